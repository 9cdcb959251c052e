"""The form of a braking file: NeXus groups and fields around the samples.

Job: turn a `StoredBraking` into the bytes of one HDF5 file that h5py, MATLAB, Octave, silx and h5web open
without plug-ins. NOT its job: reading it (`braking_file`), computing anything, the disk.

Data sets depend on the braking only, bit for bit; the wall clock goes to the attribute `file_time`.
"""

from __future__ import annotations

import dataclasses
import json
import math
import re
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np

from rigctl import __version__
from rigctl.core.channels import MICROPHONE
from rigctl.core.units import unit_of
from rigctl.recording.braking import StoredBraking, StoredChannel
from rigctl.recording.hdf5_image import Group, Image


def start_time(braking: StoredBraking) -> str:
    """Time of the first sample by the rig clock, ISO 8601."""
    return (datetime.fromisoformat(braking.epoch) + timedelta(seconds=braking.t0_s)).isoformat()


def image(braking: StoredBraking) -> bytes:
    """The braking file as bytes."""
    root = Image(NX_class="NXroot", default="entry", creator="rigctl", creator_version=__version__)
    root.stamp("", "file_time", datetime.now(UTC).isoformat(timespec="seconds"))
    default = MICROPHONE if MICROPHONE in braking.channels else next(iter(braking.channels), "braking")
    entry = root.group("entry", "NXentry", default=default)
    specification = braking.specification
    entry.text("title", f"{specification['sequence']}: braking {braking.index}")
    entry.text("entry_identifier", f"{braking.index:05d}")
    entry.text("start_time", start_time(braking))
    entry.number("duration", round(braking.duration_s * 1e3), "ms")  # NeXus wants an integer
    axes: dict[tuple[float, int], str] = {}
    for channel in braking.channels.values():
        _channel(entry, channel, axes)
    _braking(entry, braking)
    _events(entry, braking)
    _clocks(entry, braking)
    results = entry.group("results", "NXcollection")
    for name, value in braking.outcome.results.items():
        results.number(name, np.nan if value is None else value, unit_of(name))
    return root.finish()


def _channel(entry: Group, channel: StoredChannel, axes: dict[tuple[float, int], str]) -> None:
    spec, samples = channel.data.spec, channel.data.samples
    signal = "counts" if spec.is_counts else "value"
    title = spec.description or spec.name
    group = entry.group(spec.name, "NXdata", signal=signal, axes="time", time_indices=0, title=title)
    attributes: dict[str, str | float] = {
        "units": "count" if spec.is_counts else spec.unit,
        "long_name": f"{spec.name} (counts)" if spec.is_counts else f"{spec.name} ({spec.unit})",
        "rate_hz": spec.rate_hz,
    }
    group.packed(signal, samples, **attributes)
    group.stamp(signal, "crc32", channel.crc32)
    key = (spec.rate_hz, len(samples))
    if key in axes:
        group.link("time", axes[key])
    else:
        axes[key] = f"/entry/{spec.name}/time"
        group.time_axis("time", *key, units="s", long_name="time since the first sample (s)")
    if spec.is_counts:
        group.number("counts_scaling_factor", spec.scale)
        group.number("counts_offset", spec.offset)
        group.text("units_physical", spec.unit)
    chain = group.group("chain", "NXcollection")
    chain.text("native", json.dumps(channel.native.to_mapping(), ensure_ascii=False))
    chain.text("filter", _filter_json(channel))
    if channel.gaps_s:
        chain.array("gaps", np.array(channel.gaps_s, np.float64), "s")


def _filter_json(channel: StoredChannel) -> str:
    if channel.filter is None:
        spec = channel.native
        plain = spec.is_counts or (spec.scale, spec.offset) == (1.0, 0.0)
        return json.dumps({"kind": "none", "stored": "as acquired" if plain else "scale and offset applied"})
    return json.dumps(channel.filter.model_dump(mode="json"), ensure_ascii=False)


def _braking(entry: Group, braking: StoredBraking) -> None:
    specification = braking.specification
    group = entry.group("braking", "NXcollection")
    group.number("index", braking.index)
    for name in ("sequence", "role"):
        group.text(name, str(specification[name]))
    group.text("status", braking.status)
    group.text("note", braking.note)
    group.number("attempt", braking.attempt)
    group.number("t0_rig", braking.t0_s, "s")
    group.number("bytes_cut", braking.bytes_cut)
    for name, value in _set_points(specification).items():
        group.number(name, value, unit_of(name))
    group.text("specification", json.dumps(specification, ensure_ascii=False))
    group.text("metadata", json.dumps(braking.metadata, ensure_ascii=False))
    group.text("summary", json.dumps(summary(braking), ensure_ascii=False))
    marks = group.group("marks", "NXcollection")
    for mark in _last_of_each_name(braking):
        marks.number(mark.name, mark.t_s, "s")
    group.text(
        "marks_json", json.dumps([dataclasses.asdict(mark) for mark in braking.marks], ensure_ascii=False)
    )


def _last_of_each_name(braking: StoredBraking) -> list[Any]:
    """Marks as plain fields; of several with one name the first. All are in `marks_json`."""
    first: dict[str, Any] = {}
    for mark in braking.marks:
        first.setdefault(mark.name, mark)
    return list(first.values())


def _set_points(specification: dict[str, Any]) -> dict[str, float | int]:
    """Numbers at the top of the specification (set-points) and the loop indices, by name."""
    numbers = {
        name: value
        for name, value in specification.items()
        if name not in ("index", "ventilator")
        and isinstance(value, int | float)
        and not isinstance(value, bool)
    }
    loop = specification.get("loop") or {}
    return {**numbers, **{f"loop_{name}": value for name, value in loop.items()}}


def _events(entry: Group, braking: StoredBraking) -> None:
    group = entry.group("events", "NXcollection")
    for name, column in braking.outcome.events.items():
        group.array(name, column, unit_of(name))
    group.text("settings", json.dumps(braking.outcome.settings, ensure_ascii=False))
    if braking.outcome.error:
        group.text("error", braking.outcome.error)


def _clocks(entry: Group, braking: StoredBraking) -> None:
    """One log for each source; nothing where the rig has one clock only."""
    if not braking.clocks:
        return
    group = entry.group("clocks", "NXcollection")
    for source, columns in braking.clocks.items():
        log = group.group(_nexus_name(source), "NXcollection", source=source)
        for name, values in columns.items():
            log.array(name, np.array(values), unit_of(name))


def _nexus_name(text: str) -> str:
    """As NeXus allows names of groups."""
    return re.sub(r"[^A-Za-z0-9_]", "_", text)


def summary(braking: StoredBraking) -> dict[str, Any]:
    """All but the samples, as plain JSON values (None instead of NaN)."""
    outcome = braking.outcome
    return {
        "index": braking.index,
        "sequence": braking.specification["sequence"],
        "role": braking.specification["role"],
        "status": braking.status,
        "note": braking.note,
        "attempt": braking.attempt,
        "t0_s": braking.t0_s,
        "start_time": start_time(braking),
        "duration_s": braking.duration_s,
        "set_points": _set_points(braking.specification),
        "channels": {name: channel.data.spec.to_mapping() for name, channel in braking.channels.items()},
        "marks": [dataclasses.asdict(mark) for mark in braking.marks],
        "results": outcome.results,
        "events": {
            name: [value if math.isfinite(value) else None for value in column.tolist()]
            for name, column in outcome.events.items()
        },
        "evaluation_error": outcome.error,
        **({"clocks": _newest(braking)} if braking.clocks else {}),
    }


def _newest(braking: StoredBraking) -> dict[str, dict[str, float]]:
    """The last measurement of each clock."""
    return {
        source: {name: values[-1] for name, values in columns.items()}
        for source, columns in braking.clocks.items()
    }
