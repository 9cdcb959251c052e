"""The serial wire log: what was transferred can be read back; size is limited; failures end the log only."""

import threading
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigctl.hal.devices import RigContext
from rigctl.hal.wirelog import WireLog, read_wire_log, wire_log


def test_lines_say_time_direction_and_bytes(tmp_path: Path):
    log = WireLog(tmp_path / "drive.log", "drive on /dev/ttyUSB0")
    log.sent(bytes.fromhex("010300030001740a"))
    log.note("no answer\nwithin 0.2 s")
    log.received(bytes.fromhex("0103020233f931"))
    log.close()
    head, sent, note, received = (tmp_path / "drive.log").read_text().splitlines()
    assert head.startswith("# rigctl serial wire log 1: drive on /dev/ttyUSB0;")
    assert sent.endswith("> 01 03 00 03 00 01 74 0a  |......t.|")
    assert note.endswith("# no answer within 0.2 s")
    assert "< 01 03 02 02 33 f9 31" in received
    first, second = read_wire_log(tmp_path / "drive.log")
    assert first[1:] == (">", bytes.fromhex("010300030001740a"))
    assert first[0] <= second[0]


@settings(max_examples=30)
@given(transfers=st.lists(st.tuples(st.booleans(), st.binary(min_size=1, max_size=80)), max_size=20))
def test_every_transfer_is_read_back(tmp_path_factory: pytest.TempPathFactory, transfers):
    path = tmp_path_factory.mktemp("log") / "x.log"
    log = WireLog(path)
    for sending, data in transfers:
        assert log.trace(sending, data) == data
    log.close()
    assert [(way == ">", data) for _, way, data in read_wire_log(path)] == transfers


def test_full_files_make_room_and_the_newest_is_never_lost(tmp_path: Path):
    log = WireLog(tmp_path / "x.log", limit_bytes=2000, keep=2)
    for number in range(200):
        log.sent(number.to_bytes(4, "big"))
    log.close()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.log", "x.log.1", "x.log.2"]
    assert all(path.stat().st_size <= 2000 for path in tmp_path.iterdir())
    kept = [
        int.from_bytes(data, "big")
        for name in ("x.log.2", "x.log.1", "x.log")
        for _, _, data in read_wire_log(tmp_path / name)
    ]
    assert kept == list(range(kept[0], 200))


def test_threads_do_not_mix_their_lines(tmp_path: Path):
    log = WireLog(tmp_path / "x.log")

    def talk(value: int) -> None:
        for _ in range(200):
            log.sent(bytes([value]) * 20)

    threads = [threading.Thread(target=talk, args=(value,)) for value in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    log.close()
    transfers = read_wire_log(tmp_path / "x.log")
    assert len(transfers) == 800
    assert all(len(set(data)) == 1 and len(data) == 20 for _, _, data in transfers)


def test_a_log_that_cannot_be_written_ends_with_one_message(capsys: pytest.CaptureFixture[str]):
    log = WireLog(Path("/dev/full"), "drive")
    for _ in range(3):
        log.sent(b"abc")
    assert not log.active
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "wire log /dev/full ends" in err


def test_drivers_get_their_log_through_the_context(tmp_path: Path):
    context = RigContext(tmp_path, "real", None, "rig.toml", tmp_path)
    assert not wire_log(context, "drive", "/dev/ttyUSB0").active
    context.wire_log_dir = tmp_path / "wires"
    log = wire_log(context, "drive", "socket://10.0.0.4:4001")
    log.sent(b"\x01")
    log.close()
    assert [path.name for path in (tmp_path / "wires").iterdir()] == ["drive-socket-10-0-0-4-4001.log"]
