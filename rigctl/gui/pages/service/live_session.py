"""The session that runs now, for the tabs of the Service page.

Job: keep it from `attached` to `detached`; the connection itself remembers an ended one for other pages. Not
its job: finding sessions (`rigctl.gui.rig.connection`).
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QObject, Signal

from rigctl.app.sessions import alive
from rigctl.gui.rig.connection import RigConnection


class LiveSession(QObject):
    """One for the page."""

    began = Signal(object)
    """A session is watched now."""
    ended = Signal()
    """It has ended or gone."""

    def __init__(self, rig: RigConnection, parent: QObject | None = None) -> None:
        super().__init__(parent)
        session: Any = rig.session
        self.session: Any = session if session is not None and alive(session) else None
        """Session that runs, None without one."""
        rig.attached.connect(self._on_attached)
        rig.detached.connect(self._on_detached)

    def _on_attached(self, session: Any) -> None:
        self.session = session
        self.began.emit(session)

    def _on_detached(self, _why: str) -> None:
        self.session = None
        self.ended.emit()
