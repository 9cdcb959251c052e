"""Analytic sensitivity of all eigenvalues by all quantities (eq 24), and where it has no meaning.

For the pencil Q(l) = l^2 M + l D + K with Q v = 0, w^T Q = 0 eq 24 reads
dl/dp = - w^T (l^2 dM + l dD + dK) v / w^T (2 l M + D) v: the same number as with the state matrix, and no dA.
Eigenvalues that coincide or nearly do (`eigen_systems`) get nan and a reason instead of a number.
NOT its job: finite changes (`variations`), choosing quantities for people, tables.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from sim_hardware.brake_model.design.brake_gradients import numerators
from sim_hardware.brake_model.eigen.eigen_systems import EigenSystem, band_system, eigen_system
from sim_hardware.brake_model.linear import LinearModel, Matrices, known, value_of
from sim_hardware.brake_model.parametric import LinearBrake

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class Derivatives:
    """Derivatives of the matrices by several quantities.

    Attributes
    ----------
    names : (q,)
    units : (q,)
    amounts : (q,) value of each quantity
    mass, damping, stiffness : (q, n_dof, n_dof) per unit; or sequences of q sparse arrays
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    amounts: Array
    mass: Any
    damping: Any
    stiffness: Any


@dataclass(frozen=True, slots=True)
class Sensitivities:
    """Eq 24 for q quantities and m eigenvalues.

    Attributes
    ----------
    absolute : (q, m) d lambda / d p, 1/s per unit of the quantity; nan where the eigenvalue is not `regular`
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    amounts: Array
    system: EigenSystem
    absolute: ComplexArray

    @property
    def per_percent(self) -> ComplexArray:
        """(q, m) change of lambda for 1 % more of the quantity, 1/s."""
        return 0.01 * self.amounts[:, None] * self.absolute

    @property
    def reach_percent(self) -> Array:
        """(q, m) change of the quantity (%) up to which the derivative tells the change: at most 100.

        Beyond it the eigenvalue has moved by a quarter of its distance to the next one: re-solve instead.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = 0.25 * self.system.gap / np.abs(self.per_percent)
        return np.where(np.isnan(reach), np.nan, np.minimum(reach, 100.0))


def parameter_names(model: LinearModel, *, places: bool = False, operating: bool = True) -> tuple[str, ...]:
    """Quantities worth a sensitivity: the parameters of the file, on request every place of an expression
    too.

    Models made elsewhere have no parameters but parts ("part.K_mu"): then these. `operating`: also mu, slope,
    pressure and the like.
    """
    plain = [q for q in model.quantities.values() if "." not in q.name]
    everything = places or all(q.kind == "operating" for q in plain)
    chosen = model.quantities.values() if everything else plain
    return tuple(q.name for q in chosen if operating or q.kind != "operating")


def derivatives(
    model: LinearModel, names: Sequence[str] | None = None, values: Mapping[str, float] | None = None
) -> Derivatives:
    """Exact derivatives of M, D, K by several quantities (`parameter_names` where None).

    Raises
    ------
    KeyError, ValueError
        as `LinearModel.derivative`
    """
    chosen = parameter_names(model) if names is None else tuple(names)
    single = [model.derivative(name, values) for name in chosen]
    units = tuple(known(model, name).unit for name in chosen)
    amounts = np.array([value_of(model, name, values) for name in chosen])
    if any(d.is_sparse for d in single):
        kept = [sparse_matrices(d) for d in single]
        return Derivatives(
            chosen,
            units,
            amounts,
            [d.mass for d in kept],
            [d.damping for d in kept],
            [d.stiffness for d in kept],
        )
    n = len(model.freedoms)
    stacks = [np.zeros((len(chosen), n, n)) for _ in range(3)]
    for number, d in enumerate(single):
        stacks[0][number], stacks[1][number], stacks[2][number] = d.mass, d.damping, d.stiffness
    return Derivatives(chosen, units, amounts, *stacks)


def sparse_matrices(matrices: Matrices) -> Matrices:
    """The same as scipy sparse arrays (CSR)."""
    return Matrices(*(sparse.csr_array(m) for m in (matrices.mass, matrices.damping, matrices.stiffness)))


def sensitivities(system: EigenSystem, changes: Derivatives) -> Sensitivities:
    """Eq 24 for all quantities and all eigenvalues of a system at once, from derivatives of the matrices."""
    v, w, values = system.right, system.left, system.values
    if isinstance(changes.mass, np.ndarray):
        n = v.shape[0]
        # (n_dof^2, m): products w_a v_b, so that each w^T dK v is a row of one matrix product
        products = np.ascontiguousarray((w[:, None, :] * v[None, :, :]).reshape(n * n, -1))
        inertia, damping, stiffness = (
            _real_times_complex(d.reshape(-1, n * n), products)
            for d in (changes.mass, changes.damping, changes.stiffness)
        )
    else:
        inertia, damping, stiffness = (
            np.array([np.sum(w * (d @ v), axis=0) for d in several])
            for several in (changes.mass, changes.damping, changes.stiffness)
        )
    numerator = values**2 * inertia + values * damping + stiffness
    return Sensitivities(changes.names, changes.units, changes.amounts, system, _quotient(system, numerator))


def sensitivities_of(
    model: LinearModel, system: EigenSystem, names: Sequence[str] | None, values: Mapping[str, float] | None
) -> Sensitivities:
    """Eq 24 for quantities of a model whose eigenvalues are known; our brake by its rank-one structure.

    Raises
    ------
    KeyError, ValueError
        as `LinearModel.derivative`
    """
    if not isinstance(model, LinearBrake):
        return sensitivities(system, derivatives(model, names, values))
    chosen = parameter_names(model) if names is None else tuple(names)
    quantities = [known(model, name) for name in chosen]
    amounts = np.array([value_of(model, name, values) for name in chosen])
    numerator = numerators(model, chosen, values, system.values, system.left, system.right)
    units = tuple(quantity.unit for quantity in quantities)
    return Sensitivities(chosen, units, amounts, system, _quotient(system, numerator))


def eigen_sensitivities(
    model: LinearModel,
    names: Sequence[str] | None = None,
    values: Mapping[str, float] | None = None,
    *,
    band_hz: tuple[float, float] | None = None,
) -> Sensitivities:
    """Eq 24 for the eigenvalues of a model, all or those in a frequency band (large models).

    Parameters
    ----------
    names : quantities; `parameter_names` where None
    values : working point, and other values that differ from the file's

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible value, a band without eigenvalues, a large model without band
    ArithmeticError, numpy.linalg.LinAlgError
        no convergence in the band, M is singular
    """
    matrices = model.matrices(values)
    system = eigen_system(matrices) if band_hz is None else band_system(matrices, band_hz)
    return sensitivities_of(model, system, names, values)


def _quotient(system: EigenSystem, numerator: ComplexArray) -> ComplexArray:
    regular = system.regular
    found = np.full(numerator.shape, complex(np.nan, np.nan))
    found[:, regular] = -numerator[:, regular] / system.slope[regular]  # eq 24
    return found


def _real_times_complex(real: Array, products: ComplexArray) -> ComplexArray:
    """Real (q, k) times complex (k, m) without turning the large real factor complex."""
    doubled = real @ products.view(float)
    return doubled.view(complex)
