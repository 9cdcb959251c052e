"""Our heartbeat comes before the first set-point, so that a node watches us by the time that it is commanded.

A node watches a heartbeat from the first one that it has heard: after a controller that died between its
first set-point and its first heartbeat, the output would stand for ever. A process killed in that moment:
`tests/faults/test_can_early_death.py`.
"""

from __future__ import annotations

from typing import Any

import can
import pytest
from can_worlds import OUTPUT, REGULATOR, EmulatedWorld

from drivers.can.canopen_network import FIRST_HEARTBEATS
from sim_hardware.bench.can import FaultRule

FULL_M3_H = 1000.0
HEARTBEAT, REGULATOR_RPDO, OUTPUT_RPDO = 0x701, 0x210, 0x231
FULL_AIR, DISABLED = (32767).to_bytes(2, "little"), b"\0\0\0\0"


def is_set_point(message: can.Message) -> bool:
    """Not a vent, nor full air."""
    safe = {REGULATOR_RPDO: DISABLED, OUTPUT_RPDO: FULL_AIR}.get(message.arbitration_id)
    return safe is not None and bytes(message.data) != safe


def heard(listener: can.BusABC) -> list[can.Message]:
    found: list[can.Message] = []
    while (message := listener.recv(0)) is not None:
        found.append(message)
    return found


def pressurised(world: EmulatedWorld) -> bool:
    inputs = world.signals.commands()
    return not inputs.vent and inputs.pressure_set_bar > 0.0


def air_throttled(world: EmulatedWorld) -> bool:
    return world.air_m3_h() < FULL_M3_H


DEVICES = {
    "pressure": (REGULATOR, pressurised, lambda device: device.set_pressure(10.0)),
    "ventilator": (OUTPUT, air_throttled, lambda device: device.set_flow(100.0)),
}


@pytest.fixture(params=DEVICES)
def commanded(request: pytest.FixtureRequest, wire: EmulatedWorld) -> tuple[Any, ...]:
    """World, node id, whether its output is in force, a function that commands it; the device is open."""
    node, in_force, command = DEVICES[request.param]
    device = getattr(wire, request.param)()
    device.open()
    return wire, node, lambda: in_force(wire), lambda: command(device)


def test_heartbeats_come_before_the_first_set_point(commanded: tuple[Any, ...]) -> None:
    world, _node, in_force, command = commanded
    listener = can.Bus(interface="virtual", channel=world.channel, ignore_config=True)
    try:
        world.context.lease.renew()
        command()  # in the same moment
        assert world.run_until(in_force)
        frames = heard(listener)
        first = next(number for number, message in enumerate(frames) if is_set_point(message))
        before = [message.arbitration_id for message in frames[:first]]
        assert before.count(HEARTBEAT) >= FIRST_HEARTBEATS
    finally:
        listener.shutdown()


def test_they_come_again_when_the_lease_has_lapsed(commanded: tuple[Any, ...]) -> None:
    world, _node, in_force, command = commanded
    command()
    assert world.run_until(in_force)
    assert world.run_until_idle(lambda: not in_force())
    listener = can.Bus(interface="virtual", channel=world.channel, ignore_config=True)
    try:
        world.context.lease.renew()
        command()
        assert world.run_until(in_force)
        frames = heard(listener)
        first = next(number for number, message in enumerate(frames) if is_set_point(message))
        before = [message.arbitration_id for message in frames[:first]]
        assert before.count(HEARTBEAT) >= FIRST_HEARTBEATS
    finally:
        listener.shutdown()


@pytest.mark.parametrize("slipped", range(FIRST_HEARTBEATS))
def test_gone_right_after_the_first_set_point_it_is_safe(commanded: tuple[Any, ...], slipped: int) -> None:
    """Even when all but one of the first heartbeats are lost on the way."""
    world, node, in_force, command = commanded
    if slipped:
        world.inject(kind="drop", node=node, cob_id=HEARTBEAT, direction="to_node", count=slipped)
    seen: list[bool] = []

    def die() -> None:
        """In the nodes' thread, with the very frame that puts the first set-point in force."""
        if not seen and in_force():
            seen.append(True)
            world.bench.add_fault(FaultRule(kind="drop", node=node, direction="to_node"))

    world.on_command(die)
    command()
    assert world.run_until(lambda: seen)
    assert world.run_until(lambda: not in_force()), "the node holds what a dead controller has commanded"
