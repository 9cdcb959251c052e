"""Writer of small brake files for tests: bodies, points and couplings in a few lines.

NOT its job: any check.
"""

OPERATING = """
name = "small"
description = "a test"
[operating]
mu = { value = 0.4, unit = "1", origin = "test" }
slope = { value = 0.05, unit = "s/m", origin = "test" }
piston_area = { value = 2e-3, unit = "m2", origin = "test" }
effective_radius = { value = 0.1, unit = "m", origin = "test" }
"""
UNITS = {
    "m_": "kg",
    "J_": "kg m2",
    "c_": "N/m",
    "d_": "N s/m",
    "r_": "m",
    "t_": "N m/rad",
    "e_": "N m s/rad",
    "a_": "rad",
}
CONTACT = (
    "contact",
    "pad.face",
    "disc.face",
    {"side": 1, "load_share": 1.0, "stiffness": "c_n", "damping": "d_n"},
)


def brake_text(
    numbers: dict[str, float],
    bodies: dict[str, str],
    points: dict[str, tuple[str, str]],
    couplings: list[tuple[str, str, str, dict]],
    torsions: list[tuple[str, str, dict]] = [],  # noqa: B006
) -> str:
    """A brake file; parameters get units by their first letters."""

    def table(entries: dict) -> str:
        return "\n".join(
            f"{k} = {v!r}" if isinstance(v, int | float) else f'{k} = "{v}"' for k, v in entries.items()
        )

    lines = [OPERATING, "[parameters]"]
    lines += [
        f'{n} = {{ value = {v!r}, unit = "{UNITS[n[:2]]}", origin = "test" }}' for n, v in numbers.items()
    ]
    for name, freedoms in bodies.items():
        listed = [{"x": "x", "y": "y", "p": "phi"}[f] for f in freedoms]
        lines.append(f'[[bodies]]\nname = "{name}"\nfreedoms = {listed!r}')
        lines += [f'mass = "m_{name}"'] * bool({"x", "y"} & set(listed)) + [f'inertia = "J_{name}"'] * (
            "phi" in listed
        )
    for key, (x, y) in points.items():
        body, name = key.split(".")
        lines.append(f'[[points]]\nbody = "{body}"\nname = "{name}"\nx = "{x}"\ny = "{y}"')
    for i, (kind, first, second, entries) in enumerate(couplings):
        head = f'[[couplings]]\nkind = "{kind}"\nname = "k{i}"\nbetween = ["{first}", "{second}"]\n'
        lines.append(head + table(entries))
    for i, (first, second, entries) in enumerate(torsions):
        lines.append(f'[[torsions]]\nname = "t{i}"\nbetween = ["{first}", "{second}"]\n' + table(entries))
    return "\n".join(lines)
