"""Reading a spool, whole or damaged.

Job: return every frame whose CRC is right; pass over torn and changed bytes by searching for the next magic;
say how much was passed over and where samples are missing. NOT its job: writing (`spool`), files of brakings.
"""

from __future__ import annotations

import json
import mmap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import RecordingError
from rigctl.recording.durable import disk_error
from rigctl.recording.spool import (
    COVERED_FROM,
    FORMAT_VERSION,
    HEAD,
    KIND_DATA,
    KIND_END,
    KIND_HEADER,
    KIND_MARK,
    MAGIC,
    MAX_PAYLOAD,
    MISSING_MARK,
    STARTED_MARK,
    little_endian,
)


class UnreadableSpool(RecordingError):
    """There is a spool, but its header is not whole: nothing of it was acknowledged to anybody."""


@dataclass(frozen=True, slots=True)
class Mark:
    """An event of a braking: name, rig time, plain values."""

    name: str
    t_s: float
    values: dict[str, Any]


@dataclass(frozen=True, slots=True)
class ChannelStretch:
    """All samples of one channel, as acquired.

    Attributes
    ----------
    samples : ndarray, shape (n,)
        Missing samples are filled with the value before them (at the start: after them).
    first : int
        Count of the first sample since the start of the rig.
    gaps : tuple of (int, int)
        Ranges [start, stop) within `samples` that are filled, not measured.
    """

    samples: NDArray[Any]
    first: int
    gaps: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Spool:
    """What could be read of a spool.

    Attributes
    ----------
    header : dict
        As given to `SpoolWriter.create`.
    channels : tuple of ChannelSpec
    stretches : dict of str to ChannelStretch
    marks : tuple of Mark
    end : dict or None
        {"status", "note"} of the end frame; None when the braking was cut off.
    size, bytes_cut : int
        Bytes of the file, and how many of them belong to no whole frame.
    lost_frames : int
        Frames that were written and cannot be read, as far as later frames show it.
    """

    path: Path
    header: dict[str, Any]
    channels: tuple[ChannelSpec, ...]
    stretches: dict[str, ChannelStretch]
    marks: tuple[Mark, ...]
    end: dict[str, Any] | None
    size: int
    bytes_cut: int
    lost_frames: int

    @property
    def intact(self) -> bool:
        """True when nothing is missing: no bytes cut, no gap, and the end frame is there."""
        gaps = any(stretch.gaps for stretch in self.stretches.values())
        gaps = gaps or any(mark.name == MISSING_MARK for mark in self.marks)
        return self.end is not None and not (self.bytes_cut or self.lost_frames or gaps)


class Frame(NamedTuple):
    """One whole frame; its payload is the range [start, stop) of the file."""

    kind: int
    channel: int
    sequence: int
    first_sample: int
    start: int
    stop: int


def scan(data: bytes | mmap.mmap) -> tuple[list[Frame], int]:
    """All whole frames of a spool in order, and the count of bytes that belong to none.

    A frame counts when its CRC is right and its sequence number is above that of the frame before.
    """
    frames: list[Frame] = []
    size, at, used = len(data), 0, 0
    with memoryview(data) as view:
        while at + HEAD.size <= size:
            found = _frame_at(view, at, size)
            if found is not None and (not frames or found.sequence > frames[-1].sequence):
                frames.append(found)
                used += found.stop - at
                at = found.stop
                continue
            at = data.find(MAGIC, at + 1)
            if at < 0:
                break
    return frames, size - used


def _frame_at(view: memoryview, at: int, size: int) -> Frame | None:
    magic, crc, kind, channel, zero, length, sequence, first = HEAD.unpack_from(view, at)
    start = at + HEAD.size
    stop = start + length
    if magic != MAGIC or zero or length > MAX_PAYLOAD or stop > size:
        return None
    if crc32(view[at + COVERED_FROM : stop]) != crc:
        return None
    return Frame(kind, channel, sequence, first, start, stop)


def read_spool(path: Path) -> Spool:
    """Read all that is whole in a spool.

    Raises
    ------
    UnreadableSpool
        Its header frame is not whole, or of another format.
    RecordingError
        The file cannot be opened.
    """
    try:
        with path.open("rb") as file:
            data: bytes | mmap.mmap = (
                mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) if path.stat().st_size else b""
            )
    except OSError as error:
        raise disk_error(error, path, "read the spool") from error
    try:
        return _assemble(path, data)
    finally:
        if isinstance(data, mmap.mmap):
            data.close()


def _assemble(path: Path, data: bytes | mmap.mmap) -> Spool:
    frames, cut = scan(data)
    if not frames or frames[0].kind != KIND_HEADER:
        raise UnreadableSpool(
            "the header of this spool is damaged.",
            place=str(path),
            remedy="It was cut off before recording began, or the disk failed. Move it away to go on.",
        )
    header = json.loads(data[frames[0].start : frames[0].stop])
    if header.pop("format", None) != FORMAT_VERSION:
        raise UnreadableSpool(
            "this spool has another format.",
            place=str(path),
            remedy="Recover it with the version that wrote it.",
        )
    channels = tuple(ChannelSpec(**mapping) for mapping in header.pop("channels"))
    parts: list[list[Frame]] = [[] for _ in channels]
    marks: list[Mark] = []
    end: dict[str, Any] | None = None
    for item in frames[1:]:
        if item.kind == KIND_DATA and item.channel < len(parts):
            parts[item.channel].append(item)
        elif item.kind == KIND_MARK:
            marks.append(Mark(**json.loads(data[item.start : item.stop])))
        elif item.kind == KIND_END:
            end = json.loads(data[item.start : item.stop])
    started = next((mark.values for mark in marks if mark.name == STARTED_MARK), {})
    firsts = started.get("first", [items[0].first_sample if items else 0 for items in parts])
    stretches = {
        spec.name: _join(spec, first, items, data)
        for spec, first, items in zip(channels, firsts, parts, strict=True)
        if items
    }
    return Spool(
        path=path,
        header=header,
        channels=channels,
        stretches=stretches,
        marks=tuple(marks),
        end=end,
        size=len(data),
        bytes_cut=cut,
        lost_frames=frames[-1].sequence + 1 - len(frames),
    )


def _join(spec: ChannelSpec, first: int, items: Sequence[Frame], data: bytes | mmap.mmap) -> ChannelStretch:
    """Join the frames of one channel from sample `first` on; repeated samples are dropped, missing ones
    filled and listed.
    """
    dtype = little_endian(spec.dtype)
    pieces: list[NDArray[Any]] = []
    gaps: list[tuple[int, int]] = []
    begin = following = first
    for item in items:
        samples = np.frombuffer(data[item.start : item.stop], dtype)
        if not len(samples):
            continue
        skip = following - item.first_sample
        if skip < 0:
            gaps.append((following - begin, item.first_sample - begin))
            last = pieces[-1][-1] if pieces else samples[0]
            pieces.append(np.full(-skip, last, dtype))
            skip = 0
        if skip < len(samples):
            pieces.append(samples[skip:])
            following = item.first_sample + len(samples)
    joined = np.concatenate([np.empty(0, dtype), *pieces]).astype(np.dtype(spec.dtype), copy=False)
    return ChannelStretch(joined, begin, tuple(gaps))
