"""`rigctl manual`, `rigctl control` and `rigctl sessions` as a person at a terminal uses them."""

import json
import signal
import time
from pathlib import Path

import pytest

from rigctl.app.control_socket import COMMAND, ControlClient
from rigctl.app.sessions import running_sessions
from rigctl.engine.state import Progress
from rigctl.recording.braking_file import read_braking


@pytest.fixture
def session(cli):
    process = cli.start(
        "manual", "--rig", cli.rig, "--out", cli.folder, "--name", "hand", "--seed", 1, "--time", "virtual",
        "--no-report",
    )  # fmt: skip
    deadline = time.monotonic() + 90.0
    while time.monotonic() < deadline:
        found = [s for s in running_sessions() if s.campaign == (cli.folder / "hand").resolve()]
        if found:
            return process, found[0]
        assert process.poll() is None, process.stdout.read()
        time.sleep(0.05)
    raise AssertionError("no session")


def wait_for(client: ControlClient, condition) -> Progress:
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline:
        news = client.recv(1.0)
        if isinstance(news, Progress) and condition(news):
            return news
    raise AssertionError("did not happen")


def test_a_braking_by_hand_from_the_terminal(cli, session):
    process, found = session
    campaign = f"--campaign={found.campaign}"
    code, text = cli.run("sessions", "--json")
    assert code == 0
    assert {row["mode"] for row in json.loads(text) if row["campaign"] == str(found.campaign)} == {"manual"}

    code, text = cli.run("control", "set_speed", "speed_rpm=50", campaign)
    assert (code, "Enable it first" in text) == (1, True)
    assert cli.run("control", "enable", campaign)[0] == 0
    code, text = cli.run("control", "set_speed", "speed_rpm=5000", campaign)
    assert (code, "outside 0 … 800" in text) == (1, True)
    with_comment = ("duration_s=1", "speed_rpm=40", "pressure_bar=20", "comment=first try")
    assert cli.run("control", "record", *with_comment, campaign)[0] == 0
    client = ControlClient(found.run_dir, 5.0, who="test", role=COMMAND)
    wait_for(client, lambda p: p.done == 1 and p.phase in ("ready", "by hand"))
    client.close()
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 0, out
    assert "1 brakings by hand" in out
    braking = read_braking(Path(found.campaign) / "brakings" / "00001.h5")
    assert (braking.status, braking.summary["note"]) == ("complete", "first try")
    assert braking.results["pressure_mean_bar"] == pytest.approx(20.0, abs=1.0)
    assert braking.channels.specs["microphone"].rate_hz == 40000
    assert braking.channels.specs["torque"].rate_hz == 1000


def test_emergency_stop_in_a_manual_session_is_reset_in_words(cli, session):
    process, found = session
    campaign = f"--campaign={found.campaign}"
    cli.run("control", "enable", campaign)
    client = ControlClient(found.run_dir, 5.0, who="test", role=COMMAND)
    client.command("set_speed", speed_rpm=50.0)
    wait_for(client, lambda p: p.speed_rpm > 45.0)
    assert cli.run("laboratory", "estop", "pressed=true", campaign)[0] == 0
    tripped = wait_for(client, lambda p: p.state.value == "faulted" and "emergency stop" in p.cause)
    assert not tripped.relay
    wait_for(client, lambda p: abs(p.speed_rpm) < 1.0)
    client.close()
    code, text = cli.run("control", "reset", "reason=too early", campaign)
    assert (code, "emergency stop" in text) == (1, True)
    cli.run("laboratory", "estop", "pressed=false", campaign)
    deadline = time.monotonic() + 30.0  # the watchdog wants to see the rig at rest for two seconds
    while (code := cli.run("control", "reset", "reason=released", campaign)[0]) != 0:
        assert time.monotonic() < deadline
    assert cli.run("control", "enable", campaign)[0] == 0
    assert cli.run("control", "end", campaign)[0] == 0
    assert process.wait(timeout=60) == 0


def test_control_says_that_nothing_runs(cli):
    code, text = cli.run("control", "stop", f"--campaign={cli.folder}")
    assert (code, "is not running" in text) == (2, True)
