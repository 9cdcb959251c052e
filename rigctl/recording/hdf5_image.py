"""An HDF5 file built in memory, by the low-level calls of h5py.

Job: groups, attributes and data sets with little ceremony and little time (a braking file has some two
hundred objects; the high-level calls of h5py cost four times as much), and the finished file as bytes. HDF5
never touches the disk here: on a full disk it brings the interpreter down (h5py#914), our own writes report
it. NOT its job: what is in the file (`nexus`), putting it on the disk (`durable`).
"""

from __future__ import annotations

import zlib
from functools import lru_cache
from typing import Any, Final

import h5py
import numpy as np
from h5py import h5a, h5d, h5f, h5g, h5p, h5s, h5t  # pyright: ignore[reportAttributeAccessIssue]
from numpy.typing import NDArray

CHUNK_SAMPLES: Final = 65536
_SCALAR = h5s.create(h5s.SCALAR)
_TEXT_DTYPE = h5py.string_dtype()
_TEXT = h5t.py_create(_TEXT_DTYPE, logical=True)
_GROWTH_BYTES = 1 << 20
_PLAIN = h5p.create(h5p.DATASET_CREATE)
_PLAIN.set_obj_track_times(False)  # the wall clock has no place in the data


class Group:
    """A group under construction; its methods add members."""

    def __init__(self, gid: Any) -> None:
        self.id = gid

    def group(self, name: str, nx_class: str, **attributes: str | float) -> Group:
        """Add a group of a NeXus class."""
        made = Group(h5g.create(self.id, name.encode()))
        set_attributes(made.id, {"NX_class": nx_class, **attributes})
        return made

    def text(self, name: str, value: str, **attributes: str | float) -> None:
        """Add a scalar string."""
        made = h5d.create(self.id, name.encode(), _TEXT, _SCALAR, _PLAIN)
        made.write(h5s.ALL, h5s.ALL, np.array(value, dtype=_TEXT_DTYPE))
        set_attributes(made, attributes)

    def number(self, name: str, value: float | int, units: str = "") -> None:
        """Add a scalar, int64 or float64 by its Python type."""
        self.array(name, np.array(value), units)

    def array(self, name: str, values: NDArray[Any], units: str = "") -> None:
        """Add a small array as it is (contiguous, not compressed)."""
        space = h5s.create_simple(values.shape) if values.ndim else _SCALAR
        made = h5d.create(self.id, name.encode(), _type_of(values.dtype.str), space, _PLAIN)
        if values.size:
            made.write(h5s.ALL, h5s.ALL, values)
        if units:
            set_attributes(made, {"units": units})

    def packed(self, name: str, values: NDArray[Any], chunks: list[bytes], **attributes: str | float) -> None:
        """Add a one-dimensional data set from chunks made by `pack`."""
        length = min(CHUNK_SAMPLES, len(values))
        plist = _PLAIN.copy()
        plist.set_chunk((length,))
        plist.set_shuffle()
        plist.set_deflate(1)
        space = h5s.create_simple(values.shape)
        made = h5d.create(self.id, name.encode(), _type_of(values.dtype.str), space, plist)
        for number, chunk in enumerate(chunks):
            made.write_direct_chunk((number * length,), chunk)
        set_attributes(made, attributes)

    def link(self, name: str, target: str) -> None:
        """Add a second name (hard link) of an object that exists: an absolute path in the file."""
        self.id.links.create_hard(name.encode(), self.id, target.encode())


class Image(Group):
    """The root group of a file in memory; `finish` gives its bytes."""

    def __init__(self) -> None:
        access = h5p.create(h5p.FILE_ACCESS)
        access.set_fapl_core(_GROWTH_BYTES, False)
        access.set_libver_bounds(h5f.LIBVER_EARLIEST, h5f.LIBVER_LATEST)
        access.set_fclose_degree(h5f.CLOSE_STRONG)
        self._file = h5f.create(b"braking.h5", h5f.ACC_TRUNC, fapl=access)
        super().__init__(h5g.open(self._file, b"/"))

    def finish(self) -> bytes:
        """The whole file as bytes; the image cannot be used afterwards."""
        h5f.flush(self._file)
        data = self._file.get_file_image()
        self._file.close()
        return data


def set_attributes(target: Any, attributes: dict[str, str | float]) -> None:
    """Set scalar attributes: strings as variable-length UTF-8, numbers as int64 or float64."""
    for name, value in attributes.items():
        if isinstance(value, str):
            made = h5a.create(target, name.encode(), _TEXT, _SCALAR)
            made.write(np.array(value, dtype=_TEXT_DTYPE))
        else:
            array = np.array(value)
            made = h5a.create(target, name.encode(), _type_of(array.dtype.str), _SCALAR)
            made.write(array)


@lru_cache
def _type_of(dtype: str) -> Any:
    return h5t.py_create(np.dtype(dtype), logical=True)


def pack(values: NDArray[Any]) -> list[bytes]:
    """Compress a one-dimensional array into chunks of the shuffle and deflate filters.

    Sound is noise in its low bytes, where searching for repeated strings is wasted time: run lengths and
    Huffman codes (`Z_RLE`) compress the shuffled bytes as well as gzip level 1, faster. The result is an
    ordinary deflate stream that every reader knows.
    """
    strategy = zlib.Z_RLE if values.dtype.kind in "iu" else zlib.Z_DEFAULT_STRATEGY
    length = min(CHUNK_SAMPLES, len(values))
    return [
        _pack_one(values[at : at + length], length, 1, strategy) for at in range(0, len(values), length or 1)
    ]


def pack_time_axis(rate_hz: float, n: int) -> tuple[NDArray[np.float64], list[bytes]]:
    """Time axis k / rate_hz in s, shape (n,), and its chunks. The chunks are kept from braking to braking.

    The part of the last chunk beyond `n` holds the continued axis; HDF5 does not look at it.
    """
    length = min(CHUNK_SAMPLES, n)
    chunks = [_axis_chunk(rate_hz, at, length) for at in range(0, n, length or 1)]
    return np.arange(n, dtype=np.float64) / rate_hz, chunks


@lru_cache(maxsize=256)
def _axis_chunk(rate_hz: float, first: int, length: int) -> bytes:
    values = np.arange(first, first + length, dtype=np.float64) / rate_hz
    return _pack_one(values, length, 9, zlib.Z_DEFAULT_STRATEGY)


def _pack_one(values: NDArray[Any], length: int, level: int, strategy: int) -> bytes:
    if len(values) < length:
        values = np.concatenate((values, np.zeros(length - len(values), values.dtype)))
    shuffled = np.ascontiguousarray(values.view(np.uint8).reshape(length, values.itemsize).T)
    packer = zlib.compressobj(level, zlib.DEFLATED, 15, 8, strategy)
    return packer.compress(shuffled.data.cast("B")) + packer.flush()
