"""Compression of samples into the chunks of a data set with the HDF5 filters shuffle and deflate.

Job: chunks that every HDF5 reader unpacks with the filters it always has, at a tenth of the usual time.
NOT its job: the file around them (`hdf5_image`).

Shuffled samples are planes: all lowest bytes, then all bytes above them, and so on. The lower half of the
planes of measured samples is noise, on which deflate spends most of its time to save little; there it is told
to copy ("stored" blocks, RFC 1951 3.2.4), and only the upper half is searched.
"""

from __future__ import annotations

import struct
import zlib
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

CHUNK_SAMPLES: Final = 65536

_ZLIB_HEAD: Final = b"\x78\x01"  # RFC 1950: deflate, window of 32 kB, fastest
_STORED_HEAD = struct.Struct("<BHH")  # not the last block, stored; length, its complement
_STORED_BYTES: Final = 65535
_RAW: Final = -15  # negative window bits: deflate without the frame of zlib


def pack(values: NDArray[Any]) -> list[bytes]:
    """Compress a one-dimensional array into chunks of the shuffle and deflate filters."""
    length = min(CHUNK_SAMPLES, len(values))
    return [_pack_one(values[at : at + length], length) for at in range(0, len(values), length or 1)]


@lru_cache(maxsize=64)
def time_axis_chunks(rate_hz: float, n: int) -> list[bytes]:
    """Chunks of the time axis k / rate_hz in s, k = 0 ... n - 1, float64.

    The part of the last chunk beyond `n` holds the continued axis; HDF5 does not look at it.
    """
    length = min(CHUNK_SAMPLES, n)
    return [_axis_chunk(rate_hz, at, length) for at in range(0, n, length or 1)]


@lru_cache(maxsize=256)
def _axis_chunk(rate_hz: float, first: int, length: int) -> bytes:
    values = np.arange(first, first + length, dtype=np.float64) / rate_hz
    return zlib.compress(_planes(values, length).data.cast("B"), 9)


def _pack_one(values: NDArray[Any], length: int) -> bytes:
    planes = _planes(values, length).data.cast("B")
    noise = length * (values.itemsize // 2)
    packer = zlib.compressobj(1, zlib.DEFLATED, _RAW)
    parts: list[bytes | memoryview] = [_ZLIB_HEAD]
    for at in range(0, noise, _STORED_BYTES):
        block = planes[at : min(at + _STORED_BYTES, noise)]
        parts += (_STORED_HEAD.pack(0, len(block), len(block) ^ 0xFFFF), block)
    parts += (packer.compress(planes[noise:]), packer.flush(), zlib.adler32(planes).to_bytes(4, "big"))
    return b"".join(parts)


def _planes(values: NDArray[Any], length: int) -> NDArray[np.uint8]:
    """The shuffled bytes of a chunk, shape (itemsize, length); a partial chunk is filled with zeros."""
    if len(values) < length:
        values = np.concatenate((values, np.zeros(length - len(values), values.dtype)))
    little = values.astype(values.dtype.newbyteorder("<"), copy=False)
    return np.ascontiguousarray(little.view(np.uint8).reshape(length, values.itemsize).T)
