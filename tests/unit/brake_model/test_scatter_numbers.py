"""Scatter: first onset and its gradient, laws, confidence intervals, drivers, and the known spread of our
brakes.
"""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.design.scatter import LAWS, changed, draw, drivers, variables, wilson
from sim_hardware.brake_model.eigen.first_onset import onset_gradient, scan
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.stability import onset_mu, onset_pressure

BRAKES = Path("configs/brakes")
MODEL = LinearBrake(load_brake(BRAKES / "model.toml"))
BASIC = LinearBrake(load_brake(BRAKES / "basic.toml"))
PRESSURES, FRICTIONS = np.linspace(0.0, 30.0, 31), np.linspace(0.0, 1.6, 41)


def test_onset_is_that_of_the_bisection():
    by_pressure = onset_pressure(MODEL.brake)
    found = scan(MODEL, "pressure", PRESSURES)
    assert found.onset == pytest.approx(by_pressure.value, rel=1e-8)
    assert found.frequency_hz == pytest.approx(by_pressure.frequency_hz, rel=1e-8)
    by_mu = onset_mu(BASIC.brake, mu_max=1.6)
    found = scan(BASIC, "mu", FRICTIONS)
    assert (found.onset, found.frequency_hz) == pytest.approx((by_mu.value, by_mu.frequency_hz), rel=1e-8)
    assert (found.unstable == (found.onset <= FRICTIONS)).all()


def test_scan_that_ends_early_finds_the_same_onset():
    whole, part = scan(BASIC, "mu", FRICTIONS), scan(BASIC, "mu", FRICTIONS, whole=False)
    assert (whole.onset, whole.frequency_hz) == (part.onset, part.frequency_hz)
    assert np.isnan(part.growth_1_s[-1])


def test_scan_over_a_quantity_in_which_the_matrices_are_not_linear():
    grid = np.linspace(0.8, 1.2, 9) * MODEL.quantities["x_con"].value
    found = scan(MODEL, "x_con", grid, {"pressure": 15.0})
    for x, growth in zip(grid, found.growth_1_s, strict=True):
        exact = np.linalg.eigvals(MODEL.matrices({"x_con": x, "pressure": 15.0}).state_matrix()).real.max()
        assert growth == pytest.approx(exact, abs=1e-6)


def test_scan_at_the_edges():
    assert scan(MODEL, "pressure", PRESSURES, {"slope": 0.0}).onset is None
    assert scan(MODEL, "pressure", np.array([20.0, 25.0])).onset == 20.0
    assert scan(MODEL, "pressure", np.array([20.0])).onset == 20.0
    for grid in (np.array([]), np.array([1.0, 1.0]), np.array([0.0, np.nan])):
        with pytest.raises(ValueError, match="rising"):
            scan(MODEL, "pressure", grid)
    with pytest.raises(KeyError, match="no quantity"):
        scan(MODEL, "presure", PRESSURES)


@pytest.mark.parametrize("name", ["m_padi", "c_abu_t", "d_pis_t", "x_pis", "slope", "mu"])
def test_gradient_of_the_onset_is_that_of_finite_differences(name):
    at = scan(MODEL, "pressure", PRESSURES)
    slope, frequency_slope = onset_gradient(MODEL, "pressure", at.onset, [name])
    value = MODEL.quantities[name].value
    step = 1e-5 * value
    up, down = (scan(MODEL, "pressure", PRESSURES, {name: value + s}) for s in (step, -step))
    # in relative units: change of the onset, of the frequency, per relative change of the quantity
    assert slope[0] * value == pytest.approx((up.onset - down.onset) / 2e-5, rel=1e-4, abs=1e-4)
    assert frequency_slope[0] * value == pytest.approx(
        (up.frequency_hz - down.frequency_hz) / 2e-5, rel=1e-4, abs=1e-2
    )


def test_gradient_needs_a_quantity_that_matters():
    with pytest.raises(ValueError, match="does not move"):
        onset_gradient(MODEL, "pressure", 15.0, ["m_padi"], {"slope": 0.0})


def test_spread_of_our_brakes_is_the_known_one():
    """brake-identification: ±5 % gives A 0.44 to 0.92 and 2373 to 2429 Hz, B 14.5 to 16.1 bar and 2113 to
    2169 Hz.

    With 60 samples the 10 % and 90 % quantiles are uncertain by about a third of the width.
    """
    for model, over, grid, onset, frequency in (
        (BASIC, "mu", FRICTIONS, (0.44, 0.92), (2373.0, 2429.0)),
        (MODEL, "pressure", PRESSURES, (14.5, 16.1), (2113.0, 2169.0)),
    ):
        chosen, random = variables(model), np.random.default_rng(3)
        found = [
            scan(
                model,
                over,
                grid,
                changed(model, chosen, draw(random, len(chosen), 0.05, "uniform")),
                whole=False,
            )
            for _ in range(60)
        ]
        onsets = [np.inf if s.onset is None else s.onset for s in found]
        frequencies = [s.frequency_hz for s in found if s.frequency_hz is not None]
        for values, (low, high) in ((onsets, onset), (frequencies, frequency)):
            tolerance = 0.35 * (high - low)
            assert np.quantile(values, (0.1, 0.9)) == pytest.approx((low, high), abs=tolerance)


@settings(max_examples=30, deadline=None)
@given(spread=st.floats(0.001, 0.9), law=st.sampled_from(LAWS), seed=st.integers(0, 1000))
def test_factors_are_positive_and_repeatable(spread, law, seed):
    factors = draw(np.random.default_rng(seed), 400, spread, law)
    assert (factors > 0.0).all()
    assert (factors == draw(np.random.default_rng(seed), 400, spread, law)).all()
    if law == "uniform":
        assert np.abs(factors - 1.0).max() <= spread
    else:
        assert np.log(factors).std() == pytest.approx(spread, rel=0.15)


@pytest.mark.parametrize("spread", [0.0, -0.1, 1.0, float("nan")])
def test_nonsense_spreads_are_refused(spread):
    with pytest.raises(ValueError, match="between 0 and 1"):
        draw(np.random.default_rng(1), 3, spread, "uniform")
    with pytest.raises(ValueError, match="unknown law"):
        draw(np.random.default_rng(1), 3, 0.1, "normal")


def test_variables_are_the_parameters_of_the_file():
    names = {v.name for v in variables(MODEL)}
    assert {"m_disc", "c_con_il", "x_pis"} <= names
    assert not names & {"mu", "slope", "pressure", "piston_area"}
    assert not any("." in name for name in names)
    group = variables(MODEL, groups=["piston_position"])
    assert [v.name for v in group] == ["piston_position"]
    assert len(group[0].members) == 4
    values = changed(MODEL, group, np.array([1.1]))
    assert values["inner_pad.piston_l.x"] == pytest.approx(-1.1 * 0.017)


def test_wrong_variables_are_refused():
    with pytest.raises(KeyError, match="did you mean"):
        variables(MODEL, ["c_con"])
    with pytest.raises(KeyError, match="no group 'pistons'"):
        variables(MODEL, groups=["pistons"])
    with pytest.raises(ValueError, match="varied twice"):
        variables(MODEL, ["m_disc", "m_disc"])
    with pytest.raises(ValueError, match="is 0 in the model"):
        variables(BASIC, ["slope"])


def test_wilson_covers_as_stated():
    """Exact coverage by adding up binomial probabilities; and the textbook's values for 0 and 5 of 10."""
    trials = 40
    counts = np.arange(trials + 1)
    interval = wilson(counts, trials)
    coverage = [
        stats.binom.pmf(counts, trials, p)[(interval.low <= p) & (p <= interval.high)].sum()
        for p in np.linspace(0.02, 0.98, 97)
    ]
    assert min(coverage) > 0.83
    assert np.mean(coverage) == pytest.approx(0.95, abs=0.01)
    few = wilson(np.array([0, 5, 10]), 10)
    assert few.low == pytest.approx([0.0, 0.2366, 0.7225], abs=1e-4)
    assert few.high == pytest.approx([0.2775, 0.7634, 1.0], abs=1e-4)
    for counts, trials in ((np.array([1]), 0), (np.array([3]), 2), (np.array([-1]), 2)):
        with pytest.raises(ValueError, match="counts"):
            wilson(counts, trials)


def test_drivers_are_spearmans_correlations():
    random = np.random.default_rng(7)
    factors = random.uniform(0.9, 1.1, (200, 3))
    outcome = factors[:, 0] ** 5 + 0.01 * random.standard_normal(200)
    found = drivers(factors, outcome)
    for i in range(3):
        assert found.correlation[i] == pytest.approx(stats.spearmanr(factors[:, i], outcome).statistic)
    assert abs(found.correlation[0]) > found.threshold > abs(found.correlation[1])
    # stable samples (inf) rank highest, missing ones (nan) are left out
    censored = np.where(factors[:, 0] > 1.05, np.inf, factors[:, 0])
    censored[:10] = np.nan
    kept = drivers(factors, censored)
    assert kept.samples == 190
    assert kept.correlation[0] > 0.9
    assert np.isnan(drivers(factors, np.full(200, np.inf)).correlation).all()


def test_chance_rarely_exceeds_the_threshold_of_drivers():
    random = np.random.default_rng(2)
    exceeded = 0
    for _ in range(200):
        found = drivers(random.random((50, 20)), random.random(50))
        exceeded += bool((np.abs(found.correlation) > found.threshold).any())
    assert exceeded / 200 < 0.1


def test_models_too_large_for_all_eigenvalues_are_refused(monkeypatch):
    monkeypatch.setattr("sim_hardware.brake_model.eigen.first_onset.MOST_FREEDOMS", 13)
    with pytest.raises(ValueError, match=r"has 14 degrees of freedom.*up to 13; reduce it"):
        scan(MODEL, "pressure", PRESSURES)
