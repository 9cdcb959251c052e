"""Microphone of the bench: resampling, scaling, and what happens to samples that nobody takes."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from sim_hardware.bench.microphone import NO_READER_S, Microphone, Resampler
from sim_hardware.bench.settings import MicrophoneSettings

PA_PER_COUNT = 20.0 / 32768.0


class Tone:
    """In place of the plant's sound: counts that rise by one with each sample."""

    def __init__(self) -> None:
        self.next = 0
        self.forgotten = 0

    def render(self, _track: object, ticks: int, _drive_on: bool) -> NDArray[np.int16]:
        counts = np.arange(self.next, self.next + 10 * ticks) % 20_000
        self.next += 10 * ticks
        return counts.astype(np.int16)

    def forget(self) -> None:
        self.forgotten += 1


@pytest.fixture
def pipe(tmp_path: Path) -> Iterator[tuple[Path, int]]:
    """A pipe and a reader that takes nothing by itself."""
    path = tmp_path / "pipe"
    os.mkfifo(path)
    reader = os.open(path, os.O_RDWR | os.O_NONBLOCK)
    yield path, reader
    os.close(reader)


def job(ticks: int = 40) -> tuple[NDArray[np.float64], int, bool]:
    return np.zeros((2, 9)), ticks, False


def wait_until(condition: object, timeout_s: float = 5.0) -> None:
    assert callable(condition)
    deadline = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.002)


def test_tone_keeps_frequency_and_amplitude() -> None:
    resample = Resampler()
    n = np.arange(40_000)
    blocks = np.split(np.sin(2.0 * np.pi * 2350.0 / 40_000.0 * n), 100)
    out = np.concatenate([resample(block) for block in blocks])
    delay = 0.5 * (6 * 32 - 1) / 6.0
    expected = np.sin(2.0 * np.pi * 2350.0 * (np.arange(48_000) / 48_000.0 - delay / 40_000.0))
    assert len(out) == 48_000
    assert np.max(np.abs(out - expected)[100:]) < 1e-4


@settings(max_examples=30, deadline=None)
@given(cuts=st.lists(st.integers(1, 40), min_size=1, max_size=8), seed=st.integers(0, 1000))
def test_blocks_join_without_a_trace(cuts: list[int], seed: int) -> None:
    line = np.random.default_rng(seed).standard_normal(5 * sum(cuts))
    resample = Resampler()
    pieces = [resample(piece) for piece in np.split(line, 5 * np.cumsum(cuts)[:-1])]
    assert np.allclose(np.concatenate(pieces), Resampler()(line), atol=1e-12)


def test_other_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match="multiple of 5"):
        Resampler()(np.zeros(7))


@pytest.mark.parametrize(
    ("kind", "dtype", "scale"), [("float32", "<f4", 2.0), ("int16", "<i2", 2.0 / 32768.0)]
)
def test_samples_arrive_scaled_and_in_order(
    pipe: tuple[Path, int], kind: str, dtype: str, scale: float
) -> None:
    """Full scale of 40 Pa: half the counts of the plant's converter (20 Pa)."""
    path, reader = pipe
    chosen = MicrophoneSettings.model_validate({"format": kind, "full_scale_pa": 40.0})
    microphone = Microphone(chosen, Tone(), PA_PER_COUNT, path)  # pyright: ignore[reportArgumentType]
    microphone.start()
    microphone.submit(job(ticks=160))  # 6400 bytes of float32: more than one write
    wait_until(lambda: microphone.status()["samples"] == 1600)
    values = np.frombuffer(os.read(reader, 65536), dtype).astype(float)
    microphone.stop()
    assert len(values) == 1600
    assert np.max(np.abs(values * scale - np.arange(1600) / 32768.0)) <= 1.0 / 32768.0


def test_what_nobody_reads_is_replaced_by_what_is_new(pipe: tuple[Path, int]) -> None:
    path, reader = pipe
    microphone = Microphone(MicrophoneSettings(), Tone(), PA_PER_COUNT, path)  # pyright: ignore[reportArgumentType]
    microphone.start()
    for k in range(4):
        microphone.submit(job())
        wait_until(lambda k=k: microphone.status()["samples"] == 400 * (k + 1))
    fresh = np.frombuffer(os.read(reader, 65536), "<f4")
    assert fresh[0] == pytest.approx(1200 / 32768.0)  # a recorder begins with the newest block
    assert len(fresh) == 400

    microphone.submit(job())  # it has read: from now on nothing may be thrown away for a while
    microphone.submit(job())
    wait_until(lambda: microphone.status()["samples"] == 2400)
    assert microphone.status()["recording"]
    assert len(np.frombuffer(os.read(reader, 65536), "<f4")) == 800

    microphone.submit(job())
    wait_until(lambda: microphone.status()["samples"] == 2800)
    time.sleep(NO_READER_S + 0.05)
    microphone.submit(job())
    wait_until(lambda: microphone.status()["samples"] == 3200)
    status = microphone.status()
    microphone.stop()
    assert not status["recording"]
    assert (status["unread"], status["lost"]) == (400, 0)


def test_missed_jobs_are_counted_and_forgotten(pipe: tuple[Path, int]) -> None:
    path, _ = pipe
    sound = Tone()
    microphone = Microphone(MicrophoneSettings(), sound, PA_PER_COUNT, path)  # pyright: ignore[reportArgumentType]
    for _ in range(53):  # nobody renders yet
        microphone.submit(job())
    assert microphone.status()["lost"] == 3 * 400
    microphone.start()
    wait_until(lambda: sound.next == 50 * 400)
    microphone.stop()
    assert sound.forgotten == 1
