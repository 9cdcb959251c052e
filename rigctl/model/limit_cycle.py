"""Squeal beyond its onset as a study: bifurcation diagram, hysteresis, level of the sound.

Job: run `sim_hardware.brake_model.time_domain.limit_cycle` and `.squeal_ramp` with the friction law and the
radiation of the simulated rig (plant file), and say what comes out. NOT its job: integration, drawing
(`limit_cycle_figures`), sound that the rig adds (motor, ventilator, background).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rigctl.config.loading import load_model
from rigctl.core.units import RAD_S_PER_RPM, REFERENCE_PRESSURE_PA
from rigctl.model.limit_cycle_figures import bifurcation_figure, ramp_figure
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.time_domain.limit_cycle import Branches, branches
from sim_hardware.brake_model.time_domain.squeal_points import squeal_points
from sim_hardware.brake_model.time_domain.squeal_ramp import Ramp, ramps

#: speed of the paper's measurements (section 4.1), and v_s where no plant file says it
SPEED_RPM, SATURATION_M_S = 40.0, 0.10
#: values of one study: each is simulated for seconds, and its last stretch is kept
MOST_VALUES = 2000
_SUFFIX = {"pressure": "_bar", "slope": "_s_m", "slip": "_m_s"}
_VERDICTS = {
    "none": "no onset within the range",
    "supercritical": "supercritical: the amplitude grows from zero, no hysteresis of steady motions",
    "sudden": "sudden: at the onset the amplitude jumps to the reversal of slip, no hysteresis",
    "subcritical": "subcritical: large motions squeal where small ones die away",
}


@dataclass(frozen=True, slots=True)
class Radiation:
    """How motion becomes sound at the microphone, and what else a plant file says about squeal.

    Attributes
    ----------
    source : name of the plant, "" for none
    weights_pa_s2_m : Pa per m/s2 by degree of freedom (monopoles); empty: no sound
    saturation_m_s : v_s of the friction law
    roughness_n_per_sqrt_n : rms of the surfaces' excitation
    """

    source: str = ""
    weights_pa_s2_m: Mapping[str, float] = field(default_factory=dict)
    saturation_m_s: float = SATURATION_M_S
    roughness_n_per_sqrt_n: float = 0.003


def read_radiation(plant: Path) -> Radiation:
    """Read the radiation of a plant file, as the simulated rig has it.

    p = efficiency rho / (4 pi r) sum of area dv/dt

    Raises
    ------
    ConfigError
        names file, key, value and remedy
    """
    from sim_hardware.plant.settings import PlantSettings

    settings = load_model(plant, PlantSettings)
    r = settings.radiation
    monopole = r.efficiency * r.air_density_kg_m3 / (4.0 * math.pi * r.microphone_distance_m)
    weights = {name: monopole * area_m2 for name, area_m2 in r.areas_m2.items()}
    return Radiation(settings.name, weights, r.saturation_m_s, r.roughness_n_per_sqrt_n)


def level_db(rms_pa: ArrayLike) -> NDArray[np.float64]:
    """Sound pressure level, dB(Z) re 20 uPa; not a number for silence."""
    rms = np.asarray(rms_pa, dtype=float)
    with np.errstate(all="ignore"):
        return np.where(rms > 0.0, 20.0 * np.log10(rms / REFERENCE_PRESSURE_PA), np.nan)


def squeal_study(
    brake: Brake,
    quantity: str,
    values: Sequence[float] | NDArray[np.float64],
    *,
    radiation: Radiation | None = None,
    linear_law: bool = False,
    saturation_m_s: float | None = None,
    speed_rpm: float = SPEED_RPM,
    pressure_bar: float = 20.0,
    mu: float | None = None,
    slope_s_m: float | None = None,
    ramp: bool = False,
    durations_s: Sequence[float] = (1.0, 2.0, 4.0, 8.0),
    longest_s: float = 6.0,
) -> Study:
    """Limit cycles over a quantity, from small and large starts, and (`ramp`) slow ramps up and down.

    Parameters
    ----------
    quantity, values : "pressure" (bar), "mu", "slope" (s/m), "slip" (sliding speed, m/s) or a parameter
        of the brake file
    radiation : sound and friction law of a plant; None: no sound, v_s = 0.1 m/s
    linear_law : friction falls linearly (eq 28): only reversal of slip and lift-off bound the motion
    saturation_m_s : other v_s
    speed_rpm, pressure_bar, mu, slope_s_m : what is not varied; the brake file's mu and slope where None
    durations_s : of ramps, one direction
    longest_s : simulated time at most for a motion to become steady

    Returns
    -------
    facts: onset by eigenvalues and as seen in time, end of squeal of large motions, hysteresis, verdict,
    levels; tables "branches" (values of all points), with `ramp` "ramps" and "ramp_course"; figures
    "bifurcation", with `ramp` "ramps"

    Raises
    ------
    KeyError, ValueError
        unknown quantity, values that cannot be
    """
    if len(values) > MOST_VALUES:
        raise ValueError(
            f"{len(values)} values are too many to simulate side by side; give {MOST_VALUES} at most"
        )
    radiation = radiation or Radiation()
    bound = None if linear_law else radiation.saturation_m_s if saturation_m_s is None else saturation_m_s
    _check_surfaces(brake, radiation)
    slip_m_s = speed_rpm * RAD_S_PER_RPM * brake.effective_radius_m
    fixed: dict[str, Any] = {
        "slip_m_s": slip_m_s, "saturation_m_s": bound, "pressure_bar": pressure_bar, "mu": mu,
        "slope_s_m": slope_s_m,
    }  # fmt: skip
    points = squeal_points(brake, quantity, values, **fixed)
    found = branches(points, dict(radiation.weights_pa_s2_m), longest_s=longest_s)
    runs: list[Ramp] = []
    if ramp:
        first, last = float(points.values.min()), float(points.values.max())
        runs = ramps(
            brake, quantity, first, last, durations_s=durations_s, radiation=dict(radiation.weights_pa_s2_m),
            roughness_n_per_sqrt_n=radiation.roughness_n_per_sqrt_n, **fixed,
        )  # fmt: skip
    sound = bool(radiation.weights_pa_s2_m)
    law = "linear law (eq. 28)" if bound is None else f"saturating law, v_s = {bound:g} m/s"
    heading = f"{brake.name}: {_headline(found)}; {law}"
    figures: dict[str, Any] = {
        "bifurcation": partial(bifurcation_figure, found, runs, heading, level_db if sound else None)
    }
    tables = [_branch_table(found, sound)]
    if runs:
        tables += [_ramp_table(runs, points.unit), _course_table(runs, quantity, points.unit, sound)]
        figures["ramps"] = partial(ramp_figure, found, runs, heading)
    facts = {
        "brake": brake.name,
        "quantity": quantity if points.unit in ("", "1") else f"{quantity}, {points.unit}",
        "friction_law": law, "sliding_speed_m_s": slip_m_s if quantity != "slip" else None,
        "plant": radiation.source or None, **_facts(found, sound), **_ramp_facts(runs, quantity),
    }  # fmt: skip
    return Study("squeal", heading, facts, tuple(tables), figures)


def _headline(found: Branches) -> str:
    """What is seen, in a line."""
    points = found.points
    unit = "" if points.unit == "1" else f" {points.unit}"
    if found.onset_eigenvalues is None:
        share = int(found.large.squeals.sum())
        return f"squeal at {share} of {len(points)} values of {points.quantity}, no onset between"
    at = f"{points.quantity} = {found.onset_eigenvalues:.4g}{unit}"
    kinds = {
        "none": f"unstable at {at}, no lasting squeal found",
        "supercritical": f"squeal grows from zero at {at}",
        "sudden": f"squeal jumps to the reversal of slip at {at}",
        "subcritical": f"squeal sets in at {at}, lasts to {_text(found.fold)}{unit}"
        + (" at least" if found.beyond else ""),
    }
    return kinds[found.verdict]


def _text(value: float | None) -> str:
    return "–" if value is None else f"{value:.4g}"


def _check_surfaces(brake: Brake, radiation: Radiation) -> None:
    for name in radiation.weights_pa_s2_m:
        if name not in brake.freedoms:
            raise KeyError(
                f"the plant '{radiation.source}' radiates from {name}, which the brake '{brake.name}' does "
                "not have; name another plant file, or study without sound"
            )


def _facts(found: Branches, sound: bool) -> dict[str, Any]:
    points, small, large = found.points, found.small, found.large
    suffix = _SUFFIX.get(points.quantity, "")
    facts: dict[str, Any] = {
        "verdict": _VERDICTS[found.verdict],
        f"onset_by_eigenvalues{suffix}": found.onset_eigenvalues,
        f"onset_seen_in_time{suffix}": found.onset_time,
        f"squeal_of_large_motions_ends_at{suffix}": found.fold,
        f"hysteresis_of_steady_motions{suffix}": found.hysteresis,
        f"hysteresis_known_to{suffix}": None if found.beyond else found.resolution,
        "squeal_lasts_beyond_the_range": found.beyond,
    }
    unstable = found.mode.growth_1_s > 0.0
    if found.onset_eigenvalues is not None:
        nearest = int(np.argmin(np.abs(points.values - found.onset_eigenvalues)))
        facts["frequency_at_onset_hz"] = float(found.mode.frequency_hz[nearest])
    if large.squeals.any():
        frequencies = large.frequency_hz[large.squeals]
        facts["frequency_of_limit_cycles_hz"] = f"{frequencies.min():.1f} to {frequencies.max():.1f}"
        loudest = int(np.argmax(np.where(large.squeals, large.slip_amplitude_m_s, -1.0)))
        facts["largest_slip_amplitude_m_s"] = float(large.slip_amplitude_m_s[loudest])
        facts["largest_sticking_share"] = float(large.stuck_share.max())
        facts["largest_lift_off_share"] = float(large.lifted_share.max())
        if sound:
            levels = level_db(large.radiated)[large.squeals]
            facts["sound_level_db"] = f"{levels.min():.1f} to {levels.max():.1f}"
    facts["small_starts_that_squeal"] = f"{int(small.squeals.sum())} of {len(points)}"
    facts["large_starts_that_squeal"] = f"{int(large.squeals.sum())} of {len(points)}"
    facts["motions_not_steady_at_the_end"] = int((~small.settled).sum() + (~large.settled).sum())
    both = unstable & np.isfinite(found.growth_1_s)
    if both.any():
        apart = np.abs(found.growth_1_s - found.mode.growth_1_s)[both]
        facts["growth_rates_time_and_eigenvalues_apart_1_s"] = float(apart.max())
    return facts


def _ramp_facts(runs: Sequence[Ramp], quantity: str) -> dict[str, Any]:
    if not runs:
        return {}
    suffix = _SUFFIX.get(quantity, "")
    slowest = [run for run in runs if run.duration_s == max(r.duration_s for r in runs)]
    widths = {
        f"{duration:g} s": _mean([r.width for r in runs if r.duration_s == duration])
        for duration in dict.fromkeys(r.duration_s for r in runs)
    }
    return {
        "slowest_ramp_s": slowest[0].duration_s,
        f"ramp_onset_up{suffix}": _mean([r.onset for r in slowest]),
        f"ramp_end_down{suffix}": _mean([r.end for r in slowest]),
        f"ramp_width{suffix}": _mean([r.width for r in slowest]),
        f"ramp_widths_by_duration{suffix}": widths,
    }


def _mean(values: Sequence[float | None]) -> float | None:
    known = [v for v in values if v is not None]
    return float(np.mean(known)) if known else None


def _column(name: str, unit: str, values: Sequence[Any] | NDArray[Any]) -> Column:
    return Column(name, unit, np.asarray(values, dtype=object).tolist())


def _branch_table(found: Branches, sound: bool) -> Table:
    p, mode = found.points, found.mode
    columns = [
        _column(p.quantity, "" if p.unit == "1" else p.unit, p.values),
        _column("growth_eigenvalues", "1/s", mode.growth_1_s),
        _column("growth_in_time", "1/s", found.growth_1_s),
        _column("frequency_eigenvalues", "Hz", mode.frequency_hz),
    ]
    for name, cycles in (("small", found.small), ("large", found.large)):
        columns += [
            _column(f"{name}_squeals", "", cycles.squeals),
            _column(f"{name}_steady", "", cycles.settled),
            _column(f"{name}_slip_amplitude", "m/s", cycles.slip_amplitude_m_s),
            _column(f"{name}_frequency", "Hz", cycles.frequency_hz),
            _column(f"{name}_disc_acceleration", "m/s2", cycles.surface_acceleration_m_s2),
            _column(f"{name}_disc_velocity", "m/s", cycles.surface_velocity_m_s),
            _column(f"{name}_sticking", "", cycles.stuck_share),
            _column(f"{name}_lifted", "", cycles.lifted_share),
        ]
        if sound:
            columns.append(
                _column(f"{name}_level", "dB", np.where(cycles.squeals, level_db(cycles.radiated), np.nan))
            )
    columns.append(_column("growth_time", "s", found.small.growth_time_s))
    return Table("branches", f"Steady motions over {p.quantity}, from small and large starts", tuple(columns))


def _ramp_table(runs: Sequence[Ramp], unit: str) -> Table:
    unit = "" if unit == "1" else unit
    return Table(
        "ramps",
        "Ramps up and down",
        (
            _column("duration", "s", [r.duration_s for r in runs]),
            _column("seed", "", [r.seed for r in runs]),
            _column("onset", unit, [r.onset for r in runs]),
            _column("end", unit, [r.end for r in runs]),
            _column("width", unit, [r.width for r in runs]),
        ),
    )


def _course_table(runs: Sequence[Ramp], quantity: str, unit: str, sound: bool) -> Table:
    parts = [
        (run, way, *values)
        for run in runs
        for way, values in (
            ("up", (run.up, run.slip_up_m_s, run.radiated_up)),
            ("down", (run.down, run.slip_down_m_s, run.radiated_down)),
        )
    ]
    columns = [
        _column(
            "duration", "s", np.concatenate([np.full(len(v), run.duration_s) for run, _, v, *_ in parts])
        ),
        _column("seed", "", np.concatenate([np.full(len(v), run.seed) for run, _, v, *_ in parts])),
        _column("direction", "", [way for _, way, v, *_ in parts for _ in v]),
        _column(quantity, "" if unit == "1" else unit, np.concatenate([v for _, _, v, *_ in parts])),
        _column("slip_amplitude", "m/s", np.concatenate([slip for *_, slip, _ in parts])),
    ]
    if sound:
        columns.append(_column("level", "dB", level_db(np.concatenate([pa for *_, pa in parts]))))
    return Table("ramp_course", "Course of the ramps", tuple(columns))
