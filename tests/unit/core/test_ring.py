"""The sample ring: what is written is read, and a reader that was too slow is told so."""

import threading
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigctl.core.blocks import Block
from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.core.errors import DeviceError, RecordingError
from rigctl.core.ring import SampleRing

SPECS = [
    ChannelSpec("microphone", "Pa", 400.0, "int16", scale=0.5, offset=1.0),
    ChannelSpec("pressure", "bar", 100.0),
]


@settings(max_examples=60, deadline=None)
@given(sizes=st.lists(st.integers(0, 200), min_size=1, max_size=40))
def test_any_sequence_of_writes_reads_back(tmp_path_factory: pytest.TempPathFactory, sizes: list[int]):
    path = tmp_path_factory.mktemp("ring") / "ring"
    writer = SampleRing.create(path, SPECS, seconds=1.0)
    reader = SampleRing.attach(path, 1.0)
    everything = np.arange(sum(sizes), dtype=np.int16)
    at = 0
    for size in sizes:
        start, stop = writer.write("microphone", everything[at : at + size])
        assert (start, stop) == (at, at + size)
        np.testing.assert_array_equal(reader.read("microphone", start, stop), everything[start:stop])
        at += size
        oldest = max(0, at - writer.capacity("microphone"))
        np.testing.assert_array_equal(reader.read("microphone", oldest, at), everything[oldest:at])
    writer.close()
    reader.close()
    path.unlink()


def test_slow_reader_is_told(tmp_path: Path):
    ring = SampleRing.create(tmp_path / "ring", SPECS, seconds=1.0)
    for _ in range(3):
        ring.write("pressure", np.zeros(60, np.float32))
    with pytest.raises(RecordingError, match="overwritten"):
        ring.read("pressure", 0, 10)


def test_reader_waits_no_longer_than_it_says(tmp_path: Path):
    ring = SampleRing.create(tmp_path / "ring", SPECS, seconds=1.0)
    with pytest.raises(RecordingError, match="has not arrived"):
        ring.read("pressure", 0, 10, timeout_s=0.02)
    with pytest.raises(RecordingError, match="has not arrived"):
        ring.read("pressure", 0, 10, keep_waiting=lambda: False)


def test_reader_does_not_wait_when_nobody_is_left_who_writes(tmp_path: Path):
    writer = SampleRing.create(tmp_path / "ring", SPECS, seconds=1.0)
    second = SampleRing.attach(tmp_path / "ring", 1.0, writes=True)
    readers = [SampleRing.attach(tmp_path / "ring", 1.0, read_only=read_only) for read_only in (False, True)]
    writer.close()
    for reader in readers:  # the second one could still write
        with pytest.raises(RecordingError, match="has not arrived"):
            reader.read("pressure", 0, 10, timeout_s=0.3)
    second.write("pressure", np.arange(10, dtype=np.float32))
    second.close()
    for reader in readers:
        np.testing.assert_array_equal(reader.read("pressure", 0, 10), np.arange(10))
        with pytest.raises(RecordingError, match="sample 11 of pressure will not arrive"):
            reader.read("pressure", 0, 11, timeout_s=60.0)


def test_reader_gets_samples_that_come_late(tmp_path: Path):
    ring = SampleRing.create(tmp_path / "ring", SPECS, seconds=1.0)
    late = threading.Timer(0.02, ring.write, ("pressure", np.arange(10, dtype=np.float32)))
    late.start()
    np.testing.assert_array_equal(ring.read("pressure", 2, 10, timeout_s=10.0), np.arange(2, 10))
    late.join()


def test_ring_keeps_the_channel_specs_for_other_processes(tmp_path: Path):
    SampleRing.create(tmp_path / "ring", SPECS)
    assert list(SampleRing.attach(tmp_path / "ring", 1.0).specs.values()) == SPECS
    with pytest.raises(DeviceError, match="has not made"):
        SampleRing.attach(tmp_path / "other", 0.02)
    with pytest.raises(ValueError, match="do not fit"):
        SampleRing.create(tmp_path / "small", SPECS, seconds=0.1).write("pressure", np.zeros(100, np.float32))


def test_a_reader_that_only_looks_cannot_write(tmp_path: Path):
    writer = SampleRing.create(tmp_path / "ring", SPECS)
    looker = SampleRing.attach(tmp_path / "ring", 0.0, read_only=True)
    writer.write("pressure", np.arange(5, dtype=np.float32))
    np.testing.assert_array_equal(looker.read("pressure", 1, 4), [1, 2, 3])
    with pytest.raises(ValueError, match="read-only"):
        looker.write("pressure", np.zeros(5, np.float32))
    np.testing.assert_array_equal(writer.read("pressure", 0, 5), np.arange(5))
    looker.close()
    writer.close()


def test_block_gives_physical_means_and_raw_samples(tmp_path: Path):
    ring = SampleRing.create(tmp_path / "ring", SPECS)
    ranges = {"microphone": ring.write("microphone", np.array([1, 2, 3], np.int16)), "pressure": (0, 0)}
    block = Block(7, 1_500_000_000, 50_000_000, ranges, ring)
    assert block.t_s == 1.5
    assert block.end_s == pytest.approx(1.55)
    np.testing.assert_array_equal(block.samples("microphone"), [1, 2, 3])
    assert block.mean("microphone") == pytest.approx(2.0)  # counts 2 * 0.5 + 1
    assert np.isnan(block.mean("pressure"))


def test_channel_data_scales_and_keeps_time():
    data = ChannelData(SPECS[0], -0.5, np.array([0, 2], np.int16))
    np.testing.assert_allclose(data.physical(), [1.0, 2.0])
    np.testing.assert_allclose(data.time_s(), [-0.5, -0.4975])
    assert SPECS[0].is_counts
    assert not SPECS[1].is_counts
    assert ChannelSpec(**SPECS[0].to_mapping()) == SPECS[0]


def test_samples_that_are_not_valid_do_not_count_in_a_mean(tmp_path: Path) -> None:
    ring = SampleRing.create(tmp_path / "ring", [ChannelSpec("torque", "N·m", 10.0)], seconds=1.0)
    ring.write("torque", np.array([1.0, np.nan, 3.0, np.nan, np.nan, 8.0, 2.0], np.float32))
    assert ring.mean("torque", 0, 3) == 2.0
    assert np.isnan(ring.mean("torque", 3, 5))
    ring.write("torque", np.array([4.0, np.nan, 6.0, np.nan, 5.0], np.float32))  # over the end of the ring
    assert ring.mean("torque", 5, 12) == 5.0
