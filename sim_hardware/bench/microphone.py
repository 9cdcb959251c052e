"""The bench's microphone as a sound card: the plant's sound into a source of a private PulseAudio.

Job: render the sound in a thread of its own, scale and resample it as a converter does, write it into the
source's pipe; keep it fresh while nobody records; count what is lost. Not its job: the sound
(`sim_hardware.plant.sound`), the server (`pulse`).

The source has no clock of its own: the rate at which samples are written *is* the sampling rate, and the
plant loop keeps that to the machine's clock.
"""

from __future__ import annotations

import errno
import fcntl
import os
import queue
import struct
import termios
import threading
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from rigctl.core.errors import DeviceError, RigctlError
from sim_hardware.bench.settings import MicrophoneSettings
from sim_hardware.plant import SoundJob
from sim_hardware.plant.sound import SOUND_HZ, Sound

PIPE_BYTES = 64 * 1024
#: writes up to PIPE_BUF are atomic: whole or not at all
WRITE_BYTES = 4096
#: the pipe has not been read for so long: nobody records, and what stands in it is thrown away
NO_READER_S = 0.25
#: steps of 10 ms that may wait for rendering
MAX_WAITING = 50
_F_SETPIPE_SZ = 1031
_TAPS = 32  # of each phase of the resampler


@dataclass
class MicrophoneCounts:
    """What has happened to the samples.

    Attributes
    ----------
    samples : int
        Put into the pipe.
    lost : int
        Never put there: the pipe was full, or rendering too late.
    unread : int
        Taken out again, since the reader did not come back for a quarter of a second. It has left, or it
        misses them.
    recording : bool
        Somebody reads.
    """

    samples: int = 0
    lost: int = 0
    unread: int = 0
    recording: bool = False


class Resampler:
    """40 kHz to 48 kHz without a gap between blocks, by a polyphase low pass (6/5).

    Blocks must hold a multiple of 5 samples. The delay is 16 samples of 40 kHz.
    """

    UP, DOWN = 6, 5

    def __init__(self) -> None:
        n = np.arange(self.UP * _TAPS) - 0.5 * (self.UP * _TAPS - 1)
        response = np.sinc(n / self.UP * 0.95) * np.kaiser(len(n), 9.0)
        response *= self.UP / response.sum()
        phases = np.arange(self.UP) * self.DOWN % self.UP
        # output m uses the inputs up to (5 m) div 6, newest first, with the taps of phase (5 m) mod 6
        self._taps = np.array([response[phase :: self.UP][::-1] for phase in phases])
        self._starts = np.arange(self.UP) * self.DOWN // self.UP
        self._memory = np.zeros(_TAPS - 1)

    def __call__(self, block: NDArray[np.float64]) -> NDArray[np.float64]:
        """The next block, 6/5 as long.

        Raises
        ------
        ValueError
            Its length is no multiple of 5.
        """
        groups, rest = divmod(len(block), self.DOWN)
        if rest:
            raise ValueError(f"a block of {len(block)} samples; give a multiple of {self.DOWN}")
        line = np.concatenate((self._memory, block))
        self._memory = line[len(block) :]
        windows = sliding_window_view(line, _TAPS)[: groups * self.DOWN].reshape(groups, self.DOWN, _TAPS)
        return np.einsum("gut,ut->gu", windows[:, self._starts], self._taps).reshape(-1)


class Microphone:
    """Takes the sound's jobs of the plant loop and feeds the pipe.

    Parameters
    ----------
    settings : MicrophoneSettings
    sound : Sound
        Of the plant; its only user is the thread.
    pa_per_count : float
        Of the sound's counts.
    pipe : Path
        Of the source; its reader is there already.
    """

    def __init__(self, settings: MicrophoneSettings, sound: Sound, pa_per_count: float, pipe: Path) -> None:
        self._settings, self._sound, self._pipe_path = settings, sound, pipe
        self._full_scale_per_count = pa_per_count / settings.full_scale_pa
        self._resample = Resampler() if settings.rate_hz != SOUND_HZ else None
        self._frame_bytes = 4 if settings.format == "float32" else 2
        self._jobs: queue.Queue[SoundJob | None] = queue.Queue(MAX_WAITING)
        self._counts = MicrophoneCounts()
        self._late = False
        self._level = 0  # bytes in the pipe after our last write
        self._read_at = 0.0
        self._failure: RigctlError | None = None
        self._fd = -1
        self._thread = threading.Thread(target=self._run, name="microphone", daemon=True)

    def start(self) -> None:
        """Open the pipe and begin.

        Raises
        ------
        DeviceError
            The pipe cannot be opened.
        """
        try:
            # for reading too: stale samples are taken out here
            self._fd = os.open(self._pipe_path, os.O_RDWR | os.O_NONBLOCK | os.O_CLOEXEC)
            fcntl.fcntl(self._fd, _F_SETPIPE_SZ, PIPE_BYTES)
        except OSError as error:
            raise DeviceError(
                f"cannot be opened: {error.strerror}.",
                place=str(self._pipe_path),
                remedy="See the log of pulseaudio in the bench's folder.",
            ) from error
        self._thread.start()

    def submit(self, job: SoundJob) -> None:
        """Sound of the next step; never waits."""
        try:
            self._jobs.put_nowait(job)
        except queue.Full:
            self._counts.lost += job[1] * self._settings.rate_hz // 4000
            self._late = True

    def stop(self) -> None:
        """End the thread and close the pipe."""
        if self._thread.is_alive():
            try:
                self._jobs.put(None, timeout=2.0)
            except queue.Full:
                self._late = True
            self._thread.join(5.0)
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def status(self) -> dict[str, Any]:
        """Counts, and what has gone wrong."""
        return {**asdict(self._counts), "failure": str(self._failure) if self._failure else ""}

    def _run(self) -> None:
        while (job := self._jobs.get()) is not None:
            if self._late:  # jobs are missing in between: the brake's motion cannot go on from there
                self._late = False
                self._sound.forget()
            try:
                self._write(self._converted(self._sound.render(*job)))
            except OSError as error:
                self._failure = DeviceError(
                    f"cannot be written: {error.strerror}.",
                    place=str(self._pipe_path),
                    remedy="PulseAudio has gone: start the bench anew.",
                )
                return

    def _converted(self, counts: NDArray[np.int16]) -> bytes:
        values = counts.astype(np.float64) * self._full_scale_per_count
        if self._resample is not None:
            values = self._resample(values)
        if self._settings.format == "float32":
            return np.clip(values, -1.0, 1.0).astype("<f4").tobytes()
        return np.clip(np.rint(values * 32768.0), -32768, 32767).astype("<i2").tobytes()

    def _write(self, data: bytes) -> None:
        """Into the pipe, in pieces that go in whole; what nobody reads is replaced by what is new."""
        now = time.monotonic()
        if self._waiting_bytes() < self._level:
            self._read_at = now
            self._counts.recording = True
        elif now - self._read_at > NO_READER_S:
            waiting = self._throw_away()
            if self._counts.recording:
                self._counts.recording = False
                self._counts.unread += waiting // self._frame_bytes
        for start in range(0, len(data), WRITE_BYTES):
            piece = data[start : start + WRITE_BYTES]
            try:
                written = os.write(self._fd, piece)
                self._counts.samples += written // self._frame_bytes
            except OSError as error:
                if error.errno != errno.EAGAIN:
                    raise
                self._counts.lost += len(piece) // self._frame_bytes
        self._level = self._waiting_bytes()

    def _waiting_bytes(self) -> int:
        return struct.unpack("i", fcntl.ioctl(self._fd, termios.FIONREAD, b"\0\0\0\0"))[0]

    def _throw_away(self) -> int:
        """Empty the pipe; returns the number of bytes."""
        try:
            return len(os.read(self._fd, PIPE_BYTES))
        except BlockingIOError:
            return 0
