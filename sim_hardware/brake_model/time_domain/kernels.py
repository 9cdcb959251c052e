"""Compiled recursion of the squealing brake: exact linear propagation, friction evaluated at the pads only.

Main step: exponential Adams-Moulton in the s form (`modal`), with the contact motion predicted one step
ahead. Where a pad's slip would reverse, careful steps take over (`contact`). For any number of pads and
modes; `blocks` does the same main steps faster for the usual brake.
NOT its job: building the coefficients (`integrator`).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from sim_hardware.brake_model.time_domain.contact import (
    CALM,
    DEPTH,
    FROM_LAW,
    OPTIONS,
    SLIDES,
    Array,
    Coefficients,
    Memory,
    careful_and_count,
    outputs_now,
    point,
    present_g,
    shift,
)


@njit(**OPTIONS)
def advance_general(
    c: Coefficients,
    m: Memory,
    operation: Array,
    inverse_saturation: float,
    first: int,
    patience: int,
    excitation: Array,
    out: Array,
) -> int:
    """Advance until all is done, or until `patience` main steps in a row went well.

    Parameters
    ----------
    c, m : coefficients; memory, updated
    operation : (4, 2) pad force (N), mu_mean, mean slip (m/s), slope k (s/m) at the two ends of the call;
        linear between
    inverse_saturation : 1 / v_s (s/m)
    first : internal step to begin with, a multiple of `c.substeps`
    patience : main steps in a row after which to return at the end of an output interval; 0: never
    excitation : (n_out, G) N, held over each output interval; (0, G) for none
    out : (n_out, O) filled with the outputs at the start of each interval

    Returns
    -------
    first internal step that was not taken
    """
    groups, modes = len(c.share), c.modal.shape[2]
    steps = len(out) * c.substeps
    step, well = steps, 0
    ahead = np.zeros(2 * groups)
    start, end = np.zeros(4), np.zeros(4)
    still = np.zeros(groups)
    for n in range(first, steps):
        push = excitation[n // c.substeps] if len(excitation) else still
        point(operation, n / steps, start)
        point(operation, (n + 1) / steps, end)
        present_g(c, m, start, inverse_saturation)
        if n % c.substeps == 0:
            outputs_now(c, m, push, out[n // c.substeps])
        forwards = m.flags[0] >= CALM
        for row in range(2 * groups):
            value = 0.0
            for j in range(modes):
                value += (
                    c.modal[c.ahead + row, 0, j] * m.modes[0, j]
                    + c.modal[c.ahead + row, 1, j] * m.modes[1, j]
                )
            for q in range(groups):
                value += c.ahead_history[row, 0, q] * m.present[q] + c.ahead_hold[row, q] * push[q]
                for d in range(1, DEPTH):
                    value += c.ahead_history[row, d, q] * m.history[d - 1, q]
            ahead[row] = value
            if row % 2 == 0:
                forwards = forwards and end[2] - value > SLIDES * end[2]
        if not forwards:
            careful_and_count(c, m, push, start, end, inverse_saturation)
            well = 0
            continue
        for j in range(modes):
            re = c.modal[c.rotation, 0, j] * m.modes[0, j] - c.modal[c.rotation, 1, j] * m.modes[1, j]
            im = c.modal[c.rotation, 0, j] * m.modes[1, j] + c.modal[c.rotation, 1, j] * m.modes[0, j]
            for p in range(groups):
                re += c.modal[c.drive + p, 0, j] * m.present[p] + c.modal[c.hold + p, 0, j] * push[p]
                im += c.modal[c.drive + p, 1, j] * m.present[p] + c.modal[c.hold + p, 1, j] * push[p]
            m.modes[0, j], m.modes[1, j] = re, im
        shift(m)
        for row in range(2 * groups):
            m.contact[row] = ahead[row]
        m.flags[1] = FROM_LAW
        well += 1
        if 0 < patience <= well and (n + 1) % c.substeps == 0:
            step = n + 1
            break
    point(operation, step / steps, end)
    present_g(c, m, end, inverse_saturation)
    return step
