"""Steps of the plant: grids, repeatability, independence of the block length, refusals."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plant_rig import MS, TURN, Rig, shipped_brake, shipped_settings

from sim_hardware.plant import Commands, Plant

SLOW = ("torque", "pressure", "speed", "disc_temperature")


def test_channels_are_those_of_the_rig():
    plant = Rig().plant
    assert [spec.name for spec in plant.channels] == ["microphone", *SLOW]
    assert plant.sound_channel.dtype == "int16" and plant.sound_channel.rate_hz == 40_000.0
    assert plant.sound_channel.scale * 32768 == pytest.approx(20.0)
    assert all(spec.dtype == "float32" and spec.rate_hz == 4000.0 for spec in plant.channels[1:])


def test_full_rate_step_delivers_all_samples_and_sound():
    plant = Rig().plant
    step = plant.step(50 * MS, TURN, full_rate=True)
    assert step.stride == 1
    assert {name: (len(s), s.dtype) for name, s in step.samples.items()} == dict.fromkeys(
        SLOW, (200, np.float32)
    )
    sound = plant.render_sound()
    assert sound.shape == (2000,) and sound.dtype == np.int16


@pytest.mark.parametrize(
    ("dt_ms", "stride", "samples", "readings"),
    [(500, 200, 10, 50), (50, 200, 1, 5), (75, 100, 3, 8), (1, 4, 1, 1)],
)
def test_monitoring_step_is_sparse(dt_ms, stride, samples, readings):
    step = Rig().plant.step(dt_ms * MS, TURN, full_rate=False)
    assert step.stride == stride
    assert all(len(step.samples[name]) == samples for name in SLOW)
    assert {name: len(values) for name, values in step.safety.items()} == dict.fromkeys("pnMT", readings)


def test_safety_readings_are_plain_numbers_of_other_sensors():
    rig = Rig().turn(200.0)
    step = rig.plant.step(50 * MS, rig.commands, full_rate=True)
    assert json.loads(json.dumps(step.safety)) == step.safety
    controller = step.samples["speed"][::40]
    assert not np.any(np.isclose(step.safety["n"], controller, rtol=0, atol=1e-6))
    assert np.mean(step.safety["n"]) == pytest.approx(200.0 * 1.005, abs=0.3)  # tacho with its own gain error


@pytest.mark.parametrize("dt_ns", [0, -50 * MS, 100_000, 50 * MS + 1])
def test_a_step_is_a_whole_number_of_ticks(dt_ns):
    with pytest.raises(ValueError, match="250000"):
        Rig().plant.step(dt_ns, TURN, full_rate=True)


def test_set_points_must_be_finite():
    with pytest.raises(ValueError, match="finite"):
        Rig().plant.step(50 * MS, Commands(pressure_set_bar=math.nan), full_rate=True)


def test_sound_is_delivered_once_and_only_after_a_full_step():
    plant = Rig().plant
    with pytest.raises(RuntimeError, match="full_rate"):
        plant.render_sound()
    plant.step(50 * MS, TURN, full_rate=True)
    plant.render_sound()
    with pytest.raises(RuntimeError):
        plant.render_sound()
    plant.step(50 * MS, TURN, full_rate=True)
    plant.step(50 * MS, TURN, full_rate=False)
    with pytest.raises(RuntimeError):
        plant.render_sound()


def _everything(seed: int) -> list[np.ndarray]:
    rig = Rig(seed).turn()
    rig.plant.set_condition(disc_degc=140.0, bedding=0.9)
    parts = [rig.listen(1.0, pressure_set_bar=16.0)]
    slow = rig.run(0.5)
    safety = rig.plant.step(500 * MS, rig.commands, full_rate=False).safety
    return [*parts, *(slow[name] for name in SLOW), *(np.array(safety[name]) for name in "pnMT")]


def test_same_seed_is_equal_bit_for_bit_and_another_is_not():
    first, again, other = _everything(5), _everything(5), _everything(6)
    assert all(a.tobytes() == b.tobytes() for a, b in zip(first, again, strict=True))
    assert all(a.tobytes() != b.tobytes() for a, b in zip(first, other, strict=True))


def test_compiling_does_not_touch_the_rig():
    fresh, compiled = Rig(3), Rig(3)
    compiled.plant.compile()
    a, b = fresh.run(0.2, **_up()), compiled.run(0.2, **_up())
    assert all(np.array_equal(a[name], b[name]) for name in SLOW)


def _up() -> dict:
    return {"speed_set_rpm": 40.0, "drive_enabled": True, "relay_closed": True, "pressure_set_bar": 5.0}


@settings(max_examples=15, deadline=None)
@given(st.lists(st.integers(1, 400), min_size=1, max_size=6))
def test_block_length_does_not_matter_to_the_slow_channels(lengths):
    """However a second is cut into full-rate steps, the same samples come out."""
    total = sum(lengths)
    whole = Plant(shipped_settings(), shipped_brake(), seed=2)
    pieces = Plant(shipped_settings(), shipped_brake(), seed=2)
    commands = Commands(**_up())
    expected = whole.step(total * 250_000, commands, full_rate=True).samples
    got = [pieces.step(n * 250_000, commands, full_rate=True).samples for n in lengths]
    for name in SLOW:
        assert np.array_equal(expected[name], np.concatenate([part[name] for part in got]))


def test_monitoring_and_full_rate_tell_the_same_story():
    """Spin up, brake, release: coarse mechanics stay close to fine ones, temperatures too."""
    truths = []
    for full_rate, block_ms in ((True, 50), (False, 500)):
        rig = Rig(4)
        rig.run(3.0, full_rate=full_rate, block_ms=block_ms, **{**_up(), "pressure_set_bar": 0.0})
        rig.run(6.0, full_rate=full_rate, block_ms=block_ms, pressure_set_bar=20.0)
        braking = rig.plant.truth
        rig.run(2.0, full_rate=full_rate, block_ms=block_ms, pressure_set_bar=0.0)
        truths.append((braking, rig.plant.truth))
    (fine, fine_end), (coarse, coarse_end) = truths
    assert coarse.speed_rpm == pytest.approx(fine.speed_rpm, abs=0.1)
    assert coarse.pressure_bar == pytest.approx(fine.pressure_bar, abs=0.03)
    assert coarse.brake_torque_nm == pytest.approx(fine.brake_torque_nm, rel=3e-3)
    assert coarse.friction_energy_j == pytest.approx(fine.friction_energy_j, rel=3e-3)
    assert coarse_end.surface_degc == pytest.approx(fine_end.surface_degc, abs=0.05)
    assert coarse_end.pressure_bar == pytest.approx(fine_end.pressure_bar, abs=0.03)


@pytest.mark.parametrize("wrong", [{"bedding": 1.0}, {"bedding": -0.1}, {"disc_degc": math.inf}])
def test_impossible_conditions_are_refused(wrong):
    with pytest.raises(ValueError, match="give"):
        Rig().plant.set_condition(**wrong)
