"""The braking being recorded: its spool, and the copying of its samples from the ring.

Job: one braking from its begin to its end frame. NOT its job: messages (`recorder`), the file (`commit`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from numpy.typing import NDArray

from rigctl.core.errors import RecordingError
from rigctl.core.ring import SampleRing
from rigctl.recording.braking import decimation_factors
from rigctl.recording.campaign import Campaign
from rigctl.recording.spool import MISSING_MARK, STARTED_MARK, SpoolWriter

_Part = tuple[int, int, NDArray[Any]]
"""Number of the channel, count of its first sample, samples."""


class RunningBraking:
    """One braking under way. Everything it is given is in the spool when the call returns.

    Parameters
    ----------
    campaign : Campaign
    ring : SampleRing
    order : mapping
        The controller's "begin": specification, t0_s, epoch, evaluation, metadata.

    Raises
    ------
    RecordingError
        A channel cannot be stored, an earlier spool is still there, or the disk refuses.
    """

    def __init__(self, campaign: Campaign, ring: SampleRing, order: Mapping[str, Any]) -> None:
        specification = order["specification"]
        self.index = int(specification["index"])
        self.path = campaign.spool_path(self.index)
        self.gap: RecordingError | None = None
        self._ring = ring
        self._started = False
        self._names = list(decimation_factors(specification, list(ring.specs.values())))
        header = {
            "specification": specification,
            "t0_s": order["t0_s"],
            "epoch": order["epoch"],
            "attempt": campaign.next_attempt(self.index),
            "evaluation": order["evaluation"],
            "metadata": order["metadata"],
        }
        self._spool = SpoolWriter.create(self.path, [ring.specs[name] for name in self._names], header)

    @property
    def synced_s(self) -> float:
        """Rig time up to which samples survive a power cut."""
        return self._spool.synced_s

    def block(
        self, begin_s: float, end_s: float, ranges: Sequence[Sequence[int]], keep_waiting: Callable[[], bool]
    ) -> None:
        """Copy one block, or several in a row.

        `ranges` holds [start, stop) of the ring's counts for each recorded channel.
        Samples that the ring no longer holds, or never gets, leave a gap (`gap`); the rest is still worth it.
        """
        if not self._started:
            self._spool.mark(STARTED_MARK, begin_s, {"first": [start for start, _ in ranges]})
            self._started = True
        try:
            parts = self._read(ranges, keep_waiting)
        except RecordingError as error:
            self.gap = self.gap or error
            parts = self._read_what_is_there(ranges)
            if not parts:
                return
        self._spool.append(parts, end_s)

    def _read(self, ranges: Sequence[Sequence[int]], keep_waiting: Callable[[], bool]) -> list[_Part]:
        return [
            (number, start, self._ring.read(name, start, stop, keep_waiting=keep_waiting))
            for number, (name, (start, stop)) in enumerate(zip(self._names, ranges, strict=True))
            if stop > start
        ]

    def _read_what_is_there(self, ranges: Sequence[Sequence[int]]) -> list[_Part]:
        """The part of each range that the ring holds; nothing when that is overwritten at this moment."""
        held = []
        for name, (start, stop) in zip(self._names, ranges, strict=True):
            written = self._ring.written(name)
            held.append((max(start, written - self._ring.capacity(name)), min(stop, written)))
        try:
            return self._read(held, lambda: False)
        except RecordingError:
            return []

    def mark(self, name: str, t_s: float, values: dict[str, Any]) -> None:
        """State what happened at rig time `t_s`."""
        self._spool.mark(name, t_s, values)

    def flush_if_due(self) -> bool:
        """Flush when the last flush is `spool.SYNC_PERIOD_S` ago; True when it did."""
        return self._spool.sync_if_due()

    def end(self, status: str, note: str) -> None:
        """Write the end frame, flush, close."""
        try:
            if self.gap is not None:
                self._spool.mark(MISSING_MARK, self._spool.written_s, {"error": str(self.gap)})
            self._spool.end(status, note)
        finally:
            self._spool.close()

    def give_up(self) -> None:
        """Close the spool as it is: recovery makes a file of what is in it."""
        self._spool.close()
