"""Simulation of a brake for people: time series, events, coupling forces (section 2.2) of a braking at one
point.

Job: the study of one motion integrated with all events, in the words and units of the rig. NOT its job:
integration (`sim_hardware.brake_model.time_domain.motion`), bifurcations and long runs, drawing
(`motion_figures`).
"""

from __future__ import annotations

import math
from collections import Counter
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from rigctl.model.motion_figures import forces_figure, motion_figure
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.friction import (
    ConstantFriction,
    FrictionLaw,
    LinearFriction,
    SaturatingFriction,
)
from sim_hardware.brake_model.time_domain.energy import balance
from sim_hardware.brake_model.time_domain.motion import CouplingForces, Motion, integrate
from sim_hardware.brake_model.time_domain.reference import WorkingPoint

Array = NDArray[np.float64]
LAWS = ("constant", "linear", "saturating")

PA_PER_BAR = 1e5
#: size of slip variation at which the saturating law's slope fades (m/s), as the simulated rig has it
SATURATION_M_S = 0.1
START_M_S = 1e-3
OUTPUT_HZ = 40_000.0
#: part of the motion at its end that counts as the state it has reached
_END = 0.25


def friction_law(law: str, mu: float, slope_s_m: float, saturation_m_s: float) -> FrictionLaw:
    """The friction law of that name around the working point.

    Raises
    ------
    ValueError
        unknown law
    pydantic.ValidationError
        values out of range
    """
    if law == "constant":
        return ConstantFriction(mu_mean=mu)
    if law == "linear":
        return LinearFriction(mu_mean=mu, k_s_m=slope_s_m)
    if law == "saturating":
        return SaturatingFriction(mu_mean=mu, k_s_m=slope_s_m, saturation_m_s=saturation_m_s)
    raise ValueError(f"friction law {law!r}; known: {', '.join(LAWS)}")


def least_stable_start(
    brake: Brake, mu: float, slope_s_m: float, pressure_pa: float, speed_m_s: float
) -> Array:
    """Initial state (2 n_dof,): shape of the least stable vibration, scaled to a largest slip velocity at the
    pads.

    Raises
    ------
    ValueError
        no vibration moves the pads along the disc
    """
    decomposition = np.linalg.eig(brake.state_matrix(mu, slope_s_m, pressure_pa))
    values: NDArray[np.complex128] = decomposition[0].astype(complex)
    vectors: NDArray[np.complex128] = decomposition[1].astype(complex)
    rows = np.array([contact.row_x for contact in brake.contacts])
    n = brake.n_dof
    slips = np.abs(rows @ vectors[n:]).max(axis=0)
    size = np.linalg.norm(vectors[n:], axis=0)
    moving = np.flatnonzero((values.imag > 0.0) & (slips > 1e-9 * size))
    if moving.size == 0:
        raise ValueError(
            f"no vibration of brake '{brake.name}' moves its pads along the disc: no start to take"
        )
    shape = vectors[:, moving[int(np.argmax(values[moving].real))]]
    largest = (rows @ shape[n:])[int(np.argmax(np.abs(rows @ shape[n:])))]
    return (shape * (speed_m_s / largest)).real


def simulation_study(
    brake: Brake,
    pressure_bar: float,
    speed_rpm: float,
    duration_s: float,
    *,
    law: str = "saturating",
    mu: float | None = None,
    slope_s_m: float | None = None,
    saturation_m_s: float = SATURATION_M_S,
    start_m_s: float = START_M_S,
    forces: bool = False,
    output_hz: float = OUTPUT_HZ,
    rtol: float = 1e-8,
    name: str = "simulation",
) -> Study:
    """Motion of a brake at one working point, from a small motion of its least stable shape.

    Parameters
    ----------
    pressure_bar, speed_rpm : working point; speed of the disc in 1/min
    duration_s : length of the simulated time
    law : "constant", "linear" (eq 28) or "saturating" (slope fades beyond `saturation_m_s`)
    mu, slope_s_m : coefficient of friction and falling slope at the working point; the brake file's where
        None
    start_m_s : slip velocity of the initial motion
    forces : record the forces of all coupling elements
    output_hz : rate of the series; the integration chooses its own steps
    rtol : tolerance of a step

    Returns
    -------
    facts: squeal frequency, slip amplitude, sticking, energy balance; tables "series", "events" and with
    forces "forces", "peak_forces"; figures "motion" and with forces "forces"

    Raises
    ------
    ValueError, ArithmeticError
        wrong values; the motion is not finite
    """
    for key, value in (("pressure", pressure_bar), ("speed", speed_rpm), ("start", start_m_s)):
        if not (math.isfinite(value) and value >= 0.0):
            raise ValueError(f"{key} is {value!r}: give a finite number, 0 or more")
    if not (math.isfinite(duration_s * output_hz) and duration_s * output_hz >= 2.0 and output_hz > 0.0):
        raise ValueError(
            f"{duration_s!r} s at {output_hz!r} Hz: give at least two samples of a positive rate"
        )
    mu = brake.mu if mu is None else mu
    slope = brake.slope_s_m if slope_s_m is None else slope_s_m
    try:
        chosen = friction_law(law, mu, slope, saturation_m_s)
    except ValidationError as error:
        first = error.errors()[0]
        key = first["loc"][-1] if first["loc"] else law
        raise ValueError(f"friction law: {key} is {first['input']!r}: {first['msg']}") from error
    slip_m_s = 2.0 * math.pi * speed_rpm / 60.0 * brake.effective_radius_m
    point = WorkingPoint(brake.pad_force_n(pressure_bar * PA_PER_BAR), slip_m_s, chosen)
    start = least_stable_start(brake, mu, chosen.slope_s_m, pressure_bar * PA_PER_BAR, start_m_s)
    times = np.arange(math.floor(duration_s * output_hz) + 1) / output_hz
    motion = integrate(brake, point, start, times, rtol=rtol, record_forces=forces)
    facts = _facts(motion, pressure_bar, speed_rpm, law, output_hz)
    title = f"{brake.name} at {pressure_bar:g} bar, {speed_rpm:g} 1/min, {law} friction: {_headline(facts)}"
    tables = [_events(motion), _series(motion)]
    figures = {"motion": partial(motion_figure, motion, title)}
    if motion.coupling_forces is not None:
        tables += [_peaks(motion.coupling_forces), _force_series(motion.times_s, motion.coupling_forces)]
        figures["forces"] = partial(forces_figure, motion.coupling_forces, title)
    return Study(name, title, facts, tuple(tables), figures)


def _headline(facts: dict[str, Any]) -> str:
    if facts["slip_amplitude_m_s"] < facts["start_slip_m_s"]:
        return "the motion dies out"
    text = f"{facts['frequency_hz']:.0f} Hz, slip ±{facts['slip_amplitude_m_s']:.3g} m/s"
    sticking = max(facts["sticking_share"].values())
    return text + (f", sticks {100.0 * sticking:.0f} % of the time" if sticking > 0.0 else "")


def _facts(
    motion: Motion, pressure_bar: float, speed_rpm: float, law: str, output_hz: float
) -> dict[str, Any]:
    slip = motion.course.slip_m_s[0] - motion.sliding_speed_m_s
    last = slip[-max(2, round(_END * len(slip))) :]
    leading = int(np.argmax(np.abs(last).max(axis=0)))
    counts = Counter((event.where, event.kind) for event in motion.events)
    energies = balance(motion)
    scale = float(max((energies.kinetic + energies.stored).max(), energies.dissipated[-1]))
    return {
        "pressure_bar": pressure_bar,
        "speed_rpm": speed_rpm,
        "sliding_speed_m_s": float(motion.course.slip_m_s[0]),
        "friction_law": law,
        "coefficient_of_friction": float(motion.course.mu_mean[0]),
        "slope_s_m": float(motion.course.k_s_m[0]),
        "frequency_hz": main_frequency_hz(last[:, leading], output_hz),
        "slip_amplitude_m_s": float(np.abs(last - last.mean(axis=0)).max()),
        "start_slip_m_s": float(np.abs(slip[0]).max()),
        "least_normal_force_n": float(motion.normal_n.min()),
        "sticking_share": {name: _sticking(motion, g) for g, name in enumerate(motion.groups)},
        "events": {f"{where} {kind}": count for (where, kind), count in sorted(counts.items())},
        "integration_steps": motion.steps,
        "energy_balance_error_at_output_rate": float(np.abs(energies.error).max()) / scale
        if scale > 0.0
        else 0.0,
    }


def _sticking(motion: Motion, group: int) -> float:
    """Share of the last part of the time in which a group sticks."""
    end = float(motion.times_s[-1])
    begin = end - _END * (end - float(motion.times_s[0]))
    spans = np.clip(motion.sticking_s(group), begin, end)
    return float((spans[:, 1] - spans[:, 0]).sum() / (end - begin))


def main_frequency_hz(signal: Array, rate_hz: float) -> float:
    """Frequency of the highest line of a signal (N,), interpolated; 0 where there is no motion."""
    centred = (signal - signal.mean()) * np.blackman(len(signal))
    if len(signal) < 16 or not centred.any():
        return 0.0
    size = max(1 << 16, 4 * len(signal))
    spectrum = np.abs(np.fft.rfft(centred, size))
    i = min(max(int(spectrum.argmax()), 1), len(spectrum) - 2)
    a, b, c = np.log(np.maximum(spectrum[i - 1 : i + 2], 1e-300))
    bend = a - 2.0 * b + c
    return float((i + (0.5 * (a - c) / bend if bend else 0.0)) * rate_hz / size)


def _events(motion: Motion) -> Table:
    return Table(
        "events",
        "Events: groups of contacts stick, release, reverse; contacts lift off, land",
        (
            Column("time", "s", [event.time_s for event in motion.events]),
            Column("where", "", [event.where for event in motion.events]),
            Column("event", "", [event.kind for event in motion.events]),
        ),
    )


def _series(motion: Motion) -> Table:
    columns = [Column("time", "s", list(motion.times_s))]
    for g, name in enumerate(motion.groups):
        columns += [
            Column(f"{name}.sliding_speed", "m/s", list(motion.sliding_speed_m_s[:, g])),
            Column(f"{name}.friction", "N", list(motion.friction_n[:, g])),
            Column(f"{name}.sliding", "", list(motion.sliding[:, g])),
        ]
    columns += [
        Column(f"{contact.name}.normal_force", "N", list(motion.normal_n[:, c]))
        for c, contact in enumerate(motion.brake.contacts)
    ]
    n = motion.brake.n_dof
    for i, freedom in enumerate(motion.brake.freedoms):
        turns = freedom.endswith(".phi")
        columns += [
            Column(freedom, "rad" if turns else "m", list(motion.states[:, i])),
            Column(f"{freedom}.velocity", "rad/s" if turns else "m/s", list(motion.states[:, n + i])),
        ]
    return Table("series", "Motion from the steadily sliding state, forces as they are", tuple(columns))


def _peaks(forces: CouplingForces) -> Table:
    peaks = np.abs(forces.forces_n).max(axis=0)
    moments = np.abs(forces.moments_nm).max(axis=0)
    return Table(
        "peak_forces",
        "Largest variation of the force of each coupling element (torsions: N m)",
        (
            Column("coupling", "", (*forces.elements, *forces.torsions)),
            Column("along_x", "N", [*map(float, peaks[:, 0]), *(None for _ in forces.torsions)]),
            Column("along_y", "N", [*map(float, peaks[:, 1]), *(None for _ in forces.torsions)]),
            Column("moment", "N m", [*(None for _ in forces.elements), *map(float, moments)]),
        ),
    )


def _force_series(times: Array, forces: CouplingForces) -> Table:
    columns = [Column("time", "s", list(times))]
    for e, name in enumerate(forces.elements):
        columns += [
            Column(f"{name}.force_{axis}", "N", list(forces.forces_n[:, e, i])) for i, axis in enumerate("xy")
        ]
    columns += [
        Column(f"{name}.moment", "N m", list(forces.moments_nm[:, t]))
        for t, name in enumerate(forces.torsions)
    ]
    return Table(
        "forces", "Forces of all coupling elements on their second body, from the mean", tuple(columns)
    )
