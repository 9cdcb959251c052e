"""Right column, bottom: [Start …], why it cannot be started, and the second click that starts it.

Job: asking in place (no dialog); `started` carries what was chosen. Not its job: saving and starting
(`page`).
"""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QComboBox, QGridLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel, PlainEdit, set_wrong

MOST_SEED = 2**63 - 1


@dataclass(frozen=True)
class StartChoice:
    """How a program is started. `time`: None leaves it to the rig."""

    time: str | None = None
    seed: int | None = None


class StartPanel(QWidget):
    """The way into a run."""

    started = Signal(object)
    """StartChoice."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._simulated = False
        self.why = QLabel()
        self.why.setObjectName("start-why")
        self.why.setProperty("look", "muted")
        self.why.setWordWrap(True)
        self.button = QPushButton(self.tr("Start …"))
        self.button.setObjectName("start")
        self.button.setProperty("look", "primary")
        self.button.setToolTip(self.tr("Shows what will be run; a second click starts it"))
        self.button.clicked.connect(self.open)
        self.sure = QWidget()
        self.words = QLabel()
        self.words.setObjectName("start-words")
        self.words.setWordWrap(True)
        self.time = QComboBox()
        self.time.setObjectName("start-time")
        self.time.addItem(self.tr("as fast as it can be computed"), "virtual")
        self.time.addItem(self.tr("by the clock"), "real")
        self.time.setToolTip(self.tr("Time of the simulated rig"))
        self.seed = PlainEdit()
        self.seed.setObjectName("start-seed")
        self.seed.setPlaceholderText(self.tr("any"))
        self.seed.setToolTip(self.tr("A whole number makes the simulated run repeatable bit for bit"))
        self.seed_fault = FaultLabel(theme)
        self.seed.textEdited.connect(lambda _text: self._read_seed())
        self.time_label, self.seed_label = QLabel(self.tr("Time")), QLabel(self.tr("Seed"))
        self.go = QPushButton(self.tr("Start now"))
        self.go.setObjectName("start-now")
        self.go.setProperty("look", "primary")
        self.go.setToolTip(self.tr("Start the run; the run page follows it"))
        self.go.clicked.connect(self._on_go)
        self.no = QPushButton(self.tr("Cancel"))
        self.no.setObjectName("start-cancel")
        self.no.setToolTip(self.tr("Start nothing (Esc)"))
        self.no.clicked.connect(self.close_panel)
        self._build()
        theme.changed.connect(self._restyle)
        self._restyle()

    def _build(self) -> None:
        self._grid = QGridLayout(self.sure)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.addWidget(self.words, 0, 0, 1, 2)
        self._grid.addWidget(self.time_label, 1, 0)
        self._grid.addWidget(self.time, 1, 1)
        self._grid.addWidget(self.seed_label, 2, 0)
        self._grid.addWidget(self.seed, 2, 1)
        self._grid.addWidget(self.seed_fault, 3, 1)
        self._grid.addWidget(self.no, 4, 0)
        self._grid.addWidget(self.go, 4, 1)
        self._grid.setColumnStretch(1, 1)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addWidget(self.why)
        self._column.addWidget(self.button)
        self._column.addWidget(self.sure)
        self.sure.hide()

    def _restyle(self) -> None:
        self._column.setSpacing(self._theme.px(1))
        self._grid.setSpacing(self._theme.px(1))
        self.why.setFont(self._theme.font("small"))

    @property
    def asking(self) -> bool:
        """True between the first and the second click."""
        return not self.sure.isHidden()

    def show_state(self, why_not: str, words: str, *, simulated: bool) -> None:
        """`why_not`: what hinders a start, "" for nothing; `words`: what will be run."""
        self._simulated = simulated
        self.why.setText(why_not)
        self.why.setVisible(bool(why_not))
        self.button.setEnabled(not why_not)
        self.words.setText(words)
        for widget in (self.time, self.time_label, self.seed, self.seed_label):
            widget.setVisible(simulated)
        if why_not and self.asking:
            self.close_panel()

    def open(self) -> None:
        """First click."""
        self.button.hide()
        self.sure.show()
        self._read_seed()
        self.no.setFocus(Qt.FocusReason.OtherFocusReason)

    def close_panel(self) -> None:
        """Start nothing."""
        self.sure.hide()
        self.button.show()

    def _read_seed(self) -> int | None:
        """The seed; None for any. What is no seed is said, and [Start now] waits."""
        text = self.seed.text().strip()
        number = int(text) if text.isascii() and text.isdigit() else None
        wrong = self._simulated and bool(text) and (number is None or number > MOST_SEED)
        self.seed_fault.setFault(
            self.tr("Enter a whole number of 0 or more, or leave it empty.") if wrong else ""
        )
        set_wrong(self.seed, "error" if wrong else "")
        self.go.setEnabled(not wrong)
        return number

    def _on_go(self) -> None:
        seed = self._read_seed()
        if not self.go.isEnabled():
            return
        self.close_panel()
        if self._simulated:
            self.started.emit(StartChoice(self.time.currentData(), seed))
        else:
            self.started.emit(StartChoice())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc: no."""
        if event.key() == Qt.Key.Key_Escape and self.asking:
            self.close_panel()
            return
        super().keyPressEvent(event)
