"""Compiled: eigenvalues along a line of points as roots of a secular equation, continued from point to point.

The equation (see `secular_equation`): F(l) = 1 + sum_j (c_j l + e_j) / (l^2 - a_j l + b_j) = 0, one real
quadratic for each pair of nodes. Every root is predicted from its past, corrected by Newton, and all of them
are guarded together.
NOT its job: building coefficients, LAPACK for the points flagged here (`secular`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.secular import FLAGGED, HISTORY, SOLVED
from sim_hardware.brake_model.eigen.secular_equation import LANES
from sim_hardware.brake_model.time_domain import simd as _simd

Array = NDArray[np.float64]
#: numba's intrinsics: their Python signatures are not those of the compiled code
simd: Any = _simd

OPTIONS = {"cache": True, "nogil": True, "error_model": "numpy"}
_INDEX = ir.IntType(32)
#: last correction of a root, relative to it; Newton then leaves its square
_STEP = 3e-8
_STEPS = 6
#: |F'| |l| of a root below which it has a close neighbour and is left to LAPACK
_ISOLATED = 2e-2
#: errors of the sums of eigenvalues and of their squares, relative to the sums of magnitudes
_SUM = 2e-12
_SWEEPS = 40
#: a pair this near to the real axis, relative to its magnitude, is not decided here
_REAL = 1e-7


@intrinsic
def _total(typing_context: Any, a: Any) -> Any:
    """Return the sum of all lanes of a vector (`simd`), halves added to halves."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        value, lanes = args[0], signature.args[0].lanes
        while lanes > 1:
            nothing = ir.Constant(value.type, ir.Undefined)
            lower, upper = (
                builder.shuffle_vector(
                    value,
                    nothing,
                    ir.Constant(ir.VectorType(_INDEX, lanes // 2), list(range(first, first + lanes // 2))),
                )
                for first in (0, lanes // 2)
            )
            value, lanes = builder.fadd(lower, upper), lanes // 2
        return builder.extract_element(value, ir.Constant(_INDEX, 0))

    return types.float64(a), code


reduced: Any = _total


@njit(**OPTIONS)
def _secular(
    re: float, im: float, a: Array, b: Array, c: Array, e: Array
) -> tuple[float, float, float, float]:
    """F and F' at re + i im; all tables in lanes of eight, padded with terms that are zero."""
    x, y, one = simd.splat8(re), simd.splat8(im), simd.splat8(1.0)
    square_x, square_y = simd.splat8(re * re - im * im), simd.splat8(2.0 * re * im)
    twice_x, twice_y = simd.splat8(2.0 * re), simd.splat8(2.0 * im)
    f_x, f_y, g_x, g_y = simd.zero8(), simd.zero8(), simd.zero8(), simd.zero8()
    for j in range(0, a.size, LANES):
        a_j, c_j = simd.load8(a, j), simd.load8(c, j)
        q_x = simd.negative_multiply_add(a_j, x, simd.add(square_x, simd.load8(b, j)))
        q_y = simd.negative_multiply_add(a_j, y, square_y)
        inverse = simd.divide(one, simd.multiply_add(q_x, q_x, simd.multiply(q_y, q_y)))
        q_x, q_y = simd.multiply(q_x, inverse), simd.multiply(q_y, inverse)  # 1 / q = q_x - i q_y
        n_x, n_y = simd.multiply_add(c_j, x, simd.load8(e, j)), simd.multiply(c_j, y)
        t_x = simd.multiply_add(n_x, q_x, simd.multiply(n_y, q_y))
        t_y = simd.negative_multiply_add(n_x, q_y, simd.multiply(n_y, q_x))
        s_x = simd.subtract(twice_x, a_j)
        u_x = simd.multiply_add(t_y, twice_y, simd.negative_multiply_add(t_x, s_x, c_j))
        u_y = simd.multiply_add(t_x, twice_y, simd.multiply(t_y, s_x))  # F' of a term: (u_x - i u_y) / q
        f_x, f_y = simd.add(f_x, t_x), simd.add(f_y, t_y)
        g_x = simd.add(g_x, simd.negative_multiply_add(u_y, q_y, simd.multiply(u_x, q_x)))
        g_y = simd.subtract(g_y, simd.multiply_add(u_y, q_x, simd.multiply(u_x, q_y)))
    return 1.0 + reduced(f_x), reduced(f_y), reduced(g_x), reduced(g_y)


@njit(**OPTIONS)
def _correct(roots: Array, count: int, a: Array, b: Array, c: Array, e: Array) -> bool:
    """Correct `count` roots (2, n) by Newton; whether all came to rest, each alone."""
    for k in range(count):
        re, im = roots[0, k], roots[1, k]
        real = im == 0.0
        rest = False
        for _ in range(_STEPS):
            f_re, f_im, g_re, g_im = _secular(re, im, a, b, c, e)
            slope = g_re * g_re + g_im * g_im
            step_re = (f_re * g_re + f_im * g_im) / slope
            step_im = 0.0 if real else (f_im * g_re - f_re * g_im) / slope
            re -= step_re
            im -= step_im
            size = re * re + im * im
            if step_re * step_re + step_im * step_im <= _STEP * _STEP * size:
                rest = slope * size > _ISOLATED * _ISOLATED
                break
        if not rest or (not real and im <= _REAL * abs(re)):
            return False
        roots[0, k], roots[1, k] = re, im
    return True


@njit(**OPTIONS)
def _complete(roots: Array, count: int, first: float, second: float) -> bool:
    """Whether the roots are all eigenvalues: their sum and that of their squares are traces of A and A^2."""
    sum_1, sum_2, size_1, size_2 = 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        re, im = roots[0, k], roots[1, k]
        weight = 1.0 if im == 0.0 else 2.0
        size = re * re + im * im
        sum_1 += weight * re
        sum_2 += weight * (re * re - im * im)
        size_1 += weight * np.sqrt(size)
        size_2 += weight * size
    return abs(sum_1 - first) <= _SUM * size_1 and abs(sum_2 - second) <= _SUM * size_2


@njit(**OPTIONS)
def _aberth(  # noqa: PLR0912, PLR0915 (one iteration, its parts in order)
    start: Array, count: int, roots: Array, half: int, a: Array, b: Array, c: Array, e: Array
) -> int:
    """All roots anew by Ehrlich and Aberth from those of a neighbour, reals and pairs free to change.

    Returns the number of roots with Im >= 0 now in `roots`, or 0 where they did not come to rest.
    """
    n = 2 * half
    re, im, done = np.empty(n), np.empty(n), np.zeros(n, np.bool_)
    m = 0
    for k in range(count):  # a little apart and off the axis, so that pairs may part
        x, y = start[0, k], start[1, k]
        shift = 1e-3 * np.sqrt(x * x + y * y)
        if y == 0.0:
            re[m], im[m] = x, (shift if k % 2 == 0 else -shift)
            m += 1
        else:
            re[m], im[m] = x + shift, y
            re[m + 1], im[m + 1] = x - shift, -y
            m += 2
    left = n
    for _ in range(_SWEEPS):
        for k in range(n):
            if done[k]:
                continue
            f_re, f_im, g_re, g_im = _secular(re[k], im[k], a, b, c, e)
            x, y = re[k], im[k]
            # p'/p = F'/F + sum of 1/(l - node), less the other roots: each is drawn to a zero of its own
            inverse = 1.0 / (f_re * f_re + f_im * f_im)
            r_re, r_im = (g_re * f_re + g_im * f_im) * inverse, (g_im * f_re - g_re * f_im) * inverse
            for j in range(half):
                n_re, n_im = 2.0 * x - a[j], 2.0 * y
                q_re, q_im = x * x - y * y - a[j] * x + b[j], 2.0 * x * y - a[j] * y
                inverse = 1.0 / (q_re * q_re + q_im * q_im)
                r_re += (n_re * q_re + n_im * q_im) * inverse
                r_im += (n_im * q_re - n_re * q_im) * inverse
            for i in range(n):
                if i != k:
                    d_re, d_im = x - re[i], y - im[i]
                    inverse = 1.0 / (d_re * d_re + d_im * d_im)
                    r_re -= d_re * inverse
                    r_im += d_im * inverse
            inverse = 1.0 / (r_re * r_re + r_im * r_im)
            step_re, step_im = r_re * inverse, -r_im * inverse
            re[k] -= step_re
            im[k] -= step_im
            if not step_re * step_re + step_im * step_im > 1e-26 * (x * x + y * y):
                done[k] = True
                left -= 1
        if left == 0:
            break
    if left > 0:
        return 0
    found, below = 0, 0
    for k in range(n):
        size = np.sqrt(re[k] * re[k] + im[k] * im[k])
        if abs(im[k]) <= 1e-9 * size:
            roots[0, found], roots[1, found] = re[k], 0.0
            found += 1
        elif im[k] > 0.0:
            roots[0, found], roots[1, found] = re[k], im[k]
            found += 1
        else:
            below += 1
    reals = 0
    for k in range(found):
        reals += roots[1, k] == 0.0
    return found if found - reals == below and found + below == n else 0


@njit(**OPTIONS)
def _store(roots: Array, count: int, order: NDArray[np.int64], out: NDArray[np.complex128]) -> None:
    """Write all eigenvalues of a point, sorted by frequency, a pair as l and its conjugate."""
    for k in range(1, count):  # insertion: the order of the last point is nearly right
        index = order[k]
        j = k - 1
        while j >= 0 and (
            roots[1, order[j]] > roots[1, index]
            or (roots[1, order[j]] == roots[1, index] and roots[0, order[j]] > roots[0, index])
        ):
            order[j + 1] = order[j]
            j -= 1
        order[j + 1] = index
    m = 0
    for k in range(count):
        re, im = roots[0, order[k]], roots[1, order[k]]
        out[m] = complex(re, im)
        m += 1
        if im != 0.0:
            out[m] = complex(re, -im)
            m += 1


@njit(**OPTIONS)
def _walk(  # noqa: PLR0912 (one loop, its parts in order)
    basis: Array,
    weights: Array,
    a: Array,
    b: Array,
    numerators: Array,
    sums: Array,
    start: Array,
    start_count: int,
    out: NDArray[np.complex128],
    state: NDArray[np.uint8],
) -> None:
    """Eigenvalues at all points of a line; see `walk_rows`."""
    points, terms, half = basis.shape[0], basis.shape[1], out.shape[1] // 2
    c, e = np.zeros(a.size), np.zeros(a.size)
    past = np.empty((HISTORY, 2, 2 * half))
    newest = 0
    roots = np.empty((2, 2 * half))
    order = np.arange(2 * half)
    count, known = start_count, 0
    last = start.copy()
    for i in range(points):
        for j in range(half):
            c[j], e[j] = numerators[0, 0, j], numerators[1, 0, j]
        first, second = sums[0, 0], sums[1, 0]
        for t in range(1, terms):
            value = basis[i, t]
            for j in range(half):
                c[j] += value * numerators[0, t, j]
                e[j] += value * numerators[1, t, j]
            first += value * sums[0, t]
            second += value * sums[1, t]
        if known == 0:
            roots[:, :count] = last[:, :count]
        else:
            roots[:, :count] = 0.0
            for h in range(known):
                value, row = weights[i, known - 1, h], (newest - h) % HISTORY
                for part in range(2):
                    for k in range(count):
                        roots[part, k] += value * past[row, part, k]
        solved = _correct(roots, count, a, b, c, e) and _complete(roots, count, first, second)
        if not solved:
            found = _aberth(last, count, roots, half, a, b, c, e)
            solved = (
                found > 0 and _correct(roots, found, a, b, c, e) and _complete(roots, found, first, second)
            )
            known = 0
            if solved and found != count:
                count = found
            if solved:
                for k in range(2 * half):
                    order[k] = k
        if not solved:
            state[i] = FLAGGED
            continue
        state[i] = SOLVED
        last[:, :count] = roots[:, :count]
        newest = (newest + 1) % HISTORY
        past[newest, :, :count] = roots[:, :count]
        known = min(known + 1, HISTORY)
        _store(roots, count, order, out[i])


@njit(**OPTIONS)
def walk_rows(
    rows: NDArray[np.int64],
    basis: Array,
    weights: Array,
    a: Array,
    b: Array,
    numerators: Array,
    sums: Array,
    starts: Array,
    counts: NDArray[np.int64],
    out: NDArray[np.complex128],
    state: NDArray[np.uint8],
) -> None:
    """Eigenvalues at all points of some lines.

    Parameters
    ----------
    rows : (m,) the lines to do
    basis : (points, terms) polynomials of the variable along the lines
    weights : (points, HISTORY, HISTORY) weights [h - 1, :h] that predict a point from its h predecessors,
        last first
    a, b : (n / 2,) of the nodes, padded to a multiple of `LANES`
    numerators : (lines, 2, terms, n / 2) coefficients of c and e, padded alike
    sums : (lines, 2, terms) of the traces of A and A^2
    starts, counts : (lines, 2, n) Re and Im of the roots with Im >= 0 near the first point, (lines,) their
        number
    out : (lines, points, n) eigenvalues; undefined where flagged
    state : (lines, points) SOLVED or FLAGGED
    """
    for row in rows:
        _walk(
            basis,
            weights,
            a,
            b,
            numerators[row],
            sums[row],
            starts[row],
            int(counts[row]),
            out[row],
            state[row],
        )


@njit(**OPTIONS)
def cross_rows(
    a: Array, b: Array, numerators: Array, low: Array, high: Array, found: Array
) -> NDArray[np.bool_]:
    """Crossings of the imaginary axis on some lines: Newton in (omega, u) on F(i omega; u) = 0.

    Parameters
    ----------
    a, b, numerators : as in `walk_rows`; polynomials are Chebyshev's of u in -1 … 1
    low, high : (lines,) ranges of u
    found : (lines, 2) start (u, omega); the crossing on return. omega = 0: a real eigenvalue passes 0

    Returns
    -------
    (lines,) whether Newton came to rest within the range
    """
    lines, terms = numerators.shape[0], numerators.shape[2]
    good = np.zeros(lines, np.bool_)
    value, rate = np.ones(terms), np.zeros(terms)
    for line in range(lines):
        u, omega = found[line, 0], found[line, 1]
        real = omega == 0.0
        for _ in range(30):
            for t in range(1, terms):  # T_t and its derivative
                if t == 1:
                    value[1], rate[1] = u, 1.0
                else:
                    value[t] = 2.0 * u * value[t - 1] - value[t - 2]
                    rate[t] = 2.0 * value[t - 1] + 2.0 * u * rate[t - 1] - rate[t - 2]
            f_re, f_im, g_re, g_im, h_re, h_im = 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for j in range(a.size):
                c, e, dc, de = 0.0, 0.0, 0.0, 0.0
                for t in range(terms):
                    c += value[t] * numerators[line, 0, t, j]
                    e += value[t] * numerators[line, 1, t, j]
                    dc += rate[t] * numerators[line, 0, t, j]
                    de += rate[t] * numerators[line, 1, t, j]
                q_re, q_im = b[j] - omega * omega, -a[j] * omega
                inverse = 1.0 / (q_re * q_re + q_im * q_im)
                t_re = (e * q_re + c * omega * q_im) * inverse
                t_im = (c * omega * q_re - e * q_im) * inverse
                f_re += t_re
                f_im += t_im
                h_re += (de * q_re + dc * omega * q_im) * inverse
                h_im += (dc * omega * q_re - de * q_im) * inverse
                u_re = c + t_re * a[j] + 2.0 * t_im * omega
                u_im = t_im * a[j] - 2.0 * t_re * omega
                g_re += (u_re * q_re + u_im * q_im) * inverse
                g_im += (u_im * q_re - u_re * q_im) * inverse
            if real:
                step_u, step_omega = f_re / h_re, 0.0
            else:  # dF/d omega = i F'
                o_re, o_im = -g_im, g_re
                determinant = h_re * o_im - h_im * o_re
                step_u = (f_re * o_im - f_im * o_re) / determinant
                step_omega = (h_re * f_im - h_im * f_re) / determinant
            u -= step_u
            omega -= step_omega
            if abs(step_u) <= 1e-9 and abs(step_omega) <= 1e-9 * abs(omega):
                slack = 1e-9 + 1e-3 * (high[line] - low[line])
                good[line] = low[line] - slack <= u <= high[line] + slack
                break
        found[line, 0], found[line, 1] = u, omega
    return good
