"""What the page shows while no program is open: what a program is, and ways to begin.

Not its job: opening (`files`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QPushButton, QScrollArea, QVBoxLayout, QWidget

from rigctl.gui.pages.sequence.program_file import ShippedProgram
from rigctl.gui.pages.sequence.words import brakings_text
from rigctl.gui.theme import ThemeKeeper


class EmptyState(QScrollArea):
    """Begin anew, open a file, take one of the shipped programs or a recent one."""

    newAsked = Signal(str)
    openAsked = Signal()
    programAsked = Signal(object)
    """Path."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.inner = QWidget()
        self.title = QLabel(self.tr("No program is open"))
        self.words = QLabel(
            self.tr(
                "A program is a list of sequences: bedding, then for example a matrix of temperatures, "
                "speeds and "
                "pressures. Begin with a new one, change one that comes with rigctl, or drop a program "
                "file here."
            )
        )
        self.words.setWordWrap(True)
        self.new = QPushButton(self.tr("New matrix of brakings"))
        self.new.setObjectName("empty-new")
        self.new.setProperty("look", "primary")
        self.new.setToolTip(self.tr("A program with one sequence, to be changed"))
        self.new.clicked.connect(lambda: self.newAsked.emit("matrix"))
        self.open = QPushButton(self.tr("Open a file …"))
        self.open.setObjectName("empty-open")
        self.open.setToolTip(self.tr("A program file of the window or the command line (Ctrl+O)"))
        self.open.clicked.connect(self.openAsked)
        buttons = QHBoxLayout()
        buttons.addWidget(self.new)
        buttons.addWidget(self.open)
        buttons.addStretch(1)
        self._programs = QGridLayout()
        self._programs.setColumnStretch(1, 1)
        self._column = QVBoxLayout(self.inner)
        self._column.addWidget(self.title)
        self._column.addWidget(self.words)
        self._column.addLayout(buttons)
        self._column.addLayout(self._programs)
        self._column.addStretch(1)
        self.setWidget(self.inner)
        self._shipped: tuple[ShippedProgram, ...] = ()
        self._recent: tuple[Path, ...] = ()
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        unit = self._theme.px(1)
        self._column.setContentsMargins(4 * unit, 4 * unit, 4 * unit, 2 * unit)
        self._column.setSpacing(2 * unit)
        self._programs.setHorizontalSpacing(2 * unit)
        self._programs.setVerticalSpacing(unit)
        self.title.setFont(self._theme.font("large"))
        self.words.setMaximumWidth(90 * unit)

    def showEvent(self, event: QShowEvent) -> None:
        """Fonts once more: polishing within the scroll area takes the large one away."""
        super().showEvent(event)
        self._restyle()

    def show_programs(self, shipped: tuple[ShippedProgram, ...], recent: tuple[Path, ...]) -> None:
        """Offer programs."""
        if (shipped, recent) == (self._shipped, self._recent):
            return
        self._shipped, self._recent = shipped, recent
        while (item := self._programs.takeAt(0)) is not None:
            widget = item.widget()
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        row = 0
        if recent:
            row = self._heading(row, self.tr("Recent"))
            for path in recent:
                row = self._line(row, path.stem, path, str(path.parent), "")
        if shipped:
            row = self._heading(row, self.tr("Coming with rigctl"))
            for program in shipped:
                row = self._line(
                    row, program.name, program.path, program.description, brakings_text(program.count)
                )

    def _heading(self, row: int, text: str) -> int:
        label = QLabel(text)
        label.setProperty("look", "title")
        self._programs.addWidget(label, row, 0, 1, 3)
        return row + 1

    def _line(self, row: int, name: str, path: Path, about: str, count: str) -> int:
        button = QPushButton(name)
        button.setObjectName(f"program-{name}")
        button.setToolTip(str(path))
        button.clicked.connect(lambda _checked=False: self.programAsked.emit(path))
        words, number = QLabel(about), QLabel(count)
        words.setWordWrap(True)
        for label in (words, number):
            label.setProperty("look", "muted")
        number.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self._programs.addWidget(button, row, 0)
        self._programs.addWidget(words, row, 1)
        self._programs.addWidget(number, row, 2)
        return row + 1
