"""Dry run: each impossible set-point is found once; the estimate behaves like a disc that heats and cools."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from scipy.integrate import solve_ivp

from sequences import Program
from sequences.braking import AXES
from sequences.capabilities import WATTS_PER_NM_RPM, RigCapabilities
from sequences.check import CheckResult, Problem, check_program
from sequences.estimate import estimate_duration, loop_order_durations

Maker = Callable[..., dict[str, Any]]
ROW = {"duration_s": 10, "start_rpm": 40, "end_rpm": 40}


@pytest.fixture
def check(sequence_data: Maker, rig: RigCapabilities) -> Callable[..., CheckResult]:
    def run(**changes: Any) -> CheckResult:
        program = Program.model_validate({"name": "p", "sequences": [sequence_data(**changes)]})
        return check_program(program, rig)

    return run


def only(result: CheckResult) -> Problem:
    assert len(result.problems) == 1, result.problems
    return result.problems[0]


def test_a_program_within_the_limits_has_no_problems(check: Callable[..., CheckResult]) -> None:
    result = check()
    assert result.ok
    assert result.problems == ()
    assert result.n_brakings == 6
    assert result.n_by_sequence == {"some": 6}


Case = tuple[dict[str, Any], str, str, str, int, int]
IMPOSSIBLE: list[Case] = [
    # changes, key, value, part of the remedy, first braking, number of brakings
    ({"pressures_bar": [10, 35.5, 36]}, "pressures_bar", "1094.28, 1109.91 N·m", "at most 32.5 bar", 2, 4),
    (
        {"pressures_bar": [10, 39], "speed_profiles": [{**ROW, "start_rpm": 0, "end_rpm": 0}],
         "pressure_function": {"kind": "ramp", "amplitude_bar": 6.0}},
        "pressures_bar", "45 bar", "working point plus amplitude", 2, 2,
    ),
    (
        {"pressures_bar": [5], "pressure_function": {"kind": "ramp", "amplitude_bar": 4.5}},
        "pressures_bar", "0.5 bar", "at least 1 bar", 1, 2,
    ),
    (
        {"pressure_function": {"kind": "sine", "amplitude_bar": 4.0, "frequency_hz": 5.0}},
        "pressure_function", "125.664 bar/s", "lower amplitude", 1, 6,
    ),
    (
        {"pressures_bar": [15], "pressure_function": {"kind": "constant", "rise_s": 0.1}},
        "pressure_function", "150 bar/s", "lengthen rise_s", 1, 2,
    ),
    ({"speed_profiles": [ROW, {**ROW, "start_rpm": 610}]}, "speed_profiles", "610 1/min", "up to 600", 4, 6),
    ({"speed_profiles": [{**ROW, "start_rpm": -10}]}, "speed_profiles", "-10 1/min", "from 0 1/min", 1, 6),
    (
        {"speed_profiles": [{"duration_s": 1, "start_rpm": 200, "end_rpm": 0}]},
        "speed_profiles", "200 1/min per s", "lengthen the segment", 1, 6,
    ),
    ({"temperatures_degc": [22, 50]}, "temperatures_degc", "22 degC", "from 25 degC", 1, 3),
    (
        {"limits": {"max_degc": 600.0, "cool_down_degc": 480.0}},
        "limits.max_degc", "600 degC", "500 or less", 1, 6,
    ),
    (
        {"conditioning": {"drag_speed_rpm": 700}},
        "conditioning.drag_speed_rpm", "700 1/min", "rig's own", 1, 6,
    ),
    (
        {"conditioning": {"drag_pressure_bar": 45}},
        "conditioning.drag_pressure_bar", "45 bar", "rig's own", 1, 6,
    ),
    (
        # Of three brakings at 50 degC the first must be heated to it; at 300 degC each must be.
        {"conditioning": {"drag_speed_rpm": 10, "drag_pressure_bar": 2}, "temperatures_degc": [50, 300]},
        "temperatures_degc", "50, 300 degC", "raise conditioning.drag_pressure_bar", 1, 4,
    ),
    ({"recording": {"channels": [{"name": "accelerometer"}]}}, "recording.channels", "accelerometer",
     "disc_temperature, microphone, pressure", 1, 6),
    (
        {"recording": {"channels": [{"name": "torque"}]}},
        "recording.channels", "torque at 40000 Hz", "4000", 1, 6,
    ),
    ({"recording": {"channels": [{"name": "torque", "decimation": 25}]}}, "recording.channels",
     "torque at 1600 Hz", "4000, 2000, 1000", 1, 6),
    ({"ventilator": True}, "ventilator", "microphone", "ventilator = false", 1, 6),
]  # fmt: skip


@pytest.mark.parametrize("case", IMPOSSIBLE, ids=lambda case: f"{case[1]}-{case[2]}")
def test_impossible_set_points_are_found_once(check: Callable[..., CheckResult], case: Case) -> None:
    changes, key, value, remedy, first, count = case
    result = check(**changes)
    problem = only(result)
    assert not result.ok
    assert problem.place == f"sequences[0] 'some': {key}"
    assert problem.value == value
    assert remedy.lower() in problem.remedy.lower()
    assert (problem.first_index, problem.count) == (first, count)


def test_45_bar_is_named_with_the_actuator_and_with_the_drive(check: Callable[..., CheckResult]) -> None:
    actuator, drive = check(pressures_bar=[45]).errors
    assert (actuator.value, drive.value) == ("45 bar", "1391.29 N·m")
    assert "40 bar of the actuator" in actuator.problem


def test_power_counts_speed_and_pressure_together(sequence_data: Maker, rig: RigCapabilities) -> None:
    weak = rig.model_copy(update={"drive_power_kw": 15.0})
    data = sequence_data(
        pressures_bar=[5, 30], speed_profiles=[{**ROW, "end_rpm": 40}, {**ROW, "start_rpm": 200}]
    )
    problem = only(check_program(Program.model_validate({"name": "p", "sequences": [data]}), weak))
    peak_kw = rig.peak_torque_nm(30.0) * 200.0 * WATTS_PER_NM_RPM / 1000.0
    assert problem.value == f"{peak_kw:.6g} kW"
    assert problem.count == 2  # of eight brakings: the fast ones with 30 bar, at two temperatures


def test_a_drive_that_reverses_may_reverse(sequence_data: Maker, rig: RigCapabilities) -> None:
    both_ways = rig.model_copy(update={"min_speed_rpm": -600.0})
    data = sequence_data(speed_profiles=[{**ROW, "start_rpm": -40, "end_rpm": -40}])
    program = Program.model_validate({"name": "p", "sequences": [data]})
    assert check_program(program, both_ways).ok
    assert not check_program(program, rig).ok


def test_many_values_are_shortened_in_the_report(check: Callable[..., CheckResult]) -> None:
    result = check(temperatures_degc=list(range(10, 20)))
    assert only(result).value == "10, 11, 12, 13, 14, ... (10 values) degC"


def test_expected_overheating_and_time_outs_are_warnings(check: Callable[..., CheckResult]) -> None:
    hot = check(
        temperatures_degc=[450],
        pressures_bar=[30],
        speed_profiles=[{"duration_s": 30, "start_rpm": 200, "end_rpm": 200}],
    )
    assert hot.ok
    assert only(hot).place.endswith("limits.max_degc")
    slow = check(temperatures_degc=[300], conditioning={"timeout_s": 20.0})
    assert slow.ok
    assert only(slow).place.endswith("conditioning.timeout_s")


def test_data_volume(check: Callable[..., CheckResult]) -> None:
    channels = [{"name": "microphone"}, {"name": "torque", "decimation": 40}]
    result = check(recording={"channels": channels, "pre_s": 1.0, "post_s": 1.0})
    assert result.data_bytes == 6 * 12 * (40000 * 2 + 1000 * 4)


def test_the_times_of_the_parts_add_up(check: Callable[..., CheckResult]) -> None:
    result = check(dwell_s=3.0, conditioning={"soak_s": 5.0})
    parts = result.estimate
    assert parts.braking_s == pytest.approx(60.0)
    assert parts.soaking_s == pytest.approx(30.0)
    # per braking: 0.4 s to 40 1/min, 0.5 s before, 0.5 s after, 0.4 s to standstill, 3 s dwell
    assert parts.other_s == pytest.approx(6 * 4.8)
    assert result.estimated_duration_s == pytest.approx(sum(parts.model_dump().values()))


def _reference_time_s(
    rig: RigCapabilities, start_degc: float, end_degc: float, power_w: float, ventilated: bool
) -> float:
    """Heating or cooling by the differential equation of `ThermalCoefficients`, integrated tightly."""
    disc = rig.thermal
    conductance = disc.ventilated_w_k if ventilated else disc.still_w_k

    def slope(_: float, degc: Any) -> Any:
        radiated = disc.radiation_w_k4 * ((degc + 273.15) ** 4 - (disc.ambient_degc + 273.15) ** 4)
        return (power_w - conductance * (degc - disc.ambient_degc) - radiated) / disc.heat_capacity_j_k

    def reached(_: float, degc: Any) -> float:
        return float(degc[0] - end_degc)

    reached.terminal = True  # type: ignore[attr-defined]
    solution = solve_ivp(slope, (0.0, 1e5), [start_degc], events=reached, rtol=1e-9, atol=1e-9)
    return float(solution.t_events[0][0])


@pytest.mark.parametrize(
    ("start_degc", "end_degc"), [(310.0, 30.0), (120.0, 100.0), (480.0, 60.0), (35.0, 30.0)]
)
def test_cooling_time_agrees_with_the_differential_equation(
    sequence_data: Maker, rig: RigCapabilities, start_degc: float, end_degc: float
) -> None:
    conditioning = {"tolerance_k": 1.0, "soak_s": 0.0, "mode": "at_most"}
    data = sequence_data(temperatures_degc=[end_degc - 1.0], pressures_bar=[5], conditioning=conditioning)
    program = Program.model_validate({"name": "p", "sequences": [data]})
    expected_s = _reference_time_s(rig, start_degc, end_degc, 0.0, ventilated=True)
    estimate = estimate_duration(program.brakings(), rig, start_degc)
    assert estimate.cooling_s == pytest.approx(expected_s, rel=0.05)
    assert estimate.heating_s == 0.0


@pytest.mark.parametrize("end_degc", [50.0, 150.0, 310.0])
def test_heating_time_agrees_with_the_differential_equation(
    sequence_data: Maker, rig: RigCapabilities, end_degc: float
) -> None:
    data = sequence_data(
        temperatures_degc=[end_degc + 1.0],
        pressures_bar=[5],
        conditioning={"tolerance_k": 1.0, "soak_s": 0.0},
    )
    program = Program.model_validate({"name": "p", "sequences": [data]})
    power_w = rig.nominal_torque_nm(10.0) * 200.0 * WATTS_PER_NM_RPM * rig.thermal.disc_heat_share
    expected_s = _reference_time_s(rig, 20.0, end_degc, power_w, ventilated=False)
    estimate = estimate_duration(program.brakings(), rig)
    moving_s = 200.0 / rig.max_speed_rate_rpm_s + rig.release_s
    assert estimate.heating_s - moving_s == pytest.approx(expected_s, rel=0.05)
    assert estimate.cooling_s == 0.0


def test_at_most_never_heats(check: Callable[..., CheckResult]) -> None:
    assert check(conditioning={"mode": "exact"}).estimate.heating_s > 0
    assert check(conditioning={"mode": "at_most"}).estimate.heating_s == 0


def test_without_conditioning_nothing_is_heated_or_cooled(check: Callable[..., CheckResult]) -> None:
    parts = check(temperatures_degc=..., conditioning={"enabled": False, "soak_s": 5.0}).estimate
    assert (parts.heating_s, parts.cooling_s, parts.soaking_s) == (0.0, 0.0, 0.0)


def test_temperature_outside_is_quicker_than_inside(sequence_data: Maker, rig: RigCapabilities) -> None:
    data = sequence_data(temperatures_degc=[50, 150, 250])
    program = Program.model_validate({"name": "p", "sequences": [data]})
    durations = loop_order_durations(program, "some", rig)
    assert len(durations) == 6
    outside, inside = durations[AXES], durations[("pressure", "speed", "temperature")]
    assert outside.total_s < inside.total_s
    assert outside.braking_s == inside.braking_s
    assert durations[AXES] == estimate_duration(program.brakings(), rig)
    with pytest.raises(KeyError):
        loop_order_durations(program, "other", rig)
