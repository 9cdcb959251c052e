"""The spool: an append-only file of CRC-framed samples, written while a braking runs.

Job: whatever was flushed can be read again after any crash. One frame after the other::

    magic 4 | crc u32 | kind u8 | channel u8 | 0 u16 | length u32 | sequence u32 | first sample u64 | payload

little endian; the CRC-32 covers everything after it. The first frame is the header (JSON: channels,
specification, t0, ...); then data frames (samples of one channel as acquired) and marker frames (JSON); a
spool that was ended in order has an end frame. `length` is that of the payload in bytes, `first sample`
counts the samples of the channel since the start of the rig. NOT its job: reading (`spool_reader`), what
becomes of the samples (`commit`).
"""

from __future__ import annotations

import json
import os
import struct
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import RecordingError
from rigctl.recording.durable import disk_error, sync_folder, write_all

MAGIC: Final = b"\xabRgF"
FORMAT_VERSION: Final = 1
HEAD: Final = struct.Struct("<4sIBBHIIQ")
COVERED_FROM: Final = 8  # first byte of a frame that its CRC covers
_COVERED_HEAD = struct.Struct("<BBHIIQ")
_CRC = struct.Struct("<I")
MAX_PAYLOAD: Final = 64 * 1024 * 1024
SYNC_PERIOD_S: Final = 0.4
"""Wall time between two flushes. In real time samples are at most 0.3 s old when they come
(`client.MERGED_NS` and a block), and a flush that is due is noticed within 0.2 s (`recorder.POLL_MS`):
together less than 1 s.
"""

KIND_HEADER, KIND_DATA, KIND_MARK, KIND_END = 1, 2, 3, 4
STARTED_MARK: Final = "recording_started"
"""Mark at the time of the first sample; its value `first` lists the count of it for each channel."""
CLOCKS_MARK: Final = "clocks"
"""Mark with the clocks of the rig's sources as measured then: source -> name -> number."""
MISSING_MARK: Final = "samples_missing"
"""Mark of a spool into which some samples never came."""


def frame_head(
    kind: int, channel: int, sequence: int, first_sample: int, payload: bytes | memoryview
) -> bytes:
    """The head of a frame with this payload."""
    head = _COVERED_HEAD.pack(kind, channel, 0, len(payload), sequence, first_sample)
    return MAGIC + _CRC.pack(crc32(payload, crc32(head))) + head


def frame(kind: int, channel: int, sequence: int, first_sample: int, payload: bytes | memoryview) -> bytes:
    """One frame, head and payload, ready to be appended."""
    return b"".join((frame_head(kind, channel, sequence, first_sample, payload), payload))


def little_endian(dtype: str) -> np.dtype[Any]:
    """The numpy type that samples of `dtype` have in the spool."""
    return np.dtype(dtype).newbyteorder("<")


class SpoolWriter:
    """Writes one spool. Every call either appends whole frames or raises `RecordingError`.

    Attributes
    ----------
    path : Path
    bytes_written : int
        Length of the file up to the last whole frame.
    written_s, synced_s : float
        Rig time up to which samples were appended, and up to which they survive a power cut.
    """

    def __init__(self, path: Path, fd: int, channels: list[ChannelSpec], t0_s: float) -> None:
        self.path = path
        self.bytes_written = 0
        self.written_s = self.synced_s = t0_s
        self._fd = fd
        self._sequence = 0
        self._dtypes = [little_endian(spec.dtype) for spec in channels]
        self._synced_at = time.monotonic()
        self._failed: RecordingError | None = None

    @classmethod
    def create(cls, path: Path, channels: Iterable[ChannelSpec], header: dict[str, Any]) -> SpoolWriter:
        """Make the file, with its header on the disk when this returns.

        Parameters
        ----------
        path : Path
        channels : iterable of ChannelSpec
        header : dict
            Plain JSON values, among them "t0_s", the rig time at the start.

        Raises
        ------
        RecordingError
            There is a spool of that name, or the disk refuses.
        """
        specs = list(channels)
        if len(specs) > 255:
            raise RecordingError(f"{len(specs)} channels are too many for one spool.", place=str(path))
        head = _json({"format": FORMAT_VERSION, "channels": [spec.to_mapping() for spec in specs], **header})
        try:
            fd = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | os.O_CLOEXEC, 0o644)
        except FileExistsError as error:
            raise RecordingError(
                "a spool of an earlier attempt is still there.",
                place=str(path),
                remedy="Recover the campaign first (`rigctl resume` does).",
            ) from error
        except OSError as error:
            raise disk_error(error, path, "make the spool") from error
        writer = cls(path, fd, specs, header["t0_s"])
        try:
            writer._append(frame(KIND_HEADER, 0, 0, 0, head), 1)
            writer.sync()
            sync_folder(path.parent)
        except (OSError, RecordingError) as error:
            writer.close()
            path.unlink(missing_ok=True)
            if isinstance(error, OSError):
                raise disk_error(error, path.parent, "flush the folder") from error
            raise
        return writer

    def append(self, parts: Iterable[tuple[int, int, NDArray[Any]]], end_s: float) -> None:
        """Append the samples of one or more blocks with one write.

        Parameters
        ----------
        parts : iterable of (channel number, first sample, samples)
            Number of the channel in the header; samples of shape (n,).
        end_s : float
            Rig time at the end of the block.
        """
        pieces: list[bytes | memoryview] = []  # head, payload, head, payload, ...
        sequence = self._sequence
        for channel, first, samples in parts:
            payload = np.ascontiguousarray(samples, self._dtypes[channel]).data.cast("B")
            pieces += (frame_head(KIND_DATA, channel, sequence, first, payload), payload)
            sequence += 1
        self._append(b"".join(pieces), len(pieces) // 2)
        self.written_s = end_s

    def mark(self, name: str, t_s: float, values: dict[str, Any]) -> None:
        """Append an event of the braking: name, rig time, plain values."""
        payload = _json({"name": name, "t_s": t_s, "values": values})
        self._append(frame(KIND_MARK, 0, self._sequence, 0, payload), 1)

    def end(self, status: str, note: str) -> None:
        """Append the end frame and flush: the braking is whole from here on."""
        self._append(frame(KIND_END, 0, self._sequence, 0, _json({"status": status, "note": note})), 1)
        self.sync()

    def sync_if_due(self) -> bool:
        """Flush when the last flush is `SYNC_PERIOD_S` of wall time ago; True when it flushed."""
        if time.monotonic() - self._synced_at < SYNC_PERIOD_S or self.synced_s == self.written_s:
            return False
        self.sync()
        return True

    def sync(self) -> None:
        """Flush to the disk. After a failed flush nothing can be trusted: the spool takes no more data."""
        self._refuse_after_failure()
        try:
            os.fdatasync(self._fd)
        except OSError as error:
            self._failed = disk_error(error, self.path, "flush samples")
            raise self._failed from error
        self.synced_s = self.written_s
        self._synced_at = time.monotonic()

    def close(self) -> None:
        """Close the file; it stays where it is."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def _append(self, data: bytes, frames: int) -> None:
        self._refuse_after_failure()
        try:
            write_all(self._fd, data)
        except OSError as error:
            self._failed = disk_error(error, self.path, "append samples")
            self._cut_the_torn_frame()
            raise self._failed from error
        self.bytes_written += len(data)
        self._sequence += frames

    def _cut_the_torn_frame(self) -> None:
        """Best effort: the reader passes over a torn frame just as well."""
        try:
            os.ftruncate(self._fd, self.bytes_written)
        except OSError:
            return

    def _refuse_after_failure(self) -> None:
        if self._failed is not None:
            raise self._failed


def _json(payload: dict[str, Any]) -> bytes:
    try:
        return json.dumps(payload, separators=(",", ":"), allow_nan=False).encode()
    except (TypeError, ValueError) as error:
        raise RecordingError(f"this cannot be recorded as JSON: {error}.", value=payload) from error
