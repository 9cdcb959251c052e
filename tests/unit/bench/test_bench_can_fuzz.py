"""Whatever comes over the bus, the emulated nodes neither fall over nor leave what their manual promises."""

from __future__ import annotations

import struct

from bench_can_peer import ALL, Bench, SdoAborted
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sim_hardware.bench.can import FaultRule

USED = [0x000, 0x080, 0x210, 0x230, 0x231, 0x701, *(0x600 + node for node in ALL), 0x1A0, 0x190]
FRAMES = st.lists(
    st.tuples(st.sampled_from(USED) | st.integers(0, 0x7FF), st.binary(max_size=8), st.booleans()),
    max_size=60,
)
#: Requests that reach the objects: command, object, four bytes.
COMMUNICATION = (
    0x1001, 0x1003, 0x1005, 0x1008, 0x1014, 0x1016, 0x1017, 0x1018, 0x1029, 0x1400, 0x1600, 0x1800, 0x1A00,
)  # fmt: skip
DEVICE = (
    0x2100, 0x2200, 0x6000, 0x6001, 0x6002, 0x6003, 0x6040, 0x6132, 0x6300, 0x6314, 0x6320, 0x6371, 0x6411,
    0x6444, 0x9124,
)  # fmt: skip
INDICES = st.sampled_from((*COMMUNICATION, *DEVICE))
REQUESTS = st.lists(
    st.tuples(
        st.sampled_from(ALL),
        st.sampled_from([0x22, 0x23, 0x27, 0x2B, 0x2F, 0x40, 0x21, 0x00, 0x60, 0x70, 0x80]),
        INDICES,
        st.integers(0, 9),
        st.integers(0, 0xFFFFFFFF)
        | st.sampled_from([0, 1, 2, 5, 10, 100, 0x7F, 0x80000000, 0x800001A0, 0x1A0, 0x60400010, 0x91300120]),
    ),
    max_size=60,
)


def _still_alive(bench: Bench) -> None:
    """After a reset of all nodes everything is as from power-on."""
    if not bench.can.faults.quiet:
        bench.can.clear_faults()
        bench.run(320)  # frames under way still arrive
    bench.send(0x000, b"\x81\x00")
    bench.run(60)
    for node in ALL:
        assert bench.number(node, 0x1018, 2) == node
    bench.nmt(1)
    assert bench.signals.get("vent") is True and bench.signals.get("relay_closed") is False
    assert len(bench.of(0x1A0, bench.run(10))) == 10


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(FRAMES)
def test_any_frames(frames: list[tuple[int, bytes, bool]]):
    bench = Bench().boot()
    try:
        for cob_id, data, remote in frames:
            bench.send(cob_id, b"" if remote else data, remote=remote)
            bench.run(1)
        _still_alive(bench)
    finally:
        bench.close()


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(REQUESTS)
def test_any_parameters(requests: list[tuple[int, int, int, int, int]]):
    bench = Bench().boot()
    try:
        for node, command, index, sub, value in requests:
            try:
                bench.ask(node, struct.pack("<BHBI", command, index, sub, value))
            except (SdoAborted, TimeoutError):
                pass  # refused in order, an abort of ours, or heartbeats watched from a node that is silent
            bench.send(0x701, b"\x05")
            bench.run(3)
        _still_alive(bench)
    finally:
        bench.close()


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.builds(
            FaultRule,
            kind=st.sampled_from(["drop", "corrupt", "delay", "duplicate", "reorder", "mute", "reboot"]),
            node=st.sampled_from(ALL),
            probability=st.floats(0.1, 1.0),
            delay_ms=st.integers(0, 100),
            corrupt=st.sampled_from(["bits", "shorten", "lengthen", "random"]),
            duration_ms=st.none() | st.integers(1, 300),
            outage_ms=st.integers(1, 200),
            seed=st.integers(0, 9),
        ),
        min_size=1,
        max_size=3,
    )
)
def test_no_fault_of_the_wire_keeps_the_relay_closed_without_fresh_renewals(rules: list[FaultRule]):
    """Renewals end; whatever the wire then does with old frames, the relay is open soon and stays open."""
    bench = Bench().boot()
    try:
        for rule in rules:
            bench.can.add_fault(rule)
        bench.safety(2, 1)
        for counter in range(2, 12):
            bench.run(20)
            bench.safety(1, counter)
        bench.run(100 * len(rules) + 160)  # delays add up, then the relay's own time
        assert bench.signals.get("relay_closed") is False
        for _ in range(30):
            bench.run(10)
            assert bench.signals.get("relay_closed") is False
        _still_alive(bench)
    finally:
        bench.close()
