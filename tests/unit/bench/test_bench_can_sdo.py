"""SDO server of the emulated nodes against raw frames written from CiA 301, and its codecs."""

from __future__ import annotations

import struct

import pytest
from bench_can_peer import ALL, AMPLIFIER, ANALOG, ENCODER, REGULATOR, Bench, SdoAborted
from hypothesis import given
from hypothesis import strategies as st

from sim_hardware.bench.can.datatypes import DataType, decode, encode, limits
from sim_hardware.bench.can.dictionary import Abort, AbortCode, Access, Entry, ObjectDictionary
from sim_hardware.bench.can.sdo import SdoServer


@pytest.fixture
def bench():
    made = Bench().boot(operational=False)
    yield made
    made.close()


def refused(code: int):
    """The abort code on the wire is this one."""
    return pytest.raises(SdoAborted, match=f"{code:08X}")


@pytest.mark.parametrize(
    ("node", "device_type"),
    list(zip(ALL, (0x80198, 0x20194, 0x20194, 0x20196, 0x30191, 0x80191), strict=True)),
)
def test_every_node_tells_who_it_is(bench: Bench, node: int, device_type: int):
    assert bench.number(node, 0x1000) == device_type
    assert bench.number(node, 0x1018, 0) == 4
    assert bench.number(node, 0x1018, 1) == 0x0B1C
    assert bench.number(node, 0x1018, 2) == node
    assert bench.number(node, 0x1001) == 0
    assert bench.read(node, 0x1008).decode().startswith("Bench ")
    assert bench.read(node, 0x100A) == b"bench 1.0"


def test_exact_frames_of_an_expedited_transfer(bench: Bench):
    assert bench.ask(REGULATOR, bytes.fromhex("40 17 10 00 00 00 00 00")) == bytes.fromhex(
        "4B 17 10 00 64 00 00 00"
    )
    assert bench.ask(REGULATOR, bytes.fromhex("2B 17 10 00 C8 00 00 00")) == bytes.fromhex(
        "60 17 10 00 00 00 00 00"
    )
    assert bench.number(REGULATOR, 0x1017) == 200


def test_expedited_download_without_size_takes_the_length_of_the_type(bench: Bench):
    bench.ask(REGULATOR, struct.pack("<BHB4s", 0x22, 0x1017, 0, b"\x2c\x01\xff\xff"))
    assert bench.number(REGULATOR, 0x1017) == 300


def test_exact_frames_of_a_segmented_upload(bench: Bench):
    text = b"Bench pressure regulator"
    assert bench.ask(REGULATOR, bytes.fromhex("40 08 10 00 00 00 00 00")) == struct.pack(
        "<BHBI", 0x41, 0x1008, 0, len(text)
    )
    parts = [bench.ask(REGULATOR, bytes([head]) + bytes(7)) for head in (0x60, 0x70, 0x60, 0x70)]
    assert [part[0] for part in parts] == [0x00, 0x10, 0x00, 0x10 | (7 - 3) << 1 | 1]
    assert b"".join(part[1:] for part in parts)[: len(text)] == text


@pytest.mark.parametrize(
    ("index", "sub", "data", "code"),
    [
        (0x5000, 0, b"\0", 0x06020000),  # no such object
        (0x1018, 5, b"\0\0\0\0", 0x06090011),  # no such sub-index
        (0x1000, 0, b"\0\0\0\0", 0x06010002),  # constant
        (0x6301, 1, b"\0\0", 0x06010002),  # measured
        (0x1017, 0, b"\0", 0x06070013),  # too short
        (0x1017, 0, b"\0\0\0", 0x06070012),  # too long
        (0x6371, 1, b"\x31\0", 0x06090032),  # 49 ms, below 50
        (0x6371, 1, b"\xe9\x03", 0x06090031),  # 1001 ms
        (0x2100, 0, b"\x02", 0x06090031),
        (0x1029, 1, b"\x03", 0x06090031),
        (0x1005, 0, b"\x81\0\0\0", 0x06090030),
        (0x1003, 0, b"\x01", 0x06090030),
        (0x1014, 0, struct.pack("<I", 0x281), 0x06090030),
        (0x1016, 1, struct.pack("<I", 0x80 << 16 | 100), 0x06090030),
    ],
)  # fmt: skip
def test_wrong_writes_are_refused_with_the_code_of_the_standard(bench: Bench, index, sub, data, code):
    with refused(code):
        bench.write(REGULATOR, index, sub, data)


def test_wrong_reads_are_refused(bench: Bench):
    with refused(0x06020000):
        bench.read(REGULATOR, 0x9130, 1)
    with refused(0x06090011):
        bench.read(AMPLIFIER, 0x9130, 3)
    with refused(0x08000024):
        bench.read(REGULATOR, 0x1003, 1)


def test_the_same_node_cannot_be_watched_twice(bench: Bench):
    bench.u32(REGULATOR, 0x1016, 1, 0x01 << 16 | 250)
    with refused(0x06040043):
        bench.u32(REGULATOR, 0x1016, 2, 0x01 << 16 | 100)


def test_toggle_that_does_not_alternate_ends_the_transfer(bench: Bench):
    bench.ask(REGULATOR, bytes.fromhex("40 08 10 00 00 00 00 00"))
    bench.ask(REGULATOR, b"\x60" + bytes(7))
    with refused(0x05030000):
        bench.ask(REGULATOR, b"\x60" + bytes(7))
    with refused(0x05040001):  # nothing is under way any more
        bench.ask(REGULATOR, b"\x70" + bytes(7))
    assert bench.read(REGULATOR, 0x1008) == b"Bench pressure regulator"


@pytest.mark.parametrize("request_head", [0xA0, 0xC6, 0xE0])
def test_block_transfer_and_unknown_commands_are_refused(bench: Bench, request_head: int):
    with refused(0x05040001):
        bench.ask(ENCODER, bytes([request_head, 0x08, 0x10, 0, 0, 0, 0, 0]))


def test_a_silent_client_is_given_up_after_a_second(bench: Bench):
    bench.ask(REGULATOR, bytes.fromhex("40 08 10 00 00 00 00 00"))
    assert not bench.of(0x590, bench.run(990))
    (abort,) = bench.of(0x590, bench.run(20))
    assert abort == struct.pack("<BHBI", 0x80, 0x1008, 0, 0x05040000)


def test_abort_of_the_client_is_not_answered(bench: Bench):
    bench.ask(REGULATOR, bytes.fromhex("40 08 10 00 00 00 00 00"))
    bench.send(0x610, struct.pack("<BHBI", 0x80, 0x1008, 0, 0x08000000))
    assert not bench.of(0x590, bench.run(1200))


@pytest.mark.parametrize("data", [b"", b"\x40\x00\x10\x00", bytes(7)])
def test_short_frames_and_remote_frames_are_ignored(bench: Bench, data: bytes):
    bench.send(0x610, data)
    bench.send(0x610, remote=True)
    assert not bench.of(0x590, bench.run(5))


def test_a_stopped_node_does_not_answer(bench: Bench):
    bench.nmt(2, REGULATOR)
    with pytest.raises(TimeoutError):
        bench.read(REGULATOR, 0x1000)
    assert bench.number(AMPLIFIER, 0x1000)


def test_segmented_download_into_a_number(bench: Bench):
    """Nothing forbids a client to write two bytes in segments."""
    answer = bench.ask(ANALOG, struct.pack("<BHBI", 0x21, 0x6411, 1, 2))
    assert answer[0] == 0x60
    bench.ask(ANALOG, bytes([(7 - 2) << 1 | 1]) + struct.pack("<h", 16384) + bytes(5))
    assert bench.signals.get("ventilator_m3_h") == pytest.approx(16384 / 32767 * 1000.0)


def test_segmented_download_of_another_length_than_announced(bench: Bench):
    bench.ask(ANALOG, struct.pack("<BHBI", 0x21, 0x6411, 1, 4))
    with refused(0x06070010):
        bench.ask(ANALOG, bytes([(7 - 2) << 1 | 1]) + bytes(7))
    with refused(0x05040005):
        bench.ask(ANALOG, struct.pack("<BHBI", 0x21, 0x6411, 1, 1 << 20))


# -- codecs ---------------------------------------------------------------------------------------


def _server() -> tuple[ObjectDictionary, SdoServer]:
    dictionary = ObjectDictionary()
    dictionary.add(Entry(0x2000, 0, "bytes", DataType.DOMAIN, Access.RW, b""))
    dictionary.add(Entry(0x2001, 0, "secret", DataType.UNSIGNED8, Access.WO))
    return dictionary, SdoServer(dictionary)


@given(st.binary(max_size=256))
def test_any_bytes_survive_download_and_upload(data: bytes):
    _, server = _server()
    assert server.request(struct.pack("<BHBI", 0x21, 0x2000, 0, len(data))) == bytes.fromhex(
        "6000200000000000"
    )
    parts = [data[at : at + 7] for at in range(0, len(data), 7)] or [b""]
    for number, part in enumerate(parts):
        head = number % 2 << 4 | (7 - len(part)) << 1 | (number == len(parts) - 1)
        assert server.request(bytes([head]) + part.ljust(7, b"\xaa")) == bytes(
            [0x20 | number % 2 << 4]
        ) + bytes(7)
    answer = server.request(bytes.fromhex("4000200000000000"))
    assert answer is not None
    if answer[0] & 2:
        assert answer[4 : 8 - (answer[0] >> 2 & 3)] == data
        return
    assert struct.unpack_from("<I", answer, 4)[0] == len(data)
    read, toggle, last = b"", 0, False
    while not last:
        answer = server.request(bytes([0x60 | toggle << 4]) + bytes(7))
        assert answer is not None and answer[0] >> 4 == toggle
        read, toggle, last = read + answer[1 : 8 - (answer[0] >> 1 & 7)], toggle ^ 1, bool(answer[0] & 1)
    assert read == data


@given(st.lists(st.binary(max_size=9), max_size=40))
def test_no_sequence_of_requests_breaks_the_server(requests: list[bytes]):
    """Whatever comes, each answer is eight bytes, and a proper read works afterwards."""
    _, server = _server()
    for request in requests:
        answer = server.request(request)
        assert answer is None or len(answer) == 8
    assert server.request(bytes.fromhex("4001200000000000")) == struct.pack(
        "<BHBI", 0x80, 0x2001, 0, 0x06010001
    )


@given(st.data(), st.sampled_from([kind for kind in DataType if limits(kind) is not None]))
def test_integers_round_trip(data: st.DataObject, kind: DataType):
    low, high = limits(kind) or (0, 0)
    value = data.draw(st.integers(low, high))
    wire = encode(kind, value)
    assert decode(kind, wire) == value
    if kind is not DataType.BOOLEAN:
        assert int.from_bytes(wire, "little", signed=low < 0) == value
        for beyond in (low - 1, high + 1):
            with pytest.raises(ValueError):
                encode(kind, beyond)


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_reals_round_trip(value: float):
    assert decode(DataType.REAL32, encode(DataType.REAL32, value)) == value


def test_reals_that_are_no_numbers_are_refused():
    entry = Entry(0x2000, 0, "gain", DataType.REAL32, Access.RW, 1.0)
    for wrong in (float("nan"), float("inf")):
        with pytest.raises(Abort) as caught:
            entry.accept(struct.pack("<f", wrong))
        assert caught.value.code is AbortCode.BAD_VALUE
