"""Braking files: what goes in comes out, viewers understand them, the same braking gives the same data."""

from __future__ import annotations

import json
import math
import re
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from recording_samples import SPECS, no_evaluation, specification, write_spool

from rigctl.core.channels import ChannelData
from rigctl.core.errors import RecordingError
from rigctl.recording.braking import Outcome, assemble, decimation_factors
from rigctl.recording.braking_file import file_image, read_braking, read_summary, verify
from rigctl.recording.durable import write_part
from rigctl.recording.evaluation import evaluate_braking
from rigctl.recording.packing import CHUNK_SAMPLES
from rigctl.recording.spool_reader import read_spool
from rigctl.signals.decimation import decimate


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, np.ndarray]]:
    """A file of a squealing braking of 4 s, and its samples as acquired."""
    folder = tmp_path_factory.mktemp("file")
    data = write_spool(folder / "00001.spool", 4.0)
    path = folder / "00001.h5"
    write_part(path, file_image(assemble(read_spool(folder / "00001.spool"), evaluate_braking)))
    return path, data


def test_counts_are_stored_as_acquired(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    path, data = made
    microphone = read_braking(path).channels["microphone"]
    assert len(data["microphone"]) > 2 * CHUNK_SAMPLES  # several chunks, the last one partial
    assert microphone.samples.dtype == np.int16
    np.testing.assert_array_equal(microphone.samples, data["microphone"])
    assert microphone.spec == SPECS[0]
    np.testing.assert_allclose(microphone.physical(), data["microphone"] * 6.1e-3, rtol=1e-6)


def test_slow_channels_are_decimated_and_say_how(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    path, data = made
    for name in ("torque", "pressure", "speed", "disc_temperature"):
        channel = read_braking(path).channels[name]
        assert channel.spec.rate_hz == 1000.0 and channel.samples.dtype == np.float32
        np.testing.assert_array_equal(channel.samples, decimate(data[name], 4))
        with h5py.File(path) as file:
            chain = file[f"entry/{name}/chain"]
            stated = json.loads(chain["filter"][()])
            assert json.loads(chain["native"][()])["rate_hz"] == 4000.0
        assert stated["factor"] == 4 and stated["stop_band_attenuation_db"] > 80.0


def test_a_tone_above_the_new_nyquist_frequency_does_not_fold(tmp_path: Path) -> None:
    write_spool(tmp_path / "s", 4.0)
    spool = read_spool(tmp_path / "s")
    time_s = np.arange(16000) / 4000.0
    tone = (np.sin(2 * np.pi * 1200.0 * time_s)).astype(np.float32)  # would appear at 200 Hz
    stretch = spool.stretches["torque"]
    stretch.samples[:] = tone
    stored = assemble(spool, no_evaluation).channels["torque"].data.samples
    inner = stored[200:-200] * np.hanning(len(stored) - 400)
    spectrum = np.abs(np.fft.rfft(inner)) / (np.hanning(len(inner)).sum() / 2)
    assert 20 * np.log10(spectrum.max()) < -80.0


def test_time_axis_is_that_of_the_samples(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    with h5py.File(made[0]) as file:
        for name, rate_hz in (("microphone", 40000.0), ("torque", 1000.0), ("speed", 1000.0)):
            group = file[f"entry/{name}"]
            time_s = group["time"][...]
            assert group["time"].attrs["units"] == "s"
            np.testing.assert_array_equal(time_s, np.arange(len(group[group.attrs["signal"]])) / rate_hz)


def test_silx_finds_the_default_plot(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    silx_io, nxdata = pytest.importorskip("silx.io"), pytest.importorskip("silx.io.nxdata")
    with silx_io.open(str(made[0])) as file:
        plot = nxdata.get_default(file)
        assert plot is not None and plot.is_valid and plot.is_curve
        assert plot.signal_dataset_name == "counts" and plot.axes_dataset_names == ["time"]
        for spec in SPECS:
            assert nxdata.get_default(file[f"entry/{spec.name}"]).is_valid


def test_nexus_check_finds_nothing(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    _check_nexus(made[0])


def _check_nexus(path: Path) -> None:
    pytest.importorskip("nexusformat")
    nxcheck = Path(sys.executable).with_name("nxcheck")
    run = subprocess.run([nxcheck, str(path)], capture_output=True, text=True, check=True)
    text = re.sub(r"\x1b\[[0-9;]*m", "", run.stdout + run.stderr)
    assert re.search(r"number of warnings: 0\b", text), text
    assert re.search(r"number of errors: 0\b", text), text


def clock_state(drift_ppm: float, offset_ms: float | None = None) -> dict[str, float | bool]:
    """As drivers put it on the status board; the master has no offset."""
    state: dict[str, float | bool] = {"drift_ppm": drift_ppm, "jitter_ms": 0.1, "samples": 1000}
    return state | (
        {"master": True} if offset_ms is None else {"offset_ms": offset_ms, "lost": 2, "doubled": 0}
    )


def test_clocks_of_sources_are_kept_as_measured(tmp_path: Path) -> None:
    first = {"rigmic": clock_state(-28.5), "amplifier 1": clock_state(30.0, -1042.0)}
    second = {"rigmic": clock_state(-29.5), "amplifier 1": clock_state(31.0, -1042.5)}
    marks = [("clocks", 101.05, first), ("clocks", 102.05, second)]
    write_spool(tmp_path / "s", 2.5, marks=marks)
    stored = assemble(read_spool(tmp_path / "s"), no_evaluation)
    assert [mark.name for mark in stored.marks] == ["pressure_onset"]
    path = tmp_path / "00001.h5"
    write_part(path, file_image(stored))
    with h5py.File(path) as file:
        clocks = file["entry/clocks"]
        assert set(clocks) == {"rigmic", "amplifier_1"}
        assert clocks["amplifier_1"].attrs["source"] == "amplifier 1"
        offset, drift = clocks["amplifier_1/offset_ms"], clocks["amplifier_1/drift_ppm"]
        assert (offset.attrs["units"], drift.attrs["units"]) == ("ms", "ppm")
        assert offset[...].tolist() == [-1042.0, -1042.5] and drift[...].tolist() == [30.0, 31.0]
        assert "offset_ms" not in clocks["rigmic"]
    read = read_braking(path)
    np.testing.assert_allclose(read.clocks["amplifier 1"]["time_s"], [1.05, 2.05])
    assert read.clocks["amplifier 1"]["lost"].tolist() == [2, 2]
    assert read.clocks["rigmic"]["drift_ppm"].tolist() == [-28.5, -29.5]
    assert read_summary(path)["clocks"]["amplifier 1"]["offset_ms"] == -1042.5
    _check_nexus(path)


def test_no_group_of_clocks_where_there_is_one_clock(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    with h5py.File(made[0]) as file:
        assert "clocks" not in file["entry"]
    assert read_braking(made[0]).clocks == {} and "clocks" not in read_summary(made[0])


def test_only_filters_that_every_reader_has(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    filters: set[str] = set()
    with h5py.File(made[0]) as file:
        file.visititems(lambda _, item: filters.update(getattr(item, "_filters", {})))
    assert filters == {"shuffle", "gzip"}


def test_results_events_and_settings(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    braking = read_braking(made[0])
    assert braking.status == "complete" and braking.complete and braking.index == 1
    assert braking.specification == specification()
    assert braking.metadata == {"seed": 1}
    assert braking.settings["detection"]["threshold_db"] == 60.0
    assert braking.mark_s("pressure_onset") == pytest.approx(0.15)
    assert braking.results["n_squeal"] == 1 and len(braking.events["frequency_hz"]) >= 1
    assert braking.results["squeal_frequency_hz"] == pytest.approx(2350.0, abs=1.0)
    assert braking.results["pressure_mean_bar"] == pytest.approx(15.0, abs=0.05)
    assert braking.results["mean_mu"] == pytest.approx(300 / (2 * 14.5e5 * 2.29e-3 * 0.105), rel=0.01)


def test_summary_and_fields_say_the_same(made: tuple[Path, dict[str, np.ndarray]]) -> None:
    summary = read_summary(made[0])
    assert summary["set_points"]["pressure_bar"] == 15.0 and summary["set_points"]["loop_pressure"] == 2
    assert summary["start_time"] == "2000-01-01T00:01:40+00:00"
    with h5py.File(made[0]) as file:
        entry = file["entry"]
        assert entry["start_time"][()].decode() == summary["start_time"]
        assert entry["duration"][()] == 4000 and entry["duration"].attrs["units"] == "ms"
        assert entry["braking/pressure_bar"].attrs["units"] == "bar"
        assert set(entry["results"]) == set(summary["results"])
        for name, value in summary["results"].items():
            stored = entry[f"results/{name}"][()]
            assert math.isnan(stored) if value is None else stored == value
        for name, column in summary["events"].items():
            np.testing.assert_array_equal(entry[f"events/{name}"][...], np.array(column, float))


def test_the_same_spool_gives_the_same_data_sets(tmp_path: Path) -> None:
    contents = []
    for name in ("a", "b"):
        write_spool(tmp_path / f"{name}.spool", 1.0, seed=5)
        path = tmp_path / f"{name}.h5"
        write_part(path, file_image(assemble(read_spool(tmp_path / f"{name}.spool"), evaluate_braking)))
        found: dict[str, bytes] = {}
        with h5py.File(path) as file:
            file.visititems(
                lambda key, item, found=found: (
                    found.update({key: np.asarray(item[()]).tobytes() if item.dtype != object else item[()]})
                    if isinstance(item, h5py.Dataset)
                    else None
                )
            )
        contents.append(found)
    assert len(contents[0]) > 80
    assert contents[0] == contents[1]


def test_files_of_the_same_spool_differ_in_file_time_only(tmp_path: Path) -> None:
    write_spool(tmp_path / "s", 0.5)
    braking = assemble(read_spool(tmp_path / "s"), evaluate_braking)
    first = file_image(braking)
    time.sleep(1.1)
    second = file_image(braking)
    stamp = rb"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00"
    assert first != second
    assert re.sub(stamp, b"-", first) == re.sub(stamp, b"-", second)


def test_verify_finds_changed_samples(made: tuple[Path, dict[str, np.ndarray]], tmp_path: Path) -> None:
    copy = tmp_path / "00001.h5"
    copy.write_bytes(made[0].read_bytes())
    verify(copy)
    with h5py.File(copy, "r+") as file:
        file["entry/torque/value"][7] += 1.0
    with pytest.raises(RecordingError, match="torque"):
        verify(copy)


@pytest.mark.parametrize("content", [b"", b"not HDF5", None])
def test_other_files_are_refused_with_their_name(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "00009.h5"
    if content is None:
        with h5py.File(path, "w") as file:
            file["x"] = 1
    else:
        path.write_bytes(content)
    for read in (read_braking, read_summary, verify):
        with pytest.raises(RecordingError, match=r"00009\.h5"):
            read(path)


def test_a_failed_evaluation_does_not_cost_the_samples(tmp_path: Path) -> None:
    data = write_spool(tmp_path / "s", 0.5)
    spool = read_spool(tmp_path / "s")
    spool.header["evaluation"] = {"detection": {"threshold_db": "loud"}}
    write_part(tmp_path / "f.h5", file_image(assemble(spool, evaluate_braking)))
    braking = read_braking(tmp_path / "f.h5")
    assert "threshold_db" in braking.summary["evaluation_error"] and braking.results == {}
    np.testing.assert_array_equal(braking.channels["microphone"].samples, data["microphone"])


def test_status_follows_from_what_is_there(tmp_path: Path) -> None:
    cases = {"complete": "complete", "incomplete": "incomplete", None: "recovered"}
    for number, (status, expected) in enumerate(cases.items()):
        write_spool(tmp_path / str(number), 0.5, status=status)
        assert assemble(read_spool(tmp_path / str(number)), no_evaluation).status == expected
    write_spool(tmp_path / "gap", 0.5, skip_blocks=frozenset({4}))
    broken = assemble(read_spool(tmp_path / "gap"), no_evaluation)
    assert broken.status == "recovered" and broken.channels["torque"].gaps_s == ((0.2, 0.25),)


def test_a_braking_without_any_sample_still_makes_a_file(tmp_path: Path) -> None:
    write_spool(tmp_path / "s", 0.0, status=None)
    write_part(tmp_path / "f.h5", file_image(assemble(read_spool(tmp_path / "s"), evaluate_braking)))
    braking = read_braking(tmp_path / "f.h5")
    assert braking.status == "recovered" and len(braking.channels) == 0


def test_rates_that_the_rig_cannot_give_are_refused() -> None:
    assert decimation_factors(specification(), SPECS)["torque"] == 4
    with pytest.raises(RecordingError, match=r"torque cannot be stored at 40000 Hz.*4000 Hz"):
        decimation_factors(specification(channels=[{"name": "torque", "decimation": 1}]), SPECS)
    with pytest.raises(RecordingError, match="no channel 'force'"):
        decimation_factors(specification(channels=[{"name": "force", "decimation": 40}]), SPECS)


def test_evaluation_sees_the_stored_channels(tmp_path: Path) -> None:
    write_spool(tmp_path / "s", 0.5)
    seen: dict[str, ChannelData] = {}

    def look(channels: dict[str, ChannelData], settings: object) -> Outcome:
        seen.update(channels)
        return Outcome()

    assemble(read_spool(tmp_path / "s"), look)  # type: ignore[arg-type]
    assert {name: data.spec.rate_hz for name, data in seen.items()} == {
        spec.name: 40000.0 if spec.name == "microphone" else 1000.0 for spec in SPECS
    }
