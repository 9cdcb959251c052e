"""Plain building stones for the tests of ``sequences``: a valid sequence as a mapping, and a rig."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sequences.capabilities import RigCapabilities

MU_NOMINAL, MU_PEAK, NM_BAR_AT_MU_1 = 0.42, 0.65, 48.1


@pytest.fixture(scope="session")
def program_folder() -> Path:
    return Path(__file__).parents[3] / "configs" / "programs"


@pytest.fixture(scope="session")
def sequence_data() -> Callable[..., dict[str, Any]]:
    """Return a function that makes the mapping of a valid sequence with some entries replaced."""

    def make(**changes: Any) -> dict[str, Any]:
        data: dict[str, Any] = {
            "name": "some",
            "role": "matrix",
            "temperatures_degc": [50, 100],
            "speed_profiles": [{"duration_s": 10, "start_rpm": 40, "end_rpm": 40}],
            "pressures_bar": [5, 10, 15],
            "recording": {"channels": [{"name": "microphone"}, {"name": "torque", "decimation": 40}]},
        }
        data.update(changes)
        return {key: value for key, value in data.items() if value is not ...}

    return make


@pytest.fixture(scope="session")
def rig() -> RigCapabilities:
    """The paper's rig: 40 bar, 84 kW; thermal values of a solid disc of 4 kg."""
    slow = {"rate_hz": 4000.0}
    return RigCapabilities.model_validate(
        {
            "min_pressure_bar": 1.0,
            "max_pressure_bar": 40.0,
            "max_pressure_rate_bar_s": 80.0,
            "max_speed_rpm": 600.0,
            "max_speed_rate_rpm_s": 100.0,
            "max_torque_nm": 1000.0,
            "drive_power_kw": 84.0,
            "dead_pressure_bar": 0.5,
            "nominal_torque_nm_bar": NM_BAR_AT_MU_1 * MU_NOMINAL,
            "peak_torque_nm_bar": NM_BAR_AT_MU_1 * MU_PEAK,
            "max_disc_temperature_degc": 500.0,
            "conditioning_speed_rpm": 200.0,
            "conditioning_pressure_bar": 10.0,
            "start_s": 0.5,
            "release_s": 0.5,
            "thermal": {
                "heat_capacity_j_k": 1900.0,
                "still_w_k": 2.0,
                "ventilated_w_k": 10.0,
                "radiation_w_k4": 3e-9,
                "disc_heat_share": 0.92,
                "ambient_degc": 20.0,
            },
            "channels": {
                "microphone": {"rate_hz": 40000.0, "bytes_per_sample": 2, "is_sound": True},
                **{name: slow for name in ("torque", "pressure", "speed", "disc_temperature")},
            },
        }
    )
