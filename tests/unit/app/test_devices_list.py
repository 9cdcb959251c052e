"""`rigctl devices list`: each part is asked by itself; third-party drivers are found by their entry points.

Packages are really installed for the process under test: a module and a ``.dist-info`` folder on its path.
"""

import builtins
import json
import os
import socket
import subprocess
import sys
import tempfile
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from drivers import listing
from rigctl.app.devices import devices_app
from rigctl.app.devices.listing import collect
from rigctl.core.errors import ConfigError, DeviceError
from rigctl.core.registry import Registry
from rigctl.hal.bench_paths import FOLDER_VARIABLE

WriteRig = Callable[..., Path]

BLOWER = """
class Blower:
    def __init__(self, settings, context):
        self._port = settings["port"]
    def open(self): ...
    def close(self): ...
    def identity(self):
        return {"maker": "Acme", "model": "Blower 3", "port": self._port}
    def set_flow(self, flow_m3_h):
        raise AssertionError("bring-up moves nothing")
"""


COMMAND = "from rigctl.app.devices import devices_app; devices_app()()"


def install(folder: Path, package: str, version: str, module: str, code: str, *points: str) -> None:
    """Install a package of one module, as pip would leave it behind."""
    (folder / f"{module}.py").write_text(code)
    info = folder / f"{module}-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: {version}\n")
    (info / "entry_points.txt").write_text("[rigctl.devices]\n" + "\n".join(points) + "\n")


def rigctl_devices(site: Path, *arguments: object) -> tuple[int, str, str]:
    done = subprocess.run(
        [sys.executable, "-c", COMMAND, *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": str(site)},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def site(tmp_path: Path) -> Path:
    folder = tmp_path / "site"
    folder.mkdir()
    install(folder, "acme-blower", "3.1", "acme_blower", BLOWER, "ventilator.acme = acme_blower:Blower")
    install(
        folder, "broken-drive", "0.1", "broken_drive", "raise RuntimeError('licence expired')",
        "drive.broken = broken_drive:Drive", "drive.noclass = broken_drive",
    )  # fmt: skip
    install(
        folder, "needy", "0.2", "needy", "import no_such_vendor_sdk\n", "drive.needy = needy:Drive"
    )  # fmt: skip
    return folder


def test_third_party_drivers_are_listed_used_and_break_only_themselves(site: Path, write_rig: WriteRig):
    code, text, err = rigctl_devices(site, "list", "--json")
    assert code == 0, err
    kinds = {(kind["role"], kind["kind"]): kind for kind in json.loads(text)["kinds of devices"]["found"]}
    acme = kinds["ventilator", "acme"]
    assert acme["origin"] == "acme-blower 3.1"
    assert acme["target"] == "acme_blower:Blower"
    assert acme["problem"] == ""
    assert "RuntimeError: licence expired" in kinds["drive", "broken"]["problem"]
    assert "does not name a class" in kinds["drive", "noclass"]["problem"]
    assert "Install the library that provides 'no_such_vendor_sdk'" in kinds["drive", "needy"]["problem"]
    assert kinds["drive", "simulated"] == {
        "role": "drive", "kind": "simulated", "target": "sim_hardware.devices.roles:SimulatedDrive",
        "origin": "rigctl", "problem": "",
    }  # fmt: skip

    rig = write_rig('port = "/dev/ttyUSB4"', ventilator="acme")
    code, text, err = rigctl_devices(site, "test", rig)
    assert code == 0, err
    assert "ventilator (acme): warning" in text
    assert "maker Acme, model Blower 3, port /dev/ttyUSB4" in text

    rig = write_rig('port = "x"', ventilator="acme", drive="broken")
    code, text, err = rigctl_devices(site, "test", rig)
    assert code == 1
    assert (
        f"{rig}: devices.drive.kind: importing 'broken_drive:Drive' fails: RuntimeError: licence expired."
        in text
    )
    assert "maker Acme" in text
    assert "1 of 5 failed: drive." in text
    assert "Traceback" not in text + err


def test_a_kind_of_two_packages_is_refused_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    install(tmp_path, "acme-blower", "3.1", "acme_blower_x", BLOWER, "ventilator.twin = acme_blower_x:Blower")
    install(
        tmp_path, "other-blower", "1.0", "other_blower_x", BLOWER, "ventilator.twin = other_blower_x:Blower"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ConfigError, match=r"acme-blower 3\.1, other-blower 1\.0\. Uninstall all but one"):
        Registry().target("ventilator", "twin")


@pytest.mark.parametrize(
    ("module", "part", "remedy"),
    [
        ("serial", "serial ports", "pip install pyserial"),
        ("can", "CAN interfaces", "pip install python-can"),
        ("sounddevice", "sound devices", "pip install sounddevice"),
    ],
)
def test_a_missing_library_is_one_line(module: str, part: str, remedy: str, monkeypatch: pytest.MonkeyPatch):
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.partition(".")[0] == module:
            raise ModuleNotFoundError(f"No module named {module!r}", name=module)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    parts = {entry.title: entry for entry in collect()}
    assert parts[part].rows == ()
    assert len(parts[part].remarks) == 1
    assert parts[part].remarks[0].endswith(f"{remedy}.")
    assert parts["kinds of devices"].rows


def fake_sound(**functions: Any) -> types.ModuleType:
    module = types.ModuleType("sounddevice")
    module.PortAudioError = type("PortAudioError", (Exception,), {})  # type: ignore[attr-defined]
    for name, function in functions.items():
        setattr(module, name, function)
    return module


def test_missing_portaudio_and_silent_sound_server(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "sounddevice", None)
    with pytest.raises(DeviceError, match="pip install sounddevice"):
        listing.sound_devices()
    monkeypatch.delitem(sys.modules, "sounddevice")
    real = builtins.__import__

    def without_portaudio(name: str, *rest: Any, **more: Any) -> Any:
        if name == "sounddevice":
            raise OSError("PortAudio library not found")
        return real(name, *rest, **more)

    with monkeypatch.context() as patch:
        patch.setattr(builtins, "__import__", without_portaudio)
        with pytest.raises(
            DeviceError, match=r"PortAudio library not found\. Install PortAudio: apt install"
        ):
            listing.sound_devices()

    silent = fake_sound()

    def refuse() -> None:
        raise silent.PortAudioError("Host error")  # type: ignore[attr-defined]

    silent.query_hostapis = refuse  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "sounddevice", silent)
    with pytest.raises(DeviceError, match=r"does not answer: Host error\. Start the sound server"):
        listing.sound_devices()


def test_sound_devices_with_inputs_and_their_rates(monkeypatch: pytest.MonkeyPatch):
    def device(index: int, name: str, inputs: int) -> dict[str, Any]:
        return {
            "index": index, "name": name, "hostapi": 0, "max_input_channels": inputs,
            "default_samplerate": 48000.0, "default_low_input_latency": 0.01,
        }  # fmt: skip

    def check(*, device: int, channels: int, samplerate: int, dtype: str) -> None:
        if samplerate not in (44_100, 48_000):
            raise module.PortAudioError("Invalid sample rate")  # type: ignore[attr-defined]

    module = fake_sound(
        query_hostapis=lambda: [{"name": "ALSA", "default_input_device": 1}],
        query_devices=lambda: [device(0, "speaker", 0), device(1, "rigmic", 2)],
        check_input_settings=check,
    )
    monkeypatch.setitem(sys.modules, "sounddevice", module)
    (found,) = listing.sound_devices()
    assert found == listing.SoundDevice("rigmic", "ALSA", 2, 48000.0, (44_100, 48_000), 0.01, True)


def test_no_sound_device_says_what_to_do(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(listing, "sound_devices", list)
    (part,) = [entry for entry in collect() if entry.title == "sound devices"]
    assert "start the sound server" in part.remarks[0]


def test_a_broken_vendor_library_is_a_remark(monkeypatch: pytest.MonkeyPatch):
    import can

    def detect(name: str) -> list[dict[str, str]]:
        if name == "pcan":
            raise AttributeError("module 'ctypes' has no attribute 'windll'")
        return [{"interface": "socketcan", "channel": "can0"}] if name == "socketcan" else []

    monkeypatch.setattr(can, "detect_available_configs", detect)
    found, remarks = listing.can_interfaces()
    assert found == [listing.CanInterface("socketcan", "can0")]
    assert remarks[0].startswith("pcan: cannot be searched: AttributeError")


def test_ports_of_a_bench_are_named_as_in_rig_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "none"))
    assert listing.bench_ports() == []
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    ours, theirs = os.openpty()
    try:
        (tmp_path / "drive").symlink_to(os.ttyname(theirs))
        (tmp_path / "left-over").symlink_to("/dev/pts/no-such-pty")
        (tmp_path / "bench.json").write_text("{}")
        assert listing.bench_ports() == [listing.BenchPort("bench:drive", os.ttyname(theirs))]
    finally:
        os.close(ours)
        os.close(theirs)


def test_the_microphone_of_a_bench_is_listed_while_its_server_lives(monkeypatch: pytest.MonkeyPatch):
    with tempfile.TemporaryDirectory(prefix="rl-") as name:  # short, for the path of a socket
        folder = Path(name)
        monkeypatch.setenv(FOLDER_VARIABLE, name)
        (folder / "sound").mkdir()
        (folder / "bench.json").write_text('{"microphone": {"device": "rigmic"}}')
        assert listing.bench_ports() == []
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as server:
            server.bind(str(folder / "sound" / "native"))
            server.listen()
            assert listing.bench_ports() == [
                listing.BenchPort("bench:rigmic", str(folder / "sound" / "native"))
            ]
            (folder / "bench.json").write_text('{"microphone": {}}')
            assert listing.bench_ports() == []
        (folder / "bench.json").write_text('{"microphone": {"device": "rigmic"}}')
        assert listing.bench_ports() == []  # it was killed


def test_the_command_prints_every_part():
    result = CliRunner().invoke(devices_app(), ["list"])
    assert result.exit_code == 0
    for title in (
        "serial ports",
        "CAN interfaces",
        "sound devices",
        "ports of a running bench",
        "kinds of devices",
    ):
        assert title in result.stdout
    assert "sim_hardware.devices.roles:SimulatedDrive" in result.stdout
