"""Top of the page: which file, and New, Open, Recent, Save, Undo, Redo.

Not its job: doing it (`files`, `page`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Signal, SignalInstance
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QPushButton, QSizePolicy, QWidget

from rigctl.gui.theme import ThemeKeeper


class ProgramBar(QWidget):
    """Buttons and the name of the file."""

    newPressed = Signal()
    openPressed = Signal()
    recentPressed = Signal(object)
    """Path."""
    savePressed = Signal()
    saveAsPressed = Signal()
    undoPressed = Signal()
    redoPressed = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._row = QHBoxLayout(self)
        self.file = QLabel()
        self.file.setObjectName("program-file")
        self.file.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.new = self._button("new", self.tr("New"), self.tr("A new program (Ctrl+N)"), self.newPressed)
        self.open = self._button(
            "open", self.tr("Open …"), self.tr("A program file (Ctrl+O)"), self.openPressed
        )
        self.recent = QPushButton(self.tr("Recent"))
        self.recent.setObjectName("recent-programs")
        self.recent.setToolTip(self.tr("Programs opened or saved last"))
        self._menu = QMenu(self.recent)
        self.recent.setMenu(self._menu)
        self._row.addWidget(self.recent)
        self.save = self._button(
            "save", self.tr("Save"), self.tr("To the open file (Ctrl+S)"), self.savePressed
        )
        self.save_as = self._button(
            "save-as", self.tr("Save as …"), self.tr("Under another name (Ctrl+Shift+S)"), self.saveAsPressed
        )
        self._row.addWidget(self.file, 1)
        self.undo = self._button("undo", self.tr("Undo"), self.tr("Take back the last change (Ctrl+Z)"),
                                 self.undoPressed)  # fmt: skip
        self.redo = self._button("redo", self.tr("Redo"), self.tr("Do it again (Ctrl+Y)"), self.redoPressed)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _button(self, key: str, text: str, tip: str, signal: SignalInstance) -> QPushButton:
        button = QPushButton(text)
        button.setObjectName(f"program-{key}")
        button.setToolTip(tip)
        button.clicked.connect(lambda _checked=False: signal.emit())
        self._row.addWidget(button)
        return button

    def _restyle(self) -> None:
        unit = self._theme.px(1)
        self._row.setContentsMargins(unit, unit, unit, unit)
        self._row.setSpacing(unit)

    def show_file(self, path: Path | None, *, dirty: bool, recent: tuple[Path, ...]) -> None:
        """Name of the file, and whether it holds what is shown."""
        name = path.name if path is not None else ""
        if dirty:
            text = self.tr("●  {0}, not saved").format(name) if name else self.tr("●  not saved yet")
        else:
            text = name
        self.file.setText(text)
        self.file.setToolTip(str(path) if path is not None else "")
        self.save.setEnabled(dirty)
        self.save_as.setEnabled(dirty or path is not None)
        self.recent.setEnabled(bool(recent))
        self._menu.clear()
        for entry in recent:
            action = self._menu.addAction(entry.name)
            action.setToolTip(str(entry))
            action.triggered.connect(lambda _checked=False, entry=entry: self.recentPressed.emit(entry))

    def show_steps(self, *, undo: bool, redo: bool) -> None:
        """Whether there is a step back or forward."""
        self.undo.setEnabled(undo)
        self.redo.setEnabled(redo)
