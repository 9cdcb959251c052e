"""What the stability map shows: two axes, the map at the sliders' values, measured squeal of a campaign.

Job: ask the worker, first for a coarse map, then for a fine one; say how far it is; cancel. No widget. Not
its job: computing (`studies`).
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from rigctl.gui.pages.model import studies
from rigctl.gui.pages.model.data import (
    MU,
    OPERATING,
    PRESSURE,
    CampaignPoints,
    Knob,
    MapAxis,
    Measured,
    Setting,
    StabilityMap,
)
from rigctl.gui.pages.model.latest import Latest
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.services import Services
from rigctl.gui.work import Job

#: points along each axis of the first and of the final map
COARSE, FINE = 25, 81
#: axes as they are at first: friction and pressure as rigs brake; factors around the file's value
_START = {MU: (0.1, 0.8), PRESSURE: (0.0, 40.0)}
_START_FACTOR = (0.5, 2.0)
#: lane of longer work, shared with the other pages
_LANE = ""


def start_axis(key: str) -> MapAxis:
    """An axis with its usual range."""
    low, high = _START.get(key, OPERATING.get(key, _START_FACTOR))
    return MapAxis(key, low, high)


class MapState(QObject):
    """Map and measured points; see the signals.

    Signals
    -------
    mapFound : StabilityMap
    working : words while the worker computes, "" when it does not
    failed : why there is no map
    pointsFound : CampaignPoints, or None
    campaignWrong : why a campaign was refused, or ""
    stale : True when the sliders have moved away from the map on screen
    """

    mapFound = Signal(object)
    working = Signal(str)
    failed = Signal(str)
    pointsFound = Signal(object)
    campaignWrong = Signal(str)
    stale = Signal(bool)

    def __init__(self, state: ModelState, services: Services) -> None:
        super().__init__(state)
        self._state, self._services = state, services
        self.x, self.y = start_axis(MU), start_axis(PRESSURE)
        self.map: StabilityMap | None = None
        self.points: CampaignPoints | None = None
        self._key: object = None
        self._count = COARSE
        self._latest = Latest(services.work, studies.stability_map, _LANE, self)
        self._latest.answered.connect(self._take)
        self._latest.failed.connect(self._refuse)
        self._reading: Job | None = None
        self._seen = False
        state.changed.connect(self._refresh)
        state.brakeRead.connect(self._new_brake)

    def set_seen(self, seen: bool) -> None:
        """The map is looked at: it follows the sliders from now on. Unseen it costs nothing."""
        self._seen = seen
        self._refresh()

    def set_axes(self, x: MapAxis, y: MapAxis) -> None:
        """Other axes or ranges."""
        self.x, self.y = x, y
        self._refresh()

    def cancel(self) -> None:
        """The map that is being computed is not wanted; what there is stays on screen."""
        self._latest.drop()
        self.working.emit("")
        self.stale.emit(True)

    def again(self) -> None:
        """Compute once more, after a cancel."""
        self._key = None
        self._refresh()

    # -- map --------------------------------------------------------------------------------------

    def _new_brake(self, facts: object) -> None:
        self._latest.drop()
        self.map, self._key = None, None
        self.x, self.y = start_axis(MU), start_axis(PRESSURE)
        self.working.emit("")
        if facts is not None:
            self._refresh()

    def knob_of(self, key: str) -> Knob | None:
        """The knob of an axis; None for operating values."""
        facts = self._state.facts
        return None if key in OPERATING or facts is None else facts.knob(key)

    def question(self) -> tuple[Setting, tuple[MapAxis, Knob | None], tuple[MapAxis, Knob | None]]:
        """The map as the worker is asked for it: a slider that is an axis does not count."""
        setting = self._state.setting
        axes = tuple((axis, self.knob_of(axis.key)) for axis in (self.x, self.y))
        own = {axis.key for axis in (self.x, self.y)}
        setting = replace(setting, **dict.fromkeys(own & set(OPERATING), 0.0))
        return setting, axes[0], axes[1]

    def _refresh(self) -> None:
        facts = self._state.facts
        if facts is None or not self._seen:
            return
        question = self.question()
        members = {m for axis in question[1:] if axis[1] is not None for m in axis[1].members}
        rest = tuple(pair for pair in question[0].factors if pair[0] not in members)
        key = (facts.file, replace(question[0], factors=rest), question[1], question[2])
        if key == self._key:
            return
        self._key = key
        self._ask(COARSE)

    def _ask(self, count: int) -> None:
        facts = self._state.facts
        if facts is None:
            return
        self._count = count
        words = self.tr("Coarse map…") if count == COARSE else self.tr("Fine map: {0} points…")
        self.working.emit(words.format(count * count))
        self._latest.ask(facts.file, *self.question(), count)

    def _take(self, found: StabilityMap) -> None:
        self.map = found
        self.failed.emit("")
        self.stale.emit(False)
        self.mapFound.emit(found)
        if self._latest.busy:
            return
        if len(found.x_values) == COARSE:
            self._ask(FINE)
        else:
            self.working.emit("")

    def _refuse(self, text: str) -> None:
        self.working.emit("")
        self.failed.emit(text)

    # -- measured squeal --------------------------------------------------------------------------

    def campaigns(self) -> list[Path]:
        """Campaigns of the data folder, newest first."""
        folder = self._services.data_folder
        if not folder.is_dir():
            return []
        found = [path for path in folder.iterdir() if (path / "brakings").is_dir()]
        return sorted(found, key=lambda path: (path.stat().st_mtime, path.name), reverse=True)

    def open_campaign(self, folder: Path | None) -> None:
        """Read the measured squeal of a campaign; None: none."""
        if self._reading is not None and not self._reading.done:
            self._reading.cancel()
        self._reading = None
        self.points = None
        self.pointsFound.emit(None)
        self.campaignWrong.emit("")
        if folder is not None:
            self._reading = self._services.work.in_process(
                studies.campaign_points, folder, done=self._take_points, failed=self.campaignWrong.emit
            )

    def _take_points(self, points: CampaignPoints) -> None:
        self._reading = None
        self.points = points
        self.pointsFound.emit(points)

    def place_of(self, point: Measured) -> tuple[float, float] | None:
        """Where a measured point stands on the map; None unless both axes were measured."""
        values = {MU: point.mu, PRESSURE: point.pressure_bar}
        if self.x.key in values and self.y.key in values:
            return values[self.x.key], values[self.y.key]
        return None
