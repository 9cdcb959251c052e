"""The window's one connection to a controller: signals for what comes, methods for what a person asks."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from rigctl.gui.rig.state import RigState


class RigConnection(QObject):
    """Signals and commands of the rig."""

    stateChanged = Signal(object)
    """RigState, at most ten times a second and with every change of its word."""
    recordsAdded = Signal(list)
    """Newly read records of the campaign's journal (`rigctl.core.journal.Record`); first all."""
    attached = Signal(object)
    """Session that the window watches now."""
    detached = Signal(str)
    """It has ended or gone; why."""
    refused = Signal(str)
    """The controller or this window refused something; the reason in words."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.state = RigState()

    def stop(self) -> None:
        """Software stop: from anybody, at any time."""

    def close(self) -> None:
        """Leave; the run goes on."""
