"""The bench's CAN side: all emulated nodes on one bus, served by one thread.

Job: `BenchCan` brings frames between bus and nodes (through the fault seam), keeps their timers on real time,
and obeys commands from outside. Not its job: opening the bus, the plant, the socket that commands come from.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import can
from pydantic import ValidationError

from rigctl.core.errors import ConfigError, DeviceError
from sim_hardware.bench.can import loopback
from sim_hardware.bench.can.faults import FaultRule, FrameFaults
from sim_hardware.bench.can.frames import HIGHEST_COB_ID, Frame
from sim_hardware.bench.can.node import Device, NmtState, Node
from sim_hardware.bench.can.nodes.amplifier import Amplifier
from sim_hardware.bench.can.nodes.analog_output import AnalogOutput
from sim_hardware.bench.can.nodes.current_input import CurrentInput
from sim_hardware.bench.can.nodes.encoder import Encoder
from sim_hardware.bench.can.nodes.regulator import Regulator
from sim_hardware.bench.can.nodes.safety_io import SafetyIo
from sim_hardware.bench.can.scheduler import NS_PER_MS, Scheduler
from sim_hardware.bench.can.settings import NODE_NAMES, BenchCanSettings
from sim_hardware.bench.signals import RigSignals

_LONGEST_WAIT_S = 0.05
_BATCH = 64  # frames read before the timers are looked at again
_CALL_TIMEOUT_S = 2.0
_BUS_GONE = 200  # errors of the bus in a row


@dataclass
class Statistics:
    """Counts since the start."""

    sent: int = 0
    received: int = 0
    send_errors: int = 0
    receive_errors: int = 0


class BenchCan:
    """All nodes on one bus.

    Parameters
    ----------
    bus : can.BusABC
        Open; stays the caller's to shut down.
    signals : RigSignals
    settings : BenchCanSettings
    clock_ns : callable
        Time of the nodes; the plant's samples have it too.

    Attributes
    ----------
    nodes : dict of str to Node
    devices : dict of str to Device
        By name: regulator, amplifier, current_input, encoder, safety_io, analog_output.
    faults : FrameFaults
        While the thread runs, use `add_fault` and `clear_faults` instead.
    """

    def __init__(
        self,
        bus: can.BusABC,
        signals: RigSignals,
        settings: BenchCanSettings | None = None,
        *,
        clock_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self._bus, self._clock_ns = bus, clock_ns
        self._mark = loopback.new_mark()
        self.deaf_to_itself = loopback.drop_marked(bus, self._mark)
        self.scheduler = Scheduler(clock_ns())
        self.statistics = Statistics()
        self.faults = FrameFaults(self.scheduler, self._put, self._reboot)
        self.devices = _make_devices(settings or BenchCanSettings(), signals)
        self.nodes: dict[str, Node] = {}
        self._by_id: dict[int, Node] = {}
        for name, device in self.devices.items():
            node_settings = getattr(settings or BenchCanSettings(), name)
            node_id = node_settings.node
            node = Node(
                node_settings, device, self.scheduler, lambda frame, n=node_id: self._from_node(n, frame)
            )
            self.nodes[name] = self._by_id[node_id] = node
            node.on_reroute = self._forget_routes
        self._unheard: set[int] = set()  # identifiers of ours that no other node of ours listens to
        self._routes: dict[int, list[Node]] | None = None
        self._produced: set[int] = set()
        self._errors_in_a_row = 0
        self._posted: deque[Callable[[], None]] = deque()
        self._thread: threading.Thread | None = None
        self._stopping = threading.Event()
        self._failure: BaseException | None = None

    # -- life -----------------------------------------------------------------------------------

    def power_on(self) -> None:
        """Apply power to all nodes. `start` does it too."""
        for node in self.nodes.values():
            node.power_on()

    def start(self) -> None:
        """Apply power to all nodes and serve them in a thread of their own."""
        if self._thread is not None:
            return
        self._stopping.clear()
        self.power_on()
        self._thread = threading.Thread(target=self._serve, name="bench-can", daemon=True)
        self._thread.start()

    def wait_booted(self, timeout_s: float = 10.0) -> None:
        """Wait until every node with power has sent its boot-up message.

        Raises
        ------
        DeviceError
            One has not, within the time.
        """
        deadline_s = time.monotonic() + timeout_s
        while booting := [n for n, node in self.nodes.items() if node.state is NmtState.INITIALISING]:
            self.check()
            if time.monotonic() > deadline_s:
                raise DeviceError(
                    f"{', '.join(booting)}: no boot-up within {timeout_s:g} s.", place="bench: can",
                    remedy="Look at boot_ms in the bench file.",
                )  # fmt: skip
            time.sleep(0.002)

    def stop(self) -> None:
        """Stop the thread and take the power away: outputs fall into their de-energised state."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join(_CALL_TIMEOUT_S)
            self._thread = None
        self.faults.clear()
        for node in self.nodes.values():
            node.power_off()

    def check(self) -> None:
        """Raise what has ended the thread, if something has."""
        if self._failure is not None:
            raise DeviceError(
                f"the emulated nodes have stopped: {self._failure}.",
                place="bench: can",
                remedy="Check the bus of the bench file, then start the bench again.",
            ) from self._failure

    def advance(self, now_ns: int) -> None:
        """Without a thread: read what has arrived, then make all calls due until `now_ns`."""
        while (message := self._bus.recv(0)) is not None:
            self._from_bus(message)
        self.scheduler.advance(now_ns)

    def _serve(self) -> None:
        try:
            while not self._stopping.is_set():
                self._turn()
        except BaseException as error:
            self._failure = error
            for node in self.nodes.values():
                node.power_off()

    def _turn(self) -> None:
        """Once round: what was posted, what is due, what arrives until the next is due."""
        while self._posted:
            self._posted.popleft()()
        self.scheduler.advance(self._clock_ns())
        due_ns = self.scheduler.next_due_ns()
        wait_s = _LONGEST_WAIT_S
        if due_ns is not None:
            wait_s = max(0.0, min(wait_s, (due_ns - self._clock_ns()) * 1e-9))
        for _ in range(_BATCH):
            message = self._recv(wait_s)
            if message is None:
                return
            self._from_bus(message)
            wait_s = 0.0

    def _recv(self, wait_s: float) -> can.Message | None:
        try:
            message = self._bus.recv(wait_s)
        except can.CanError as error:
            self.statistics.receive_errors += 1
            self._errors_in_a_row += 1
            if self._errors_in_a_row > _BUS_GONE:
                raise DeviceError(f"the bus has failed: {error}", place="bench: can") from error
            return None
        self._errors_in_a_row = 0
        return message

    # -- frames ---------------------------------------------------------------------------------

    def _from_bus(self, message: can.Message) -> None:
        if message.is_extended_id or message.is_error_frame or message.arbitration_id > HIGHEST_COB_ID:
            return
        cob_id = message.arbitration_id
        if cob_id in self._produced and not message.is_remote_frame:
            return  # our own, come back from the bus
        nodes = self._listeners(cob_id)
        self.statistics.received += 1
        if nodes:
            self.scheduler.now_ns = max(self.scheduler.now_ns, self._clock_ns())
            self._deliver(Frame(cob_id, bytes(message.data), message.is_remote_frame), nodes, None)

    def _forget_routes(self) -> None:
        self._routes = None
        self._unheard.clear()

    def _listeners(self, cob_id: int) -> list[Node] | None:
        if self._routes is None:
            routes: dict[int, list[Node]] = {}
            for node in self._by_id.values():
                for known in node.routes:
                    routes.setdefault(known, []).append(node)
            self._routes = routes
        return self._routes.get(cob_id)

    def _deliver(self, frame: Frame, nodes: list[Node], sender: int | None) -> None:
        for node in tuple(nodes):
            if node.node_id == sender:
                continue
            if self.faults.quiet:
                node.receive(frame)
            else:
                self.faults.carry(node.node_id, "to_node", frame, node.receive)

    def _from_node(self, node_id: int, frame: Frame) -> None:
        if self.faults.quiet:
            if frame.cob_id in self._unheard:  # the short way for nearly all
                self._put(frame)
            else:
                self._to_bus(node_id, frame)
        else:
            self.faults.carry(node_id, "from_node", frame, lambda part: self._to_bus(node_id, part))

    def _to_bus(self, node_id: int, frame: Frame) -> None:
        self._produced.add(frame.cob_id)
        self._put(frame)
        nodes = self._listeners(frame.cob_id)
        if nodes is not None and (len(nodes) > 1 or nodes[0].node_id != node_id):
            self._deliver(frame, nodes, node_id)
        else:
            self._unheard.add(frame.cob_id)

    def _put(self, frame: Frame) -> None:
        message = can.Message(
            timestamp=self._mark, arbitration_id=frame.cob_id, is_extended_id=False,
            is_remote_frame=frame.remote, data=frame.data,
        )  # fmt: skip
        try:
            self._bus.send(message)
            self.statistics.sent += 1
        except can.CanError:
            self.statistics.send_errors += 1

    # -- from outside -----------------------------------------------------------------------------

    def call(self, action: Callable[[], Any]) -> Any:
        """Do something in the nodes' thread (or at once without one) and give its result or its error."""
        self.check()
        if self._thread is None or threading.current_thread() is self._thread:
            return action()
        done, outcome = threading.Event(), {}

        def run() -> None:
            try:
                outcome["result"] = action()
            except Exception as error:
                outcome["error"] = error
            done.set()

        self._posted.append(run)
        if not done.wait(_CALL_TIMEOUT_S):
            self.check()
            raise DeviceError(
                "the emulated nodes do not answer.", place="bench: can", remedy="Restart the bench."
            )
        if "error" in outcome:
            raise outcome["error"]
        return outcome["result"]

    def add_fault(self, rule: FaultRule) -> int:
        """Put a fault in force; its number is for `remove_fault`."""
        return self.call(lambda: self.faults.add(rule))

    def remove_fault(self, number: int) -> bool:
        """Take a fault back. False: there is none of this number."""
        return self.call(lambda: self.faults.remove(number))

    def clear_faults(self) -> None:
        """Take all frame faults back."""
        self.call(self.faults.clear)

    def disturb(self, name: str, **faults: Any) -> None:
        """A fault inside a device, e.g. ``disturb("current_input", wire="broken")``; see `disturb` there."""
        device = self.devices[self._known(name)]
        action = getattr(device, "disturb", None)
        if action is None:
            raise ConfigError(
                "this device has no faults of its own.", place=f"bench: can: {name}", value=name
            )
        try:
            self.call(lambda: action(**faults))
        except (TypeError, ValueError) as error:
            raise ConfigError(
                f"{error}.",
                place=f"bench: can: {name}",
                value=faults,
                remedy="Known faults are in the manual.",
            ) from error

    def power(self, name: str, on: bool) -> None:
        """Switch a node's supply."""
        node = self.nodes[self._known(name)]
        self.call(node.power_on if on else node.power_off)

    def command(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """A command as a JSON object, for the bench's command socket.

        ``{"do": "fault", "kind": "drop", "node": 32, …}`` (fields of `FaultRule`) gives ``{"id": n}``;
        ``{"do": "remove", "id": n}``; ``{"do": "clear"}``; ``{"do": "disturb", "node": "amplifier",
        "channel": 1, "broken": true}``; ``{"do": "power", "node": "regulator", "on": false}``; ``{"do":
        "status"}``.

        Raises
        ------
        ConfigError
            The command is not one of these.
        """
        fields = dict(request)
        action = fields.pop("do", None)
        place = "bench: can: command"
        with contextlib.suppress(KeyError):
            if action == "fault":
                return {"id": self.add_fault(_rule(fields))}
            if action == "remove":
                return {"removed": self.remove_fault(int(fields["id"]))}
            if action == "clear":
                self.clear_faults()
                return {}
            if action == "disturb":
                self.disturb(fields.pop("node"), **fields)
                return {}
            if action == "power":
                self.power(fields["node"], _switch(fields["on"]))
                return {}
            if action == "status":
                return self.call(self._status)
        raise ConfigError(
            f"{dict(request)!r} is no command or lacks a field.",
            place=place, value=action, remedy="Give do = fault, remove, clear, disturb, power or status.",
        )  # fmt: skip

    def _status(self) -> dict[str, Any]:
        rules = {
            number: rule.model_dump(exclude_defaults=True) | {"acted": acted}
            for number, (rule, acted) in self.faults.rules().items()
        }
        nodes = {name: {"node": node.node_id, "state": node.state.name} for name, node in self.nodes.items()}
        return {
            "nodes": nodes, "faults": rules, **vars(self.statistics),
            "latest_ms": self.scheduler.latest_ns / NS_PER_MS, "skipped": self.scheduler.skipped,
        }  # fmt: skip

    def _known(self, name: str) -> str:
        if name not in self.nodes:
            raise ConfigError(
                f"there is no node {name!r}.",
                place="bench: can", value=name, remedy=f"The nodes are {', '.join(self.nodes)}.",
            )  # fmt: skip
        return name

    def _reboot(self, node_id: int, outage_ms: int) -> None:
        node = self._by_id.get(node_id)
        if node is None:
            raise ConfigError(
                f"there is no node {node_id}.",
                place="bench: can: fault", value=node_id,
                remedy=f"Nodes: {', '.join(f'{n:#x}' for n in self._by_id)}.",
            )  # fmt: skip
        node.reboot(outage_ms)


def _switch(value: Any) -> bool:
    if not isinstance(value, bool):
        raise ConfigError(
            f"on = {value!r} is neither true nor false.",
            place="bench: can: power", value=value, remedy="Give true or false.",
        )  # fmt: skip
    return value


def _rule(fields: dict[str, Any]) -> FaultRule:
    try:
        return FaultRule.model_validate(fields)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(str(part) for part in first["loc"]) or "fault"
        raise ConfigError(
            f"{key}: {first['msg']}.",
            place="bench: can: fault", value=first.get("input"),
            remedy=str(first.get("ctx", {}).get("remedy", "The fields are in the devices' manual.")),
        ) from error  # fmt: skip


def _make_devices(settings: BenchCanSettings, signals: RigSignals) -> dict[str, Device]:
    delay_ns = settings.delay_ms * NS_PER_MS
    makers: dict[str, Callable[[], Device]] = {
        "regulator": lambda: Regulator(settings.regulator, signals, delay_ns),
        "amplifier": lambda: Amplifier(settings.amplifier, signals, delay_ns),
        "current_input": lambda: CurrentInput(settings.current_input, signals, delay_ns),
        "encoder": lambda: Encoder(settings.encoder, signals, delay_ns),
        "safety_io": lambda: SafetyIo(settings.safety_io, signals),
        "analog_output": lambda: AnalogOutput(settings.analog_output, signals),
    }
    return {name: makers[name]() for name in NODE_NAMES if getattr(settings, name).present}
