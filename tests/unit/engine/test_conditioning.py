"""Conditioning on the real plant: arrives, stays, learns, and gives up with a reason."""

import pytest

from rigctl.core.errors import RunError
from rigctl.engine.conditioning import Air, Conditioner
from rigctl.engine.state import Progress
from sequences.braking import Conditioning

HOW = Conditioning(tolerance_k=2.0, soak_s=1.0, timeout_s=900.0)


def condition(rig, conditioner: Conditioner, target_degc: float, how: Conditioning = HOW) -> float:
    """Run a conditioning script; returns the rig time it took."""
    script = conditioner.condition(target_degc, how)
    next(script)
    start_s = None
    for block in rig.blocks():
        start_s = block.t_s if start_s is None else start_s
        try:
            script.send(block)
        except StopIteration:
            return block.end_s - start_s
    raise AssertionError


def conditioner_of(rig) -> Conditioner:
    rig.drive.enable()
    return Conditioner(rig, Air(rig), Progress())


def test_arrives_within_the_tolerance_and_without_hunting(make_rig):
    rig, session = make_rig()
    conditioner = conditioner_of(rig)
    condition(rig, conditioner, 60.0)
    for target_degc in (100.0, 95.0, 200.0, 290.0, 280.0, 310.0):
        seconds = condition(rig, conditioner, target_degc)
        assert session.plant.truth.surface_degc == pytest.approx(
            target_degc, abs=6.0
        )  # pyrometer error included
        assert seconds < 200.0
        assert session.setpoints.pressure_bar == 0.0


def test_surface_and_body_have_come_together(make_rig):
    rig, session = make_rig()
    condition(rig, conditioner_of(rig), 200.0)
    truth = session.plant.truth
    assert abs(truth.surface_degc - truth.bulk_degc) < 6.0  # 25 K while dragging at full power


def test_at_most_only_cools(make_rig):
    rig, session = make_rig()
    conditioner = conditioner_of(rig)
    how = Conditioning(mode="at_most", tolerance_k=5.0, soak_s=0.0, timeout_s=900.0)
    assert condition(rig, conditioner, 100.0, how) <= 1.0  # cold already: nothing to do
    assert session.plant.truth.bulk_degc == pytest.approx(20.0, abs=1.0)
    session.plant.set_condition(disc_degc=180.0)
    assert condition(rig, conditioner, 100.0, how) > 10.0
    assert session.plant.truth.surface_degc < 106.0


def test_unreachable_temperature_ends_with_a_reason(make_rig):
    rig, _ = make_rig()
    how = Conditioning(tolerance_k=2.0, soak_s=0.0, timeout_s=20.0)
    with pytest.raises(RunError, match=r"not 300 °C, after 20 s.*Raise timeout_s"):
        condition(rig, conditioner_of(rig), 300.0, how)


def test_ventilator_is_off_afterwards(make_rig):
    rig, session = make_rig()
    conditioner = conditioner_of(rig)
    session.plant.set_condition(disc_degc=150.0)
    condition(rig, conditioner, 60.0)
    assert session.setpoints.ventilator_m3_h == 0.0


class OwnAir:
    """A ventilator that blows by itself until somebody commands it, as real ones do for safety."""

    commanded_m3_h = 1000.0

    def set_flow(self, flow_m3_h: float) -> None:
        self.commanded_m3_h = flow_m3_h


def test_air_that_a_device_blows_by_itself_is_stopped(make_rig):
    """... before a braking, also without conditioning; and again when it has lost its lease meanwhile."""
    rig, _ = make_rig()
    rig.ventilator = OwnAir()
    air = Air(rig)
    block = next(rig.blocks())
    assert air.flow_m3_h == 1000.0
    air.stop(block)
    assert air.flow_m3_h == 0.0 and not air.still(block)
    rig.ventilator.commanded_m3_h = 1000.0
    air.stop(block)
    assert rig.ventilator.commanded_m3_h == 0.0
