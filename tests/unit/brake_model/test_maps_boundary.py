"""Maps over two quantities: what they count, and their boundary lines."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.eigen.boundary import stability_boundary
from sim_hardware.brake_model.eigen.contours import crossed_edges, linked
from sim_hardware.brake_model.eigen.maps import eigenvalue_map
from sim_hardware.brake_model.parametric import LinearBrake

BRAKES = {name: LinearBrake(load_brake(Path(__file__).parents[3] / f"configs/brakes/{name}.toml")) for name in
          ("basic", "model", "plant")}  # fmt: skip


def leading(model: LinearBrake, values: dict[str, float]) -> complex:
    at = np.linalg.eigvals(model.matrices(values).state_matrix())
    return complex(at[at.real.argmax()])


def test_growth_frequency_and_number_of_unstable_pairs() -> None:
    model = BRAKES["plant"]
    xs, ys = np.linspace(0.0, 2.0, 21), np.linspace(0.0, 30.0, 16)
    found = eigenvalue_map(model, ("mu", xs), ("pressure", ys))
    assert found.method == "secular"
    assert found.eigenvalues.shape == (16, 21, 28)
    for row, column in ((0, 0), (5, 3), (15, 20), (9, 11)):
        at = {"mu": xs[column], "pressure": ys[row]}
        values = np.linalg.eigvals(model.matrices(at).state_matrix())
        assert found.growth_rate_1_s[row, column] == pytest.approx(values.real.max(), rel=1e-8)
        assert found.frequency_hz[row, column] == pytest.approx(
            abs(leading(model, at).imag) / (2 * np.pi), rel=1e-9
        )
        assert found.unstable_pairs[row, column] == np.sum((values.real > 0) & (values.imag >= 0))
    assert found.unstable_pairs.max() >= 2
    assert 0.0 < found.unstable_share < 1.0
    np.testing.assert_array_equal(found.unstable, found.growth_rate_1_s > 0.0)


@pytest.mark.parametrize(
    ("brake", "x", "y", "method"),
    [
        ("model", ("mu", (0.0, 1.0)), ("pressure", (0.0, 30.0)), None),
        ("model", ("mu", (0.0, 1.0)), ("pressure", (0.0, 30.0)), "lapack"),
        ("basic", ("mu", (1.5, 0.0)), ("c_con_it", (1.0e8, 1.8e8)), None),
        ("plant", ("piston_stiffness", (-0.3, 0.3)), ("pressure", (0.0, 30.0)), None),
    ],
)
def test_points_of_the_boundary_lie_on_the_axis_with_their_frequency(brake: str, x, y, method) -> None:
    model = BRAKES[brake]
    found = eigenvalue_map(
        model, (x[0], np.linspace(*x[1], 14)), (y[0], np.linspace(*y[1], 11)), method=method
    )  # fmt: skip
    assert found.boundary
    checked = 0
    for line in found.boundary:
        for a, b, frequency in zip(line.x, line.y, line.frequency_hz, strict=True):
            at = found.x.values(model, a, found.y.values(model, b))
            value = leading(model, at)
            assert abs(value.real) < 1e-6
            assert abs(value.imag) / (2.0 * np.pi) == pytest.approx(frequency, rel=1e-9)
            checked += 1
    assert checked > 10


def test_the_boundary_goes_through_the_single_boundaries() -> None:
    model = BRAKES["model"]
    xs = np.linspace(0.0, 1.0, 9)
    found = eigenvalue_map(model, ("mu", xs), ("pressure", np.linspace(0.0, 30.0, 31)))
    (line,) = found.boundary
    assert not line.closed
    for mu in xs:
        single = stability_boundary(model, "pressure", 0.0, 30.0, {"mu": float(mu)}).point
        assert single is not None
        nearest = np.abs(line.x - mu) < 1e-12
        assert np.any(np.abs(line.y[nearest] - single.value) < 1e-9 * single.value)


def test_small_and_constant_maps() -> None:
    model = BRAKES["basic"]
    one = eigenvalue_map(model, ("mu", [0.7]), ("pressure", [3.0]))
    assert one.eigenvalues.shape == (1, 1, 28)
    assert one.unstable_share == 1.0
    assert one.boundary == ()
    row = eigenvalue_map(model, ("mu", np.linspace(0.0, 1.0, 30)), ("pressure", 3.0))
    (line,) = row.boundary
    assert line.x == pytest.approx([0.64], abs=1e-3)
    flat = eigenvalue_map(model, ("mu", np.linspace(0.0, 1.0, 20)), ("pressure", np.linspace(0.0, 30.0, 9)))
    (line,) = flat.boundary  # slope 0: pressure has no influence
    np.testing.assert_allclose(line.x, line.x[0], rtol=1e-11)


def test_bad_input_is_refused() -> None:
    model = BRAKES["model"]
    with pytest.raises(ValueError, match="both axes"):
        eigenvalue_map(model, ("mu", [0.0, 1.0]), ("mu", [0.0, 1.0]))
    with pytest.raises(ValueError, match="rise or fall"):
        eigenvalue_map(model, ("mu", [0.0, 1.0, 0.5]), ("pressure", [0.0, 1.0]))
    with pytest.raises(ValueError, match="finite"):
        eigenvalue_map(model, ("mu", [0.0, np.nan]), ("pressure", [0.0, 1.0]))
    with pytest.raises(KeyError, match="did you mean"):
        eigenvalue_map(model, ("mu", [0.0, 1.0]), ("presure", [0.0, 1.0]))


def test_lines_around_an_island_and_at_saddles() -> None:
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, 9), np.linspace(-1.0, 1.0, 11))
    level = 0.5 - np.hypot(x, y)
    edges = crossed_edges(level > 0.0)
    ((chain, closed),) = linked(edges, level > 0.0, level)
    assert closed
    assert sorted(chain) == list(range(len(edges.row)))
    for lift, lines in ((0.3, 2), (-0.3, 2)):  # two regions that touch at a corner: joined or parted
        level = np.array([[1.0, -1.0], [-1.0, 1.0]]) + lift
        found = linked(crossed_edges(level > 0.0), level > 0.0, level)
        assert [len(chain) for chain, _ in found] == [2] * lines
