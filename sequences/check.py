"""Dry run: every set-point of every braking against what the rig can do, before anything moves.

Job: find all problems at once, grouped (not one copy per braking), with place, value and remedy; count the
brakings; estimate time and data volume. Not the job: refusing nonsense in the file (that happens at load),
guarding limits during the run (``rigctl.safety``).

An *error* means the program must not be started; a *warning* rests on an estimate and is for the engineer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from sequences.braking import Braking
from sequences.capabilities import RigCapabilities
from sequences.estimate import BrakingForecast, DurationEstimate, ThermalWalk
from sequences.fields import Data, sentence
from sequences.limits import (
    Finding,
    pressure_findings,
    recording_findings,
    speed_findings,
    temperature_findings,
)
from sequences.program import Program

Severity = Literal["error", "warning"]
_SHOWN_VALUES = 5


class Problem(Data):
    """One kind of problem at one place: first met at braking `first_index`, in `count` brakings.

    `place` is for reading; `sequence` (name) and `key` (field of the sequence) say the same for programs.
    """

    severity: Severity
    place: str
    sequence: str
    key: str
    value: str
    problem: str
    remedy: str
    first_index: int
    count: int


class CheckResult(Data):
    """Outcome of the dry run."""

    problems: tuple[Problem, ...]
    n_brakings: int
    n_by_sequence: dict[str, int]
    estimate: DurationEstimate
    data_bytes: int

    @property
    def errors(self) -> tuple[Problem, ...]:
        return tuple(p for p in self.problems if p.severity == "error")

    @property
    def warnings(self) -> tuple[Problem, ...]:
        return tuple(p for p in self.problems if p.severity == "warning")

    @property
    def ok(self) -> bool:
        """True if the program may be started."""
        return not self.errors

    @property
    def estimated_duration_s(self) -> float:
        return self.estimate.total_s


class _Key(NamedTuple):
    sequence: str
    key: str
    problem: str


@dataclass
class _Group:
    finding: Finding
    first_index: int
    count: int = 0
    values: dict[float | str, None] = field(default_factory=dict[float | str, None])


class _Collector:
    """Groups findings by sequence, key and kind of problem, in the order in which they are met."""

    def __init__(self) -> None:
        self._groups: dict[_Key, _Group] = {}

    def add(self, braking: Braking, finding: Finding) -> None:
        key = _Key(braking.sequence, finding.key, finding.problem)
        group = self._groups.setdefault(key, _Group(finding, braking.index))
        group.count += 1
        group.values[finding.value] = None

    def problems(self, positions: dict[str, int]) -> Iterator[Problem]:
        for key, group in self._groups.items():
            yield Problem(
                severity=group.finding.severity,
                place=f"sequences[{positions[key.sequence]}] '{key.sequence}': {key.key}",
                sequence=key.sequence,
                key=key.key,
                value=_text(list(group.values), group.finding.unit),
                problem=group.finding.problem,
                remedy=sentence(group.finding.remedy),
                first_index=group.first_index,
                count=group.count,
            )


def _text(values: list[float | str], unit: str) -> str:
    shown = [value if isinstance(value, str) else f"{value:.6g}" for value in values]
    text = ", ".join(shown[:_SHOWN_VALUES])
    if len(shown) > _SHOWN_VALUES:
        text += f", ... ({len(shown)} values)"
    return f"{text} {unit}".rstrip()


# A rule looks at one group of set-points; the key says which brakings share them, so each is judged once.
_Rule = Callable[[Braking, RigCapabilities], Iterator[Finding]]
_RULES: tuple[tuple[_Rule, Callable[[Braking], int]], ...] = (
    (temperature_findings, lambda b: b.loop.temperature),
    (speed_findings, lambda b: b.loop.speed),
    (pressure_findings, lambda b: b.loop.speed * 1_000_000 + b.loop.pressure),
    (recording_findings, lambda b: 0),
)


def check_program(
    program: Program, capabilities: RigCapabilities, start_degc: float | None = None
) -> CheckResult:
    """Check `program` against a rig and estimate its duration, the disc at `start_degc` (None: ambient)."""
    collector = _Collector()
    walk = ThermalWalk(capabilities, start_degc)
    judged: dict[tuple[str, int, int], tuple[Finding, ...]] = {}
    data_bytes = 0.0
    for braking in program.brakings():
        for number, (rule, group_of) in enumerate(_RULES):
            key = (braking.sequence, number, group_of(braking))
            if key not in judged:
                judged[key] = tuple(rule(braking, capabilities))
            for finding in judged[key]:
                collector.add(braking, finding)
        for finding in _forecast_findings(braking, walk.step(braking), capabilities):
            collector.add(braking, finding)
        data_bytes += _data_bytes(braking, capabilities)
    positions = {sequence.name: i for i, sequence in enumerate(program.sequences)}
    return CheckResult(
        problems=tuple(collector.problems(positions)),
        n_brakings=program.count,
        n_by_sequence={sequence.name: sequence.count for sequence in program.sequences},
        estimate=walk.estimate,
        data_bytes=round(data_bytes),
    )


def _forecast_findings(
    braking: Braking, forecast: BrakingForecast, capabilities: RigCapabilities
) -> Iterator[Finding]:
    timeout_s = braking.conditioning.timeout_s
    target = braking.temperature_degc
    if target is not None and target >= capabilities.min_conditioning_degc:
        if forecast.conditioning_s is None:
            yield Finding(
                "temperatures_degc", target, "degC",
                "the conditioning drag does not heat the disc to this temperature",
                "raise conditioning.drag_pressure_bar or drag_speed_rpm, or lower the temperature",
            )  # fmt: skip
        elif forecast.conditioning_s > timeout_s:
            yield Finding(
                "conditioning.timeout_s", timeout_s, "s",
                "conditioning is expected to take longer than its time-out",
                "raise conditioning.timeout_s, or choose a loop order with smaller temperature steps",
                "warning",
            )  # fmt: skip
    if forecast.end_degc > braking.limits.max_degc:
        yield Finding(
            "limits.max_degc", braking.limits.max_degc, "degC",
            "the braking is expected to heat the disc above this limit, and would be cut short",
            "start cooler, or brake shorter or with less pressure",
            "warning",
        )  # fmt: skip


def _data_bytes(braking: Braking, capabilities: RigCapabilities) -> float:
    recording = braking.recording
    seconds = recording.pre_s + braking.duration_s + recording.post_s
    known = (c for c in recording.channels if c.name in capabilities.channels)
    return sum(
        seconds * recording.sampling_hz / c.decimation * capabilities.channels[c.name].bytes_per_sample
        for c in known
    )
