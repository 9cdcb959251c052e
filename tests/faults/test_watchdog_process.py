"""The real watchdog process against faults of controller, sensors, rig, files and itself."""

from __future__ import annotations

import json
import math
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from watchdog_bench import ROOT, SHIPPED_LIMITS, Bench

from rigctl.core.errors import LinkClosed
from rigctl.core.wire import connect


@pytest.fixture
def bench() -> Iterator[Bench]:
    with Bench() as new:
        yield new


def run_down(bench: Bench) -> None:
    """The rig goes on alone with an open relay until it is at rest; then it sends no more samples."""
    while bench.plant["n"] > 0.0 or bench.plant["p"] > 0.8:
        bench.sample()
        assert bench.answer()["m"] == "hold"


def assert_tripped(bench: Bench, cause: str) -> None:
    trip = bench.record("trip")
    assert trip.payload["cause"] == cause
    assert trip.payload["words"] and trip.payload["remedy"]
    assert not bench.relay


# -- the normal life --------------------------------------------------------------------------------


def test_a_run_in_order(bench: Bench) -> None:
    bench.start().arm()
    bench.plant.update(p=20.0, n=40.0, M=380.0)
    assert bench.blocks(20) == "edge"
    bench.plant.update(p=0.0, n=0.0, M=0.0)
    assert bench.blocks(3) == "edge"
    bench.heartbeat()
    bench.say("disarm")
    assert bench.answer() == {"m": "open", "k": bench.k, "reason": "disarmed"}
    assert bench.controller is not None
    bench.controller.close()
    assert bench.ended() == 0
    assert bench.kinds() == ["started", "controller_connected", "relay_closed", "armed", "disarmed", "ended"]
    started = bench.record("started").payload
    assert started["limits"] == bench.hash8
    assert started["heavy_modules"] == []
    assert started["real_time_priority"] is False and started["priority"]


def test_it_is_small_and_starts_at_once(bench: Bench) -> None:
    before = time.monotonic()
    bench.start()
    bench.block()
    started_after_s = time.monotonic() - before
    assert bench.process is not None
    status = Path(f"/proc/{bench.process.pid}/status").read_text()
    resident_kb = int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1])
    print(f"resident {resident_kb / 1000:.1f} MB, first answer after {started_after_s:.2f} s")
    assert resident_kb < 30_000


def test_its_modules_need_the_standard_library_only() -> None:
    code = (
        "import sys, rigctl.safety.__main__\n"
        "names = {name.partition('.')[0] for name in sys.modules}\n"
        "print(sorted(names - sys.stdlib_module_names - {'rigctl', '__main__', 'sitecustomize'}))\n"
        "words = [name for name in sys.modules if name.startswith('rigctl.core')]\n"
        "print(sorted(words))"
    )
    done = subprocess.run(
        [sys.executable, "-S", "-c", code], capture_output=True, text=True, cwd=ROOT, check=True
    )
    others, words = done.stdout.splitlines()
    assert others == "[]"
    assert words == str(
        ["rigctl.core", "rigctl.core.errors", "rigctl.core.journal", "rigctl.core.registry",
         "rigctl.core.safety_link", "rigctl.core.wire"]
    )  # fmt: skip


# -- controller -------------------------------------------------------------------------------------


def test_killed_controller() -> None:
    with Bench(own_process=True) as bench:
        bench.start().arm()
        bench.plant.update(p=20.0, n=100.0)
        bench.blocks(3)
        assert bench.child is not None
        killed_s = time.monotonic()
        bench.child.kill()
        assert bench.answer()["m"] == "open"
        print(f"killed -> open {1000 * (time.monotonic() - killed_s):.1f} ms")
        run_down(bench)
        assert bench.ended() == 4
        assert_tripped(bench, "controller_gone")
        safe = bench.record("safe_state_reached")
        assert safe.payload["pressure_bar"] < 1.0 and safe.payload["speed_rpm"] < 1.0
        assert safe.rig_s is not None and safe.rig_s > 0.0
        assert bench.record("ended").payload["exit_code"] == 4


def test_frozen_controller() -> None:
    with Bench(own_process=True) as bench:
        bench.start().arm()
        bench.plant.update(p=20.0, n=100.0)
        bench.blocks(3)
        assert bench.child is not None
        bench.heartbeat()
        bench.child.send_signal(signal.SIGSTOP)
        bench.sample()
        assert bench.answer()["m"] == "edge"  # the heartbeat before it froze
        stopped_s = time.monotonic()
        opened = bench.answer()  # no sample: the wall clock
        assert opened["m"] == "open" and 0.25 < time.monotonic() - stopped_s < 2.0
        run_down(bench)
        assert bench.ended() == 4  # though the frozen process is still there
        assert bench.child.poll() is None
        assert_tripped(bench, "heartbeat_late")
        assert bench.record("safe_state_reached")


@pytest.mark.parametrize(
    "changes",
    [
        {"answer": 1},
        {"mask": 11},
        {"limits": "00000000"},
        {"k": 2},
        {"k": 500},
        {"set": {"p": 45.0, "n": 0.0, "enable": True}},
        {"set": {"p": 0.0, "n": 900.0, "enable": True}},
        {"set": {"p": math.nan, "n": 0.0, "enable": True}},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_wrong_heartbeats(bench: Bench, changes: dict[str, Any]) -> None:
    bench.start().arm()
    bench.heartbeat(**changes)
    bench.sample()
    assert bench.answer()["m"] == "open"
    bench.read_status()
    assert bench.status["state"] == "tripped" and bench.status["cause"] and bench.status["remedy"]
    assert bench.blocks(3) == "hold"
    assert_tripped(bench, "setpoint" if "set" in changes else "heartbeat_wrong")


def test_replayed_heartbeat(bench: Bench) -> None:
    bench.start().arm()
    sent: list[dict[str, Any]] = []
    assert bench.controller is not None
    send = bench.controller.send
    bench.controller.send = lambda message: (sent.append(message), send(message))[1]  # type: ignore[method-assign]
    bench.block()
    bench.controller.send(sent[0])
    bench.sample()
    assert bench.answer()["m"] == "open"
    bench.block()
    assert_tripped(bench, "heartbeat_wrong")


def test_garbage_from_the_controller(bench: Bench) -> None:
    bench.start().arm()
    bench.say("open sesame")
    assert bench.block() == "open"
    bench.block()
    assert_tripped(bench, "heartbeat_wrong")


def test_a_controller_that_does_not_read(bench: Bench) -> None:
    bench.start(controller=False)
    bench.connect_controller()
    bench.blocks(6)
    nonces_unread = 0
    assert bench.controller is not None
    while bench.block(beat=False) == "hold" and nonces_unread < 3:
        nonces_unread += 1
    assert bench.blocks(3) == "hold"  # locked: nothing to trip, no hanging


def test_disarming_in_motion_is_refused_and_leaving_then_trips(bench: Bench) -> None:
    bench.start().arm()
    bench.plant.update(n=100.0)
    bench.blocks(2)
    bench.say("disarm")
    assert bench.controller is not None
    bench.controller.close()
    bench.controller = None
    assert bench.answer()["m"] == "open"
    run_down(bench)
    assert bench.ended() == 4
    assert_tripped(bench, "controller_gone")
    assert bench.record("refused_disarm")


def test_only_one_controller_and_only_with_its_own_name(bench: Bench) -> None:
    bench.start(controller=False)
    for message in ({"m": "arm"}, {"m": "hello", "pid": 1}, {"m": "hello"}):
        liar = connect(bench.socket, 5.0)
        liar.send(message)
        with pytest.raises(LinkClosed):
            liar.recv(5.0)
        liar.close()
    bench.connect_controller()
    bench.arm()
    second = connect(bench.socket, 5.0)
    with pytest.raises(LinkClosed):
        second.recv(5.0)
    second.close()
    assert bench.blocks(3) == "edge"
    bench.say("disarm")
    assert bench.answer()["m"] == "open"
    assert bench.controller is not None
    bench.controller.close()
    assert bench.ended() == 0
    assert bench.kinds().count("refused_controller") == 4


# -- sensors and limits -----------------------------------------------------------------------------


def test_over_temperature_trips_in_its_block_and_is_reset_by_a_person(bench: Bench) -> None:
    bench.start().arm()
    bench.plant.update(p=20.0, n=100.0, T=505.0)
    assert bench.block() == "open"
    assert "disc temperature" in bench.open_reason
    assert bench.status["state"] == "tripped"
    bench.blocks(60)
    bench.say("reset", who="A. Person", reason="wanted to")
    bench.blocks(2)
    assert bench.status["state"] == "tripped"  # still hot
    bench.plant["T"] = 200.0
    bench.blocks(2)
    bench.say("reset", who="A. Person", reason="disc has cooled")
    bench.blocks(2)
    assert bench.status["state"] == "locked"
    bench.arm()
    assert bench.controller is not None
    bench.say("disarm")
    assert bench.answer()["m"] == "open"
    bench.controller.close()
    assert bench.ended() == 0
    trip = bench.record("trip").payload
    assert (trip["cause"], trip["threshold"]) == ("temperature_range", 500.0)
    assert max(trip["samples"]["temperature_degc"][-1]) == trip["value"] > 505.0
    assert bench.record("reset").payload["who"] == "A. Person"
    assert bench.record("refused_reset").payload["why"] == "temperature_range"


def test_a_trip_lasts_to_the_end_and_is_the_exit_code(bench: Bench) -> None:
    bench.start().arm()
    assert bench.block(estop_ok=False) == "open"
    bench.blocks(30)
    bench.say("disarm")
    assert bench.controller is not None
    bench.controller.close()
    assert bench.ended() == 4
    assert_tripped(bench, "estop")


def test_frozen_sensor(bench: Bench) -> None:
    bench.start().arm()
    bench.plant.update(p=20.0, n=40.0, M=380.0)
    words = [bench.block(torque_nm=[381.0] * 5) for _ in range(20)]
    assert words == ["edge"] * 19 + ["open"]
    bench.block()
    assert_tripped(bench, "torque_frozen")


@pytest.mark.parametrize("bad", [None, math.nan])
def test_sensor_without_a_value(bench: Bench, bad: Any) -> None:
    bench.start().arm()
    assert bench.block(pressure_bar=[bad] * 5) == "open"
    bench.block()
    assert_tripped(bench, "pressure_invalid")
    line = next(line for line in bench.journal.read_text().splitlines() if '"trip"' in line)
    json.loads(line, parse_constant=lambda word: pytest.fail(f"{word} is no strict JSON"))


def test_relay_that_does_not_open(bench: Bench) -> None:
    bench.start().arm()
    assert bench.block(doors_ok=False) == "open"
    bench.blocks(5, relay_closed=True)
    assert bench.record("further_cause").payload["cause"] == "relay_welded"
    assert bench.record("trip").payload["cause"] == "doors"


# -- rig and files ----------------------------------------------------------------------------------


def test_rig_link_closed_while_armed(bench: Bench) -> None:
    bench.start().arm()
    assert bench.rig is not None
    bench.rig.close()
    assert bench.ended() == 4
    bench.relay = False
    assert_tripped(bench, "rig_gone")
    assert bench.record("safe_state_not_confirmed")


def test_rig_link_closed_while_locked(bench: Bench) -> None:
    bench.start().block()
    assert bench.rig is not None
    bench.rig.close()
    assert bench.ended() == 3
    assert bench.record("rig_gone")


def test_silent_rig(bench: Bench) -> None:
    bench.start().arm()
    bench.heartbeat()
    assert bench.answer()["m"] == "open"
    bench.sample()
    assert bench.answer()["m"] == "hold"
    assert bench.ended() == 4
    assert_tripped(bench, "samples_late")


def test_garbage_from_the_rig(bench: Bench) -> None:
    bench.start().arm()
    assert bench.rig is not None
    bench.rig.send({"k": 7})
    assert bench.answer()["m"] == "open"
    bench.block()
    assert_tripped(bench, "rig_garbage")


def test_an_error_in_the_program_opens_the_relay(bench: Bench) -> None:
    bench.start().arm()
    bench.sample(t_s="soon")  # no driver gives this; arithmetic on it raises
    assert bench.answer()["m"] == "open"
    assert bench.ended() == 70
    bench.relay = False
    assert_tripped(bench, "watchdog_error")


def test_killed_watchdog_closes_its_links(bench: Bench) -> None:
    bench.start().arm()
    assert bench.process is not None and bench.rig is not None and bench.controller is not None
    bench.process.kill()
    with pytest.raises(LinkClosed):  # whereupon a rig opens its relay
        bench.rig.recv(5.0)
    with pytest.raises(LinkClosed):
        while bench.controller.recv(5.0) is not None:
            pass


def test_limits_file_edited_during_the_run(bench: Bench) -> None:
    bench.start().arm()
    bench.limits_file.write_text(
        bench.limits_file.read_text().replace("max_degc = 500.0", "max_degc = 600.0")
    )
    assert bench.blocks(3) == "edge"
    bench.plant["T"] = 505.0
    assert bench.block() == "open"  # by the limits that were loaded
    bench.plant["T"] = 25.0
    bench.blocks(60)
    bench.say("reset", who="A. Person", reason="test")
    bench.blocks(6)
    bench.say("arm")
    bench.blocks(10)
    assert not bench.relay
    assert bench.record("refused_arm").payload["why"] == "limits_file"


def test_journal_that_cannot_be_written_stops_the_rig() -> None:
    with Bench() as bench:
        bench.start().arm()
        assert bench.process is not None
        limit = os.path.getsize(bench.journal)
        resource.prlimit(bench.process.pid, resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
        bench.plant["n"] = 100.0
        bench.blocks(2)
        bench.say("disarm")  # refused, and that cannot be written
        words = [bench.block() for _ in range(30)]
        assert "open" in words
        assert not bench.relay
        assert "journal cannot be written" in bench.open_reason


# -- the watchdog's own life ------------------------------------------------------------------------


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_the_terminal_cannot_end_it(bench: Bench, number: int) -> None:
    bench.start().arm()
    assert bench.process is not None
    bench.process.send_signal(number)
    assert bench.blocks(10) == "edge"


def test_sigterm_while_armed_trips_waits_for_rest_and_ends(bench: Bench) -> None:
    bench.start().arm()
    bench.plant.update(n=100.0)
    bench.blocks(2)
    assert bench.process is not None
    bench.process.terminate()
    assert bench.answer()["m"] == "open"
    run_down(bench)
    assert bench.ended() == 4
    assert_tripped(bench, "terminated")


def test_sigterm_while_locked_ends(bench: Bench) -> None:
    bench.start().block()
    assert bench.process is not None
    bench.process.terminate()
    assert bench.ended() == 0


def test_after_a_trip_nobody_acknowledged_the_next_watchdog_stays_locked(bench: Bench) -> None:
    bench.start().arm()
    assert bench.block(doors_ok=False) == "open"
    bench.blocks(3)
    bench.record("trip")  # what was not written yet when it is killed, the next one cannot know
    assert bench.process is not None and bench.controller is not None and bench.rig is not None
    bench.process.kill()
    bench.process.wait()

    def again(*arguments: str) -> None:
        assert bench.process is not None and bench.controller is not None and bench.rig is not None
        for stream in (bench.process.stdout, bench.process.stderr):
            assert stream is not None
            stream.close()
        bench.controller.close()
        bench.rig.close()
        bench.k, bench.nonce, bench.relay = -1, 0, False
        bench.start(*arguments)

    again()
    bench.say("arm")
    bench.blocks(20)
    assert not bench.relay and "a door is open" in bench.status["cause"]
    assert bench.record("refused_arm").payload["why"] == "unacknowledged"
    bench.process.kill()
    bench.process.wait()
    again("--acknowledged-by", "A. Person", "--acknowledged-reason", "door closed, nobody inside")
    bench.arm()
    assert bench.record("acknowledged").payload["cause"] == "doors"


@pytest.mark.parametrize("own_process", [False, True])
def test_real_time_heartbeat_by_the_wall_clock(own_process: bool) -> None:
    edits = {"heartbeat_s = 0.14": "heartbeat_s = 0.30", "heartbeat_s = 0.15": "heartbeat_s = 0.30",
             "sample_s = 0.18": "sample_s = 1.0", "sample_s = 0.20": "sample_s = 1.0",
             "heartbeat_s = 3.0": "heartbeat_s = 3.0"}  # fmt: skip
    with Bench(own_process=own_process, clock="real", edits=edits) as bench:
        bench.start().arm()
        last_s = time.monotonic()
        bench.heartbeat()
        if bench.child is not None:
            bench.child.send_signal(signal.SIGSTOP)
        assert bench.answer()["m"] == "open"
        late_s = time.monotonic() - last_s
        assert 0.28 < late_s < 0.6
        run_down(bench)
        assert_tripped(bench, "heartbeat_late")
        assert "real_time_priority" in bench.record("started").payload


# -- options ----------------------------------------------------------------------------------------


def run_once(tmp_path: Path, **options: str) -> subprocess.CompletedProcess[str]:
    given = {
        "run-dir": str(tmp_path), "limits": str(SHIPPED_LIMITS), "journal": str(tmp_path / "journal.jsonl"),
        "link": "watchdog_link:FakeSafetyLink",
        "link-settings": json.dumps({"socket": str(tmp_path / "none.sock")}),
        "time": "virtual", "connect-timeout": "0.05", **options,
    }  # fmt: skip
    arguments = [part for key, value in given.items() for part in (f"--{key}", value)]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    return subprocess.run(
        [sys.executable, "-m", "rigctl.safety", *arguments], cwd=ROOT, env=environment, capture_output=True,
        text=True, check=False, timeout=20,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ({"limits": "/nowhere.toml"}, 2, "/nowhere.toml: cannot be read: No such file"),
        ({"link-settings": "{"}, 2, "--link-settings: '{': is no JSON"),
        ({"link-settings": "3"}, 2, "is no JSON object"),
        ({"acknowledged-by": "me"}, 2, "is not complete. Give both, or neither."),
        ({"link": "no_such_module:Link"}, 3, "cannot import 'no_such_module:Link'"),
        ({}, 3, "no process answers within 0.05 s"),
        ({"journal": "/nowhere/journal.jsonl"}, 3, "/nowhere/journal.jsonl"),
    ],
)
def test_what_is_wrong_at_the_start_is_told_in_one_line(
    tmp_path: Path, options: dict[str, str], code: int, words: str
) -> None:
    done = run_once(tmp_path, **options)
    assert done.returncode == code
    assert words in done.stderr
    assert "Traceback" not in done.stderr
