"""The sound of the simulated rig: quiet background, ventilator, hiss, and squeal as the eigenvalues say."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rigctl.signals.spectra import spectrogram
from rigctl.signals.squeal import SquealDetection, detect_squeal
from sim_hardware.brake_model import load_brake
from sim_hardware.plant import Commands, Plant, PlantSettings

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
MS = 1_000_000
SETTINGS = PlantSettings.model_validate(tomllib.loads((CONFIGS / "plants" / "a_class.toml").read_text()))
BRAKE = load_brake(CONFIGS / "brakes" / "plant.toml")
TURN = Commands(speed_set_rpm=40.0, speed_ramp_rpm_per_s=100.0, drive_enabled=True, relay_closed=True)
HZ = 40_000.0


def changed(section, **values):
    part = getattr(SETTINGS, section)
    return SETTINGS.model_copy(update={section: part.model_copy(update=values)})


def turning(seed=1, settings=SETTINGS, brake=BRAKE, degc=20.0):
    plant = Plant(settings, brake, seed=seed)
    for _ in range(4):
        plant.step(500 * MS, TURN, full_rate=False)
    plant.set_condition(disc_degc=degc, bedding=0.9)
    return plant


def listen(plant, duration_s, commands):
    parts = []
    for _ in range(round(duration_s * 20)):
        plant.step(50 * MS, commands, full_rate=True)
        parts.append(plant.render_sound())
    return np.concatenate(parts) * plant.sound_channel.scale


def level_db(sound_pa):
    """Sound pressure level between 20 Hz and 20 kHz, dB(Z)."""
    power = np.abs(np.fft.rfft(sound_pa)) ** 2
    power[: round(20.0 * len(sound_pa) / HZ)] = 0.0
    return 10 * np.log10(2 * power.sum() / len(sound_pa) ** 2 / 4e-10)


def line(sound_pa, low_hz=1000.0):
    """Loudest line above low_hz of the mean spectrum: frequency (interpolated) and level."""
    spec = spectrogram(sound_pa, HZ, fft_size=16384, hop=8192)
    power = spec.power.mean(axis=0, dtype=float)
    first = round(low_hz / spec.line_hz)
    k = first + int(np.argmax(power[first:]))
    a, b, c = np.log(power[k - 1 : k + 2])
    return (k + 0.5 * (a - c) / (a - 2 * b + c)) * spec.line_hz, 10 * np.log10(power[k] / 4e-10)


def events(sound_pa):
    found = detect_squeal(spectrogram(sound_pa, HZ), SquealDetection(), window_s=(0.5, len(sound_pa) / HZ))
    return [event for event in found if event.harmonic_of is None]


def prediction(truth, brake):
    """Least stable pair of eigenvalues at the rig's working point: growth 1/s, frequency Hz."""
    values = np.linalg.eigvals(
        brake.state_matrix(truth.mu, truth.slope_s_m, (truth.pressure_bar - 0.5) * 1e5)
    )
    values = values[values.imag > 2 * np.pi * 1000]
    worst = values[np.argmax(values.real)]
    return worst.real, worst.imag / (2 * np.pi)


def test_background_is_about_50_db_with_the_drive_running():
    sound = listen(turning(), 3.0, TURN)
    assert level_db(sound) == pytest.approx(50.5, abs=1.5)
    assert events(sound) == []
    assert line(sound)[1] < 40.0
    motor = line(sound, low_hz=200.0)
    assert motor[0] == pytest.approx(300.0, abs=2.0) and motor[1] == pytest.approx(40.0, abs=1.5)


def test_ventilator_makes_65_db_and_is_gone_three_seconds_after_it_was_switched_off():
    plant = turning()
    on = replace(TURN, ventilator_m3_h=1000.0)
    plant.step(5000 * MS, on, full_rate=False)
    sound = listen(plant, 2.0, on)
    assert level_db(sound) == pytest.approx(65.4, abs=1.5)
    assert events(sound) == []
    plant.step(3000 * MS, TURN, full_rate=False)
    assert level_db(listen(plant, 2.0, TURN)) < 52.0


def test_valve_hisses_when_pressure_comes_and_goes_but_is_no_squeal():
    plant = turning(degc=30.0)
    before = level_db(listen(plant, 0.5, TURN))
    onset = listen(plant, 0.5, replace(TURN, pressure_set_bar=9.0))
    assert level_db(onset) > before + 3.0
    vented = listen(plant, 0.3, replace(TURN, vent=True))
    assert level_db(vented) > before + 6.0
    assert events(np.concatenate([onset, vented])) == []


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_no_tone_at_8_bar_whatever_the_temperature(seed):
    for degc in (30.0, 140.0, 300.0):
        sound = listen(turning(seed, degc=degc), 4.0, replace(TURN, pressure_set_bar=8.0))
        assert events(sound) == []
        assert line(sound[int(HZ) :])[1] < 50.0


@pytest.mark.parametrize(("pressure_bar", "degc"), [(13.0, 140.0), (20.0, 110.0), (30.0, 200.0)])
def test_squeal_has_the_frequency_of_the_unstable_eigenvalue(pressure_bar, degc):
    plant = turning(2, degc=degc)
    sound = listen(plant, 5.0, replace(TURN, pressure_set_bar=pressure_bar))
    growth, predicted_hz = prediction(plant.truth, BRAKE)
    assert growth > 0.0
    found = events(sound)
    assert found
    assert all(abs(event.frequency_hz - 2350.0) < 50.0 for event in found)
    frequency, level = line(sound[2 * int(HZ) :])
    assert frequency == pytest.approx(predicted_hz, abs=10.0)
    assert 65.0 <= level <= 105.0
    assert min(event.start_s for event in found) < 1.8  # grows from the roughness of the surfaces


def test_squeal_gets_louder_with_pressure():
    levels = [
        line(listen(turning(4, degc=140.0), 4.0, replace(TURN, pressure_set_bar=p))[2 * int(HZ) :])[1]
        for p in (13.0, 18.0, 30.0)
    ]
    assert levels == sorted(levels) and levels[-1] - levels[0] > 8.0


@pytest.mark.parametrize("degc", [40.0, 130.0, 250.0])
def test_onset_over_pressure_is_where_the_eigenvalue_crosses(degc):
    """Ramp through the onset: tone starts within half a bar of Re(lambda) = 0, at temperatures apart."""
    plant = turning(5, degc=degc, settings=changed("pressure", ripple_bar=0.0))
    growths, levels = [], []
    for pressure_bar in np.arange(9.0, 30.0, 0.5):
        plant.set_condition(disc_degc=degc)
        sound = listen(plant, 1.5, replace(TURN, pressure_set_bar=float(pressure_bar)))
        growths.append(prediction(plant.truth, BRAKE)[0])
        levels.append(line(sound[int(HZ) :])[1])
        if levels[-1] > 75.0:
            break
    crossing = next(i for i, growth in enumerate(growths) if growth > 0.0)
    loud = next(i for i, level in enumerate(levels) if level > 60.0)
    assert 0 <= loud - crossing <= 2  # half-bar steps; near the crossing growth takes its time
    assert max(levels[:crossing]) < 55.0


@pytest.mark.parametrize(("parameter", "factor"), [("m_padi", 1.05), ("c_knu_t", 0.8)])
def test_changing_the_brake_moves_the_squeal_as_the_eigenvalue_says(parameter, factor):
    value = BRAKE.spec.parameters[parameter].value * factor
    brake = BRAKE.with_parameters(**{parameter: value})
    plant = turning(6, brake=brake, degc=140.0)
    sound = listen(plant, 4.0, replace(TURN, pressure_set_bar=26.0))
    growth, predicted_hz = prediction(plant.truth, brake)
    assert growth > 0.0 and abs(predicted_hz - 2350.0) > 10.0
    assert line(sound[2 * int(HZ) :])[0] == pytest.approx(predicted_hz, abs=10.0)


def test_squeal_is_modulated_once_a_turn():
    plant = turning(7, degc=140.0)
    sound = listen(plant, 7.0, replace(TURN, pressure_set_bar=15.0))[int(HZ) :]
    squeal = spectrogram(sound, HZ, fft_size=2048, hop=512)
    k = round(2350.0 / squeal.line_hz)
    envelope = np.sqrt(squeal.power[:, k - 1 : k + 2].sum(axis=1, dtype=float))
    spectrum = np.abs(np.fft.rfft(envelope - envelope.mean()))
    hz = np.fft.rfftfreq(len(envelope), squeal.hop_s)
    assert hz[np.argmax(spectrum)] == pytest.approx(40.0 / 60.0, abs=0.1)


def test_sound_that_is_too_loud_clips_at_full_scale():
    plant = turning(8, degc=140.0, settings=changed("microphone", full_scale_pa=0.5))
    on = replace(TURN, pressure_set_bar=25.0)
    listen(plant, 2.0, on)
    plant.step(50 * MS, on, full_rate=True)
    counts = plant.render_sound()
    assert counts.min() == -32768 and counts.max() == 32767
    assert np.mean(np.abs(counts.astype(int)) >= 32767) > 0.1


def test_squeal_ends_when_the_pads_open_and_when_the_disc_stands():
    plant = turning(9, degc=140.0)
    on = replace(TURN, pressure_set_bar=20.0)
    assert events(listen(plant, 2.0, on))
    listen(plant, 1.5, TURN)
    assert line(listen(plant, 1.0, TURN))[1] < 40.0
    stop = replace(on, speed_set_rpm=0.0)
    listen(plant, 2.0, stop)
    assert plant.truth.pressure_bar > 19.0 and plant.truth.speed_rpm == 0.0
    assert line(listen(plant, 1.0, stop))[1] < 40.0


def loudest_start(plant, commands):
    """Largest sound pressure of the squeal band in the first 20 ms that are rendered, Pa."""
    plant.step(50 * MS, commands, full_rate=True)
    sound = plant.render_sound()[:800] * plant.sound_channel.scale
    spectrum = np.abs(np.fft.rfft(sound * np.hanning(800))) * 4 / 800
    return spectrum[round(2350 * 800 / HZ) - 1 : round(2350 * 800 / HZ) + 2].max()


def test_motion_is_forgotten_while_nobody_listens():
    """After a step without sound the brake starts from rest; it does not go on where it was heard last."""
    on = replace(TURN, pressure_set_bar=20.0)
    for unheard in (False, True):
        plant = turning(10, degc=140.0)
        listen(plant, 2.0, on)
        assert loudest_start(plant, on) > 0.3
        plant.step(50 * MS, on, full_rate=unheard)
        assert loudest_start(plant, on) < 0.02


def test_a_disc_stopped_while_squealing_starts_silent():
    plant = turning(11, degc=140.0)
    on = replace(TURN, pressure_set_bar=20.0)
    listen(plant, 2.0, on)
    listen(plant, 0.4, replace(on, quick_stop=True))
    assert plant.truth.speed_rpm == 0.0
    listen(plant, 2.0, replace(TURN, quick_stop=True))  # pads open
    listen(plant, 2.0, TURN)
    peaks = []
    for _ in range(3):
        plant.step(50 * MS, replace(TURN, pressure_set_bar=6.0), full_rate=True)
        peaks.append(np.abs(plant.render_sound() * plant.sound_channel.scale).max())
    assert max(peaks) < 0.3  # valve hiss, no tone
