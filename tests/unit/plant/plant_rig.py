"""A small operator for the plant's tests: commands with defaults, runs that collect what came out.

Not its job: judging.
"""

import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from sim_hardware.brake_model import Brake, load_brake
from sim_hardware.plant import Commands, Plant, PlantSettings

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
MS = 1_000_000
TURN = Commands(speed_set_rpm=40.0, speed_ramp_rpm_per_s=100.0, drive_enabled=True, relay_closed=True)


def shipped_mapping() -> dict:
    """Content of the shipped file, a new copy each time."""
    return tomllib.loads((CONFIGS / "plants" / "a_class.toml").read_text(encoding="utf-8"))


@cache
def shipped_settings() -> PlantSettings:
    return PlantSettings.model_validate(shipped_mapping())


def changed_settings(**changes: object) -> PlantSettings:
    """Shipped values with others, given as section__key=value."""
    mapping = shipped_mapping()
    for name, value in changes.items():
        section, key = name.split("__")
        mapping[section][key] = value
    return PlantSettings.model_validate(mapping)


@cache
def shipped_brake() -> Brake:
    return load_brake(CONFIGS / "brakes" / "plant.toml")


class Rig:
    """A plant that is stepped in blocks and remembers its slow samples."""

    def __init__(
        self, seed: int = 1, settings: PlantSettings | None = None, brake: Brake | None = None
    ) -> None:
        self.plant = Plant(settings or shipped_settings(), brake or shipped_brake(), seed=seed)
        self.commands = Commands()

    def run(self, duration_s: float, *, full_rate: bool = True, block_ms: int = 50, **changes) -> dict:
        """Step for a while with the last commands, changed; return the samples joined, and "sound" if any."""
        self.commands = replace(self.commands, **changes)
        collected: dict[str, list] = {}
        for _ in range(round(duration_s * 1000 / block_ms)):
            step = self.plant.step(block_ms * MS, self.commands, full_rate=full_rate)
            for name, samples in step.samples.items():
                collected.setdefault(name, []).append(samples)
        return {name: np.concatenate(parts) for name, parts in collected.items()}

    def listen(self, duration_s: float, **changes) -> np.ndarray:
        """Sound in Pa."""
        self.commands = replace(self.commands, **changes)
        parts = []
        for _ in range(round(duration_s * 20)):
            self.plant.step(50 * MS, self.commands, full_rate=True)
            parts.append(self.plant.render_sound())
        return np.concatenate(parts) * self.plant.sound_channel.scale

    def turn(self, speed_rpm: float = 40.0) -> "Rig":
        """Up to speed with the brake open."""
        self.commands = replace(TURN, speed_set_rpm=speed_rpm)
        self.run(0.5 * np.ceil(2.0 * speed_rpm / 100.0 + 4.0), full_rate=False, block_ms=500)
        return self


def smooth(samples: np.ndarray, n: int = 80) -> np.ndarray:
    """Moving average over n samples (20 ms), without its ends."""
    return np.convolve(np.asarray(samples, dtype=float), np.ones(n) / n, mode="valid")
