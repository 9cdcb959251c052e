"""The pyrometer on UPP as a source, on the emulated one behind a pty with faults of bytes.

Each fault ends in invalid samples or an error that names the source, never in a wrong temperature.
"""

import time

import numpy as np
import pytest
from daq_rig import DISC_DEGC, Rig

from drivers.daq.acquisition import LiveAcquisition
from rigctl.core.errors import DeviceError
from rigctl.hal.devices import Request

RECORDING = Request(50_000_000, recording=True)


@pytest.fixture
def rig(tmp_path):
    made = Rig(tmp_path, pyrometer=True)
    yield made
    made.close()


@pytest.fixture
def settings(rig):
    return {"kind": "upp", "port": str(rig.folder / "pyrometer"), "emissivity": 1.0}


@pytest.fixture
def opened(rig, settings):
    context = rig.context()
    device = LiveAcquisition({"sources": {"pyrometer": settings}}, context)
    device.open()
    yield device, context
    device.close()


def temperatures(device, count):
    return np.concatenate([device.next_block(RECORDING).samples("disc_temperature") for _ in range(count)])


def test_it_gives_the_temperature_at_1_khz_and_its_identity(opened):
    device, _ = opened
    degc = temperatures(device, 10)
    assert len(degc) == 500
    assert degc == pytest.approx(DISC_DEGC, abs=0.06)
    identity = device.identity()
    assert identity["pyrometer.serial"] == "00590"
    assert identity["pyrometer.emissivity"] == "1"
    diagnosis = device.diagnose(5)
    assert len(diagnosis.round_trip_s) == 5
    assert diagnosis.values[0].value == pytest.approx(DISC_DEGC, abs=0.06)


def test_error_values_are_never_temperatures(rig, opened):
    device, context = opened
    temperatures(device, 3)
    for error in (88880, 77770, 75550, 74440):
        rig.ports["pyrometer"].command({"do": "error", "value": error})
        degc = temperatures(device, 10)
        assert np.all(np.isnan(degc[-200:])), error
        assert np.nanmax(np.abs(degc - DISC_DEGC), initial=0.0) < 0.06, error
        assert "pyrometer: disc_temperature" in context.board.snapshot()["faults"], error
        rig.ports["pyrometer"].command({"do": "error", "value": 0})
        assert temperatures(device, 10)[-200:] == pytest.approx(DISC_DEGC, abs=0.06), error
        assert "faults" not in context.board.snapshot(), error


def test_a_disturbed_line_gives_no_wrong_temperature(rig, opened):
    device, _ = opened
    temperatures(device, 3)
    for kind, probability in (
        ("corrupt", 0.1),
        ("drop", 0.1),
        ("duplicate", 0.1),
        ("split", 0.1),
        ("delay", 0.3),
    ):
        fault = {"do": "fault", "kind": kind, "direction": "to_host", "probability": probability}
        rig.ports["pyrometer"].command(fault | ({"silence_s": 0.15} if kind == "delay" else {}))
        degc = temperatures(device, 30)
        wrong = np.abs(degc[np.isfinite(degc)] - DISC_DEGC)
        # without a checksum, a flipped digit below the jump limit cannot be told from a temperature
        assert np.max(wrong, initial=0.0) <= 50.0, kind
        rig.ports["pyrometer"].command({"do": "clear"})
        for _ in range(10):  # up to 20 blocks for it to recover
            degc = temperatures(device, 2)
            if degc == pytest.approx(DISC_DEGC, abs=0.06):
                break
        else:
            pytest.fail(f"{kind}: {degc} after it has ended")


def test_a_pyrometer_without_power_is_named(rig, opened):
    device, _ = opened
    temperatures(device, 3)
    rig.ports["pyrometer"].command({"do": "power", "on": False})
    deadline = time.monotonic() + 4.0
    with pytest.raises(DeviceError, match=r"sources\.pyrometer: has delivered no sample"):
        while time.monotonic() < deadline:
            device.next_block(RECORDING)


def test_an_unplugged_line_is_named(rig, opened):
    device, _ = opened
    temperatures(device, 3)
    rig.ports["pyrometer"].command({"do": "unplug"})
    deadline = time.monotonic() + 4.0
    with pytest.raises(DeviceError, match=r"sources\.pyrometer: (the line is gone|has delivered no sample)"):
        while time.monotonic() < deadline:
            device.next_block(RECORDING)


def test_an_emissivity_that_differs_is_refused_or_set(rig, settings):
    other = settings | {"emissivity": 0.85}
    with pytest.raises(DeviceError, match=r"set to an emissivity of 1, the rig file says 0\.85"):
        LiveAcquisition({"sources": {"pyrometer": other}}, rig.context()).open()
    device = LiveAcquisition({"sources": {"pyrometer": other | {"configure": True}}}, rig.context())
    device.open()
    try:
        assert device.identity()["pyrometer.emissivity"] == "0.85"
    finally:
        device.close()


def test_a_missing_port_or_a_wrong_address_is_named(rig, settings):
    missing = settings | {"port": str(rig.folder / "nothing")}
    with pytest.raises(DeviceError, match=r"sources\.pyrometer\.port: the port .* does not open"):
        LiveAcquisition({"sources": {"pyrometer": missing}}, rig.context()).open()
    with pytest.raises(DeviceError, match=r"does not answer to 07ms"):
        LiveAcquisition({"sources": {"pyrometer": settings | {"address": 7}}}, rig.context()).open()
