"""Identification: known parameters recovered, uncertainty, what the data fix, samples against the
linearisation.
"""

from pathlib import Path

import numpy as np
import pytest

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.design.fit import (
    Measured,
    chain,
    fit,
    gradient,
    potential_scale_reduction,
    predict,
)
from sim_hardware.brake_model.design.scatter import variables
from sim_hardware.brake_model.parametric import LinearBrake

BRAKES = Path("configs/brakes")
PLANT = LinearBrake(load_brake(BRAKES / "plant.toml"))
MODEL = LinearBrake(load_brake(BRAKES / "model.toml"))
BASIC = LinearBrake(load_brake(BRAKES / "basic.toml"))
ROUGH = Measured(12.0, 0.5, 2350.0, 10.0)


def test_known_parameters_are_recovered_from_synthetic_data():
    """Data of the plant with two parameters changed; the fit starts from the unchanged plant with a wide
    prior.
    """
    chosen = variables(PLANT, ["m_padi", "d_pis_t"])
    truth = np.log([0.96, 1.25])
    onset, frequency = predict(PLANT, chosen, truth, ROUGH)
    assert abs(onset / 12.0 - 1.0) > 0.01
    found = fit(PLANT, chosen, Measured(onset, 1e-4, frequency, 1e-3), spreads=[0.5, 0.5])
    assert found.converged
    assert found.logarithms == pytest.approx(truth, abs=2e-4)
    assert found.identifiable == 2
    assert (found.posterior < 0.01).all()
    assert found.after == pytest.approx([onset, frequency], rel=1e-5)


def test_truth_lies_within_the_stated_uncertainty():
    """Noisy data of scattered plants: the truth lies within two standard deviations nearly always."""
    chosen = variables(PLANT, ["m_padi", "d_pis_t", "c_abu_t"])
    random, prior = np.random.default_rng(4), np.array([0.03, 0.1, 0.03])
    inside = []
    for _ in range(8):
        truth = prior * random.standard_normal(3)
        exact = predict(PLANT, chosen, truth, ROUGH)
        noisy = exact + np.array([0.1, 3.0]) * random.standard_normal(2)
        found = fit(PLANT, chosen, Measured(noisy[0], 0.1, noisy[1], 3.0), spreads=prior)
        inside.extend(np.abs(found.logarithms - truth) < 2.0 * found.posterior)
    assert np.mean(inside) > 0.85


def test_two_numbers_fix_at_most_two_combinations():
    names = ["m_padi", "c_abu_t", "c_knu_t", "m_ct", "c_knu_l", "d_pis_t", "c_pis_t", "x_con", "c_con_il"]
    chosen = variables(MODEL, names)
    found = fit(MODEL, chosen, ROUGH, spreads=[0.1] * len(chosen))
    assert found.converged
    assert found.identifiable == 2
    assert found.singular_values.size == 2
    assert found.after == pytest.approx([12.0, 2350.0], rel=0.1)
    assert (found.posterior <= found.prior * (1 + 1e-12)).all()
    # information adds up: the sum of shrunk variances is that of two directions, never more
    lost = 1.0 - (found.posterior / found.prior) ** 2
    assert lost.sum() == pytest.approx(
        (found.singular_values**2 / (1 + found.singular_values**2)).sum(), rel=1e-6
    )
    assert found.directions @ found.directions.T == pytest.approx(np.eye(2), abs=1e-9)


def test_gradient_of_the_prediction_is_that_of_finite_differences():
    chosen = variables(PLANT, ["m_padi", "c_abu_t"], ["piston_damping"])
    x = np.array([0.02, -0.03, 0.1])
    here = predict(PLANT, chosen, x, ROUGH)
    slopes = gradient(PLANT, chosen, x, here[0], ROUGH)
    for i in range(3):
        step = np.zeros(3)
        step[i] = 1e-5
        numeric = (predict(PLANT, chosen, x + step, ROUGH) - predict(PLANT, chosen, x - step, ROUGH)) / 2e-5
        assert slopes[:, i] == pytest.approx(numeric, rel=1e-4, abs=1e-3)


def test_onset_alone_and_onset_over_friction():
    chosen = variables(BASIC, ["c_con_it", "c_con_ot"])
    found = fit(BASIC, chosen, Measured(0.55, 0.02, quantity="mu"), spreads=[0.1, 0.1])
    assert found.after.shape == (1,)
    assert found.singular_values.shape == (1,)
    assert found.after[0] == pytest.approx(0.55, abs=0.02)


def test_samples_agree_with_the_linearisation_where_it_holds():
    """Accurate data and narrow priors: nearly Gaussian, so samples must have the linearised spread."""
    chosen = variables(PLANT, ["m_padi", "d_pis_t"])
    measured = Measured(12.0, 0.05, 2350.0, 2.0)
    found = fit(PLANT, chosen, measured, spreads=[0.01, 0.02])
    chains = [chain(PLANT, chosen, measured, found, np.random.default_rng(i), 40) for i in range(3)]
    samples = np.array([c[0] for c in chains])
    assert samples.shape == (3, 40, 2)
    assert potential_scale_reduction(samples).max() < 1.2
    flat = samples.reshape(-1, 2)
    assert flat.std(axis=0) == pytest.approx(found.posterior, rel=0.35)
    assert np.abs(flat.mean(axis=0) - found.logarithms).max() < 0.5 * found.posterior.max()
    predictions = np.array([c[1] for c in chains]).reshape(-1, 2)
    assert predictions[17] == pytest.approx(predict(PLANT, chosen, flat[17], measured))


def test_chains_are_repeatable():
    chosen = variables(PLANT, ["m_padi"])
    found = fit(PLANT, chosen, ROUGH, spreads=[0.05])
    one, two = (chain(PLANT, chosen, ROUGH, found, np.random.default_rng(3), 5)[0] for _ in range(2))
    assert (one == two).all()


def test_chains_that_disagree_are_noticed():
    random = np.random.default_rng(1)
    agreeing = random.standard_normal((4, 100, 2))
    assert potential_scale_reduction(agreeing).max() < 1.1
    agreeing[0, :, 1] += 3.0
    assert potential_scale_reduction(agreeing)[1] > 1.5


def test_nonsense_is_refused():
    with pytest.raises(ValueError, match=r"does not begin to squeal.*falling slope"):
        fit(BASIC, variables(BASIC, ["m_disc"]), ROUGH, spreads=[0.05])
    with pytest.raises(ValueError, match="positive one for each of 1"):
        fit(PLANT, variables(PLANT, ["m_disc"]), ROUGH, spreads=[0.0])
    with pytest.raises(ValueError, match="cannot be free"):
        fit(BASIC, variables(BASIC, ["mu"]), Measured(0.5, 0.01, quantity="mu"), spreads=[0.1])
    for numbers in ((-1.0, 0.1), (12.0, 0.0), (float("nan"), 0.1), (12.0, 0.1, 2350.0, -1.0)):
        with pytest.raises(ValueError, match="positive"):
            Measured(*numbers)
    with pytest.raises(ValueError, match="no uncertainty"):
        Measured(12.0, 0.1, 2350.0)
