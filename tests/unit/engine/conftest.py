"""A rig within the test's own process: the real plant and rig file, without processes and sockets."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.core.blocks import Block
from rigctl.core.channels import ChannelSpec
from rigctl.core.registry import Registry
from rigctl.core.ring import SampleRing
from rigctl.hal.devices import Request, RigContext
from rigctl.hal.rig import Rig
from sim_hardware.brake_model import load_brake
from sim_hardware.devices import roles
from sim_hardware.plant import Commands, Plant, PlantSettings


class PlantSession:
    """Stands in for `SimulatedSession`: the plant is stepped at once. The relay is closed."""

    def __init__(self, context: RigContext, configs: Path) -> None:
        settings = load_model(configs / "plants" / "a_class.toml", PlantSettings)
        self.plant = Plant(settings, load_brake(configs / "brakes" / "plant.toml"), seed=context.seed or 0)
        self.ring = SampleRing.create(context.run_dir / "ring", self.plant.channels)
        self.setpoints = roles.SimulatedSession(context).setpoints
        self.status: dict[str, Any] = {"relay": True, "estop": True, "doors": True}
        self.channels: Sequence[ChannelSpec] = self.plant.channels
        self.arguments: list[str] = []
        self.relay_timeout_s = 0.0
        self.blocks: list[Block] = []
        self._k = self._t_ns = 0

    def open(self) -> None:
        pass

    def close(self) -> None:
        pass

    def next_block(self, request: Request) -> Block:
        points = self.setpoints
        relay = bool(self.status["relay"])
        step = self.plant.step(
            request.dt_ns,
            Commands(
                speed_set_rpm=points.speed_rpm,
                speed_ramp_rpm_per_s=points.ramp_rpm_per_s,
                drive_enabled=points.enable and relay,
                quick_stop=points.quick_stop,
                pressure_set_bar=points.pressure_bar,
                vent=points.vent or not relay,
                ventilator_m3_h=points.ventilator_m3_h,
                relay_closed=relay,
            ),
            full_rate=request.recording,
        )
        ranges = {name: self.ring.write(name, samples) for name, samples in step.samples.items()}
        sound = self.plant.render_sound() if request.recording else None
        written = self.ring.written("microphone")
        ranges["microphone"] = (written, written) if sound is None else self.ring.write("microphone", sound)
        block = Block(self._k, self._t_ns, request.dt_ns, ranges, self.ring, step.stride, dict(self.status))
        self._k += 1
        self._t_ns += request.dt_ns
        return block


@pytest.fixture
def make_rig(tmp_path: Path, configs: Path) -> Iterator[Any]:
    """Factory of rigs: `make_rig(seed=1)` -> (Rig, PlantSession)."""
    rigs: list[Rig] = []

    def make(seed: int = 1) -> tuple[Rig, PlantSession]:
        config = load_model(configs / "rigs" / "simulated.toml", RigConfig)
        run_dir = tmp_path / f"run{len(rigs)}"
        run_dir.mkdir()
        context = RigContext(run_dir, "virtual", seed, "simulated.toml", configs / "rigs")
        session = context.share("simulated", lambda: PlantSession(context, configs))
        registry = Registry()
        for role, name in _CLASSES.items():
            registry.register(role, "simulated", f"sim_hardware.devices.roles:{name}")
        rig = Rig(config, context, registry)
        rig.open()
        rigs.append(rig)
        return rig, session

    yield make
    for rig in rigs:
        rig.close()


_CLASSES: Mapping[str, str] = {
    "drive": "SimulatedDrive",
    "pressure": "SimulatedPressureActuator",
    "ventilator": "SimulatedVentilator",
    "acquisition": "SimulatedAcquisition",
    "safety": "SimulatedSafetyChannel",
}
