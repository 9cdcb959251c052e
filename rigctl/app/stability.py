"""`rigctl stability`: eigenvalues and onset of squeal of a brake file, for people.

Job: print what `sim_hardware.brake_model` finds. Not its job: computing it.
"""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path

from rich.console import Console

from rigctl.app import exit_codes
from rigctl.model.loading import read_brake_file
from sim_hardware.brake_model import predict
from sim_hardware.brake_model.stability import EigenPair


def show_stability(path: Path, k: float | None, mu: float | None, max_bar: float, console: Console) -> int:
    """Print pairs of eigenvalues without pressure and at the highest pressure, and the onset."""
    found = predict(read_brake_file(path), mu, k, max_bar)
    console.print(
        f"{found.brake}: mu = {found.mu:g}, k = {found.slope_s_m:g} s/m, p = 0 … {max_bar:g} bar",
        highlight=False,
    )
    console.print(f"{'pair':>4}  {'at 0 bar':>32}  {f'at {max_bar:g} bar':>32}", highlight=False)
    unit = f"{'Hz':>10} {'damping %':>10} {'Re 1/s':>10}"
    console.print(f"{'':4}  {unit}  {unit}", highlight=False)
    for number, (low, high) in enumerate(zip_longest(found.pairs, found.pairs_at_max), start=1):
        mark = "  unstable" if high is not None and high.unstable else ""
        console.print(f"{number:4d}  {_columns(low)}  {_columns(high)}{mark}", highlight=False)
    if found.onset_pressure_bar is None or found.onset_frequency_hz is None:
        console.print(f"Stable up to {max_bar:g} bar.", highlight=False)
    else:
        console.print(
            f"Onset of squeal: {found.onset_pressure_bar:.2f} bar, {found.onset_frequency_hz:.1f} Hz",
            highlight=False,
        )
    return exit_codes.OK


def _columns(pair: EigenPair | None) -> str:
    if pair is None:
        return " " * 32
    return f"{pair.frequency_hz:10.2f} {100 * pair.damping_ratio:10.3f} {pair.real_part_1_s:10.2f}"
