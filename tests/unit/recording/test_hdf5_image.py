"""Files in memory: packed chunks are what HDF5 reads, and the bytes do not depend on files made before."""

from __future__ import annotations

import io
import zlib

import h5py
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigctl.recording import hdf5_image
from rigctl.recording.hdf5_image import Image
from rigctl.recording.packing import CHUNK_SAMPLES, pack

LENGTHS = st.sampled_from([1, 2, 3, 1000, 65535, CHUNK_SAMPLES, CHUNK_SAMPLES + 1, 2 * CHUNK_SAMPLES + 17])


@settings(max_examples=40, deadline=None)
@given(
    n=LENGTHS, dtype=st.sampled_from(["i1", "i2", "i4", "f4", "f8"]), spread=st.sampled_from([0.0, 3.0, 1e4])
)
def test_packed_samples_read_back(n: int, dtype: str, spread: float) -> None:
    values = np.clip(np.random.default_rng(n).normal(0.0, spread, n), -100, 100).astype(dtype)
    for chunk in pack(values):  # a whole zlib stream with its check sum, nothing after it
        unpacker = zlib.decompressobj()
        assert len(unpacker.decompress(chunk)) == min(n, CHUNK_SAMPLES) * values.itemsize
        assert unpacker.eof and not unpacker.unused_data
    image = Image(NX_class="NXroot")
    image.packed("x", values, units="count")
    with h5py.File(io.BytesIO(image.finish())) as file:
        assert file["x"].dtype == values.dtype and file["x"].attrs["units"] == "count"
        np.testing.assert_array_equal(file["x"][...], values)


def test_noise_is_hardly_larger_and_silence_is_small() -> None:
    noise = np.random.default_rng(1).integers(-30000, 30000, CHUNK_SAMPLES).astype(np.int16)
    assert sum(map(len, pack(noise))) < 1.001 * noise.nbytes
    assert sum(map(len, pack(np.zeros(CHUNK_SAMPLES, np.float32)))) < 0.51 * 4 * CHUNK_SAMPLES


def described(number: int, n: int, text: str = "text") -> Image:
    """Two structures (by `n`), any number of values."""
    image = Image(NX_class="NXroot", default="entry")
    image.stamp("", "file_time", f"{number}")
    entry = image.group("entry", "NXentry", default="sound")
    sound = entry.group("sound", "NXdata", signal="value", time_indices=0)
    sound.packed("value", np.arange(n, dtype=np.float32) * number, rate_hz=10.0)
    sound.stamp("value", "crc32", number)
    sound.time_axis("time", 10.0, n, units="s")
    entry.group("other", "NXdata").link("time", "/entry/sound/time")
    entry.text("title", text * number)
    entry.number("count", number)
    entry.number("level", number / 2, "dB")
    entry.array("column", np.full(n % 7, number / 4), "Hz")
    return image


def test_everything_described_is_in_the_file() -> None:
    with h5py.File(io.BytesIO(described(3, 9, "ä").finish())) as file:
        assert dict(file.attrs) == {"NX_class": "NXroot", "default": "entry", "file_time": "3"}
        entry = file["entry"]
        assert dict(entry.attrs) == {"NX_class": "NXentry", "default": "sound"}
        assert dict(entry["sound"].attrs) == {"NX_class": "NXdata", "signal": "value", "time_indices": 0}
        value = entry["sound/value"]
        assert dict(value.attrs) == {"rate_hz": 10.0, "crc32": 3}
        np.testing.assert_array_equal(value[...], np.arange(9) * 3.0)
        np.testing.assert_array_equal(entry["other/time"][...], np.arange(9) / 10.0)
        assert entry["title"][()].decode() == "äää"
        assert entry["count"][()] == 3 and entry["count"].dtype == np.int64
        assert entry["level"][()] == 1.5 and entry["level"].attrs["units"] == "dB"
        np.testing.assert_array_equal(entry["column"][...], [0.75, 0.75])


@pytest.mark.parametrize("n", [7, 9])  # 7: an empty column
def test_bytes_do_not_depend_on_files_made_before(n: int) -> None:
    hdf5_image._skeleton.cache_clear()
    alone = described(5, n).finish()
    hdf5_image._skeleton.cache_clear()
    for number, length in ((900, n), (4, 30), (2, n)):
        described(number, length).finish()
    assert hdf5_image._skeleton.cache_info().currsize == 2
    assert described(5, n).finish() == alone
    assert described(6, n).finish() != alone


def test_a_description_that_fails_does_not_disturb_the_next_file() -> None:
    image = described(1, 9)
    image.link("broken", "/nowhere")
    with pytest.raises((OSError, ValueError, RuntimeError, KeyError)):
        image.finish()
    with h5py.File(io.BytesIO(described(1, 9).finish())) as file:
        assert file["entry/count"][()] == 1
