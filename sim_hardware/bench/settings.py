"""The bench file: which plant, which wires, which devices on them.

Job: frozen model of `configs/benches/*.toml` and its loader. Not its job: settings of a device (the packages
`can` and `serial` define them), the folder of a running bench (`rigctl.hal.bench_paths`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from rigctl.config.loading import load_model
from sim_hardware.bench.can.settings import BenchCanSettings
from sim_hardware.bench.serial.bench import SerialSettings

Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_-]{0,31}$")]


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class BusSettings(_Frozen):
    """The CAN bus: python-can's `interface` and its own keyword arguments.

    With "udp_multicast" frames stay on this machine (hop_limit 0); one bench per group and port.
    """

    model_config = ConfigDict(frozen=True, extra="allow", allow_inf_nan=False)
    interface: Annotated[str, Field(min_length=1)] = "udp_multicast"

    @property
    def arguments(self) -> dict[str, Any]:
        """All keyword arguments of `can.Bus`."""
        return {"interface": self.interface, **(self.model_extra or {})}


class MicrophoneSettings(_Frozen):
    """The microphone as a sound card: a private PulseAudio with one source.

    Attributes
    ----------
    enabled : bool
        False: no sound is made.
    name : str
        Of the source, and of the ALSA device.
    rate_hz : int
        Sampling rate of the source; the plant's sound is resampled from 40 kHz.
    format : str
        Format of the source.
    full_scale_pa : float
        Sound pressure that gives full scale (1.0, or 32768 counts).
    """

    enabled: bool = True
    name: Name = "rigmic"
    rate_hz: Literal[40_000, 48_000] = 40_000
    format: Literal["float32", "int16"] = "float32"
    full_scale_pa: Annotated[float, Field(gt=0.0, le=2000.0)] = 20.0


class BenchSettings(_Frozen):
    """A bench file, validated. Relative paths in it start at the folder of the file.

    Attributes
    ----------
    seed : int or None
        Of noise and scatter; None draws one.
    folder : Path or None
        Where ports and sockets are; None leaves it to `rigctl.hal.bench_paths`.
    realtime : bool
        Ask for real-time priority; without permission the bench runs as it may.
    """

    name: Annotated[str, Field(min_length=1, max_length=120)]
    plant: Path
    brake: Path
    seed: Annotated[int | None, Field(ge=0, le=2**31 - 1)] = None
    folder: Path | None = None
    realtime: bool = True
    bus: BusSettings = BusSettings()
    can: BenchCanSettings = BenchCanSettings()
    serial: SerialSettings = SerialSettings()
    microphone: MicrophoneSettings = MicrophoneSettings()


def load_bench(path: Path) -> BenchSettings:
    """Read a bench file; plant and brake become paths from here.

    Raises
    ------
    ConfigError
        With one line for each fault.
    """
    settings = load_model(path, BenchSettings)
    here = path.parent
    return settings.model_copy(update={"plant": here / settings.plant, "brake": here / settings.brake})
