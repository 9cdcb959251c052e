"""The watchdog without a controller: it shows and journals what it sees, and the relay stays open."""

from __future__ import annotations

import re
import signal
import time

from can_safety_bench import WAIT_S, CanRig, CanWatchdog

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
