"""A linear model made of matrices: M, D, K with parts that scale with friction, pressure, speed or your own
numbers.

Job: `MatrixModel`, a `LinearModel`, and `part_factors`, the naming scheme below. NOT its job: files
(`files`, which also says how to bring a finite-element model), checks of single matrices (`checks`),
eigenvalues.

Names of matrices. A letter, then what the part is multiplied by, joined by "_":

=============  =====================================================================================
M, D, K        inertia, damping, stiffness; M and K must be given. G is damping too (gyroscopic, say)
K_mu, D_mu     times the coefficient of friction mu
D_k_p          times the falling slope k (s/m) and the pressure p (bar): falling friction, eq 31; sign: as it
               stands in D, so negative definite
K_p            times the pressure p (bar)
G_v            times the sliding speed v (in the unit you choose)
K_v_v          twice named: squared (centrifugal stiffness)
D_mu_p_per_v   "per_": divided by (damping by friction across the sliding direction)
K_pad_l        times a number `pad_l` of the same file, if it has one: your own design parameters
=============  =====================================================================================

k, p, v may be written slope, pressure, speed. Every number that a part names is stored in the same file, as a
scalar (`mu`, `slope`, `pressure`, `speed`, `pad_l`): it is the value where a study does not say otherwise,
and a quantity that studies may vary. Each part also has a factor "part.K_mu", 1 in the file, so that
sensitivities know it. Matrices are dense or sparse, in any one consistent set of units with seconds (m-kg-N,
mm-t-N); optional: `name`, `freedoms` (one text per degree of freedom), `groups` (parameter groups).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy import sparse

from sim_hardware.brake_model.foreign.checks import DENSE_UP_TO, check_inertia, checked_matrix
from sim_hardware.brake_model.linear import (
    MU,
    PRESSURE,
    SLOPE,
    Array,
    Kind,
    Matrices,
    NamedQuantity,
    ParameterGroup,
    unknown_quantity,
)

SPEED = "speed"
_LETTERS: dict[str, tuple[str, Kind]] = {
    "M": ("mass", "inertia"),
    "D": ("damping", "damping"),
    "G": ("damping", "damping"),
    "K": ("stiffness", "stiffness"),
}
_ALIASES = {
    "mu": MU,
    "k": SLOPE,
    "slope": SLOPE,
    "p": PRESSURE,
    "pressure": PRESSURE,
    "v": SPEED,
    "speed": SPEED,
}
_UNITS = {MU: "1", SLOPE: "s/m", PRESSURE: "bar", SPEED: ""}
_NOT_NEGATIVE = {MU, SLOPE, PRESSURE}


@dataclass(frozen=True, slots=True)
class Part:
    """A matrix of the file: its name, where it belongs, and the powers of the quantities it is multiplied
    by.
    """

    name: str
    family: str
    kind: Kind
    powers: Mapping[str, int]

    @property
    def scale(self) -> str:
        """Name of its factor, 1 in the file."""
        return f"part.{self.name}"


def is_part(name: str) -> bool:
    """Whether a name is that of a matrix: a letter of M, D, G, K alone or followed by "_"."""
    return name[:1] in _LETTERS and name[1:2] in {"", "_"}


def part_factors(name: str, numbers: Mapping[str, float]) -> Part:
    """What a matrix's name says; see the module.

    Raises
    ------
    ValueError
        a factor is not known
    """
    family, kind = _LETTERS[name[0]]
    known = {**_ALIASES, **{number: number for number in numbers}}
    powers: Counter[str] = Counter()
    rest = name[2:]
    if name.endswith("_"):
        raise ValueError(f"the matrix name {name!r} ends with '_'; name a factor or leave it out")
    while rest:
        sign = -1 if rest.startswith("per_") else 1
        text = rest.removeprefix("per_") if sign < 0 else rest
        found = max((k for k in known if text == k or text.startswith(f"{k}_")), key=len, default=None)
        if found is None:
            raise ValueError(
                f"matrix {name}: the factor {text!r} is none of mu, k, p, v, and the file has no number "
                "of that name; "
                "correct the name, or add the number"
            )
        powers[known[found]] += sign
        rest = text[len(found) + 1 :]
    return Part(name, family, kind, MappingProxyType({q: n for q, n in powers.items() if n}))


class MatrixModel:
    """M, D, K of a model made elsewhere as functions of named quantities. Immutable; see
    `linear.LinearModel`.

    Parameters
    ----------
    name : of the model
    parts : matrices (n_dof, n_dof), dense or sparse, by the names of the module's scheme; copied
    numbers : values of the quantities that parts are multiplied by, by name (mu, slope, pressure, speed, your
        own)
    freedoms : (n_dof,) names of the degrees of freedom; q1, q2, … where not given
    groups : parameter groups; a group for each part where not given

    Raises
    ------
    ValueError
        M or K missing; a matrix empty, not square, of another size, complex or not finite; M singular or
        negative; a part's number missing, a number that no part uses; wrong number of freedoms; unknown
        member of a group
    """

    def __init__(
        self,
        name: str,
        parts: Mapping[str, Any],
        numbers: Mapping[str, float] | None = None,
        freedoms: Sequence[str] | None = None,
        groups: Sequence[ParameterGroup] | None = None,
    ) -> None:
        self._name = name
        given = {_ALIASES.get(key, key): float(value) for key, value in (numbers or {}).items()}
        for key in ("M", "K"):
            if not any(part[0] == key for part in parts):
                raise ValueError(
                    f"the matrix {key} is missing (there are: {', '.join(parts) or 'none'}); add it"
                )
        strange = [part for part in parts if not is_part(part)]
        if strange:
            raise ValueError(
                f"the name {strange[0]!r} is no matrix's; matrices are called M, D, K, K_mu, D_k_p, …"
            )
        self.parts = tuple(part_factors(part, given) for part in parts)
        n_dof = np.shape(parts[self.parts[0].name])[0] if np.ndim(parts[self.parts[0].name]) else 0
        arrays = {part.name: checked_matrix(part.name, parts[part.name], n_dof) for part in self.parts}
        self._check_numbers(given)
        self._freedoms = (
            tuple(map(str, freedoms)) if freedoms is not None else tuple(f"q{i + 1}" for i in range(n_dof))
        )
        if len(self._freedoms) != n_dof or len(set(self._freedoms)) != n_dof:
            raise ValueError(
                f"{len(self._freedoms)} names of freedoms ({len(set(self._freedoms))} different) where "
                "the matrices "
                f"have {n_dof} rows; give each its own name"
            )
        self._families = {
            family: _Family([arrays[p.name] for p in self.parts if p.family == family], n_dof)
            for family in ("mass", "damping", "stiffness")
        }
        self._numbers = given
        self._quantities = self._named()
        self._groups = tuple(groups) if groups is not None else self._own_groups()
        self._check_groups()
        self.matrices()

    @property
    def name(self) -> str:
        """Name of the model."""
        return self._name

    @property
    def freedoms(self) -> tuple[str, ...]:
        """Names of the degrees of freedom."""
        return self._freedoms

    @property
    def groups(self) -> tuple[ParameterGroup, ...]:
        """Parameter groups of the file, or one for each part."""
        return self._groups

    @property
    def quantities(self) -> Mapping[str, NamedQuantity]:
        """Numbers of the file, and a factor of each part."""
        return self._quantities

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        """M, D, K with other values for some quantities. See `LinearModel.matrices`."""
        now = self._valued(values)
        combined = self._combined({part.name: _product(part, now) * now[part.scale] for part in self.parts})
        changed = values is None or any(
            name == part.scale or name in part.powers
            for name in values
            for part in self.parts
            if part.name[0] == "M"
        )
        if changed:
            check_inertia(combined.mass, self._freedoms)
        return combined

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        """Derivatives of M, D, K by one quantity, per unit of it. See `LinearModel.derivative`."""
        if name not in self.quantities:
            raise unknown_quantity(self._name, name, self.quantities)
        now = self._valued(values)
        rates = {}
        for part in self.parts:
            if name == part.scale:
                rates[part.name] = _product(part, now)
            else:
                power = part.powers.get(name, 0)
                others = Part(
                    part.name, part.family, part.kind, {q: n for q, n in part.powers.items() if q != name}
                )
                own = power * now[name] ** (power - 1) if power else 0.0
                rates[part.name] = own * _product(others, now) * now[part.scale] if power else 0.0
        return self._combined(rates)

    @property
    def numbers(self) -> Mapping[str, float]:
        """Values of the file's quantities, without the parts' factors."""
        return MappingProxyType(self._numbers)

    def part(self, name: str) -> Any:
        """The matrix of a part as it stands in the file, dense or CSR."""
        part = next(part for part in self.parts if part.name == name)
        own = [p.name for p in self.parts if p.family == part.family]
        return self._families[part.family].combined([float(other == name) for other in own])

    def projected(self, basis: Array, name: str) -> MatrixModel:
        """The model restricted to x = basis y, (n_dof, n_small) real: every part V^T P V; same numbers,
        groups.
        """
        parts = {part.name: basis.T @ (self.part(part.name) @ basis) for part in self.parts}
        return MatrixModel(name, parts, self._numbers, groups=self._groups)

    def _combined(self, factors: Mapping[str, float]) -> Matrices:
        return Matrices(
            *(
                family.combined([factors[part.name] for part in self.parts if part.family == name])
                for name, family in self._families.items()
            )
        )

    def _valued(self, values: Mapping[str, float] | None) -> dict[str, float]:
        """All quantities with what is given replaced and checked."""
        now = {name: quantity.value for name, quantity in self.quantities.items()}
        for name, value in (values or {}).items():
            if name not in now:
                raise unknown_quantity(self._name, name, self.quantities)
            if not np.isfinite(value):
                raise ValueError(f"{name} = {value!r}: give a finite number")
            if value < 0.0 and (name in _NOT_NEGATIVE or name in {"part.M", "part.D", "part.K"}):
                raise ValueError(f"{name} = {value:g}: give a value that is not negative")
            now[name] = float(value)
        for part in self.parts:
            for name, power in part.powers.items():
                if power < 0 and now[name] == 0.0:
                    raise ValueError(
                        f"{name} = 0: the matrix {part.name} is divided by it; give another value"
                    )
        return now

    def _named(self) -> Mapping[str, NamedQuantity]:
        found = []
        for name in sorted(self._numbers, key=lambda name: (name not in _UNITS, name)):
            kinds: set[Kind] = {part.kind for part in self.parts if name in part.powers}
            own: Kind = kinds.pop() if len(kinds) == 1 else "other"
            kind: Kind = "operating" if name in _UNITS else own
            found.append(NamedQuantity(name, self._numbers[name], _UNITS.get(name, ""), kind))
        found += [NamedQuantity(part.scale, 1.0, "1", part.kind) for part in self.parts]
        return MappingProxyType({quantity.name: quantity for quantity in found})

    def _check_numbers(self, given: Mapping[str, float]) -> None:
        used = {name for part in self.parts for name in part.powers}
        for name in sorted(used - set(given)):
            part = next(part.name for part in self.parts if name in part.powers)
            raise ValueError(
                f"the matrix {part} is multiplied by {name}, and the file has no value of it; add the "
                f"number {name}"
            )
        for name, value in given.items():
            if name not in used:
                raise ValueError(
                    f"no matrix is multiplied by the number {name!r}: changing it would do nothing; "
                    "remove it, or name "
                    f"it in a matrix (K_{name})"
                )
            if not np.isfinite(value) or (value < 0.0 and name in _NOT_NEGATIVE):
                raise ValueError(f"the number {name} is {value!r}; give a finite value that is not negative")

    def _own_groups(self) -> tuple[ParameterGroup, ...]:
        return tuple(
            ParameterGroup(part.name.lower(), f"Matrix {part.name}", part.kind, both=(part.scale,))
            for part in self.parts
        )

    def _check_groups(self) -> None:
        for group in self._groups:
            for member in group.members:
                if member not in self.quantities:
                    message = unknown_quantity(self._name, member, self.quantities).args[0]
                    raise ValueError(f"group {group.name!r}: {message}")


class _Family:
    """Parts of M, of D or of K, ready to be summed with factors."""

    def __init__(self, parts: list[Any], n_dof: int) -> None:
        self._n = n_dof
        self._dense = n_dof <= DENSE_UP_TO
        if self._dense:
            arrays = [p.toarray() if sparse.issparse(p) else p for p in parts]
            self._stack = np.stack(arrays) if arrays else np.zeros((0, n_dof, n_dof))
            return
        marks = [sparse.csr_array((np.ones(p.nnz), p.indices, p.indptr), shape=p.shape) for p in parts]
        self._pattern: Any = sparse.csr_array(sum(marks, start=sparse.csr_array((n_dof, n_dof))))
        self._pattern.sort_indices()
        keys = self._keys(self._pattern)
        self._stack = np.zeros((len(parts), len(keys)))
        for row, part in zip(self._stack, parts, strict=True):
            row[np.searchsorted(keys, self._keys(part))] = part.data

    def _keys(self, matrix: Any) -> Any:
        rows = np.repeat(np.arange(self._n, dtype=np.int64), np.diff(matrix.indptr))
        return rows * self._n + matrix.indices

    def combined(self, factors: list[float]) -> Any:
        """Sum of factor times part; dense or CSR."""
        total = np.tensordot(np.array(factors, dtype=float), self._stack, axes=1)
        if self._dense:
            return total
        return sparse.csr_array(
            (total, self._pattern.indices, self._pattern.indptr), shape=(self._n, self._n)
        )


def _product(part: Part, now: Mapping[str, float]) -> float:
    return float(np.prod([now[name] ** power for name, power in part.powers.items()]))
