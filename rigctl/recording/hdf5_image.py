"""An HDF5 file built in memory, by the low-level calls of h5py.

Job: groups, attributes and data sets with little ceremony and little time, and the finished file as bytes.
HDF5 never touches the disk here: on a full disk it brings the interpreter down (h5py#914), our own writes
report it. NOT its job: what is in the file (`nexus`), compression (`packing`), the disk (`durable`).

A braking file has more than a hundred objects and as many attributes, nearly all the same from braking to
braking, and making one takes ten times as long as filling it. So a file is described first, its values apart
from its structure (names, types, lengths, fixed attributes). The structure alone becomes a file without
values, the skeleton, which is kept; a copy of it is opened and filled. The skeleton does not depend on
values, so the bytes of a file depend on its description only, not on the files that were made before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from itertools import count
from typing import Any

import h5py
import numpy as np
from h5py import h5a, h5d, h5f, h5g, h5o, h5p, h5s, h5t  # pyright: ignore[reportAttributeAccessIssue]
from numpy.typing import NDArray

from rigctl.recording.packing import CHUNK_SAMPLES, pack, time_axis_chunks

_SCALAR = h5s.create(h5s.SCALAR)
_TEXT_DTYPE = h5py.string_dtype()
_TEXT = h5t.py_create(_TEXT_DTYPE, logical=True)
_GROWTH_BYTES = 1 << 20
_numbers = count()
_PLAIN = h5p.create(h5p.DATASET_CREATE)
_PLAIN.set_obj_track_times(False)  # the wall clock has no place in the data
_PLACED = _PLAIN.copy()
_PLACED.set_alloc_time(h5d.ALLOC_TIME_EARLY)  # has its place in the file before it has values

_GROUP, _TEXT_FIELD, _ARRAY, _PACKED, _TIME_AXIS, _LINK = range(6)
_Attributes = tuple[tuple[str, str | float], ...]
_Part = tuple[int, str, Any, _Attributes]
"""Kind, absolute path, what else the kind needs, attributes: hashable, as it is the key of the skeleton."""


class Group:
    """A group under construction; its methods add members.

    The keyword arguments of the methods are attributes, strings or numbers; they belong to the structure.
    `stamp` is for those that differ from file to file.
    """

    def __init__(self, image: Image, path: str) -> None:
        self._image = image
        self._path = path

    def group(self, name: str, nx_class: str, **attributes: str | float) -> Group:
        """Add a group of a NeXus class."""
        path = f"{self._path}/{name}"
        self._image.parts.append((_GROUP, path, None, (("NX_class", nx_class), *attributes.items())))
        return Group(self._image, path)

    def text(self, name: str, value: str) -> None:
        """Add a scalar string."""
        path = f"{self._path}/{name}"
        self._image.parts.append((_TEXT_FIELD, path, None, ()))
        self._image.texts.append((path, np.array(value, dtype=_TEXT_DTYPE)))

    def number(self, name: str, value: float | int, units: str = "") -> None:
        """Add a scalar, int64 or float64 by its Python type."""
        self.array(name, np.array(value), units)

    def array(self, name: str, values: NDArray[Any], units: str = "") -> None:
        """Add a small array as it is (not compressed)."""
        path = f"{self._path}/{name}"
        form = (values.dtype.str, values.shape)
        self._image.parts.append((_ARRAY, path, form, (("units", units),) if units else ()))
        if values.size:
            self._image.arrays.append((path, values.tobytes()))

    def packed(self, name: str, values: NDArray[Any], **attributes: str | float) -> None:
        """Add a one-dimensional data set, compressed."""
        path = f"{self._path}/{name}"
        form = (values.dtype.str, len(values))
        self._image.parts.append((_PACKED, path, form, tuple(attributes.items())))
        self._image.chunks.append((path, pack(values)))

    def time_axis(self, name: str, rate_hz: float, n: int, **attributes: str | float) -> None:
        """Add the time axis k / rate_hz in s, k = 0 ... n - 1, compressed, as part of the structure."""
        path = f"{self._path}/{name}"
        self._image.parts.append((_TIME_AXIS, path, (rate_hz, n), tuple(attributes.items())))

    def link(self, name: str, target: str) -> None:
        """Add a second name (hard link) of an object that exists: an absolute path in the file."""
        self._image.parts.append((_LINK, f"{self._path}/{name}", target, ()))

    def stamp(self, member: str, name: str, value: str | int) -> None:
        """Add an attribute whose value is not part of the structure; `member` "" is the group itself."""
        path = f"{self._path}/{member}" if member else self._path or "/"
        self._image.stamps.append((path, name, value))


class Image(Group):
    """The root group of a file in memory; `finish` gives its bytes."""

    def __init__(self, **attributes: str | float) -> None:
        self.parts: list[_Part] = [(_GROUP, "/", None, tuple(attributes.items()))]
        self.texts: list[tuple[str, NDArray[Any]]] = []
        self.arrays: list[tuple[str, bytes]] = []
        self.chunks: list[tuple[str, list[bytes]]] = []
        self.stamps: list[tuple[str, str, str | int]] = []
        super().__init__(self, "")

    def finish(self) -> bytes:
        """The whole file as bytes."""
        stamps = tuple((path, name, isinstance(value, str)) for path, name, value in self.stamps)
        skeleton, offsets = _skeleton(tuple(self.parts), stamps)
        content = bytearray(skeleton)
        for path, data in self.arrays:
            at = offsets[path]
            content[at : at + len(data)] = data
        with _file(content) as (file, done):
            for path, text in self.texts:
                h5d.open(file, path.encode()).write(h5s.ALL, h5s.ALL, text)
            for path, chunks in self.chunks:
                _write_chunks(h5d.open(file, path.encode()), chunks)
            for path, name, value in self.stamps:
                kind = _TEXT_DTYPE if isinstance(value, str) else np.int64
                h5a.open(h5o.open(file, path.encode()), name.encode()).write(np.array(value, dtype=kind))
            return done()


@lru_cache(maxsize=64)  # some 0.15 MB each
def _skeleton(
    parts: tuple[_Part, ...], stamps: tuple[tuple[str, str, bool], ...]
) -> tuple[bytes, dict[str, int]]:
    """The file of a structure, without values, and the places of its small arrays in it, by path."""
    with _file() as (file, done):
        root = h5g.open(file, b"/")
        made: dict[str, Any] = {"/": root}
        for kind, path, form, attributes in parts:
            if kind == _LINK:
                root.links.create_hard(path.encode(), root, form.encode())
                continue
            target = root if path == "/" else _create(file, kind, path.encode(), form)
            _set_attributes(target, attributes)
            made[path] = target
        for path, name, is_text in stamps:
            h5a.create(made[path], name.encode(), _TEXT if is_text else _type_of("<i8"), _SCALAR)
        offsets = {path: made[path].get_offset() for kind, path, _, _ in parts if kind == _ARRAY}
        return done(), {path: at for path, at in offsets.items() if at is not None}


def _create(file: Any, kind: int, name: bytes, form: Any) -> Any:
    if kind == _GROUP:
        return h5g.create(file, name)
    if kind == _TEXT_FIELD:
        return h5d.create(file, name, _TEXT, _SCALAR, _PLAIN)
    if kind == _ARRAY:
        dtype, shape = form
        space = h5s.create_simple(shape) if shape else _SCALAR
        return h5d.create(file, name, _type_of(dtype), space, _PLACED)
    if kind == _PACKED:
        return _create_packed(file, name, *form)
    rate_hz, n = form
    axis = _create_packed(file, name, "<f8", n)
    _write_chunks(axis, time_axis_chunks(rate_hz, n))
    return axis


def _create_packed(file: Any, name: bytes, dtype: str, n: int) -> Any:
    plist = _PLAIN.copy()
    plist.set_chunk((min(CHUNK_SAMPLES, n),))
    plist.set_shuffle()
    plist.set_deflate(1)
    return h5d.create(file, name, _type_of(dtype), h5s.create_simple((n,)), plist)


def _write_chunks(target: Any, chunks: list[bytes]) -> None:
    for number, chunk in enumerate(chunks):
        target.write_direct_chunk((number * CHUNK_SAMPLES,), chunk)


def _set_attributes(target: Any, attributes: _Attributes) -> None:
    """Set scalar attributes: strings as variable-length UTF-8, numbers as int64 or float64."""
    for name, value in attributes:
        if isinstance(value, str):
            made = h5a.create(target, name.encode(), _TEXT, _SCALAR)
            made.write(np.array(value, dtype=_TEXT_DTYPE))
        else:
            array = np.array(value)
            made = h5a.create(target, name.encode(), _type_of(array.dtype.str), _SCALAR)
            made.write(array)


@contextmanager
def _file(image: bytearray | None = None) -> Iterator[tuple[Any, Callable[[], bytes]]]:
    """A file in memory, a new one or a copy of `image`, and the call that gives its bytes."""
    access = h5p.create(h5p.FILE_ACCESS)
    access.set_fapl_core(_GROWTH_BYTES, False)
    access.set_libver_bounds(h5f.LIBVER_EARLIEST, h5f.LIBVER_LATEST)
    access.set_fclose_degree(h5f.CLOSE_STRONG)
    name = f"image {next(_numbers)}".encode()  # HDF5 takes two files of one name for the same
    if image is None:
        file = h5f.create(name, h5f.ACC_TRUNC, fapl=access)
    else:
        access.set_file_image(image)
        file = h5f.open(name, h5f.ACC_RDWR, fapl=access)

    def finished() -> bytes:
        h5f.flush(file)
        return file.get_file_image()

    try:
        yield file, finished
    finally:
        file.close()


@lru_cache
def _type_of(dtype: str) -> Any:
    return h5t.py_create(np.dtype(dtype), logical=True)
