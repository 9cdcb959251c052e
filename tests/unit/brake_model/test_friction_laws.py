"""Friction laws: values, slope at the working point, bounds, and the same law in the compiled kernel."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from sim_hardware.brake_model.friction import (
    ConstantFriction,
    FrictionLaw,
    LinearFriction,
    SaturatingFriction,
)
from sim_hardware.brake_model.time_domain.contact import deviation

speeds = st.floats(-3.0, 3.0)


def test_linear_law_is_equation_28() -> None:
    law = LinearFriction(mu_mean=0.4, k_s_m=0.0576)
    mu_0 = 0.4 + 0.0576 * 0.44
    assert law.mu(1.2, 0.44) == pytest.approx(mu_0 - 0.0576 * 1.2)
    assert law.mu(-1.2, 0.44) == pytest.approx(mu_0 - 0.0576 * 1.2)
    assert law.holding_mu(0.44) == pytest.approx(mu_0)
    assert ConstantFriction(mu_mean=0.4).mu(2.0, 0.44) == pytest.approx(0.4)


@given(mean=st.floats(0.05, 2.0), k=st.floats(0.0, 0.5), size=st.floats(0.001, 1.0), speed=speeds)
def test_saturating_law(mean: float, k: float, size: float, speed: float) -> None:
    law = SaturatingFriction(mu_mean=0.4, k_s_m=k, saturation_m_s=size)
    assert law.mu(mean, mean) == pytest.approx(0.4)
    step = 1e-4 * size
    slope = (law.mu(mean + step, mean) - law.mu(mean - step, mean)) / (2 * step)
    assert slope == pytest.approx(-k, rel=1e-6, abs=1e-9)
    assert abs(law.mu(speed, mean) - 0.4) <= k * size * (1 + 1e-12) + 1e-15  # rounding of 0.4
    assert np.sign(law.mu(speed, mean) - 0.4) in (0.0, np.sign(mean - abs(speed)))


@settings(deadline=None)  # the first call compiles
@given(speed=speeds, mean=st.floats(0.05, 2.0), normal=st.floats(-2000.0, 2000.0), size=st.floats(0.001, 1.0))
def test_kernel_uses_the_same_law(speed: float, mean: float, normal: float, size: float) -> None:
    """Friction force from the kernel: mu(|v|) N sgn(v), none where the pad lifts off."""
    law = SaturatingFriction(mu_mean=0.4, k_s_m=0.0576, saturation_m_s=size)
    slip_variation = mean - speed
    speed = mean - slip_variation
    g = deviation(slip_variation, normal, 1000.0, 0.4, mean, 0.0576, 1.0 / size, 0.37)
    total = max(1000.0 + normal, 0.0)
    force = float(law.mu(speed, mean)) * total * np.sign(speed)
    assert g + 0.4 * 1000.0 + 0.37 * normal == pytest.approx(force, abs=1e-9)


def test_laws_as_data() -> None:
    adapter: TypeAdapter[FrictionLaw] = TypeAdapter(FrictionLaw)
    assert isinstance(adapter.validate_python({"law": "constant", "mu_mean": 0.4}), ConstantFriction)
    for bad in (
        {"law": "linear", "mu_mean": 0.4, "k_s_m": -1.0},
        {"law": "saturating", "mu_mean": 0.4, "k_s_m": 0.1, "saturation_m_s": 0.0},
        {"law": "linear", "mu_mean": float("nan"), "k_s_m": 0.1},
        {"law": "stribeck", "mu_mean": 0.4},
    ):
        with pytest.raises(ValidationError):
            adapter.validate_python(bad)
