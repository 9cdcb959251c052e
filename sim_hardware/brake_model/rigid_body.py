"""Rigid-body motions: what can move without stretching a spring or damper, and eigenvalues beside them.

Such a motion has two eigenvalues 0 that share one vector (it drifts). A general eigenvalue routine returns
them as +-1e-4 1/s or so, of which one looks unstable. Here they are taken out exactly before the others are
computed. NOT its job: eigenvalues of brakes without such motions are LAPACK's, unchanged.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: a motion is rigid where its stiffness and damping are below this part of the largest
_NOTHING = 1e-12
#: eigenvalues below this part of the largest may be those of rigid-body motions
_SMALL = 1e-6


def rigid_motions(state_matrix: Array) -> Array:
    """Orthonormal displacement shapes (n_dof, r) with K r = 0 and D r = 0, from the state matrix (eq 27).

    Parameters
    ----------
    state_matrix : (2 n_dof, 2 n_dof) of displacements and velocities
    """
    n = len(state_matrix) // 2
    stiffness, damping = state_matrix[n:, :n], state_matrix[n:, n:]
    stiffest = float(np.abs(stiffness).max(initial=0.0))
    if stiffest == 0.0:
        largest = float(np.abs(damping).max(initial=0.0))
        stacked = damping / largest if largest > 0.0 else damping
    else:
        stacked = np.vstack([stiffness / stiffest, damping / np.sqrt(stiffest)])
    _, sizes, rows = np.linalg.svd(stacked)
    sizes = np.concatenate([sizes, np.zeros(n - len(sizes))])
    return np.ascontiguousarray(rows[sizes <= _NOTHING * n * max(sizes.max(initial=0.0), _NOTHING)].T)


def eigenvalues(state_matrix: Array) -> Complex:
    """All 2 n_dof eigenvalues (1/s) of a state matrix (eq 27); those of rigid-body motions are exactly 0."""
    values = np.linalg.eigvals(state_matrix).astype(complex)
    size = np.abs(values)
    if size.min(initial=np.inf) >= _SMALL * size.max(initial=0.0) and size.max(initial=0.0) > 0.0:
        return values
    n = len(state_matrix) // 2
    rigid = rigid_motions(state_matrix)
    count = rigid.shape[1]
    if count == 0:
        return values
    others = np.linalg.qr(rigid, mode="complete")[0][:, count:]
    reduced = np.zeros((2 * (n - count), 2 * (n - count)))
    reduced[: n - count, n - count :] = np.eye(n - count)
    # the rigid parts drive nothing: what the others do is theirs alone
    reduced[n - count :, : n - count] = others.T @ state_matrix[n:, :n] @ others
    reduced[n - count :, n - count :] = others.T @ state_matrix[n:, n:] @ others
    return np.concatenate([np.zeros(2 * count), np.linalg.eigvals(reduced)]).astype(complex)


def largest_growth(state_matrices: Array) -> Array:
    """Largest real part (b,) of the eigenvalues of each matrix, (b, 2 n_dof, 2 n_dof); rigid-body motions:
    0."""
    values = np.linalg.eigvals(state_matrices)
    growth, size = values.real.max(axis=-1), np.abs(values)
    doubtful = (size.min(axis=-1) < _SMALL * size.max(axis=-1)) & (growth < _SMALL * size.max(axis=-1))
    for i in np.flatnonzero(doubtful):
        growth[i] = float(eigenvalues(state_matrices[i]).real.max())
    return growth


def freely_moving(freedoms: tuple[str, ...], state_matrix: Array) -> tuple[str, ...]:
    """Names of the degrees of freedom that take part in rigid-body motions."""
    shapes = rigid_motions(state_matrix)
    size = np.abs(shapes).max(axis=1, initial=0.0)
    return tuple(name for name, moves in zip(freedoms, size > 1e-6, strict=True) if moves)
