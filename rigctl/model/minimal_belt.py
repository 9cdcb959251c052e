"""Study of the oscillator on a moving belt (section 1.1, Fig. 1a).

Job: phase plane, limit cycles, frequency over the belt speed as a `Study`, with the paper's statements beside
ours. NOT its job: mechanics (`sim_hardware.brake_model.minimal`), drawing (`figures_minimal`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.model import figures_minimal as figures
from rigctl.model.beside_paper import Statement, statement_table
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.minimal.belt import BeltOscillator
from sim_hardware.brake_model.minimal.cycles import (
    LimitCycle,
    PhasePlane,
    SpeedCurve,
    default_amplitude_m,
    frequency_over_speed,
    largest_one_way_speed,
    next_turn_m,
    orbit,
    phase_plane,
    stick_slip_cycle,
)
from sim_hardware.brake_model.minimal.laws import BeltLaw, CoulombLaw, ExponentialLaw, LinearFallingLaw
from sim_hardware.brake_model.minimal.motion import Trajectory, simulate

Array = NDArray[np.float64]
UM = 1e6

COULOMB = CoulombLaw(mu_static=0.5, mu_dynamic=0.4)
FALLING = LinearFallingLaw(mu_static=0.5, slope_s_m=0.6)
EXPONENTIAL = ExponentialLaw(mu_static=0.5, mu_dynamic=0.4, speed_scale_m_s=0.1)
LAWS: tuple[BeltLaw, ...] = (COULOMB, FALLING, EXPONENTIAL)

BELT = BeltOscillator(
    mass_kg=1.0, stiffness_n_m=1.8e8, normal_force_n=3435.0, belt_speed_m_s=0.15, law=FALLING
)
"""1 kg at 2135 Hz under 15 bar; the slope is ten times the measured one, so that growth is seen by eye."""

SPEEDS_M_S = (0.01, 1.0)
SQUEAL_SPEED_M_S = 0.44
"""Sliding speed of the paper's squeal test (section 5.3): 40 1/min at 0.105 m."""


def belt_study(
    belt: BeltOscillator = BELT,
    *,
    laws: Sequence[BeltLaw] = LAWS,
    speeds_m_s: tuple[float, float] = SPEEDS_M_S,
    points: int = 41,
    name: str = "belt",
) -> Study:
    """Phase plane with limit cycles and stability regions (Fig. 1a), limit-cycle frequency over belt speed.

    Parameters
    ----------
    belt : the oscillator of the phase plane
    laws : friction laws compared over the belt speed, on the same oscillator
    speeds_m_s, points : range of belt speeds (spaced by equal ratios) and their number

    Raises
    ------
    ValueError
        no stiffness, belt at rest or faster than its law reaches, or a range of speeds that is none
    """
    low, high = speeds_m_s
    if not (0.0 < low < high < math.inf and points >= 2):
        raise ValueError(
            f"speeds = {low:g} … {high:g} m/s in {points} points: not a range above 0. "
            "Give two rising speeds and at least 2 points"
        )
    if belt.law.zero_speed_m_s <= belt.belt_speed_m_s:
        raise ValueError(
            f"belt_speed_m_s = {belt.belt_speed_m_s:g}: beyond {belt.law.zero_speed_m_s:.3g} m/s the law "
            "gives a negative mu. Give a smaller belt speed or slope"
        )
    plane = phase_plane(belt)
    amplitudes = np.geomspace(0.02 * _scale_m(belt, plane), _reach_m(belt, plane), 70)
    turns = np.array([next_turn_m(belt, float(a)) for a in amplitudes])
    paths = _trajectories(belt, plane)
    speeds = np.geomspace(low, high, points)
    curves = {law.law: frequency_over_speed(belt.changed(law=law), speeds) for law in laws}
    facts = _belt_facts(belt, plane) | _speed_facts(belt, laws, curves)
    return Study(
        name=name,
        title="Oscillator on a moving belt: falling friction as a mechanism of squeal (section 1.1, Fig. 1a)",
        facts=facts,
        tables=(
            _cycles_table(plane),
            _regions_table(plane),
            statement_table(_belt_statements(belt, plane, laws, curves), "1.1"),
            _frequency_table(curves),
            Table(
                "turns",
                "Amplitude before and after one turn",
                (
                    Column("amplitude", "µm", (amplitudes * UM).tolist()),
                    Column("next amplitude", "µm", (turns * UM).tolist()),
                ),
            ),
            _trajectories_table(paths),
        ),
        figures={
            "phase_plane": partial(figures.belt_phase_plane, belt, plane, paths, amplitudes, turns),
            "frequency": partial(
                figures.belt_frequency,
                belt,
                curves,
                facts.get("linear_one_way_up_to_m_s", math.nan),
                constant=facts.get("linear_spread_up_to_there_percent", math.inf) < 1e-4,
            ),
        },
    )


def figure_1a_study() -> Study:
    """Fig. 1a of the paper with our default numbers."""
    return belt_study(name="figure_1a")


def _scale_m(belt: BeltOscillator, plane: PhasePlane) -> float:
    stable = [c.turn_m for c in plane.cycles if c.stable]
    return min(stable) if stable else belt.belt_speed_m_s / belt.angular_frequency_1_s


def _reach_m(belt: BeltOscillator, plane: PhasePlane) -> float:
    """Largest amplitude drawn: beyond the outermost cycle."""
    largest = max((c.turn_m for c in plane.cycles), default=0.0)
    return max(1.6 * largest, 3.0 * _scale_m(belt, plane), 0.3 * default_amplitude_m(belt))


def _trajectories(belt: BeltOscillator, plane: PhasePlane) -> dict[str, Trajectory]:
    """Limit cycle and motions beginning inside and outside of it; boundary orbits of the regions."""
    paths: dict[str, Trajectory] = {}
    size = _scale_m(belt, plane)
    period = 1.0 / belt.frequency_hz
    rest = belt.equilibrium_m
    first = plane.regions[0]
    if math.isfinite(first.to_m):
        inside = 0.12 * size if first.behaviour == "diverging" else 0.7 * min(size, first.to_m)
        paths["from inside"] = _until_stuck(simulate(belt, rest + inside, 0.0, 6.0 * period))
        paths["from outside"] = _until_stuck(simulate(belt, rest + 1.6 * size, 0.0, 3.0 * period))
    else:  # no turn at all: until it is a hundred times as far
        growth = belt.eigenvalues()[0].real
        paths["from inside"] = simulate(belt, rest + 0.01 * size, 0.0, math.log(100.0) / growth)
    for cycle in plane.cycles:
        paths[f"{cycle.kind} cycle {cycle.turn_m * UM:.4g} µm"] = cycle.trajectory
    for region in plane.regions[:-1]:
        if not any(math.isclose(c.turn_m, region.to_m, rel_tol=1e-6) for c in plane.cycles):
            turn = orbit(belt, region.to_m)
            if turn is not None:
                paths[f"boundary {region.to_m * UM:.4g} µm"] = turn
    return paths


def _until_stuck(path: Trajectory) -> Trajectory:
    """The trajectory up to where it sticks first: from there on it is the limit cycle."""
    end = next((i for i, phase in enumerate(path.phases) if phase.kind == "stick"), len(path.phases))
    return Trajectory(path.phases[: end + 1])


def _belt_facts(belt: BeltOscillator, plane: PhasePlane) -> dict[str, Any]:
    eigenvalues = belt.eigenvalues()
    stick_slip = next((c for c in plane.cycles if c.kind == "stick-slip"), None)
    return {
        "friction_law": belt.law.law,
        "natural_frequency_hz": belt.frequency_hz,
        "equilibrium_um": belt.equilibrium_m * UM,
        "slope_at_equilibrium_s_m": belt.slope_s_m,
        "critical_slope_s_m": belt.critical_slope_s_m,
        "equilibrium_unstable": belt.falls_too_steeply,
        "damping_ratio_D": belt.damping_ratio,
        "dimensionless_belt_speed": belt.dimensionless().belt_speed if belt.normal_force_n else None,
        "growth_rate_1_s": eigenvalues[0].real,
        "growth_per_turn": float(np.exp(2.0 * math.pi * eigenvalues[0].real / abs(eigenvalues[0].imag)))
        if eigenvalues[0].imag
        else None,
        "stick_slip_frequency_hz": stick_slip.frequency_hz if stick_slip else None,
        "stick_slip_amplitude_um": stick_slip.amplitude_m * UM if stick_slip else None,
        "stick_share": stick_slip.stick_share if stick_slip else None,
        "mu_negative_beyond_m_s": belt.law.zero_speed_m_s,
    }


def _speed_facts(
    belt: BeltOscillator, laws: Sequence[BeltLaw], curves: dict[str, SpeedCurve]
) -> dict[str, Any]:
    facts: dict[str, Any] = {}
    for law in laws:
        facts[f"{law.law}_frequency_spread_percent"] = 100.0 * curves[law.law].spread
        if isinstance(law, CoulombLaw):
            facts["coulomb_speed_of_strong_dependence_m_s"] = _coulomb_speed(belt.changed(law=law))
        if isinstance(law, LinearFallingLaw):
            oscillator = belt.changed(law=law)
            facts["linear_one_way_up_to_m_s"] = largest_one_way_speed(oscillator)
            facts["linear_spread_up_to_there_percent"] = 100.0 * _one_way_spread(oscillator, curves[law.law])
    return facts


def _one_way_spread(belt: BeltOscillator, curve: SpeedCurve) -> float:
    """Spread of the frequency where the linear law's cycle slides one way only; nan below two speeds."""
    within = curve.exists & (curve.speeds_m_s <= largest_one_way_speed(belt))
    f = curve.frequency_hz[within]
    return float((f.max() - f.min()) / f.mean()) if f.size > 1 else math.nan


def _belt_statements(
    belt: BeltOscillator, plane: PhasePlane, laws: Sequence[BeltLaw], curves: dict[str, SpeedCurve]
) -> list[Statement]:
    """Statements of section 1.1 that these parameters speak to."""
    rows: list[Statement] = []
    if isinstance(belt.law, LinearFallingLaw):
        rows += _plane_statements(belt, plane)
    for law in laws:
        curve = curves[law.law]
        f = curve.frequency_hz[curve.exists]
        if f.size < 2:
            continue
        span = f"{f.min():.1f} … {f.max():.1f} Hz"
        if isinstance(law, CoulombLaw):
            ours = span + _coulomb_words(belt.changed(law=law, belt_speed_m_s=SQUEAL_SPEED_M_S))
            rows.append(
                ("limit-cycle frequency over belt speed, Coulomb", "depends on it", ours, curve.spread > 1e-3)
            )
        elif isinstance(law, LinearFallingLaw):
            oscillator = belt.changed(law=law)
            limit, spread = largest_one_way_speed(oscillator), _one_way_spread(oscillator, curve)
            if math.isfinite(spread):
                words = "constant to rounding" if spread < 1e-12 else f"constant within {100 * spread:.0e} %"
                ours = f"{words} up to {limit:.3g} m/s; over all speeds {span}"
                rows.append(
                    (
                        "limit-cycle frequency over belt speed, linear falling",
                        "independent",
                        ours,
                        spread < 1e-6,
                    )
                )
    return rows


def _coulomb_words(at_squeal: BeltOscillator) -> str:
    """How much of the dependence is left at the speed at which brakes squeal."""
    cycle = stick_slip_cycle(at_squeal)
    if cycle is None:
        return f"; none at {SQUEAL_SPEED_M_S:g} m/s (40 1/min)"
    below = 100.0 * (1.0 - cycle.frequency_hz / at_squeal.frequency_hz)
    return (
        f"; at {SQUEAL_SPEED_M_S:g} m/s (40 1/min) {cycle.frequency_hz:.1f} Hz, {below:.2g} % below the "
        f"natural frequency: strong only below {_coulomb_speed(at_squeal):.2g} m/s"
    )


def _coulomb_speed(belt: BeltOscillator) -> float:
    """(mu_s - mu_d) F_n / sqrt(c m): belt speed (m/s) below which sticking takes much of a period."""
    drop = belt.law.mu_static - belt.law.sliding(0.0)
    return drop * belt.normal_force_n / math.sqrt(belt.stiffness_n_m * belt.mass_kg)


def _plane_statements(belt: BeltOscillator, plane: PhasePlane) -> list[Statement]:
    behaviours = [region.behaviour for region in plane.regions]
    found = ", ".join(f"{c.kind} {c.frequency_hz:.1f} Hz" for c in plane.cycles if c.stable) or "none"
    outside = ", ".join(behaviours[1:]) or "nothing"
    outer = [c for c in plane.cycles if not c.stable]
    if outer:
        mu = "mu is still positive" if outer[-1].law_valid else "eq 28 gives a negative mu"
        outside += f" (from {outer[-1].turn_m * UM:.3g} µm, where {mu})"
    return [
        (
            "falling law, near the equilibrium",
            "trajectories diverge",
            f"{behaviours[0]}, D = {belt.damping_ratio:.4g}",
            behaviours[0] == "diverging",
        ),
        (
            "falling law, limit cycle",
            "stick-slip",
            found,
            any(c.kind == "stick-slip" and c.stable for c in plane.cycles),
        ),
        (
            "falling law, outside the limit cycle",
            "diverging or contracting, by the parameters",
            outside,
            "contracting" in behaviours[1:],
        ),
    ]


def _cycles_table(plane: PhasePlane) -> Table:
    cycles: tuple[LimitCycle, ...] = plane.cycles
    return Table(
        "cycles",
        "Limit cycles",
        (
            Column("kind", "", [c.kind for c in cycles]),
            Column("stable", "", [c.stable for c in cycles]),
            Column("frequency", "Hz", [c.frequency_hz for c in cycles]),
            Column("amplitude", "µm", [c.amplitude_m * UM for c in cycles]),
            Column("turning point", "µm", [c.turn_m * UM for c in cycles]),
            Column("stick share", "", [c.stick_share for c in cycles]),
            Column("largest slip speed", "m/s", [c.slip_speed_max_m_s for c in cycles]),
            Column("mu stays positive", "", [c.law_valid for c in cycles]),
            Column("multiplier", "", [c.multiplier for c in cycles]),
        ),
    )


def _regions_table(plane: PhasePlane) -> Table:
    return Table(
        "regions",
        "Regions of the phase plane by amplitude",
        (
            Column("from", "µm", [r.from_m * UM for r in plane.regions]),
            Column("to", "µm", [r.to_m * UM for r in plane.regions]),
            Column("behaviour", "", [r.behaviour for r in plane.regions]),
        ),
    )


def _frequency_table(curves: dict[str, SpeedCurve]) -> Table:
    names = [law for law, curve in curves.items() for _ in curve.kinds]

    def column(field: str, factor: float = 1.0) -> list[float]:
        return [float(v) * factor for curve in curves.values() for v in getattr(curve, field)]

    return Table(
        "frequency",
        "Limit cycle over belt speed",
        (
            Column("law", "", names),
            Column("belt speed", "m/s", column("speeds_m_s")),
            Column("frequency", "Hz", column("frequency_hz")),
            Column("amplitude", "µm", column("amplitude_m", UM)),
            Column("stick share", "", column("stick_share")),
            Column("kind", "", [kind or None for curve in curves.values() for kind in curve.kinds]),
            Column("mu stays positive", "", [v for curve in curves.values() for v in curve.law_valid]),
        ),
    )


def _trajectories_table(paths: dict[str, Trajectory]) -> Table:
    sampled = {name: path.sampled(300) for name, path in paths.items()}

    def column(index: int) -> Array:
        return np.concatenate([s[index] for s in sampled.values()])

    return Table(
        "trajectories",
        "Trajectories of the phase plane",
        (
            Column("trajectory", "", [name for name, s in sampled.items() for _ in s[0]]),
            Column("time", "s", column(0).tolist()),
            Column("position", "µm", (column(1) * UM).tolist()),
            Column("velocity", "m/s", column(2).tolist()),
        ),
    )
