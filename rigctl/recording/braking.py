"""From the samples of a spool to the contents of a braking file: channels as stored, filters, evaluation.

Job: decimate each channel to the rate its braking asks for, by anti-alias filters; evaluate; decide the
status. Pure: the same spool gives the same contents. NOT its job: the form of the file (`nexus`), the disk.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.core.errors import RecordingError
from rigctl.recording.spool import CLOCKS_MARK, STARTED_MARK
from rigctl.recording.spool_reader import Mark, Spool
from rigctl.signals.decimation import FilterDescription, decimate, design_decimation

COMPLETE, INCOMPLETE, RECOVERED = "complete", "incomplete", "recovered"


@dataclass(frozen=True)
class Outcome:
    """What evaluation found, in the form of the file.

    Attributes
    ----------
    results : dict of str to (float, int or None)
        Numbers of the braking, unit in the name; None where a quantity is not defined.
    events : dict of str to ndarray
        Columns of the table of events, each of shape (n_events,); NaN where not defined.
    settings : dict
        Plain mapping of the settings used.
    error : str
        Why there is no evaluation; empty when there is one.
    """

    results: dict[str, float | int | None] = field(default_factory=dict)
    events: dict[str, NDArray[Any]] = field(default_factory=dict)
    settings: dict[str, Any] = field(default_factory=dict)
    error: str = ""

    @property
    def n_events(self) -> int:
        """Rows of the table of events."""
        return max((len(column) for column in self.events.values()), default=0)


Clocks = dict[str, dict[str, list[float]]]
"""Clocks of a real rig's sources while the braking was recorded, by source: ``time_s`` (of the measurement,
since the first sample), ``offset_ms``, ``drift_ppm``, … with unit in the name; all of one length."""

Evaluator = Callable[[Mapping[str, ChannelData], Mapping[str, Any]], Outcome]
"""Evaluates the stored channels with settings taken from the head of the spool."""


@dataclass(frozen=True)
class StoredChannel:
    """A channel as it goes to the file: data on the braking's time axis, the native spec and the filter."""

    data: ChannelData
    native: ChannelSpec
    filter: FilterDescription | None
    gaps_s: tuple[tuple[float, float], ...]

    @cached_property
    def crc32(self) -> int:
        """CRC-32 of the samples as stored."""
        return crc32(self.data.samples.data)


@dataclass(frozen=True)
class StoredBraking:
    """All that a braking file holds; times in s since the first sample, `t0_s` in rig time."""

    specification: dict[str, Any]
    status: str
    note: str
    attempt: int
    t0_s: float
    epoch: str
    duration_s: float
    channels: dict[str, StoredChannel]
    marks: tuple[Mark, ...]
    metadata: dict[str, Any]
    outcome: Outcome
    bytes_cut: int
    clocks: Clocks = field(default_factory=dict)

    @property
    def index(self) -> int:
        """Number of the braking in its program."""
        return int(self.specification["index"])


def decimation_factors(specification: Mapping[str, Any], specs: Sequence[ChannelSpec]) -> dict[str, int]:
    """Factor between the native rate and the rate to be stored, for each channel the braking records.

    Raises
    ------
    RecordingError
        The rig does not deliver a channel, or its rate is not a whole multiple of the one to be stored.
    """
    available = {spec.name: spec for spec in specs}
    recording = specification["recording"]
    factors: dict[str, int] = {}
    for channel in recording["channels"]:
        name, stored_hz = channel["name"], recording["sampling_hz"] / channel.get("decimation", 1)
        if name not in available:
            raise RecordingError(
                f"the rig has no channel '{name}'.",
                place=f"braking {specification['index']}",
                value=name,
                remedy=f"Record some of: {', '.join(available)}.",
            )
        ratio = available[name].rate_hz / stored_hz
        factor = round(ratio)
        if factor < 1 or not math.isclose(ratio, factor, rel_tol=1e-9):
            raise RecordingError(
                f"{name} cannot be stored at {stored_hz:g} Hz, the rig delivers {ratio * stored_hz:g} Hz.",
                place=f"braking {specification['index']}",
                value=stored_hz,
                remedy="Choose sampling rate and decimation so that the rig's rate is a whole multiple.",
            )
        factors[name] = factor
    return factors


def assemble(spool: Spool, evaluate: Evaluator) -> StoredBraking:
    """Make the contents of the braking file from a spool.

    Raises
    ------
    RecordingError
        The head of the spool names channels that cannot be stored.
    """
    header = spool.header
    specification = header["specification"]
    factors = decimation_factors(specification, spool.channels)
    channels = {
        spec.name: _store(spec, spool, factors[spec.name])
        for spec in spool.channels
        if spec.name in factors and spec.name in spool.stretches
    }
    started = next((mark.t_s for mark in spool.marks if mark.name == STARTED_MARK), header["t0_s"])
    end = spool.end or {"status": RECOVERED, "note": "the recording was cut off"}
    status, note = end["status"], end["note"]
    if status == COMPLETE and not (spool.intact and len(channels) == len(factors)):
        status, note = RECOVERED, "parts of the recording are missing"
    duration_s = max((len(c.data.samples) / c.data.spec.rate_hz for c in channels.values()), default=0.0)
    return StoredBraking(
        specification=specification,
        status=status,
        note=note,
        attempt=header["attempt"],
        t0_s=started,
        epoch=header["epoch"],
        duration_s=duration_s,
        channels=channels,
        marks=tuple(
            Mark(mark.name, mark.t_s - started, mark.values)
            for mark in spool.marks
            if mark.name not in (STARTED_MARK, CLOCKS_MARK)
        ),
        clocks=_clocks(spool, started),
        metadata=header["metadata"],
        outcome=evaluate({name: c.data for name, c in channels.items()}, header["evaluation"]),
        bytes_cut=spool.bytes_cut,
    )


def _clocks(spool: Spool, started_s: float) -> Clocks:
    """All measurements of each source's clock, in columns."""
    found: Clocks = {}
    for mark in spool.marks:
        if mark.name != CLOCKS_MARK:
            continue
        for source, state in mark.values.items():
            columns = found.setdefault(source, {})
            columns.setdefault("time_s", []).append(mark.t_s - started_s)
            for name, value in state.items():
                if isinstance(value, bool):  # the master says that it is one; it is the one without an offset
                    continue
                columns.setdefault(name, []).append(value)
    return found


def _store(spec: ChannelSpec, spool: Spool, factor: int) -> StoredChannel:
    stretch = spool.stretches[spec.name]
    gaps_s = tuple((start / spec.rate_hz, stop / spec.rate_hz) for start, stop in stretch.gaps)
    native = ChannelData(spec, 0.0, stretch.samples)
    if factor == 1:
        if spec.is_counts:
            return StoredChannel(native, spec, None, gaps_s)
        # a calibration changes values that are physical already; the native spec in the file keeps it
        value = replace(spec, scale=1.0, offset=0.0)
        return StoredChannel(ChannelData(value, 0.0, native.physical()), spec, None, gaps_s)
    samples = decimate(native.physical(), factor)
    stored = ChannelSpec(spec.name, spec.unit, spec.rate_hz / factor, "float32", description=spec.description)
    description = design_decimation(factor).describe(spec.rate_hz)
    return StoredChannel(ChannelData(stored, 0.0, np.ascontiguousarray(samples)), spec, description, gaps_s)
