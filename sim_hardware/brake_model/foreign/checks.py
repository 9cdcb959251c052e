"""Checks of matrices made elsewhere, with messages that say what to do.

Job: one matrix (`checked_matrix`), inertia (`check_inertia`). NOT its job: names and numbers (`foreign`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

#: degrees of freedom up to which matrices are used as dense arrays
DENSE_UP_TO = 300
#: smallest pivot of M with unit diagonal, above which M counts as regular
_SMALLEST_PIVOT = 1e-12


def checked_matrix(name: str, matrix: Any, n_dof: int) -> Any:
    """A copy as float64, dense array or CSR with sorted indices, (n_dof, n_dof).

    Raises
    ------
    ValueError
        empty, not square, not n_dof by n_dof, not numbers, complex, not finite
    """
    shape = np.shape(matrix)
    if len(shape) != 2 or shape[0] != shape[1] or 0 in shape:
        size = " × ".join(map(str, shape)) or "a single number"
        raise ValueError(f"the matrix {name} is {size}; give a square matrix that is not empty")
    if shape[0] != n_dof:
        raise ValueError(
            f"the matrix {name} is {shape[0]} × {shape[0]} where the first is {n_dof} × {n_dof}; "
            "give all for the same degrees of freedom"
        )
    copy: Any = sparse.csr_array(matrix) if sparse.issparse(matrix) else np.array(matrix)
    if sparse.issparse(copy):
        copy = copy.copy()
        copy.sum_duplicates()
    if copy.dtype.kind not in "biufc":
        raise ValueError(f"the matrix {name} holds {copy.dtype}; give numbers")
    data = copy.data if sparse.issparse(copy) else copy
    if copy.dtype.kind == "c":
        if np.any(np.imag(data) != 0.0):
            raise ValueError(
                f"the matrix {name} is complex; give real matrices (structural damping eta as D = eta K "
                "/ omega "
                "at a frequency of interest)"
            )
        copy = copy.real
    copy = copy.astype(np.float64)
    data = copy.data if sparse.issparse(copy) else copy
    bad = np.argwhere(~np.isfinite(copy.tocoo().data if sparse.issparse(copy) else data))
    if bad.size:
        if sparse.issparse(copy):
            coo = copy.tocoo()
            row, column = int(coo.row[bad[0][0]]), int(coo.col[bad[0][0]])
        else:
            row, column = map(int, bad[0])
        raise ValueError(
            f"the matrix {name} has {len(bad)} values that are not finite, "
            f"the first in row {row + 1}, column {column + 1}; correct the export"
        )
    return sparse.csr_array(copy) if n_dof > DENSE_UP_TO and not sparse.issparse(copy) else copy


def check_inertia(mass: Any, freedoms: Sequence[str]) -> None:
    """Refuse an M that is singular or, being symmetric, not positive.

    Raises
    ------
    ValueError
        says which freedom, where one has no inertia
    """
    diagonal = np.asarray(mass.diagonal())
    remedy = "remove freedoms without inertia by static condensation before the export"
    symmetric = abs(mass - mass.T).max() <= 1e-9 * abs(mass).max()
    if symmetric:
        without = np.flatnonzero(diagonal <= 0.0)
        if without.size:
            index = int(without[0])
            more = f" (and {len(without) - 1} more)" if len(without) > 1 else ""
            raise ValueError(
                f"M: the freedom {freedoms[index]!r}{more} has the inertia {diagonal[index]:g}, which "
                "must be positive; "
                f"{remedy if diagonal[index] == 0.0 else 'correct the sign'}"
            )
        root = 1.0 / np.sqrt(diagonal)
        scaled = sparse.csc_array(mass * root[:, None] * root[None, :]) if sparse.issparse(mass) else None
        if scaled is None:
            smallest = float(np.linalg.eigvalsh(mass * root[:, None] * root[None, :])[0])
        else:
            factors = splu(
                scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
            smallest = float(factors.U.diagonal().real.min())
        if smallest < -_SMALLEST_PIVOT:
            raise ValueError("M is not positive: some motion has negative kinetic energy; correct the masses")
    else:
        size = np.asarray(
            abs(mass).max(axis=1).toarray() if sparse.issparse(mass) else np.abs(mass).max(axis=1)
        ).ravel()
        smallest = 0.0
        if size.all():
            try:
                factors = splu(sparse.csc_array(sparse.csr_array(mass) / size[:, None]))
                smallest = float(np.abs(factors.U.diagonal()).min())
            except RuntimeError:  # SuperLU: singular
                smallest = 0.0
    if smallest < _SMALLEST_PIVOT:
        raise ValueError(f"M is singular: some motion has no kinetic energy; {remedy}")
