"""A model as tables: bodies, coupling tables g and h, quantities that studies may change, parameter groups.

NOT its job: any computation beyond the matrices' sizes.
"""

from __future__ import annotations

from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.linear import LinearModel
from sim_hardware.brake_model.parametric import LinearBrake


def describe(model: LinearModel) -> Study:
    """What the model consists of, and the names by which studies call its quantities."""
    tables = [_quantities(model), _groups(model), _members(model)]
    facts = {
        "degrees_of_freedom": len(model.freedoms),
        "quantities": len(model.quantities),
        "parameter_groups": len(model.groups),
    }
    if isinstance(model, LinearBrake):
        brake = model.brake
        facts = {
            "description": brake.spec.description,
            "bodies": len(brake.spec.bodies),
            "coupling_elements": len(brake.spec.couplings) + len(brake.spec.torsions),
            "friction_contacts": len(brake.contacts),
        } | facts
        tables = [_bodies(brake), _couplings(brake), *tables]
    return Study("model", f"{model.name}: what it consists of", facts, tuple(tables))


def _bodies(brake: Brake) -> Table:
    inertia = dict(zip(brake.freedoms, brake.inertia.tolist(), strict=True))
    bodies = brake.spec.bodies
    mass = [inertia.get(f"{b.name}.x", inertia.get(f"{b.name}.y")) for b in bodies]
    return Table(
        "bodies",
        "Bodies",
        (
            Column("body", "", [b.name for b in bodies]),
            Column("freedoms", "", [" ".join(b.freedoms) or "at rest" for b in bodies]),
            Column("mass", "kg", mass),
            Column("moment_of_inertia", "kg m2", [inertia.get(f"{b.name}.phi") for b in bodies]),
        ),
    )


def _couplings(brake: Brake) -> Table:
    rows = [
        (c.name, "g", c.kind, " – ".join(c.between), *e.stiffness_n_m, *e.damping_ns_m)
        for c, e in zip(brake.spec.couplings, brake.elements, strict=True)
    ]
    rows += [
        (c.name, "h", "torsion", " – ".join(c.between), None, e.stiffness_nm_rad, None, e.damping_nms_rad)
        for c, e in zip(brake.spec.torsions, brake.torsions, strict=True)
    ]
    heads = (
        ("coupling", ""), ("table", ""), ("kind", ""), ("between", ""),
        ("stiffness_x", "N/m"), ("stiffness_y", "N/m, N m"),
        ("damping_x", "N s/m"), ("damping_y", "N s/m, N m s"),
    )  # fmt: skip
    columns = [Column(name, unit, [row[i] for row in rows]) for i, (name, unit) in enumerate(heads)]
    return Table("couplings", "Coupling elements: table g (forces), table h (torques)", tuple(columns))


def _quantities(model: LinearModel) -> Table:
    quantities = list(model.quantities.values())
    return Table(
        "quantities",
        "Quantities that studies may change",
        (
            Column("quantity", "", [q.name for q in quantities]),
            Column("value", "", [q.value for q in quantities]),
            Column("unit", "", [q.unit for q in quantities]),
            Column("kind", "", [q.kind for q in quantities]),
        ),
    )


def _groups(model: LinearModel) -> Table:
    groups = model.groups
    return Table(
        "groups",
        "Parameter groups",
        (
            Column("group", "", [g.name for g in groups]),
            Column("title", "", [g.title for g in groups]),
            Column("kind", "", [g.kind for g in groups]),
            Column("members", "", [len(g.members) for g in groups]),
            Column("leading_and_trailing", "", [g.has_sides for g in groups]),
        ),
    )


def _members(model: LinearModel) -> Table:
    rows = [
        (group.name, side, member)
        for group in model.groups
        for side, members in (("leading", group.leading), ("trailing", group.trailing), ("both", group.both))
        for member in members
    ]
    heads = ("group", "side", "quantity")
    columns = tuple(Column(name, "", [row[i] for row in rows]) for i, name in enumerate(heads))
    return Table("members", "Members of the parameter groups", columns)
