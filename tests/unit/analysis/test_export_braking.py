"""Brakings in the formats of other programs."""

import csv
import wave

import numpy as np
import pytest
from campaign_files import Case
from scipy.io import loadmat

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.core.errors import RecordingError
from rigctl.export.braking import Format, export_braking, save_sound, write_wav
from rigctl.recording.braking_file import read_braking


@pytest.fixture
def braking(campaign):
    return (
        campaign(Case(0, 20.0, tones=((2350.0, 92.0, 1.0, 2.3),)), Case(0, sound=False))
        / "brakings"
        / "00001.h5"
    )


def test_wav_holds_the_counts_and_says_their_worth(braking, tmp_path):
    (path,) = export_braking(braking, tmp_path / "out", [Format.WAV], "c-")
    assert path.name == "c-00001.wav"
    sound = read_braking(braking).channels["microphone"]
    with wave.open(str(path)) as file:
        assert file.getframerate() == 40_000
        counts = np.frombuffer(file.readframes(file.getnframes()), "<i2")
    assert np.array_equal(counts, sound.samples)
    assert f"1 count = {sound.spec.scale:.9g} Pa".encode() in path.read_bytes()


def test_csv_has_a_file_per_rate_with_units_in_the_names(braking, tmp_path):
    written = {path.name for path in export_braking(braking, tmp_path, [Format.CSV])}
    assert written == {"00001-40000Hz.csv", "00001-1000Hz.csv", "00001-events.csv"}
    with (tmp_path / "00001-1000Hz.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert {"time_s", "pressure_bar", "torque_nm", "speed_rpm", "disc_temperature_degc"} == set(rows[0])
    pressure = read_braking(braking).channels["pressure"].physical()
    assert [float(row["pressure_bar"]) for row in rows] == pytest.approx(pressure.tolist(), rel=1e-6)
    assert float(rows[1]["time_s"]) == pytest.approx(1e-3)


def test_matlab_file_has_channels_results_and_events(braking, tmp_path):
    (path,) = export_braking(braking, tmp_path, [Format.MAT])
    found = loadmat(path, simplify_cells=True)
    file = read_braking(braking)
    channel = found["channels"]["torque"]
    assert np.allclose(channel["value"], file.channels["torque"].physical())
    assert (channel["rate_hz"], channel["unit"]) == (1000.0, "N·m")
    assert found["results"]["mean_mu"] == pytest.approx(file.results["mean_mu"])
    assert found["events"]["frequency_hz"] == pytest.approx(file.events["frequency_hz"][0])
    assert found["braking"]["index"] == 1


def test_nothing_is_replaced_and_nothing_half_written_is_left(braking, tmp_path):
    first = export_braking(braking, tmp_path, [Format.HDF5])
    second = export_braking(braking, tmp_path, [Format.HDF5])
    assert [p.name for p in first + second] == ["00001.h5", "00001-2.h5"]
    assert first[0].read_bytes() == braking.read_bytes()
    assert not list(tmp_path.glob("*.part"))


def test_what_cannot_be_written_is_said(braking, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match="export"):
        export_braking(braking, tmp_path / "file", [Format.CSV])
    silent = braking.with_name("00002.h5")
    assert export_braking(silent, tmp_path, [Format.WAV]) == []
    with pytest.raises(RecordingError, match="without sound"):
        save_sound(silent, tmp_path / "s.wav")


def test_samples_that_are_no_counts_fill_the_range(tmp_path):
    sound = ChannelData(ChannelSpec("microphone", "Pa", 8000.0), 0.0, np.array([0.0, 0.5, -2.0], np.float32))
    write_wav(tmp_path / "f.wav", sound)
    with wave.open(str(tmp_path / "f.wav")) as file:
        counts = np.frombuffer(file.readframes(3), "<i2")
    assert counts.tolist() == [0, 8192, -32767]
    assert b"1 count = 6.1037019e-05 Pa" in (tmp_path / "f.wav").read_bytes()
