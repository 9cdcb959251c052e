"""What every speed drive must do, on the simulated drive and on both drivers with their emulators."""

import contextlib
import math
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from speed_drive_rigs import DriveUnderTest, emulated, simulated, until

from rigctl.core.errors import DeviceError
from rigctl.hal.wirelog import read_wire_log

KINDS = ("simulated", "modbus", "eurotherm590")
REAL = ("modbus", "eurotherm590")


@pytest.fixture(params=KINDS)
def rig(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[DriveUnderTest]:
    with simulated(tmp_path) if request.param == "simulated" else emulated(tmp_path, request.param) as under:
        under.drive.open()
        yield under


@pytest.fixture(params=REAL)
def real(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[DriveUnderTest]:
    with emulated(tmp_path, request.param) as under:
        under.drive.open()
        yield under


def _run_at(under: DriveUnderTest, speed_rpm: float = 100.0) -> None:
    under.drive.enable()
    under.drive.set_speed(speed_rpm, 500.0)
    until(lambda: abs(under.speed_set_rpm() - speed_rpm) < 0.1, what="set-point at the plant")
    until(under.torque_on, what="torque")


def _reports(under: DriveUnderTest, speed_rpm: float) -> bool:
    with contextlib.suppress(DeviceError):
        return abs(under.drive.actual_rpm - speed_rpm) < 0.3
    return False


def _error(under: DriveUnderTest, timeout_s: float = 4.0) -> DeviceError:
    """The error that the drive's thread remembers, as the next call raises it."""
    end_s = time.monotonic() + timeout_s
    while time.monotonic() < end_s:
        try:
            under.drive.set_speed(0.0, 100.0)
        except DeviceError as error:
            return error
        time.sleep(0.01)
    raise AssertionError("no DeviceError came")


# -- every drive ------------------------------------------------------------------------------------


def test_after_open_it_is_safe(rig: DriveUnderTest) -> None:
    assert not rig.torque_on()
    assert not rig.drive.enabled
    assert rig.drive.commanded_rpm == 0.0
    assert rig.drive.identity()["model"]


def test_enable_starts_at_zero_speed_and_set_speed_arrives(rig: DriveUnderTest) -> None:
    rig.drive.enable()
    assert rig.drive.enabled
    assert rig.drive.commanded_rpm == 0.0
    rig.drive.set_speed(40.0, 60.0)
    assert rig.drive.commanded_rpm == 40.0
    until(lambda: abs(rig.speed_set_rpm() - 40.0) < 0.1, what="set-point at the plant")


def test_disable_takes_the_torque(rig: DriveUnderTest) -> None:
    _run_at(rig)
    rig.drive.disable()
    assert not rig.drive.enabled
    until(lambda: not rig.torque_on(), 1.0, "torque off")


def test_quick_stop_ends_without_torque(rig: DriveUnderTest) -> None:
    _run_at(rig)
    rig.drive.quick_stop()
    assert rig.drive.commanded_rpm == 0.0
    until(lambda: not rig.torque_on(), 5.0, "torque off after the quick stop")


def test_zero_speed_is_always_accepted(rig: DriveUnderTest) -> None:
    rig.drive.set_speed(0.0, 60.0)
    rig.drive.enable()
    rig.drive.set_speed(0.0, 60.0)
    assert rig.drive.commanded_rpm == 0.0


@pytest.mark.parametrize("speed_rpm", [math.nan, math.inf, -math.inf])
def test_a_set_point_that_is_no_number_is_refused(rig: DriveUnderTest, speed_rpm: float) -> None:
    rig.drive.enable()
    with pytest.raises(DeviceError, match="refuses"):
        rig.drive.set_speed(speed_rpm, 60.0)
    with pytest.raises(DeviceError, match="refuses"):
        rig.drive.set_speed(10.0, speed_rpm)
    assert rig.drive.commanded_rpm == 0.0


def test_it_can_be_closed_twice(rig: DriveUnderTest) -> None:
    rig.drive.close()
    rig.drive.close()


# -- drives on wires --------------------------------------------------------------------------------


def test_open_relay_keeps_the_torque_away(real: DriveUnderTest) -> None:
    real.close_relay(False)
    real.drive.enable()
    assert "did not start" in str(_error(real))
    assert not real.torque_on()
    assert not real.drive.enabled


def test_relay_that_opens_needs_a_new_enable(real: DriveUnderTest) -> None:
    _run_at(real)
    real.close_relay(False)
    assert "torque away by itself" in str(_error(real))
    real.close_relay(True)
    time.sleep(0.2)
    assert not real.torque_on()
    _run_at(real, 50.0)


def test_actual_speed_is_the_shafts(real: DriveUnderTest) -> None:
    assert real.shaft is not None
    _run_at(real, 123.0)
    until(lambda: abs(real.shaft.speed_rpm - 123.0) < 0.2, what="shaft at speed")
    until(lambda: _reports(real, 123.0), what="reported speed")
    assert real.context.board.snapshot()["enabled"] is True


def test_ramp_reaches_the_plant(real: DriveUnderTest) -> None:
    assert real.signals is not None
    real.drive.enable()
    real.drive.set_speed(200.0, 50.0)
    until(lambda: abs(real.speed_set_rpm() - 200.0) < 0.1, what="set-point")
    assert real.signals.get("speed_ramp_rpm_per_s") == pytest.approx(50.0, rel=1e-3)


def test_lost_control_loop_ends_the_torque(real: DriveUnderTest) -> None:
    _run_at(real)
    real.loop.stop()
    until(lambda: not real.torque_on(), 1.5, "torque off")
    assert "control loop" in str(_error(real))
    with pytest.raises(DeviceError, match="control loop is not running"):
        real.drive.enable()


def test_speed_without_enable_is_refused(real: DriveUnderTest) -> None:
    with pytest.raises(DeviceError, match="not enabled"):
        real.drive.set_speed(10.0, 60.0)


def test_set_points_beyond_the_drive_are_refused(real: DriveUnderTest) -> None:
    real.drive.enable()
    with pytest.raises(DeviceError, match="ends at 1000"):
        real.drive.set_speed(1000.1, 60.0)
    with pytest.raises(DeviceError, match="ramps are"):
        real.drive.set_speed(100.0, 0.01)


def test_a_trip_is_named_and_stays(real: DriveUnderTest) -> None:
    assert real.port is not None
    _run_at(real)
    real.port.command({"do": "trip", "code": 0x2310})
    error = str(_error(real))
    assert "overcurrent" in error or "current trip" in error
    assert not real.torque_on()
    assert "tripped" in real.context.board.snapshot()["faults"]["drive"]
    with pytest.raises(DeviceError, match="refuses to enable: tripped"):
        real.drive.enable()


def test_its_own_loss_of_communication_is_reset_by_enable(real: DriveUnderTest) -> None:
    assert real.port is not None
    _run_at(real)
    real.port.command({"do": "fault", "kind": "mute", "for_s": 2.0})
    until(lambda: not real.torque_on(), 2.0, "the drive's own supervision")
    assert "link failed" in str(_error(real))
    until(lambda: _recovered(real), 6.0, "recovery")
    _run_at(real, 30.0)


def _recovered(real: DriveUnderTest) -> bool:
    try:
        real.drive.set_speed(0.0, 100.0)
    except DeviceError:
        return False
    return real.drive.diagnose(0).values[1].fault == ""


def test_pulled_plug_is_an_error_and_the_drive_comes_back(real: DriveUnderTest) -> None:
    assert real.port is not None
    _run_at(real)
    real.port.command({"do": "unplug", "for_s": 1.5})
    assert "link failed" in str(_error(real))
    until(lambda: not real.torque_on(), 2.0, "torque off")
    with pytest.raises(DeviceError):
        real.drive.enable()
    until(lambda: _recovered(real), 6.0, "recovery")
    assert not real.torque_on()
    _run_at(real, 30.0)


def test_diagnosis(real: DriveUnderTest) -> None:
    diagnosis = real.drive.diagnose(20)
    assert len(diagnosis.round_trip_s) == 20
    assert all(0.001 < time_s < 1.0 for time_s in diagnosis.round_trip_s)
    assert not diagnosis.warnings
    assert diagnosis.values[0].name == "speed"


# -- faults of the wire -----------------------------------------------------------------------------

WIRE_FAULTS = {
    "a lost answer": {"kind": "drop", "per": "message", "direction": "to_host", "count": 1},
    "a lost request": {"kind": "drop", "per": "message", "direction": "to_device", "count": 1},
    "lost bytes": {"kind": "drop", "probability": 0.01},
    "flipped bits": {"kind": "corrupt", "probability": 0.01},
    "doubled bytes": {"kind": "duplicate", "probability": 0.005},
    "late answers": {"kind": "delay", "direction": "to_host", "silence_s": 0.15, "probability": 0.1},
    "torn messages": {"kind": "split", "silence_s": 0.03, "probability": 0.005},
    "doubled answers": {"kind": "duplicate", "per": "message", "direction": "to_host", "probability": 0.1},
}
#: A fault may strike so often; the drive is watched for so long after that, but no longer than …
ENOUGH, AFTERWARDS_S, LONGEST_S = 5, 0.4, 3.0


@pytest.mark.parametrize("name", WIRE_FAULTS)
def test_no_fault_of_the_wire_makes_a_wrong_value(real: DriveUnderTest, name: str) -> None:
    assert real.port is not None
    assert real.shaft is not None
    _run_at(real, 100.0)
    until(lambda: _reports(real, 100.0), what="steady speed")
    fault = WIRE_FAULTS[name]
    enough = min(fault.get("count", ENOUGH), ENOUGH)
    real.port.command({"do": "fault", **fault})
    end_s = time.monotonic() + LONGEST_S
    struck, failed, seen = 0, False, False
    while time.monotonic() < end_s and not failed:
        struck = sum(real.port.command({"do": "counts"})["struck"].values())
        if struck >= enough and not seen:  # and what the last one did
            seen, end_s = True, min(end_s, time.monotonic() + AFTERWARDS_S)
        with contextlib.suppress(DeviceError):  # no fresh value is no wrong value
            assert abs(real.drive.actual_rpm - 100.0) < 0.3 or not real.drive.enabled
        try:
            real.drive.set_speed(100.0, 500.0)
        except DeviceError:
            failed = True
        assert abs(real.speed_set_rpm() - 100.0) < 0.1 or not real.torque_on() or not real.drive.enabled
        time.sleep(0.005)
    assert struck > 0, "the fault never struck"
    if failed:
        until(lambda: not real.torque_on(), 2.0, "safe state")
    else:
        assert real.drive.enabled
    real.port.command({"do": "clear"})


# -- dangerous settings -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("parameters", "complaint"),
    [
        ({"58.16": 3.0}, "after 3 s"),
        ({"58.16": 0.0}, "after 0 s"),
        ({"58.14": 0}, "no action"),
        ({"58.14": 2}, "last speed"),
        ({"58.15": 2}, "any message"),
        ({"46.01": 1500.0}, "every speed would be wrong"),
    ],
)
def test_dangerous_settings_of_the_abb_drive(
    tmp_path: Path, parameters: dict[str, float], complaint: str
) -> None:
    with emulated(tmp_path, "modbus", parameters=parameters) as under:
        under.drive.open()
        with pytest.raises(DeviceError, match=complaint):
            under.drive.enable()
        assert any(finding.unsafe for finding in under.drive.diagnose(1).warnings)
        assert not under.torque_on()


@pytest.mark.parametrize("kind", REAL)
def test_a_port_that_is_not_there(tmp_path: Path, kind: str) -> None:
    absent = str(tmp_path / "nothing")
    with (
        emulated(tmp_path, kind, port=absent) as under,
        pytest.raises(DeviceError, match=r"nothing.*Check cable"),
    ):
        under.drive.open()


@pytest.mark.parametrize("kind", REAL)
def test_over_tcp(tmp_path: Path, kind: str) -> None:
    with emulated(tmp_path, kind, tcp=True) as under:
        under.drive.open()
        _run_at(under)
        under.drive.disable()


# -- transcripts ------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", REAL)
def test_start_sequence_on_the_wire(tmp_path: Path, kind: str) -> None:
    """The writes from "off" to "running at 100 1/min", byte for byte; repetitions are written once."""
    golden = Path(__file__).parent / "golden" / f"speed_drive_{kind}_start.txt"
    with emulated(tmp_path, kind) as under:
        assert under.signals is not None
        under.context.wire_log_dir = tmp_path
        under.drive = type(under.drive)(under.extra["settings"], under.context)
        under.drive.open()
        try:
            under.drive.set_speed(0.0, 500.0)
            until(lambda: under.signals.get("speed_ramp_rpm_per_s") == 500.0, what="ramp")
            _run_at(under, 100.0)
            log = next(tmp_path.glob("*.log"))
        finally:
            under.drive.close()
        sent = [data for _, way, data in read_wire_log(log) if way == ">" and _writes(kind, data)]
    lines: list[str] = []
    for data in sent:
        line = data.hex(" ")
        if line not in lines[-3:]:
            lines.append(line)
    expected = [line for line in golden.read_text().splitlines() if line and not line.startswith("#")]
    assert lines[: len(expected)] == expected


def _writes(kind: str, data: bytes) -> bool:
    return data[1] == 0x10 if kind == "modbus" else 0x02 in data
