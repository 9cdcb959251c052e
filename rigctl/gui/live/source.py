"""From the sample ring to stretches of physical samples with their rig time.

Job: attach read-only to the ring of a run folder, remember which ranges were announced, and hand out what
has been written since, without ever waiting. The sound is written some blocks after it was announced;
what was overwritten before it was read becomes a gap; a ring that is made anew is attached anew. Plain
Python, no Qt. Not its job: histories (`buffer`), the announcements (`rigctl.gui.rig.connection`).
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.core.errors import DeviceError, RecordingError
from rigctl.core.ring import RING_NAME, SampleRing
from rigctl.gui.live.buffer import HISTORY_S, Stretch

_JOIN_NS = 1_000_000
"""Ranges that follow each other in count and, this closely, in time are read as one."""
_MARGIN = 64
"""Share of the ring (one of so many) that is not read at its old end, where the writer is about to write."""


@dataclass(slots=True)
class _Range:
    """Announced samples [start, stop) of a channel; the first at `t_ns`."""

    t_ns: int
    start: int
    stop: int
    stride: int
    end_ns: int


class LiveSource:
    """Reads one run folder.

    Parameters
    ----------
    run_dir : Path
        Folder with the ring; the ring may appear later.
    history_s : float
        What is older than that against the newest block is not read any more.
    """

    def __init__(self, run_dir: Path, history_s: float = HISTORY_S) -> None:
        self._path = run_dir / RING_NAME
        self._history_ns = round(history_s * 1e9)
        self._ring: SampleRing | None = None
        self._inode = 0
        self._pending: dict[str, deque[_Range]] = {}
        self._newest_ns = -(1 << 62)
        self.end_s = float("-inf")
        """Rig time at the end of the newest announced block."""
        self.generation = 0
        """Counts the rings attached so far; a new one has its own time and channels."""

    @property
    def specs(self) -> Mapping[str, ChannelSpec]:
        """Channels of the attached ring by name; empty before."""
        return {} if self._ring is None else self._ring.specs

    def announce(self, blocks: Iterable[Mapping[str, Any]]) -> None:
        """Remember the ranges of new blocks (mappings with t_ns, dt_ns, stride and ranges)."""
        for block in blocks:
            t_ns, dt_ns, stride = int(block["t_ns"]), int(block["dt_ns"]), int(block.get("stride", 1))
            if t_ns < self._newest_ns - dt_ns:  # time has begun anew
                self._pending.clear()
            self._newest_ns = t_ns + dt_ns
            for name, (start, stop) in block["ranges"].items():
                if stop > start:
                    self._add(name, _Range(t_ns, int(start), int(stop), stride, t_ns + dt_ns))
        self.end_s = self._newest_ns * 1e-9

    def _add(self, name: str, new: _Range) -> None:
        queue = self._pending.setdefault(name, deque())
        if queue:
            last = queue[-1]
            follows = new.start == last.stop and abs(new.t_ns - last.end_ns) < _JOIN_NS
            if follows and new.stride == last.stride:
                last.stop, last.end_ns = new.stop, new.end_ns
                return
        queue.append(new)

    def take(self) -> list[Stretch]:
        """All announced samples that are there by now."""
        if not self._pending:
            return []
        ring = self._attached()
        if ring is None:
            self._forget_old()
            return []
        taken: list[Stretch] = []
        for name, queue in self._pending.items():
            if name in ring.specs:
                self._take_channel(ring, ring.specs[name], queue, taken)
        self._pending = {name: queue for name, queue in self._pending.items() if queue}
        self._forget_old()
        return taken

    def _take_channel(
        self, ring: SampleRing, spec: ChannelSpec, queue: deque[_Range], taken: list[Stretch]
    ) -> None:
        # The microphone delivers all its samples or none: the stride is that of the slow channels.
        capacity = ring.capacity(spec.name)
        while queue:
            piece = queue[0]
            stride = piece.stride if _strided(piece, spec) else 1
            written = ring.written(spec.name)
            oldest = written - capacity + capacity // _MARGIN
            recent = piece.stop - int(self._history_ns * 1e-9 * spec.rate_hz / stride)
            start, stop = max(piece.start, oldest, recent), min(piece.stop, written)
            if start < stop:
                t_s = piece.t_ns * 1e-9 + (start - piece.start) * stride / spec.rate_hz
                try:
                    raw = ring.read(spec.name, start, stop, timeout_s=0.0)
                except RecordingError:  # overwritten while it was read: a gap
                    pass
                else:
                    taken.append(Stretch(spec.name, t_s, ChannelData(spec, t_s, raw).physical(), stride))
            if written < piece.stop:  # the rest comes later
                if start < stop:
                    piece.t_ns += round((stop - piece.start) * stride / spec.rate_hz * 1e9)
                    piece.start = stop
                return
            queue.popleft()

    def _forget_old(self) -> None:
        """Announcements that were never followed by samples."""
        oldest_ns = self._newest_ns - self._history_ns
        for queue in self._pending.values():
            while queue and queue[0].end_ns < oldest_ns:
                queue.popleft()

    def _attached(self) -> SampleRing | None:
        try:
            inode = os.stat(self._path).st_ino
        except (
            FileNotFoundError
        ):  # a rig that has closed removes its ring; what was written can still be read
            return self._ring
        if self._ring is not None and inode == self._inode:
            return self._ring
        self.close()
        try:
            self._ring = SampleRing.attach(self._path, 0.0, read_only=True)
        except DeviceError:  # its maker has not finished it
            return None
        self._inode = inode
        self.generation += 1
        return self._ring

    def close(self) -> None:
        """Let the ring go."""
        if self._ring is not None:
            self._ring.close()
            self._ring = None


def _strided(piece: _Range, spec: ChannelSpec) -> bool:
    """True when the range has as many samples as a strided block, not as many as a full one."""
    full = (piece.end_ns - piece.t_ns) * 1e-9 * spec.rate_hz
    return piece.stop - piece.start < 0.75 * full
