"""Brakings made up for the tests of recording: channels, specifications, signals, spools of them.

Not a model of anything: noise, steps and a tone with known numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.recording.braking import Outcome
from rigctl.recording.campaign import Campaign, create_campaign
from rigctl.recording.spool import SpoolWriter

BLOCK_S = 0.05
EPOCH = "2000-01-01T00:00:00+00:00"
SPECS = (
    ChannelSpec("microphone", "Pa", 40000.0, "int16", 6.1e-3, 0.0, "1/2-inch microphone, 0.5 m"),
    ChannelSpec("torque", "N·m", 4000.0),
    ChannelSpec("pressure", "bar", 4000.0),
    ChannelSpec("speed", "1/min", 4000.0),
    ChannelSpec("disc_temperature", "°C", 4000.0),
)


def specification(index: int = 1, pressure_bar: float = 15.0, **recording: Any) -> dict[str, Any]:
    """A braking as the recorder gets it: plain JSON."""
    return {
        "index": index,
        "sequence": "matrix",
        "role": "matrix",
        "index_in_sequence": index,
        "repetition": 1,
        "loop": {"temperature": 0, "speed": 0, "pressure": 2},
        "temperature_degc": 100.0,
        "pressure_bar": pressure_bar,
        "ventilator": False,
        "dwell_s": 1.0,
        "recording": {
            "sampling_hz": 40000.0,
            "channels": [
                {"name": spec.name, "decimation": 1 if spec.name == "microphone" else 40} for spec in SPECS
            ],
            **recording,
        },
    }


def signals(seconds: float, seed: int = 0, squeal_hz: float = 2350.0) -> dict[str, np.ndarray]:
    """Samples as acquired: pressure on from 1/8 to 7/8 of the time, squeal in its middle half."""
    rng = np.random.default_rng(seed)
    slow, fast = np.arange(round(seconds * 4000)) / 4000.0, np.arange(round(seconds * 40000)) / 40000.0
    on = (slow > seconds / 8) & (slow < seconds * 7 / 8)
    loud = (fast > seconds / 4) & (fast < seconds * 3 / 4)
    tone = 300.0 * np.sin(2 * np.pi * squeal_hz * fast) * loud
    return {
        "microphone": np.rint(rng.normal(0.0, 2.0, len(fast)) + tone).astype(np.int16),
        "torque": (on * 300.0 + rng.normal(0.0, 1.0, len(slow))).astype(np.float32),
        "pressure": (on * 15.0 + rng.normal(0.0, 0.02, len(slow))).astype(np.float32),
        "speed": (40.0 + rng.normal(0.0, 0.05, len(slow))).astype(np.float32),
        "disc_temperature": (100.0 + slow + rng.normal(0.0, 0.1, len(slow))).astype(np.float32),
    }


def header(specified: Mapping[str, Any], **changes: Any) -> dict[str, Any]:
    """Head of a spool as the recorder writes it."""
    return {
        "specification": dict(specified),
        "t0_s": 100.0,
        "epoch": EPOCH,
        "attempt": 1,
        "evaluation": {},
        "metadata": {"seed": 1},
        **changes,
    }


def write_spool(
    path: Path,
    seconds: float = 1.0,
    *,
    seed: int = 0,
    index: int = 1,
    status: str | None = "complete",
    skip_blocks: frozenset[int] = frozenset(),
    specified: Mapping[str, Any] | None = None,
    block_s: float = BLOCK_S,
    marks: Sequence[tuple[str, float, dict[str, Any]]] = (),
) -> dict[str, np.ndarray]:
    """Write the spool of a braking block by block; returns the samples. `status` None leaves out the end."""
    data = signals(seconds, seed)
    writer = SpoolWriter.create(path, SPECS, header(specified or specification(index)))
    for k in range(round(seconds / block_s)):
        parts = []
        for number, spec in enumerate(SPECS):
            n = round(spec.rate_hz * block_s)
            parts.append((number, k * n, data[spec.name][k * n : (k + 1) * n]))
        if k not in skip_blocks:
            writer.append(parts, 100.0 + (k + 1) * block_s)
        if k == 2:
            writer.mark("pressure_onset", 100.15, {"pressure_bar": 15.0})
    for mark in marks:
        writer.mark(*mark)
    if status is not None:
        writer.end(status, "")
    writer.close()
    return data


def new_campaign(parent: Path, name: str = "campaign") -> Campaign:
    """An empty campaign."""
    return create_campaign(parent / name, {"program": {"name": "test"}, "seed": 1})


def no_evaluation(channels: Mapping[str, ChannelData], settings: Mapping[str, Any]) -> Outcome:
    """Stands for the evaluation where a test is about the samples: number of samples of each channel."""
    return Outcome(
        results={f"{name}_n": len(data.samples) for name, data in channels.items()}, settings=dict(settings)
    )
