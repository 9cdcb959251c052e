"""The fault laboratory of a whole run: from the command line to the watchdog's trip, on the same block."""

import json
from pathlib import Path

from sim_hardware.devices.laboratory import SOCKET_NAME, Laboratory


def laboratory_of(cli, name: str) -> Laboratory:
    """The laboratory of a run that is just starting: asked before the first block."""
    command = Path(f"/proc/{cli.pid_of(name, 'controller')}/cmdline").read_bytes().decode().split("\0")
    return Laboratory(Path(command[command.index("--run-dir") + 1]), timeout_s=30.0)


def test_emergency_stop_at_a_given_time(cli):
    program = cli.program(pressures=[10], temperatures=[30], duration_s=600.0)
    run = cli.start_run(program, "a")
    with laboratory_of(cli, "a") as laboratory:
        laboratory.ask("estop", pressed=True, at_s=40.0)
        run_dir = laboratory._run_dir
    text, _ = run.communicate(timeout=90)
    assert run.returncode == 4, text + cli.logs("a")
    trip = next(r for r in cli.records("a") if r.kind == "trip")
    assert trip.payload["cause"] == "estop"
    assert 40.0 < (trip.rig_s or 0.0) <= 40.5
    assert any(r.kind == "safe_state_reached" for r in cli.records("a"))
    assert not (run_dir / SOCKET_NAME).exists()


def test_command_line(cli):
    program = cli.program(pressures=[2], temperatures=[30], duration_s=3000.0)
    run = cli.start_run(program, "a")
    cli.wait_for("a", lambda r: r.kind == "braking_started")
    here = ("--campaign", cli.folder / "a")
    code, text = cli.run("laboratory", "sensor", "channel=torque", "mode=offset", "value=5", *here)
    assert (code, text.strip()) == (0, "Sensor torque: offset by 5.")
    code, text = cli.run("laboratory", *here)
    assert json.loads(text)["sensors"]["torque"]["value"] == 5
    code, text = cli.run("laboratory", "doors", "open=maybe", *here)
    assert code == 1
    assert "true or false" in text
    code, text = cli.run("laboratory", "doors", "open=true", *here)
    assert code == 0, text
    text, _ = run.communicate(timeout=90)
    assert run.returncode == 4
    assert "door" in text
