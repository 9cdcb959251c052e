"""Fault seam between nodes and bus: each kind does what it says, only where it should, and repeatably."""

from __future__ import annotations

import itertools
import struct

import pytest
from bench_can_peer import AMPLIFIER, ENCODER, MS, REGULATOR, SAFETY, Bench
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from rigctl.core.errors import ConfigError
from sim_hardware.bench.can import FaultRule
from sim_hardware.bench.can.faults import FrameFaults
from sim_hardware.bench.can.frames import Frame
from sim_hardware.bench.can.scheduler import Scheduler


@pytest.fixture
def bench():
    made = Bench()
    start = [float(k) for k in range(2000)]
    made.signals.publish(2000 * MS, torque_nm=start)  # 1 N·m more each millisecond
    made.boot()
    made.run(30)
    yield made
    made.close()


def torque(frames: list[bytes]) -> list[int]:
    return [struct.unpack_from("<i", data)[0] // 100 for data in frames]


def test_drop_one_identifier_and_nothing_else(bench: Bench):
    number = bench.can.add_fault(FaultRule(kind="drop", cob_id=0x1A0))
    heard = bench.run(100)
    assert not bench.of(0x1A0, heard) and len(bench.of(0x1A2, heard)) == 100
    assert bench.can.remove_fault(number) and not bench.can.remove_fault(number)
    assert len(bench.of(0x1A0, bench.run(10))) == 10
    assert {entry.cob_id for entry in (i.before for i in bench.can.faults.log)} == {0x1A0}


def test_skip_and_count(bench: Bench):
    bench.can.add_fault(FaultRule(kind="drop", cob_id=0x1A0, skip=3, count=2))
    values = torque(bench.of(0x1A0, bench.run(10)))
    steps = [b - a for a, b in itertools.pairwise(values)]
    assert steps == [1, 1, 3, 1, 1, 1, 1]


def test_probability_is_repeatable_by_seed():
    def lost(seed: int) -> list[int]:
        bench = Bench()
        bench.signals.publish(2000 * MS, torque_nm=[float(k) for k in range(2000)])
        bench.boot()
        bench.can.add_fault(
            FaultRule(kind="drop", node=AMPLIFIER, direction="from_node", probability=0.3, seed=seed)
        )
        values = torque(bench.of(0x1A0, bench.run(300)))
        bench.close()
        return values

    first = lost(7)
    assert first == lost(7) != lost(8)
    assert 150 < len(first) < 260


def test_corrupt_flips_bits_and_says_which_in_the_log(bench: Bench):
    bench.can.add_fault(FaultRule(kind="corrupt", cob_id=0x1A0, bits=3, count=5, seed=1))
    bench.run(10)
    log = list(bench.can.faults.log)
    assert len(log) == 5
    for entry in log:
        ((after, _),) = entry.after
        changed = int.from_bytes(entry.before.data, "little") ^ int.from_bytes(after.data, "little")
        assert changed.bit_count() == 3 and len(after.data) == 8


@pytest.mark.parametrize(("corrupt", "size"), [("shorten", 5), ("lengthen", 7), ("random", 6)])
def test_corrupt_lengths(bench: Bench, corrupt: str, size: int):
    bench.can.add_fault(FaultRule.model_validate({"kind": "corrupt", "cob_id": 0x1A2, "corrupt": corrupt}))
    assert {len(data) for data in bench.of(0x1A2, bench.run(10))} == {size}


def test_a_shortened_command_is_not_taken(bench: Bench):
    bench.can.add_fault(FaultRule(kind="corrupt", cob_id=0x230, direction="to_node", corrupt="shorten"))
    bench.safety(2, 1)
    bench.run(20)
    assert bench.signals.get("relay_closed") is False
    assert bench.of(0xB0) == [bytes.fromhex("10 82 11 01 00 00 00 00")]


def test_delay_keeps_the_order(bench: Bench):
    bench.can.add_fault(FaultRule(kind="delay", cob_id=0x1A0, delay_ms=40))
    assert not bench.of(0x1A0, bench.run(39))
    values = torque(bench.of(0x1A0, bench.run(100)))
    assert {b - a for a, b in itertools.pairwise(values)} == {1}
    bench.can.clear_faults()


def test_duplicate(bench: Bench):
    bench.can.add_fault(FaultRule(kind="duplicate", cob_id=0x1A0, delay_ms=0))
    values = torque(bench.of(0x1A0, bench.run(10)))
    assert len(values) == 20 and values[::2] == values[1::2]


def test_a_duplicated_renewal_renews_once(bench: Bench):
    """The second copy, 140 ms later, must not hold the relay."""
    bench.can.add_fault(FaultRule(kind="duplicate", node=SAFETY, cob_id=0x230, delay_ms=140))
    bench.safety(2, 1)
    bench.run(160)
    assert bench.signals.get("relay_closed") is False


def test_reorder_swaps_neighbours(bench: Bench):
    bench.can.add_fault(FaultRule(kind="reorder", cob_id=0x1A0, count=1))
    values = torque(bench.of(0x1A0, bench.run(4)))  # the first millisecond brings none
    first = values[1]
    assert values == [first + 1, first, first + 2, first + 3]


def test_reorder_gives_up_waiting(bench: Bench):
    bench.can.add_fault(FaultRule(kind="reorder", node=SAFETY, cob_id=0x230, delay_ms=30, count=1))
    bench.safety(2, 1)
    bench.run(25)
    assert bench.signals.get("relay_closed") is False
    bench.run(20)
    assert bench.signals.get("relay_closed") is True


def test_mute_takes_a_node_off_the_bus_both_ways(bench: Bench):
    bench.can.add_fault(FaultRule(kind="mute", node=AMPLIFIER, duration_ms=200))
    heard = bench.run(150)
    assert not [frame for frame in heard if frame.cob_id & 0x7F == AMPLIFIER]
    with pytest.raises(TimeoutError):
        bench.read(AMPLIFIER, 0x1000)
    bench.run(60)
    assert len(bench.of(0x1A0, bench.run(10))) == 10
    assert bench.read(AMPLIFIER, 0x1000)


def test_reboot_loses_parameters_and_boots_again(bench: Bench):
    bench.u8(REGULATOR, 0x2100, 0, 1)
    bench.control(0x0007, 3277)
    bench.run(50)
    bench.can.add_fault(FaultRule(kind="reboot", node=REGULATOR, outage_ms=100))
    bench.run(1)
    assert bench.signals.get("vent") is True
    assert not [frame for frame in bench.run(98) if frame.cob_id & 0x7F == REGULATOR]
    assert bench.of(0x710, bench.run(60))[0] == b"\0"
    assert bench.number(REGULATOR, 0x2100) == 0
    assert not bench.of(0x190, bench.run(20))


def test_babble(bench: Bench):
    bench.can.add_fault(FaultRule(kind="babble", cob_id=0x000, data="8000", rate_hz=500, count=50))
    assert bench.of(0x000, bench.run(300)) == [b"\x80\x00"] * 50
    bench.can.add_fault(FaultRule(kind="babble", rate_hz=1000, duration_ms=100, seed=3))
    before = len(bench.heard)
    bench.run(200)
    known = {0x1A0, 0x1A1, 0x1A2, 0x190, 0x1B0} | {0x700 + node for node in range(128)}
    noise = [frame for frame in bench.heard[before:] if frame.cob_id not in known]
    assert 80 <= len(noise) <= 100 and len({frame.cob_id for frame in noise}) > 50


def test_commands_as_json(bench: Bench):
    number = bench.can.command({"do": "fault", "kind": "drop", "node": ENCODER})["id"]
    status = bench.can.command({"do": "status"})
    assert status["nodes"]["encoder"] == {"node": ENCODER, "state": "OPERATIONAL"}
    assert status["faults"] == {number: {"kind": "drop", "node": ENCODER, "acted": 0}}
    assert bench.can.command({"do": "remove", "id": number}) == {"removed": True}
    bench.can.command({"do": "disturb", "node": "current_input", "wire": "broken"})
    bench.can.command({"do": "power", "node": "amplifier", "on": False})
    assert bench.can.command({"do": "status"})["nodes"]["amplifier"]["state"] == "OFF"
    bench.can.command({"do": "clear"})
    assert bench.can.command({"do": "status"})["faults"] == {}


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"do": "explode"}, "explode.*Give do = fault"),
        ({"do": "power", "node": "regulator"}, "lacks a field"),
        ({"do": "power", "node": "toaster", "on": True}, "no node 'toaster'.*encoder"),
        ({"do": "power", "node": "regulator", "on": "no"}, "neither true nor false"),
        ({"do": "fault", "kind": "drop", "nodes": 3}, "nodes: Extra inputs"),
        ({"do": "fault", "kind": "mute"}, "mute needs a node"),
        ({"do": "fault", "kind": "reboot", "node": 99}, "no node 99.*0x10"),
        ({"do": "disturb", "node": "analog_output", "wire": "broken"}, "no faults of its own"),
        ({"do": "disturb", "node": "encoder", "wire": "broken"}, "unexpected keyword argument 'wire'"),
        ({"do": "disturb", "node": "current_input", "wire": "loose"}, "'loose'.*broken"),
        ({"do": "disturb", "node": "amplifier", "channel": 3, "broken": True}, "channel 3"),
    ],
)
def test_wrong_commands_are_refused_in_words(bench: Bench, request_: dict, words: str):
    with pytest.raises(ConfigError, match=words):
        bench.can.command(request_)


def test_rules_are_checked():
    for wrong in ({"kind": "melt"}, {"kind": "drop", "probability": 0}, {"kind": "babble", "data": "123"}):
        with pytest.raises(ValidationError):
            FaultRule.model_validate(wrong)


KINDS = st.sampled_from(["drop", "corrupt", "delay", "duplicate", "reorder"])
RULES = st.builds(
    FaultRule,
    kind=KINDS, probability=st.floats(0.05, 1.0), skip=st.integers(0, 3), count=st.none() | st.integers(1, 5),
    delay_ms=st.integers(0, 20), seed=st.integers(0, 99),
)  # fmt: skip


@given(st.lists(RULES, max_size=4), st.integers(1, 40))
def test_no_frame_is_lost_but_by_drop_and_none_is_born_but_by_duplicate(rules: list[FaultRule], frames: int):
    """Whatever rules are in force: after they are taken back, every frame has come or was dropped."""
    scheduler = Scheduler()
    got: list[Frame] = []
    faults = FrameFaults(scheduler, got.append, lambda node, outage: None)
    for rule in rules:
        faults.add(rule)
    for k in range(frames):
        scheduler.advance(k * MS)
        faults.carry(1, "from_node", Frame(0x181, struct.pack("<I", k)), got.append)
    faults.clear()
    scheduler.advance(10_000 * MS)
    kinds = {rule.kind for rule in rules}
    if "drop" not in kinds:
        assert len(got) >= frames
    if "duplicate" not in kinds:
        assert len(got) <= frames
    if not kinds & {"drop", "duplicate", "corrupt"}:
        assert sorted(struct.unpack("<I", frame.data)[0] for frame in got) == list(range(frames))
    assert faults.quiet
