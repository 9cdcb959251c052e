"""Asking for a file without stopping the window: STOP, alarms and live plots go on behind the dialog.

Job: `ask_open`, `ask_save`; the answer comes by a call. Not its job: reading and writing.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget


def ask_open(
    parent: QWidget, title: str, start: Path, kinds: str, then: Callable[[Path], object],
    *, folders: bool = False,
) -> QFileDialog:  # fmt: skip
    """Ask for a file that exists (or a folder); `start` is the file or folder to begin with."""
    dialog = _dialog(parent, title, start, kinds, then)
    dialog.setFileMode(QFileDialog.FileMode.Directory if folders else QFileDialog.FileMode.ExistingFile)
    dialog.setOption(QFileDialog.Option.ShowDirsOnly, folders)
    dialog.show()
    return dialog


def ask_save(
    parent: QWidget, title: str, start: Path, kinds: str, then: Callable[[Path], object]
) -> QFileDialog:
    """Ask for a name to save under; the dialog itself asks before a file is replaced."""
    dialog = _dialog(parent, title, start, kinds, then)
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setDefaultSuffix(start.suffix.removeprefix("."))
    if start.suffix:
        dialog.selectFile(start.name)
    dialog.show()
    return dialog


def _dialog(
    parent: QWidget, title: str, start: Path, kinds: str, then: Callable[[Path], object]
) -> QFileDialog:
    folder = start if start.is_dir() else start.parent
    dialog = QFileDialog(parent.window(), title, str(folder), kinds)
    dialog.setModal(False)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.fileSelected.connect(lambda name: then(Path(name)))
    return dialog
