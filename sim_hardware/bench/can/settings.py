"""Settings of the emulated CANopen nodes: what the bench file says of them.

Job: frozen models with bounds; the defaults are the table of nodes of the bench. Not its job: files
(`sim_hardware.bench.settings` embeds `BenchCanSettings`), and parameters that drivers write over the bus.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

NodeId = Annotated[int, Field(ge=1, le=127)]
Milliseconds = Annotated[int, Field(ge=1, le=65535)]
Unsigned32 = Annotated[int, Field(ge=0, le=0xFFFFFFFF)]


class _Model(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class WatchSettings(_Model):
    """A heartbeat that a node watches from power-on (1016h)."""

    node: NodeId
    time_ms: Milliseconds


class NodeSettings(_Model):
    """What every node has.

    Attributes
    ----------
    node : int
        Node-ID.
    present : bool
        False: the node is not on the bus.
    boot_ms : int
        From power-on or reset to boot-up.
    heartbeat_ms : int
        1017h from power-on; 0 sends none.
    autostart : bool
        Operational by itself after boot-up.
    watched : tuple of WatchSettings
        1016h from power-on, at most 4.
    vendor, product, revision, serial : int
        Identity 1018h; product 0 stands for the node-ID.
    device_name, hardware_version, software_version : str
        1008h (empty: the device's own), 1009h, 100Ah.
    """

    node: NodeId
    present: bool = True
    boot_ms: int = Field(default=50, ge=1, le=10_000)
    heartbeat_ms: int = Field(default=100, ge=0, le=65535)
    autostart: bool = False
    watched: tuple[WatchSettings, ...] = Field(default=(), max_length=4)
    vendor: Unsigned32 = 0x0000_0B1C
    product: Unsigned32 = 0
    revision: Unsigned32 = 0x0001_0000
    serial: Unsigned32 = 1
    device_name: str = Field(default="", max_length=64, pattern=r"^[ -~]*$")
    hardware_version: str = Field(default="1.0", max_length=32, pattern=r"^[ -~]*$")
    software_version: str = Field(default="bench 1.0", max_length=32, pattern=r"^[ -~]*$")


class RegulatorSettings(NodeSettings):
    """Pressure regulator.

    Attributes
    ----------
    range_bar : float
        Pressure of 100 % (16384).
    tpdo_ms : int
        Event time of TPDO1.
    loss_reaction : str
        2100h from power-on: "hold" (as devices come from their makers, dangerous) or "vent".
    window_bar, window_delay_ms : float, int
        Target window from power-on.
    """

    node: NodeId = 0x10
    range_bar: float = Field(default=50.0, gt=0.0, le=400.0)
    tpdo_ms: Milliseconds = 10
    loss_reaction: Literal["hold", "vent"] = "hold"
    window_bar: float = Field(default=0.5, gt=0.0, le=50.0)
    window_delay_ms: int = Field(default=100, ge=50, le=1000)


class AmplifierChannel(_Model):
    """One channel of the bridge amplifier: range in its unit, digits behind the point."""

    low: float
    high: float
    digits: int = Field(ge=0, le=6)

    @model_validator(mode="after")
    def _fits(self) -> AmplifierChannel:
        if not self.low < self.high:
            raise PydanticCustomError(
                "range", "low {low} is not below high {high}", {"low": self.low, "high": self.high}
            )
        if max(abs(self.low), abs(self.high)) * 10**self.digits >= 2**31 - 1:
            raise PydanticCustomError(
                "range",
                "{digits} digits do not fit into 32 bits",
                {"digits": self.digits, "remedy": "Use fewer."},
            )
        return self


class AmplifierSettings(NodeSettings):
    """Bridge amplifier: torque [N·m] and line pressure [bar]."""

    node: NodeId = 0x20
    tpdo_ms: Milliseconds = 1
    torque: AmplifierChannel = AmplifierChannel(low=-2000.0, high=2000.0, digits=2)
    pressure: AmplifierChannel = AmplifierChannel(low=-5.0, high=100.0, digits=4)


class CurrentInputSettings(NodeSettings):
    """Current input with the pyrometer's analog output: temperatures at 4 and 20 mA."""

    node: NodeId = 0x21
    tpdo_ms: Milliseconds = 10
    at_4ma_degc: float = 0.0
    at_20ma_degc: float = 600.0

    @model_validator(mode="after")
    def _rises(self) -> CurrentInputSettings:
        if not self.at_4ma_degc < self.at_20ma_degc:
            raise PydanticCustomError(
                "range",
                "at_20ma_degc {high} is not above at_4ma_degc {low}",
                {"low": self.at_4ma_degc, "high": self.at_20ma_degc},
            )
        return self


class EncoderSettings(NodeSettings):
    """Encoder: steps per turn and turns until the position wraps."""

    node: NodeId = 0x22
    tpdo_ms: Milliseconds = 1
    steps_per_turn: int = Field(default=4096, ge=1, le=1 << 20)
    turns: int = Field(default=4096, ge=1, le=4096)


class SafetyIoSettings(NodeSettings):
    """Safety I/O: time without a rising counter after which the relay opens, and the relay's own time."""

    node: NodeId = 0x30
    tpdo_ms: Milliseconds = 10
    relay_timeout_ms: int = Field(default=150, ge=10, le=5000)
    relay_delay_ms: int = Field(default=10, ge=1, le=100)


class AnalogOutputSettings(NodeSettings):
    """Analog output to the ventilator: air at 100 %, value on errors (32767: full air)."""

    node: NodeId = 0x31
    full_m3_h: float = Field(default=1000.0, gt=0.0)
    error_mode: int = Field(default=1, ge=0, le=1)
    error_value: int = Field(default=32767, ge=-32768, le=32767)


class BenchCanSettings(_Model):
    """All nodes of the bench.

    Attributes
    ----------
    delay_ms : int
        Age of the plant's samples that nodes report: at least the plant's step, so that 1 kHz PDOs always
        find the sample of their own millisecond.
    """

    delay_ms: int = Field(default=25, ge=0, le=1000)
    regulator: RegulatorSettings = RegulatorSettings()
    amplifier: AmplifierSettings = AmplifierSettings()
    current_input: CurrentInputSettings = CurrentInputSettings()
    encoder: EncoderSettings = EncoderSettings()
    safety_io: SafetyIoSettings = SafetyIoSettings()
    analog_output: AnalogOutputSettings = AnalogOutputSettings()

    @model_validator(mode="after")
    def _nodes_differ(self) -> BenchCanSettings:
        seen: dict[int, str] = {}
        for name in NODE_NAMES:
            node = getattr(self, name).node
            if node in seen:
                raise PydanticCustomError(
                    "node",
                    "node {node} is given to {first} and {second}",
                    {"node": node, "first": seen[node], "second": name, "remedy": "Give each its own."},
                )
            seen[node] = name
        return self


NODE_NAMES = ("regulator", "amplifier", "current_input", "encoder", "safety_io", "analog_output")
