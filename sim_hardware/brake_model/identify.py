"""Identification: find parameters with which a brake becomes unstable where it should.

    python -m sim_hardware.brake_model.identify configs/brakes/model.toml \\
        --target onset_bar=15 frequency_hz=2140 --free c_fin_t,c_con_it,d_con --out new.toml

Chosen parameters are varied on a logarithmic scale within a band around their start values, so that the brake
meets the targets with the smallest change (least squares, with a weak pull towards the start). Targets:
`onset_bar` (at the file's mu and slope) or `onset_mu` (constant friction), and `frequency_hz` of the pair
that becomes unstable. The new file keeps the old one's text; identified values and their origins are
replaced. NOT its job: deciding which parameters are uncertain; the targets alone do not single out one brake.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sim_hardware.brake_model.assembly import Array, Brake, load_brake
from sim_hardware.brake_model.stability import Onset, eigen_pairs, onset_mu, onset_pressure

TARGETS = ("onset_bar", "onset_mu", "frequency_hz")

#: weight of the pull towards the start values: this share of a residual of relative size 1
_PULL = 1e-4
#: range searched for the onset, as a multiple of the target
_SEARCH = 4.0


@dataclass(frozen=True)
class Identification:
    """Result: the new brake, changes as factors, and the onset before and after (None: stable)."""

    brake: Brake
    factors: dict[str, float]
    before: Onset | None
    after: Onset | None


def identify(
    brake: Brake, targets: Mapping[str, float], free: Sequence[str], *, band: float = 0.3
) -> Identification:
    """Return the brake whose free parameters meet the targets with the smallest change.

    Parameters
    ----------
    brake : start
    targets : one of `onset_bar`, `onset_mu`, and optionally `frequency_hz`
    free : names of parameters to vary
    band : largest relative change, for example 0.3 for 1/1.3 to 1.3 times the start value

    Raises
    ------
    ValueError
        unknown or contradictory targets, no free parameter, band not positive
    KeyError
        unknown parameter
    """
    from scipy.optimize import least_squares

    _check(brake, targets, free, band)
    start = np.array([brake.spec.parameters[name].value for name in free])

    def changed(logarithms: Array) -> Brake:
        return brake.with_parameters(**dict(zip(free, (start * np.exp(logarithms)).tolist(), strict=True)))

    def residuals(logarithms: Array) -> Array:
        return np.concatenate([_misses(changed(logarithms), targets), _PULL * logarithms])

    limit = float(np.log1p(band))
    solution = least_squares(
        residuals,
        np.zeros(len(free)),
        bounds=(-limit, limit),
        diff_step=1e-6,
        x_scale=0.1,
        xtol=1e-12,
        ftol=1e-14,
    )
    found = changed(solution.x)
    return Identification(
        found,
        dict(zip(free, np.exp(solution.x).tolist(), strict=True)),
        _onset(brake, targets),
        _onset(found, targets),
    )


def _check(brake: Brake, targets: Mapping[str, float], free: Sequence[str], band: float) -> None:
    unknown = sorted(set(targets) - set(TARGETS))
    if unknown:
        raise ValueError(f"unknown target {unknown[0]!r}; use {', '.join(TARGETS)}")
    if ("onset_bar" in targets) == ("onset_mu" in targets):
        raise ValueError(f"targets {sorted(targets)}: give exactly one of onset_bar and onset_mu")
    if any(not (np.isfinite(value) and value > 0.0) for value in targets.values()):
        raise ValueError(f"targets {dict(targets)}: give positive values")
    if "onset_bar" in targets and brake.slope_s_m <= 0.0:
        raise ValueError(
            f"brake '{brake.name}' has the slope 0: pressure has no effect; use onset_mu or set a slope"
        )
    if not free:
        raise ValueError("no free parameter; name at least one")
    missing = sorted(set(free) - set(brake.spec.parameters))
    if missing:
        raise KeyError(
            f"unknown parameter {missing[0]!r}; the brake has: {', '.join(sorted(brake.spec.parameters))}"
        )
    if not band > 0.0:
        raise ValueError(f"band is {band!r}; give a positive share, for example 0.3")


def _onset(brake: Brake, targets: Mapping[str, float]) -> Onset | None:
    if "onset_bar" in targets:
        return onset_pressure(brake, pressure_max_bar=_SEARCH * targets["onset_bar"])
    return onset_mu(brake, 0.0, mu_max=_SEARCH * targets["onset_mu"])


def _misses(brake: Brake, targets: Mapping[str, float]) -> Array:
    """Relative misses; smooth also where the brake is stable throughout: the growth rate at the wanted onset
    is used.

    At the wanted onset the pair nearest to the wanted frequency must have real part 0 and that frequency, and
    no other pair may be unstable.
    """
    if "onset_bar" in targets:
        pairs = eigen_pairs(brake, pressure_bar=targets["onset_bar"])
    else:
        pairs = eigen_pairs(brake, targets["onset_mu"], 0.0)
    if "frequency_hz" in targets:
        frequency = targets["frequency_hz"]
        # growth counts against the distance, so that the pair in question does not change places with a
        # neighbour
        critical = min(
            pairs, key=lambda pair: abs(pair.frequency_hz - frequency) / frequency + abs(pair.damping_ratio)
        )
        misses = [critical.damping_ratio * 100.0, (critical.frequency_hz - frequency) / frequency * 10.0]
    else:
        critical = min(pairs, key=lambda pair: pair.damping_ratio)
        misses = [critical.damping_ratio * 100.0, 0.0]
    others = [max(0.0, -pair.damping_ratio) * 100.0 for pair in pairs if pair is not critical]
    return np.array([*misses, sum(others)])


def updated_text(text: str, brake: Brake, factors: Mapping[str, float], origin: str) -> str:
    """Return a brake file's text with new values and origins of the parameters in `factors`.

    Raises
    ------
    ValueError
        a parameter does not stand on a line of its own as `name = { ... }`
    """
    for name in factors:
        parameter = brake.spec.parameters[name]
        text = replaced_parameter(text, name, parameter.unit, parameter.value, origin)
    return text


def replaced_parameter(text: str, name: str, unit: str, value: float, origin: str) -> str:
    """Return a brake file's text with another value and origin of one parameter or operating value.

    Comments, order and everything else stay as they are.

    Raises
    ------
    ValueError
        the parameter does not stand on a line of its own as `name = { ... }`
    """
    line = re.compile(rf"(?m)^({re.escape(name)}[ \t]*=[ \t]*)\{{[^{{}}\n]*\}}([ \t]*(?:#.*)?)$")
    source = json.dumps(origin, ensure_ascii=False)
    entry = f"{{ value = {value!r}, unit = {json.dumps(unit)}, origin = {source} }}"
    changed, count = line.subn(lambda found: f"{found[1]}{entry}{found[2]}", text)
    if count != 1:
        raise ValueError(
            f"parameter {name!r} stands {count} times as '{name} = {{ ... }}'; write it once on one line"
        )
    return changed


def _shown(onset: Onset | None, targets: Mapping[str, float]) -> str:
    unit = " bar" if "onset_bar" in targets else ""
    if onset is None:
        return "stable"
    name = "pressure" if "onset_bar" in targets else "mu"
    return f"unstable from {name} = {onset.value:.4g}{unit} at {onset.frequency_hz:.1f} Hz"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code (0 done, 1 targets not met, 2 refused)."""
    parser = argparse.ArgumentParser(
        prog="python -m sim_hardware.brake_model.identify", description=(__doc__ or "").split("\n")[0]
    )
    parser.add_argument("brake", type=Path, help="brake file to start from")
    parser.add_argument("--target", nargs="+", required=True, metavar="NAME=VALUE", help=", ".join(TARGETS))
    parser.add_argument("--free", required=True, metavar="NAME,NAME,...", help="parameters to vary")
    parser.add_argument("--band", type=float, default=0.3, help="largest relative change (default 0.3)")
    parser.add_argument("--out", type=Path, help="brake file to write")
    options = parser.parse_args(arguments)
    try:
        targets = {name: float(value) for name, _, value in (item.partition("=") for item in options.target)}
        start = load_brake(options.brake)
        result = identify(start, targets, options.free.split(","), band=options.band)
        print(f"before: {_shown(result.before, targets)}")
        for name, factor in result.factors.items():
            unit = start.spec.parameters[name].unit
            old, new = start.spec.parameters[name].value, result.brake.spec.parameters[name].value
            print(f"  {name:12s} {old:12.6g} -> {new:12.6g} {unit:10s} ({(factor - 1.0) * 100.0:+.2f} %)")
        print(f"after:  {_shown(result.after, targets)}")
        if options.out is not None:
            met = ", ".join(f"{name} = {value:g}" for name, value in targets.items())
            text = options.brake.read_text(encoding="utf-8")
            options.out.write_text(
                updated_text(text, result.brake, result.factors, f"identified by us against {met}"),
                encoding="utf-8",
            )
            print(f"written: {options.out}")
    except (OSError, ValueError, KeyError) as error:  # includes refused and unreadable brake files
        print(f"identify: {error.args[0] if isinstance(error, KeyError) else error}", file=sys.stderr)
        return 2
    return 0 if _meets(result.after, targets) else 1


def _meets(onset: Onset | None, targets: Mapping[str, float], tolerance: float = 0.01) -> bool:
    if onset is None:
        return False
    wanted = targets.get("onset_bar", targets.get("onset_mu", 0.0))
    frequency = targets.get("frequency_hz", onset.frequency_hz)
    return (
        abs(onset.value / wanted - 1.0) < tolerance and abs(onset.frequency_hz / frequency - 1.0) < tolerance
    )


if __name__ == "__main__":
    sys.exit(main())
