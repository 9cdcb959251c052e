"""Compiled inner loops of squeal detection: spectral peaks of each frame, and their tracks through time.

Job: candidate peaks with interpolated frequency, power and prominence; greedy frame-to-frame association.
NOT its job: deciding what is an event (`squeal`).
"""

import numba
import numpy as np

from rigctl.signals.spectra import interpolate_peak

SCALLOPING = 0.70
"""Power on the nearest line of a Hann-windowed tone is at least this share of the tone's power (-1.42 dB)."""


@numba.njit(cache=True, nogil=True)
def _select(values, n, rank):
    """Value of given rank among values[:n] (reorders them): Hoare's quickselect."""
    low, high = 0, n - 1
    while low < high:
        pivot = values[(low + high) >> 1]
        i, j = low, high
        while i <= j:
            while values[i] < pivot:
                i += 1
            while values[j] > pivot:
                j -= 1
            if i <= j:
                values[i], values[j] = values[j], values[i]
                i += 1
                j -= 1
        if rank <= j:
            high = j
        elif rank >= i:
            low = i
        else:
            break
    return values[rank]


@numba.njit(cache=True, nogil=True)
def find_peaks(
    power,
    first_frame,
    low,
    high,
    minimum,
    prominence,
    half_width,
    separation,
    dynamic_range,
    frame_of,
    line,
    strength,
    ratio,
):
    """Peaks of all frames, strongest first within a frame.

    Parameters
    ----------
    power : ndarray, shape (n_frames, n_lines), float32
    first_frame : int
        Frames before it are skipped.
    low, high : int
        First and last line searched.
    minimum : ndarray, shape (n_lines,), float64
        Least interpolated power of a peak at each line.
    prominence : float
        Least ratio of power to the running median of the lines within `half_width`.
    separation : int
        A line with a stronger one within this distance is no peak (modulation side bands, window side lobes).
    dynamic_range : float
        Peaks weaker than the frame's strongest divided by this are dropped.
    frame_of, line, strength, ratio : ndarray, shape (capacity,)
        Output: frame index, interpolated line, interpolated power, ratio to the running median.

    Returns
    -------
    int
        Number of peaks; equal to the capacity when the arrays were too small (then weaker ones are missing).

    Notes
    -----
    The running median is evaluated at candidates only, so quiet frames cost one comparison a line.
    """
    n_lines = power.shape[1]
    scratch = np.empty(2 * half_width + 1, np.float32)
    count = 0
    capacity = frame_of.shape[0]
    for frame in range(first_frame, power.shape[0]):
        row = power[frame]
        begin = count
        for k in range(low, high + 1):
            p = row[k]
            if p < SCALLOPING * minimum[k] or p <= row[k - 1] or p < row[k + 1]:
                continue
            stronger = False
            for j in range(max(low, k - separation), min(high, k + separation) + 1):
                if row[j] > p:
                    stronger = True
                    break
            if stronger:
                continue
            position, value = interpolate_peak(row, k)
            if value < minimum[k]:
                continue
            left, right = max(1, k - half_width), min(n_lines - 2, k + half_width)
            n = right - left + 1
            for j in range(n):
                scratch[j] = row[left + j]
            median = np.float64(_select(scratch, n, n >> 1))
            if value < prominence * median:
                continue
            if count == capacity:
                return count
            # insertion sort, strongest first
            slot = count
            while slot > begin and strength[slot - 1] < value:
                frame_of[slot] = frame_of[slot - 1]
                line[slot] = line[slot - 1]
                strength[slot] = strength[slot - 1]
                ratio[slot] = ratio[slot - 1]
                slot -= 1
            frame_of[slot] = frame
            line[slot] = position
            strength[slot] = value
            ratio[slot] = value / max(median, 1e-30)
            count += 1
        while count > begin and strength[count - 1] * dynamic_range < strength[begin]:
            count -= 1
    return count


@numba.njit(cache=True, nogil=True)
def track_peaks(frame_of, line, tolerance, tolerance_relative, max_gap, track_of):
    """Give every peak the number of its track; returns the number of tracks.

    A peak joins the nearest free track whose last frequency lies within the tolerance (lines, or a share of
    the frequency, whichever is larger) and whose last frame is at most `max_gap` + 1 frames ago; strongest
    peaks choose first (the input is sorted that way). `track_of` (shape (n_peaks,)) is the output.
    """
    n = frame_of.shape[0]
    last_line = np.empty(n, np.float64)
    last_frame = np.empty(n, np.int64)
    alive = np.empty(n, np.int64)
    n_alive = 0
    n_tracks = 0
    for i in range(n):
        frame = frame_of[i]
        if i == 0 or frame != frame_of[i - 1]:
            kept = 0
            for a in range(n_alive):
                if frame - last_frame[alive[a]] <= max_gap + 1:
                    alive[kept] = alive[a]
                    kept += 1
            n_alive = kept
        best = -1
        best_distance = max(tolerance, tolerance_relative * line[i])
        for a in range(n_alive):
            track = alive[a]
            if last_frame[track] == frame:
                continue
            distance = abs(last_line[track] - line[i])
            if distance <= best_distance:
                best = track
                best_distance = distance
        if best < 0:
            best = n_tracks
            n_tracks += 1
            alive[n_alive] = best
            n_alive += 1
        last_line[best] = line[i]
        last_frame[best] = frame
        track_of[i] = best
    return n_tracks
