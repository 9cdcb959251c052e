"""Friction and the evaluation of a whole braking, with missing channels and strange input."""

import numpy as np
import pytest

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.signals import _tracking, decimation, levels, spectra
from rigctl.signals.calibration import mean_square_pa2
from rigctl.signals.evaluation import Evaluation, evaluate, warm_up
from rigctl.signals.friction import FrictionGeometry, find_application, friction_coefficient
from rigctl.signals.squeal import SquealDetection

GEOMETRY = FrictionGeometry()
RATE_HZ = 40000


def slow(name, unit, values, rate_hz=1000.0, t0_s=0.0):
    return ChannelData(ChannelSpec(name, unit, rate_hz), t0_s, np.asarray(values, np.float32))


def braking(mu=0.42, p_bar=15.0, squeal_db=80.0, *, with_sound=True, t0_s=0.0, seconds=6.0):
    t = np.arange(int(seconds * 1000)) / 1000
    pressure = p_bar * np.clip(np.minimum((t - 1.0) / 0.3, (seconds - 0.5 - t) / 0.3), 0, 1) + 0.05
    torque = (
        mu
        * 2
        * np.clip(pressure - 0.5, 0, None)
        * 1e5
        * GEOMETRY.piston_area_m2
        * GEOMETRY.effective_radius_m
    )
    channels = {
        "pressure": slow("pressure", "bar", pressure, t0_s=t0_s),
        "torque": slow("torque", "N·m", torque, t0_s=t0_s),
        "speed": slow("speed", "1/min", np.full(t.size, 40.0), t0_s=t0_s),
        "disc_temperature": slow("disc_temperature", "°C", 100 + 2 * t, t0_s=t0_s),
    }
    if with_sound:
        ts = np.arange(int(seconds * RATE_HZ)) / RATE_HZ
        rng = np.random.default_rng(0)
        x = np.sqrt(mean_square_pa2(50.0)) * rng.standard_normal(ts.size)
        on = (ts > 2.5) & (ts < 4.5)
        x += on * np.sqrt(2 * mean_square_pa2(squeal_db)) * np.sin(2 * np.pi * 2350 * ts)
        scale = 20 / 32768
        spec = ChannelSpec("microphone", "Pa", RATE_HZ, "int16", scale)
        channels["microphone"] = ChannelData(spec, t0_s, np.round(x / scale).astype(np.int16))
    return channels


def run(channels, **detection):
    return evaluate(channels, friction=GEOMETRY, detection=SquealDetection(**detection))


def test_a_squealing_braking():
    result = run(braking())
    (event,) = result.events
    assert event.frequency_hz == pytest.approx(2350, abs=1)
    assert event.level_db == pytest.approx(80, abs=0.2)
    assert event.pressure_bar == pytest.approx(15.05, abs=0.01)
    assert event.speed_rpm == pytest.approx(40)
    assert event.temperature_degc == pytest.approx(100 + 2 * event.peak_s, abs=0.1)
    assert event.mu == pytest.approx(0.42, abs=0.001)
    assert result.mean_mu == pytest.approx(0.42, abs=1e-3)
    assert result.std_mu < 1e-3
    assert result.n_squeal == 1
    assert result.main_event == event
    assert result.application_s == pytest.approx((1.019, 5.481), abs=0.003)
    assert result.background_db == pytest.approx(50.0, abs=0.3)
    assert result.background_frames > 10
    assert result.clipped_share == 0.0
    # 2 s of 80 dB in 4.46 s of brake application
    assert result.leq_db == pytest.approx(80 + 10 * np.log10(2 / 4.46), abs=0.05)
    assert result.laeq_db == pytest.approx(result.leq_db + 1.27, abs=0.15)
    assert result.lmax_db == pytest.approx(80.0, abs=0.05)


def test_statistics_follow_the_stated_rule():
    stats = run(braking()).channels
    assert "microphone" not in stats
    pressure = stats["pressure"]
    assert pressure.maximum == pytest.approx(15.05, abs=0.01)
    assert pressure.minimum == pytest.approx(0.05, abs=0.01)
    assert 14.9 < pressure.mean < 15.06
    temperature = stats["disc_temperature"]
    assert temperature.initial == pytest.approx(102.0, abs=0.1)
    assert temperature.final == pytest.approx(111.0, abs=0.1)


def test_times_follow_the_time_axis_of_the_channels():
    a, b = run(braking()), run(braking(t0_s=100.0))
    assert b.events[0].start_s - a.events[0].start_s == pytest.approx(100.0)
    assert b.events[0].level_db == a.events[0].level_db
    assert b.application_s[0] == pytest.approx(100 + a.application_s[0])


def test_bedding_braking_without_microphone():
    result = run(braking(with_sound=False))
    assert result.events == ()
    assert result.leq_db is result.lmax_db is result.background_db is result.clipped_share is None
    assert result.mean_mu == pytest.approx(0.42, abs=1e-3)


def test_sound_alone_is_evaluated():
    result = run({"microphone": braking()["microphone"]})
    assert len(result.events) == 1
    assert result.events[0].pressure_bar is None
    assert result.events[0].mu is None
    assert result.mean_mu is None
    assert result.application_s is None


@pytest.mark.parametrize("missing", ["torque", "speed", "disc_temperature", "pressure"])
def test_any_channel_may_be_missing(missing):
    channels = braking()
    del channels[missing]
    result = run(channels)
    assert len(result.events) == 1
    assert (result.mean_mu is None) == (missing != "disc_temperature")


def test_nothing_at_all_and_empty_channels():
    assert run({}).events == ()
    empty = {name: ChannelData(d.spec, 0.0, d.samples[:0]) for name, d in braking().items()}
    assert run(empty).channels == {}


def test_no_brake_application_gives_no_mu():
    channels = braking(p_bar=0.3)
    result = run(channels)
    assert result.mean_mu is None
    assert result.application_s is None


def test_broken_sensor_gives_none_instead_of_nan():
    channels = braking()
    channels["torque"].samples[:] = np.nan
    channels["disc_temperature"].samples[::2] = np.nan
    result = run(channels)
    assert result.mean_mu is None
    assert result.events[0].mu is None
    assert result.channels["torque"].mean is None
    assert result.channels["disc_temperature"].mean == pytest.approx(106.5, abs=0.5)
    assert Evaluation.model_validate_json(result.model_dump_json()) == result


def test_dump_and_load():
    result = run(braking())
    assert Evaluation.model_validate_json(result.model_dump_json()) == result


def test_clipping_is_reported():
    channels = braking(squeal_db=120.0)
    assert np.abs(channels["microphone"].samples.astype(int)).max() >= 32767 - 1
    clipped = ChannelData(
        channels["microphone"].spec, 0.0, np.where(np.arange(240000) % 10 == 0, 32767, 0).astype(np.int16)
    )
    assert run({**channels, "microphone": clipped}).clipped_share == pytest.approx(0.1)


def test_channels_of_different_rates_are_laid_on_the_pressure_grid():
    channels = braking()
    torque = channels["torque"]
    channels["torque"] = slow("torque", "N·m", torque.samples[::5], rate_hz=200.0)
    assert run(channels).mean_mu == pytest.approx(0.42, abs=0.002)


def test_decimated_input_gives_the_same_mu_as_raw_input():
    from rigctl.signals.decimation import decimate

    raw = {k: v for k, v in braking().items() if k != "microphone"}
    small = {
        k: ChannelData(ChannelSpec(k, v.spec.unit, 250.0), 0.0, decimate(v.samples, 4))
        for k, v in raw.items()
    }
    assert run(small).mean_mu == pytest.approx(run(raw).mean_mu, abs=1e-4)


def test_mu_formula_and_where_it_is_undefined():
    pressure = np.array([0.0, 0.9, 10.5, 10.5, 10.5])
    speed = np.array([40.0, 40.0, 40.0, 0.0, -40.0])
    torque = np.array([0.0, 5.0, 192.36, 100.0, -192.36])
    mu = friction_coefficient(torque, pressure, speed, GEOMETRY)
    assert np.isnan(mu[[0, 1, 3]]).all()
    # 10 bar above p0, A = 22.9 cm2, r = 0.105 m: 48.09 N·m per unit mu and bar
    assert mu[2] == mu[4] == pytest.approx(192.36 / 480.9, rel=1e-4)


def test_application_is_found_and_its_settled_part_excludes_the_ramps():
    pressure = np.concatenate(
        (np.zeros(10), np.linspace(0, 20, 21), np.full(50, 20.0), np.linspace(20, 0, 21))
    )
    app = find_application(pressure, GEOMETRY)
    assert (app.start, app.stop) == (12, 100)
    assert (app.settled_start, app.settled_stop) == (28, 84)
    assert find_application(np.zeros(5), GEOMETRY) is None


def test_after_warm_up_nothing_is_compiled_any_more():
    warm_up()
    kernels = (
        _tracking.find_peaks,
        _tracking.track_peaks,
        spectra._fill_frames,
        spectra._to_power,
        levels._square_sums,
        decimation._filter,
    )
    before = [len(kernel.signatures) for kernel in kernels]
    channels = braking()
    for writeable in (True, False):
        channels["microphone"].samples.flags.writeable = writeable
        run(channels)
    decimation.decimate(channels["torque"].samples, 4)
    assert [len(kernel.signatures) for kernel in kernels] == before
