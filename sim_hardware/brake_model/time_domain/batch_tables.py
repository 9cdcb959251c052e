"""Layout of what the batch kernels compute with: coefficients of a brake, memory and working points of lanes.

NOT its job: the recursion (`batch_kernels`), what the coefficients mean (`integrator`, `modal`).
"""

from __future__ import annotations

import numpy as np

from sim_hardware.brake_model.time_domain.contact import DEPTH, PAST, Array, Coefficients
from sim_hardware.brake_model.time_domain.modal import Complex

#: brakings per vector
LANES = 8
#: friction groups that the kernels are written for
PADS = 2

# -- coefficients: a section per kind, each with all modes, in units of the number of modes
#: main step, per mode: E, drive of both pads, contact motion ahead from Re and from Im
MODE_SIZE = 14
HOLD = MODE_SIZE  #: 4 per mode: excitation held over the step
FINE = HOLD + 4  #: as the main step, of the fine step, from the new modes
FINE_HOLD = FINE + MODE_SIZE  #: 4 per mode
LATE = FINE_HOLD + 4  #: 16 per mode: from g and its history, s form to fine form
MODAL_SIZE = LATE + 16
# -- then single ones
AHEAD = 0  #: (DEPTH, PADS, 4) contact motion ahead from g and its history
AHEAD_HOLD = AHEAD + 4 * PADS * DEPTH  #: (PADS, 4)
FINE_END = AHEAD_HOLD + 4 * PADS  #: (4, PADS) contact motion from g at the end of a fine step
SHARE = FINE_END + 4 * PADS
MU_REF = SHARE + PADS
#: outputs: 2 per mode, then
OUTPUT = MU_REF + 1
OUTPUT_SIZE = PADS * DEPTH + PADS  #: from g, its history and the excitation

# -- memory of eight lanes, rows
HISTORY_ROW = 0  #: (PAST, PADS)
CONTACT_ROW = HISTORY_ROW + PAST * PADS  #: slip, compression of each pad
PRESENT_ROW = CONTACT_ROW + 2 * PADS
CALM_ROW = PRESENT_ROW + PADS  #: smooth steps in a row
SOLVED_ROW = CALM_ROW + 1  #: 1: g is in the present rows, 0: it follows from the law
STATE_ROWS = SOLVED_ROW + 1  #: then the modes, Re and Im in turn, and a second place for them
# -- working point: pad force, mu, slip, k, each followed by its change per internal step
SATURATION_ROW = 8
OPERATION_ROWS = 9

_LINE = 64


def table_of(c: Coefficients, modes: int) -> Array:
    """All coefficients of a brake in the order above; modes that it does not have are zero.

    Parameters
    ----------
    modes : number of modes to lay out, at least that of the brake

    Returns
    -------
    (size,)
    """

    def rows(first: int, count: int = 1) -> Array:
        """(modes, count, 2): the rows of a kind."""
        part = np.zeros((count, 2, modes))
        width = min(modes, c.modal.shape[2])
        part[:, :, :width] = c.modal[first : first + count, :, :width]
        return part.transpose(2, 0, 1)

    def as_complex(part: Array) -> Complex:
        return part[..., 0] + 1j * part[..., 1]

    def flat(part: Complex) -> Array:
        """Complex (modes, count) as Re, Im in turn."""
        return np.stack([part.real, part.imag], axis=-1).reshape(modes, -1)

    def from_modes(first: int) -> Array:
        """(modes, 8): four rows from Re, then from Im."""
        return rows(first, 2 * PADS).transpose(0, 2, 1).reshape(modes, -1)

    rotation, fine_rotation = as_complex(rows(c.rotation)), as_complex(rows(c.fine_rotation))
    fine_start, fine_end = as_complex(rows(c.fine_start, PADS)), as_complex(rows(c.fine_end, PADS))
    history = as_complex(rows(c.history, DEPTH * PADS))
    history[:, :PADS] -= fine_end
    late = np.stack([history.real, history.imag], axis=1)  # (modes, 2, DEPTH * PADS)
    main = [flat(rotation), flat(as_complex(rows(c.drive, PADS))), from_modes(c.ahead)]
    fine = [flat(fine_rotation), flat(fine_rotation * fine_end + fine_start), from_modes(c.contact)]
    hold: Complex = fine_start + fine_end
    fine_hold = np.stack([hold.real, hold.imag], axis=1)  # (modes, 2, PADS)
    parts = [
        np.hstack(main),
        flat(as_complex(rows(c.hold, PADS))),
        np.hstack(fine),
        fine_hold,
        late,
        c.ahead_history.transpose(1, 2, 0),
        c.ahead_hold.T,
        c.fine_end_contact,
        c.share,
        np.array([c.mu_ref]),
    ]
    for o in range(len(c.output_direct)):
        effect = c.output_history[o].copy()
        effect[0] += c.output_direct[o]
        parts += [rows(c.output + o), effect, c.output_direct[o]]
    return np.concatenate([part.ravel() for part in parts])


def aligned(shape: tuple[int, ...]) -> Array:
    """Zeros that begin at a cache line."""
    size = int(np.prod(shape))
    line = _LINE // 8
    buffer = np.zeros(size + line)
    start = -(buffer.ctypes.data // 8) % line
    return buffer[start : start + size].reshape(shape)
