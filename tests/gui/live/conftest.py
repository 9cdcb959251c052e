"""A small acquisition that writes into a real ring, for the tests of the live plots."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from rigctl.core.channels import ChannelSpec
from rigctl.core.ring import RING_NAME, SampleRing
from rigctl.gui.live.view import LiveView
from rigctl.gui.services import Services

BLOCK_S = 0.05
SPECS = (
    ChannelSpec("microphone", "Pa", 40_000.0, "int16", scale=20.0 / 32768),
    ChannelSpec("torque", "N·m", 1000.0),
    ChannelSpec("pressure", "bar", 1000.0),
    ChannelSpec("speed", "1/min", 1000.0),
    ChannelSpec("disc_temperature", "°C", 1000.0),
    ChannelSpec("pad_temperature", "°C", 1000.0),
    ChannelSpec("vibration", "m/s²", 1000.0),
)
CAMPAIGN = """
[rig.friction]
piston_area_m2 = 2.29e-3
effective_radius_m = 0.105
p0_bar = 0.5
[rig.safety]
limits = "config/limits.toml"
"""
LIMITS = """
pressure = { min_bar = -1.0, max_bar = 24.0 }
speed = { min_rpm = -10.0, max_rpm = 840.0 }
torque = { min_nm = -150.0, max_nm = 1300.0 }
disc_temperature = { min_degc = 5.0, max_degc = 500.0 }
"""


class Acquisition:
    """Blocks of 20 bar at 150 1/min with mu 0.4 and a squeal of 2350 Hz."""

    def __init__(self, folder: Path, services: Services) -> None:
        self.run_dir = folder / "run"
        self.campaign = folder / "campaign"
        self.run_dir.mkdir()
        (self.campaign / "config").mkdir(parents=True)
        (self.campaign / "campaign.toml").write_text(CAMPAIGN)
        (self.campaign / "config" / "limits.toml").write_text(LIMITS)
        self.rig = services.rig
        self.ring = SampleRing.create(self.run_dir / RING_NAME, SPECS)
        self.k = 0

    def attach(self) -> None:
        self.rig.attached.emit(SimpleNamespace(run_dir=self.run_dir, campaign=self.campaign))

    def blocks(self, count: int, *, sound: bool = True) -> None:
        made = []
        for _ in range(count):
            t_s, self.k = self.k * BLOCK_S, self.k + 1
            ones = np.ones(50, np.float32)
            values = {
                "pressure": 20.0 * ones, "speed": 150.0 * ones, "disc_temperature": 120.0 * ones,
                "pad_temperature": 90.0 * ones, "vibration": ones,
                "torque": 0.4 * 2 * 19.5e5 * 2.29e-3 * 0.105 * ones,
            }  # fmt: skip
            ranges = {name: self.ring.write(name, x) for name, x in values.items()}
            t = t_s + np.arange(2000) / 40_000.0
            x = np.sin(2 * np.pi * 2350.0 * t) / 20.0 * 32768
            sound_now = x.astype(np.int16) if sound else np.empty(0, np.int16)
            ranges["microphone"] = self.ring.write("microphone", sound_now)
            made.append({"t_ns": round(t_s * 1e9), "dt_ns": 50_000_000, "stride": 1, "ranges": ranges})
        self.rig.blocksArrived.emit(made)


@pytest.fixture
def acquisition(services: Services, tmp_path: Path) -> Acquisition:
    """Not attached yet."""
    return Acquisition(tmp_path, services)


@pytest.fixture
def live_view(services: Services, qtbot) -> Callable[..., LiveView]:
    """Makes a shown view; it is stopped and closed at the end of the test."""
    made: list[LiveView] = []

    def make(size: tuple[int, int] = (1000, 700), **options: object) -> LiveView:
        view = LiveView(services, **options)  # type: ignore[arg-type]
        qtbot.addWidget(view)
        view.resize(*size)
        view.show()
        qtbot.waitExposed(view)
        view.start()
        made.append(view)
        return view

    yield make
    for view in made:
        view.stop()
