"""A missing library, port, bus or sound device: one clear message that names the device in the rig file and
says what to do; all other devices are examined as if nothing had happened."""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from rigctl.app import compose
from rigctl.core.errors import DeviceError
from rigctl.hal.devices import RigContext

ROOT = Path(__file__).resolve().parents[3]
LAB = ROOT / "configs" / "rigs" / "lab-example.toml"
WITHOUT = (
    "import sys; sys.modules.update(dict.fromkeys({modules!r})); from rigctl.app.cli import main; main()"
)

DEVICES_TEST = ("devices", "test", "--json")


def examined(rig: Path, *arguments: str, without: tuple[str, ...] = ()) -> dict[str, Any]:
    """`rigctl devices test --json` in a process where some modules cannot be imported: role -> report."""
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT.format(modules=without), *DEVICES_TEST, str(rig), *arguments],
        capture_output=True, text=True, timeout=120, check=False, cwd=ROOT,
    )  # fmt: skip
    assert done.returncode == 1, done.stderr
    assert "Traceback" not in done.stderr
    return {device["role"]: device for device in json.loads(done.stdout)["devices"]}


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """The laboratory's rig, with a port, a bus and a sound device that no machine has."""
    text = LAB.read_text().replace('"../', f'"{ROOT}/configs/')
    text = re.sub(r'channel = "can\d"', 'channel = "can97"', text)
    text = text.replace('device = "USB Audio"', 'device = "No such microphone"')
    path = tmp_path / "lab.toml"
    path.write_text(text)
    return path


def only_finding(device: dict[str, Any]) -> tuple[str, str]:
    (finding,) = device["findings"]
    assert device["result"] == "failed"
    return finding["problem"], finding["remedy"]


def test_missing_port_bus_and_sound_device(lab: Path):
    found = examined(lab)
    problem, remedy = only_finding(found["drive"])
    assert problem.startswith(f"{lab}: devices.drive: ") and "usb-FTDI_USB-RS485_drive" in problem
    assert "rigctl devices list" in remedy
    for role in ("pressure", "ventilator", "safety"):
        problem, remedy = only_finding(found[role])
        assert problem.startswith(
            f"{lab}: devices.{role}: buses.main: the socketcan interface 'can97' does not open"
        )
        assert "modprobe" in remedy or "ip link set can97 up" in remedy
    problem, remedy = only_finding(found["acquisition"])
    assert problem.startswith(f"{lab}: devices.acquisition.sources.microphone")
    assert "No such microphone" in problem or "PortAudio" in problem
    assert remedy


@pytest.mark.parametrize(
    ("module", "role", "library"),
    [
        ("pymodbus", "drive", "pymodbus"),
        ("can", "pressure", "can"),
        ("canopen", "ventilator", "canopen"),
        ("sounddevice", "acquisition", "sounddevice"),
        ("can", "safety", "can"),
    ],
)
def test_missing_library(lab: Path, module: str, role: str, library: str):
    problem, remedy = only_finding(examined(lab, "--role", role, without=(module,))[role])
    assert problem.startswith(f"{lab}: devices.{role}")
    assert library in problem
    assert remedy.startswith("Install ")


def test_a_missing_library_breaks_nothing_else(lab: Path):
    found = examined(lab, without=("can", "canopen", "sounddevice"))
    assert "cannot open" in only_finding(found["drive"])[0]
    code = WITHOUT.format(modules=("can", "canopen", "pymodbus", "serial", "sounddevice"))
    done = subprocess.run(
        [sys.executable, "-c", code, "check", "configs/programs/quick_check.toml"],
        capture_output=True, text=True, timeout=120, check=False, cwd=ROOT,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "The program can be run." in done.stdout


def test_a_run_names_the_device_in_the_rig_file_too(lab: Path, tmp_path: Path):
    config = compose.read_rig(lab)
    rig = compose.build_rig(config, RigContext(tmp_path, "real", None, str(lab), tmp_path))
    with pytest.raises(DeviceError) as caught:
        rig.open()
    assert str(caught.value).startswith(f"{lab}: devices.drive: ")
    assert "rigctl devices list" in caught.value.remedy


def test_an_unknown_bus_and_a_bench_that_does_not_run(
    lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("RIGCTL_BENCH_DIR", str(tmp_path / "no-bench"))
    text = re.sub(r'port = "/dev/[^"]*drive[^"]*"', 'port = "bench:drive"', lab.read_text())
    lab.write_text(re.sub(r'(\[devices\.pressure\].*?bus = )"main"', r'\1"mian"', text, flags=re.DOTALL))
    found = examined(lab, "--role", "drive", "--role", "pressure")
    assert "rigctl bench" in only_finding(found["drive"])[1]
    problem, remedy = only_finding(found["pressure"])
    assert "there is no bus 'mian'" in problem
    assert "main, watchdog" in remedy
