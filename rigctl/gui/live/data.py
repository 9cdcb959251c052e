"""All that the live plots show of one session: signals, sound, set-points.

Job: take stretches of samples and news of set-points, analyse the sound within a budget of time so that
the event loop never waits, copy itself for a frozen display. Plain Python, no Qt. Not its job: getting
samples (`source`), asking for them (`feed`).
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import MICROPHONE, ChannelSpec
from rigctl.gui.live.buffer import HISTORY_S, Friction, LiveBuffer, Stretch
from rigctl.gui.live.sound import LAF, LiveSpectrum

SILENT_AFTER_S = 10.0
"""Sound this much older than the newest block: none comes. In virtual time it is some seconds behind."""
SLICE_S = 0.25
"""Sound is analysed in pieces of this length; one takes 1 to 4 ms."""
BACKLOG_S, KEPT_S = 3.0, 1.5
"""In virtual time more sound comes than can be analysed beside the window. When more than the first waits,
all but the newest is left out, a gap: so that what is analysed is still to be seen, and is in one piece."""


class StepSeries:
    """Values that hold until the next one: set-points over rig time."""

    def __init__(self, history_s: float = HISTORY_S) -> None:
        self._history_s = history_s
        self._points: deque[tuple[float, float]] = deque()

    def set(self, t_s: float, value: float) -> None:
        """From `t_s` on the value is this; NaN: none. Time that goes back begins a new series."""
        if self._points and t_s < self._points[-1][0]:
            self._points.clear()
        if not self._points or not _same(self._points[-1][1], value):
            self._points.append((t_s, value))
        while len(self._points) > 1 and self._points[1][0] < t_s - self._history_s:
            self._points.popleft()

    def value(self) -> float:
        """The newest; NaN when there is none."""
        return self._points[-1][1] if self._points else float("nan")

    def course(self, from_s: float, to_s: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Corners of the stepped line within a stretch: times and values."""
        t: list[float] = []
        v: list[float] = []
        for start_s, value in self._points:
            if start_s > to_s:
                break
            if start_s <= from_s:
                t, v = [from_s], [value]
                continue
            if v:
                t.append(start_s)
                v.append(v[-1])
            t.append(start_s)
            v.append(value)
        if t:
            t.append(to_s)
            v.append(v[-1])
        return np.array(t), np.array(v)

    def copy(self) -> StepSeries:
        """Independent copy."""
        twin = StepSeries(self._history_s)
        twin._points = deque(self._points)
        return twin


def _same(a: float, b: float) -> bool:
    return a == b or (np.isnan(a) and np.isnan(b))


class LiveData:
    """One session's signals, for drawing.

    Parameters
    ----------
    specs : iterable of ChannelSpec
    friction : Friction, optional
    history_s : float

    Attributes
    ----------
    buffer : LiveBuffer
    sound : LiveSpectrum or None
        None when the rig has no microphone.
    setpoints : dict of str to StepSeries
        By channel name.
    end_s : float
        Newest rig time that has been announced; minus infinity before the first block.
    version : int
        Rises whenever something has changed.
    """

    def __init__(
        self,
        specs: Iterable[ChannelSpec] = (),
        friction: Friction | None = None,
        history_s: float = HISTORY_S,
    ) -> None:
        self.history_s = history_s
        self.buffer = LiveBuffer(specs, friction, history_s)
        microphone = self.buffer.specs.get(MICROPHONE)
        self.sound = None if microphone is None else LiveSpectrum(microphone.rate_hz, history_s=history_s)
        self.setpoints: dict[str, StepSeries] = {}
        self.end_s = float("-inf")
        self.version = 0
        self._backlog: deque[Stretch] = deque()
        self._backlog_s = 0.0

    def feed(self, stretches: Sequence[Stretch], end_s: float) -> None:
        """Take samples; `end_s` is the end of the newest announced block. Sound waits for `work`."""
        if stretches or end_s != self.end_s:
            self.version += 1
        self.end_s = end_s
        self.buffer.feed(stretches)
        if self.sound is None:
            return
        for stretch in stretches:
            if stretch.name == MICROPHONE:
                self._queue(stretch, self.sound.rate_hz)

    def _queue(self, stretch: Stretch, rate_hz: float) -> None:
        step = round(SLICE_S * rate_hz)
        for at in range(0, len(stretch.samples), step):
            piece = stretch.samples[at : at + step]
            self._backlog.append(Stretch(MICROPHONE, stretch.t_s + at / rate_hz, piece))
            self._backlog_s += len(piece) / rate_hz
        if self._backlog_s > BACKLOG_S:
            while self._backlog_s > KEPT_S:
                self._backlog_s -= len(self._backlog.popleft().samples) / rate_hz

    def work(self, budget_s: float) -> bool:
        """Analyse waiting sound for about `budget_s`; True when some is left."""
        if self.sound is None:
            return False
        begin = time.perf_counter()
        while self._backlog:
            stretch = self._backlog.popleft()
            self._backlog_s -= len(stretch.samples) / self.sound.rate_hz
            self.sound.feed(stretch.t_s, stretch.samples)
            self.version += 1
            if time.perf_counter() - begin > budget_s:
                break
        return bool(self._backlog)

    def level_db(self, name: str = LAF, over_s: float = 0.25) -> float:
        """Newest sound level, mean of a moment; NaN when no sound comes (any more)."""
        if self.sound is None:
            return float("nan")
        history = self.sound.levels[name]
        if history.end_s < self.end_s - SILENT_AFTER_S:
            return float("nan")
        return history.mean(history.end_s - over_s, history.end_s)

    def note_setpoints(self, t_s: float, values: Mapping[str, float]) -> None:
        """Set-points by channel name that hold from now on."""
        for name, value in values.items():
            self.setpoints.setdefault(name, StepSeries(self.history_s)).set(t_s, value)
        self.version += 1

    def copy(self) -> LiveData:
        """Independent copy, for a frozen display; it is not fed any more."""
        twin = LiveData((), None, self.history_s)
        twin.buffer = self.buffer.copy()
        twin.sound = None if self.sound is None else self.sound.copy()
        twin.setpoints = {name: series.copy() for name, series in self.setpoints.items()}
        twin.end_s, twin.version = self.end_s, self.version
        return twin
