"""The simulated rig around the brake: drive, pressure line, temperatures, friction map, sensors, sound.

`Plant.step` advances everything by one block and gives the samples; `Plant.render_sound` the microphone's.
Physical values come from `configs/plants/*.toml` as `PlantSettings`. SI inside, rig units at `Commands`,
`PlantStep` and `PlantTruth`.
NOT its job: the brake's vibration (`sim_hardware.brake_model`), processes, time pacing and the HAL
(`sim_hardware.devices`). Names are imported on first use, so that settings can be checked without numba.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sim_hardware.plant.plant import Plant, SoundJob, sound_of
    from sim_hardware.plant.settings import PlantSettings
    from sim_hardware.plant.words import Commands, PlantStep, PlantTruth, behind_relay

_HOME = {
    "Plant": "plant",
    "PlantSettings": "settings",
    "Commands": "words",
    "PlantStep": "words",
    "PlantTruth": "words",
    "SoundJob": "plant",
    "behind_relay": "words",
    "sound_of": "plant",
}

__all__ = [
    "Commands",
    "Plant",
    "PlantSettings",
    "PlantStep",
    "PlantTruth",
    "SoundJob",
    "behind_relay",
    "sound_of",
]


def __getattr__(name: str) -> Any:
    """Import `name` from its module on first use (PEP 562)."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
