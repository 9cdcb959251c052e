"""What every page of the window is: a widget that knows when it is looked at, and what it would lose.

Not its job: layout of the frame, the rig.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QWidget

from rigctl.gui.services import Services


class Page(QWidget):
    """Base of all pages. `services` is the window's; pages never make their own connections or threads."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self.services = services

    def activated(self) -> None:
        """The page is shown now: start what costs time."""

    def deactivated(self) -> None:
        """Another page is shown: stop timers and drawing."""

    def closing(self) -> None:
        """The window closes: end what goes on (processes, procedures); the rig is not touched."""

    def open(self, **what: Any) -> None:
        """Show something particular, asked for by another page (`Services.navigate`)."""

    def unsaved(self) -> list[str]:
        """What a person would lose by closing the window now, a line each; empty when nothing."""
        return []

    def save_layout(self, settings: QSettings) -> None:
        """Write splitter positions and the like; the window opens a group for each page."""

    def restore_layout(self, settings: QSettings) -> None:
        """Read what `save_layout` has written; anything may be missing."""

    def help_text(self) -> str:
        """What F1 shows: rich text, a few sentences and the keys of this page."""
        return ""
