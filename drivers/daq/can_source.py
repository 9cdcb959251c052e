"""What all sources on CANopen have in common: node, TPDO, frames with the time of their arrival.

Job: open the node, compare its TPDO with what the source needs (mapping read back), start it, collect its
frames. Not its job: what the objects mean (`drivers.daq.can_sources`).
"""

# numpy's stubs are partly unknown in some of its versions:
# pyright: reportUnknownMemberType=false

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drivers.can.canopen_network import canopen_network
from drivers.can.canopen_node import CanopenNode, Identity
from drivers.can.objects import ObjectRef
from drivers.can.pdo import PdoSetup, ensure_pdo
from drivers.daq.source import NOTHING, SlowSettings, Taken
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading, measured

BACKLOG = 60_000  # frames: a minute at 1 kHz
DEVICE_TYPE = ObjectRef(0x1000, 0, "u32")
_NUMPY = {"u8": "<u1", "i8": "<i1", "u16": "<u2", "i16": "<i2", "u32": "<u4", "i32": "<i4", "f32": "<f4"}


class CanSettings(SlowSettings):
    """Keys of all sources on CANopen.

    Attributes
    ----------
    bus : str
        Name of a table `[buses.NAME]`.
    node : int
    tpdo : int
        Number of the TPDO that carries the values.
    cob_id : int or None
        Its identifier; None: the one of CiA 301, 180h/280h/380h/480h + node.
    event_ms : int
        Its period.
    configure : bool
        Set the TPDO as needed; otherwise a difference is an error.
    identity : Identity
        Who the node must be.
    heartbeat_limit_s : float
        See `CanopenNode`.
    """

    bus: str = Field(min_length=1)
    node: int = Field(ge=1, le=127)
    tpdo: int = Field(default=1, ge=1, le=4)
    cob_id: int | None = Field(default=None, ge=0x181, le=0x57F)
    event_ms: int = Field(default=1, ge=1, le=1000)
    configure: bool = False
    identity: Identity = Identity(
        device_type=None, name=None, vendor_id=None, product_code=None, revision=None, serial=None
    )
    heartbeat_limit_s: float = Field(default=0.35, gt=0.0, le=10.0)


class CanSource:
    """Base of the sources; see `drivers.daq.source.Source`."""

    counted = True
    interpolation = "linear"
    hold_s = 0.0
    profile = 0

    def __init__(
        self,
        name: str,
        settings: CanSettings,
        context: RigContext,
        place: str,
        *,
        objects: tuple[ObjectRef, ...],
        emcy_names: Mapping[int, str],
        tolerated: bool = True,
    ) -> None:
        self.name, self.place, self.settings = name, place, settings
        self.rate_hz = 1000.0 / settings.event_ms
        self.malformed = 0
        self._context = context
        cob_id = settings.cob_id or 0x80 + 0x100 * settings.tpdo + settings.node
        self._setup = PdoSetup(True, settings.tpdo, cob_id, objects, 254, settings.event_ms)
        self._dtype = np.dtype([(f"v{i}", _NUMPY[entry.kind]) for i, entry in enumerate(objects)])
        self._frames: deque[tuple[float, bytes]] = deque(maxlen=BACKLOG)
        self._last: tuple[float, bytes] | None = None
        self._first_s = float("nan")
        self._count = 0
        self._node = CanopenNode(
            canopen_network(context, settings.bus), settings.node, f"acquisition source {name!r}",
            heartbeat_limit_s=settings.heartbeat_limit_s, emcy_names=emcy_names,
            tolerated_emcy=tuple(emcy_names) if tolerated else (),
        )  # fmt: skip
        self._identity: dict[str, str] = {}
        self._faults: dict[str, str] = {}
        self._changed: list[str] = []
        self._end: Callable[[], None] | None = None
        self._opened = False

    def open(self) -> None:
        """Find the node, verify profile, settings and TPDO, start it, and listen.

        Raises
        ------
        DeviceError
            It is not there, is another device, or is set up otherwise.
        """
        node = self._node
        node.open()
        self._opened = True
        try:
            self._identity = node.check_identity(self.profile, self.settings.identity)
            self.verify(node)
            if self.settings.configure:
                node.pre_operational()
            self._changed = ensure_pdo(node, self._setup, configure=self.settings.configure)
            self._frames.clear()
            self._count, self._last = 0, None
            self._end = node.network.session.subscribe(self._setup.cob_id, self._on_frame)
            node.start()
            node.watch()
        except BaseException:
            self.close()
            raise

    def verify(self, node: CanopenNode) -> None:
        """Read the settings that the meaning of the values depends on."""
        raise NotImplementedError

    def close(self) -> None:
        """Stop listening. The node goes on: the watchdog listens to it too."""
        end, self._end = self._end, None
        if end is not None:
            end()
        if self._opened:
            self._opened = False
            self._node.unwatch()
            self._node.close()
        for key in list(self._faults):
            self.fault(key, "")

    def identity(self) -> Mapping[str, str]:
        """See `AnySource.identity`."""
        return dict(self._identity)

    def check(self) -> None:
        """See `AnySource.check`."""
        self._node.check()

    def take(self) -> Taken:
        """See `Source.take`; values as the integers of the frame."""
        frames = self._frames
        batch = [frames.popleft() for _ in range(len(frames))]
        size = self._dtype.itemsize
        good = [entry for entry in batch if len(entry[1]) == size]
        self.malformed += len(batch) - len(good)
        if not good:
            return NOTHING
        self._last = good[-1]
        return Taken(np.array([when for when, _ in good]), self._decode(b"".join(data for _, data in good)))

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `AnySource.diagnose`."""
        self.check()
        times = measured(lambda: self._node.read(DEVICE_TYPE), round_trips)
        self.take()
        now_s = time.monotonic()
        readings: list[Reading] = []
        specs = self.channels()
        if self._last is None:
            readings = [Reading(spec.name, None, spec.unit, fault="no frame yet") for spec in specs]
        else:
            when_s, data = self._last
            rate_hz = (self._count - 1) / (when_s - self._first_s) if self._count > 1 else None
            values = self.show(self._decode(data)[0])
            for spec, value in zip(specs, values, strict=True):
                valid = bool(np.isfinite(value))
                fault = "" if valid else self._faults.get(spec.name, "not valid")
                readings.append(
                    Reading(
                        spec.name, float(value) if valid else None, spec.unit, now_s - when_s, rate_hz, fault
                    )
                )
        warnings = [Finding(f"set at opening, since configure = true: {text}.") for text in self._changed]
        return Diagnosis(tuple(readings), times, tuple(warnings), self.identity())

    def channels(self) -> Any:
        """See `AnySource.channels`."""
        raise NotImplementedError

    def show(self, raw: NDArray[np.float64]) -> NDArray[np.float64]:
        """Physical values of one frame, for people."""
        raise NotImplementedError

    def fault(self, key: str, problem: str) -> None:
        """Publish a fault of a channel where it has changed; an empty text takes it back."""
        if self._faults.get(key, "") == problem:
            return
        self._faults[key] = problem
        self._context.board.fault(f"{self.name}: {key}", problem)

    def _decode(self, data: bytes) -> NDArray[np.float64]:
        fields = np.frombuffer(data, self._dtype)
        return np.stack([fields[name].astype(np.float64) for name in self._dtype.names or ()], axis=1)

    def _on_frame(self, data: bytes, timestamp_s: float) -> None:
        if self._count == 0:
            self._first_s = timestamp_s
        self._count += 1
        self._frames.append((timestamp_s, data))
