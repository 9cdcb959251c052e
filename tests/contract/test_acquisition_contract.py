"""Every acquisition keeps the same promises: the simulated one, and the live one on emulated devices.

Faults of the live one follow below: each ends in invalid samples (NaN) and a fault on the board, or in an
error that names the source in the rig file, never in a wrong value.
"""

import contextlib
import threading
import time

import numpy as np
import pytest
from daq_rig import (
    CAN_SOURCES,
    DISC_DEGC,
    MICROPHONE,
    PRESSURE_BAR,
    SPEED_RPM,
    TORQUE_NM,
    Rig,
    StandInSound,
)

import drivers.daq.microphone
from drivers.daq.acquisition import LiveAcquisition
from rigctl.core.errors import ConfigError, DeviceError
from rigctl.core.ring import SampleRing
from rigctl.core.wire import connect
from rigctl.hal.devices import Request, RigContext
from sim_hardware.devices.roles import SimulatedAcquisition

RECORDING = Request(50_000_000, recording=True)


@pytest.fixture
def sound(monkeypatch):
    stand_in = StandInSound()
    monkeypatch.setattr(drivers.daq.microphone, "sound_library", lambda place: stand_in)
    return stand_in


@pytest.fixture
def rig(tmp_path):
    made = Rig(tmp_path)
    yield made
    made.close()


@contextlib.contextmanager
def live(rig, sources, **changes):
    context = rig.context()
    acquisition = LiveAcquisition({"sources": sources, **changes}, context)
    acquisition.open()
    try:
        yield acquisition, context
    finally:
        acquisition.close()


def blocks(acquisition, count):
    return [acquisition.next_block(RECORDING) for _ in range(count)]


def joined(found, name):
    return np.concatenate([block.samples(name) for block in found])


def assert_values(device, found, name, expected, tolerance, *, looks=6):
    """All valid samples are right, and most are valid: a busy machine may lose some for a while, then it is
    looked at again, but it never changes any."""
    for _ in range(looks):
        samples = joined(found, name)
        valid = np.isfinite(samples)
        assert samples[valid] == pytest.approx(expected, abs=tolerance)
        if np.mean(valid) > 0.8:
            return
        found = blocks(device, len(found))
    pytest.fail(f"most samples of {name} are not valid, {looks} times {len(found)} blocks long")


def until_error(acquisition, match, *, seconds=8.0):
    deadline = time.monotonic() + seconds
    with pytest.raises(DeviceError, match=match):
        while time.monotonic() < deadline:
            acquisition.next_block(RECORDING)


# -- the contract -----------------------------------------------------------------------------------


@pytest.fixture(params=["simulated", "live"])
def acquisition(request, tmp_path, configs, sound):
    if request.param == "live":
        made = Rig(tmp_path)
        context = made.context()
        device = LiveAcquisition({"sources": {"microphone": MICROPHONE, **CAN_SOURCES}}, context)
        device.open()
        yield device, context
        device.close()
        made.close()
        return
    context = RigContext(tmp_path, "real", 1, "simulated.toml", configs / "rigs")
    device = SimulatedAcquisition(
        {"brake": "../brakes/plant.toml", "plant": "../plants/a_class.toml"}, context
    )
    links = []

    def join_as_watchdog():
        link = connect(tmp_path / "rig.sock", 120.0, "simulated rig")
        link.send({"m": "hello", "role": "safety"})
        links.append(link)

    thread = threading.Thread(target=join_as_watchdog)
    thread.start()
    device.open()
    thread.join()
    yield device, context
    device.close()
    for link in links:
        link.close()
    device._session._process.wait(20.0)


def test_channels_are_those_of_the_rig(acquisition):
    device, _ = acquisition
    specs = {spec.name: spec for spec in device.channels()}
    assert set(specs) == {"microphone", "torque", "pressure", "speed", "disc_temperature"}
    units = {name: spec.unit for name, spec in specs.items()}
    assert units["torque"] == "N·m" and units["pressure"] == "bar" and units["speed"] == "1/min"
    assert units["disc_temperature"] == "°C" and units["microphone"] == "Pa"
    assert specs["microphone"].is_counts
    for spec in specs.values():
        assert spec.rate_hz % 1000.0 == 0.0, "stored at 1 kHz by whole decimation"


def test_blocks_follow_each_other_without_a_gap_in_any_channel(acquisition):
    device, context = acquisition
    rates = {spec.name: spec.rate_hz for spec in device.channels()}
    reader = SampleRing.attach(context.run_dir / "ring")
    last = None
    begin_s = time.monotonic()
    for block in blocks(device, 12):
        assert block.dt_ns == RECORDING.dt_ns
        if last is not None:
            assert block.k == last.k + 1
            assert block.t_ns == last.t_ns + last.dt_ns
        for name, (start, stop) in block.ranges.items():
            if block.stride == 1:
                assert stop - start == round(rates[name] * 0.05)
            if last is not None:
                assert start == last.ranges[name][1]
            assert np.array_equal(
                reader.read(name, start, stop), block.samples(name), equal_nan=rates[name] != 40_000
            )
        last = block
    assert 0.4 < time.monotonic() - begin_s < 3.0, "blocks keep pace with the clock"


# -- live: values and clocks ------------------------------------------------------------------------


def test_values_are_those_of_the_devices(rig, sound):
    with live(rig, {"microphone": MICROPHONE, **CAN_SOURCES}) as (device, _):
        found = blocks(device, 30)
        assert_values(device, found, "torque", TORQUE_NM, 0.01)
        assert_values(device, found, "pressure", PRESSURE_BAR, 0.001)
        assert_values(device, found, "disc_temperature", DISC_DEGC, 0.05)
        speed = joined(found, "speed")
        # the emulated shaft itself moves in steps where the machine is too busy to turn it
        assert float(np.nanmedian(speed)) == pytest.approx(SPEED_RPM, abs=0.5)
        counts = joined(found, "microphone").astype(int)
        assert np.all(np.diff(counts) % 1000 == 1), "no frame lost or doubled"
        clocks = found[-1].status["clocks"]
        assert set(clocks) == {"microphone", "bridge", "shaft", "loop"}
        assert abs(clocks["bridge"]["drift_ppm"]) < 2000  # a first guess after some seconds
        assert "bridge.clock" in device.identity()
        assert device.diagnose(3).round_trip_s


def test_without_a_microphone_the_machines_clock_leads(rig):
    with live(rig, {"bridge": CAN_SOURCES["bridge"]}) as (device, _):
        found = blocks(device, 10)
        assert_values(device, found, "torque", TORQUE_NM, 0.01)
        assert device.ready_after_s < 1.0


def test_the_rig_can_be_opened_again(rig, sound):
    context = rig.context()
    device = LiveAcquisition({"sources": {"microphone": MICROPHONE, **CAN_SOURCES}}, context)
    for _ in range(2):
        device.open()
        assert [block.k for block in blocks(device, 3)] == [0, 1, 2]
        device.close()
    assert not (context.run_dir / "ring").exists()


# -- live: faults -----------------------------------------------------------------------------------


def test_a_broken_bridge_is_never_a_torque(rig):
    with live(rig, {"bridge": CAN_SOURCES["bridge"]}) as (device, context):
        blocks(device, 3)
        rig.can.disturb("amplifier", channel=1, broken=True)
        found = blocks(device, 12)
        torque = joined(found, "torque")
        assert np.all(np.isnan(torque[-200:]))
        assert np.nanmax(np.abs(torque - TORQUE_NM), initial=0.0) < 0.01
        assert_values(device, found, "pressure", PRESSURE_BAR, 0.001)
        assert "bridge: torque" in context.board.snapshot()["faults"]
        rig.can.disturb("amplifier", channel=1, broken=False)
        assert np.nanmedian(joined(blocks(device, 12), "torque")[-200:]) == pytest.approx(TORQUE_NM, abs=0.01)
        assert "bridge: torque" not in context.board.snapshot().get("faults", {})


def test_a_loop_fault_is_never_a_temperature(rig):
    with live(rig, {"loop": CAN_SOURCES["loop"]}) as (device, context):
        for wire in ("broken", "short", "failure_low", "failure_high"):
            assert np.all(np.isfinite(joined(blocks(device, 10), "disc_temperature")[-100:])), wire
            rig.can.disturb("current_input", wire=wire)
            degc = joined(blocks(device, 12), "disc_temperature")
            assert np.all(np.isnan(degc[-200:])), wire
            assert np.nanmax(np.abs(degc - DISC_DEGC), initial=0.0) < 0.05, wire
            assert "loop fault" in context.board.snapshot()["faults"]["loop: disc_temperature"], wire
            rig.can.disturb("current_input", wire="ok")


def test_lost_frames_are_invalid_samples_and_counted(rig):
    from sim_hardware.bench.can import FaultRule

    with live(rig, {"bridge": CAN_SOURCES["bridge"]}) as (device, _):
        blocks(device, 4)
        rig.can.add_fault(FaultRule(kind="drop", node=0x20, cob_id=0x1A0, direction="from_node", count=4))
        torque = joined(blocks(device, 10), "torque")
        missing = int(np.count_nonzero(np.isnan(torque)))
        assert missing >= 4
        assert np.nanmax(np.abs(torque - TORQUE_NM)) < 0.01
        assert device.clocks()["bridge"]["lost"] >= 4


@pytest.mark.parametrize(
    "name, node", [("bridge", "amplifier"), ("shaft", "encoder"), ("loop", "current_input")]
)
def test_a_node_without_power_is_named(rig, name, node):
    with live(rig, {name: CAN_SOURCES[name]}) as (device, _):
        blocks(device, 3)
        rig.can.power(node, False)
        until_error(device, rf"source '{name}'|sources\.{name}")


def test_an_encoder_that_stands_still_is_an_error_not_a_speed(rig):
    with live(rig, {"shaft": CAN_SOURCES["shaft"]}) as (device, _):
        blocks(device, 3)
        rig.can.disturb("encoder", stuck=True)
        until_error(device, "position error")


def test_a_device_set_up_otherwise_is_refused(rig):
    wrong = CAN_SOURCES["bridge"] | {"channels": {"torque": {"input": 1, "unit": "bar"}}}
    with (
        pytest.raises(DeviceError, match=r"channels\.torque: input 1 measures in unit 00560000h"),
        live(rig, {"bridge": wrong}),
    ):
        pass
    wrong = CAN_SOURCES["shaft"] | {"steps_per_turn": 1024}
    with pytest.raises(DeviceError, match=r"has 4096 steps per turn"), live(rig, {"shaft": wrong}):
        pass
    wrong = CAN_SOURCES["loop"] | {"event_ms": 5}
    with pytest.raises(DeviceError, match=r"every 10 ms instead of 5 ms"), live(rig, {"loop": wrong}):
        pass


def test_sound_overflow_silence_unplugging_and_gaps_are_named(rig, sound):
    for fault, message in (
        ("overflow", "reports .* overflows"),
        ("unplugged", "has ended by itself"),
        ("mute", "no sound for"),
    ):
        with live(rig, {"microphone": MICROPHONE}) as (device, _):
            blocks(device, 3)
            setattr(sound, fault, True)
            until_error(device, rf"sources\.microphone: .*{message}")
            setattr(sound, fault, False)
    with live(rig, {"microphone": MICROPHONE}) as (device, _):
        blocks(device, 3)
        sound.skip = 4000
        until_error(device, r"sources\.microphone: (has lost \d+ ms of sound|delivers \d+ frames/s)")


def test_a_sound_card_at_another_rate_is_found(rig, sound):
    sound.actual_hz = 44_100
    with (
        pytest.raises(DeviceError, match="frames/s instead of 40000"),
        live(rig, {"microphone": MICROPHONE}) as (device, _),
    ):
        blocks(device, 100)


def test_missing_sound_devices_and_libraries_are_named(rig, sound, monkeypatch):
    sound.name = "USB card"
    with (
        pytest.raises(DeviceError, match=r"microphone\.device: no sound device.*'rigmic'.*'USB card'"),
        live(rig, {"microphone": MICROPHONE}),
    ):
        pass
    monkeypatch.undo()
    monkeypatch.setitem(__import__("sys").modules, "sounddevice", None)
    with (
        pytest.raises(DeviceError, match=r"sources\.microphone: the library 'sounddevice' is missing"),
        live(rig, {"microphone": MICROPHONE}),
    ):
        pass


def test_mistakes_in_the_rig_file_are_named(rig):
    context = rig.context()
    for settings, message in (
        ({"sources": {"a": {"kind": "sound"}}}, r"sources\.a\.kind: source has no kind 'sound'"),
        ({"sources": {"a": {}}}, r"sources\.a\.kind: missing"),
        ({"sources": {"a": MICROPHONE, "b": MICROPHONE}}, "two microphones"),
        ({"sources": {"a": CAN_SOURCES["loop"], "b": CAN_SOURCES["loop"]}}, "comes from two sources"),
        ({"sources": {"a": CAN_SOURCES["loop"] | {"colour": 1}}}, r"sources\.a\.colour"),
        ({"sources": {"a": CAN_SOURCES["loop"] | {"bus": "other"}}}, r"no bus 'other'"),
    ):
        with pytest.raises(ConfigError, match=message):
            LiveAcquisition(settings, context)
    context.time = "virtual"
    with pytest.raises(ConfigError, match="cannot run in virtual time"):
        LiveAcquisition({"sources": {"a": CAN_SOURCES["loop"]}}, context)
