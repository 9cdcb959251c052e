"""`rigctl devices monitor`: values stay live beside devices that fail, hang or come back; it ends cleanly."""

import os
import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path

import devices_drivers
import pytest
from rich.console import Console

from rigctl.app.devices import monitor
from rigctl.app.devices.examine import RigFile

pytestmark = pytest.mark.usefixtures("kinds")
WriteRig = Callable[..., Path]


def text_of(watchers: list[monitor.Watcher]) -> str:
    console = Console(width=250, record=True, file=open(os.devnull, "w"))  # noqa: SIM115
    console.print(monitor.table(watchers))
    console.file.close()
    return console.export_text()


def watchers_of(rig: Path, *roles: str) -> list[monitor.Watcher]:
    file = RigFile.read(rig)
    context = file.context(rig.parent, None)
    opening = threading.Lock()
    return [monitor.Watcher(file, role, context, 0.02, opening) for role in roles]


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def test_a_device_that_fails_is_shown_and_opened_again(write_rig: WriteRig, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(monitor, "RETRY_S", 0.2)
    monkeypatch.setattr(devices_drivers.Flaky, "opened", 0)
    watchers = watchers_of(write_rig(drive="flaky", safety="plainsafety"), "drive", "safety")
    for watcher in watchers:
        watcher.start()
    wait_for(lambda: "has fallen silent. Check the cable." in text_of(watchers))
    shown = text_of(watchers)
    assert "devices.drive: /dev/ttyUSB0: has fallen silent." in shown
    assert "emergency stop released" in shown
    wait_for(lambda: watchers[0].view.failure == "")
    assert watchers[0].view.diagnosis is not None
    assert watchers[0].view.diagnosis.values[0].value == 2
    for watcher in watchers:
        watcher.stop()
    assert all(watcher.join(5) for watcher in watchers)
    assert devices_drivers.Flaky.closed.is_set()


def test_a_slow_device_holds_up_none(write_rig: WriteRig):
    slow, quick = watchers_of(write_rig(drive="hanging", pressure="gooddrive"), "drive", "pressure")
    started = time.monotonic()
    slow.start()
    quick.start()
    wait_for(lambda: quick.view.failure == "")
    assert time.monotonic() - started < 1.4
    assert slow.view.diagnosis is None
    wait_for(lambda: slow.view.diagnosis is not None)
    slow.stop()
    quick.stop()
    assert slow.join(5) and quick.join(5)


def test_ages_grow_while_a_device_is_gone(write_rig: WriteRig):
    (watcher,) = watchers_of(write_rig(drive="gooddrive"), "drive")
    assert "is being opened" in text_of([watcher])
    watcher.start()
    wait_for(lambda: watcher.view.failure == "")
    watcher.stop()
    assert watcher.join(5)
    time.sleep(0.2)
    row = next(line for line in text_of([watcher]).splitlines() if "speed" in line)
    assert "0.25 1/min" in row and "20/s" in row
    assert float(row.split("1/min")[1].split("ms")[0]) >= 200.0


def test_ctrl_c_ends_it_and_closes_the_devices(
    write_rig: WriteRig, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    calls: list[str] = []
    monkeypatch.setattr(devices_drivers.GoodDrive, "calls", calls)

    def press() -> None:
        wait_for(lambda: calls.count("diagnose 0") > 2)
        os.kill(os.getpid(), signal.SIGINT)

    # who runs the tests in the background of a shell ignores it
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    person = threading.Thread(target=press)
    person.start()
    try:
        file = RigFile.read(write_rig(drive="gooddrive"))
        failed = monitor.watch(file, ["drive"], tmp_path, every_s=0.05, duration_s=None, wire_log_dir=None)
    finally:
        signal.signal(signal.SIGINT, before)
        person.join()
    assert not failed
    assert calls[0] == "open"
    assert calls[-1] == "close"
    assert set(calls[1:-1]) == {"diagnose 0"}
