"""Boot-up, NMT states, heartbeats both ways, emergencies: raw frames written from CiA 301."""

from __future__ import annotations

import itertools
import struct

import pytest
from bench_can_peer import ALL, AMPLIFIER, ENCODER, REGULATOR, SAFETY, Bench

from sim_hardware.bench.can import BenchCanSettings
from sim_hardware.bench.can.settings import AmplifierSettings, RegulatorSettings, WatchSettings

HEARTBEAT_LOST_BY_1 = bytes.fromhex("30 81 11 01 00 00 00 00")
NO_ERROR = bytes.fromhex("00 00 00 00 00 00 00 00")


@pytest.fixture
def bench():
    made = Bench()
    yield made
    made.close()


def test_every_node_boots_once_and_then_beats_pre_operational(bench: Bench):
    bench.can.power_on()
    assert not bench.run(49)
    assert {(frame.cob_id, frame.data) for frame in bench.run(1)} == {(0x700 + node, b"\0") for node in ALL}
    heard = bench.run(300)
    for node in ALL:
        beats = [frame for frame in heard if frame.cob_id == 0x700 + node]
        assert [frame.data for frame in beats] == [b"\x7f"] * 3
        assert [b.t_ms - a.t_ms for a, b in itertools.pairwise(beats)] == [100, 100]
    assert {frame.cob_id >> 7 for frame in heard} == {0x700 >> 7}  # no PDO before somebody says start


@pytest.mark.parametrize(("command", "state"), [(1, 5), (2, 4), (128, 127)])
def test_nmt_commands_are_seen_in_the_heartbeat(bench: Bench, command: int, state: int):
    bench.boot(operational=False)
    bench.nmt(command, AMPLIFIER)
    heard = bench.run(100)
    assert bench.of(0x720, heard) == [bytes([state])]
    assert bench.of(0x710, heard) == [b"\x7f"]  # addressed to the amplifier alone


def test_pdos_only_while_operational(bench: Bench):
    bench.boot()
    assert len(bench.of(0x1A0, bench.run(20))) == 20
    bench.nmt(2)
    assert not [frame for frame in bench.run(99) if frame.cob_id < 0x580]
    bench.nmt(1)
    assert bench.of(0x1A0, bench.run(20))
    bench.nmt(128)
    assert not [frame for frame in bench.run(50) if frame.cob_id < 0x580]


@pytest.mark.parametrize("command", [129, 130])
def test_reset_boots_anew_and_brings_the_parameters_back(bench: Bench, command: int):
    bench.boot(operational=False)
    bench.u16(REGULATOR, 0x1017, 0, 500)
    bench.u32(REGULATOR, 0x1016, 1, 1 << 16 | 250)
    bench.u8(REGULATOR, 0x2100, 0, 1)
    bench.send(0x000, bytes([command, REGULATOR]))
    assert bench.of(0x710, bench.run(60)) == [b"\0"]
    assert bench.number(REGULATOR, 0x1017) == 100
    assert bench.number(REGULATOR, 0x1016, 1) == 0
    assert bench.number(REGULATOR, 0x2100) == (0 if command == 129 else 1)  # communication alone leaves it


@pytest.mark.parametrize("data", [b"", b"\x01", bytes([77, 0]), bytes([1, 5])])
def test_nmt_frames_for_nobody_change_nothing(bench: Bench, data: bytes):
    bench.boot(operational=False)
    bench.send(0x000, data)
    bench.run(5)
    assert {node.state.name for node in bench.can.nodes.values()} == {"PRE_OPERATIONAL"}


def test_heartbeat_time_zero_silences(bench: Bench):
    bench.boot(operational=False)
    bench.u16(ENCODER, 0x1017, 0, 0)
    assert not bench.of(0x722, bench.run(500))
    bench.u16(ENCODER, 0x1017, 0, 20)
    assert len(bench.of(0x722, bench.run(200))) == 10


def test_watching_begins_with_the_first_heartbeat(bench: Bench):
    bench.boot(operational=False)
    bench.u32(SAFETY, 0x1016, 1, 1 << 16 | 100)
    assert not bench.of(0xB0, bench.run(1000))
    bench.send(0x701, b"\x05")
    assert not bench.of(0xB0, bench.run(100))
    assert bench.of(0xB0, bench.run(3)) == [HEARTBEAT_LOST_BY_1]


def test_lost_heartbeat_is_told_registered_and_taken_back(bench: Bench):
    bench.boot(operational=False)
    bench.u32(REGULATOR, 0x1016, 1, 1 << 16 | 50)
    bench.nmt(1)
    bench.heartbeat_ms = 25
    bench.run(200)
    assert not bench.of(0x90)
    bench.heartbeat_ms = 0
    bench.run(100)
    assert bench.of(0x90) == [HEARTBEAT_LOST_BY_1]
    assert bench.can.nodes["regulator"].state.name == "PRE_OPERATIONAL"  # 1029h:1 = 0
    assert bench.number(REGULATOR, 0x1001) == 0x11
    assert bench.number(REGULATOR, 0x1003, 0) == 1
    assert bench.number(REGULATOR, 0x1003, 1) == 0x00018130
    bench.heartbeat_ms = 25
    bench.run(30)
    assert bench.of(0x90) == [HEARTBEAT_LOST_BY_1, NO_ERROR]
    assert bench.number(REGULATOR, 0x1001) == 0
    bench.u8(REGULATOR, 0x1003, 0, 0)
    assert bench.number(REGULATOR, 0x1003, 0) == 0


@pytest.mark.parametrize(("behaviour", "state"), [(0, "PRE_OPERATIONAL"), (1, "OPERATIONAL"), (2, "STOPPED")])
def test_error_behaviour(bench: Bench, behaviour: int, state: str):
    bench.boot(operational=False)
    bench.u32(AMPLIFIER, 0x1016, 1, 1 << 16 | 50)
    bench.u8(AMPLIFIER, 0x1029, 1, behaviour)
    bench.nmt(1)
    bench.send(0x701, b"\x05")
    bench.run(60)
    assert bench.can.nodes["amplifier"].state.name == state


def test_nodes_may_watch_each_other_and_settings_may_say_so():
    settings = BenchCanSettings(
        amplifier=AmplifierSettings(heartbeat_ms=50, autostart=True),
        regulator=RegulatorSettings(watched=(WatchSettings(node=AMPLIFIER, time_ms=120),)),
    )
    bench = Bench(settings).boot(operational=False)
    assert bench.of(0x1A0, bench.run(10))  # starts by itself
    bench.run(300)
    bench.can.power("amplifier", False)
    bench.run(200)
    assert bench.of(0x90) == [bytes.fromhex("30 81 11 20 00 00 00 00")]
    bench.close()


def test_emergency_identifier_may_be_switched_off(bench: Bench):
    bench.boot(operational=False)
    bench.u32(REGULATOR, 0x1014, 0, 0x80000090)
    bench.can.disturb("regulator", supply_low=True)
    assert not bench.of(0x90, bench.run(20))
    assert bench.number(REGULATOR, 0x1001) & 0x21 == 0x21
    bench.u32(REGULATOR, 0x1014, 0, 0x91)
    bench.can.disturb("regulator", supply_low=False)
    assert bench.of(0x91, bench.run(20)) == [NO_ERROR]


def test_a_node_without_power_is_silent_and_deaf(bench: Bench):
    bench.boot()
    bench.can.power("encoder", False)
    heard = bench.run(300)
    assert not [frame for frame in heard if frame.cob_id & 0x7F == ENCODER]
    with pytest.raises(TimeoutError):
        bench.read(ENCODER, 0x1000)
    bench.can.power("encoder", True)
    assert bench.of(0x722, bench.run(60))[0] == b"\0"
    bench.nmt(1)
    assert bench.of(0x1A2, bench.run(5))


def test_a_short_rpdo_is_told_and_not_taken(bench: Bench):
    bench.boot()
    bench.control(7, 1000)
    bench.run(30)
    bench.send(0x210, struct.pack("<H", 0))
    assert bench.of(0x90, bench.run(20)) == [bytes.fromhex("10 82 11 01 00 00 00 00")]
    assert bench.signals.get("pressure_set_bar") == pytest.approx(1000 / 16384 * 50)
    bench.control(7, 1000)
    assert bench.of(0x90, bench.run(5)) == [NO_ERROR]
