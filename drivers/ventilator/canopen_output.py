"""Ventilator of kind "canopen": an analog output after CiA 401 that sets the air flow.

Job: open it only when it is the right device and blows full air by itself when we are gone; send the flow
as a PDO when it changes and every 100 ms while the control loop's lease is in force; full air when the lease
lapses and at closing. The first flow goes out after our heartbeats, so that the device watches us by then.
Not its job: how much air (the engine).
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Annotated, Any

from pydantic import Field

from drivers.can.canopen_network import canopen_network
from drivers.can.canopen_node import CanopenNode
from drivers.can.node_settings import Frozen, NodeSettings, PdoSettings, validated
from drivers.can.objects import ObjectRef, ObjectSetting, Scaling
from drivers.can.pdo import PdoSetup, ensure_heartbeats, ensure_pdo, ensure_value
from rigctl.core.errors import DeviceError, RigctlError
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading, measured

_RENEW_S = 0.1
_USE_ERROR_VALUE = 1  # CiA 401, 6443h


class OutputObjects(Frozen):
    """Objects of the dictionary. Defaults: CiA 401, first analog output."""

    output: ObjectSetting = ObjectRef(0x6411, 1, "i16")
    error_mode: ObjectSetting = ObjectRef(0x6443, 1, "u8")
    error_value: ObjectSetting = ObjectRef(0x6444, 1, "i32")


class OutputSettings(NodeSettings):
    """Table `[devices.ventilator]` of kind "canopen".

    Attributes
    ----------
    full_m3_h, full_scale_counts : float, int
        Air flow of `full_scale_counts`.
    profile : int
        Device profile in 1000h; 0: not compared.
    """

    full_m3_h: Annotated[float, Field(gt=0, le=1e6)]
    full_scale_counts: Annotated[int, Field(gt=0, le=32767)] = 32767
    profile: Annotated[int, Field(ge=0, le=0xFFFF)] = 401
    objects: OutputObjects = OutputObjects()
    rpdo: PdoSettings = PdoSettings()


class CanopenVentilator:
    """See `rigctl.hal.devices.Ventilator`.

    Parameters
    ----------
    settings : mapping
        `OutputSettings`.
    context : RigContext
    """

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        self._settings = s = validated(OutputSettings, settings, f"{context.place}: devices.ventilator")
        self._network = canopen_network(context, s.bus)
        self._node = CanopenNode(
            self._network, s.node, "ventilator", heartbeat_limit_s=s.silence_s,
            eds=context.folder / s.eds if s.eds else None, tolerated_emcy=s.tolerated_emcy,
        )  # fmt: skip
        self._scaling = Scaling(s.full_m3_h, s.full_scale_counts)
        self._rpdo = PdoSetup(
            False, s.rpdo.number, s.rpdo.identifier(s.node, transmitted=False), (s.objects.output,)
        )
        self._command = self._rpdo.codec
        self._lock = threading.Lock()
        self._counts: int | None = None  # None: nothing commanded, the device's own full air
        self._leased = False
        self._opened = False
        self._identity: dict[str, str] = {}
        self._changed: list[str] = []
        self._ends: list[Callable[[], None]] = []

    def open(self) -> None:
        """See `Device.open`. Afterwards the device blows full air until `set_flow`.

        Raises
        ------
        DeviceError
            It is not there, is another device, or would stand still without us.
        """
        s, node = self._settings, self._node
        self._counts, self._leased = None, False
        node.open()
        try:
            node.reset()
            self._identity = node.check_identity(s.profile, s.identity)
            self._changed = self._ensure_safe()
            node.start()
            node.watch()
            self._send(s.full_scale_counts)  # safe without our heartbeat: nobody need renew it
            self._ends.append(self._network.cycle.add(self._renew, _RENEW_S, node.ended))
            self._opened = True
        except BaseException:
            self._leave()
            raise

    def _ensure_safe(self) -> list[str]:
        s, node = self._settings, self._node
        meaning = "what it does when our heartbeat is lost; it must blow full air"
        changed = ensure_value(node, s.objects.error_mode, _USE_ERROR_VALUE, meaning, configure=s.configure)
        changed += ensure_value(
            node, s.objects.error_value, s.full_scale_counts, meaning, configure=s.configure
        )
        changed += ensure_heartbeats(
            node, produce_ms=s.heartbeat_ms, consume_limit_ms=s.watch_ms, configure=s.configure
        )
        return changed + ensure_pdo(node, self._rpdo, configure=s.configure)

    def close(self) -> None:
        """See `Device.close`: full air, then the bus is left."""
        if not self._opened:
            return
        self._opened = False
        try:
            self._send(self._settings.full_scale_counts)
        except RigctlError:
            pass  # it is gone: it blows full air by itself
        self._leave()

    def _leave(self) -> None:
        self._node.unwatch()
        while self._ends:
            self._ends.pop()()
        self._node.close()

    def identity(self) -> Mapping[str, str]:
        """What the node says in 1000h, 1008h and 1018h."""
        return dict(self._identity)

    @property
    def commanded_m3_h(self) -> float:
        """Air flow in force."""
        counts = self._settings.full_scale_counts if self._counts is None else self._counts
        return self._scaling.to_value(counts)

    def set_flow(self, flow_m3_h: float) -> None:
        """See `Ventilator.set_flow`. Takes effect while the control loop's lease is in force.

        Raises
        ------
        DeviceError
            The device has failed, or the flow is outside of its range.
        """
        counts = self._scaling.to_counts(flow_m3_h, self._node.place)
        if not self._opened:
            raise DeviceError("is not open.", place=self._node.place, remedy="Open the rig first.")
        self._node.check()
        with self._lock:
            self._counts = counts
            if self._node.knows_us:
                self._send(counts)

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `rigctl.hal.diagnosis`."""
        self._node.check()
        s, node = self._settings, self._node
        times = measured(lambda: node.read(s.objects.output), round_trips)
        found: list[Finding] = []
        values: tuple[Reading, ...] = (Reading("commanded air", self.commanded_m3_h, "m3/h"),)
        if round_trips:
            values += (Reading("output", self._scaling.to_value(node.read(s.objects.output)), "m3/h"),)
            mode, value = node.read(s.objects.error_mode), node.read(s.objects.error_value)
            if mode != _USE_ERROR_VALUE or value != s.full_scale_counts:
                found.append(
                    Finding("it does not blow full air when our heartbeat is lost "
                            f"({s.objects.error_mode} = {mode}, {s.objects.error_value} = {value}).",
                            f"Set them to {_USE_ERROR_VALUE} and {s.full_scale_counts}.", unsafe=True)
                )  # fmt: skip
            found += [
                Finding(f"was set at opening: {change}.", "Store it in the device.")
                for change in self._changed
            ]
        return Diagnosis(values, times, tuple(found), self.identity())

    def _renew(self) -> None:
        with self._lock:
            in_force = self._network.lease_in_force()
            if in_force:
                self._leased = True
                if self._counts is not None and self._node.failure is None and self._node.knows_us:
                    self._send(self._counts)
            elif self._leased:
                self._leased = False
                self._counts = None
                self._send(self._settings.full_scale_counts)

    def _send(self, counts: int) -> None:
        self._network.session.send(self._rpdo.cob_id, self._command.pack(counts))
