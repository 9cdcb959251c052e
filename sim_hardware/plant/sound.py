"""Sound at the microphone: what the brake radiates, what the rig adds, and the converter.

Job: roughness excitation and time integration of the brake over a block, monopole radiation of its surfaces,
motor lines, shaft, ventilator and valve noise, 16-bit conversion with clipping. Levels are dB(Z) re 20 uPa.
NOT its job: slow physics; whether the brake squeals (that is `sim_hardware.brake_model`, from pressure,
friction and slope at this moment); evaluation of the sound.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from rigctl.core.errors import ConfigError
from rigctl.core.units import M3_S_PER_M3_H, PA_PER_BAR, REFERENCE_PRESSURE_PA
from sim_hardware.brake_model import Brake, SquealIntegrator
from sim_hardware.plant.layout import TRACK
from sim_hardware.plant.settings import BackgroundSettings, PlantSettings

SOUND_HZ = 40_000
SAMPLES_PER_TICK = 10
#: the brake is integrated in pieces of at most this many rows of the sound track (50 ms), linear in between
_ROWS = 5
#: slower than this the disc stands, as far as sound goes
_MIN_SLIP_M_S = 0.01
_FORCE, _MU, _SLIP, _SLOPE, _AIR_RATE, _OMEGA, _MOTOR_TORQUE, _FLOW, _ANGLE = range(len(TRACK))
_BACKGROUND, _VENTILATOR, _HISS = range(3)
_N_LINES = 4
#: all noise is drawn uniform, which is quick; filters and resonances make it Gaussian. rms 1 needs a width of
_UNIFORM = math.sqrt(12.0)
_INAUDIBLE_PA = 1e-5

Array = NDArray[np.float64]


class Sound:
    """Source of the microphone's samples. Keeps filters, phases and the brake's motion between blocks.

    Parameters
    ----------
    settings : physical values
    brake : the brake inside the rig
    random : generator of all noise of the sound

    Raises
    ------
    ConfigError
        a radiating surface that does not belong to the brake
    """

    def __init__(self, settings: PlantSettings, brake: Brake, random: np.random.Generator) -> None:
        radiation, background = settings.radiation, settings.background
        radiating = tuple(radiation.areas_m2)
        for freedom in radiating:
            if freedom not in brake.freedoms or freedom.endswith(".phi"):
                raise ConfigError(
                    "the brake has no such translation.",
                    place=f"{settings.name}: radiation.areas_m2",
                    value=freedom,
                    remedy=f"Use some of: {', '.join(f for f in brake.freedoms if not f.endswith('.phi'))}.",
                )
        self._radiation = radiation
        self._background = background
        self._random = random
        self._flow_max = settings.thermal.ventilator_max_m3_h * M3_S_PER_M3_H
        self._ventilator = (_rms_pa(background.ventilator_db), _amplitude_pa(background.ventilator_blade_db))
        self._motor_lines = np.array([_amplitude_pa(level_db) for level_db in background.motor_lines_db])
        self._hiss = _rms_pa(background.hiss_db) / (background.hiss_rate_bar_per_s * PA_PER_BAR)
        self._motor_step = 2.0 * math.pi * background.motor_line_hz / SOUND_HZ
        self._blade_step = 2.0 * math.pi * background.ventilator_blade_hz / (SOUND_HZ * self._flow_max)
        self._integrator = SquealIntegrator(brake, output_hz=float(SOUND_HZ), outputs=radiating)
        # monopole: p = rho / (4 pi r) S dv/dt
        monopole = (
            radiation.efficiency
            * radiation.air_density_kg_m3
            / (4.0 * math.pi * radiation.microphone_distance_m)
        )
        self._weights = monopole * np.array(list(radiation.areas_m2.values()))
        self._filters = _filters(background)
        self._memory = np.zeros((3, 2))
        self._phasors = np.zeros((_N_LINES, 2))
        self._phasors[:, 0] = 1.0
        self._counts_per_pa = 32768.0 / settings.microphone.full_scale_pa
        self._floor = math.hypot(
            _rms_pa(background.background_db), _rms_pa(settings.microphone.self_noise_db)
        )

    def forget(self) -> None:
        """The brake's motion dies away: nothing was rendered for a while."""
        self._integrator.reset()

    def render(self, track: Array, ticks: int, drive_on: bool) -> NDArray[np.int16]:
        """Sound of a step.

        Parameters
        ----------
        track : (rows, 9) course of the slow state, see `layout.TRACK`
        ticks : length of the step in 0.25 ms
        drive_on : the rectifier works

        Returns
        -------
        (10 ticks,) int16 counts of the converter
        """
        out = np.empty(SAMPLES_PER_TICK * ticks, np.int16)
        last = len(track) - 1
        done = 0
        for row in range(0, last, _ROWS):
            end = min(row + _ROWS, last)
            stop = len(out) if end == last else SAMPLES_PER_TICK * 40 * end
            self._piece(track[row], track[end], track[row : end + 1, _AIR_RATE], drive_on, out[done:stop])
            done = stop
        return out

    def _piece(
        self, start: Array, end: Array, air_rate: Array, drive_on: bool, out: NDArray[np.int16]
    ) -> None:
        n = len(out)
        motion = self._brake(start, end, n)
        first, last = self._levels(start, drive_on), self._levels(end, drive_on)
        hiss = self._hiss * float(air_rate.mean())
        first[_HISS] = last[_HISS] = hiss if hiss > _INAUDIBLE_PA else 0.0
        white = np.empty((3, n), np.float32)
        for source in (_BACKGROUND, _VENTILATOR, _HISS):
            if first[source] + last[source] > 0.0:
                self._random.random(out=white[source], dtype=np.float32)
        blade = self._blade_step * 0.5 * (start[_FLOW] + end[_FLOW])
        steps = (self._motor_step, 2.0 * self._motor_step, 3.0 * self._motor_step, blade)
        shaft = 0.5 * (start[_OMEGA] + end[_OMEGA]) / SOUND_HZ
        modulation = self._background.shaft_modulation if shaft > 0.0 else 0.0
        _mix(
            motion, self._weights, white, self._filters, self._memory, self._phasors, steps, first, last,
            start[_ANGLE], shaft, self._radiation.modulation, modulation, self._counts_per_pa, out,
        )  # fmt: skip

    def _brake(self, start: Array, end: Array, n: int) -> Array:
        """Accelerations of the radiating surfaces, (n, surfaces) m/s2; (0, surfaces) while nothing rubs."""
        force, slip = (float(start[_FORCE]), float(end[_FORCE])), (float(start[_SLIP]), float(end[_SLIP]))
        if max(force) <= 0.0 or min(slip) < _MIN_SLIP_M_S:
            self._integrator.reset()
            return np.zeros((0, len(self._weights)))
        rough = self._radiation.roughness_n_per_sqrt_n * math.sqrt(0.5 * (force[0] + force[1]))
        excitation = self._random.random((n, self._integrator.n_pads))
        excitation -= 0.5
        excitation *= _UNIFORM * rough
        return self._integrator.advance(
            n,
            normal_force_n=force,
            mu=(float(start[_MU]), float(end[_MU])),
            slip_m_s=slip,
            k_s_m=(float(start[_SLOPE]), float(end[_SLOPE])),
            saturation_m_s=self._radiation.saturation_m_s,
            excitation_n=excitation,
        )

    def _levels(self, row: Array, drive_on: bool) -> Array:
        """Rms sound pressure of background, ventilator, hiss (the caller's), amplitudes of the lines, Pa."""
        b = self._background
        levels = np.zeros(3 + _N_LINES)
        levels[_BACKGROUND] = self._floor
        flow = float(row[_FLOW])
        if flow > 0.02 * self._flow_max:
            fan = (flow / self._flow_max) ** b.ventilator_level_exponent
            levels[_VENTILATOR] = self._ventilator[0] * fan
            levels[3 + _N_LINES - 1] = self._ventilator[1] * fan
        if drive_on:
            load_db = b.motor_line_db_per_knm * abs(float(row[_MOTOR_TORQUE])) / 1000.0
            levels[3 : 3 + len(self._motor_lines)] = self._motor_lines * 10.0 ** (load_db / 20.0)
        return levels


def _rms_pa(level_db: float) -> float:
    return REFERENCE_PRESSURE_PA * 10.0 ** (level_db / 20.0)


def _amplitude_pa(level_db: float) -> float:
    return math.sqrt(2.0) * _rms_pa(level_db)


def _filters(b: BackgroundSettings) -> Array:
    """Per noise: pole of the low pass, pole of the high pass or 0, gain to unit power; (3, 3)."""
    back = np.exp(-1j * np.linspace(0.0, 2.0 * math.pi, SOUND_HZ, endpoint=False))  # z^-1 on the unit circle
    rows = []
    for low_hz, high_hz in (
        (b.background_corner_hz, 0.0),
        (b.ventilator_corner_hz, 0.0),
        (b.hiss_to_hz, b.hiss_from_hz),
    ):
        low = math.exp(-2.0 * math.pi * low_hz / SOUND_HZ)
        high = math.exp(-2.0 * math.pi * high_hz / SOUND_HZ) if high_hz > 0.0 else 0.0
        response = (1.0 - low) / np.abs(1.0 - low * back)
        if high > 0.0:
            response = response * np.abs((1.0 - back) / (1.0 - high * back))
        rows.append((low, high, _UNIFORM / math.sqrt(float(np.mean(response**2)))))
    return np.array(rows)


@njit(cache=True, nogil=True)
def _mix(
    motion: Any,
    weights: Any,
    white: Any,
    filters: Any,
    memory: Any,
    phasors: Any,
    steps: Any,
    first: Any,
    last: Any,
    angle: float,
    shaft_step: float,
    directivity: float,
    shaft_modulation: float,
    counts_per_pa: float,
    out: Any,
) -> None:
    """Sum all sources and convert to counts.

    motion (n or 0, surfaces) m/s2; weights (surfaces,) Pa per m/s2; white (3, n) uniform in 0 to 1; filters
    (3, 3); memory (3, 2) and phasors (4, 2), changed; steps (4,) rad per sample; first, last (7,) levels at
    start and end, linear between; out (n,) int16, filled.
    """
    n = out.shape[0]
    pressure = np.zeros(n)
    shaft = np.empty(n)
    s_re, s_im = math.cos(angle), math.sin(angle)
    t_re, t_im = math.cos(shaft_step), math.sin(shaft_step)
    for i in range(n):
        shaft[i] = s_im
        s_re, s_im = s_re * t_re - s_im * t_im, s_re * t_im + s_im * t_re
    if motion.shape[0] == n:
        for i in range(n):
            total = 0.0
            for j in range(weights.shape[0]):
                total += weights[j] * motion[i, j]
            pressure[i] = total * (1.0 + directivity * shaft[i])
    for source in range(3):
        level, rise = first[source], (last[source] - first[source]) / n
        if level == 0.0 and rise == 0.0:
            memory[source, 0] = memory[source, 1] = 0.0
            continue
        low, high, gain = filters[source, 0], filters[source, 1], filters[source, 2]
        slow, passed = memory[source, 0], memory[source, 1]
        modulation = shaft_modulation if source == 0 else 0.0
        for i in range(n):
            before = slow
            slow = low * slow + (1.0 - low) * (white[source, i] - 0.5)
            value = slow
            if high > 0.0:
                passed = high * passed + slow - before
                value = passed
            pressure[i] += gain * value * (level + rise * i) * (1.0 + modulation * shaft[i])
        memory[source, 0], memory[source, 1] = slow, passed
    for line in range(phasors.shape[0]):
        level, rise = first[3 + line], (last[3 + line] - first[3 + line]) / n
        if level == 0.0 and rise == 0.0:
            continue
        re, im = phasors[line, 0], phasors[line, 1]
        c, s = math.cos(steps[line]), math.sin(steps[line])
        for i in range(n):
            pressure[i] += im * (level + rise * i)
            re, im = re * c - im * s, re * s + im * c
        size = math.sqrt(re * re + im * im)
        phasors[line, 0], phasors[line, 1] = re / size, im / size
    for i in range(n):
        out[i] = np.int16(min(max(round(pressure[i] * counts_per_pa), -32768.0), 32767.0))
