"""What the fields of the page hold: a program as the texts that a person sees, right or wrong.

Job: frozen values (so that undo is a list of them) and the way from and to the models: `form_of` is exact,
and `mapping_of` puts a text that is no number into the mapping as it is, so that the model refuses it at
its place. Without Qt. Not its job: judging (`checking`), keeping (`draft`).
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from typing import Any, get_args

from rigctl.gui.pages.sequence.paste import parse_list, parse_number, write_number
from sequences.braking import AXES, Axis, Conditioning, Recording, Role, TemperatureLimits
from sequences.matrix import Sequence
from sequences.pressure import ConstantPressure, PressureFunction, RampPressure, StepsPressure
from sequences.profiles import SpeedProfile
from sequences.program import Program

ROLES: tuple[str, ...] = get_args(Role)
KINDS = ("constant", "ramp", "sine", "triangle", "steps")
_UIDS = itertools.count(1)


def new_uid() -> int:
    """A number by which a sequence is found again while it is edited; it is not part of its value."""
    return next(_UIDS)


@dataclass(frozen=True)
class SpeedRow:
    """One segment (t, n1, n2). `joined`: it goes on with the profile of the row above."""

    duration: str = ""
    start: str = ""
    end: str = ""
    joined: bool = False


@dataclass(frozen=True)
class FunctionForm:
    """The pressure over the time of a braking; fields of the other kinds keep their texts."""

    kind: str = "constant"
    amplitude: str = "5"
    frequency: str = "0.5"
    direction: str = "rising"
    steps: str = "0 5 0"
    rise: str = "0"


@dataclass(frozen=True)
class ConditioningForm:
    """How the start temperature is met; an empty drag is the rig's own."""

    enabled: bool = True
    mode: str = "exact"
    tolerance: str = "2"
    soak: str = "2"
    timeout: str = "3600"
    drag_speed: str = ""
    drag_pressure: str = ""


@dataclass(frozen=True)
class LimitsForm:
    """Maximum and cool-down temperature."""

    maximum: str = "500"
    cool_down: str = "480"


@dataclass(frozen=True)
class ChannelRow:
    """A channel to store."""

    name: str
    decimation: str = "1"


@dataclass(frozen=True)
class RecordingForm:
    """What is stored of a braking."""

    sampling: str = "40000"
    channels: tuple[ChannelRow, ...] = ()
    pre: str = "0.5"
    post: str = "0.5"


@dataclass(frozen=True)
class SequenceForm:
    """One sequence. Two are equal when a person sees the same."""

    name: str
    role: str = "matrix"
    enabled: bool = True
    repeat: str = "1"
    temperatures: tuple[str, ...] = ()
    speeds: tuple[SpeedRow, ...] = ()
    pressures: tuple[str, ...] = ()
    loop_order: tuple[Axis, Axis, Axis] = AXES
    processing: str = "loops"
    function: FunctionForm = FunctionForm()
    conditioning: ConditioningForm = ConditioningForm()
    limits: LimitsForm = LimitsForm()
    recording: RecordingForm = RecordingForm()
    dwell: str = "0"
    ventilator: bool = False
    uid: int = field(default_factory=new_uid, compare=False)


@dataclass(frozen=True)
class ProgramForm:
    """A program."""

    name: str = ""
    description: str = ""
    sequences: tuple[SequenceForm, ...] = ()


# -- from models ------------------------------------------------------------------------------------


def form_of(program: Program) -> ProgramForm:
    """The texts that show `program`; `mapping_of` leads back to the same program."""
    return ProgramForm(program.name, program.description, tuple(map(sequence_form, program.sequences)))


def sequence_form(sequence: Sequence) -> SequenceForm:
    """The texts that show one sequence."""
    return SequenceForm(
        name=sequence.name,
        role=sequence.role,
        enabled=sequence.enabled,
        repeat=str(sequence.repeat),
        temperatures=tuple(map(write_number, sequence.temperatures_degc)),
        speeds=tuple(row for profile in sequence.speed_profiles for row in _speed_rows(profile)),
        pressures=tuple(map(write_number, sequence.pressures_bar)),
        loop_order=sequence.loop_order,
        processing=sequence.processing,
        function=_function_form(sequence.pressure_function),
        conditioning=_conditioning_form(sequence.conditioning),
        limits=_limits_form(sequence.limits),
        recording=_recording_form(sequence.recording),
        dwell=write_number(sequence.dwell_s),
        ventilator=sequence.ventilator,
    )


def _speed_rows(profile: SpeedProfile) -> list[SpeedRow]:
    return [
        SpeedRow(write_number(s.duration_s), write_number(s.start_rpm), write_number(s.end_rpm), number > 0)
        for number, s in enumerate(profile.segments)
    ]


def _function_form(function: PressureFunction) -> FunctionForm:
    form = FunctionForm(kind=function.kind, rise=write_number(function.rise_s))
    if isinstance(function, StepsPressure):
        return replace(form, steps=" ".join(map(write_number, function.steps_bar)))
    if isinstance(function, ConstantPressure):
        return form
    form = replace(form, amplitude=write_number(function.amplitude_bar))
    if isinstance(function, RampPressure):
        return replace(form, direction=function.direction)
    return replace(form, frequency=write_number(function.frequency_hz))


def _conditioning_form(how: Conditioning) -> ConditioningForm:
    return ConditioningForm(
        enabled=how.enabled,
        mode=how.mode,
        tolerance=write_number(how.tolerance_k),
        soak=write_number(how.soak_s),
        timeout=write_number(how.timeout_s),
        drag_speed="" if how.drag_speed_rpm is None else write_number(how.drag_speed_rpm),
        drag_pressure="" if how.drag_pressure_bar is None else write_number(how.drag_pressure_bar),
    )


def _limits_form(limits: TemperatureLimits) -> LimitsForm:
    return LimitsForm(write_number(limits.max_degc), write_number(limits.cool_down_degc))


def _recording_form(recording: Recording) -> RecordingForm:
    return RecordingForm(
        sampling=write_number(recording.sampling_hz),
        channels=tuple(ChannelRow(c.name, str(c.decimation)) for c in recording.channels),
        pre=write_number(recording.pre_s),
        post=write_number(recording.post_s),
    )


# -- to models --------------------------------------------------------------------------------------


def _number(text: str) -> float | str:
    value = parse_number(text)
    return text.strip() if value is None else value


def _whole(text: str) -> int | float | str:
    value = _number(text)
    return int(value) if isinstance(value, float) and value.is_integer() else value


def profile_rows(rows: tuple[SpeedRow, ...]) -> list[list[int]]:
    """Numbers of the rows of each speed profile."""
    profiles: list[list[int]] = []
    for number, row in enumerate(rows):
        if row.joined and profiles:
            profiles[-1].append(number)
        else:
            profiles.append([number])
    return profiles


def mapping_of(form: SequenceForm) -> dict[str, Any]:
    """What the model `Sequence` validates. Without conditioning the temperatures are left out."""
    how, recording = form.conditioning, form.recording
    conditioning: dict[str, Any] = {
        "enabled": how.enabled,
        "mode": how.mode,
        "tolerance_k": _number(how.tolerance),
        "soak_s": _number(how.soak),
        "timeout_s": _number(how.timeout),
    }
    for key, text in (("drag_speed_rpm", how.drag_speed), ("drag_pressure_bar", how.drag_pressure)):
        if text.strip():
            conditioning[key] = _number(text)
    return {
        "name": form.name.strip(),
        "role": form.role,
        "enabled": form.enabled,
        "repeat": _whole(form.repeat),
        "temperatures_degc": [_number(text) for text in form.temperatures] if how.enabled else [],
        "speed_profiles": [
            {"segments": [_segment(form.speeds[number]) for number in numbers]}
            for numbers in profile_rows(form.speeds)
        ],
        "pressures_bar": [_number(text) for text in form.pressures],
        "loop_order": list(form.loop_order),
        "processing": form.processing,
        "pressure_function": function_mapping(form.function),
        "conditioning": conditioning,
        "limits": {
            "max_degc": _number(form.limits.maximum),
            "cool_down_degc": _number(form.limits.cool_down),
        },
        "recording": {
            "sampling_hz": _number(recording.sampling),
            "channels": [{"name": c.name, "decimation": _whole(c.decimation)} for c in recording.channels],
            "pre_s": _number(recording.pre),
            "post_s": _number(recording.post),
        },
        "dwell_s": _number(form.dwell),
        "ventilator": form.ventilator,
    }


def _segment(row: SpeedRow) -> dict[str, Any]:
    return {
        "duration_s": _number(row.duration),
        "start_rpm": _number(row.start),
        "end_rpm": _number(row.end),
    }


def function_mapping(form: FunctionForm) -> dict[str, Any]:
    """What the model of the pressure function validates."""
    mapping: dict[str, Any] = {"kind": form.kind, "rise_s": _number(form.rise)}
    if form.kind in ("ramp", "sine", "triangle"):
        mapping["amplitude_bar"] = _number(form.amplitude)
    if form.kind in ("sine", "triangle"):
        mapping["frequency_hz"] = _number(form.frequency)
    if form.kind == "ramp":
        mapping["direction"] = form.direction
    if form.kind == "steps":
        mapping["steps_bar"] = [_number(text) for text in parse_list(form.steps)]
    return mapping
