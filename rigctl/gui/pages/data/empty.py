"""What the data page shows before there is data: how to record the first braking.

Not its job: recording.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.flow import FlowLayout


class EmptyPane(QWidget):
    """Words and ways out."""

    manual = Signal()
    sequence = Signal()
    otherFolder = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.setObjectName("data-empty")
        self.title = QLabel(self.tr("No braking has been recorded yet"))
        self.title.setWordWrap(True)
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setTextFormat(Qt.TextFormat.PlainText)
        self.by_hand = QPushButton(self.tr("&Brake by hand"))
        self.by_hand.setObjectName("data-empty-manual")
        self.by_hand.setProperty("look", "primary")
        self.by_hand.setToolTip(self.tr("Page Manual: start the simulated rig, enable it, start a braking"))
        self.test = QPushButton(self.tr("&Write a test program"))
        self.test.setObjectName("data-empty-sequence")
        self.test.setToolTip(self.tr("Page Sequence: a matrix of pressures and temperatures, run unattended"))
        self.other = QPushButton(self.tr("&Open folder…"))
        self.other.setObjectName("data-empty-other")
        self.other.setToolTip(self.tr("A campaign, or a folder of them"))
        self._row = FlowLayout()
        for button in (self.by_hand, self.test, self.other):
            self._row.addWidget(button)
        self._column = QVBoxLayout(self)
        self._column.addStretch(1)
        self._column.addWidget(self.title)
        self._column.addWidget(self.words)
        self._column.addLayout(self._row)
        self._column.addStretch(2)
        self.by_hand.clicked.connect(self.manual)
        self.test.clicked.connect(self.sequence)
        self.other.clicked.connect(self.otherFolder)
        theme.changed.connect(self._restyle)
        self._restyle()

    def show_folder(self, folder: Path) -> None:
        """Where campaigns are looked for."""
        self.words.setText(
            self.tr(
                "Brakings are kept in campaigns, folders below {0}; there is none yet. The simulated rig "
                "records one in a few seconds and needs no hardware: on the page Manual choose it, enable "
                "it and start a braking, or let a test program run."
            ).format(folder)
        )

    def _restyle(self) -> None:
        u = self._theme.px
        self.title.setFont(self._theme.font("large"))
        self.words.setMaximumWidth(u(90))
        self._column.setContentsMargins(u(6), u(6), u(6), u(6))
        self._column.setSpacing(u(2))
        self._row.setSpacing(u(1))
