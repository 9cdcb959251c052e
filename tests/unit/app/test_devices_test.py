"""`rigctl devices test`: devices are examined one by one, each failure has one clear message with remedy."""

import json
from collections.abc import Callable
from pathlib import Path

import devices_drivers
import pytest
from typer.testing import CliRunner

from rigctl.app.devices import devices_app
from rigctl.app.devices.examine import RigFile
from rigctl.core.errors import ConfigError
from rigctl.hal.diagnosis import Finding, Reading

pytestmark = pytest.mark.usefixtures("kinds")
WriteRig = Callable[..., Path]


def run(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(devices_app(), [str(argument) for argument in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.exit_code, result.stdout


def test_a_good_device_is_opened_asked_and_closed_and_nothing_else(
    write_rig: WriteRig, monkeypatch: pytest.MonkeyPatch
):
    calls: list[str] = []
    monkeypatch.setattr(devices_drivers.GoodDrive, "calls", calls)
    code, text = run("test", write_rig(drive="gooddrive"), "--role", "drive", "-n", 7)
    assert code == 0
    assert calls == ["open", "diagnose 7", "close"]
    assert "drive (gooddrive): ok" in text
    assert "maker Test, model M1" in text
    assert "0.25 1/min, 20/s, 10 ms old" in text
    assert "7 round trips" in text
    assert "p99" in text
    assert "None failed." in text


def test_unsafe_settings_fail_others_warn(write_rig: WriteRig, monkeypatch: pytest.MonkeyPatch):
    unsafe = Finding(
        "the drive keeps turning when the link is lost (30.18 = 0).", "Set 30.18 to 1.", unsafe=True
    )
    monkeypatch.setattr(devices_drivers.GoodDrive, "warnings", (unsafe,))
    code, text = run("test", write_rig(drive="gooddrive"), "--role", "drive")
    assert code == 1
    assert "unsafe the drive keeps turning when the link is lost (30.18 = 0)." in text
    assert "Set 30.18 to 1." in text
    monkeypatch.setattr(devices_drivers.GoodDrive, "warnings", (Finding("old firmware.", "Update."),))
    code, text = run("test", write_rig(drive="gooddrive"), "--role", "drive")
    assert code == 0
    assert "drive (gooddrive): warning" in text
    assert "look at the warnings of: drive" in text


def test_a_value_that_is_not_valid_is_no_number(write_rig: WriteRig, monkeypatch: pytest.MonkeyPatch):
    values = (
        Reading("temperature", None, "°C", fault="sensor open circuit (2.1 mA)"),
        Reading("x", float("nan")),
    )
    monkeypatch.setattr(devices_drivers.GoodDrive, "values", values)
    code, text = run("test", write_rig(drive="gooddrive"), "--role", "drive", "--json")
    report = json.loads(text)
    assert code == 0
    assert [value["value"] for value in report["devices"][0]["values"]] == [None, None]
    assert report["devices"][0]["findings"][0]["problem"] == "temperature: sensor open circuit (2.1 mA)."


def test_a_fault_on_the_board_fails(write_rig: WriteRig, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(devices_drivers.GoodDrive, "fault", "over-temperature of the motor")
    code, text = run("test", write_rig(drive="gooddrive"), "--role", "drive")
    assert code == 1
    assert "drive reports a fault: over-temperature of the motor." in text


def test_each_failure_is_its_own(write_rig: WriteRig):
    rig = write_rig(drive="silent", pressure="crashing", ventilator="no-such-kind", safety="plainsafety")
    code, text = run("test", rig)
    assert code == 1
    assert f"{rig}: devices.drive: /dev/ttyUSB7: no answer within 0.5 s.\n    Check its power." in text
    assert f"{rig}: devices.pressure: KeyError: 'serial number'." in text
    assert "fault in the driver devices_drivers:Crashing" in text
    assert f"{rig}: devices.ventilator.kind: ventilator has no kind 'no-such-kind'." in text
    assert "acquisition (simulated): simulated" in text
    assert "safety (plainsafety): warning" in text
    assert "emergency stop released      yes" in text
    assert "3 of 5 failed: drive, pressure, ventilator." in text
    assert "Traceback" not in text


def test_wrong_settings_and_missing_libraries_name_the_device(write_rig: WriteRig):
    rig = write_rig('typo = "x"', drive="gooddrive")
    assert f"{rig}: devices.drive: unknown setting 'typo'." in run("test", rig)[1]
    rig = write_rig(drive="uninstalled")
    code, text = run("test", rig, "--role", "drive")
    assert code == 1
    assert f"{rig}: devices.drive.kind: cannot import 'no_such_vendor_library:Drive'" in text
    assert "Install the library that provides 'no_such_vendor_library'." in text


def test_json_is_complete(write_rig: WriteRig):
    rig = write_rig(drive="gooddrive", pressure="silent")
    code, text = run("test", rig, "--json", "-n", 20)
    report = json.loads(text)
    assert code == 1
    assert report["result"] == "failed"
    by_role = {device["role"]: device for device in report["devices"]}
    assert list(by_role) == ["drive", "pressure", "ventilator", "acquisition", "safety"]
    assert by_role["drive"]["class"] == "devices_drivers:GoodDrive"
    assert by_role["drive"]["round_trip_s"]["count"] == 20
    assert by_role["pressure"]["result"] == "failed"
    assert by_role["pressure"]["findings"][0]["remedy"] == "Check its power."
    assert by_role["safety"]["result"] == "simulated"


def test_a_rig_of_simulated_devices_has_nothing_to_test(configs: Path):
    code, text = run("test", configs / "rigs" / "simulated.toml")
    assert code == 0
    assert "nothing to bring up" in text


def test_a_wrong_rig_file_is_told_as_everywhere(tmp_path: Path):
    with pytest.raises(ConfigError, match="no such file"):
        RigFile.read(tmp_path / "none.toml")
