"""Worlds in which the actuator suites run: the driver on emulated CAN nodes, and the simulated device."""

import pytest
from can_worlds import EmulatedWorld, SimulatedWorld


@pytest.fixture(params=["emulated", "simulated"])
def world(request, tmp_path):
    made = EmulatedWorld(tmp_path) if request.param == "emulated" else SimulatedWorld(tmp_path)
    yield made
    made.close()


@pytest.fixture
def wire(tmp_path):
    made = EmulatedWorld(tmp_path)
    yield made
    made.close()
