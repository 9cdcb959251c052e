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
from sim_hardware.brake_model import Brake, SquealIntegrator, compile_kernels
from sim_hardware.plant.layout import TRACK
from sim_hardware.plant.settings import BackgroundSettings, PlantSettings

SOUND_HZ = 40_000
SAMPLES_PER_TICK = 10
#: the brake is integrated in pieces of at most this many rows of the sound track (50 ms), linear in between
_ROWS = 5
#: slower than this the disc stands, as far as sound goes
_MIN_SLIP_M_S = 0.01
_FORCE, _MU, _SLIP, _SLOPE, _AIR_RATE, _OMEGA, _MOTOR_TORQUE, _FLOW, _ANGLE = range(len(TRACK))
_SOURCES, _N_LINES = 3, 4
#: all noise is drawn uniform, which is quick; filters and resonances make it Gaussian. rms 1 needs a width of
_UNIFORM = math.sqrt(12.0)
_INAUDIBLE_PA = 1e-5
_SILENCE = np.zeros((0, 1))

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
        self._random = random.integers(1, 2**64, 4, dtype=np.uint64)  # state of the kernels' generator
        self._flow_max = settings.thermal.ventilator_max_m3_h * M3_S_PER_M3_H
        self._ventilator = (_rms_pa(background.ventilator_db), _amplitude_pa(background.ventilator_blade_db))
        lines = [_amplitude_pa(level_db) for level_db in background.motor_lines_db]
        self._motor_lines = lines + [0.0] * (_N_LINES - 1 - len(lines))
        self._hiss = _rms_pa(background.hiss_db) / (background.hiss_rate_bar_per_s * PA_PER_BAR)
        self._motor_step = 2.0 * math.pi * background.motor_line_hz / SOUND_HZ
        self._blade_step = 2.0 * math.pi * background.ventilator_blade_hz / (SOUND_HZ * self._flow_max)
        # monopole: p = rho / (4 pi r) S dv/dt
        monopole = (
            radiation.efficiency
            * radiation.air_density_kg_m3
            / (4.0 * math.pi * radiation.microphone_distance_m)
        )
        self._brake = brake
        self._integrator = SquealIntegrator(
            brake,
            output_hz=float(SOUND_HZ),
            outputs=radiating,
            weights=[monopole * area_m2 for area_m2 in radiation.areas_m2.values()],
        )
        self._filters = _filters(background)
        self._memory = np.zeros((_SOURCES, 2))
        self._phasors = np.array([[1.0, 0.0], [1.0, 0.0]])  # motor line and ventilator's blades, e^(i angle)
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

    def compile(self) -> None:
        """Compile (or load) the kernels of the brake's motion that are needed only around slip reversals."""
        compile_kernels(self._brake)

    def _piece(
        self, start: Array, end: Array, air_rate: Array, drive_on: bool, out: NDArray[np.int16]
    ) -> None:
        n = len(out)
        first, last = start.tolist(), end.tolist()
        motion = self._motion(first, last, n)
        hiss = self._hiss * float(air_rate.sum()) / len(air_rate)
        hiss = hiss if hiss > _INAUDIBLE_PA else 0.0
        levels = np.array([self._levels(first, hiss, drive_on), self._levels(last, hiss, drive_on)])
        shaft = 0.5 * (first[_OMEGA] + last[_OMEGA]) / SOUND_HZ
        blade = self._blade_step * 0.5 * (first[_FLOW] + last[_FLOW])
        _mix(
            motion, self._random, self._filters, self._memory, self._phasors, levels,
            self._motor_step, blade, first[_ANGLE], shaft, self._radiation.modulation,
            self._background.shaft_modulation if shaft > 0.0 else 0.0, self._counts_per_pa, out,
        )  # fmt: skip

    def _motion(self, start: list[float], end: list[float], n: int) -> Array:
        """Sound pressure of the radiating surfaces, (n, 1) Pa; (0, 1) while nothing rubs."""
        force, slip = (start[_FORCE], end[_FORCE]), (start[_SLIP], end[_SLIP])
        if max(force) <= 0.0 or min(slip) < _MIN_SLIP_M_S:
            self._integrator.reset()
            return _SILENCE
        rough = self._radiation.roughness_n_per_sqrt_n * math.sqrt(0.5 * (force[0] + force[1]))
        excitation = np.empty((n, self._integrator.n_pads))
        _roughness(self._random, _UNIFORM * rough, excitation)
        return self._integrator.advance(
            n,
            normal_force_n=force,
            mu=(start[_MU], end[_MU]),
            slip_m_s=slip,
            k_s_m=(start[_SLOPE], end[_SLOPE]),
            saturation_m_s=self._radiation.saturation_m_s,
            excitation_n=excitation,
        )

    def _levels(self, row: list[float], hiss_pa: float, drive_on: bool) -> list[float]:
        """Rms sound pressure of background, ventilator, hiss, amplitudes of the lines, Pa."""
        b = self._background
        noise_pa, blade_pa, motor_pa = 0.0, 0.0, 0.0
        flow = row[_FLOW]
        if flow > 0.02 * self._flow_max:
            fan = (flow / self._flow_max) ** b.ventilator_level_exponent
            noise_pa, blade_pa = self._ventilator[0] * fan, self._ventilator[1] * fan
        if drive_on:
            motor_pa = 10.0 ** (b.motor_line_db_per_knm * abs(row[_MOTOR_TORQUE]) / 20_000.0)
        return [self._floor, noise_pa, hiss_pa, *(motor_pa * line for line in self._motor_lines), blade_pa]


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


@njit(inline="always")
def _turn(bits: Any, left: int) -> Any:
    """Rotate 64 bits to the left."""
    return (bits << np.uint64(left)) | (bits >> np.uint64(64 - left))


@njit(inline="always")
def _draw(a: Any, b: Any, c: Any, d: Any) -> tuple[Any, Any, Any, Any, float, float]:
    """Next state of the generator xoshiro256++ and two numbers, uniform in -0.5 to 0.5, from its 64 bits."""
    bits = _turn(a + d, 23) + a
    c ^= a
    d ^= b
    shifted = b << np.uint64(17)
    b ^= c
    a ^= d
    c ^= shifted
    d = _turn(d, 45)
    high, low = np.int32(bits >> np.uint64(32)), np.int32(bits & np.uint64(0xFFFFFFFF))
    return a, b, c, d, high * 2.0**-32, low * 2.0**-32


@njit(cache=True, nogil=True)
def _roughness(random: Any, width: float, force: Any) -> None:
    """Fill force (n, pads) with noise, uniform, independent; random (4,) state of the generator, changed."""
    a, b, c, d = random[0], random[1], random[2], random[3]
    for i in range(force.shape[0]):
        for p in range(0, force.shape[1], 2):
            a, b, c, d, first, second = _draw(a, b, c, d)
            force[i, p] = width * first
            if p + 1 < force.shape[1]:
                force[i, p + 1] = width * second
    random[0], random[1], random[2], random[3] = a, b, c, d


@njit(cache=True, nogil=True)
def _mix(  # noqa: PLR0915 (one pass over the samples)
    motion: Any,
    random: Any,
    filters: Any,
    memory: Any,
    phasors: Any,
    levels: Any,
    motor_step: float,
    blade_step: float,
    angle: float,
    shaft_step: float,
    directivity: float,
    shaft_modulation: float,
    counts_per_pa: float,
    out: Any,
) -> None:
    """Sum all sources and convert to counts, in one pass.

    motion (n or 0, 1) Pa; random (4,) state of the generator, memory (3, 2) and phasors (2, 2), changed;
    filters (3, 3); levels (2, 7) at start and end, linear between; steps in rad per sample; out (n,) int16,
    filled.
    """
    n = out.shape[0]
    rubs = motion.shape[0] == n
    fan, air = levels[0, 1] + levels[1, 1] > 0.0, levels[0, 2] + levels[1, 2] > 0.0
    motor, blade = levels[0, 3] + levels[1, 3] > 0.0, levels[0, 6] + levels[1, 6] > 0.0
    a, b, c, d = random[0], random[1], random[2], random[3]
    low0, low1, low2 = filters[0, 0], filters[1, 0], filters[2, 0]
    high2 = filters[2, 1]
    gain0 = (1.0 - low0) * filters[0, 2]
    gain1 = (1.0 - low1) * filters[1, 2]
    gain2 = (1.0 - low2) * filters[2, 2]
    slow0, slow1 = memory[0, 0], memory[1, 0] if fan else 0.0
    slow2, passed = (memory[2, 0], memory[2, 1]) if air else (0.0, 0.0)
    l0, l1, l2, l3 = levels[0, 0], levels[0, 1], levels[0, 2], levels[0, 3]
    l4, l5, l6 = levels[0, 4], levels[0, 5], levels[0, 6]
    part = 1.0 / n
    d0, d1 = (levels[1, 0] - l0) * part, (levels[1, 1] - l1) * part
    d3, d4 = (levels[1, 3] - l3) * part, (levels[1, 4] - l4) * part
    d5, d6 = (levels[1, 5] - l5) * part, (levels[1, 6] - l6) * part
    s_re, s_im, t_re, t_im = math.cos(angle), math.sin(angle), math.cos(shaft_step), math.sin(shaft_step)
    m_re, m_im, m_c, m_s = phasors[0, 0], phasors[0, 1], math.cos(motor_step), math.sin(motor_step)
    f_re, f_im, f_c, f_s = phasors[1, 0], phasors[1, 1], math.cos(blade_step), math.sin(blade_step)
    for i in range(n):
        a, b, c, d, white, second = _draw(a, b, c, d)
        slow0 = low0 * slow0 + gain0 * white
        pressure = slow0 * (l0 + d0 * i) * (1.0 + shaft_modulation * s_im)
        if rubs:
            pressure += motion[i, 0] * (1.0 + directivity * s_im)
        s_re, s_im = s_re * t_re - s_im * t_im, s_re * t_im + s_im * t_re
        if fan:
            slow1 = low1 * slow1 + gain1 * second
            pressure += slow1 * (l1 + d1 * i)
        if air:
            a, b, c, d, white, second = _draw(a, b, c, d)
            before = slow2
            slow2 = low2 * slow2 + gain2 * white
            passed = high2 * passed + slow2 - before
            pressure += passed * l2
        if motor:  # harmonics by the formulas of the double and triple angle
            twice = 2.0 * m_im * m_re
            thrice = m_im * (3.0 - 4.0 * m_im * m_im)
            pressure += m_im * (l3 + d3 * i) + twice * (l4 + d4 * i) + thrice * (l5 + d5 * i)
            m_re, m_im = m_re * m_c - m_im * m_s, m_re * m_s + m_im * m_c
        if blade:
            pressure += f_im * (l6 + d6 * i)
            f_re, f_im = f_re * f_c - f_im * f_s, f_re * f_s + f_im * f_c
        out[i] = np.int16(min(max(np.rint(pressure * counts_per_pa), -32768.0), 32767.0))
    random[0], random[1], random[2], random[3] = a, b, c, d
    memory[0, 0], memory[1, 0], memory[2, 0], memory[2, 1] = slow0, slow1, slow2, passed
    size = math.sqrt(m_re * m_re + m_im * m_im)
    phasors[0, 0], phasors[0, 1] = m_re / size, m_im / size
    size = math.sqrt(f_re * f_re + f_im * f_im)
    phasors[1, 0], phasors[1, 1] = f_re / size, f_im / size
