"""The spool: round trip, and whatever is cut off or changed costs only the frames it touches."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_samples import SPECS, header, new_campaign, signals, specification, write_spool

from rigctl.core.errors import RecordingError
from rigctl.core.ring import SampleRing
from rigctl.recording import spool as spool_module
from rigctl.recording.running import RunningBraking
from rigctl.recording.spool import (
    KIND_DATA,
    KIND_END,
    KIND_HEADER,
    KIND_MARK,
    MISSING_MARK,
    SpoolWriter,
    frame,
)
from rigctl.recording.spool_reader import UnreadableSpool, read_spool, scan


def small_spool() -> tuple[bytes, list[tuple[int, int]]]:
    """Bytes of a spool of ten frames and the range of each."""
    rng = np.random.default_rng(3)
    data, ranges = b"", []
    for sequence in range(10):
        kind = {0: KIND_HEADER, 5: KIND_MARK, 9: KIND_END}.get(sequence, KIND_DATA)
        piece = frame(kind, sequence % 3, sequence, 20 * sequence, rng.bytes(5 + 3 * sequence))
        ranges.append((len(data), len(data) + len(piece)))
        data += piece
    return data, ranges


SMALL, RANGES = small_spool()


def test_round_trip(tmp_path: Path) -> None:
    data = write_spool(tmp_path / "00001.spool", 1.0)
    found = read_spool(tmp_path / "00001.spool")
    assert found.intact and found.bytes_cut == 0 and found.lost_frames == 0
    assert found.channels == SPECS
    assert found.header == header(specification())
    assert [(m.name, m.t_s, m.values) for m in found.marks] == [
        ("pressure_onset", 100.15, {"pressure_bar": 15.0})
    ]
    for name, samples in data.items():
        stretch = found.stretches[name]
        assert stretch.samples.dtype == samples.dtype
        np.testing.assert_array_equal(stretch.samples, samples)


def test_truncated_at_every_byte_all_whole_frames_are_read() -> None:
    for length in range(len(SMALL) + 1):
        frames, cut = scan(SMALL[:length])
        whole = [item for item in RANGES if item[1] <= length]
        assert [f.stop for f in frames] == [stop for _, stop in whole]
        assert cut == length - (whole[-1][1] if whole else 0)


@settings(max_examples=150, deadline=None)
@given(position=st.integers(0, 8 * len(SMALL) - 1))
def test_one_flipped_bit_costs_one_frame(position: int) -> None:
    changed = bytearray(SMALL)
    changed[position // 8] ^= 1 << (position % 8)
    frames, cut = scan(bytes(changed))
    hit = next(item for item in RANGES if item[0] <= position // 8 < item[1])
    assert [f.stop for f in frames] == [stop for start, stop in RANGES if (start, stop) != hit]
    assert cut == hit[1] - hit[0]


@settings(max_examples=100, deadline=None)
@given(start=st.integers(0, len(SMALL)), garbage=st.binary(max_size=200), drop=st.integers(0, 60))
def test_garbage_in_the_middle_costs_the_frames_it_touches(start: int, garbage: bytes, drop: int) -> None:
    stop = min(len(SMALL), start + drop)
    frames, _ = scan(SMALL[:start] + garbage + SMALL[stop:])
    untouched = [n for n, (a, b) in enumerate(RANGES) if b <= start or a >= stop]
    assert set(untouched) <= {f.sequence for f in frames}


@settings(max_examples=100, deadline=None)
@given(data=st.binary(max_size=400))
def test_noise_has_no_frames(data: bytes) -> None:
    assert scan(data) == ([], len(data))


def test_a_missing_block_is_a_gap_that_is_stated(tmp_path: Path) -> None:
    data = write_spool(tmp_path / "00001.spool", 1.0, skip_blocks=frozenset({7}))
    found = read_spool(tmp_path / "00001.spool")
    assert not found.intact
    stretch = found.stretches["microphone"]
    assert stretch.gaps == ((14000, 16000),)
    np.testing.assert_array_equal(stretch.samples[:14000], data["microphone"][:14000])
    np.testing.assert_array_equal(stretch.samples[16000:], data["microphone"][16000:])
    assert set(stretch.samples[14000:16000]) == {data["microphone"][13999]}


def test_repeated_samples_are_taken_once(tmp_path: Path) -> None:
    samples = signals(0.2)["microphone"]
    writer = SpoolWriter.create(tmp_path / "s", SPECS[:1], header(specification()))
    for first, last in ((0, 2000), (0, 2000), (1000, 5000)):
        writer.append([(0, 70 + first, samples[first:last])], 1.0)
    writer.end("complete", "")
    writer.close()
    stretch = read_spool(tmp_path / "s").stretches["microphone"]
    assert stretch.first == 70 and stretch.gaps == ()
    np.testing.assert_array_equal(stretch.samples, samples[:5000])


@pytest.mark.parametrize("length", [0, 10, 40])
def test_without_a_whole_header_it_is_unreadable(tmp_path: Path, length: int) -> None:
    (tmp_path / "s").write_bytes(SMALL[:length][: RANGES[0][1] - 1])
    with pytest.raises(UnreadableSpool, match="header"):
        read_spool(tmp_path / "s")


def test_an_earlier_spool_is_never_overwritten(tmp_path: Path) -> None:
    write_spool(tmp_path / "s", 0.1)
    before = (tmp_path / "s").read_bytes()
    with pytest.raises(RecordingError, match="earlier attempt"):
        write_spool(tmp_path / "s", 0.1)
    assert (tmp_path / "s").read_bytes() == before


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO])
def test_a_refused_write_is_reported_and_costs_nothing_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int
) -> None:
    samples = signals(0.2)["microphone"]
    writer = SpoolWriter.create(tmp_path / "s", SPECS[:1], header(specification()))
    writer.append([(0, 0, samples[:2000])], 0.05)
    writer.sync()
    room = [1234]
    real = os.write

    def short(fd: int, data: memoryview) -> int:
        if not room[0]:
            raise OSError(code, os.strerror(code))
        n = real(fd, data[: room[0]])
        room[0] -= n
        return n

    monkeypatch.setattr(os, "write", short)
    with pytest.raises(RecordingError, match="append samples") as caught:
        writer.append([(0, 2000, samples[2000:4000])], 0.1)
    assert caught.value.remedy and str(tmp_path) in caught.value.place
    with pytest.raises(RecordingError):  # it stays failed: no later sample may follow a hole unnoticed
        writer.append([(0, 4000, samples[4000:6000])], 0.15)
    monkeypatch.undo()
    writer.close()
    found = read_spool(tmp_path / "s")
    np.testing.assert_array_equal(found.stretches["microphone"].samples, samples[:2000])
    assert found.bytes_cut == 0 and found.end is None


def test_a_failed_flush_is_never_acknowledged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    writer = SpoolWriter.create(tmp_path / "s", SPECS[:1], header(specification()))
    writer.append([(0, 0, signals(0.1)["microphone"])], 105.0)

    def fail(fd: int) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(os, "fdatasync", fail)
    with pytest.raises(RecordingError, match="flush"):
        writer.sync()
    monkeypatch.undo()
    assert writer.synced_s < 105.0
    with pytest.raises(RecordingError):  # after a failed flush the kernel may have dropped pages: no retry
        writer.sync()
    writer.close()


def test_flushes_when_due_by_the_wall_clock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [1000.0]
    monkeypatch.setattr(spool_module.time, "monotonic", lambda: now[0])
    writer = SpoolWriter.create(tmp_path / "s", SPECS[:1], header(specification()))
    writer.append([(0, 0, signals(0.1)["microphone"])], 105.0)
    assert not writer.sync_if_due() and writer.synced_s < 105.0
    now[0] += 1.0
    assert writer.sync_if_due() and writer.synced_s == 105.0
    now[0] += 1.0
    assert not writer.sync_if_due()  # nothing new
    writer.close()


def test_what_is_not_json_is_refused_before_a_file_is_made(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="JSON"):
        SpoolWriter.create(tmp_path / "s", SPECS, header(specification(pressure_bar=float("nan"))))
    assert not (tmp_path / "s").exists()


def test_frames_that_come_again_count_once() -> None:
    start = RANGES[6][0]
    frames, cut = scan(SMALL + SMALL[start:])
    assert [f.sequence for f in frames] == list(range(10))
    assert cut == len(SMALL) - start


def test_a_spool_that_says_samples_are_missing_is_not_intact(tmp_path: Path) -> None:
    """Samples that never came at the end of a braking leave no hole between frames."""
    writer = SpoolWriter.create(tmp_path / "s", SPECS[:1], header(specification()))
    writer.append([(0, 0, signals(0.1)["microphone"])], 100.1)
    writer.mark(MISSING_MARK, 100.1, {"error": "overwritten"})
    writer.end("complete", "")
    writer.close()
    found = read_spool(tmp_path / "s")
    assert found.end == {"status": "complete", "note": ""} and not found.intact


def test_of_ranges_partly_overwritten_or_not_there_the_rest_is_kept(tmp_path: Path) -> None:
    campaign = new_campaign(tmp_path)
    ring = SampleRing.create(tmp_path / "ring", SPECS, 1.0)
    data = signals(1.3)
    for name, samples in data.items():
        for part in np.array_split(samples, 2):
            ring.write(name, part)
    order = {"specification": specification(), "t0_s": 0.0, "epoch": "", "evaluation": {}, "metadata": {}}
    running = RunningBraking(campaign, ring, order)
    whole = [(0, round(1.5 * spec.rate_hz)) for spec in SPECS]  # 0.3 s overwritten, 0.2 s never delivered
    running.block(0.0, 1.5, whole, lambda: False)
    assert running.gap is not None
    running.end("complete", "")
    spool = read_spool(running.path)
    assert not spool.intact
    for spec in SPECS:
        stretch, missing = spool.stretches[spec.name], round(0.3 * spec.rate_hz)
        assert stretch.gaps == ((0, missing),)
        np.testing.assert_array_equal(stretch.samples[missing:], data[spec.name][missing:])
