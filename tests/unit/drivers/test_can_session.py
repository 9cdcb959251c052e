"""`CanSession`: dispatch, time stamps, counts, the wire log, and every way in which a bus can fail."""

from __future__ import annotations

import errno
import itertools
import os
import socket
import time
from typing import Any

import can
import pytest

from drivers.can.bus import bus_settings, open_bus
from drivers.can.frames import ERROR, Frame, frame_of
from drivers.can.session import CanSession, can_session
from rigctl.core.errors import ConfigError, DeviceError
from rigctl.hal.devices import RigContext

_numbers = itertools.count()


@pytest.fixture
def table() -> dict[str, Any]:
    return {"interface": "virtual", "channel": f"session-{os.getpid()}-{next(_numbers)}"}


@pytest.fixture
def context(tmp_path, table) -> RigContext:
    return RigContext(tmp_path, "real", None, "rig.toml", tmp_path, log_dir=tmp_path, buses={"main": table})


@pytest.fixture
def session(context):
    made = can_session(context, "main")
    made.open()
    yield made
    made.close()


@pytest.fixture
def peer(table):
    bus = can.Bus(interface="virtual", channel=table["channel"], ignore_config=True)
    yield bus
    bus.shutdown()


def put(peer: can.BusABC, cob_id: int, data: bytes, **other: Any) -> None:
    other.setdefault("is_extended_id", False)
    peer.send(can.Message(arbitration_id=cob_id, data=data, **other))


def wait_for(condition, timeout_s: float = 2.0) -> bool:
    end_s = time.monotonic() + timeout_s
    while not condition() and time.monotonic() < end_s:
        time.sleep(0.005)
    return bool(condition())


def test_all_devices_of_a_rig_share_one_session(context):
    assert can_session(context, "main") is can_session(context, "main")


def test_frames_go_to_those_who_subscribed(session: CanSession, peer):
    got: list[tuple[str, bytes]] = []
    session.subscribe(0x123, lambda data, _t: got.append(("a", data)))
    end = session.subscribe(0x123, lambda data, _t: got.append(("b", data)))
    put(peer, 0x123, b"\x01")
    put(peer, 0x124, b"\x02")
    assert wait_for(lambda: session.statistics.received == 2)
    assert got == [("a", b"\x01"), ("b", b"\x01")]
    assert session.statistics.unheard == 1
    end()
    end()
    put(peer, 0x123, b"\x03")
    assert wait_for(lambda: len(got) == 3)
    assert got[-1] == ("a", b"\x03")


def test_time_stamps_are_of_the_monotonic_clock(session: CanSession, peer):
    stamps: list[float] = []
    session.subscribe(0x123, lambda _data, timestamp_s: stamps.append(timestamp_s))
    before_s = time.monotonic()
    put(peer, 0x123, b"")
    assert wait_for(lambda: stamps)
    assert before_s - 0.001 <= stamps[0] <= time.monotonic()


@pytest.mark.parametrize("stamp_s", [0.0, 12.5, 4e9])
def test_time_stamps_of_another_clock_are_replaced(session: CanSession, stamp_s):
    stamps: list[float] = []
    session.subscribe(0x123, lambda _data, timestamp_s: stamps.append(timestamp_s))
    before_s = time.monotonic()
    session._on_frame(frame_of(can.Message(arbitration_id=0x123, is_extended_id=False, timestamp=stamp_s)))
    assert before_s <= stamps[0] <= time.monotonic()


def test_remote_frames_and_long_identifiers_of_the_same_number_are_not_data(session: CanSession, peer):
    got: list[bytes] = []
    session.subscribe(0x123, lambda data, _t: got.append(data))
    put(peer, 0x123, b"\x01", is_extended_id=True)
    peer.send(can.Message(arbitration_id=0x123, is_extended_id=False, is_remote_frame=True, dlc=1))
    put(peer, 0x123, b"\x02")
    assert wait_for(lambda: got)
    assert got == [b"\x02"]


def test_sent_frames_arrive_and_count(session: CanSession, peer):
    session.send(0x210, b"\x07\x00\x34\x12")
    message = peer.recv(1.0)
    assert message is not None and (message.arbitration_id, bytes(message.data)) == (
        0x210,
        b"\x07\x00\x34\x12",
    )
    assert not message.is_extended_id
    assert session.statistics.sent == 1


def test_users_are_counted(context, peer):
    session = can_session(context, "main")
    session.open()
    session.open()
    session.close()
    session.send(0x100, b"")
    session.close()
    session.close()
    with pytest.raises(DeviceError, match="not open"):
        session.send(0x100, b"")
    session.open()
    session.send(0x100, b"")
    session.close()


def test_a_failing_callback_is_a_failure_of_the_bus(session: CanSession, peer, context):
    session.subscribe(0x123, lambda _data, _t: 1 / 0)
    put(peer, 0x123, b"\xab")
    assert wait_for(lambda: session.failure)
    with pytest.raises(DeviceError, match=r"bus 'main'.*123h ab.*ZeroDivisionError"):
        session.send(0x100, b"")
    assert "ZeroDivisionError" in context.board.snapshot()["faults"]["bus main"]


def test_bus_off_is_told(session: CanSession, context):
    session._on_frame(Frame(0x40, bytes(8), time.monotonic_ns(), ERROR))
    with pytest.raises(DeviceError, match="bus-off"):
        session.check()
    assert "bus-off" in context.board.snapshot()["faults"]["bus main"]


def test_error_passive_is_shown_and_taken_back(session: CanSession, context):
    for data, shown in ((b"\0\x10", True), (b"\0\0", False)):
        session._on_frame(Frame(0x04, data + bytes(6), time.monotonic_ns(), ERROR))
        assert ("bus main" in context.board.snapshot().get("faults", {})) is shown
    session.check()


def test_a_lost_interface_is_told(session: CanSession, context):
    assert session._bus is not None
    session._bus.shutdown()
    assert wait_for(lambda: session.failure)
    with pytest.raises(DeviceError, match="cannot be read any more"):
        session.check()


def test_an_interface_that_takes_no_frames_is_told(session: CanSession, monkeypatch):
    def full(*_: object) -> None:
        raise can.CanOperationError("Transmit buffer full")

    monkeypatch.setattr(session._bus, "send", full)
    with pytest.raises(DeviceError, match=r"does not take frames .identifier 210h.*Transmit buffer full"):
        session.send(0x210, b"")


def test_an_ended_reading_thread_is_told(session: CanSession):
    assert session._reader is not None
    session._closing.set()
    session._reader.join(2.0)
    session.look()
    with pytest.raises(DeviceError, match="reading thread"):
        session.check()


@pytest.mark.parametrize("kind", ["log", "asc", "blf"])
def test_wire_log_in_standard_formats(tmp_path, table, peer, kind):
    buses = {"main": table | {"log": kind}}
    context = RigContext(tmp_path, "real", None, "rig.toml", tmp_path, log_dir=tmp_path, buses=buses)
    session = can_session(context, "main")
    session.open()
    session.send(0x210, b"\x01\x02")
    put(peer, 0x190, b"\x03")
    assert wait_for(lambda: session.statistics.received == 1)
    session.close()
    with can.LogReader(tmp_path / f"can-main.{kind}") as reader:
        frames = [(m.arbitration_id, bytes(m.data), m.is_rx) for m in reader]
    assert frames == [(0x210, b"\x01\x02", False), (0x190, b"\x03", True)]


def test_no_log_without_a_wish(session: CanSession, tmp_path):
    session.send(0x100, b"")
    assert list(tmp_path.iterdir()) == []


def test_multicast_gives_no_echo_and_survives_garbage(tmp_path):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        port = probe.getsockname()[1]
    table = {
        "interface": "udp_multicast",
        "channel": "239.74.163.2",
        "port": port,
        "hop_limit": 0,
        "fd": False,
    }
    contexts = [
        RigContext(tmp_path, "real", None, "rig.toml", tmp_path, buses={"main": table}) for _ in range(2)
    ]
    try:
        sessions = [can_session(context, "main") for context in contexts]
        for session in sessions:
            session.open()
    except DeviceError as error:
        pytest.skip(f"no multicast on this machine: {error}")
    one, other = sessions
    try:
        own: list[bytes] = []
        got: list[bytes] = []
        one.subscribe(0x123, lambda data, _t: own.append(data))
        other.subscribe(0x123, lambda data, _t: got.append(data))
        one.send(0x123, b"\x01")
        if not wait_for(lambda: got):
            pytest.skip("multicast frames do not come back on this machine")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            for _ in range(3):
                stranger.sendto(b"garbage", ("239.74.163.2", port))
        one.send(0x123, b"\x02")
        assert wait_for(lambda: got == [b"\x01", b"\x02"])
        assert wait_for(lambda: one.statistics.echoed == 2)
        assert own == []
        assert wait_for(lambda: other.statistics.malformed == 3)
        assert other.failure is None
        other.send(0x123, b"\x03")
        assert wait_for(lambda: own == [b"\x03"])
    finally:
        for session in sessions:
            session.close()


# -- opening ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({}, ("buses.main.interface", "missing")),
        ({"interface": "virtual", "log": "pcap"}, ("buses.main.log", "'pcap'", "asc")),
        ({"interface": "virtual", "controller_node": 128}, ("controller_node", "1 to 127")),
    ],
)
def test_wrong_tables_are_told(table, words):
    with pytest.raises(ConfigError) as caught:
        bus_settings({"main": table}, "main", "rig.toml")
    for word in ("rig.toml", *words):
        assert word in str(caught.value)


def test_unknown_bus_names_those_that_there_are():
    with pytest.raises(ConfigError, match=r"no bus 'man'.*main"):
        bus_settings({"main": {"interface": "virtual"}}, "man", "rig.toml")


def test_unknown_interface_names_those_that_there_are():
    with pytest.raises(ConfigError, match=r"no interface 'socketcam'.*socketcan"):
        open_bus(bus_settings({"main": {"interface": "socketcam"}}, "main", "rig.toml"))


def _raiser(error: BaseException):
    def raise_it(*_: object, **__: object) -> None:
        raise error

    return raise_it


@pytest.mark.parametrize(
    ("interface", "error", "remedy"),
    [
        ("socketcan", OSError(errno.EAFNOSUPPORT, "Address family not supported"), "modprobe can"),
        ("socketcan", OSError(errno.ENODEV, "No such device"), "ip link set can0 up type can bitrate 500000"),
        ("socketcan", OSError(errno.EPERM, "Operation not permitted"), "Permission is missing"),
        ("slcan", OSError(errno.EACCES, "Permission denied"), "group dialout"),
        ("pcan", can.CanInterfaceNotImplementedError("no library"), "Install the vendor's library"),
        ("udp_multicast", can.CanInitializationError("no network"), "ip route add 239.0.0.0/8"),
        (
            "udp_multicast",
            can.CanInterfaceNotImplementedError("msgpack not installed"),
            "pip install msgpack",
        ),
        ("slcan", TypeError("unexpected keyword argument 'x'"), "Correct the keys of [buses.main]"),
        ("kvaser", can.CanInitializationError("channel 7"), "rigctl devices list"),
        (
            "socketcan",
            ModuleNotFoundError("No module named 'msgpack'", name="msgpack"),
            "pip install msgpack",
        ),
    ],
)
def test_what_stops_a_bus_from_opening_is_told(monkeypatch, interface, error, remedy):
    monkeypatch.setattr(can, "Bus", _raiser(error))
    table = {"interface": interface, "channel": "can0", "bitrate": 500000}
    with pytest.raises(DeviceError) as caught:
        open_bus(bus_settings({"main": table}, "main", "rig.toml"))
    text = str(caught.value)
    assert text.startswith("rig.toml: buses.main") and remedy in text
