"""The watchdog without a controller: it shows and journals what it sees, and the relay stays open."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

from can_safety_bench import ROOT, WAIT_S, CanRig, CanWatchdog

from sim_hardware.bench.can import FaultRule


def test_it_shows_values_and_verdicts_and_leaves_the_relay_open() -> None:
    with CanRig() as rig, CanWatchdog(rig) as watch:
        rig.plant.update(torque_nm=380.0, disc_temperature_degc=120.0)
        watch.start("--supervise", "--every", "0.2")
        watch.wait_for(lambda: watch.kinds().count("seen") >= 2, "values")
        rig.can.disturb("current_input", wire="broken")
        rig.signals.set(doors_ok=False)
        watch.wait_for(lambda: "doors" in str(watch.records()[-1].payload.get("verdicts")), "verdicts")
        rig.can.add_fault(FaultRule(kind="mute", node=0x30))
        watch.wait_for(lambda: "safety_channel" in str(watch.records()[-1].payload.get("verdicts")), "mute")
        assert watch.watchdog is not None
        watch.watchdog.send_signal(signal.SIGINT)
        assert watch.watchdog.wait(WAIT_S) == 0
        seen = [record.payload for record in watch.records() if record.kind == "seen"]
        first = next(payload for payload in seen if payload["torque_nm"] is not None)
        assert abs(first["torque_nm"] - 380.0) < 1.0 and abs(first["temperature_degc"] - 120.0) < 1.0
        assert first["estop_ok"] and first["doors_ok"] and not first["relay_closed"]
        assert watch.kinds()[0] == "started" and watch.records()[0].payload["supervises_only"] is True
        total = watch.records()[-1]
        assert total.kind == "supervised" and total.payload["samples"] >= 10
        assert {"doors", "temperature_invalid", "safety_channel"} <= set(total.payload["verdicts"])
        assert re.search(r"watchdog: seen at .*: pressure 0\.\d\d, speed .*torque 38\d\.", watch.logs())
        assert rig.signals.relay_at_s == [] and not rig.relay


def test_it_ends_after_the_time_given_and_takes_no_controller() -> None:
    with CanRig() as rig, CanWatchdog(rig) as watch:
        started_s = time.monotonic()
        watch.start("--supervise", "--for", "1.0")
        assert watch.watchdog is not None and watch.watchdog.wait(WAIT_S) == 0
        assert time.monotonic() - started_s >= 1.0
        assert not (watch.folder / "watchdog.sock").exists()


def test_a_bus_without_a_safety_node_is_told_with_what_was_heard() -> None:
    with CanRig() as rig, CanWatchdog(rig) as watch:
        rig.can.power("safety_io", on=False)
        watch.start("--supervise", "--connect-timeout", "1.5")
        assert watch.watchdog is not None and watch.watchdog.wait(WAIT_S) == 3
        words = watch.logs()
        assert "safety I/O 30h on bus 'main': sends no state (1B0h) within 1.5 s" in words
        assert "1A0h" in words and "Check its supply" in words and "Traceback" not in words


def test_the_options_for_a_rig_file(tmp_path: Path) -> None:
    text = (ROOT / "configs" / "rigs" / "simulated.toml").read_text(encoding="utf-8")
    assert '[devices.safety]\nkind = "simulated"' in text
    table = '[devices.safety]\nkind = "can"\nbus = "main"\n[buses.main]\ninterface = "socketcan"'
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text(text.replace('[devices.safety]\nkind = "simulated"', table), encoding="utf-8")

    def options(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "drivers.safety_io", *arguments]
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)

    lines = options(str(rig_file), "--start-sensors").stdout.splitlines()
    assert lines[:3] == ["--link", "drivers.safety_io.watchdog_link:CanSafetyLink", "--link-settings"]
    settings = json.loads(lines[3])
    assert settings["bus"] == {"interface": "socketcan"}
    assert settings["channel"]["start_nodes"] == [0x20, 0x21, 0x22, 0x30]
    assert json.loads(options(str(rig_file)).stdout.splitlines()[3])["channel"]["start_nodes"] == [0x30]
    refused = options(str(ROOT / "configs" / "rigs" / "simulated.toml"))
    assert refused.returncode == 2 and "devices.safety: is of kind 'simulated'" in refused.stderr
