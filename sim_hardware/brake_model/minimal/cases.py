"""Systems of the literature as data: TOML files with matrices or belt parameters, and the numbers they must
give.

Job: read such files (the shipped ones lie in `cases/`), compute what they expect, set both side by side. Each
expectation says how it was derived. A 2-DOF case is a `LinearModel`, so that every linear study takes it.
NOT its job: the models themselves.
"""

from __future__ import annotations

import difflib
import math
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from sim_hardware.brake_model.linear import MU, Matrices, NamedQuantity, ParameterGroup, unknown_quantity
from sim_hardware.brake_model.minimal.belt import BeltOscillator
from sim_hardware.brake_model.minimal.cycles import stable_cycle
from sim_hardware.brake_model.minimal.hurwitz import (
    Crossing,
    TwoFreedoms,
    first_instability,
    hurwitz_boundaries,
)

FOLDER = Path(__file__).with_name("cases")

Pair = tuple[float, float]
Square = tuple[Pair, Pair]
_NOTHING: Square = ((0.0, 0.0), (0.0, 0.0))
_FROZEN = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Expectation(BaseModel):
    """A number that the case must give."""

    model_config = _FROZEN

    quantity: str
    value: float
    relative_tolerance: Annotated[float, Field(gt=0.0, le=0.1)] = 1e-9
    derivation: str


class _Case(BaseModel):
    model_config = _FROZEN

    name: str
    title: str
    source: str
    expect: tuple[Expectation, ...] = Field(min_length=1)


class TwoDofCase(_Case):
    """M x'' + (D + mu D') x' + (K + mu K') x = 0 with two freedoms; `parameter` says what mu stands for."""

    kind: Literal["two-dof"]
    parameter: str = "coefficient of friction"
    freedoms: tuple[str, str] = ("x1", "x2")
    mass: Square
    damping: Square = _NOTHING
    damping_mu: Square = _NOTHING
    stiffness: Square
    stiffness_mu: Square = _NOTHING

    @property
    def system(self) -> TwoFreedoms:
        """The matrices."""
        parts = (self.mass, self.damping, self.damping_mu, self.stiffness, self.stiffness_mu)
        return TwoFreedoms(*(np.array(part) for part in parts))

    @property
    def quantities(self) -> Mapping[str, NamedQuantity]:
        """mu only."""
        return {MU: NamedQuantity(MU, 0.0, "", "operating")}

    @property
    def groups(self) -> tuple[ParameterGroup, ...]:
        """None."""
        return ()

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        """M, D, K at a mu (0 where not given).

        Raises
        ------
        KeyError
            another quantity than mu
        ValueError
            mu is not finite
        """
        mu = self._mu(values)
        s = self.system
        return Matrices(s.mass, s.damping + mu * s.damping_mu, s.stiffness + mu * s.stiffness_mu)

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        """Derivatives of M, D, K by mu.

        Raises
        ------
        KeyError, ValueError
            as `matrices`
        """
        self._mu(values)
        self._mu({name: 0.0})
        s = self.system
        return Matrices(np.zeros((2, 2)), s.damping_mu, s.stiffness_mu)

    def _mu(self, values: Mapping[str, float] | None) -> float:
        for name, value in (values or {}).items():
            if name != MU:
                raise unknown_quantity(self.name, name, self.quantities)
            if not math.isfinite(value):
                raise ValueError(f"mu = {value}: not finite. Give a coefficient of friction")
        return float((values or {}).get(MU, 0.0))


class BeltCase(_Case):
    """A belt oscillator."""

    kind: Literal["belt"]
    belt: BeltOscillator


Case = Annotated[TwoDofCase | BeltCase, Field(discriminator="kind")]
_ADAPTER: TypeAdapter[TwoDofCase | BeltCase] = TypeAdapter(Case)


@dataclass(frozen=True, slots=True)
class Check:
    """An expectation beside what our model gives."""

    case: str
    expectation: Expectation
    computed: float

    @property
    def relative_error(self) -> float:
        """|computed - expected| / |expected| (absolute where 0 is expected)."""
        difference = abs(self.computed - self.expectation.value)
        return difference / abs(self.expectation.value) if self.expectation.value else difference

    @property
    def passed(self) -> bool:
        """Whether it lies within its tolerance."""
        return self.relative_error <= self.expectation.relative_tolerance


def load_case(path: Path) -> TwoDofCase | BeltCase:
    """Read a case.

    Raises
    ------
    OSError, tomllib.TOMLDecodeError, pydantic.ValidationError
        as they come
    """
    with path.open("rb") as file:
        return _ADAPTER.validate_python(tomllib.load(file))


def shipped_cases() -> tuple[TwoDofCase | BeltCase, ...]:
    """All cases of this package, by file name."""
    return tuple(load_case(path) for path in sorted(FOLDER.glob("*.toml")))


def check_case(case: TwoDofCase | BeltCase) -> tuple[Check, ...]:
    """Compute everything that a case expects.

    Raises
    ------
    ValueError
        an expectation that this kind of case cannot have, or what does not exist (no flutter, no cycle)
    """
    known = _two_dof_values(case) if isinstance(case, TwoDofCase) else _belt_values(case.belt)
    checks = []
    for expectation in case.expect:
        if expectation.quantity not in known:
            near = difflib.get_close_matches(expectation.quantity, known, n=3)
            raise ValueError(
                f"case {case.name}: quantity = {expectation.quantity!r} is not known for kind {case.kind}. "
                f"{'Did you mean' if near else 'Known'}: {', '.join(near or known)}"
            )
        checks.append(Check(case.name, expectation, known[expectation.quantity]()))
    return tuple(checks)


def _two_dof_values(case: TwoDofCase) -> dict[str, Callable[[], float]]:
    system = case.system

    def first() -> Crossing:
        found = first_instability(system)
        if found is None:
            raise ValueError(f"case {case.name}: stable at every mu, so it has no flutter or divergence")
        return found[1]

    def boundary(name: str, index: int) -> float:
        crossings = next(b for b in hurwitz_boundaries(system) if b.name == name).crossings
        positive = [c.mu for c in crossings if c.mu > 0.0]
        if len(positive) <= index:
            raise ValueError(f"case {case.name}: {name} has no such root at mu > 0")
        return positive[index]

    def frequency(index: int) -> float:
        upper = np.sort(np.abs(system.eigenvalues(0.0).imag))[2 * index]
        return float(upper) / (2.0 * math.pi)

    return {
        "critical_mu": lambda: first().mu,
        "critical_frequency_hz": lambda: first().frequency_hz,
        "divergence_mu": lambda: boundary("a0", 0),
        "flutter_mu": lambda: boundary("H3", 0),
        "undamped_flutter_mu": lambda: boundary("coupling", 0),
        "undamped_flutter_end_mu": lambda: boundary("coupling", 1),
        "first_frequency_hz": lambda: frequency(0),
        "second_frequency_hz": lambda: frequency(1),
    }


def _belt_values(belt: BeltOscillator) -> dict[str, Callable[[], float]]:
    def cycle(of: str) -> float:
        found = stable_cycle(belt)
        if found is None:
            raise ValueError(f"belt_speed_m_s = {belt.belt_speed_m_s:g}: there is no stable limit cycle")
        return float(getattr(found, of))

    return {
        "natural_frequency_hz": lambda: belt.frequency_hz,
        "damping_ratio": lambda: belt.damping_ratio,
        "effective_damping_ns_m": lambda: belt.effective_damping_ns_m,
        "equilibrium_m": lambda: belt.equilibrium_m,
        "cycle_period_s": lambda: cycle("period_s"),
        "cycle_frequency_hz": lambda: cycle("frequency_hz"),
        "cycle_amplitude_m": lambda: cycle("amplitude_m"),
        "cycle_stick_share": lambda: cycle("stick_share"),
    }
