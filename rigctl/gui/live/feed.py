"""The window's one stream of live signals: from the connection's news to `LiveData`.

Job: follow the session, pump announced blocks from the ring into the data, keep set-points. One feed for
all live views of a window, so that samples are read and analysed once. Not its job: drawing.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from rigctl.core.channels import PRESSURE, SPEED
from rigctl.gui.live.data import LiveData
from rigctl.gui.live.limits import SessionValues, read_session
from rigctl.gui.live.source import LiveSource
from rigctl.gui.rig.state import RigState
from rigctl.gui.services import Services
from rigctl.gui.work import Job

BUDGET_S = 0.006
"""Time for the analysis of sound per call; the event loop gets its turn in between."""


class LiveFeed(QObject):
    """Live signals of the session that the window watches. Get it by `LiveFeed.of`."""

    sessionChanged = Signal()
    """Attached or detached: `data` is a new one."""
    limitsChanged = Signal(dict)
    """Limits by channel that the session's campaign holds."""

    def __init__(self, services: Services) -> None:
        super().__init__(services.rig)
        self._services = services
        self._source: LiveSource | None = None
        self._values = SessionValues({}, None)
        self._generation = 0
        self._reading: Job | None = None
        self.data = LiveData()
        rig = services.rig
        rig.attached.connect(self._on_attached)
        rig.detached.connect(self._on_detached)
        rig.blocksArrived.connect(self.take)
        rig.stateChanged.connect(self._on_state)
        session = getattr(rig, "session", None)
        if session is not None:
            self._on_attached(session)

    @classmethod
    def of(cls, services: Services) -> LiveFeed:
        """The feed of this window; made when first asked for."""
        found = services.rig.findChild(LiveFeed)
        return found if isinstance(found, LiveFeed) else cls(services)

    @property
    def attached(self) -> bool:
        """True while a session is watched."""
        return self._source is not None

    @property
    def limits(self) -> Mapping[str, tuple[float, float]]:
        """Limits by channel of the present session."""
        return self._values.limits

    def take(self, blocks: list[Mapping[str, Any]]) -> None:
        """Announced blocks; what is in the ring of them is read at once."""
        if self._source is not None:
            self._source.announce(blocks)
            self.pump()

    def pump(self) -> None:
        """Read what has been written since, and analyse sound for some milliseconds."""
        source = self._source
        if source is None:
            return
        stretches = source.take()
        if source.generation != self._generation:
            self._generation = source.generation
            self.data = LiveData(source.specs.values(), self._values.friction)
            self.sessionChanged.emit()
        if self._generation:
            self.data.feed(stretches, source.end_s)
            self.data.work(BUDGET_S)

    def _on_attached(self, session: Any) -> None:
        self._close_source()
        self._source = LiveSource(Path(session.run_dir))
        self._generation = 0
        self._values = SessionValues({}, None)
        self.data = LiveData()
        self.sessionChanged.emit()
        if self._reading is not None:
            self._reading.cancel()
        campaign = getattr(session, "campaign", None)
        if campaign is not None:
            self._reading = self._services.work.in_thread(
                _read, Path(campaign), done=self._on_values, failed=self._on_unreadable
            )

    def _on_values(self, values: SessionValues) -> None:
        self._reading = None
        self._values = values
        self.data.buffer.friction = values.friction
        self.limitsChanged.emit(values.limits)

    def _on_unreadable(self, reason: str) -> None:
        self._reading = None
        self._services.notify(self.tr("No limits in the live plots: {0}").format(reason))

    def _on_detached(self, _reason: str) -> None:
        # What has been drawn stays to be looked at; nothing new comes.
        self._close_source()

    def _close_source(self) -> None:
        if self._source is not None:
            self._source.close()
            self._source = None

    def _on_state(self, state: RigState) -> None:
        if self._source is not None and self.data.end_s > float("-inf"):
            wanted = {SPEED: state.readings.set_speed_rpm, PRESSURE: state.readings.set_pressure_bar}
            self.data.note_setpoints(state.rig_s or self.data.end_s, wanted)


def _read(campaign: Path, _reporter: object) -> SessionValues:
    return read_session(campaign)
