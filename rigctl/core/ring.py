"""Samples between processes: one memory-mapped file with a ring per channel.

Job: one writer (the data acquisition), many readers, no copies but the reader's own. Each channel has a
count of all samples ever written; readers ask for ranges of that count and are told when they were too
slow. A plain file in /dev/shm is used because Python 3.11's `multiprocessing.shared_memory` unlinks
segments that a process only attached to. Who writes holds a lock on the file: a reader that waits for samples
knows at once when nobody is left who could write them. Not its job: meaning and time of samples.

Layout: 8 bytes magic, 8 bytes header length, JSON header, then per channel one 64-byte line with the
written count (uint64) and the ring itself.
"""

# numpy's stubs are partly unknown in some of its versions:
# pyright: reportUnknownMemberType=false

from __future__ import annotations

import fcntl
import json
import mmap
import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import DeviceError, RecordingError

RING_NAME = "ring"
"""The ring's file within the folder of a run: written by the acquisition, attached by all readers."""

_MAGIC = b"RGCRING1"
_ALIGN = 64
_LOOK_S = 0.1


class SampleRing:
    """Rings of all channels of a rig. Make one with `create`, open an existing one with `attach`."""

    def __init__(
        self,
        path: Path,
        buffer: mmap.mmap,
        specs: Sequence[ChannelSpec],
        capacities: Sequence[int],
        offset: int,
        fd: int,
        *,
        writes: bool,
    ) -> None:
        self.path = path
        self._fd = fd
        self._writes = writes
        if writes:
            fcntl.flock(fd, fcntl.LOCK_SH)
        self.specs = {spec.name: spec for spec in specs}
        self._buffer = buffer
        self._counts: dict[str, NDArray[np.uint64]] = {}
        self._data: dict[str, NDArray[Any]] = {}
        for spec, capacity in zip(specs, capacities, strict=True):
            self._counts[spec.name] = np.frombuffer(buffer, np.uint64, 1, offset)
            dtype = np.dtype(spec.dtype)
            self._data[spec.name] = np.frombuffer(buffer, dtype, capacity, offset + _ALIGN)
            offset += _ALIGN + _padded(capacity * dtype.itemsize)

    @classmethod
    def create(cls, path: Path, specs: Sequence[ChannelSpec], seconds: float = 16.0) -> SampleRing:
        """Make the file with room for `seconds` of each channel.

        Raises
        ------
        DeviceError
            No room for the file.
        """
        capacities = [int(np.ceil(spec.rate_hz * seconds)) for spec in specs]
        header = json.dumps(
            {"channels": [spec.to_mapping() for spec in specs], "capacities": capacities}
        ).encode()
        start = _padded(16 + len(header))
        size = start + sum(
            _ALIGN + _padded(capacity * np.dtype(spec.dtype).itemsize)
            for spec, capacity in zip(specs, capacities, strict=True)
        )
        fd = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
        try:
            os.posix_fallocate(fd, 0, size)
            buffer = mmap.mmap(fd, size)
        except OSError as error:
            os.close(fd)
            raise DeviceError(
                f"no room for {size / 1e6:.0f} MB of samples: {error.strerror}.",
                place=str(path),
                remedy="Free memory in /dev/shm.",
            ) from error
        buffer[16 : 16 + len(header)] = header
        buffer[8:16] = len(header).to_bytes(8, "little")
        made = cls(path, buffer, specs, capacities, start, fd, writes=True)
        buffer[0:8] = _MAGIC
        return made

    @classmethod
    def attach(
        cls, path: Path, timeout_s: float = 10.0, *, read_only: bool = False, writes: bool = False
    ) -> SampleRing:
        """Open the ring of another process, waiting for it to appear; read-only for who must not write.

        `writes`: this process writes a channel of it, too.

        Raises
        ------
        DeviceError
            There is none within `timeout_s`.
        """
        deadline = time.monotonic() + timeout_s
        while True:
            try:
                fd = os.open(path, (os.O_RDONLY if read_only else os.O_RDWR) | os.O_CLOEXEC)
            except FileNotFoundError:
                fd = -1
            if fd >= 0:
                if os.pread(fd, 8, 0) == _MAGIC:
                    break
                os.close(fd)
            if time.monotonic() > deadline:
                raise DeviceError("the data acquisition has not made its sample ring.", place=str(path))
            time.sleep(0.005)
        access = mmap.ACCESS_READ if read_only else mmap.ACCESS_WRITE
        buffer = mmap.mmap(fd, os.fstat(fd).st_size, access=access)
        length = int.from_bytes(buffer[8:16], "little")
        header = json.loads(buffer[16 : 16 + length])
        specs = [ChannelSpec(**mapping) for mapping in header["channels"]]
        return cls(path, buffer, specs, header["capacities"], _padded(16 + length), fd, writes=writes)

    def written(self, name: str) -> int:
        """Count of samples written to a channel since the start."""
        return int(self._counts[name][0])

    def capacity(self, name: str) -> int:
        """Samples that the ring of a channel holds."""
        return len(self._data[name])

    def write(self, name: str, samples: NDArray[Any]) -> tuple[int, int]:
        """Append samples of one channel; returns their range (start, stop) of the written count."""
        data = self._data[name]
        start = int(self._counts[name][0])
        n, capacity = len(samples), len(data)
        if n > capacity:
            raise ValueError(f"{n} samples at once do not fit the ring of {name} ({capacity})")
        at = start % capacity
        first = min(n, capacity - at)
        data[at : at + first] = samples[:first]
        data[: n - first] = samples[first:]
        self._counts[name][0] = start + n
        return start, start + n

    def read(
        self,
        name: str,
        start: int,
        stop: int,
        *,
        timeout_s: float = 10.0,
        keep_waiting: Callable[[], bool] | None = None,
    ) -> NDArray[Any]:
        """Copy of samples [start, stop), shape (stop - start,); waits until they are written.

        Parameters
        ----------
        keep_waiting : callable, optional
            Asked while waiting; False ends the wait at once.

        Raises
        ------
        RecordingError
            The range is overwritten already (the reader was too slow), not written within `timeout_s`, or
            not written yet and nobody is left who writes.
        """
        data, count = self._data[name], self._counts[name]
        if int(count[0]) < stop:
            self._wait(name, stop, timeout_s, keep_waiting)
        n, capacity = stop - start, len(data)
        at = start % capacity
        first = min(n, capacity - at)
        out = np.empty(n, data.dtype)
        out[:first] = data[at : at + first]
        out[first:] = data[: n - first]
        if int(count[0]) - start > capacity or n > capacity:
            raise RecordingError(
                f"samples {start}...{stop} of {name} were overwritten before they were read.",
                place=str(self.path),
                remedy="The machine is too slow for this recording.",
            )
        return out

    def mean(self, name: str, start: int, stop: int) -> float:
        """Mean of samples [start, stop) as acquired, without copying them; they must be written already.

        Samples that are not valid (NaN) do not count; NaN when none is valid.
        """
        data = self._data[name]
        at, n = start % len(data), stop - start
        first = data[at : at + n]
        total = float(np.add.reduce(first, dtype=np.float64))
        if len(first) < n:
            total += float(np.add.reduce(data[: n - len(first)], dtype=np.float64))
        if np.isnan(total):
            both = np.concatenate([first, data[: n - len(first)]])
            valid = both[~np.isnan(both)]
            return float(valid.mean(dtype=np.float64)) if len(valid) else total
        return total / n

    def _wait(self, name: str, stop: int, timeout_s: float, keep_waiting: Callable[[], bool] | None) -> None:
        begin_s = time.monotonic()
        deadline = begin_s + timeout_s
        look_s = begin_s + _LOOK_S
        pause_s = 0.0001  # short at first for who waits for a sample just being written; then cheap
        while int(self._counts[name][0]) < stop:
            if time.monotonic() > look_s:
                if self._nobody_writes() and int(self._counts[name][0]) < stop:
                    raise RecordingError(
                        f"sample {stop} of {name} will not arrive: its writer has gone.", place=str(self.path)
                    )
                look_s = time.monotonic() + _LOOK_S
            if time.monotonic() > deadline or (keep_waiting is not None and not keep_waiting()):
                raise RecordingError(
                    f"sample {stop} of {name} has not arrived within {timeout_s:g} s.", place=str(self.path)
                )
            time.sleep(pause_s)
            pause_s = min(2.0 * pause_s, 0.001)

    def _nobody_writes(self) -> bool:
        """Whether no process holds the lock of those who write."""
        if self._writes:
            return False
        try:
            fcntl.flock(self._fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        fcntl.flock(self._fd, fcntl.LOCK_UN)
        return True

    def close(self) -> None:
        """Drop this process's views. The file stays; its maker removes it."""
        self._counts.clear()
        self._data.clear()
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1
        try:
            self._buffer.close()
        except BufferError:  # a reader still holds a view; the map goes with the process
            return


def _padded(n: int) -> int:
    return (n + _ALIGN - 1) // _ALIGN * _ALIGN
