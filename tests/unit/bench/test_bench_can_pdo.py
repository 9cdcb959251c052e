"""PDOs of the emulated nodes: timing, mapping by the standard's procedure, SYNC, remote request, layouts."""

from __future__ import annotations

import itertools
import struct

import pytest
from bench_can_peer import AMPLIFIER, CURRENT, ENCODER, MS, REGULATOR, Bench, SdoAborted
from hypothesis import given
from hypothesis import strategies as st

from sim_hardware.bench.can.datatypes import DataType, limits
from sim_hardware.bench.can.dictionary import Access, Entry
from sim_hardware.bench.can.pdo import Layout


@pytest.fixture
def bench():
    made = Bench(torque_nm=123.456, pressure_bar=12.3456, position_turns=1.5, speed_rpm=40.04)
    made.boot(operational=False)
    yield made
    made.close()


def refused(code: int):
    return pytest.raises(SdoAborted, match=f"{code:08X}")


@pytest.mark.parametrize(
    ("cob_id", "period_ms", "size"),
    [(0x190, 10, 4), (0x1A0, 1, 8), (0x1A1, 10, 3), (0x1A2, 1, 6), (0x1B0, 10, 2)],
)
def test_periods_and_lengths_of_the_table(bench: Bench, cob_id: int, period_ms: int, size: int):
    bench.nmt(1)
    bench.run(20)
    frames = [frame for frame in bench.run(200) if frame.cob_id == cob_id]
    assert {len(frame.data) for frame in frames} == {size}
    steps = {b.t_ms - a.t_ms for a, b in itertools.pairwise(frames)}
    assert steps == {period_ms}


def test_values_of_the_fast_pdos(bench: Bench):
    bench.nmt(1)
    assert bench.of(0x1A0)[-1] == struct.pack("<ii", 12346, 123456)
    assert bench.of(0x1A2)[-1] == struct.pack("<Ih", 6144, 400)


def test_each_pdo_carries_the_sample_of_its_own_millisecond(bench: Bench):
    """The plant publishes 10 ms at once; late turns of the thread must not repeat or lose a sample."""
    bench.nmt(1)
    ramp = []
    for step in range(30):
        first = bench.t_ms
        bench.signals.publish((first + 10) * MS, torque_nm=[float(first + k) for k in range(10)])
        if step % 3 == 2:  # the thread is held up for 10 ms
            bench.t_ns += 10 * MS
            bench.signals.publish((first + 20) * MS, torque_nm=[float(first + 10 + k) for k in range(10)])
            ramp += bench.of(0x1A0, bench.run(1))
            ramp += bench.of(0x1A0, bench.run(9))
        else:
            ramp += bench.of(0x1A0, bench.run(10))
    values = [struct.unpack_from("<i", data)[0] / 100 for data in ramp][40:]
    assert {b - a for a, b in itertools.pairwise(values)} == {1.0}


def test_event_time_may_be_changed_and_switched_off(bench: Bench):
    bench.u16(AMPLIFIER, 0x1800, 5, 20)
    bench.nmt(1)
    bench.run(20)
    assert len(bench.of(0x1A0, bench.run(200))) == 10
    bench.u16(AMPLIFIER, 0x1800, 5, 0)
    assert not bench.of(0x1A0, bench.run(100))


def test_remote_request(bench: Bench):
    bench.u16(REGULATOR, 0x1800, 5, 0)
    bench.nmt(1)
    bench.send(0x190, remote=True)
    assert len(bench.of(0x190, bench.run(2))) == 1
    bench.u32(REGULATOR, 0x1800, 1, 0x40000190)  # no remote requests
    bench.send(0x190, remote=True)
    bench.run(1)
    assert not bench.of(0x190, bench.run(5))


def test_sync_every_third_and_on_change(bench: Bench):
    bench.u8(AMPLIFIER, 0x1800, 2, 3)
    bench.nmt(1)
    for _ in range(9):
        bench.send(0x080)
        bench.run(5)
    assert len(bench.of(0x1A0)) == 3


def test_rpdo_with_sync_waits_for_it(bench: Bench):
    bench.u8(REGULATOR, 0x1400, 2, 1)
    bench.nmt(1)
    bench.control(7, 8192)
    bench.run(40)
    assert bench.number(REGULATOR, 0x6300, 1) == 0
    bench.send(0x080)
    bench.run(40)
    assert bench.number(REGULATOR, 0x6300, 1) == 8192


def test_remapping_by_the_procedure_of_the_standard(bench: Bench):
    node = CURRENT
    bench.u32(node, 0x1800, 1, 0x800001A1)
    bench.u8(node, 0x1A00, 0, 0)
    bench.u32(node, 0x1A00, 1, 0x61500108)
    bench.u32(node, 0x1A00, 2, 0x71300110)
    bench.u32(node, 0x1A00, 3, 0x10010008)
    bench.u8(node, 0x1A00, 0, 3)
    bench.u32(node, 0x1800, 1, 0x000002A1)
    bench.nmt(1)
    heard = bench.run(20)
    assert not bench.of(0x1A1, heard)
    assert bench.of(0x2A1, heard)[0] == struct.pack("<BHB", 0, 4000 + round(20 / 600 * 16000), 0)


def test_what_the_standard_forbids_of_mappings(bench: Bench):
    with refused(0x08000022):  # the PDO is valid
        bench.u8(AMPLIFIER, 0x1A00, 0, 0)
    with refused(0x06090030):  # its identifier stays while it is valid
        bench.u32(AMPLIFIER, 0x1800, 1, 0x2A0)
    bench.u32(AMPLIFIER, 0x1800, 1, 0x800001A0)
    with refused(0x08000022):  # entries while the count is not zero
        bench.u32(AMPLIFIER, 0x1A00, 1, 0x61500108)
    bench.u8(AMPLIFIER, 0x1A00, 0, 0)
    with refused(0x06020000):
        bench.u32(AMPLIFIER, 0x1A00, 1, 0x77000108)
    with refused(0x06040041):  # wrong length
        bench.u32(AMPLIFIER, 0x1A00, 1, 0x61500110)
    with refused(0x06040041):  # not mappable
        bench.u32(AMPLIFIER, 0x1A00, 1, 0x61320108)
    bench.u32(AMPLIFIER, 0x1A00, 3, 0x61500108)
    with refused(0x06040042):  # 72 bits
        bench.u8(AMPLIFIER, 0x1A00, 0, 3)
    for restricted in (0x000, 0x07F, 0x101, 0x581, 0x601, 0x701, 0x7FF, 0x20000190):
        with refused(0x06090030):
            bench.u32(AMPLIFIER, 0x1800, 1, restricted)
    with refused(0x06090030):
        bench.u8(AMPLIFIER, 0x1800, 2, 252)


def test_a_measured_value_cannot_be_received_but_dummies_can(bench: Bench):
    bench.u32(REGULATOR, 0x1400, 1, 0x80000210)
    bench.u8(REGULATOR, 0x1600, 0, 0)
    with refused(0x06040041):
        bench.u32(REGULATOR, 0x1600, 1, 0x63010110)
    bench.u32(REGULATOR, 0x1600, 1, 0x00050008)
    bench.u32(REGULATOR, 0x1600, 2, 0x63000110)
    bench.u8(REGULATOR, 0x1600, 0, 2)
    bench.u32(REGULATOR, 0x1400, 1, 0x210)
    bench.nmt(1)
    bench.send(0x210, struct.pack("<Bh", 99, -5))
    bench.run(2)
    assert bench.number(REGULATOR, 0x6300, 1, signed=True) == -5


def test_inhibit_time_holds_events_back(bench: Bench):
    node = 0x30
    bench.u32(node, 0x1800, 1, 0x800001B0)
    bench.u16(node, 0x1800, 3, 500)  # 50 ms
    bench.u16(node, 0x1800, 5, 0)
    bench.u32(node, 0x1800, 1, 0x1B0)
    bench.nmt(1)
    bench.run(60)
    start = len(bench.of(0x1B0))
    for k in range(10):
        bench.signals.set(estop_ok=bool(k % 2))
        bench.run(10)
    frames = bench.of(0x1B0)[start:]
    assert 2 <= len(frames) <= 3
    bench.run(60)
    assert bench.of(0x1B0)[-1][0] & 2 == 2  # the last state is told in the end


def test_position_pdo_wraps(bench: Bench):
    bench.nmt(1)
    bench.signals.publish(bench.t_ns, position_turns=[4096.25])
    bench.run(30)
    assert struct.unpack_from("<I", bench.of(0x1A2)[-1])[0] == 1024
    bench.signals.publish(bench.t_ns, position_turns=[-0.25])
    bench.run(30)
    assert struct.unpack_from("<I", bench.of(0x1A2)[-1])[0] == (1 << 24) - 1024
    assert bench.number(ENCODER, 0x6004) == (1 << 24) - 1024


INTEGERS = [kind for kind in DataType if limits(kind) is not None]


@given(st.data(), st.lists(st.sampled_from(INTEGERS), min_size=1, max_size=8))
def test_layouts_round_trip(data: st.DataObject, kinds: list[DataType]):
    """Whatever is mapped, the packed bytes give the values back, and lie as the standard says."""
    parts: list[tuple[Entry | None, int]] = []
    expected, position = 0, 0
    for number, kind in enumerate(kinds):
        entry = Entry(0x2000, number, "x", kind, Access.RWW, mappable=True)
        bits = 1 if kind is DataType.BOOLEAN and data.draw(st.booleans()) else entry.bits
        if sum(length for _, length in parts) + bits > 64:
            continue
        low, high = limits(kind) or (0, 0)
        entry.value = data.draw(st.integers(low, high))
        expected |= (entry.number() & (1 << bits) - 1) << position
        position += bits
        parts.append((entry, bits))
    layout = Layout(parts)
    wire = layout.pack()
    assert int.from_bytes(wire, "little") == expected and len(wire) == (position + 7) // 8
    assert [value for _, value in layout.unpack(wire)] == [
        entry.value for entry, _ in parts if entry is not None
    ]
