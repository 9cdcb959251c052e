"""Every check, each side of its threshold and persistence, and what is no number."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from guard_loop import BRAKING, CALM, loaded_limits, sample_at
from hypothesis import given
from hypothesis import strategies as st

from rigctl.core.safety_link import SafetySample
from rigctl.safety.causes import CAUSES
from rigctl.safety.checks import CHECKS, CheckRunner
from rigctl.safety.observe import Signal, View
from rigctl.safety.proof import FAULTS, failed_checks, good_sample, provoke

LIMITS = loaded_limits().limits
FIELDS = {
    "pressure": "pressure_bar",
    "speed": "speed_rpm",
    "torque": "torque_nm",
    "temperature": "temperature_degc",
}


def verdicts(samples: list[SafetySample], *, wanted: bool = True, limits: Any = LIMITS) -> list[list[str]]:
    """Ids of the verdicts, block by block."""
    runner, before, out = CheckRunner(limits), None, []
    for sample in samples:
        view = View(sample, before, wanted)
        out.append([verdict.check.id for verdict in runner.run(view, before)])
        assert runner.ran == runner.expected
        before = view
    return out


def moving(k: int, **changes: Any) -> SafetySample:
    """A braking with living sensors and the relay closed."""
    wobble = ((k * 7919) % 13) / 100.0
    parts = {name: tuple(value + wobble for value in values) for name, values in BRAKING.items()}
    return sample_at(k, relay_closed=True, drive_enabled=True, **{**parts, **changes})


def test_every_check_has_a_cause_an_own_id_and_a_made_up_fault() -> None:
    ids = [check.id for check in CHECKS]
    assert len(set(ids)) == len(ids)
    assert set(ids) == set(FAULTS) <= set(CAUSES)


def test_a_good_run_gives_no_verdict() -> None:
    assert not any(verdicts([moving(k) for k in range(100)]))
    assert not any(verdicts([sample_at(k) for k in range(100)], wanted=False))


def test_the_proof_test_passes_and_notices_a_check_that_is_blind() -> None:
    assert failed_checks(LIMITS) == []
    # A limit so high that the made-up overspeed of another check cannot be told: blind the pressure check.
    blind = replace(LIMITS, pressure=replace(LIMITS.pressure, readings=10**6))
    assert failed_checks(blind) == ["pressure_range"]
    # Power so limited that a braking well within the other limits is too much: it complains before the fault.
    nervous = replace(LIMITS, power=replace(LIMITS.power, peak_kw=0.1, peak_readings=1))
    assert "power_peak (false alarm)" in failed_checks(nervous)
    assert not provoke("power_peak", nervous)


@pytest.mark.parametrize("max_degc", [60.0, 90.0, 120.0, 700.0])
def test_the_proof_test_fits_any_temperature_limit(max_degc: float) -> None:
    heat = replace(LIMITS.disc_temperature, max_degc=max_degc, approach_from_degc=0.6 * max_degc)
    assert failed_checks(replace(LIMITS, disc_temperature=heat)) == []


@pytest.mark.parametrize(
    ("check", "field", "good", "bad", "readings"),
    [
        ("pressure_peak", "pressure_bar", 42.0, 42.001, LIMITS.pressure.peak_readings),
        ("pressure_range", "pressure_bar", 41.0, 41.001, LIMITS.pressure.readings),
        ("pressure_range", "pressure_bar", -1.0, -1.001, LIMITS.pressure.readings),
        ("speed_range", "speed_rpm", 840.0, 840.001, LIMITS.speed.readings),
        ("speed_range", "speed_rpm", -10.0, -10.001, LIMITS.speed.readings),
        ("torque_range", "torque_nm", 1300.0, 1300.001, LIMITS.torque.readings),
        ("torque_range", "torque_nm", -150.0, -150.001, LIMITS.torque.readings),
        ("temperature_range", "temperature_degc", 500.0, 500.001, LIMITS.disc_temperature.readings),
        ("temperature_range", "temperature_degc", 5.0, 4.999, LIMITS.disc_temperature.readings),
    ],
)
def test_absolute_limits(check: str, field: str, good: float, bad: float, readings: int) -> None:
    def run(value: float, count: int) -> bool:
        base = {"pressure_bar": 0.0, "speed_rpm": 0.0, "torque_nm": 0.0, "temperature_degc": 100.0}
        samples = []
        for k in range(20):
            values = [base[field]] * 5
            for i in range(5):
                if 10 <= 5 * k + i < 10 + count:
                    values[i] = value
            samples.append(sample_at(k, relay_closed=True, **{field: tuple(values)}))
        return any(check in block for block in verdicts(samples))

    assert not run(good, 80)
    assert not run(bad, readings - 1)
    assert run(bad, readings)


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize("bad", [None, math.nan, math.inf, -math.inf, "20", [1.0]])
def test_readings_that_are_no_numbers(name: str, bad: Any) -> None:
    def run(count: int) -> list[list[str]]:
        samples = [moving(k) for k in range(6)]
        values = list(getattr(samples[3], FIELDS[name]))
        values[:count] = [bad] * count
        samples[3] = replace(samples[3], **{FIELDS[name]: tuple(values)})
        return verdicts(samples)

    assert not any(run(1))  # one spike is forgiven
    assert run(2)[3][0] == f"{name}_invalid"  # and named before the limits that NaN fails too
    assert run(5)[3][0] == f"{name}_invalid"


def test_a_number_among_others_is_not_hidden_by_nan() -> None:
    values = (20.0, math.nan, 43.0, 43.0, math.nan)  # min and max alone would lose these
    assert "pressure_peak" in verdicts([moving(0), moving(1, pressure_bar=values)])[1]


@CALM
@given(st.lists(st.booleans(), min_size=1, max_size=60))
def test_the_counter_saturates_and_forgives_one_by_one(bad: list[bool]) -> None:
    trip_at, count, expected = LIMITS.torque.readings, 0, False
    for flag in bad:
        count = min(trip_at, count + 1) if flag else max(0, count - 1)
        expected = expected or count >= trip_at
    padded = bad + [False] * (-len(bad) % 5)
    samples = [
        sample_at(
            k, torque_nm=tuple(2000.0 if flag else 1.0 + i / 10 for i, flag in enumerate(padded[5 * k :][:5]))
        )
        for k in range(len(padded) // 5)
    ]
    assert any("torque_range" in block for block in verdicts(samples, wanted=False)) is expected


@pytest.mark.parametrize("name", FIELDS)
def test_a_signal_with_too_few_readings_is_stale(name: str) -> None:
    least = LIMITS.freshness.min_readings
    for count, stale in ((least, False), (least - 1, True), (0, True)):
        samples = [moving(0), moving(1, **{FIELDS[name]: tuple(20.0 + i for i in range(count))})]
        assert (f"{name}_stale" in verdicts(samples)[1]) is stale


@pytest.mark.parametrize("name", FIELDS)
def test_a_frozen_signal_is_found_while_the_brake_turns_under_pressure(name: str) -> None:
    blocks = LIMITS.sanity.frozen_readings // 5
    value = BRAKING[FIELDS[name]][0]
    stuck = {FIELDS[name]: (value,) * 5}
    found = verdicts([moving(k, **stuck) for k in range(blocks)])
    assert f"{name}_frozen" in found[-1]
    assert not any(found[: blocks - 1])
    # One other digit starts the run anew; standing still, nothing need move.
    samples = [moving(k, **stuck) for k in range(2 * blocks - 2)]
    samples[blocks - 1] = moving(blocks - 1)
    assert not any(verdicts(samples))
    still = [sample_at(k, **stuck, relay_closed=True) for k in range(2 * blocks)]
    assert not any(verdicts(still))


@pytest.mark.parametrize("k", [0, 1, 3, 4, 9])
def test_block_numbers_rise_by_one(k: int) -> None:
    samples = [moving(0), moving(1), replace(moving(2), k=k)]
    assert ("samples_gap" in verdicts(samples)[2]) is (k != 2)


@pytest.mark.parametrize(
    ("changes", "bad"),
    [
        ({}, False),
        ({"t_s": 0.1 + 0.0019}, False),
        ({"t_s": 0.1 + 0.0021}, True),
        ({"t_s": 0.1 - 0.0021}, True),
        ({"t_s": 0.0}, True),
        ({"t_s": math.nan}, True),
        ({"dt_s": math.nan}, True),
        ({"dt_s": 0.0}, True),
        ({"dt_s": -0.05}, True),
        ({"dt_s": 1.0, "t_s": 1.05}, False),
        ({"dt_s": 1.1, "t_s": 1.15}, True),
    ],
)
def test_the_clock_of_the_safety_channel(changes: dict[str, float], bad: bool) -> None:
    found = verdicts([moving(0), replace(moving(1), **changes)])
    assert ("samples_clock" in found[1]) is bad


def test_temperature_is_stopped_early_when_it_rises_fast() -> None:
    def ramp(rate_k_per_s: float, end_degc: float) -> bool:
        # The last reading of the last block is `end_degc`.
        samples = []
        for k in range(60):
            times = [(k * 5 + i - 299) * 0.01 for i in range(5)]
            degc = tuple(end_degc + rate_k_per_s * t for t in times)
            samples.append(sample_at(k, relay_closed=True, temperature_degc=degc))
        return any("temperature_approach" in block for block in verdicts(samples))

    assert not ramp(5.0, 490.0)
    assert ramp(31.0, 490.0)  # 490 + 31·0.8 > 500
    assert not ramp(-10.0, 465.0)  # it came down from 495
    assert not ramp(200.0, 249.0)  # below the gate


def test_a_frozen_pyrometer_cannot_hide_the_rise() -> None:
    # 84 kW into 1900 J/K: 40 K/s · 0.8 s = 32 K. The pyrometer says 480 and stays there.
    hot = {"temperature_degc": (480.0, 480.1, 480.0, 480.1, 480.0)}
    power = {
        "torque_nm": (1000.0, 1000.1, 1000.2, 1000.0, 1000.1),
        "speed_rpm": (800.0, 800.1, 800.2, 800.0, 800.0),
    }
    assert "temperature_approach" in verdicts([moving(k, **hot, **power) for k in range(4)])[-1]
    assert not any(verdicts([moving(k, **hot) for k in range(4)]))


@pytest.mark.parametrize(
    ("kw", "seconds", "expected"),
    [
        (88.0, 2.0, []),
        (88.4, 0.45, []),
        (88.4, 0.55, ["power_range"]),
        (101.0, 0.05, []),
        (101.0, 0.15, ["power_peak"]),
    ],
)
def test_power(kw: float, seconds: float, expected: list[str]) -> None:
    torque = kw * 30000.0 / math.pi / 800.0
    samples = [
        moving(k, speed_rpm=(800.0,) * 5, torque_nm=(torque,) * 5, temperature_degc=(100.0 + k,) * 5)
        for k in range(round(seconds / 0.05))
    ]
    found = {name for block in verdicts(samples) for name in block if name.startswith("power")}
    assert sorted(found) == expected


def test_power_with_too_few_speeds_is_bad_where_nothing_is_known() -> None:
    sample = moving(1, torque_nm=(1250.0,) * 5, speed_rpm=())
    view = View(sample, None, True)
    assert view.powers_kw() == ()
    assert "speed_stale" in verdicts([moving(0), sample])[1]


def test_relay_and_chain() -> None:
    n = LIMITS.relay.readback_blocks
    shut = [sample_at(k, relay_closed=True) for k in range(n)]
    assert verdicts(shut, wanted=False)[n - 2 :] == [[], ["relay_welded"]]
    open_ = [sample_at(k, relay_closed=False) for k in range(n)]
    assert verdicts(open_, wanted=True)[n - 2 :] == [[], ["relay_not_closed"]]
    m = LIMITS.relay.enabled_blocks
    enabled = [sample_at(k, drive_enabled=True) for k in range(m)]
    assert verdicts(enabled, wanted=False)[m - 2 :] == [[], ["drive_enabled"]]
    assert not any(
        verdicts([sample_at(k, drive_enabled=True, relay_closed=True) for k in range(m)], wanted=True)
    )
    for bad in (False, None, 0, 1, "yes"):
        assert verdicts([sample_at(0, estop_ok=bad)], wanted=False) == [["estop"]]
        assert verdicts([sample_at(0, doors_ok=bad)], wanted=False) == [["doors"]]


def test_a_signal_without_a_valid_reading_is_nan_everywhere() -> None:
    for values in ((), (None,), (math.nan, None)):
        signal = Signal(values, None)
        assert all(math.isnan(x) for x in (signal.low, signal.high, signal.mean, signal.last))
        view = View(sample_at(0, pressure_bar=values), None, False)
        assert not view.at_rest(1.0, 1.0)


@CALM
@given(st.lists(st.floats(-1e6, 1e6) | st.none() | st.just(math.nan), max_size=50))
def test_signal_statistics_agree_with_the_definition(values: list[float | None]) -> None:
    valid = [v for v in values if v is not None and not math.isnan(v)]
    signal = Signal(tuple(values), None)
    assert signal.count == len(values)
    assert signal.invalid == len(values) - len(valid)
    if valid:
        assert (signal.low, signal.high) == (min(valid), max(valid))
        assert signal.mean == pytest.approx(sum(valid) / len(valid), abs=1e-6)


def test_good_samples_of_the_proof_follow_each_other() -> None:
    third, fourth = good_sample(3, LIMITS), good_sample(4, LIMITS)
    assert fourth.t_s - third.t_s == pytest.approx(fourth.dt_s)


def test_a_full_counter_empties_with_the_good_readings_of_the_next_block() -> None:
    trip_at = LIMITS.torque.readings
    bad, good = 2000.0, (1.0, 1.1, 1.2, 1.1, 1.0)
    almost = (bad,) * (trip_at - 1) + good[trip_at - 1 :]
    blocks = [(bad,) * 5] * 4 + [good, almost, good, almost]
    found = verdicts([sample_at(k, torque_nm=values) for k, values in enumerate(blocks)], wanted=False)
    assert ["torque_range" in block for block in found] == [True] * 4 + [False] * 4


@pytest.mark.parametrize(
    ("check", "name"),
    [
        ("pressure_peak", "pressure_bar"),
        ("torque_range", "torque_nm"),
        ("temperature_range", "temperature_degc"),
    ],
)
def test_a_limit_is_not_kept_by_a_reading_that_is_no_number(check: str, name: str) -> None:
    values = (None, math.nan, None, *getattr(moving(1), name)[3:])
    assert check in verdicts([moving(0), moving(1, **{name: values})])[1]


def test_a_run_begins_only_after_a_block_of_that_one_number() -> None:
    first = Signal((1.0, 2.0), None)
    assert (first.run, Signal((2.0, 2.0), first).run) == (0, 2)
    second = Signal((2.0, 2.0), None)
    assert (second.run, Signal((2.0, 2.0, 2.0), second).run, Signal((3.0,), second).run) == (2, 5, 1)


def test_a_rate_needs_half_a_second() -> None:
    degc = [450.0] + [460.0] * 8
    samples = [sample_at(k, relay_closed=True, temperature_degc=(value,) * 5) for k, value in enumerate(degc)]
    assert not any(verdicts(samples))


@pytest.mark.parametrize(
    ("pressure", "speed", "rest"),
    [(0.0, 0.0, True), (0.9, -0.9, True), (-0.9, 0.9, True), (1.0, 0.0, False), (-1.0, 0.0, False),
     (0.0, 1.0, False), (0.0, -1.0, False), (-5.0, 0.0, False), (0.0, -5.0, False)],
)  # fmt: skip
def test_rest_is_two_sided(pressure: float, speed: float, rest: bool) -> None:
    view = View(sample_at(0, pressure_bar=(9.0, pressure), speed_rpm=(9.0, speed)), None, False)
    assert view.at_rest(1.0, 1.0) is rest


@pytest.mark.parametrize(
    ("value", "limit"),
    [(1300.5, LIMITS.torque.max_nm), (-195.6, LIMITS.torque.min_nm)],
)
def test_the_limit_that_was_passed_is_the_one_that_is_reported(value: float, limit: float) -> None:
    runner, before, causes = CheckRunner(LIMITS), None, []
    for k in range(4):
        view = View(sample_at(k, torque_nm=(value,) * 10), before, relay_wanted=False)
        causes += [v.cause for v in runner.run(view, before) if v.check.id == "torque_range"]
        before = view
    assert {(cause.value, cause.threshold) for cause in causes} == {(value, limit)}
