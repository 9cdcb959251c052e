"""Large models made small: the same eigenvalues in the band, at and between the working points; all "
"studies take it."""

from functools import cache

import numpy as np
import pytest
from disc_brake_mesh import disc_brake

from sim_hardware.brake_model.eigen.band import eigen_pairs_of
from sim_hardware.brake_model.eigen.boundary import stability_boundary
from sim_hardware.brake_model.eigen.tracking import track
from sim_hardware.brake_model.foreign.matrix_model import DENSE_UP_TO, MatrixModel
from sim_hardware.brake_model.foreign.reduction import Reduction, reduce_model

BAND = (1000.0, 2500.0)
LARGE = MatrixModel("disc", disc_brake(3, 30), {"mu": 0.4, "k": 0.05, "p": 0.0})


@cache
def reduced() -> Reduction:
    return reduce_model(LARGE, BAND, [{"mu": 0.0}, {"mu": 0.4}, {"mu": 0.8}])


def test_small_model_stands_for_the_large_one() -> None:
    assert len(LARGE.freedoms) == 360 > DENSE_UP_TO
    reduction = reduced()
    small = reduction.model
    assert len(small.freedoms) < 90
    assert reduction.largest_error < 1e-5
    assert [check.basis_point for check in reduction.checks] == [True, True, True, False, False]
    assert all(check.same_unstable and check.pairs > 3 for check in reduction.checks)
    np.testing.assert_allclose(small.matrices().mass, np.eye(len(small.freedoms)), atol=1e-9)
    # elsewhere, and with another quantity changed
    for values in ({"mu": 0.63}, {"mu": 0.4, "pressure": 10.0}, {"mu": 0.5, "part.K_mu": 1.2}):
        large, own = (eigen_pairs_of(model, values, BAND) for model in (LARGE, small))
        np.testing.assert_allclose(own.eigenvalues, large.eigenvalues, rtol=1e-4)


def test_studies_take_the_small_model() -> None:
    small = reduced().model
    boundary = stability_boundary(small, "mu", 0.0, 0.8)
    assert boundary.point is not None
    at_boundary = eigen_pairs_of(LARGE, {"mu": boundary.point.value}, BAND)
    nearest = np.abs(at_boundary.frequencies_hz - boundary.point.frequency_hz).argmin()
    assert abs(at_boundary.eigenvalues[nearest].real) < 1e-4 * abs(at_boundary.eigenvalues[nearest])
    locus = track(small, "mu", np.linspace(0.4, 0.8, 3))
    assert locus.onset is not None
    assert locus.onset.value == pytest.approx(boundary.point.value, rel=1e-5)


def test_reductions_that_are_none_are_refused() -> None:
    with pytest.raises(ValueError, match="working point"):
        reduce_model(LARGE, BAND, [])
    with pytest.raises(ValueError, match="no eigenvalues"):
        reduce_model(LARGE, (1.0, 2.0), [{}])
    tiny = MatrixModel("tiny", {"M": np.eye(3), "K": np.diag([1e6, 2e6, 3e6])})
    with pytest.raises(ValueError, match="small already"):
        reduce_model(tiny, (10.0, 1000.0), [{}])
    with pytest.raises(KeyError, match="nu"):
        reduce_model(LARGE, BAND, [{"nu": 1.0}])
