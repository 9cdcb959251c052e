"""Named outputs of the time integrator as rows over state and friction inputs.

    "disc.y"                          acceleration of a degree of freedom (m/s2, rad/s2); also
    "disc.y:acceleration" "disc.y:velocity", ":displacement"  m/s, m (rad/s, rad), from the steadily sliding
    state "piston_l:force_x", ":force_y"    force of a coupling element on its second body (N), deviation from
    the mean;
                                      at a contact only force_y (friction is one scalar per pad)
    "inner_pad:friction", ":normal"   friction force on the pad along x, compression force (N), deviation from
    the mean "inner_pad:slip"                  pad minus disc velocity along x (m/s)

NOT its job: time integration, sound.
"""

from __future__ import annotations

import numpy as np

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.time_domain.modal import ModalSystem


def output_rows(brake: Brake, system: ModalSystem, names: tuple[str, ...]) -> tuple[Array, Array]:
    """Rows of the named outputs: y = C state + D (g + excitation).

    Returns
    -------
    state_rows : (n_outputs, 2 n_dof) C
    input_rows : (n_outputs, n_groups) D

    Raises
    ------
    KeyError
        unknown output; the message says what there is
    """
    state = np.zeros((len(names), 2 * brake.n_dof))
    direct = np.zeros((len(names), len(system.groups)))
    for index, name in enumerate(names):
        state[index], direct[index] = _row(brake, system, name)
    return state, direct


def _row(brake: Brake, system: ModalSystem, name: str) -> tuple[Array, Array]:  # noqa: PLR0911 (one per kind)
    what, _, quantity = name.partition(":")
    n = brake.n_dof
    none = np.zeros(len(system.groups))
    if what in brake.freedoms:
        unit, i = np.eye(2 * n), brake.freedom_index(what)
        match quantity or "acceleration":
            case "acceleration":
                return system.state_matrix[n + i], system.input_matrix[n + i]
            case "velocity":
                return unit[n + i], none
            case "displacement":
                return unit[i], none
    for element in brake.elements:
        if element.name == what and (quantity == "force_y" or (quantity == "force_x" and not element.side)):
            axis = 1 if quantity == "force_y" else 0
            row = (element.row_x, element.row_y)[axis]
            return np.concatenate([element.stiffness_n_m[axis] * row, element.damping_ns_m[axis] * row]), none
    members = [i for i, group in enumerate(system.groups) if group.pad == what]
    if members and quantity in ("friction", "normal", "slip"):
        if quantity == "slip":
            return system.contact_rows[2 * members[0]], none
        normal = system.contact_rows[[2 * i + 1 for i in members]].sum(axis=0)
        if quantity == "normal":
            return normal, none
        return system.mu_ref * normal, np.isin(np.arange(len(none)), members).astype(float)
    pads = sorted({group.pad for group in system.groups})
    raise KeyError(
        f"unknown output {name!r}; use a degree of freedom ({', '.join(brake.freedoms)}) with "
        ":acceleration, :velocity or :displacement, a coupling "
        f"({', '.join(e.name for e in brake.elements)}) with :force_x or :force_y (contacts: :force_y), "
        f"or a pad ({', '.join(pads)}) with :friction, :normal or :slip"
    )
