"""`frame_reader`: what datagrams of udp_multicast and messages of python-can become, in batches."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator

import can
import msgpack
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.can.frames import (
    BATCH,
    ERROR,
    EXTENDED,
    FD,
    REMOTE,
    BusReader,
    Frame,
    MulticastReader,
    frame_of,
    frame_reader,
)

GROUP = "239.74.163.2"


class Wire:
    """A reader on a multicast port of its own, and python-can's own bus as the peer."""

    def __init__(self, *, fd: bool = False) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("", 0))
            self.port = probe.getsockname()[1]
        self.bus = self._open(fd)
        self.peer = self._open(True)
        self.reader = MulticastReader(self.bus)
        self.got: list[Frame] = []

    def _open(self, fd: bool) -> can.BusABC:
        return can.Bus(
            interface="udp_multicast", channel=GROUP, port=self.port, hop_limit=0, fd=fd, ignore_config=True
        )

    def put(self, datagram: bytes) -> None:
        """Something that is on the port but may be no frame."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.sendto(datagram, (GROUP, self.port))

    def take(self, timeout_s: float = 1.0) -> int:
        return self.reader.take(timeout_s, self.got.append)

    def close(self) -> None:
        self.reader.close()
        self.bus.shutdown()
        self.peer.shutdown()


@pytest.fixture(scope="module")
def reachable() -> None:
    try:
        wire = Wire()
    except (OSError, can.CanError) as error:
        pytest.skip(f"no multicast on this machine: {error}")
    wire.peer.send(can.Message(arbitration_id=1))
    came = wire.take()
    wire.close()
    if not came:
        pytest.skip("multicast frames do not come back on this machine")


@pytest.fixture
def wire(reachable: None) -> Iterator[Wire]:
    made = Wire()
    yield made
    made.close()


MESSAGES = st.builds(
    lambda extended, cob_id, remote, data: can.Message(
        arbitration_id=cob_id if extended else cob_id & 0x7FF,
        is_extended_id=extended,
        is_remote_frame=remote,
        dlc=len(data),
        data=None if remote else data,
    ),
    st.booleans(), st.integers(0, 0x1FFF_FFFF), st.booleans(), st.binary(max_size=8),
)  # fmt: skip


def test_frames_of_python_can_are_read_as_it_reads_them(wire: Wire) -> None:
    """The peer's own reading of the same datagrams is the reference."""
    sent: list[can.Message] = []

    @given(MESSAGES)
    def send(message: can.Message) -> None:
        wire.peer.send(message, 1.0)
        sent.append(message)

    send()
    while len(wire.got) < len(sent) and wire.take():
        pass
    read = [frame_of(message) for _ in sent if (message := wire.peer.recv(1.0)) is not None]
    assert [frame._replace(t_ns=0) for frame in wire.got] == [frame._replace(t_ns=0) for frame in read]
    assert [frame.cob_id for frame in wire.got] == [message.arbitration_id for message in sent]
    for frame, message in zip(wire.got, sent, strict=True):
        again = frame.message()
        assert again.equals(message, timestamp_delta=None, check_channel=False, check_direction=False)


def test_all_that_wait_come_at_once_with_the_times_of_their_arrival(wire: Wire) -> None:
    sent_ns: list[tuple[int, int]] = []
    for number in range(5):
        before_ns = time.monotonic_ns()
        wire.peer.send(can.Message(arbitration_id=0x181, data=bytes([number]), is_extended_id=False))
        sent_ns.append((before_ns, time.monotonic_ns()))
        time.sleep(0.01)
    time.sleep(0.05)
    assert wire.take() == 5
    assert [frame.data for frame in wire.got] == [bytes([number]) for number in range(5)]
    for frame, (before_ns, after_ns) in zip(wire.got, sent_ns, strict=True):
        assert before_ns - 100_000 < frame.t_ns < after_ns + 100_000  # not of the reading 50 ms later
    assert wire.take(0.0) == 0


def test_nothing_comes(wire: Wire) -> None:
    start_s = time.monotonic()
    assert wire.take(0.05) == 0
    assert 0.04 < time.monotonic() - start_s < 1.0


def test_a_flood_comes_in_portions(wire: Wire) -> None:
    for number in range(BATCH + 10):
        wire.peer.send(can.Message(arbitration_id=number, data=b"", is_extended_id=False))
    assert [wire.take(), wire.take()] == [BATCH, 10]
    assert [frame.cob_id for frame in wire.got] == list(range(BATCH + 10))
    assert wire.reader.overrun == 0


def packed(**changes: object) -> bytes:
    """A frame as python-can sends it, with fields changed; None leaves one out."""
    fields = {
        "timestamp": 0.0, "arbitration_id": 0x123, "is_extended_id": False, "is_remote_frame": False,
        "is_error_frame": False, "channel": None, "dlc": 2, "data": b"\1\2", "is_fd": False,
        "bitrate_switch": False, "error_state_indicator": False,
    } | changes  # fmt: skip
    return msgpack.packb({key: value for key, value in fields.items() if value is not None})


GARBAGE = [
    b"", b"garbage", b"\xff" * 40, msgpack.packb(5), msgpack.packb([1, 2]), packed(arbitration_id=0x800),
    packed(arbitration_id=-1), packed(arbitration_id="x"), packed(arbitration_id=1.0), packed(dlc=3),
    packed(data=b"123456789", dlc=9), packed(data="12"), packed(data=None), packed(arbitration_id=None),
]  # fmt: skip


@pytest.mark.parametrize("datagram", GARBAGE)
def test_what_is_no_frame_is_an_error_and_holds_up_no_other(wire: Wire, datagram: bytes) -> None:
    wire.put(packed(data=b"a", dlc=1))
    wire.put(datagram)
    wire.put(packed(data=b"b", dlc=1))
    with pytest.raises(can.CanOperationError):
        wire.take()
    assert wire.take() == 1
    assert [frame.data for frame in wire.got] == [b"a", b"b"]


@given(st.binary(max_size=80))
def test_no_datagram_breaks_the_reader(reachable_wire: Wire, datagram: bytes) -> None:
    try:
        frame = reachable_wire.reader._decode(datagram, 0)
    except can.CanOperationError:
        return
    assert frame is None or len(frame.data) <= 8


@pytest.fixture(scope="module")
def reachable_wire(reachable: None) -> Iterator[Wire]:
    made = Wire()
    yield made
    made.close()


def test_fd_frames_only_where_the_bus_carries_them(wire: Wire) -> None:
    datagram = packed(is_fd=True, data=bytes(12), dlc=12)
    assert wire.reader._decode(datagram, 7) is None
    with_fd = Wire(fd=True)
    try:
        assert with_fd.reader._decode(datagram, 7) == Frame(0x123, bytes(12), 7, FD)
    finally:
        with_fd.close()


def test_error_frames_are_marked(wire: Wire) -> None:
    frame = wire.reader._decode(packed(is_error_frame=True, arbitration_id=0x40, data=bytes(8), dlc=8), 7)
    assert frame == Frame(0x40, bytes(8), 7, ERROR)


def test_other_interfaces_are_read_through_python_can() -> None:
    with (
        can.Bus(interface="virtual", channel="frames", ignore_config=True) as bus,
        can.Bus(interface="virtual", channel="frames", ignore_config=True) as peer,
    ):
        reader = frame_reader(bus, "virtual")
        assert isinstance(reader, BusReader) and not reader.stamped
        assert reader.take(0.0, lambda _frame: None) == 0
        peer.send(can.Message(arbitration_id=0x123, data=b"\1", is_extended_id=False))
        peer.send(can.Message(arbitration_id=0x12345, data=b"\2"))
        peer.send(can.Message(arbitration_id=0x7, is_remote_frame=True, dlc=3, is_extended_id=False))
        got: list[Frame] = []
        assert reader.take(1.0, got.append) == 3
        assert [(frame.cob_id, frame.data, frame.flags) for frame in got] == [
            (0x123, b"\1", 0), (0x12345, b"\2", EXTENDED), (0x7, bytes(3), REMOTE),
        ]  # fmt: skip
        reader.close()


@pytest.mark.parametrize("stamp_s", [0.0, 12.5, 4e9])
def test_times_of_another_clock_are_replaced_by_now(stamp_s: float) -> None:
    before_ns = time.monotonic_ns()
    frame = frame_of(can.Message(arbitration_id=1, timestamp=stamp_s))
    assert before_ns <= frame.t_ns <= time.monotonic_ns()


def test_a_late_reader_is_told_what_the_kernel_dropped(wire: Wire) -> None:
    wire.reader._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    for number in range(300):
        wire.peer.send(can.Message(arbitration_id=number, is_extended_id=False))
    while wire.take(0.05):
        pass
    wire.peer.send(can.Message(arbitration_id=0x7FF, is_extended_id=False))
    wire.take()
    assert wire.got[-1].cob_id == 0x7FF
    assert wire.reader.overrun == 300 - (len(wire.got) - 1) > 0
