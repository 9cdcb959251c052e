"""The six devices: what their manual promises, seen on the wire and in the rig's signals."""

from __future__ import annotations

import struct

import pytest
from bench_can_peer import AMPLIFIER, ANALOG, CURRENT, ENCODER, MS, REGULATOR, SAFETY, Bench, SdoAborted
from hypothesis import given
from hypothesis import strategies as st

from sim_hardware.bench.can import BenchCanSettings
from sim_hardware.bench.can.nodes.current_input import namur_status
from sim_hardware.bench.can.nodes.safety_io import rises
from sim_hardware.bench.can.settings import RegulatorSettings

DISABLED, HOLD, ACTIVE, FAULT = 0x8, 0x9, 0xF, 0x0


@pytest.fixture
def bench():
    made = Bench()
    yield made
    made.close()


def status(bench: Bench) -> tuple[int, int]:
    """Status word and actual value of the newest TPDO1 of the regulator."""
    word, actual = struct.unpack("<Hh", bench.of(0x190)[-1])
    return word, actual


# -- 10h pressure regulator -----------------------------------------------------------------------


def test_regulator_goes_through_its_states_one_by_one(bench: Bench):
    bench.boot()
    bench.run(60)
    assert status(bench)[0] & 0xF == DISABLED
    bench.control(0x0007, 3277)
    states = [struct.unpack_from("<H", data)[0] & 0xF for data in bench.of(0x190, bench.run(50))]
    assert list(dict.fromkeys(states)) in ([DISABLED, HOLD, ACTIVE], [HOLD, ACTIVE])
    assert bench.signals.get("pressure_set_bar") == pytest.approx(10.0, abs=0.01)
    assert bench.signals.get("vent") is False
    bench.control(0x0001, 3277)
    bench.run(20)
    assert status(bench)[0] & 0xF == HOLD
    assert bench.signals.get("pressure_set_bar") == 0.0 and bench.signals.get("vent") is False
    bench.control(0x0000)
    bench.run(20)
    assert status(bench)[0] & 0xF == DISABLED and bench.signals.get("vent") is True


def test_control_word_3_is_not_yet_active(bench: Bench):
    bench.boot().run(60)
    bench.control(0x0003, 3277)
    bench.run(50)
    assert status(bench)[0] & 0xF == HOLD


def test_set_point_is_limited_and_says_so(bench: Bench):
    bench.boot()
    for set_point, bar, limited in ((20000, 50.0, True), (-100, 0.0, True), (16384, 50.0, False)):
        bench.control(0x0007, set_point)
        bench.run(60)
        assert bench.signals.get("pressure_set_bar") == pytest.approx(bar)
        assert bool(status(bench)[0] & 1 << 10) is limited
    bench.write(REGULATOR, 0x6320, 1, struct.pack("<h", 13107))
    bench.run(30)
    assert bench.signals.get("pressure_set_bar") == pytest.approx(40.0, abs=0.01)


def test_target_window_after_its_delay(bench: Bench):
    bench.boot()
    bench.control(0x0007, 3277)
    bench.run(150)
    assert not status(bench)[0] & 1 << 8
    bench.signals.publish(bench.t_ns, regulator_pressure_bar=[9.8])
    reached = bench.t_ms
    while not status(bench)[0] & 1 << 8:
        bench.run(1)
        assert bench.t_ms < reached + 500
    assert 90 <= bench.t_ms - reached <= 150  # the device looks every 10 ms
    assert status(bench)[1] == round(9.8 / 50 * 16384)
    bench.signals.publish(bench.t_ns, regulator_pressure_bar=[9.0])
    bench.run(50)
    assert not status(bench)[0] & 1 << 8
    bench.write(REGULATOR, 0x6370, 1, b"\0")
    bench.signals.publish(bench.t_ns, regulator_pressure_bar=[10.0])
    bench.run(500)
    assert not status(bench)[0] & 1 << 8


def _lose_heartbeat(bench: Bench, reaction: int | None) -> None:
    bench.boot(operational=False)
    if reaction is not None:
        bench.u8(REGULATOR, 0x2100, 0, reaction)
    bench.u32(REGULATOR, 0x1016, 1, 1 << 16 | 250)
    bench.nmt(1)
    bench.heartbeat_ms = 100
    bench.control(0x0007, 9830)
    bench.run(300)
    assert bench.signals.get("pressure_set_bar") == pytest.approx(30.0, abs=0.01)
    bench.heartbeat_ms = 0
    bench.run(400)


def test_out_of_the_box_a_lost_heartbeat_holds_the_pressure(bench: Bench):
    """The dangerous default of real devices, kept on purpose: drivers must read 2100h back."""
    _lose_heartbeat(bench, None)
    assert bench.number(REGULATOR, 0x2100) == 0
    assert bench.signals.get("pressure_set_bar") == pytest.approx(30.0, abs=0.01)
    assert bench.signals.get("vent") is False


def test_with_reaction_vent_a_lost_heartbeat_vents_and_latches(bench: Bench):
    _lose_heartbeat(bench, 1)
    assert bench.signals.get("vent") is True and bench.signals.get("pressure_set_bar") == 0.0
    assert bench.number(REGULATOR, 0x604E) == 0x8130
    bench.nmt(1)
    bench.control(0x000F, 9830)
    bench.run(30)
    assert bench.signals.get("vent") is True  # the heartbeat is still missing
    bench.heartbeat_ms = 100
    bench.control(0x0007, 9830)
    bench.run(150)
    assert bench.signals.get("vent") is True  # and it latches
    bench.control(0x000F, 9830)
    bench.run(50)
    assert status(bench)[0] & 0xF == ACTIVE and bench.signals.get("vent") is False


def test_bench_file_may_make_the_regulator_safe_from_power_on():
    bench = Bench(BenchCanSettings(regulator=RegulatorSettings(loss_reaction="vent"))).boot()
    assert bench.number(REGULATOR, 0x2100) == 1
    bench.close()


@pytest.mark.parametrize("how", ["stop", "reset", "power"])
def test_regulator_vents_without_a_master_or_power(bench: Bench, how: str):
    bench.boot()
    bench.control(0x0007, 9830)
    bench.run(60)
    assert bench.signals.get("vent") is False
    if how == "power":
        bench.can.power("regulator", False)
    else:
        bench.nmt({"stop": 2, "reset": 129}[how], REGULATOR)
    bench.run(5)
    assert bench.signals.get("vent") is True
    if how == "stop":
        bench.nmt(1, REGULATOR)
        bench.run(100)
        assert status(bench)[0] & 0xF == DISABLED  # nothing comes back by itself


def test_regulator_faults_of_its_own(bench: Bench):
    bench.boot()
    bench.control(0x0007, 3277)
    bench.run(60)
    bench.can.disturb("regulator", supply_low=True)
    bench.run(20)
    assert bench.of(0x90)[-1][:3] == bytes.fromhex("203121")
    assert status(bench)[0] & 0xF == FAULT and bench.signals.get("vent") is True
    bench.control(0x000F, 3277)
    bench.run(30)
    assert status(bench)[0] & 0xF == FAULT
    bench.can.disturb("regulator", supply_low=False)
    bench.control(0x0007, 3277)
    bench.run(30)
    bench.control(0x000F, 3277)
    bench.run(50)
    assert status(bench)[0] & 0xF == ACTIVE
    bench.can.disturb("regulator", sensor_failed=True)
    bench.run(20)
    assert status(bench)[1] == -32768 and bench.signals.get("vent") is True


# -- 20h amplifier --------------------------------------------------------------------------------


def test_amplifier_units_digits_and_offset(bench: Bench):
    bench.signals.publish(bench.t_ns, torque_nm=[-123.456], pressure_bar=[12.34567])
    bench.boot()
    assert struct.unpack("<ii", bench.of(0x1A0)[-1]) == (-12346, 123457)
    assert bench.number(AMPLIFIER, 0x6131, 2) == 0x004E0000
    assert [bench.number(AMPLIFIER, 0x6132, channel) for channel in (1, 2)] == [2, 4]
    bench.u8(AMPLIFIER, 0x6132, 1, 1)
    bench.write(AMPLIFIER, 0x9124, 1, struct.pack("<i", 35))
    bench.run(2)
    assert struct.unpack("<ii", bench.of(0x1A0)[-1]) == (-1235 - 35, 123457)


def test_amplifier_overload_stays_at_the_end_of_the_range(bench: Bench):
    bench.boot()
    for torque, value, bits in ((2500.0, 200000, 2), (-2500.0, -200000, 4), (10.0, 1000, 0)):
        bench.signals.publish(bench.t_ns, torque_nm=[torque])
        bench.run(30)
        assert struct.unpack_from("<i", bench.of(0x1A0)[-1])[0] == value
        assert bench.number(AMPLIFIER, 0x6150, 1) == bits
    assert [data[:2] for data in bench.of(0xA0)] == [bytes.fromhex("1021"), bytes(2)]


def test_a_broken_bridge_is_never_a_value(bench: Bench):
    bench.boot()
    bench.can.disturb("amplifier", channel=2, broken=True)
    bench.run(2)
    assert bench.of(0x1A0)[-1][4:] == bytes.fromhex("00000080")
    assert bench.number(AMPLIFIER, 0x6150, 2) == 1
    assert bench.of(0xA0) == [bytes.fromhex("10 50 21 02 00 00 00 00")]
    bench.can.disturb("amplifier", channel=2, broken=False)
    bench.run(2)
    assert bench.of(0x1A0)[-1][4:] == bytes(4)
    with pytest.raises(SdoAborted, match="06010002"):
        bench.u32(AMPLIFIER, 0x6131, 1, 0)


# -- 21h current input ----------------------------------------------------------------------------


def current(bench: Bench) -> tuple[int, int]:
    return struct.unpack("<hB", bench.of(0x1A1)[-1])


def test_temperature_as_current(bench: Bench):
    bench.boot()
    for degc, ua, bits in (
        (0.0, 4000, 0),
        (300.0, 12000, 0),
        (600.0, 20000, 0),
        (700.0, 20500, 0),
        (-50.0, 3800, 0),
    ):
        bench.signals.publish(bench.t_ns, disc_temperature_degc=[degc])
        bench.run(50)
        assert current(bench) == (ua, bits)


@pytest.mark.parametrize(
    ("wire", "ua", "bits"),
    [("broken", 0, 5), ("short", 25000, 3), ("failure_low", 3500, 5), ("failure_high", 21600, 3)],
)
def test_wire_faults_by_ne43(bench: Bench, wire: str, ua: int, bits: int):
    bench.boot()
    bench.run(50)
    bench.can.disturb("current_input", wire=wire)
    bench.run(30)
    assert current(bench) == (ua, bits)
    assert bench.of(0xA1) == [bytes.fromhex("30 21 03 01 00 00 00 00")]
    bench.can.disturb("current_input", wire="ok")
    bench.run(20)
    assert current(bench)[1] == 0 and bench.of(0xA1)[-1] == bytes(8)
    assert bench.number(CURRENT, 0x7130, 1) == current(bench)[0]


@given(st.integers(-32768, 32767))
def test_ne43_has_no_gaps(ua: int):
    bits = namur_status(ua)
    assert bool(bits & 1) is (ua < 3600 or ua > 21000)
    assert (bits == 0) is (3800 <= ua <= 20500)


# -- 22h encoder ----------------------------------------------------------------------------------


def test_encoder_direction_scaling_and_preset(bench: Bench):
    bench.signals.publish(bench.t_ns, position_turns=[2.5], speed_rpm=[-40.0])
    bench.boot()
    assert struct.unpack("<Ih", bench.of(0x1A2)[-1]) == (10240, -400)
    bench.u32(ENCODER, 0x6003, 0, 100)
    bench.run(2)
    assert struct.unpack("<Ih", bench.of(0x1A2)[-1]) == (100, -400)
    bench.u16(ENCODER, 0x6000, 0, 5)
    bench.u32(ENCODER, 0x6001, 0, 1000)
    bench.run(2)
    assert struct.unpack("<Ih", bench.of(0x1A2)[-1])[1] == 400
    with pytest.raises(SdoAborted, match="06090030"):
        bench.u16(ENCODER, 0x6000, 0, 2)
    with pytest.raises(SdoAborted, match="06090031"):
        bench.u32(ENCODER, 0x6001, 0, 4097)


def test_encoder_speed_is_clamped_and_a_stuck_disc_gives_an_alarm(bench: Bench):
    bench.signals.publish(bench.t_ns, position_turns=[1.0], speed_rpm=[5000.0])
    bench.boot()
    assert struct.unpack("<Ih", bench.of(0x1A2)[-1]) == (4096, 32767)
    bench.can.disturb("encoder", stuck=True)
    bench.signals.publish(bench.t_ns, position_turns=[9.0], speed_rpm=[10.0])
    bench.run(50)
    assert struct.unpack("<Ih", bench.of(0x1A2)[-1]) == (4096, 32767)
    assert bench.number(ENCODER, 0x6503) == 1
    assert bench.of(0xA2) == [bytes.fromhex("20 73 21 00 00 00 00 00")]


# -- 30h safety I/O -------------------------------------------------------------------------------


def bits(bench: Bench) -> tuple[int, int]:
    return tuple(bench.of(0x1B0)[-1])  # pyright: ignore[reportReturnType]


def close_relay(bench: Bench, counter: int = 1) -> None:
    bench.boot()
    bench.safety(2, counter)
    bench.run(12)
    assert bits(bench) == (7, counter)


def test_relay_closes_by_command_2_and_opens_without_rising_counters(bench: Bench):
    close_relay(bench)
    assert bench.signals.get("relay_closed") is True
    closed_at = bench.t_ms - 12
    while bench.signals.get("relay_closed"):
        bench.run(1)
    assert 150 <= bench.t_ms - closed_at <= 155
    assert bits(bench) == (6, 1)  # told at once
    bench.safety(1, 2)
    bench.run(20)
    assert bits(bench) == (6, 2)  # renewing does not close
    bench.safety(2, 3)
    bench.run(20)
    assert bits(bench) == (7, 3)


def test_renewals_hold_it_closed_also_over_the_wrap(bench: Bench):
    close_relay(bench, 250)
    for counter in range(251, 251 + 30):
        bench.safety(1, counter % 256)
        bench.run(100)
        assert bits(bench)[0] == 7
    assert bits(bench)[1] == (251 + 29) % 256


@pytest.mark.parametrize("counter", [1, 0, 200])
def test_stuck_and_late_counters_do_not_renew(bench: Bench, counter: int):
    close_relay(bench, 1)
    for _ in range(20):
        bench.safety(1, counter)
        bench.run(10)
    assert bits(bench)[0] == 6


def test_a_stuck_close_command_does_not_close_again(bench: Bench):
    close_relay(bench, 1)
    for _ in range(40):
        bench.safety(2, 1)
        bench.run(10)
    assert bits(bench) == (6, 1)


def test_command_0_opens_at_once_whatever_its_counter(bench: Bench):
    close_relay(bench, 100)
    bench.safety(0, 3)
    bench.run(1)
    assert bits(bench) == (6, 3)
    bench.safety(2, 100)  # excites the coil; the next frame lets it go before the contact moves
    bench.safety(0, 101)
    bench.run(15)
    assert bits(bench) == (6, 101)


def test_an_overtaken_close_stays_without_effect(bench: Bench):
    close_relay(bench, 10)
    bench.safety(0, 12)
    bench.safety(2, 11)
    bench.run(20)
    assert bits(bench) == (6, 12)


@pytest.mark.parametrize("chain", ["estop_ok", "doors_ok"])
def test_the_chain_opens_at_once_and_keeps_it_open(bench: Bench, chain: str):
    close_relay(bench)
    bench.signals.set(**{chain: False})
    bench.run(3)
    assert bits(bench)[0] == (4 if chain == "estop_ok" else 2)
    bench.safety(2, 2)
    bench.run(20)
    assert bits(bench)[0] & 1 == 0
    bench.signals.set(**{chain: True})
    bench.run(20)
    assert bits(bench)[0] == 6
    bench.safety(2, 3)
    bench.run(20)
    assert bits(bench)[0] == 7


def test_drive_enable_is_read_back_behind_the_relay(bench: Bench):
    bench.boot()
    bench.signals.set(drive_enabled=True)
    bench.run(20)
    assert bits(bench)[0] == 6
    bench.safety(2, 1)
    bench.run(20)
    assert bits(bench)[0] == 15


@pytest.mark.parametrize("how", ["pre-operational", "stop", "reset", "power", "heartbeat"])
def test_relay_opens_without_the_network(bench: Bench, how: str):
    bench.boot(operational=False)
    bench.u32(SAFETY, 0x1016, 1, 1 << 16 | 50)
    bench.nmt(1)
    bench.send(0x701, b"\x05")
    bench.safety(2, 1)
    bench.run(15)
    assert bench.signals.get("relay_closed") is True
    if how == "heartbeat":
        bench.run(60)
    elif how == "power":
        bench.can.power("safety_io", False)
    else:
        bench.nmt({"pre-operational": 128, "stop": 2, "reset": 129}[how], SAFETY)
    bench.run(2)
    assert bench.signals.get("relay_closed") is False


def test_a_welded_contact_is_seen_in_the_read_back(bench: Bench):
    close_relay(bench)
    bench.can.disturb("safety_io", welded=True)
    bench.safety(0, 2)
    bench.run(20)
    assert bits(bench) == (7, 2) and bench.signals.get("relay_closed") is True
    bench.can.disturb("safety_io", welded=False)
    bench.run(20)
    assert bits(bench)[0] == 6


def test_wrong_commands_are_not_taken(bench: Bench):
    close_relay(bench)
    bench.safety(3, 2)
    bench.run(5)
    assert bits(bench) == (7, 1)


@given(st.integers(0, 255), st.integers(0, 255))
def test_rising_is_never_true_both_ways(one: int, other: int):
    assert not (rises(one, other) and rises(other, one))
    assert rises(one, None) and not rises(one, one)


# -- 31h analog output ----------------------------------------------------------------------------


def air(bench: Bench) -> float:
    return float(bench.signals.get("ventilator_m3_h"))


def test_analog_output_moves_air(bench: Bench):
    bench.boot()
    assert air(bench) == 1000.0  # nobody has commanded yet
    for raw, flow in ((0, 0.0), (16384, 500.0), (32767, 1000.0), (-5, 0.0)):
        bench.send(0x231, struct.pack("<h", raw))
        bench.run(1)
        assert air(bench) == pytest.approx(flow, abs=0.1)


@pytest.mark.parametrize(("mode", "value", "flow"), [(1, 32767, 1000.0), (1, 0, 0.0), (0, 32767, 250.0)])
def test_error_value_on_heartbeat_loss(bench: Bench, mode: int, value: int, flow: float):
    bench.boot(operational=False)
    bench.u8(ANALOG, 0x6443, 1, mode)
    bench.write(ANALOG, 0x6444, 1, struct.pack("<i", value))
    bench.u32(ANALOG, 0x1016, 1, 1 << 16 | 100)
    bench.nmt(1)
    bench.send(0x701, b"\x05")
    bench.send(0x231, struct.pack("<h", 8192))
    bench.run(10)
    assert air(bench) == pytest.approx(250.0, abs=0.1)
    bench.run(120)
    assert air(bench) == pytest.approx(flow, abs=0.1)
    bench.send(0x231, struct.pack("<h", 0))  # the node is pre-operational now, and the master still missing
    bench.run(5)
    assert air(bench) == pytest.approx(flow, abs=0.1)
    bench.send(0x701, b"\x05")
    bench.nmt(1)
    bench.send(0x231, struct.pack("<h", 0))
    bench.run(2)
    assert air(bench) == 0.0


def test_age_of_samples_is_that_of_the_settings():
    bench = Bench(BenchCanSettings(delay_ms=100)).boot()
    start = bench.t_ms
    bench.signals.publish((start + 300) * MS, torque_nm=[float(k) for k in range(300)])
    bench.run(200)
    t_ms = bench.t_ms - start
    assert struct.unpack_from("<i", bench.of(0x1A0)[-1])[0] == (t_ms - 100) * 100
    bench.close()
