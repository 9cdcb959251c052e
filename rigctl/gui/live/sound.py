"""What is made of the sound while it comes: spectrum, spectrogram, levels, squeal events.

Job: put spectra, peaks and levels together for one microphone, bounded in time and memory. Plain Python
and numpy, no Qt. Not its job: the pressure itself (`buffer`), plots.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rigctl.gui.live.buffer import HISTORY_S
from rigctl.gui.live.history import ChannelHistory
from rigctl.gui.live.levels import LevelMeter
from rigctl.gui.live.peaks import LiveDetection, LiveEvent, LiveTracks
from rigctl.gui.live.stft import SpectrogramHistory, StreamingSpectrum, level_db

LZF, LAF = "LZF", "LAF"
_HOLD_DECAY_DB_S = 2.0


class LiveSpectrum:
    """Streaming analysis of one microphone.

    Parameters
    ----------
    rate_hz : float
    settings : LiveDetection
    history_s : float
        Length of spectrogram and levels.

    Attributes
    ----------
    levels : dict of str to ChannelHistory
        "LZF" and "LAF", dB re 20 µPa.
    spectrogram : SpectrogramHistory
    spectrum_db : ndarray or None, shape (n_lines,)
        Of the newest frame.
    spectrum_s : float
        Middle of the newest frame.
    hold_db : ndarray or None, shape (n_lines,)
        Largest level of each line, falling slowly.
    """

    def __init__(
        self, rate_hz: float, settings: LiveDetection | None = None, history_s: float = HISTORY_S
    ) -> None:
        self.settings = settings or LiveDetection()
        self.rate_hz = float(rate_hz)
        self._stft = StreamingSpectrum(rate_hz, self.settings.fft_size, self.settings.hop)
        lines = self.settings.fft_size // 2 + 1
        self.line_hz = self._stft.line_hz
        self.spectrogram = SpectrogramHistory(self._stft.hop_s, self.line_hz, lines, history_s)
        self._meter = LevelMeter(rate_hz)
        self.levels = {name: ChannelHistory(self._meter.levels_hz, history_s) for name in (LZF, LAF)}
        self._tracks = LiveTracks(self.settings, self._stft.hop_s, self.line_hz, history_s)
        self.spectrum_db: NDArray[np.floating] | None = None
        self.hold_db: NDArray[np.floating] | None = None
        self.spectrum_s = float("-inf")

    def feed(self, t_s: float, pascal: NDArray[np.floating]) -> None:
        """Sound pressure that begins at `t_s`, Pa."""
        frames = self._stft.feed(t_s, pascal)
        self.spectrogram.append(frames)
        self._tracks.feed(frames)
        if len(frames.power):
            self._take_newest(frames.t_s + (len(frames.power) - 1) * self._stft.hop_s, frames.power)
        levels = self._meter.feed(t_s, pascal)  # none while the averages are still rising after a gap
        self.levels[LZF].append(levels.t_s, levels.lzf_db)
        self.levels[LAF].append(levels.t_s, levels.laf_db)

    def _take_newest(self, t_s: float, power: NDArray[np.float32]) -> None:
        passed_s = t_s - self.spectrum_s
        self.spectrum_db, self.spectrum_s = level_db(power[-1]), t_s
        largest = level_db(np.fmax.reduce(power, axis=0))
        if self.hold_db is None or not 0.0 < passed_s < HISTORY_S:
            self.hold_db = largest
        else:
            self.hold_db = np.fmax(self.hold_db - _HOLD_DECAY_DB_S * passed_s, largest)

    def events(self) -> list[LiveEvent]:
        """Squeal events of the history in the order of their start."""
        return self._tracks.events()

    @property
    def frequency_hz(self) -> NDArray[np.floating]:
        """Of the lines of the spectrum, shape (n_lines,)."""
        return np.arange(self.settings.fft_size // 2 + 1) * self.line_hz

    def copy(self) -> LiveSpectrum:
        """Independent copy, for a frozen display; it is not fed any more."""
        twin = object.__new__(LiveSpectrum)
        twin.__dict__.update(self.__dict__)
        twin.spectrogram = self.spectrogram.copy()
        twin.levels = {name: history.copy() for name, history in self.levels.items()}
        twin._tracks = self._tracks.copy()
        return twin
