"""`PressureActuator`: one suite for the CANopen driver on the emulated regulator and the simulated device.

Then, for the driver alone: every fault of the wire ends in a `DeviceError` and a fault on the board, never in
a wrong value.
"""

from __future__ import annotations

import itertools
import math
import time

import can
import pytest
from can_worlds import REGULATOR, EmulatedWorld, SimulatedWorld

from rigctl.core.errors import ConfigError, DeviceError
from sim_hardware.bench.can import BenchCanSettings
from sim_hardware.bench.can.settings import RegulatorSettings


def opened(world, **changes):
    actuator = world.pressure(**changes)
    actuator.open()
    world.run(0.02)
    return actuator


def at_pressure(world, pressure_bar: float = 10.0):
    actuator = opened(world)

    def reached() -> bool:
        if actuator.commanded_bar == 0.0:  # at first, and when a stall of this machine let the lease lapse
            actuator.set_pressure(pressure_bar)
        return abs(world.line_bar() - pressure_bar) < 0.3

    assert world.run_until(reached)
    if isinstance(world, SimulatedWorld):
        world.run(1.0)
    return actuator


def assert_fails(world: EmulatedWorld, actuator, *words: str, timeout_s: float = 1.5) -> None:
    """The fault is latched, on the board, raised by every call, and the line is vented."""
    assert world.run_until(lambda: world.fault("pressure"), timeout_s)
    for call in (lambda: actuator.set_pressure(5.0), lambda: actuator.actual_bar, actuator.vent):
        with pytest.raises(DeviceError) as caught:
            call()
        for word in words:
            assert word in str(caught.value)
    assert actuator.commanded_bar == 0.0


# -- the contract -----------------------------------------------------------------------------------


def test_it_is_vented_after_open(world):
    actuator = opened(world)
    world.run(0.5)
    assert world.line_bar() < 0.5
    assert actuator.commanded_bar == 0.0


@pytest.mark.parametrize("pressure_bar", [0.5, 12.34, 40.0])
def test_it_holds_a_set_point(world, pressure_bar):
    actuator = opened(world)
    actuator.set_pressure(pressure_bar)
    world.run(0.8)
    assert world.line_bar() == pytest.approx(
        pressure_bar, abs=0.1 + 0.06 * pressure_bar
    )  # plant: scale error
    assert actuator.commanded_bar == pytest.approx(pressure_bar, abs=50 / 16384)


def test_vent_lets_the_pressure_off_until_the_next_set_point(world):
    actuator = at_pressure(world)
    actuator.vent()
    assert actuator.commanded_bar == 0.0
    assert world.run_until(lambda: world.line_bar() < 0.5)
    world.run(0.2)
    assert world.line_bar() < 0.5
    actuator.set_pressure(5.0)
    assert world.run_until(lambda: abs(world.line_bar() - 5.0) < 0.3)


def test_zero_and_vent_are_always_accepted(world):
    actuator = opened(world)
    for _ in range(3):
        actuator.vent()
        actuator.set_pressure(0.0)
    assert actuator.commanded_bar == 0.0


@pytest.mark.parametrize("nonsense", [math.nan, math.inf, -math.inf])
def test_nonsense_is_refused_and_changes_nothing(world, nonsense):
    actuator = at_pressure(world)
    with pytest.raises(DeviceError, match="pressure"):
        actuator.set_pressure(nonsense)
    world.run(0.2)
    assert world.line_bar() == pytest.approx(10.0, abs=0.3)


def test_it_says_who_it_is(world):
    assert all(isinstance(text, str) and text for text in opened(world).identity().values())


def test_close_twice_is_no_error(world):
    actuator = at_pressure(world)
    actuator.vent()
    assert world.run_until(lambda: world.line_bar() < 0.5)
    actuator.close()
    if isinstance(world, EmulatedWorld):
        actuator.close()


# -- the driver: opening ------------------------------------------------------------------------------


def test_closing_vents(wire):
    actuator = at_pressure(wire)
    actuator.close()
    time.sleep(0.2)
    assert wire.line_bar() < 0.5
    assert wire.signals.get("vent") is True


def test_it_opens_again_after_a_close(wire):
    actuator = at_pressure(wire)
    actuator.close()
    wire.idle(0.4)  # the regulator has missed our heartbeat by now
    actuator.open()
    wire.run(0.1)
    actuator.set_pressure(7.0)
    assert wire.run_until(lambda: abs(wire.line_bar() - 7.0) < 0.3)
    assert actuator.actual_bar == pytest.approx(7.0, abs=0.5)


def test_a_regulator_that_would_hold_is_refused(wire):
    actuator = wire.pressure(configure=False)
    with pytest.raises(DeviceError) as caught:
        actuator.open()
    text = str(caught.value)
    assert "2100h:0 is 0 instead of 1" in text and "must vent" in text and "configure = true" in text
    with pytest.raises(DeviceError, match="not open"):
        actuator.set_pressure(1.0)


def test_a_regulator_that_vents_and_watches_us_is_accepted_unchanged(tmp_path):
    watched = [{"node": 1, "time_ms": 250}]
    settings = RegulatorSettings.model_validate({"loss_reaction": "vent", "watched": watched})
    world = EmulatedWorld(tmp_path, BenchCanSettings(regulator=settings))
    try:
        actuator = opened(world, configure=False)
        actuator.set_pressure(3.0)
        assert world.run_until(lambda: abs(world.line_bar() - 3.0) < 0.3)
    finally:
        world.close()


def test_one_that_does_not_watch_us_is_refused(tmp_path):
    settings = RegulatorSettings.model_validate({"loss_reaction": "vent"})
    world = EmulatedWorld(tmp_path, BenchCanSettings(regulator=settings))
    try:
        with pytest.raises(DeviceError, match="watches our heartbeat not at all"):
            world.pressure(configure=False).open()
    finally:
        world.close()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"node": 0x31}, ("CiA 401", "CiA 408")),
        ({"identity": {"serial": 77}}, ("another device", "serial", "0x0000004D")),
        ({"identity": {"name": "Other"}}, ("another device", "Bench pressure regulator")),
        ({"node": 0x55}, ("node 55h", "does not answer", "power")),
        ({"objects": {"actual": "6999h:1 i16"}}, ("cannot put 6999h:1 into TPDO1", "does not exist")),
        ({"loss_reaction": {"object": "2100h:0 u16", "vent": 1}}, ("2100h:0", "1 bytes instead of 2")),
        ({"loss_reaction": {"object": "2FFFh:0 u8", "vent": 1}}, ("refuses", "2FFFh:0")),
    ],
)
def test_wrong_devices_and_settings_are_refused(wire, changes, words):
    with pytest.raises(DeviceError) as caught:
        wire.pressure(**changes).open()
    for word in words:
        assert word in str(caught.value)


def test_an_actuator_in_fault_is_refused(wire):
    wire.bench.disturb("regulator", supply_low=True)
    with pytest.raises(DeviceError, match=r"does not become disabled: status word 0200h.*compressed air"):
        wire.pressure().open()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bus": "other"}, ("no bus 'other'", "main")),
        ({"node": 200}, ("node = 200", "127")),
        ({"range_bra": 1}, ("range_bra", "range_bar")),
        ({"objects": {"actual": "6301"}}, ("objects.actual", "6300h:1 i16")),
        ({"range_bar": math.inf}, ("range_bar", "finite")),
    ],
)
def test_wrong_keys_of_the_rig_file_are_told(wire, changes, words):
    with pytest.raises(ConfigError) as caught:
        wire.pressure(**changes)
    for word in ("rig.toml", *words):
        assert word in str(caught.value)


# -- the driver: running ------------------------------------------------------------------------------


def test_nothing_is_under_pressure_before_the_control_loop_runs(wire):
    actuator = wire.pressure()
    actuator.open()
    actuator.set_pressure(10.0)
    wire.idle(0.5)
    assert wire.line_bar() < 0.5
    assert wire.run_until(lambda: abs(wire.line_bar() - 10.0) < 0.3)


def test_it_vents_when_the_control_loop_stands_still(wire):
    actuator = at_pressure(wire)
    wire.idle(0.3)
    assert actuator.commanded_bar == 0.0
    wire.idle(0.2)
    assert wire.line_bar() < 1.0
    assert "pressure" in wire.context.board.snapshot()["faults"]


def test_the_regulator_vents_by_itself_when_our_frames_are_lost(wire):
    at_pressure(wire)
    wire.inject(kind="drop", node=REGULATOR, direction="to_node")
    assert wire.run_until(lambda: wire.line_bar() < 0.5, 1.5)


def test_a_vent_line_beside_the_regulator_is_commanded_too(wire):
    listener = can.Bus(interface="virtual", channel=wire.channel, ignore_config=True)
    actuator = wire.pressure(vent_line={"cob_id": 0x241, "vent": "01", "release": "00"})
    try:
        actuator.open()
        wire.run(0.05)
        actuator.set_pressure(5.0)
        wire.run(0.1)
        actuator.vent()
        frames = []
        while (message := listener.recv(0)) is not None:
            frames += [bytes(message.data)] if message.arbitration_id == 0x241 else []
    finally:
        listener.shutdown()
    assert [data for data, _ in itertools.groupby(frames)] == [b"\x01", b"\x00", b"\x01"]


def test_actual_value_and_window(wire):
    actuator = at_pressure(wire)
    assert wire.run_until(lambda: actuator.in_window)
    assert actuator.actual_bar == pytest.approx(10.0, abs=0.4)


@pytest.mark.parametrize("pressure_bar", [-0.1, 50.1])
def test_beyond_its_range_it_refuses(wire, pressure_bar):
    with pytest.raises(DeviceError, match="between 0 and 50"):
        opened(wire).set_pressure(pressure_bar)


def test_diagnosis_has_values_round_trips_and_what_was_set(wire):
    diagnosis = opened(wire).diagnose(5)
    assert {reading.name for reading in diagnosis.values} >= {"actual pressure", "set-point", "state"}
    assert len(diagnosis.round_trip_s) == 5
    assert any("2100h" in finding.problem for finding in diagnosis.warnings)


# -- the driver: faults of the wire ---------------------------------------------------------------------


def test_node_falls_silent(wire):
    actuator = at_pressure(wire)
    wire.inject(kind="mute", node=REGULATOR)
    assert_fails(wire, actuator, "has sent no")
    assert wire.run_until(lambda: wire.line_bar() < 0.5, 1.5)


def test_heartbeat_is_lost_while_values_still_come(wire):
    actuator = at_pressure(wire)
    wire.inject(kind="drop", node=REGULATOR, cob_id=0x700 + REGULATOR, direction="from_node")
    assert_fails(wire, actuator, "no heartbeat", "others still talk")


def test_values_are_lost_while_heartbeats_still_come(wire):
    actuator = at_pressure(wire)
    wire.inject(kind="drop", node=REGULATOR, cob_id=0x190, direction="from_node")
    assert_fails(wire, actuator, "no TPDO1")


def test_node_reboots(wire):
    actuator = at_pressure(wire)
    wire.inject(kind="reboot", node=REGULATOR, outage_ms=20)
    assert_fails(wire, actuator, "rebooted by itself")
    assert wire.run_until(lambda: wire.line_bar() < 0.5, 1.0)


def test_emergency(wire):
    actuator = at_pressure(wire)
    wire.bench.disturb("regulator", supply_low=True)
    assert_fails(wire, actuator, "3120h", "supply pressure low")


def test_failed_sensor_is_no_pressure(wire):
    actuator = at_pressure(wire)
    wire.bench.disturb("regulator", sensor_failed=True)
    assert_fails(wire, actuator, "FF01h", "pressure sensor failed")


@pytest.mark.parametrize("corrupt", ["shorten", "lengthen"])
def test_frames_of_a_wrong_length_are_no_pressure(wire, corrupt):
    actuator = at_pressure(wire)
    wire.inject(kind="corrupt", cob_id=0x190, direction="from_node", corrupt=corrupt)
    assert_fails(wire, actuator, "wrong TPDO1")


def test_single_corrupted_frames_are_left_out(wire):
    actuator = at_pressure(wire)
    wire.inject(
        kind="corrupt", cob_id=0x190, direction="from_node", corrupt="shorten", probability=0.2, seed=3
    )
    values = []
    for _ in range(40):
        wire.run(0.02)
        try:
            values.append(actuator.actual_bar)
        except DeviceError as error:
            assert "no actual value" in str(error)
    assert len(values) > 10 and all(abs(value - 10.0) < 0.4 for value in values)
    assert not wire.fault("pressure")


def test_foreign_frames_do_not_disturb(wire):
    actuator = at_pressure(wire)
    for cob_id in (0x790, 0x081, 0x600):
        wire.inject(kind="babble", cob_id=cob_id, rate_hz=200)
    wire.run(0.4)
    assert wire.line_bar() == pytest.approx(10.0, abs=0.3)
    assert actuator.actual_bar == pytest.approx(10.0, abs=0.4)


def test_garbage_in_place_of_heartbeats_and_emergencies(wire):
    actuator = at_pressure(wire)
    for cob_id, data in ((0x710, ""), (0x710, "0505"), (0x090, "2031"), (0x590, "43")):
        wire.inject(kind="babble", cob_id=cob_id, data=data, rate_hz=100)
    wire.run(0.4)
    assert actuator.actual_bar == pytest.approx(10.0, abs=0.4)
    assert not wire.context.board.snapshot().get("faults")


def test_lost_answers_of_parameters_are_asked_again(wire):
    wire.inject(kind="drop", cob_id=0x590, direction="from_node", skip=3, count=2)
    opened(wire)


def test_late_answers_are_not_taken_for_others(wire):
    wire.inject(kind="delay", cob_id=0x590, direction="from_node", delay_ms=250, skip=4, count=1)
    actuator = wire.pressure()
    try:
        actuator.open()
    except DeviceError as error:
        assert "node 10h" in str(error)
    else:
        assert actuator.identity()["serial"] == "0x00000001"


def test_a_second_controller_is_noticed(wire):
    actuator = at_pressure(wire)
    wire.inject(kind="babble", cob_id=0x701, data="05", rate_hz=10)
    assert_fails(wire, actuator, "another controller")


def test_the_bus_is_gone(wire):
    actuator = at_pressure(wire)
    session = wire.context.share("can:main", lambda: None)
    session._bus.shutdown()  # what a pulled adapter looks like
    assert wire.run_until(lambda: wire.context.board.snapshot().get("faults"), 2.0)
    with pytest.raises(DeviceError, match="bus 'main'"):
        actuator.set_pressure(5.0)
    assert wire.run_until(lambda: wire.line_bar() < 0.5, 1.5)
    actuator.close()
