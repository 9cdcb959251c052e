"""The controller's view of the safety I/O on a CAN bus: relay read-back, emergency stop, doors, enable.

Job: `CanSafetyChannel` (kind "can"): listen to the node's TPDO, publish what it says on the status board,
never show a state that is too old, and give the watchdog process everything for a channel of its own. It
sends nothing to the relay: only the watchdog does. Not its job: deciding, and the watchdog's side
(`drivers.safety_io.watchdog_link`).
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from drivers.can.bus import bus_settings
from drivers.can.session import can_session
from drivers.safety_io.settings import parse_settings
from rigctl.core.errors import ConfigError, DeviceError
from rigctl.hal.devices import RigContext, SafetyStatus
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading

LINK_TARGET = "drivers.safety_io.watchdog_link:CanSafetyLink"
STALE_S = 0.1  # ten TPDOs: the controller is not real-time, and the watchdog judges by a narrower limit
_LOOK_S = 0.02
_NMT_START_ID = 0x000
_START = 0x01
_OPEN_TIMEOUT_S = 2.0
_START_AGAIN_S = 0.2
_RELAY, _ESTOP_OK, _DOORS_OK, _ENABLED = 1, 2, 4, 8
_NAMES = ("relay", "estop", "doors", "enabled")


class CanSafetyChannel:
    """Safety channel on a CAN bus.

    Parameters
    ----------
    settings : mapping
        ``bus``: name of the rig file's bus; ``watchdog_bus``: that of the watchdog, if it has an adapter of
        its own; all other keys: `drivers.safety_io.settings.SafetyIoSettings`.
    context : RigContext

    Raises
    ------
    ConfigError
        A setting is wrong or there is no such bus.
    """

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        self._context = context
        self._place = f"{context.place}: devices.safety"
        rest = dict(settings)
        name = _bus_name(rest.pop("bus", None), f"{self._place}.bus")
        self._watchdog_bus = _bus_name(rest.pop("watchdog_bus", name), f"{self._place}.watchdog_bus")
        bus_settings(context.buses, self._watchdog_bus, context.place)
        self._io = parse_settings(rest, self._place)
        self._session = can_session(context, name)
        self._lock = threading.Lock()
        self._bits: int | None = None
        self._heard_s = float("-inf")
        self._frames = 0
        self._first_s = 0.0
        self._came = threading.Event()
        self._closing = threading.Event()
        self._unsubscribe: Callable[[], None] | None = None
        self._thread: threading.Thread | None = None

    # -- life -------------------------------------------------------------------------------------

    def open(self) -> None:
        """See `Device.open`. A node that is not operational is started; the relay stays as it is."""
        self._session.open()
        try:
            self._closing.clear()
            self._came.clear()
            self._bits, self._frames = None, 0
            self._unsubscribe = self._session.subscribe(self._io.state_cob_id, self._on_state)
            self._await_state()
        except BaseException:
            self._leave()
            raise
        self._thread = threading.Thread(target=self._watch_age, name="safety-state", daemon=True)
        self._thread.start()

    def _await_state(self) -> None:
        deadline_s = time.monotonic() + _OPEN_TIMEOUT_S
        while not self._came.wait(_START_AGAIN_S):
            self._session.check()
            if time.monotonic() > deadline_s:
                raise DeviceError(
                    f"sends no state ({self._io.state_cob_id:03X}h) within {_OPEN_TIMEOUT_S:g} s.",
                    place=self._name, remedy="Check its supply, node id and bit rate.",
                )  # fmt: skip
            self._session.send(_NMT_START_ID, bytes((_START, self._io.node)))

    def close(self) -> None:
        """See `Device.close`."""
        self._closing.set()
        if self._thread is not None:
            self._thread.join(1.0)
            self._thread = None
        self._leave()

    def _leave(self) -> None:
        if self._unsubscribe is not None:
            self._unsubscribe()
            self._unsubscribe = None
            self._session.close()
            self._context.board.fault(self._fault_name, "")

    def identity(self) -> Mapping[str, str]:
        """What is known without asking: the node's parameters are not read, the watchdog owns it."""
        return {
            "device": "safety I/O on CAN",
            "node": f"{self._io.node:02X}h",
            "bus": self._session.name,
            "watchdog_bus": self._watchdog_bus,
        }

    # -- state ------------------------------------------------------------------------------------

    def status(self) -> SafetyStatus:
        """See `SafetyChannel.status`.

        Raises
        ------
        DeviceError
            The bus has failed, or the newest state is older than `STALE_S`: what it said holds no more.
        """
        self._session.check()
        with self._lock:
            bits, age_s = self._bits, time.monotonic() - self._heard_s
        if bits is None or age_s > STALE_S:
            raise DeviceError(
                "has sent no state yet." if bits is None else f"has sent no state for {age_s * 1000:.0f} ms.",
                place=self._name, value=bits,
                remedy="Check its supply and the bus; relay, emergency stop and doors are unknown.",
            )  # fmt: skip
        return SafetyStatus(bool(bits & _RELAY), bool(bits & _ESTOP_OK), bool(bits & _DOORS_OK))

    def watchdog_link(self) -> tuple[str, Mapping[str, Any]]:
        """See `SafetyChannel.watchdog_link`."""
        bus = dict(self._context.buses[self._watchdog_bus])
        bus.pop("log", None)  # the watchdog writes its journal only
        return LINK_TARGET, {"bus_name": self._watchdog_bus, "bus": bus, "channel": self._io.to_mapping()}

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `rigctl.hal.diagnosis`. The node only talks by itself: there are no round trips."""
        self._session.check()
        with self._lock:
            bits, heard_s, frames, first_s = self._bits, self._heard_s, self._frames, self._first_s
        now_s = time.monotonic()
        age_s = now_s - heard_s
        stale = bits is None or age_s > STALE_S
        rate_hz = (frames - 1) / (heard_s - first_s) if frames > 1 else None
        states = (("relay closed", _RELAY), ("e-stop ok", _ESTOP_OK), ("doors ok", _DOORS_OK),
                  ("drive enable", _ENABLED))  # fmt: skip
        values = tuple(
            Reading(
                name, None if stale or bits is None else bool(bits & bit), age_s=age_s, rate_hz=rate_hz,
                fault="no state from the node" if stale else "",
            )
            for name, bit in states
        )  # fmt: skip
        findings: list[Finding] = []
        if bits is not None and not stale and bits & _RELAY and not bits & (_ESTOP_OK | _DOORS_OK):
            findings.append(
                Finding(
                    "the relay reads closed though the hard-wired chain is open.",
                    remedy="The relay is welded or its read-back is wrong: switch the drive off.",
                    unsafe=True,
                )
            )
        return Diagnosis(values=values, warnings=tuple(findings), identity=self.identity())

    # -- threads ----------------------------------------------------------------------------------

    def _on_state(self, data: bytes, timestamp_s: float) -> None:
        if len(data) < 2:
            return  # not this node's TPDO; the state grows old
        bits = data[0]
        with self._lock:
            changed = bits != self._bits or timestamp_s - self._heard_s > STALE_S
            self._bits, self._heard_s = bits, timestamp_s
            if self._frames == 0:
                self._first_s = timestamp_s
            self._frames += 1
        if changed:
            self._publish(bits, "")
        self._came.set()

    def _watch_age(self) -> None:
        """Take the state off the board when it has become too old."""
        told = False
        while not self._closing.wait(_LOOK_S):
            with self._lock:
                age_s = time.monotonic() - self._heard_s
            if age_s <= STALE_S:
                told = False
            elif not told:
                told = True
                self._publish(0, f"no state for {age_s * 1000:.0f} ms")

    def _publish(self, bits: int, problem: str) -> None:
        board = self._context.board
        values = zip(_NAMES, (_RELAY, _ESTOP_OK, _DOORS_OK, _ENABLED), strict=True)
        board.set(**{name: bool(bits & bit) for name, bit in values})
        board.fault(self._fault_name, problem)

    @property
    def _name(self) -> str:
        return f"safety I/O {self._io.node:02X}h on bus {self._session.name!r}"

    @property
    def _fault_name(self) -> str:
        return f"safety I/O {self._io.node:02X}h"


def _bus_name(value: Any, place: str) -> str:
    if not isinstance(value, str) or not value:
        raise ConfigError(
            f"{value!r} is no name of a bus.", place=place, value=value,
            remedy="Name a table of the rig file: [buses.NAME].",
        )  # fmt: skip
    return value
