"""Data acquisition of a real rig: kind "live" of the role acquisition, composed of sources.

Job: build the sources that the rig file names, own the sample ring, and deliver blocks on the rig's time:
wait until every source has delivered the samples of the block (or is too late), write them, say what devices
said. Not its job: single devices (`drivers.daq.microphone`, `can_sources`, `pyrometer_upp`), clocks
(`rig_time`, `collector`), limits.

Faults: a source that is silent for longer than its limit, or a master that has lost frames, raises a
`DeviceError` that names it in the rig file. Samples of slow channels that are lost, late or not valid are
NaN.

::

    [devices.acquisition]
    kind = "live"

    [devices.acquisition.sources.microphone]
    kind = "sounddevice"
    device = "bench:rigmic"
    full_scale_pa = 20.0

Kinds of sources: see `KINDS`; third parties add theirs by an entry point ``source.KIND`` of the group
``rigctl.devices`` (`drivers.daq.source`).
"""

# numpy's stubs are partly unknown in some of its versions:
# pyright: reportUnknownMemberType=false

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from drivers.daq.collector import SETTLE_S, Collector
from drivers.daq.rig_time import HostTime, RigTime, SoundTime
from drivers.daq.source import AnySource, Master, Source, checked
from rigctl.core.blocks import CLOCKS, Block
from rigctl.core.channels import ChannelSpec, corrected
from rigctl.core.errors import ConfigError, DeviceError
from rigctl.core.registry import Registry
from rigctl.core.ring import RING_NAME, SampleRing
from rigctl.core.units import NS_PER_S
from rigctl.hal.devices import Request, RigContext
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading

KINDS = {
    "sounddevice": "drivers.daq.microphone:SoundDeviceMicrophone",
    "canopen_analog": "drivers.daq.can_sources:CanopenAnalog",
    "current_loop": "drivers.daq.can_sources:CurrentLoop",
    "encoder": "drivers.daq.can_sources:Encoder",
    "upp": "drivers.daq.pyrometer_upp:UppPyrometer",
}
RING_S = 16.0
_POLL_S = 0.002  # for the end of a block
_UPDATE_S = 0.02  # meanwhile, for the slow sources: each time costs as much as ten looks at the master
_START_TIMEOUT_S = 5.0
_CLOCKS_EVERY_S = 1.0


class LiveSettings(BaseModel):
    """Settings of kind "live".

    Attributes
    ----------
    sources : mapping
        Name -> kind and settings.
    lateness_s : float
        A block waits so long for slow sources after its end; what has not come is NaN. Well below the
        leases of set-points (0.25 s).
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    sources: dict[str, dict[str, Any]] = Field(min_length=1)
    lateness_s: float = Field(default=0.1, ge=0.03, le=0.2)


class LiveAcquisition:
    """Implements `rigctl.hal.devices.Acquisition`."""

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        place = f"{context.place}: devices.acquisition"
        self._settings = checked(LiveSettings, settings, place)
        self._context = context
        self._place = place
        if context.time != "real":
            raise ConfigError(
                f"real devices cannot run in {context.time} time.", place=f"{place}.kind", value="live",
                remedy="Start with --time real.",
            )  # fmt: skip
        self._slow: list[Source] = []
        self._master: Master | None = None
        for name, table in self._settings.sources.items():
            source = _make_source(name, table, context, f"{place}.sources.{name}")
            if not callable(getattr(source, "frames", None)):
                self._slow.append(source)
            elif self._master is None:
                self._master = source
            else:
                raise ConfigError(
                    "there are two microphones, and only one can be the clock of the rig.",
                    place=f"{place}.sources.{name}", value=name, remedy="Remove one.",
                )  # fmt: skip
        self._check_names()
        self._opened: list[AnySource] = []
        self._ring: SampleRing | None = None
        self._time: RigTime = HostTime()
        self._collectors: list[Collector] = []
        self._started = False
        self._k = 0
        self._t_ns = 0
        self._told_s = self._updated_s = float("-inf")
        self.ready_after_s = 0.0
        """From the newest block's end (of its samples, on the host's clock) to its delivery."""

    # -- life ---------------------------------------------------------------------------------------

    def open(self) -> None:
        """Open all sources and wait until their clocks are known.

        Raises
        ------
        DeviceError
            Names the source that is missing, refuses, or delivers nothing.
        """
        try:
            for source in self._sources():
                source.open()
                self._opened.append(source)
            now_s = time.monotonic()
            master = self._master
            self._time = HostTime()
            if master is not None:
                own = master.settings
                self._time = SoundTime(
                    master, now_s, gap_limit_s=own.gap_limit_s, max_drift_ppm=own.max_drift_ppm
                )
            self._collectors = [Collector(source, now_s) for source in self._slow]
            self._started, self._k, self._t_ns = False, 0, 0
            self._warm_up(now_s)
            path = self._context.run_dir / RING_NAME
            path.unlink(missing_ok=True)  # of an acquisition that ended before in this folder
            self._ring = SampleRing.create(path, self.channels(), RING_S)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Stop all sources and remove the ring's file; readers that have it open keep it."""
        while self._opened:
            self._opened.pop().close()
        ring, self._ring = self._ring, None
        if ring is not None:
            ring.close()
            ring.path.unlink(missing_ok=True)
        self._collectors = []

    def identity(self) -> Mapping[str, str]:
        """What each source's device says of itself, and the measured clocks: "source.key" -> text."""
        found: dict[str, str] = {}
        for source in self._opened:
            found |= {f"{source.name}.{key}": value for key, value in source.identity().items()}
        for name, state in self.clocks().items():
            found[f"{name}.clock"] = ", ".join(f"{key} {value}" for key, value in state.items())
        return found

    def channels(self) -> Sequence[ChannelSpec]:
        """See `Acquisition.channels`."""
        specs = (spec for source in self._sources() for spec in source.channels())
        return corrected(specs, self._context.corrections)

    def clocks(self) -> dict[str, dict[str, Any]]:
        """Measured offset and drift of each source's clock against the master; see `collector.ClockState`."""
        found: dict[str, dict[str, Any]] = {}
        origin_s = float(self._time.host_s(np.zeros(1))[0]) if self._started else 0.0
        if self._master is not None and isinstance(self._time, SoundTime) and self._time.warm:
            found[self._master.name] = {
                "master": True,
                "drift_ppm": round(self._time.drift_ppm, 1),  # against the machine's clock
                "jitter_ms": round(1e3 * self._time.jitter_s, 3),
                "samples": self._master.frames(),
            }
        for collector in self._collectors:
            state = collector.state(self._time.drift_ppm if self._time.warm else 0.0, origin_s)
            found[collector.source.name] = state.to_mapping()
        return found

    # -- blocks -------------------------------------------------------------------------------------

    def next_block(self, request: Request) -> Block:
        """See `Acquisition.next_block`.

        Raises
        ------
        DeviceError
            A source is silent, has failed, or the master has lost frames; the source is named.
        """
        ring = self._ring
        if ring is None:
            raise DeviceError("is not open.", place=self._place, remedy="Open the rig first.")
        if not self._started:
            self._time.update(time.monotonic())
            self._time.start(time.monotonic())
            self._started = True
        begin_ns, end_ns = self._t_ns, self._t_ns + request.dt_ns
        self._wait(end_ns)
        ranges: dict[str, tuple[int, int]] = {}
        if self._master is not None and isinstance(self._time, SoundTime):
            counts = self._master.read(self._time.frame(begin_ns), self._time.frame(end_ns))
            spec = self._master.channels()[0]
            ranges[spec.name] = ring.write(spec.name, counts)
        for collector in self._collectors:
            specs = collector.source.channels()
            grid_s = _grid_s(specs[0].rate_hz, begin_ns, end_ns)
            values = collector.lay(self._time.host_s(grid_s)).astype(np.float32)
            for column, spec in enumerate(specs):
                ranges[spec.name] = ring.write(spec.name, values[:, column])
        k, self._k, self._t_ns = self._k, self._k + 1, end_ns
        now_s = time.monotonic()
        self.ready_after_s = now_s - float(self._time.host_s(np.array([end_ns * 1e-9]))[0])
        if now_s - self._told_s > _CLOCKS_EVERY_S:
            self._told_s = now_s
            self._context.board.set(**{CLOCKS: self.clocks()})
        return Block(k, begin_ns, request.dt_ns, ranges, ring, status=self._context.board.snapshot())

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `rigctl.hal.diagnosis`."""
        values: list[Reading] = []
        times: list[float] = []
        warnings: list[Finding] = []
        for source in self._opened:
            part = source.diagnose(round_trips)
            values += part.values
            times += part.round_trip_s
            warnings += [
                Finding(f"{source.name}: {finding.problem}", finding.remedy, finding.unsafe)
                for finding in part.warnings
            ]
        return Diagnosis(tuple(values), times, tuple(warnings), self.identity())

    # -- inside -------------------------------------------------------------------------------------

    def _sources(self) -> list[Any]:
        return [*([self._master] if self._master is not None else []), *self._slow]

    def _check_names(self) -> None:
        seen: dict[str, str] = {}
        for source in self._sources():
            for spec in source.channels():
                if spec.name in seen:
                    raise ConfigError(
                        f"channel {spec.name!r} comes from two sources: {seen[spec.name]}, {source.name}.",
                        place=source.place, value=spec.name, remedy="Rename it, or remove one source.",
                    )  # fmt: skip
                seen[spec.name] = source.name

    def _update(self, now_s: float) -> None:
        """Take what the slow sources have delivered."""
        self._updated_s = now_s
        for collector in self._collectors:
            collector.update(now_s)
            silent_s = collector.silent_s(now_s)
            if silent_s > collector.source.settings.silent_s:
                raise DeviceError(
                    f"has delivered no sample for {silent_s:.2f} s.", place=collector.source.place,
                    remedy="Check power and cable of the device.",
                )  # fmt: skip

    def _warm_up(self, begin_s: float) -> None:
        while True:
            time.sleep(0.01)
            now_s = time.monotonic()
            self._time.update(now_s)
            self._update(now_s)
            cold = [collector.source.place for collector in self._collectors if not collector.warm]
            if not self._time.warm and self._master is not None:
                cold.append(self._master.place)
            if not cold:
                return
            if now_s - begin_s > _START_TIMEOUT_S:
                raise DeviceError(
                    f"delivers too little to know its clock within {_START_TIMEOUT_S:g} s.", place=cold[0],
                    remedy="Check its rate and its cable.",
                )  # fmt: skip

    def _wait(self, end_ns: int) -> None:
        """Until all samples before `end_ns` are there, or the slow ones are late."""
        end_s = np.array([end_ns * 1e-9])
        settled_after_s = max((collector.settled_after_s for collector in self._collectors), default=0.0)
        reached_s: float | None = None
        while True:
            now_s = time.monotonic()
            self._time.update(now_s)
            host_s = float(self._time.host_s(end_s)[0])
            reached = self._time.reached(end_ns, now_s)
            if reached or now_s - self._updated_s >= _UPDATE_S:
                self._update(now_s)
            if reached:
                # counted from when we saw it: after a stall of this process, readers need their turn
                reached_s = now_s if reached_s is None else reached_s
                late = now_s > max(host_s, reached_s) + self._settings.lateness_s
                if late or all(collector.covers(host_s) for collector in self._collectors):
                    return
            due_s = host_s + (settled_after_s if reached else SETTLE_S)
            time.sleep(max(_POLL_S, min(due_s - now_s, 0.05)))


def _grid_s(rate_hz: float, begin_ns: int, end_ns: int) -> Any:
    """Rig times of the samples k / rate in [begin, end), s."""
    rate = round(rate_hz * 1000)
    first, stop = (-(-t_ns * rate // (1000 * NS_PER_S)) for t_ns in (begin_ns, end_ns))
    return np.arange(first, stop) / rate_hz


def _make_source(name: str, table: Mapping[str, Any], context: RigContext, place: str) -> Any:
    settings = dict(table)
    kind = settings.pop("kind", None)
    if not isinstance(kind, str):
        raise ConfigError(
            "missing.", place=f"{place}.kind", value=kind, remedy=f"Give one of: {', '.join(KINDS)}."
        )
    registry = Registry()
    for known, target in KINDS.items():
        registry.register("source", known, target)
    return registry.load("source", kind, place=f"{place}.kind")(name, settings, context, place)
