"""Kill or freeze any process of a run: safe state, journal, exit code, and nothing acknowledged is lost."""

import contextlib
import os
import signal
import subprocess
import time

import h5py
import pytest

from rigctl.core.journal import verify_journal


def committed(cli, name: str) -> dict[int, str]:
    """Index -> status of all brakings that the recorder has acknowledged."""
    return {
        r.payload["index"]: r.payload["status"] for r in cli.records(name) if r.kind == "BRAKING_COMMITTED"
    }


def assert_all_readable(cli, name: str) -> None:
    for index, status in committed(cli, name).items():
        with h5py.File(cli.folder / name / "brakings" / f"{index:05d}.h5") as file:
            assert file["entry/braking/status"][()].decode() == status
            assert status != "complete" or len(file["entry/pressure/value"]) > 20_000
    assert verify_journal(cli.folder / name / "journal.jsonl") == []


def wait_for_braking(cli, name: str, index: int) -> None:
    """Until braking `index` is being recorded (its predecessor is committed and its spool exists)."""
    cli.wait_for(name, lambda r: r.kind == "braking_started" and r.payload["index"] == index)
    deadline = time.monotonic() + 60
    spool = cli.folder / name / "spool" / f"{index:05d}.spool"
    while not spool.exists() and time.monotonic() < deadline:
        time.sleep(0.005)
    assert spool.exists(), cli.logs(name)


@pytest.mark.parametrize("process", ["controller", "watchdog", "recorder"])
def test_killed_process(cli, process: str):
    program = cli.program(pressures=[10, 12, 14], temperatures=[30], duration_s=20.0)
    run = cli.start_run(program, "a")
    wait_for_braking(cli, "a", 2)
    os.kill(cli.pid_of("a", process), signal.SIGKILL)
    text, _ = run.communicate(timeout=90)
    assert run.returncode in (1, 4), text + cli.logs("a")
    assert "rigctl resume" in text
    before = committed(cli, "a")
    assert before.get(1) == "complete"
    assert_all_readable(cli, "a")
    if process == "watchdog":
        assert "safety relay opened: the watchdog has gone" in cli.logs("a")
        assert any(r.kind == "at_rest_after_trip" for r in cli.records("a"))
    else:
        safe = [r for r in cli.records("a") if r.kind in ("safe_state_reached", "disarmed")]
        assert safe, cli.logs("a")
    if process == "controller":
        trip = next(r for r in cli.records("a") if r.kind == "trip")
        assert trip.source == "watchdog"
        assert trip.payload["cause"] == "controller_gone"
        assert run.returncode == 4
    # what the spool held is a file now, and resume goes on with the first braking that is not complete
    code, text = cli.run("resume", cli.folder / "a", "--no-report")
    assert code == 0, text + cli.logs("a")
    assert {i for i, status in committed(cli, "a").items() if status == "complete"} == {1, 2, 3}
    assert_all_readable(cli, "a")


def test_frozen_controller_trips_and_the_run_ends(cli):
    program = cli.program(pressures=[2], temperatures=[30], duration_s=3000.0)
    run = cli.start_run(program, "a")
    wait_for_braking(cli, "a", 1)
    os.kill(cli.pid_of("a", "controller"), signal.SIGSTOP)
    text, _ = run.communicate(timeout=120)
    assert run.returncode == 4, text + cli.logs("a")
    trip = next(r for r in cli.records("a") if r.kind == "trip")
    assert trip.payload["cause"] == "heartbeat_late"
    safe = cli.wait_for("a", lambda r: r.kind == "safe_state_reached")
    assert safe.source == "watchdog"


def test_frozen_watchdog_opens_the_relay(cli):
    cli.rig = cli.edited_config(
        "rigs/simulated.toml",
        (r'^\[devices.safety\]\nkind = "simulated"', "\\g<0>\nrelay_timeout_s = 2.0"),
    )
    program = cli.program(pressures=[2], temperatures=[30], duration_s=3000.0)
    run = cli.start_run(program, "a")
    wait_for_braking(cli, "a", 1)
    pid = cli.pid_of("a", "watchdog")
    os.kill(pid, signal.SIGSTOP)
    try:
        ended = cli.wait_for("a", lambda r: (r.source, r.kind) == ("controller", "ended"))
        assert ended.payload["cause"] == "the safety relay has opened."
    finally:  # it stays frozen for longer: test_processes.py
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGCONT)
    text, _ = run.communicate(timeout=120)
    assert run.returncode != 0, text
    assert "safety relay opened: no edge of the watchdog in time" in cli.logs("a")


def test_over_temperature_ends_in_the_safe_state(cli):
    """The disc is conditioned to 120 °C, the watchdog allows 90: it trips, whatever the controller thinks."""
    limits = cli.edited_config(
        "limits/a_class.toml",
        (r"^max_degc = .*", "max_degc = 90.0"),
        (r"^approach_from_degc = .*", "approach_from_degc = 60.0"),
    )
    cli.rig = cli.edited_config(
        "rigs/simulated.toml", (r'^limits = "../limits/a_class.toml"', f'limits = "{limits}"')
    )
    run = cli.start_run(cli.program(pressures=[10], temperatures=[120]), "a")
    text, _ = run.communicate(timeout=90)
    assert run.returncode == 4, text + cli.logs("a")
    assert "SAFETY TRIP" in text
    trip = next(r for r in cli.records("a") if r.kind == "trip")
    assert trip.payload["cause"] in ("temperature_range", "temperature_approach")
    kinds = [(r.source, r.kind) for r in cli.records("a")]
    assert ("watchdog", "safe_state_reached") in kinds
    assert ("controller", "at_rest_after_trip") in kinds
    # the trip wants a person's word
    code, text = cli.run("resume", cli.folder / "a", "--no-report")
    assert code == 4
    assert "--acknowledge" in text


def test_ctrl_c_stops_safely_and_says_how_to_go_on(cli):
    program = cli.program(pressures=[0.5, 0.6], temperatures=[30], duration_s=120.0)
    run = cli.start_run(program, "a")
    wait_for_braking(cli, "a", 1)
    run.send_signal(signal.SIGINT)
    text, _ = run.communicate(timeout=90)
    assert run.returncode == 3, text + cli.logs("a")
    assert "Stopped safely" in text
    assert f"rigctl resume {cli.folder / 'a'}" in text
    assert any(r.kind == "disarmed" for r in cli.records("a"))
    assert committed(cli, "a").get(1) in (None, "incomplete")
    code, text = cli.run("resume", cli.folder / "a", "--no-report")
    assert code == 0, text + cli.logs("a")
    assert {i for i, status in committed(cli, "a").items() if status == "complete"} == {1, 2}


def test_killed_supervisor_leaves_an_orderly_end(cli):
    """The window from which a run was started is gone: the controller stops by itself."""
    program = cli.program(pressures=[2], temperatures=[30], duration_s=3000.0)
    run = cli.start_run(program, "a")
    wait_for_braking(cli, "a", 1)
    run.kill()
    run.wait()
    ended = cli.wait_for("a", lambda r: (r.source, r.kind) == ("controller", "ended"))
    assert ended.payload["outcome"] == "stopped"
    cli.wait_for("a", lambda r: (r.source, r.kind) == ("watchdog", "disarmed"))


def test_killed_rig_server_ends_the_run(cli):
    program = cli.program(pressures=[2], temperatures=[30], duration_s=3000.0)
    run = cli.start_run(program, "a")
    wait_for_braking(cli, "a", 1)
    pattern = f"sim_hardware.devices.server.*{cli.folder}"
    found = subprocess.run(["pgrep", "-f", pattern], capture_output=True, text=True, check=True)
    os.kill(int(found.stdout.split()[0]), signal.SIGKILL)
    text, _ = run.communicate(timeout=90)
    assert run.returncode in (1, 4), text
    assert "rigctl resume" in text


def test_second_run_in_the_same_campaign_is_refused(cli):
    program = cli.program(pressures=[2], temperatures=[30], duration_s=3000.0)
    run = cli.start_run(program, "a")
    wait_for_braking(cli, "a", 1)
    code, text = cli.run("resume", cli.folder / "a", "--no-report")
    assert code == 1
    assert "another process" in text
    code, text = cli.run("run", program, "--rig", cli.rig, "--out", cli.folder, "--name", "a")
    assert code == 2
    assert "exists already" in text
    run.send_signal(signal.SIGINT)
    run.communicate(timeout=60)
    assert run.returncode == 3
