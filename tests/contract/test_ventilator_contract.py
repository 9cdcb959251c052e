"""`Ventilator`: one suite for the CANopen driver on the emulated output and for the simulated device."""

from __future__ import annotations

import math

import pytest
from can_worlds import OUTPUT, EmulatedWorld

from rigctl.core.errors import DeviceError
from sim_hardware.bench.can import BenchCanSettings
from sim_hardware.bench.can.settings import AnalogOutputSettings

FULL_M3_H = 1000.0


def opened(world, **changes):
    ventilator = world.ventilator(**changes)
    ventilator.open()
    world.run(0.02)
    return ventilator


def reaches(world, flow_m3_h: float, timeout_s: float = 20.0) -> bool:
    return world.run_until(lambda: abs(world.air_m3_h() - flow_m3_h) < 5.0, timeout_s)


@pytest.mark.parametrize("flow_m3_h", [120.0, 999.0, 1000.0])
def test_it_blows_what_was_asked_and_stops(world, flow_m3_h):
    ventilator = opened(world)
    ventilator.set_flow(flow_m3_h)
    assert reaches(world, flow_m3_h)
    ventilator.set_flow(0.0)
    assert reaches(world, 0.0)


@pytest.mark.parametrize("nonsense", [math.nan, math.inf])
def test_nonsense_is_refused_and_changes_nothing(world, nonsense):
    ventilator = opened(world)
    ventilator.set_flow(300.0)
    assert reaches(world, 300.0)
    with pytest.raises(DeviceError, match="ventilator"):
        ventilator.set_flow(nonsense)
    world.run(0.3)
    assert abs(world.air_m3_h() - 300.0) < 5.0


def test_it_says_who_it_is(world):
    assert all(isinstance(text, str) and text for text in opened(world).identity().values())


def test_a_close_is_never_an_error(world):
    ventilator = opened(world)
    ventilator.set_flow(100.0)
    ventilator.close()


# -- the driver on the wire -------------------------------------------------------------------------------


def test_full_air_until_the_first_command_and_after_closing(wire):
    ventilator = opened(wire)
    assert wire.air_m3_h() == FULL_M3_H
    ventilator.set_flow(0.0)
    assert reaches(wire, 0.0)
    ventilator.close()
    wire.idle(0.1)
    assert wire.air_m3_h() == FULL_M3_H


def test_full_air_when_the_control_loop_stands_still(wire):
    ventilator = opened(wire)
    ventilator.set_flow(100.0)
    assert reaches(wire, 100.0)
    wire.idle(0.5)
    assert wire.air_m3_h() == FULL_M3_H
    assert ventilator.commanded_m3_h == FULL_M3_H


def test_full_air_when_our_frames_are_lost(wire):
    opened(wire).set_flow(0.0)
    assert reaches(wire, 0.0)
    wire.run_until(lambda: False, 0.4)  # a node watches our heartbeat from the first one it has heard
    wire.inject(kind="drop", node=OUTPUT, direction="to_node")
    assert reaches(wire, FULL_M3_H, 2.0)


@pytest.mark.parametrize("wrong", [{"error_mode": 0}, {"error_value": 0}])
def test_a_device_that_would_stand_still_is_refused_or_set(tmp_path, wrong):
    settings = AnalogOutputSettings.model_validate(wrong | {"watched": [{"node": 1, "time_ms": 250}]})
    world = EmulatedWorld(tmp_path, BenchCanSettings(analog_output=settings))
    try:
        with pytest.raises(DeviceError, match="must blow full air"):
            world.ventilator(configure=False).open()
        ventilator = opened(world)
        ventilator.set_flow(50.0)
        assert reaches(world, 50.0)
        world.idle(0.7)
        assert world.air_m3_h() == FULL_M3_H
    finally:
        world.close()


@pytest.mark.parametrize("flow_m3_h", [-1.0, 1000.5])
def test_beyond_its_range_it_refuses(wire, flow_m3_h):
    with pytest.raises(DeviceError, match="between 0 and 1000"):
        opened(wire).set_flow(flow_m3_h)


def test_wrong_device_is_refused(wire):
    with pytest.raises(DeviceError, match="CiA 408"):
        wire.ventilator(node=0x10).open()


@pytest.mark.parametrize(
    ("rule", "words"),
    [
        ({"kind": "mute", "node": OUTPUT}, "no heartbeat"),
        ({"kind": "reboot", "node": OUTPUT, "outage_ms": 20}, "rebooted by itself"),
    ],
)
def test_faults_are_latched_and_on_the_board(wire, rule, words):
    ventilator = opened(wire)
    ventilator.set_flow(100.0)
    wire.inject(**rule)
    assert wire.run_until(lambda: wire.fault("ventilator"), 1.5)
    assert words in wire.fault("ventilator")
    with pytest.raises(DeviceError, match=words):
        ventilator.set_flow(200.0)


def test_two_devices_share_the_bus(wire):
    actuator, ventilator = wire.pressure(), opened(wire)
    actuator.open()
    wire.run(0.1)
    actuator.set_pressure(4.0)
    ventilator.set_flow(250.0)
    assert wire.run_until(lambda: abs(wire.line_bar() - 4.0) < 0.3)
    ventilator.close()
    wire.run(0.4)
    assert actuator.actual_bar == pytest.approx(4.0, abs=0.4)
