"""Choosing a brake file: those of the configuration folder, or any other; what is wrong with it stands below.

Job: one combo box with its error line. Not its job: reading the file.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QComboBox, QLabel, QVBoxLayout, QWidget

from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.file_asking import ask_open

_OTHER = "other"


class BrakeChoice(QWidget):
    """A brake file, or none where `none` names that choice."""

    valueChanged = Signal(object)
    """Path, or None; also when the same file is chosen again (it is then read again)."""

    def __init__(self, theme: ThemeKeeper, folder: Path, none: str = "") -> None:
        super().__init__()
        self._theme, self._folder, self._none = theme, folder.resolve(), none
        self._value: Path | None = None
        self.combo = QComboBox()
        self.combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.error = QLabel()
        self.error.setProperty("look", "error")
        self.error.setWordWrap(True)
        self.error.hide()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(theme.px(0.5))
        column.addWidget(self.combo)
        self.refresh()
        self.combo.activated.connect(self._on_activated)

    def refresh(self) -> None:
        """List the folder anew."""
        paths = sorted(self._folder.glob("*.toml"))
        if self._value is not None and self._value not in paths:
            paths.append(self._value)
        with QSignalBlocker(self.combo):
            self.combo.clear()
            if self._none:
                self.combo.addItem(self._none, None)
            for path in paths:
                name = path.stem if path.parent == self._folder else str(path)
                self.combo.addItem(name, path)
            self.combo.addItem(self.tr("Other file…"), _OTHER)
            self._show()

    def first(self) -> Path | None:
        """A file to begin with: the folder's "model", else its first."""
        paths = sorted(self._folder.glob("*.toml"))
        return next((p for p in paths if p.stem == "model"), paths[0] if paths else None)

    def value(self) -> Path | None:
        """The file chosen."""
        return self._value

    def setValue(self, path: Path | None) -> None:
        """Show a file; no signal."""
        self._value = None if path is None else path.resolve()
        self.refresh()

    def setError(self, text: str) -> None:
        """Say why the file was refused; "" when it is well."""
        self.error.setText(text)
        self.error.setVisible(bool(text))

    def _show(self) -> None:
        for row in range(self.combo.count()):
            if self.combo.itemData(row) == self._value:
                self.combo.setCurrentIndex(row)
                return
        self.combo.setCurrentIndex(-1)

    def _on_activated(self, row: int) -> None:
        chosen = self.combo.itemData(row)
        if chosen == _OTHER:
            self._show()
            start = self._value or self._folder
            ask_open(self, self.tr("Choose a brake file"), start, self.tr("Brake files (*.toml)"), self._take)
            return
        self._take(chosen)

    def _take(self, path: Path | None) -> None:
        self._value = path
        self.refresh()
        self.valueChanged.emit(path)
