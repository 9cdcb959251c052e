"""Pressure actuator of kind "canopen": a pressure regulator after CiA 408 on a CAN bus.

Job: open it only when it is the right device and vents by itself when we are gone; walk its state
machine; send set-points as a PDO when they change and every 20 ms while the control loop's lease is in
force; vent when the lease lapses or anything goes wrong. The first set-point goes out after our heartbeats,
so that the regulator watches us by then. Not its job: control of the pressure (the regulator's own), limits
(the engine), the safety relay (the watchdog).

A CAN controller discards disturbed frames by their CRC; here, beyond that, a frame of a wrong length and an
actual value outside of the range never become a pressure.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from drivers.can.canopen_network import LEASE_S, canopen_network
from drivers.can.canopen_node import CanopenNode
from drivers.can.node_settings import validated
from drivers.can.objects import Scaling
from drivers.can.pdo import PdoSetup, ensure_heartbeats, ensure_pdo, ensure_value
from drivers.pressure.settings import RegulatorSettings
from rigctl.core.errors import DeviceError, RigctlError
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading, measured

EMCY_NAMES = {
    0x3120: "supply pressure low",
    0xFF01: "pressure sensor failed",
    0x8130: "our heartbeat was lost",
}
_RENEW_S = 0.02
_STALE_S = 0.1
_SILENT_S = 0.25
_SILENT_LOOKS = 3
_OPEN_S = 1.0
_VENT_FRAMES = 10  # repeats of a vent when the lease is not in force
_BAD_FRAMES = 5
_FAULT_FRAMES = 3
_LOW, _HIGH = -0.05, 1.1  # an actual value beyond these parts of the range was not measured


class CanopenPressureActuator:
    """See `rigctl.hal.devices.PressureActuator`.

    Parameters
    ----------
    settings : mapping
        `RegulatorSettings`.
    context : RigContext
    """

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        place = f"{context.place}: devices.pressure"
        self._settings = s = validated(RegulatorSettings, settings, place)
        self._network = canopen_network(context, s.bus)
        self._node = CanopenNode(
            self._network, s.node, "pressure", heartbeat_limit_s=s.silence_s,
            eds=context.folder / s.eds if s.eds else None, emcy_names=EMCY_NAMES,
            tolerated_emcy=s.tolerated_emcy,
        )  # fmt: skip
        self._board = context.board
        self._scaling = Scaling(s.range_bar, s.full_scale_counts)
        self._rpdo = PdoSetup(
            False, s.rpdo.number, s.rpdo.identifier(s.node, transmitted=False),
            (s.objects.control_word, s.objects.set_point),
        )  # fmt: skip
        self._tpdo = PdoSetup(
            True, s.tpdo.number, s.tpdo.identifier(s.node, transmitted=True),
            (s.objects.status_word, s.objects.actual), transmission=254, event_ms=s.tpdo.event_ms,
        )  # fmt: skip
        self._command, self._report = self._rpdo.codec, self._tpdo.codec
        self._lock = threading.Lock()
        self._identity: dict[str, str] = {}
        self._changed: list[str] = []
        self._ends: list[Callable[[], None]] = []
        self._opened = False
        self._forget()

    def _forget(self) -> None:
        self._vented = True
        self._counts = 0
        self._leased = False
        self._vent_frames = 0
        self._inactive_since_s: float | None = None
        self._status: int | None = None
        self._actual_counts: int | None = None
        self._reported_s = float("-inf")
        self._bad_frames = self._fault_frames = self._silent_looks = 0
        self._rate_from_s, self._reports = 0.0, 0

    # -- life -------------------------------------------------------------------------------------

    def open(self) -> None:
        """See `Device.open`. Afterwards the regulator is disabled (vented) and supervised.

        Raises
        ------
        DeviceError
            It is not there, is another device, is in a fault, or would hold the pressure without us.
        """
        s, node = self._settings, self._node
        self._forget()
        node.open(self._on_node_failure)
        try:
            node.reset()
            self._identity = node.check_identity(s.profile, s.identity)
            self._changed = self._ensure_safe()
            self._ends.append(self._network.session.subscribe(self._tpdo.cob_id, self._on_report))
            node.start()
            self._send_vent()
            self._await_disabled()
            node.watch()
            self._ends.append(self._network.cycle.add(self._renew, _RENEW_S, node.ended))
            self._opened = True
        except BaseException:
            self._leave()
            raise

    def _ensure_safe(self) -> list[str]:
        """Read back all that must hold when we are gone; set it where that is allowed."""
        s, node = self._settings, self._node
        changed = ensure_value(
            node, s.loss_reaction.object, s.loss_reaction.vent,
            "what it does when our heartbeat is lost; it must vent", configure=s.configure,
        )  # fmt: skip
        changed += ensure_heartbeats(
            node, produce_ms=s.heartbeat_ms, consume_limit_ms=s.watch_ms, configure=s.configure
        )
        changed += ensure_pdo(node, self._rpdo, configure=s.configure)
        changed += ensure_pdo(node, self._tpdo, configure=s.configure)
        return changed

    def _await_disabled(self) -> None:
        deadline_s = time.monotonic() + _OPEN_S
        words = self._settings.words
        while self._state() != words.is_disabled:
            if time.monotonic() > deadline_s:
                if self._status is None:
                    problem = f"sends no {self._tpdo.name} ({self._tpdo.cob_id:03X}h)"
                else:
                    code = self._node.read(self._settings.objects.error_code)
                    reason = f", error code {code:04X}h ({self._node.emcy_name(code)})" if code else ""
                    problem = f"does not become disabled: status word {self._status:04X}h{reason}"
                raise DeviceError(
                    f"{problem}.", place=self._node.place,
                    remedy="Remove the cause (compressed air, sensor) and open the rig anew.",
                )  # fmt: skip
            time.sleep(0.005)

    def close(self) -> None:
        """See `Device.close`: vents, waits shortly until the regulator says so, leaves it pre-operational."""
        if not self._opened:
            return
        self._opened = False
        try:
            self.vent()
            deadline_s = time.monotonic() + 0.3
            while self._state() == self._settings.words.is_active and time.monotonic() < deadline_s:
                time.sleep(0.005)
        except RigctlError:
            pass  # it is gone: its own reaction and the safety relay do the rest
        self._leave()

    def _leave(self) -> None:
        self._node.unwatch()
        while self._ends:
            self._ends.pop()()
        try:
            self._node.send_pre_operational()
        except RigctlError:
            pass  # likewise
        self._node.close()

    def identity(self) -> Mapping[str, str]:
        """What the node says in 1000h, 1008h and 1018h."""
        return dict(self._identity)

    # -- commands ---------------------------------------------------------------------------------

    @property
    def commanded_bar(self) -> float:
        """See `PressureActuator.commanded_bar`."""
        return 0.0 if self._vented else self._scaling.to_value(self._counts)

    def set_pressure(self, pressure_bar: float) -> None:
        """See `PressureActuator.set_pressure`. Takes effect while the control loop's lease is in force.

        Raises
        ------
        DeviceError
            The regulator has failed, or the pressure is outside of its range.
        """
        counts = self._scaling.to_counts(pressure_bar, self._node.place)
        self._check()
        with self._lock:
            self._counts, self._vented = counts, False
        if not self._node.emergencies:
            self._board.fault("pressure", "")
        if self._node.knows_us:
            self._send_set_point()

    def vent(self) -> None:
        """See `PressureActuator.vent`. Is sent in any case; then raises what is wrong with the regulator."""
        with self._lock:
            self._vented, self._counts, self._vent_frames = True, 0, _VENT_FRAMES
            self._inactive_since_s = None
        if self._opened or self._ends:
            self._send_vent()
            self._node.check()

    # -- readings ---------------------------------------------------------------------------------

    @property
    def actual_bar(self) -> float:
        """Newest actual value of the regulator's own sensor.

        Raises
        ------
        DeviceError
            There is none that is new and valid.
        """
        self._check()
        age_s = time.monotonic() - self._reported_s
        counts = self._actual_counts
        if counts is None or age_s > _STALE_S:
            problem = "its newest actual value is not valid" if counts is None else f"it is {age_s:.2f} s old"
            raise DeviceError(
                f"no actual value: {problem}.", place=self._node.place,
                remedy="Look at the regulator's sensor and at the bus load.",
            )  # fmt: skip
        return self._scaling.to_value(counts)

    @property
    def in_window(self) -> bool:
        """Whether the regulator says that the pressure is within its target window."""
        bit = self._settings.words.window_bit
        return bit is not None and self._is_active() and bool((self._status or 0) >> bit & 1)

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `rigctl.hal.diagnosis`."""
        self._check()
        s = self._settings
        times = measured(lambda: self._node.read(s.objects.actual), round_trips)
        found: list[Finding] = []
        if round_trips:
            reaction = self._node.read(s.loss_reaction.object)
            if reaction != s.loss_reaction.vent:
                found.append(
                    Finding(f"it holds the pressure when our heartbeat is lost ({s.loss_reaction.object} = "
                            f"{reaction}).", f"Set it to {s.loss_reaction.vent}.", unsafe=True)
                )  # fmt: skip
            found += [
                Finding(f"was set at opening: {change}.", "Store it in the device.")
                for change in self._changed
            ]
        now_s = time.monotonic()
        age_s = now_s - self._reported_s
        counts = self._actual_counts
        actual = None if counts is None else self._scaling.to_value(counts)
        rate_hz = self._reports / max(now_s - self._rate_from_s, 1e-3) if self._reports else 0.0
        fault = "" if actual is not None else "not valid"
        values = (
            Reading("actual pressure", actual, "bar", age_s=age_s, rate_hz=rate_hz, fault=fault),
            Reading("set-point", self.commanded_bar, "bar"),
            Reading("state", self._state_name(), age_s=age_s),
            Reading("in target window", self.in_window, age_s=age_s),
        )
        return Diagnosis(values, times, tuple(found), self.identity())

    # -- state machine ------------------------------------------------------------------------------

    def _check(self) -> None:
        if not self._opened:
            raise DeviceError("is not open.", place=self._node.place, remedy="Open the rig first.")
        self._node.check()

    def _state(self) -> int | None:
        return None if self._status is None else self._status & self._settings.words.mask

    def _is_active(self) -> bool:
        return self._state() == self._settings.words.is_active

    def _state_name(self) -> str:
        words = self._settings.words
        names = {
            words.is_disabled: "disabled", words.is_hold: "hold", words.is_active: "active",
            words.is_fault: "fault",
        }  # fmt: skip
        state = self._state()
        return "unknown" if state is None else names.get(state, f"{self._status:04X}h")

    def _renew(self) -> None:
        """Every 20 ms: keep the lease, repeat what is commanded, look at what the regulator does."""
        now_s = time.monotonic()
        in_force = self._network.lease_in_force()
        if in_force:
            self._leased = True
        elif self._leased:
            self._leased = False
            self._lapse()
        if self._node.failure is not None:
            return
        silent_s = now_s - self._reported_s
        # Looked at several times: after a stall of this process frames still wait to be read.
        self._silent_looks = self._silent_looks + 1 if silent_s > _SILENT_S else 0
        if self._silent_looks >= _SILENT_LOOKS:
            self._node.fail(f"has sent no {self._tpdo.name} for {silent_s:.2f} s")
        elif self._vented:
            if in_force or self._vent_frames > 0:
                self._vent_frames -= 1
                self._send_vent()
        elif in_force and self._node.knows_us:
            self._watch_activation(now_s)
            self._send_set_point()

    def _lapse(self) -> None:
        """The control loop asks for no blocks any more: what it commanded holds no longer."""
        if not self._vented:
            self._board.fault("pressure", f"vented: no block was asked for within {LEASE_S:g} s")
        with self._lock:
            self._vented, self._counts, self._vent_frames = True, 0, _VENT_FRAMES
            self._inactive_since_s = None

    def _watch_activation(self, now_s: float) -> None:
        if self._is_active():
            self._inactive_since_s = None
        elif self._inactive_since_s is None:
            self._inactive_since_s = now_s
        elif now_s - self._inactive_since_s > self._settings.activate_s:
            self._node.fail(
                f"is {self._state_name()} instead of active for {now_s - self._inactive_since_s:.1f} s"
            )

    def _send_set_point(self) -> None:
        """Disabled, then hold, then active: the next control word follows from the newest status word."""
        words = self._settings.words
        with self._lock:
            if self._vented:
                return
            ready = self._state() in (words.is_hold, words.is_active)
            data = self._command.pack(words.active if ready else words.hold, self._counts)
            self._network.session.send(self._rpdo.cob_id, data)
            if self._settings.vent_line is not None:
                line = self._settings.vent_line
                self._network.session.send(line.cob_id, bytes.fromhex(line.release))

    def _send_vent(self) -> None:
        self._network.session.send(self._rpdo.cob_id, self._command.pack(self._settings.words.disable, 0))
        line = self._settings.vent_line
        if line is not None:
            self._network.session.send(line.cob_id, bytes.fromhex(line.vent))

    def _on_node_failure(self) -> None:
        """Whatever it is: no more set-points, and a vent for as long as the bus takes it."""
        with self._lock:
            self._vented, self._counts = True, 0
        try:
            self._send_vent()
        except RigctlError:
            pass  # the failure is latched already

    # -- the bus's thread ---------------------------------------------------------------------------

    def _on_report(self, data: bytes, timestamp_s: float) -> None:
        values = self._report.unpack(data)
        scale = self._scaling.full_scale_counts
        if values is None or not _LOW * scale <= values[1] <= _HIGH * scale:
            self._actual_counts = None
            self._bad_frames += 1
            if self._bad_frames >= _BAD_FRAMES:
                self._fail_if_watched(
                    f"sends {self._bad_frames} wrong {self._tpdo.name} in a row, the last {data.hex(' ')}"
                )
            return
        self._bad_frames = 0
        self._status, self._actual_counts = values
        self._reported_s = timestamp_s
        if not self._reports:
            self._rate_from_s = timestamp_s
        self._reports += 1
        in_fault = self._state() == self._settings.words.is_fault
        self._fault_frames = self._fault_frames + 1 if in_fault else 0
        if self._fault_frames >= _FAULT_FRAMES:
            self._fail_if_watched(f"is in its state FAULT (status word {self._status:04X}h)")

    def _fail_if_watched(self, problem: str) -> None:
        if self._opened:
            self._node.fail(problem)
