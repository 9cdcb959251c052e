"""The sound of a braking through the loudspeaker, if there is one.

Job: find an output, have the sound prepared in the worker process, play and stop it, say where it is. No
output, no library, a device that refuses: said in words, never an exception. Not its job: preparing
(`rigctl.analysis.viewing`).
"""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from rigctl.analysis.braking_view import Listenable
from rigctl.core.errors import DeviceError
from rigctl.gui.pages.data import remote
from rigctl.gui.work import Job, Reporter, Work

_TICK_MS = 40


class Player(QObject):
    """One sound at a time."""

    started = Signal(float)
    """It plays; gain in dB against the one gain without equal loudness."""
    position = Signal(float)
    """Time since the first sample, s."""
    stopped = Signal()
    failed = Signal(str)

    def __init__(self, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self._job: Job | None = None
        self._stream: Any = None
        self._begin_s = 0.0
        self._length_s = 0.0
        self._timer = QTimer(self)
        self._timer.setInterval(_TICK_MS)
        self._timer.timeout.connect(self._tick)

    @property
    def busy(self) -> bool:
        """True from `play` until `stopped` or `failed`."""
        return self._job is not None or self._stream is not None

    def play(self, path: Path, equal_loudness: bool, rate_hz: float) -> None:
        """Play a braking from its beginning."""
        self.stop()
        self._job = self._work.in_thread(
            find_output, rate_hz, done=partial(self._prepare, path, equal_loudness), failed=self._on_failed
        )

    def stop(self) -> None:
        """Silence; nothing happens when nothing is played."""
        was_busy = self.busy
        if self._job is not None:
            self._job.cancel()
            self._job = None
        if self._stream is not None:
            self._stream.close()
            self._stream = None
        self._timer.stop()
        if was_busy:
            self.stopped.emit()

    def _prepare(self, path: Path, equal_loudness: bool, rate_hz: float) -> None:
        self._job = self._work.in_process(
            remote.sound,
            path,
            equal_loudness,
            rate_hz,
            done=self._open,
            failed=self._on_failed,
            lane=remote.LANE,
        )

    def _open(self, sound: Listenable) -> None:
        self._job = self._work.in_thread(
            open_stream, sound, done=partial(self._on_open, sound), failed=self._on_failed
        )

    def _on_open(self, sound: Listenable, stream: Any) -> None:
        self._job = None
        self._stream = stream
        self._length_s = len(sound.samples) / sound.rate_hz
        self._begin_s = time.monotonic()
        self._timer.start()
        self.started.emit(sound.gain_db)

    def _tick(self) -> None:
        now_s = time.monotonic() - self._begin_s
        if now_s > self._length_s + 0.1:
            self.stop()
        else:
            self.position.emit(min(now_s, self._length_s))

    def _on_failed(self, words: str) -> None:
        self._job = None
        self.failed.emit(words)
        self.stopped.emit()


def find_output(rate_hz: float, reporter: Reporter) -> float:
    """Rate at which the sound output plays: the wanted one, if it can.

    Raises
    ------
    DeviceError
        There is no sound output.
    """
    del reporter
    remedy = "Save the sound as WAV and listen to it elsewhere."
    try:
        import sounddevice
    except OSError as error:
        raise DeviceError("the sound library PortAudio is missing.", remedy=remedy) from error
    try:
        device: Any = sounddevice.query_devices(kind="output")
    except (sounddevice.PortAudioError, ValueError) as error:
        raise DeviceError("this computer has no sound output.", remedy=remedy) from error
    try:
        sounddevice.check_output_settings(channels=1, dtype="float32", samplerate=rate_hz)
    except sounddevice.PortAudioError:
        return float(device["default_samplerate"])
    return rate_hz


def open_stream(sound: Listenable, reporter: Reporter) -> Any:
    """Start playing; the stream that is returned must be closed.

    Raises
    ------
    DeviceError
        The output refuses.
    """
    import sounddevice

    place = 0

    def fill(out: Any, frames: int, _when: Any, _status: Any) -> None:
        nonlocal place
        piece = sound.samples[place : place + frames]
        out[: len(piece), 0] = piece
        out[len(piece) :, 0] = 0.0
        place += frames

    try:
        stream = sounddevice.OutputStream(
            samplerate=sound.rate_hz, channels=1, dtype="float32", callback=fill, latency="high"
        )
        stream.start()
    except sounddevice.PortAudioError as error:
        raise DeviceError(
            f"the sound output cannot be used ({error}).", remedy="Is another program using it?"
        ) from error
    if reporter.cancelled:
        stream.close()
    return stream
