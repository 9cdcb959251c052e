"""The brake file (TOML) as frozen, validated data: parameters, bodies, points, coupling tables g and h.

Topology is data: bodies, connecting points and couplings may be added or removed by editing the file only.
Refused with place, value and remedy: unknown keys, parameters that are unknown, not finite, never used or of
the wrong unit for their use, masses that are not positive, couplings to unknown points, points that no
coupling uses (a coupling is missing), pads whose contacts do not carry the whole pad force, parameter groups
with unknown members.
NOT its job: mechanics (`assembly`), or turning pydantic's error into one line for the user (`rigctl.config`).
"""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from sim_hardware.brake_model.expressions import UNITS, Dimension, Quantity, evaluate, refuse, unit_name

Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$")]
ParameterName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,39}$")]
Expression = Annotated[str, Field(min_length=1)]
Freedom = Literal["x", "y", "phi"]

_SHARE_TOLERANCE = 1e-9
_CUBIC = ("cubic", "cubic_x", "cubic_y")
#: names by which studies call the operating point
_RESERVED = {"mu", "slope", "pressure", "piston_area"}
_PLACES = "name a parameter or a place such as piston_l.stiffness_y, inner_pad.piston_l.x, disc.mass"


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Parameter(_Frozen):
    """One number of the brake: value in SI, its unit, and where the value comes from."""

    value: float
    unit: str
    origin: Annotated[str, Field(min_length=1)]

    @model_validator(mode="after")
    def _known_unit(self) -> Self:
        if self.unit not in UNITS:
            raise refuse(
                f"unknown unit '{self.unit}'",
                place="unit",
                value=self.unit,
                remedy=f"give the value in one of: {', '.join(UNITS)}",
            )
        return self

    @property
    def quantity(self) -> Quantity:
        """Value with dimension."""
        return Quantity(self.value, UNITS[self.unit])


class Operating(_Frozen):
    """The working point the brake is judged at unless the caller says otherwise."""

    mu: Parameter
    slope: Parameter
    piston_area: Parameter
    effective_radius: Parameter

    @model_validator(mode="after")
    def _units_and_signs(self) -> Self:
        for key, unit, positive in (
            ("mu", "1", False),
            ("slope", "s/m", False),
            ("piston_area", "m2", True),
            ("effective_radius", "m", True),
        ):
            parameter: Parameter = getattr(self, key)
            _expect(parameter.quantity, unit, place=key, sign="positive" if positive else "not negative")
        return self


class Body(_Frozen):
    """A rigid body; no freedoms: it is at rest (the inertial frame)."""

    name: Name
    freedoms: tuple[Freedom, ...] = ()
    mass: Expression | None = None
    inertia: Expression | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if len(set(self.freedoms)) != len(self.freedoms):
            raise refuse(
                "a freedom is named twice", place="freedoms", value=self.freedoms, remedy="name it once"
            )
        for key, needed in (("mass", {"x", "y"}), ("inertia", {"phi"})):
            given, moves = getattr(self, key) is not None, bool(needed & set(self.freedoms))
            if given != moves:
                names = " or ".join(sorted(needed))
                raise refuse(
                    f"body '{self.name}' has {'a' if given else 'no'} {key} {'but no' if given else 'but a'}"
                    f" freedom {names}",
                    place=key,
                    value=getattr(self, key),
                    remedy=f"give {key} exactly where the body moves in {names}",
                )
        return self


class Point(_Frozen):
    """A connecting point of a body, from its centre of mass (x tangential, y normal to the disc)."""

    body: Name
    name: Name
    x: Expression
    y: Expression

    @property
    def key(self) -> str:
        """How couplings name the point: "body.point"."""
        return f"{self.body}.{self.name}"


class Spring(_Frozen):
    """Entry of table g: spring and damper along x and y between two points (eq 16).

    `angle` turns the element's axes from x towards y (rad); without it they are those of the brake.
    `cubic_x`, `cubic_y` (N/m3) harden the spring: F = c u + c3 u^3 (section 4.4), u counted from the steadily
    sliding state, where c is the tangent.
    """

    kind: Literal["spring"]
    name: Name
    between: tuple[str, str]
    stiffness_x: Expression | None = None
    stiffness_y: Expression | None = None
    damping_x: Expression | None = None
    damping_y: Expression | None = None
    cubic_x: Expression | None = None
    cubic_y: Expression | None = None
    angle: Expression | None = None

    @model_validator(mode="after")
    def _acts(self) -> Self:
        if self.stiffness_x is None and self.stiffness_y is None:
            raise refuse(
                f"coupling '{self.name}' has no stiffness",
                place="stiffness_x, stiffness_y",
                value=None,
                remedy="give at least one of them, or remove the coupling",
            )
        for axis in ("x", "y"):
            if getattr(self, f"cubic_{axis}") is not None and getattr(self, f"stiffness_{axis}") is None:
                raise refuse(
                    f"coupling '{self.name}' has cubic_{axis} without stiffness_{axis}",
                    place=f"cubic_{axis}",
                    value=getattr(self, f"cubic_{axis}"),
                    remedy=f"give stiffness_{axis} too: the cubic part hardens a spring, it is none itself",
                )
        return self


class Contact(_Frozen):
    """Entry of table g: friction contact of a pad (first) with the disc (second), normal along y, friction
    along x.

    `side` is +1 where +y presses the pad on the disc (inner pad), -1 where -y does (outer pad); `load_share`
    is the part of the pad's normal force p A that this contact point carries. `pad` names the pad whose force
    it shares, the first point's body where not given: the halves of a pad split into two bodies name one pad.
    `cubic` (N/m3) hardens the normal spring as in `Spring`; `one_sided = true`: it cannot pull, the whole
    normal force is max(0, load_share p A + variation).
    """

    kind: Literal["contact"]
    name: Name
    between: tuple[str, str]
    side: Literal[1, -1]
    load_share: Annotated[float, Field(gt=0.0, le=1.0)]
    stiffness: Expression
    damping: Expression | None = None
    cubic: Expression | None = None
    one_sided: bool = False
    pad: Name | None = None

    @property
    def pad_name(self) -> str:
        """The pad whose normal force the contact shares."""
        return self.pad if self.pad is not None else self.between[0].split(".")[0]


class Torsion(_Frozen):
    """Entry of table h: torsional spring and damper between two bodies (eq 17).

    `cubic` (N m/rad3) hardens the spring: M = c phi + c3 phi^3.
    """

    name: Name
    between: tuple[Name, Name]
    stiffness: Expression
    damping: Expression | None = None
    cubic: Expression | None = None


class Group(_Frozen):
    """Quantities that an engineer changes together (section 4.3.2): parameters, or places of expressions such
    as "piston_l.stiffness_y", "inner_pad.piston_l.x", "disc.mass".

    `leading` and `trailing` members can be changed in opposite directions too; `both` have no side.
    """

    name: Name
    title: Annotated[str, Field(min_length=1)]
    leading: tuple[str, ...] = ()
    trailing: tuple[str, ...] = ()
    both: tuple[str, ...] = ()

    @model_validator(mode="after")
    def _members(self) -> Self:
        members = (*self.leading, *self.trailing, *self.both)
        _unique(f"groups '{self.name}'", members)
        if not members or bool(self.leading) != bool(self.trailing):
            raise refuse(
                f"group '{self.name}' has {'members on one side only' if members else 'no members'}",
                place=f"groups '{self.name}'",
                value=members,
                remedy="name members in `both`, or in `leading` and `trailing`",
            )
        return self


class BrakeSpec(_Frozen):
    """A whole brake file. See the module docstring for what is refused."""

    name: Name
    description: Annotated[str, Field(min_length=1)]
    operating: Operating
    parameters: dict[ParameterName, Parameter]
    bodies: tuple[Body, ...]
    points: tuple[Point, ...]
    couplings: tuple[Annotated[Spring | Contact, Field(discriminator="kind")], ...]
    torsions: tuple[Torsion, ...] = ()
    groups: tuple[Group, ...] = ()

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        _unique("bodies", (body.name for body in self.bodies))
        _unique("points", (point.key for point in self.points))
        _unique("couplings and torsions", (c.name for c in (*self.couplings, *self.torsions)))
        self._check_bodies_and_points()
        self._check_quantities()
        self._check_pads()
        self._check_groups()
        return self

    def evaluated(self) -> dict[str, float]:
        """Value (SI) of every expression in the file by its place, for example "points 'disc.hub': x"."""
        quantities = self.quantities
        return {place: evaluate(text, quantities, place=place).value for place, text, _, _ in self.uses()}

    @property
    def quantities(self) -> dict[str, Quantity]:
        """Every parameter with its dimension."""
        return {name: parameter.quantity for name, parameter in self.parameters.items()}

    def with_values(self, changes: dict[str, float]) -> BrakeSpec:
        """Return the same brake with other parameter values, validated again."""
        unknown = sorted(set(changes) - set(self.parameters))
        if unknown:
            raise KeyError(
                f"unknown parameter {unknown[0]!r}; the brake has: {', '.join(sorted(self.parameters))}"
            )
        data = self.model_dump()
        for name, value in changes.items():
            data["parameters"][name]["value"] = float(value)
        return BrakeSpec.model_validate(data)

    def _check_bodies_and_points(self) -> None:
        bodies = {body.name for body in self.bodies}
        for point in self.points:
            if point.body not in bodies:
                raise _unknown("body", point.body, f"points '{point.key}': body", bodies)
        keys = {point.key for point in self.points}
        used: set[str] = set()
        for coupling in self.couplings:
            for end in coupling.between:
                if end not in keys:
                    raise _unknown("point", end, f"couplings '{coupling.name}': between", keys)
            used.update(coupling.between)
            _different_bodies(coupling.name, *(end.split(".")[0] for end in coupling.between))
        for torsion in self.torsions:
            for end in torsion.between:
                if end not in bodies:
                    raise _unknown("body", end, f"torsions '{torsion.name}': between", bodies)
            _different_bodies(torsion.name, *torsion.between)
        for key in sorted(keys - used):
            raise refuse(
                f"no coupling uses the point '{key}'",
                place=f"points '{key}'",
                value=key,
                remedy="a coupling is missing: add it to [[couplings]], or remove the point",
            )

    def uses(self) -> Iterator[tuple[str, str, str | None, str]]:
        """Yield (place, expression, sign or None, unit) of every expression of the file."""
        for body in self.bodies:
            yield from _given(f"bodies '{body.name}'", "positive", {"mass": "kg", "inertia": "kg m2"}, body)
        for point in self.points:
            yield from _given(f"points '{point.key}'", None, {"x": "m", "y": "m"}, point)
        for coupling in self.couplings:
            place = f"couplings '{coupling.name}'"
            stiffness = {key: "N/m" for key in ("stiffness", "stiffness_x", "stiffness_y")}
            damping = {key: "N s/m" for key in ("damping", "damping_x", "damping_y")}
            yield from _given(place, "positive", stiffness, coupling)
            yield from _given(place, "not negative", damping, coupling)
            yield from _given(place, "not negative", dict.fromkeys(_CUBIC, "N/m3"), coupling)
            yield from _given(place, None, {"angle": "rad"}, coupling)
        for torsion in self.torsions:
            place = f"torsions '{torsion.name}'"
            yield from _given(place, "positive", {"stiffness": "N m/rad"}, torsion)
            yield from _given(place, "not negative", {"damping": "N m s/rad"}, torsion)
            yield from _given(place, "not negative", {"cubic": "N m/rad3"}, torsion)

    def _check_quantities(self) -> None:
        for name in sorted(set(self.parameters) & _RESERVED):
            raise refuse(
                f"the name '{name}' is taken by the operating point",
                place=f"parameters.{name}",
                value=self.parameters[name].value,
                remedy="choose another name",
            )
        quantities = _Recording(self.quantities)
        for place, text, sign, unit in self.uses():
            _expect(evaluate(text, quantities, place=place), unit, place=place, sign=sign, text=text)
        for name in sorted(set(self.parameters) - quantities.used):
            raise refuse(
                f"parameter '{name}' is used nowhere",
                place=f"parameters.{name}",
                value=self.parameters[name].value,
                remedy="use it in a body, point or coupling, or remove it: changing it would do nothing",
            )

    def _check_groups(self) -> None:
        _unique("groups", (group.name for group in self.groups))
        known = {*(place_name(place) for place, *_ in self.uses()), *self.parameters}
        for group in self.groups:
            for member in (*group.leading, *group.trailing, *group.both):
                if member not in known:
                    near = get_close_matches(member, known, n=3)
                    raise refuse(
                        f"unknown quantity '{member}'",
                        place=f"groups '{group.name}'",
                        value=member,
                        remedy=f"did you mean {', '.join(near)}?" if near else _PLACES,
                    )

    def _check_pads(self) -> None:
        shares: dict[str, float] = {}
        for coupling in self.couplings:
            if isinstance(coupling, Contact):
                shares[coupling.pad_name] = shares.get(coupling.pad_name, 0.0) + coupling.load_share
        if not shares:
            raise refuse(
                "the brake has no friction contact",
                place="couplings",
                value=0,
                remedy='add a coupling of kind = "contact" between a pad and the disc',
            )
        for pad, share in shares.items():
            if abs(share - 1.0) > _SHARE_TOLERANCE:
                raise refuse(
                    f"the contacts of '{pad}' carry {share:g} of the pad force instead of 1",
                    place="couplings: load_share",
                    value=share,
                    remedy="a contact is missing or a load_share is wrong: those of a pad must add up to 1; "
                    'contacts of several bodies that share one pad force (a split pad) name it: pad = "…"',
                )


class _Recording(dict[str, Quantity]):
    """Quantities that remember which of them were read."""

    def __init__(self, quantities: dict[str, Quantity]) -> None:
        super().__init__(quantities)
        self.used: set[str] = set()

    def __getitem__(self, name: str) -> Quantity:
        self.used.add(name)
        return super().__getitem__(name)


def load_spec(path: str | Path) -> BrakeSpec:
    """Read a brake file.

    Raises
    ------
    OSError, tomllib.TOMLDecodeError, pydantic.ValidationError
        not readable, not TOML, refused
    """
    with Path(path).open("rb") as file:
        return BrakeSpec.model_validate(tomllib.load(file))


def place_name(place: str) -> str:
    """Short name of a place: "couplings 'piston_l': stiffness_y" -> "piston_l.stiffness_y"."""
    owner, key = place.rsplit(": ", 1)
    return f"{owner.split(chr(39))[1]}.{key}"


def _given(
    place: str, sign: str | None, keys: dict[str, str], owner: BaseModel
) -> Iterator[tuple[str, str, str | None, str]]:
    for key, unit in keys.items():
        text = getattr(owner, key, None)
        if text is not None:
            yield f"{place}: {key}", text, sign, unit


def _expect(quantity: Quantity, unit: str, *, place: str, sign: str | None, text: str = "") -> None:
    expected: Dimension = UNITS[unit]
    shown = f"'{text}' " if text else ""
    if text.strip() == "0" and sign is None:
        return  # zero needs no unit
    if quantity.dimension != expected:
        raise refuse(
            f"{shown}has the unit {unit_name(quantity.dimension)} where {unit} is needed",
            place=place,
            value=unit_name(quantity.dimension),
            remedy=f"name a parameter in {unit}, or correct its unit",
        )
    bad = (sign == "positive" and quantity.value <= 0.0) or (sign == "not negative" and quantity.value < 0.0)
    if bad:
        raise refuse(
            f"{shown}is {quantity.value:g} {unit} and must be {sign}",
            place=place,
            value=quantity.value,
            remedy="correct the value or its sign",
        )


def _unique(place: str, names: Iterable[str]) -> None:
    for name, count in Counter(names).items():
        if count > 1:
            raise refuse(
                f"'{name}' is given {count} times", place=place, value=name, remedy="give each its own name"
            )


def _unknown(what: str, name: str, place: str, known: Iterable[str]) -> Exception:
    return refuse(
        f"unknown {what} '{name}'",
        place=place,
        value=name,
        remedy=f"add the {what} or use one of: {', '.join(sorted(known))}",
    )


def _different_bodies(name: str, first: str, second: str) -> None:
    if first == second:
        raise refuse(
            f"couples the body '{first}' with itself",
            place=f"'{name}': between",
            value=first,
            remedy="name points of two different bodies",
        )
