"""What the paper's claims on sensitivity are judged by: one evaluation of a brake and all its modifications.

Job: `Claim`, `Evidence`, words for families of groups, measures that several claims share. NOT its job: the
claims (`claims_robustness`, `claims_influence`), their table (`claims`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rigctl.model.sensitivity_tables import BELOW_HZ
from sim_hardware.brake_model.design.effects import Effect, Influence, influence_of, one_of_each_pair
from sim_hardware.brake_model.design.robustness import Robustness, robustness
from sim_hardware.brake_model.design.variations import Mode, Variation, all_variations
from sim_hardware.brake_model.linear import LinearModel

Array = NDArray[np.float64]
Verdict = Literal["holds", "holds in part", "does not hold", "cannot be tested"]
VERDICTS: tuple[Verdict, ...] = ("holds", "holds in part", "does not hold", "cannot be tested")

STEP = 0.10
MU_LOW, MU_HIGH = 0.4, 0.6
#: a group has influence on robustness when a modification changes the maximum by more than this share of it
INFLUENCE = 0.01
#: a group is important when it ranks within this share of all groups
IMPORTANT = 0.25
#: groups near the friction contact by the beginnings of their names, as the shipped brake files name them
PAD = ("contact", "pad", "lining", "backplate")
BACKPLATE = ("piston", "finger")
ABUTMENT = ("abutment",)
NEAR_CONTACT = (*PAD, *BACKPLATE, *ABUTMENT)


class Untestable(Exception):
    """The model lacks the groups of parameters that a claim speaks of; the message says which."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A statement of the paper, tested.

    Attributes
    ----------
    key : "pad", stable name
    section : of the paper
    text : the statement, in the paper's sense
    measure : what was measured, and when the verdict is "holds"
    numbers : what came out
    """

    key: str
    section: str
    text: str
    measure: str
    numbers: Mapping[str, Any]
    verdict: Verdict
    remark: str = ""


@dataclass(frozen=True)
class Evidence:
    """A brake, all its modifications by 10 %, their robustness from mu 0.4 to 0.6 and influence at 0.4."""

    model: LinearModel
    robust: Robustness
    influence: Influence

    @classmethod
    def of(cls, model: LinearModel, values: Mapping[str, float] | None = None) -> Evidence:
        """Evaluate a model.

        Raises
        ------
        KeyError
            the model has no friction
        """
        found = robustness(model, all_variations(model, STEP), values, low=MU_LOW, high=MU_HIGH)
        return cls(model, found, influence_of(found.resolved))

    @property
    def variations(self) -> tuple[Variation, ...]:
        """All modifications."""
        return self.robust.variations

    @cached_property
    def kept(self) -> NDArray[np.intp]:
        """One eigenvalue of each pair."""
        return one_of_each_pair(self.robust.resolved.nominal[0])

    @cached_property
    def frequencies_hz(self) -> Array:
        """Of `kept`."""
        return self.robust.frequencies_hz[self.kept]

    @cached_property
    def changes(self) -> Array:
        """(v, n) Delta Re at mu = 0.4, one of each pair, 1/s."""
        return self.influence.changes[:, self.kept]

    @cached_property
    def real_parts(self) -> Array:
        """(n,) of the basic design at mu = 0.4."""
        return self.robust.resolved.nominal[0, self.kept].real

    @cached_property
    def groups(self) -> tuple[str, ...]:
        """Names of all groups that were modified."""
        return tuple(dict.fromkeys(v.group for v in self.variations))

    @cached_property
    def low(self) -> NDArray[np.bool_]:
        """(n,) below 5 kHz."""
        return self.frequencies_hz < BELOW_HZ

    def index(self, group: str, mode: Mode) -> int:
        """Number of a modification.

        Raises
        ------
        Untestable
            there is no such group, or it has no sides
        """
        for i, v in enumerate(self.variations):
            if v.group == group and v.mode == mode:
                return i
        raise Untestable(f"the file has no group '{group}' that can be changed like this ({mode})")

    def effect(self, group: str, mode: Mode) -> tuple[Effect, Array]:
        """Effect of a modification and its changes, one of each pair."""
        i = self.index(group, mode)
        return self.influence.effects[i], self.changes[i]

    def named(self, *beginnings: str) -> tuple[str, ...]:
        """Groups whose names begin with one of some words.

        Raises
        ------
        Untestable
            there is none
        """
        found = tuple(g for g in self.groups if any(g == b or g.startswith(f"{b}_") for b in beginnings))
        if not found:
            raise Untestable(f"the file has no groups named {' or '.join(f'{b}_…' for b in beginnings)}")
        return found

    def of_kind(self, kind: str, ending: str = "") -> tuple[str, ...]:
        """Groups of a kind of quantity, whose names end in a word.

        Raises
        ------
        Untestable
            there is none
        """
        found = tuple(
            dict.fromkeys(v.group for v in self.variations if v.kind == kind and v.group.endswith(ending))
        )
        if not found:
            raise Untestable(
                f"the file has no groups of kind {kind}" + (f" named …{ending}" if ending else "")
            )
        return found

    def members(self, group: str) -> list[int]:
        """Numbers of a group's modifications."""
        return [i for i, v in enumerate(self.variations) if v.group == group]

    @cached_property
    def robust_weight(self) -> dict[str, float]:
        """Largest |maximum of eq 25 minus that of the basic design| of each group, 1/s."""
        return {g: float(np.abs(self.robust.deviations[self.members(g)]).max()) for g in self.groups}

    @cached_property
    def robust_weight_low(self) -> dict[str, float]:
        """The same over the eigenvalues below 5 kHz alone."""
        below = self.robust.frequencies_hz < BELOW_HZ
        if not below.any():
            return dict.fromkeys(self.groups, 0.0)
        change = np.abs(self.robust.maxima_below(BELOW_HZ) - self.robust.basic[below].max())
        return {g: float(change[self.members(g)].max()) for g in self.groups}

    @cached_property
    def influence_weight(self) -> dict[str, float]:
        """Largest |Delta Re| of each group at mu = 0.4, 1/s."""
        return {g: float(np.abs(self.changes[self.members(g)]).max()) for g in self.groups}

    @cached_property
    def influence_weight_low(self) -> dict[str, float]:
        """The same below 5 kHz."""
        part = self.changes[:, self.low]
        return {g: float(np.abs(part[self.members(g)]).max(initial=0.0)) for g in self.groups}


def best_rank(weights: Mapping[str, float], family: Sequence[str]) -> tuple[int, str]:
    """Rank (1: strongest) and name of the strongest group of a family."""
    order = sorted(weights, key=lambda g: -weights[g])
    best = min(family, key=order.index)
    return order.index(best) + 1, best


def rank_verdict(rank: int, count: int) -> Verdict:
    """Holds within the first quarter of all groups, in part within the first half."""
    if rank <= max(1.0, IMPORTANT * count):
        return "holds"
    return "holds in part" if rank <= 0.5 * count else "does not hold"


def share_verdict(share: float) -> Verdict:
    """Holds from 80 %, in part from 50 % of the cases."""
    return "holds" if share >= 0.8 else ("holds in part" if share >= 0.5 else "does not hold")
