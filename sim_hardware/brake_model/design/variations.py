"""Design modifications: parameter groups changed by the same share, in the same or in opposite directions
(4.3.2).

A variation multiplies every member of a group by a factor: all up or all down (symmetric), leading up and
trailing down (clockwise), or the reverse (counter-clockwise). Points of connection are members by their
coordinates: one factor for both sides changes their distance, opposite factors shift both towards one edge.
NOT its job: solving the varied model (`resolving`), judging it (`robustness`, `effects`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from sim_hardware.brake_model.linear import Kind, LinearModel, ParameterGroup, value_of

Mode = Literal["increase", "decrease", "clockwise", "counter-clockwise"]
MODES: tuple[Mode, ...] = ("increase", "decrease", "clockwise", "counter-clockwise")
SYMMETRIC: tuple[Mode, ...] = ("increase", "decrease")
ASYMMETRIC: tuple[Mode, ...] = ("clockwise", "counter-clockwise")

_SIGNS: dict[Mode, tuple[int, int, int]] = {  # leading, trailing, both
    "increase": (1, 1, 1),
    "decrease": (-1, -1, -1),
    "clockwise": (1, -1, 0),
    "counter-clockwise": (-1, 1, 0),
}


@dataclass(frozen=True, slots=True)
class Variation:
    """One design modification.

    Attributes
    ----------
    name : "piston_position:clockwise"
    title : for people, "Piston: positions, leading −10 %, trailing +10 %"
    group, group_title, kind : of the group changed
    mode : how
    factors : quantity -> what it is multiplied with
    """

    name: str
    title: str
    group: str
    mode: Mode
    factors: Mapping[str, float] = field(hash=False)
    group_title: str = ""
    kind: Kind = "other"

    @property
    def symmetric(self) -> bool:
        """Whether all members change in the same direction."""
        return self.mode in SYMMETRIC

    def values(self, model: LinearModel, base: Mapping[str, float] | None = None) -> dict[str, float]:
        """Values of a model under this modification: `base` (other values, working point) with the members
        changed.

        Raises
        ------
        KeyError
            the model lacks a member
        """
        changed = {name: factor * value_of(model, name, base) for name, factor in self.factors.items()}
        return {**(base or {}), **changed}


def variation(group: ParameterGroup, mode: Mode, step: float = 0.10) -> Variation:
    """The modification of a group by a share `step` (0.10: 10 %).

    Raises
    ------
    ValueError
        step not between 0 and 1, unknown mode, or an asymmetric mode for a group without sides
    """
    if not 0.0 < step < 1.0:
        raise ValueError(f"step = {step!r}: give a share between 0 and 1, such as 0.1 for 10 %")
    if mode not in _SIGNS:
        raise ValueError(f"unknown mode of variation {mode!r}; there are: {', '.join(MODES)}")
    if mode in ASYMMETRIC and not group.has_sides:
        raise ValueError(
            f"the group '{group.name}' has no leading and trailing side: it varies symmetrically only"
        )
    leading, trailing, both = _SIGNS[mode]
    factors = {name: 1.0 + leading * step for name in group.leading}
    factors |= {name: 1.0 + trailing * step for name in group.trailing}
    if both:
        factors |= {name: 1.0 + both * step for name in group.both}
    return Variation(
        f"{group.name}:{mode}", f"{group.title}, {_how(group, mode, step)}", group.name, mode, factors,
        group.title, group.kind,
    )  # fmt: skip


def all_variations(
    model: LinearModel,
    step: float = 0.10,
    *,
    groups: Iterable[str] | None = None,
    modes: Iterable[Mode] = MODES,
) -> tuple[Variation, ...]:
    """Every modification of a model's groups in every mode that makes sense for it.

    Parameters
    ----------
    step : share by which members change
    groups : names of groups; all where None
    modes : asymmetric ones are left out for groups without sides

    Raises
    ------
    KeyError
        unknown group
    ValueError
        step not between 0 and 1
    """
    chosen = model.groups if groups is None else tuple(group_of(model, name) for name in groups)
    wanted = tuple(modes)
    return tuple(
        variation(group, mode, step)
        for group in chosen
        for mode in wanted
        if mode in SYMMETRIC or group.has_sides
    )


def group_of(model: LinearModel, name: str) -> ParameterGroup:
    """The group of that name.

    Raises
    ------
    KeyError
        unknown; the message lists the groups
    """
    for group in model.groups:
        if group.name == name:
            return group
    known = ", ".join(group.name for group in model.groups) or "none: add [[groups]] to its file"
    raise KeyError(f"the model '{model.name}' has no group {name!r}; it has: {known}")


def groups_like(model: LinearModel, prefix: str) -> tuple[ParameterGroup, ...]:
    """The group of that name, or all groups whose names begin with it: "piston" gives all of the piston.

    Raises
    ------
    KeyError
        none; the message lists the groups
    """
    found = tuple(g for g in model.groups if g.name == prefix or g.name.startswith(f"{prefix}_"))
    return found or (group_of(model, prefix),)


def _how(group: ParameterGroup, mode: Mode, step: float) -> str:
    percent = f"{100.0 * step:g} %"
    positions = group.kind == "geometry" and group.has_sides
    match mode:
        case "increase":
            return f"{percent} further apart" if positions else f"+{percent}"
        case "decrease":
            return f"{percent} closer together" if positions else f"−{percent}"
        case "clockwise":
            return (
                f"shifted {percent} to the leading edge"
                if positions
                else f"leading +{percent}, trailing −{percent}"
            )
        case _:
            return (
                f"shifted {percent} to the trailing edge"
                if positions
                else f"leading −{percent}, trailing +{percent}"
            )
