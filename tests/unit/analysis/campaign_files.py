"""Writes small campaigns in the real file format for the tests of the analysis (a helper, no test)."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.recording.braking import StoredBraking, StoredChannel
from rigctl.recording.braking_file import file_image
from rigctl.recording.evaluation import evaluate_braking
from rigctl.signals.calibration import mean_square_pa2

MU_FORCE_NM_PER_BAR = 2 * 1e5 * 2.290e-3 * 0.105


@dataclass(frozen=True)
class Case:
    """One braking to be written; `tones` are (frequency Hz, level dB, start s, stop s)."""

    index: int
    pressure_bar: float = 15.0
    temperature_degc: float | None = 100.0
    role: str = "matrix"
    status: str = "complete"
    note: str = ""
    mu: float = 0.42
    tones: tuple[tuple[float, float, float, float], ...] = ()
    sound: bool = True
    seconds: float = 2.0
    metadata: dict[str, Any] = field(default_factory=dict)


def write_campaign(folder: Path, cases: list[Case]) -> Path:
    """Write `<folder>/brakings/*.h5`; every number in the files comes from evaluating made samples."""
    (folder / "brakings").mkdir(parents=True)
    for case in cases:
        (folder / "brakings" / f"{case.index:05d}.h5").write_bytes(file_image(_braking(case)))
    return folder


def _braking(case: Case) -> StoredBraking:
    channels = _channels(case)
    stored = {name: StoredChannel(data, data.spec, None, ()) for name, data in channels.items()}
    specification = {
        "index": case.index,
        "sequence": case.role,
        "role": case.role,
        "temperature_degc": case.temperature_degc,
        "pressure_bar": case.pressure_bar,
        "loop": {"temperature": 0, "speed": 0, "pressure": 0},
    }
    return StoredBraking(
        specification=specification,
        status=case.status,
        note=case.note,
        attempt=1,
        t0_s=60.0 * case.index,
        epoch="2000-01-01T00:00:00+00:00",
        duration_s=case.seconds + 1.0,
        channels=stored,
        marks=(),
        metadata=case.metadata,
        outcome=evaluate_braking(channels, {}),
        bytes_cut=0,
    )


def _channels(case: Case) -> dict[str, ChannelData]:
    total_s = case.seconds + 1.0
    t = np.arange(int(total_s * 1000)) / 1000
    rng = np.random.default_rng(case.index)
    pressure = case.pressure_bar * np.clip(np.minimum((t - 0.5) / 0.2, (total_s - 0.5 - t) / 0.2), 0, 1)
    mu = case.mu + 0.01 * rng.standard_normal(t.size)
    slow = {
        "pressure": ("bar", pressure),
        "torque": ("N·m", mu * np.clip(pressure - 0.5, 0, None) * MU_FORCE_NM_PER_BAR),
        "speed": ("1/min", np.full(t.size, 40.0)),
        "disc_temperature": ("°C", (case.temperature_degc or 83.0) + 2 * t),
    }
    channels = {
        name: ChannelData(ChannelSpec(name, unit, 1000.0), 0.0, np.asarray(values, np.float32))
        for name, (unit, values) in slow.items()
    }
    if case.sound:
        ts = np.arange(int(total_s * 40000)) / 40000
        x = np.sqrt(mean_square_pa2(50.0)) * rng.standard_normal(ts.size)
        for f_hz, level, start_s, stop_s in case.tones:
            on = np.clip(np.minimum((ts - start_s) / 0.1, (stop_s - ts) / 0.1), 0, 1)
            x += on * np.sqrt(2 * mean_square_pa2(level)) * np.sin(2 * np.pi * f_hz * ts)
        spec = ChannelSpec("microphone", "Pa", 40000.0, "int16", 200 / 32768, description="B&K 4189")
        counts = np.clip(np.round(x / spec.scale), -32768, 32767).astype(np.int16)
        channels["microphone"] = ChannelData(spec, 0.0, counts)
    return channels


def numbered(cases: list[Case]) -> list[Case]:
    """The same cases, numbered from 1."""
    return [replace(case, index=i + 1) for i, case in enumerate(cases)]
