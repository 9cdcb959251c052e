"""A CANopen node after CiA 301: NMT states, boot-up, heartbeat, SDO server, PDOs, emergencies.

Job: the communication part, made of raw frames. Not its job: what the device does (`Device`), the bus, time
(`scheduler`), faults of the wire (`faults`).
"""

from __future__ import annotations

import enum
from collections.abc import Callable
from typing import Any

from sim_hardware.bench.can import emergency
from sim_hardware.bench.can.datatypes import DataType, Value
from sim_hardware.bench.can.dictionary import Abort, AbortCode, Access, Entry, ObjectDictionary
from sim_hardware.bench.can.emergency import Emergencies
from sim_hardware.bench.can.frames import (
    HEARTBEAT,
    NMT,
    RPDO,
    SDO_TO_CLIENT,
    SDO_TO_SERVER,
    SYNC,
    TPDO,
    Frame,
)
from sim_hardware.bench.can.heartbeat import HeartbeatConsumer
from sim_hardware.bench.can.pdo import Mapping, Rpdo, Tpdo
from sim_hardware.bench.can.scheduler import NS_PER_MS, Scheduler, Timer
from sim_hardware.bench.can.sdo import SdoServer
from sim_hardware.bench.can.settings import NodeSettings

SDO_TIMEOUT_MS = 1000
_COMMUNICATION_AREA = (0x1000, 0x1FFF)


def _nothing() -> None:
    """Nobody wants to be told."""


class NmtState(enum.IntEnum):
    """States as they stand in the heartbeat; OFF is a device without power."""

    OFF = -1
    INITIALISING = 0
    STOPPED = 4
    OPERATIONAL = 5
    PRE_OPERATIONAL = 127


class NmtCommand(enum.IntEnum):
    """Command specifiers of the NMT service."""

    START = 1
    STOP = 2
    ENTER_PRE_OPERATIONAL = 128
    RESET_NODE = 129
    RESET_COMMUNICATION = 130


class Device:
    """What a node is for. Subclasses add objects and PDOs in `define` and answer the calls they care for.

    Attributes
    ----------
    node : Node
        Set before `define` is called.
    """

    device_type = 0
    name = "device"
    node: Node

    def define(self) -> None:
        """Add the device's objects and PDOs to the node."""
        raise NotImplementedError

    def power_on(self) -> None:
        """Parameters have their power-on values; the device is in its safe state afterwards."""

    def power_off(self) -> None:
        """Without power: outputs fall into their de-energised state."""

    def refresh(self, due_ns: int) -> None:
        """Bring the values of the dictionary up to date, for a PDO due at this time."""

    def rpdo(self, number: int) -> None:
        """Values of an RPDO have been taken."""

    def nmt_changed(self, state: NmtState) -> None:
        """The NMT state has changed."""

    def heartbeat_lost(self, node: int) -> None:
        """A watched node has fallen silent."""

    def heartbeat_back(self, node: int) -> None:
        """It is heard again."""


class Node:
    """A device on the bus.

    Parameters
    ----------
    settings : NodeSettings
    device : Device
    scheduler : Scheduler
    transmit : callable
        Puts a frame onto the bus, through the fault seam.

    Attributes
    ----------
    routes : dict of int to callable
        What to do with frames, by identifier; replaced whenever it changes.
    on_reroute : callable
        Told that it has been replaced.
    """

    def __init__(
        self, settings: NodeSettings, device: Device, scheduler: Scheduler, transmit: Callable[[Frame], None]
    ) -> None:
        self.settings, self.device, self.scheduler = settings, device, scheduler
        self.node_id = settings.node
        self.state = NmtState.OFF
        self.dictionary = ObjectDictionary()
        self.routes: dict[int, Callable[[Frame], None]] = {}
        self.on_reroute: Callable[[], None] = _nothing
        self.tpdos: list[Tpdo] = []
        self.rpdos: list[Rpdo] = []
        self._transmit = transmit
        self._boot: Timer | None = None
        self._beat: Timer | None = None
        self._sdo_timer: Timer | None = None
        self.emergencies = Emergencies(self.dictionary, self.node_id, self._send_if_talking)
        self._sdo = SdoServer(self.dictionary)
        self._consumer = HeartbeatConsumer(
            self.dictionary, scheduler, [(watch.node, watch.time_ms) for watch in settings.watched],
            lost=self._heartbeat_lost, back=self._heartbeat_back, changed=self._reroute,
        )  # fmt: skip
        self._define_communication()
        device.node = self
        device.define()
        self._reroute()

    # -- for the device ---------------------------------------------------------------------------

    def add(
        self,
        index: int,
        sub: int,
        name: str,
        kind: DataType,
        access: Access,
        default: Value = 0,
        **more: Any,
    ) -> Entry:
        """Add an object of the device; see `Entry`."""
        return self.dictionary.add(Entry(index, sub, name, kind, access, default, **more))

    def add_tpdo(self, mapping: Mapping, event_ms: int) -> Tpdo:
        """The next transmit PDO, with the identifier of the pre-defined connection set."""
        number = len(self.tpdos)
        pdo = Tpdo(
            self.dictionary, number, TPDO[number] + self.node_id, mapping, event_ms=event_ms,
            changed=self._reroute, scheduler=self.scheduler, send=self._transmit, refresh=self.device.refresh,
        )  # fmt: skip
        self.tpdos.append(pdo)
        return pdo

    def add_rpdo(self, mapping: Mapping) -> Rpdo:
        """The next receive PDO, with the identifier of the pre-defined connection set."""
        number = len(self.rpdos)
        pdo = Rpdo(
            self.dictionary, number, RPDO[number] + self.node_id, mapping,
            changed=self._reroute, received=self._rpdo_received, too_short=self._rpdo_too_short,
        )  # fmt: skip
        self.rpdos.append(pdo)
        return pdo

    @property
    def operational(self) -> bool:
        return self.state is NmtState.OPERATIONAL

    @property
    def watched_silent(self) -> bool:
        """A watched node was heard once and is silent now."""
        return bool(self._consumer.silent)

    # -- power ------------------------------------------------------------------------------------

    def power_on(self) -> None:
        """Apply power: after the boot time the node says so and is pre-operational."""
        if self.state is NmtState.OFF:
            self._reset(whole=True)

    def power_off(self) -> None:
        """Take power away at once; no last frame."""
        self._enter(NmtState.OFF)
        for timer in (self._boot, self._beat, self._sdo_timer):
            if timer is not None:
                timer.cancel()
        self.device.power_off()

    def reboot(self, outage_ms: int) -> None:
        """Power fails for a while and comes back."""
        self.power_off()
        self._boot = self.scheduler.after(outage_ms * NS_PER_MS, lambda _due: self.power_on())

    # -- frames -----------------------------------------------------------------------------------

    def receive(self, frame: Frame) -> None:
        """A frame from the bus."""
        handle = self.routes.get(frame.cob_id)
        if handle is not None:
            handle(frame)

    def _send_if_talking(self, frame: Frame) -> None:
        if self.state in (NmtState.PRE_OPERATIONAL, NmtState.OPERATIONAL):
            self._transmit(frame)

    def _reroute(self) -> None:
        """Which identifiers matter, after a change of parameters."""
        routes: dict[int, Callable[[Frame], None]] = {
            NMT: self._on_nmt,
            SYNC: self._on_sync,
            SDO_TO_SERVER + self.node_id: self._on_sdo,
        }
        for node in self._consumer.watched():
            routes[HEARTBEAT + node] = self._on_heartbeat
        for pdo in self.rpdos:
            if pdo.valid:
                routes[pdo.cob_id] = lambda frame, pdo=pdo: self._on_rpdo(pdo, frame)
        for pdo in self.tpdos:
            if pdo.valid:
                routes[pdo.cob_id] = lambda frame, pdo=pdo: self._on_remote(pdo, frame)
        self.routes = routes
        self.on_reroute()

    def _on_nmt(self, frame: Frame) -> None:
        if frame.remote or len(frame.data) < 2 or frame.data[1] not in (0, self.node_id):
            return
        if self.state in (NmtState.OFF, NmtState.INITIALISING):
            return
        command = frame.data[0]
        if command == NmtCommand.START:
            self._enter(NmtState.OPERATIONAL)
        elif command == NmtCommand.STOP:
            self._enter(NmtState.STOPPED)
        elif command == NmtCommand.ENTER_PRE_OPERATIONAL:
            self._enter(NmtState.PRE_OPERATIONAL)
        elif command in (NmtCommand.RESET_NODE, NmtCommand.RESET_COMMUNICATION):
            self._reset(whole=command == NmtCommand.RESET_NODE)

    def _on_sync(self, _frame: Frame) -> None:
        if self.operational:
            for pdo in self.rpdos:
                pdo.sync()
            for pdo in self.tpdos:
                pdo.sync()

    def _on_sdo(self, frame: Frame) -> None:
        if frame.remote or self.state not in (NmtState.PRE_OPERATIONAL, NmtState.OPERATIONAL):
            return
        self.device.refresh(self.scheduler.now_ns)
        answer = self._sdo.request(frame.data)
        if self._sdo_timer is not None:
            self._sdo_timer.cancel()
            self._sdo_timer = None
        if self._sdo.busy:
            self._sdo_timer = self.scheduler.after(SDO_TIMEOUT_MS * NS_PER_MS, self._sdo_expired)
        if answer is not None:
            self._transmit(Frame(SDO_TO_CLIENT + self.node_id, answer))

    def _sdo_expired(self, _due_ns: int) -> None:
        answer = self._sdo.expire()
        if answer is not None:
            self._send_if_talking(Frame(SDO_TO_CLIENT + self.node_id, answer))

    def _on_heartbeat(self, frame: Frame) -> None:
        if not frame.remote and len(frame.data) == 1 and self.state is not NmtState.OFF:
            self._consumer.heard(frame.cob_id - HEARTBEAT)

    def _on_rpdo(self, pdo: Rpdo, frame: Frame) -> None:
        if self.operational and not frame.remote:
            pdo.frame(frame.data)

    def _on_remote(self, pdo: Tpdo, frame: Frame) -> None:
        if frame.remote:
            pdo.remote()

    def _rpdo_received(self, number: int) -> None:
        self.emergencies.went(emergency.PDO_TOO_SHORT, number + 1)
        self.device.rpdo(number)

    def _rpdo_too_short(self, number: int) -> None:
        self.emergencies.came(emergency.PDO_TOO_SHORT, emergency.COMMUNICATION, number + 1)

    # -- states -----------------------------------------------------------------------------------

    def _enter(self, state: NmtState) -> None:
        if state is self.state:
            return
        was_operational, self.state = self.operational, state
        if was_operational:
            for pdo in self.tpdos:
                pdo.stop()
            for pdo in self.rpdos:
                pdo.forget()
        self.device.nmt_changed(state)
        if state is NmtState.OPERATIONAL:
            for pdo in self.tpdos:
                pdo.start()

    def _reset(self, *, whole: bool) -> None:
        """Reset of the node, or of its communication part alone; ends in pre-operational."""
        self._enter(NmtState.INITIALISING)
        self.dictionary.reset() if whole else self.dictionary.reset(*_COMMUNICATION_AREA)
        self._sdo.reset()
        self.emergencies.clear_all()
        self._consumer.restart()
        for pdo in (*self.tpdos, *self.rpdos):
            pdo.restart()
        if whole:
            self.device.power_on()
        for timer in (self._boot, self._beat, self._sdo_timer):
            if timer is not None:
                timer.cancel()
        self._boot = self.scheduler.after(self.settings.boot_ms * NS_PER_MS, self._booted)

    def _booted(self, _due_ns: int) -> None:
        self._transmit(Frame(HEARTBEAT + self.node_id, bytes([NmtState.INITIALISING])))
        self._enter(NmtState.PRE_OPERATIONAL)
        self._restart_heartbeat()
        if self.settings.autostart:
            self._enter(NmtState.OPERATIONAL)

    def _restart_heartbeat(self) -> None:
        if self._beat is not None:
            self._beat.cancel()
            self._beat = None
        period_ms = self._producer.number()
        if period_ms and self.state not in (NmtState.OFF, NmtState.INITIALISING):
            self._beat = self.scheduler.every(period_ms * NS_PER_MS, self._send_heartbeat)

    def _send_heartbeat(self, _due_ns: int) -> None:
        self._transmit(Frame(HEARTBEAT + self.node_id, bytes([self.state])))

    def _heartbeat_lost(self, node: int) -> None:
        if self.state in (NmtState.OFF, NmtState.INITIALISING):
            return
        self.emergencies.came(emergency.HEARTBEAT_LOST, emergency.COMMUNICATION, node)
        self.device.heartbeat_lost(node)
        behaviour = self._behaviour.number()
        if behaviour == 0 and self.operational:
            self._enter(NmtState.PRE_OPERATIONAL)
        elif behaviour == 2:
            self._enter(NmtState.STOPPED)

    def _heartbeat_back(self, node: int) -> None:
        self.emergencies.went(emergency.HEARTBEAT_LOST, node)
        self.device.heartbeat_back(node)

    # -- dictionary -------------------------------------------------------------------------------

    def _define_communication(self) -> None:
        """Objects 1000h ff that are not those of PDOs, emergencies and the heartbeat consumer."""
        settings, u32, text = self.settings, DataType.UNSIGNED32, DataType.VISIBLE_STRING
        const, add = Access.CONST, self.add
        add(0x1000, 0, "device type", u32, const, self.device.device_type)
        add(0x1005, 0, "COB-ID SYNC", u32, Access.RW, SYNC, check=self._check_sync)
        add(0x1008, 0, "device name", text, const, settings.device_name or self.device.name)
        add(0x1009, 0, "hardware version", text, const, settings.hardware_version)
        add(0x100A, 0, "software version", text, const, settings.software_version)
        self._producer = add(
            0x1017, 0, "producer heartbeat time", DataType.UNSIGNED16, Access.RW, settings.heartbeat_ms,
            written=self._restart_heartbeat,
        )  # fmt: skip
        self.dictionary.add_count(0x1018, 4)
        add(0x1018, 1, "vendor", u32, const, settings.vendor)
        add(0x1018, 2, "product code", u32, const, settings.product or self.node_id)
        add(0x1018, 3, "revision", u32, const, settings.revision)
        add(0x1018, 4, "serial number", u32, const, settings.serial)
        self.dictionary.add_count(0x1029, 1)
        self._behaviour = add(
            0x1029, 1, "behaviour on communication errors", DataType.UNSIGNED8, Access.RW, 0, high=2
        )

    @staticmethod
    def _check_sync(value: Value) -> None:
        if value != SYNC:  # these devices neither produce SYNC nor hear it elsewhere
            raise Abort(AbortCode.BAD_VALUE)
