"""The real watchdog on a real CAN bus against faults of bus, nodes, sensors and processes.

Each fault must open the relay of the emulated safety I/O in time and leave its first cause in the journal.
Times are printed (pytest -s); bounds: 150 ms is the relay's own, 250 ms is T1 of the fault catalogue, with a
reserve for the load of the machine that runs the tests.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator

import can
import pytest
from can_safety_bench import CanRig, CanWatchdog

from sim_hardware.bench.can import FaultRule

RELAY_S = 0.150
RESERVE_S = 0.060
T1_S = 0.250


@pytest.fixture
def rig() -> Iterator[CanRig]:
    with CanRig() as new:
        yield new


@pytest.fixture
def armed(rig: CanRig) -> Iterator[CanWatchdog]:
    with CanWatchdog(rig) as new:
        yield new.arm()


def opened_within(watch: CanWatchdog, since_s: float, limit_s: float, what: str) -> None:
    after_s = watch.rig.opened_after(since_s)
    print(f"{what}: relay open after {after_s * 1000:.0f} ms")
    assert after_s <= limit_s + RESERVE_S


# -- processes --------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_dead_or_frozen_watchdog_opens_the_relay_by_silence(armed: CanWatchdog, number: int) -> None:
    assert armed.watchdog is not None and armed.controller is not None
    since_s = time.monotonic()
    armed.watchdog.send_signal(number)
    opened_within(armed, since_s, RELAY_S, f"watchdog {signal.Signals(number).name}")
    armed.wait_for(lambda: "stopped" in armed.logs(), "the controller notices")
    if number == signal.SIGSTOP:
        assert "the watchdog has been silent" in armed.logs()
        armed.watchdog.send_signal(signal.SIGCONT)
        assert armed.trip()["cause"] in ("samples_late", "heartbeat_late", "controller_gone")
        time.sleep(0.3)
    assert not armed.rig.relay


def test_killed_controller(armed: CanWatchdog) -> None:
    assert armed.controller is not None
    since_s = time.monotonic()
    armed.controller.kill()
    opened_within(armed, since_s, 0.1, "controller killed")
    assert armed.trip()["cause"] == "controller_gone"


def test_frozen_controller(armed: CanWatchdog) -> None:
    assert armed.controller is not None
    since_s = time.monotonic()
    armed.controller.send_signal(signal.SIGSTOP)
    opened_within(armed, since_s, T1_S, "controller frozen")
    trip = armed.trip()
    assert trip["cause"] == "heartbeat_late"
    assert trip["heartbeat_k"] >= 100_000 > trip["k"]  # numbers of their own


# -- bus and safety I/O -----------------------------------------------------------------------------


def test_muted_bus(armed: CanWatchdog) -> None:
    since_s = time.monotonic()
    for node in (0x10, 0x20, 0x21, 0x22, 0x30, 0x31):
        armed.rig.can.add_fault(FaultRule(kind="mute", node=node))
    opened_within(armed, since_s, RELAY_S, "bus muted")
    trip = armed.trip()
    assert trip["cause"] == "safety_channel" and "the bus is silent" in trip["words"]


def test_safety_node_muted(armed: CanWatchdog) -> None:
    since_s = time.monotonic()
    armed.rig.can.add_fault(FaultRule(kind="mute", node=0x30))
    opened_within(armed, since_s, RELAY_S, "safety I/O muted")
    trip = armed.trip()
    assert trip["cause"] == "safety_channel" and "(node 30h) is silent" in trip["words"]


def test_commands_do_not_reach_the_node(armed: CanWatchdog) -> None:
    since_s = time.monotonic()
    armed.rig.can.add_fault(FaultRule(kind="drop", cob_id=0x230, direction="to_node"))
    opened_within(armed, since_s, RELAY_S, "commands lost")
    trip = armed.trip()
    assert trip["cause"] == "safety_channel" and "does not take commands" in trip["words"]


@pytest.mark.parametrize("node", [0x30, 0x20])
def test_rebooted_node(armed: CanWatchdog, node: int) -> None:
    since_s = time.monotonic()
    armed.rig.can.add_fault(FaultRule(kind="reboot", node=node, outage_ms=20))
    opened_within(armed, since_s, T1_S, f"node {node:02X}h rebooted")
    trip = armed.trip()
    assert trip["cause"] in ("safety_channel", "pressure_invalid", "torque_invalid")
    if node == 0x30:
        assert trip["cause"] == "safety_channel"
    time.sleep(1.0)  # the node is operational again, and the relay stays open
    assert not armed.rig.relay and "trip" in armed.kinds()


def test_second_sender_of_the_relays_command(armed: CanWatchdog) -> None:
    arguments = {key: value for key, value in armed.rig.table.items() if key != "interface"}
    with can.Bus(interface="udp_multicast", **arguments) as intruder:
        since_s = time.monotonic()
        intruder.send(can.Message(arbitration_id=0x230, data=bytes((1, 7, 0, 0)), is_extended_id=False))
        opened_within(armed, since_s, 0.1, "second sender")
    trip = armed.trip()
    assert trip["cause"] == "safety_channel" and "somebody else" in trip["words"]


def test_emergency_stop(armed: CanWatchdog) -> None:
    since_s = time.monotonic()
    armed.rig.signals.set(estop_ok=False)
    opened_within(armed, since_s, 0.1, "e-stop")
    assert armed.trip()["cause"] == "estop"


def test_doors(armed: CanWatchdog) -> None:
    since_s = time.monotonic()
    armed.rig.signals.set(doors_ok=False)
    opened_within(armed, since_s, 0.1, "doors")
    assert armed.trip()["cause"] == "doors"


def test_welded_relay(armed: CanWatchdog) -> None:
    armed.rig.can.disturb("safety_io", welded=True)
    armed.rig.signals.set(doors_ok=False)
    assert armed.trip()["cause"] == "doors"
    armed.wait_for(lambda: "further_cause" in armed.kinds(), "further cause")
    further = next(record for record in armed.records() if record.kind == "further_cause")
    assert further.payload["cause"] == "relay_welded"
    assert "safe_state_reached" not in armed.kinds()


# -- sensors ----------------------------------------------------------------------------------------


def torque_and_pressure_silent(rig: CanRig) -> None:
    rig.can.add_fault(FaultRule(kind="drop", cob_id=0x1A0, direction="from_node"))


def speed_silent(rig: CanRig) -> None:
    rig.can.add_fault(FaultRule(kind="drop", cob_id=0x1A2, direction="from_node"))


def temperature_silent(rig: CanRig) -> None:
    rig.can.add_fault(FaultRule(kind="drop", cob_id=0x1A1, direction="from_node"))


def too_short(rig: CanRig) -> None:
    rig.can.add_fault(FaultRule(kind="corrupt", cob_id=0x1A2, direction="from_node", corrupt="shorten"))


def wire_break(rig: CanRig) -> None:
    rig.can.disturb("current_input", wire="broken")


def over_pressure(rig: CanRig) -> None:
    rig.plant["pressure_bar"] = 45.0


@pytest.mark.parametrize(
    ("inject", "cause"),
    [
        (torque_and_pressure_silent, "pressure_invalid"),
        (speed_silent, "speed_invalid"),
        (temperature_silent, "temperature_invalid"),
        (too_short, "speed_invalid"),
        (wire_break, "temperature_invalid"),
        (over_pressure, "pressure_peak"),
    ],
    ids=lambda value: value if isinstance(value, str) else value.__name__,
)
def test_sensor(armed: CanWatchdog, inject: Callable[[CanRig], None], cause: str) -> None:
    since_s = time.monotonic()
    inject(armed.rig)
    opened_within(armed, since_s, T1_S, inject.__name__)
    assert armed.trip()["cause"] == cause


def test_frozen_sensor(armed: CanWatchdog) -> None:
    armed.rig.plant.update(pressure_bar=20.0, speed_rpm=40.0, torque_nm=380.0)
    time.sleep(0.3)
    assert "trip" not in armed.kinds(), armed.trip()
    amplifier = armed.rig.can.devices["amplifier"]
    read = amplifier._signals.at  # type: ignore[attr-defined]
    since_s = time.monotonic()
    constant = {"torque_nm": 381.0}
    amplifier._signals = _Frozen(read, constant)  # type: ignore[attr-defined]
    opened_within(armed, since_s, 1.25, "torque frozen")
    assert armed.trip()["cause"] == "torque_frozen"


class _Frozen:
    """Signals of which one stands still."""

    def __init__(self, at: Callable[[str, int], float], constant: dict[str, float]) -> None:
        self._at, self._constant = at, constant

    def at(self, name: str, t_ns: int) -> float:
        """The value, or the constant."""
        return self._constant.get(name, self._at(name, t_ns))

    def newest(self, name: str) -> float:
        """Never asked for in a PDO, but part of the interface."""
        return self._constant.get(name, self._at(name, 0))
