"""Readings for a calibration: means and scatter of live channels, as the uncalibrated chain gives them.

Job: attach read-only to the sample ring of the session, collect what is written within some seconds, hand out
physical values with the calibrations in force taken out again. Not its job: what a reading means.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, QTimer

from rigctl.core.channels import ChannelCorrection, ChannelSpec
from rigctl.core.errors import DeviceError, RecordingError
from rigctl.core.ring import RING_NAME, SampleRing

MEASURE_S = 2.0
MIN_SAMPLES = 20
PATIENCE_S = 12.0
_LOOK_MS = 100
_FLOW_S = 1.0


@dataclass(frozen=True)
class Reading:
    """One channel over the time of a measurement.

    Attributes
    ----------
    spec : ChannelSpec
        Of the uncalibrated channel.
    samples : ndarray, shape (n,)
        As acquired.
    """

    spec: ChannelSpec
    samples: NDArray[Any]

    @property
    def mean(self) -> float:
        """Mean physical value of the valid samples; NaN when none is valid."""
        valid = self._valid()
        return float(valid.mean()) * self.spec.scale + self.spec.offset if len(valid) else float("nan")

    @property
    def scatter(self) -> float:
        """Standard deviation of the valid samples."""
        valid = self._valid()
        return float(valid.std(ddof=1)) * abs(self.spec.scale) if len(valid) > 1 else 0.0

    def _valid(self) -> NDArray[np.float64]:
        values = self.samples.astype(np.float64)
        return values[np.isfinite(values)]


Done = Callable[[dict[str, Reading]], None]
Failed = Callable[[str], None]


class LiveSampler(QObject):
    """One session's ring.

    Parameters
    ----------
    run_dir : Path
    corrections : sequence of ChannelCorrection
        Calibrations that the session runs with.
    """

    def __init__(
        self, run_dir: Path, corrections: Sequence[ChannelCorrection], parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._path = run_dir / RING_NAME
        self._corrections = {correction.channel: correction for correction in corrections}
        self._ring: SampleRing | None = None
        self._timer = QTimer(self)
        self._timer.setInterval(_LOOK_MS)
        self._timer.timeout.connect(self._look)
        self._starts: dict[str, int] = {}
        self._began_s = 0.0
        self._seconds = 0.0
        self._done: Done | None = None
        self._failed: Failed | None = None
        self._flow: dict[str, tuple[int, float]] = {}  # written count, and when it changed

    @property
    def busy(self) -> bool:
        """True while a measurement runs."""
        return self._timer.isActive()

    @property
    def share(self) -> float:
        """How much of the running measurement is over, 0 to 1."""
        return min((time.monotonic() - self._began_s) / self._seconds, 1.0) if self.busy else 0.0

    def spec(self, channel: str) -> ChannelSpec | None:
        """The uncalibrated channel; None when the session does not deliver it."""
        ring = self._attached()
        if ring is None or channel not in ring.specs:
            return None
        spec = ring.specs[channel]
        correction = self._corrections.get(channel)
        return spec if correction is None else correction.removed_from(spec)

    def newest(self, channel: str, samples: int) -> Reading | None:
        """The newest samples of a channel, at most so many; None when there are none."""
        ring, spec = self._attached(), self.spec(channel)
        if ring is None or spec is None:
            return None
        written = ring.written(channel)
        start = max(written - min(samples, ring.capacity(channel) // 2), 0)
        if start >= written:
            return None
        try:
            return Reading(spec, ring.read(channel, start, written, timeout_s=0.0))
        except RecordingError:  # overwritten in this moment; the next look has newer ones
            return None

    def flows(self, channel: str) -> bool:
        """True while new samples come: some within the last second."""
        ring, now_s = self._attached(), time.monotonic()
        written = 0 if ring is None or channel not in ring.specs else ring.written(channel)
        before, since_s = self._flow.get(channel, (0, now_s))
        if written != before:
            self._flow[channel] = (written, now_s)
            return True
        return written > 0 and now_s - since_s < _FLOW_S

    def measure(
        self, channels: Sequence[str], done: Done, failed: Failed, seconds: float = MEASURE_S
    ) -> None:
        """Collect what comes from now on for some seconds of this clock; then call one of the two."""
        ring = self._attached()
        missing = [name for name in channels if ring is not None and name not in ring.specs]
        if ring is None or missing:
            failed(
                self.tr("The rig delivers no channel “{0}”.").format(missing[0])
                if missing
                else self.tr("The rig delivers no samples yet: wait until it has started.")
            )
            return
        self._starts = {name: ring.written(name) for name in channels}
        self._began_s, self._seconds = time.monotonic(), seconds
        self._done, self._failed = done, failed
        self._timer.start()

    def cancel(self) -> None:
        """The measurement is not wanted any more."""
        self._timer.stop()
        self._done = self._failed = None

    def close(self) -> None:
        """Leave the ring."""
        self.cancel()
        if self._ring is not None:
            self._ring.close()
            self._ring = None

    def _look(self) -> None:
        ring = self._ring
        if ring is None:
            self._fail(self.tr("The session has ended."))
            return
        waited_s = time.monotonic() - self._began_s
        counts = {name: ring.written(name) - start for name, start in self._starts.items()}
        if waited_s >= self._seconds and min(counts.values()) >= MIN_SAMPLES:
            try:
                found = {
                    name: Reading(self.spec(name) or ring.specs[name], self._read(ring, name))
                    for name in self._starts
                }
            except RecordingError as error:
                self._fail(str(error))
                return
            done = self._done
            self.cancel()
            if done is not None:
                done(found)
        elif waited_s > PATIENCE_S + self._seconds:
            starving = min(counts, key=lambda name: counts[name])
            self._fail(
                self.tr("No samples of “{0}” come. Is the rig running and not paused?").format(starving)
            )

    def _read(self, ring: SampleRing, name: str) -> NDArray[Any]:
        stop = ring.written(name)
        start = max(self._starts[name], stop - ring.capacity(name) * 3 // 4)
        return ring.read(name, start, stop, timeout_s=0.0)

    def _fail(self, why: str) -> None:
        failed = self._failed
        self.cancel()
        if failed is not None:
            failed(why)

    def _attached(self) -> SampleRing | None:
        if self._ring is None:
            try:
                self._ring = SampleRing.attach(self._path, 0.0, read_only=True)
            except DeviceError:  # the rig has not made it yet
                return None
        return self._ring
