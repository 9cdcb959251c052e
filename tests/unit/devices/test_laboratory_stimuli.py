"""Each stimulus of the fault laboratory: what the controller reads, and what the watchdog makes of it."""

import select
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rigctl.core.errors import DeviceError
from rigctl.core.safety_link import SafetySample
from rigctl.safety.checks import CheckRunner
from rigctl.safety.limits import load_limits
from rigctl.safety.observe import View
from rigctl.signals.calibration import read_calibrator
from sim_hardware.brake_model import load_brake
from sim_hardware.devices.laboratory import Laboratory
from sim_hardware.devices.stimuli import Door, Stimuli
from sim_hardware.plant import Commands, Plant, PlantSettings, behind_relay
from sim_hardware.plant.calibrator import CalibratorOnMicrophone

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
BLOCK_NS = 50_000_000
TURN = Commands(speed_set_rpm=60.0, speed_ramp_rpm_per_s=100.0, drive_enabled=True, pressure_set_bar=10.0)


class Bench:
    """Plant, stimuli and the watchdog's checks, block by block, without processes."""

    def __init__(self) -> None:
        from rigctl.config.loading import load_model

        settings = load_model(CONFIGS / "plants" / "a_class.toml", PlantSettings)
        self.plant = Plant(settings, load_brake(CONFIGS / "brakes" / "plant.toml"), seed=3)
        self.stimuli = Stimuli(self.plant)
        self.limits = load_limits(CONFIGS / "limits" / "a_class.toml").limits
        self.runner = CheckRunner(self.limits)
        self.relay = False
        self.k = 0
        self.view: View | None = None
        self.samples: dict[str, Any] = {}

    def block(self, wanted: Commands) -> list[str]:
        """One block; the causes that the watchdog's checks give."""
        stimuli = self.stimuli
        stimuli.begin(self.k * 0.05)
        relay = self.relay = self.relay and stimuli.chain_ok
        reaching = behind_relay(wanted, closed=relay, ventilator_max_m3_h=1000.0)
        commands = stimuli.commands(reaching, relay_closed=relay)
        result = stimuli.readings(self.plant.step(BLOCK_NS, commands, full_rate=True))
        self.samples = result.samples
        self.k += 1
        p, n, torque, temperature = (tuple(result.safety[key]) for key in "pnMT")
        sample = SafetySample(self.k, self.k * 0.05, 0.05, p, n, torque, temperature, relay,
                              commands.drive_enabled, stimuli.estop_ok, stimuli.doors_ok)  # fmt: skip
        view = View(sample, self.view, relay)
        verdicts = self.runner.run(view, self.view)
        self.view = view
        return [verdict.check.id for verdict in verdicts]

    def turn(self, blocks: int = 60) -> "Bench":
        """Brake with 10 bar at 60 1/min."""
        self.relay = True
        for _ in range(blocks):
            assert self.block(TURN) == []
        return self

    def first_cause(self, blocks: int = 40) -> str:
        for _ in range(blocks):
            if causes := self.block(TURN):
                return causes[0]
        return ""

    def ask(self, do: str, **fields: Any) -> dict[str, Any]:
        return self.stimuli.handle({"do": do, **fields})


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.mark.parametrize(
    ("do", "fields", "cause"),
    [
        ("estop", {"pressed": True}, "estop"),
        ("doors", {"open": True}, "doors"),
        ("sensor", {"channel": "pressure", "mode": "invalid"}, "pressure_invalid"),
        ("sensor", {"channel": "speed", "mode": "invalid", "seen_by": "watchdog"}, "speed_invalid"),
        ("sensor", {"channel": "disc_temperature", "mode": "frozen"}, "temperature_frozen"),
        ("sensor", {"channel": "torque", "mode": "frozen"}, "torque_frozen"),
        ("sensor", {"channel": "pressure", "mode": "offset", "value": 31.5}, "pressure_range"),
        ("sensor", {"channel": "disc_temperature", "mode": "offset", "value": 480}, "temperature_range"),
        ("disc", {"degc": 520}, "temperature_range"),
    ],
)
def test_each_stimulus_has_its_trip_cause(bench: Bench, do: str, fields: dict[str, Any], cause: str):
    bench.turn()
    bench.ask(do, **fields)
    assert bench.first_cause() == cause


def test_the_controller_alone_is_deceived(bench: Bench):
    bench.turn(20)
    bench.ask("sensor", channel="pressure", mode="invalid", seen_by="controller")
    assert bench.first_cause(20) == ""
    assert np.isnan(bench.samples["pressure"]).all()
    assert np.isfinite(bench.samples["torque"]).all()


def test_open_chain_takes_torque_and_pressure_away(bench: Bench):
    bench.turn()
    assert bench.plant.truth.pressure_bar > 8.0
    bench.ask("estop", pressed=True)
    for _ in range(60):
        bench.block(TURN)
    assert bench.plant.truth.pressure_bar < 0.2
    assert bench.plant.truth.speed_rpm == 0.0


def test_stuck_vent_valve_keeps_the_pressure_until_it_is_mended(bench: Bench):
    bench.turn()
    before = bench.plant.truth.pressure_bar
    bench.ask("vent_valve", stuck=True)
    bench.relay = False
    for _ in range(20):
        bench.block(replace(TURN, vent=True, pressure_set_bar=0.0))
    assert bench.plant.truth.pressure_bar == pytest.approx(before, abs=0.7)
    bench.ask("vent_valve", stuck=False)
    for _ in range(20):
        bench.block(TURN)
    assert bench.plant.truth.pressure_bar < 0.2


def test_weight_is_felt_with_the_error_of_the_chain_and_only_at_standstill(bench: Bench):
    rest = Commands(vent=True)
    bench.block(rest)
    zero = bench.samples["torque"].mean()
    bench.ask("weight", torque_nm=500.0)
    bench.block(rest)
    assert bench.samples["torque"].mean() - zero == pytest.approx(500.0 * 0.998, abs=0.3)
    assert bench.ask("status")["truth"]["torque_nm"] == pytest.approx(500.0, abs=0.5)
    bench.ask("weight", torque_nm=0.0)
    bench.turn(20)
    with pytest.raises(DeviceError, match="turns"):
        bench.ask("weight", torque_nm=100.0)


@pytest.mark.parametrize(("level_db", "drift_db"), [(94.0, 0.0), (114.0, 0.0), (94.0, 0.5)])
def test_calibrator_gives_its_level_and_shows_a_drift(bench: Bench, level_db: float, drift_db: float):
    bench.ask("calibrator", level_db=level_db)
    bench.ask("microphone", drift_db=drift_db)
    assert bench.stimuli.listens
    coupler, sound = CalibratorOnMicrophone(20.0), bench.stimuli.sound
    assert sound is not None
    parts = []
    for _ in range(20):
        bench.block(Commands(vent=True))
        parts.append(coupler.heard(bench.plant.render_sound(), *sound))
    reading = read_calibrator(np.concatenate(parts), 40_000.0, level_db)
    nominal = bench.plant.sound_channel.scale
    assert 20 * np.log10(nominal / reading.pa_per_count) == pytest.approx(drift_db, abs=0.02)
    assert reading.frequency_hz == pytest.approx(1000.0, abs=0.5)
    assert reading.level_spread_db < 0.1
    assert reading.tone_to_rest_db > 40.0


def test_without_a_stimulus_nothing_is_touched(bench: Bench):
    result = bench.plant.step(BLOCK_NS, Commands(), full_rate=True)
    assert bench.stimuli.readings(result) is result
    commands = Commands(vent=True)
    assert bench.stimuli.commands(commands, relay_closed=False) is commands
    assert bench.stimuli.sound is None


def test_a_stimulus_waits_for_its_time_and_clear_ends_all(bench: Bench):
    bench.turn(10)
    answer = bench.ask("doors", open=True, at_s=0.72)
    assert answer["waiting"] == [{"do": "doors", "open": True, "at_s": 0.72}]
    opened = next(k for k in range(11, 40) if bench.block(TURN) == ["doors"])
    assert opened == 16  # the block that begins at 0.75 s
    bench.ask("sensor", channel="speed", mode="frozen")
    answer = bench.ask("clear")
    assert not answer["doors_open"] and not answer["sensors"] and not answer["waiting"]


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"do": "explode"}, "estop"),
        ({"do": "estop"}, "pressed"),
        ({"do": "estop", "pressed": 1}, "true or false"),
        ({"do": "sensor", "channel": "sound", "mode": "ok"}, "pressure, speed"),
        ({"do": "sensor", "channel": "speed", "mode": "odd"}, "frozen"),
        ({"do": "disc", "degc": 5000}, "0 to 700"),
        ({"do": "calibrator", "level_db": 100}, "94, 114"),
        ({"do": "weight", "torque_nm": float("nan")}, "1200"),
        ({"do": "doors", "shut": True, "at_s": 3}, "open"),
    ],
)
def test_nonsense_is_refused_with_a_remedy(bench: Bench, request_: dict[str, Any], words: str):
    with pytest.raises(DeviceError, match=words):
        bench.stimuli.handle(request_)


def test_door_and_client(bench: Bench, tmp_path: Path):
    import threading

    poll = select.poll()
    door = Door(tmp_path, bench.stimuli, poll)
    stop = threading.Event()

    def serve() -> None:
        while not stop.is_set():
            for fd, _ in poll.poll(20):
                assert door.on_ready(fd)

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        with Laboratory(tmp_path) as one, Laboratory(tmp_path) as other:
            assert one.ask("estop", pressed=True)["estop_pressed"]
            assert other.ask("status")["estop_pressed"]
            with pytest.raises(DeviceError, match="no stimulus"):
                other.ask("explode")
            assert not other.ask("clear")["estop_pressed"]
    finally:
        stop.set()
        thread.join()
        door.close()
    with pytest.raises(DeviceError, match="no simulated rig"):
        Laboratory(tmp_path, timeout_s=0.0).ask("status")
