"""Calibrations on disk: round trip, nothing overwritten, in force and due; what they do to a channel."""

from datetime import UTC, date, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from rigctl.calibration.record import Calibration, Due, Point, Quantity
from rigctl.calibration.store import due_lines, history, in_force, rig_folder, save
from rigctl.core.channels import ChannelCorrection, ChannelData, ChannelSpec, corrected
from rigctl.core.errors import ConfigError, DeviceError

WHEN = datetime(2026, 11, 30, 9, 30, tzinfo=UTC)


def calibration(**changes: object) -> Calibration:
    values = {
        "quantity": Quantity.TORQUE, "channel": "torque", "unit": "N·m", "rig": "rig A", "date": WHEN,
        "operator": "Meier", "gain": 1.002, "offset": -0.4, "figures": {"residual_percent": 0.08},
        "points": (Point(applied=0, measured=0.4), Point(applied=500, measured=499.4, series="right up")),
        "valid_days": 365,
    }  # fmt: skip
    return Calibration.model_validate({**values, **changes})


def test_round_trip_and_nothing_is_overwritten(tmp_path: Path):
    folder = rig_folder(tmp_path, "A-class front brake, simulated rig")
    assert folder.name == "a-class-front-brake-simulated-rig"
    first = save(folder, calibration())
    second = save(folder, calibration(gain=1.01))
    assert first != second
    assert sorted(path.suffix for path in folder.iterdir()) == [".toml", ".toml"]
    kept, faults = history(folder)
    assert faults == []
    assert [entry.calibration for entry in kept] == [calibration(), calibration(gain=1.01)]


def test_newest_holds_and_history_is_kept(tmp_path: Path):
    for days, gain in ((0, 1.0), (10, 1.02), (5, 1.01)):
        save(tmp_path, calibration(date=WHEN + timedelta(days=days), gain=gain))
    save(tmp_path, calibration(quantity=Quantity.MICROPHONE, channel="microphone", nominal_scale=6e-4))
    force = in_force(tmp_path)
    assert force[Quantity.TORQUE].calibration.gain == 1.02
    assert Quantity.EMISSIVITY not in force
    assert len(history(tmp_path)[0]) == 4


def test_a_damaged_file_is_named_and_stops_the_rig(tmp_path: Path):
    path = save(tmp_path, calibration())
    path.write_text(path.read_text().replace("gain", "gian"))
    assert "Did you mean 'gain'" in history(tmp_path)[1][0]
    with pytest.raises(ConfigError, match="gian"):
        in_force(tmp_path)
    assert in_force(tmp_path / "none") == {}


@pytest.mark.parametrize(
    ("today", "state"),
    [
        (date(2026, 12, 1), Due.VALID),
        (date(2027, 10, 31), Due.SOON),
        (date(2027, 11, 30), Due.SOON),
        (date(2027, 12, 1), Due.OVERDUE),
    ],
)
def test_due_dates(tmp_path: Path, today: date, state: Due):
    save(tmp_path, calibration())
    lines = {line.quantity: line.state for line in due_lines(history(tmp_path)[0], today)}
    assert lines == {Quantity.TORQUE: state, Quantity.MICROPHONE: Due.NEVER, Quantity.EMISSIVITY: Due.NEVER}


def test_a_date_without_zone_is_utc():
    assert calibration(date=datetime(2026, 11, 30, 9, 30)).date == WHEN


def test_correction_of_a_channel_leaves_the_samples():
    spec = ChannelSpec("torque", "N·m", 4000.0, scale=2.0, offset=1.0)
    correction = ChannelCorrection("torque", 1.002, -0.4, 2.0)
    new, other = corrected([spec, ChannelSpec("speed", "1/min", 4000.0)], [correction])
    samples = np.array([0, 100], np.float32)
    before = ChannelData(spec, 0, samples).physical()
    assert ChannelData(new, 0, samples).physical() == pytest.approx(1.002 * before - 0.4)
    assert other.scale == 1.0
    back = correction.removed_from(new)
    assert (back.scale, back.offset) == pytest.approx((2.0, 1.0))


def test_a_changed_chain_wants_a_new_calibration():
    with pytest.raises(DeviceError, match="Calibrate it anew"):
        corrected(
            [ChannelSpec("torque", "N·m", 4000.0, scale=2.1)], [ChannelCorrection("torque", 1.0, 0, 2.0)]
        )
