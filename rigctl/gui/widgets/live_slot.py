"""Where the live view of the signals goes on a page: made when first shown, started and stopped with it.

Job: import the plots only when somebody looks. Not its job: the plots (`rigctl.gui.live`).
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QSettings, Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from rigctl.gui.services import Services


class LiveSlot(QWidget):
    """Holds a `LiveView`."""

    levelChanged = Signal(float)
    """Newest sound level, dB."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        self._layout: dict[str, Any] = {}
        self.view: Any = None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)

    def start(self) -> None:
        """Make the view if need be; plots run."""

    def stop(self) -> None:
        """Plots rest."""

    def save_layout(self, settings: QSettings) -> None:
        """As the view wants it."""

    def restore_layout(self, settings: QSettings) -> None:
        """As the view wants it."""
