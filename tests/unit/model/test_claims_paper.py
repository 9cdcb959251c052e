"""The paper's claims of 4.3.3 and 4.3.4: verdicts and numbers on our brake, on scattered brakes, without
groups.
"""

from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model import sensitivity as family
from rigctl.model.claims import CLAIMS, claims_study, evaluate, scattered_brakes, scattered_verdicts
from rigctl.model.loading import read_model
from sim_hardware.brake_model.foreign.matrix_model import MatrixModel
from sim_hardware.brake_model.parametric import LinearBrake

FILE = Path(__file__).parents[3] / "configs" / "brakes" / "model.toml"
MODEL = read_model(FILE)
assert isinstance(MODEL, LinearBrake)

EXPECTED = {
    "pairs": "holds",
    "friction": "holds in part",
    "fig9": "holds",
    "asymmetry_strong": "holds",
    "pad": "holds",
    "backplate": "holds",
    "damping_harms": "holds",
    "abutments": "holds",
    "asymmetry_squeals": "holds",
    "narrow_band": "holds",
    "mode_coupling": "holds",
    "broad_band": "does not hold",
    "monodirectional": "holds",
    "piston_distance": "holds",
    "quieter_below_5_khz": "holds",
    "near_contact": "holds",
    "damping": "holds",
    "inertia": "holds",
    "distance": "holds",
    "not_destabilised": "holds in part",
}


@pytest.fixture(scope="module")
def claims():
    return {claim.key: claim for claim in evaluate(MODEL)}


def test_every_claim_has_the_verdict_we_publish(claims) -> None:
    assert {key: claim.verdict for key, claim in claims.items()} == EXPECTED
    assert tuple(claims) == tuple(CLAIMS)
    assert all(claim.text and claim.measure and claim.numbers for claim in claims.values())


def test_numbers_of_the_identification_study(claims) -> None:
    numbers = claims["friction"].numbers
    assert numbers["maximum_below_5_khz_1_s"] == pytest.approx(0.440, abs=0.001)
    assert claims["asymmetry_squeals"].numbers["share_percent"] == 100.0
    assert claims["asymmetry_squeals"].numbers["share_of_these_percent"] == pytest.approx(100.0 * 18 / 21)
    assert claims["pad"].numbers["rank"] == 1 and claims["abutments"].numbers["rank"] == 10
    assert claims["damping"].numbers["largest_rise_percent"] < 0.01
    assert claims["distance"].numbers["piston_position_1_s"] == pytest.approx(-36.0, abs=0.1)
    assert claims["quieter_below_5_khz"].numbers["onset_further_apart_bar"] == pytest.approx(15.06, abs=0.01)
    assert claims["near_contact"].numbers["share_below_5_khz_percent"] == pytest.approx(40.0)


def test_basic_brake_gets_other_verdicts() -> None:
    """Uneven pad wear: the brake that friction destabilises; the claims are not true of any brake."""
    verdicts = {claim.key: claim.verdict for claim in evaluate(read_model(FILE.with_name("basic.toml")))}
    assert verdicts["not_destabilised"] == "does not hold" and verdicts["friction"] == "holds"
    assert sum(verdict != EXPECTED[key] for key, verdict in verdicts.items()) >= 5


def test_scatter_is_seeded_and_stays_in_its_bounds() -> None:
    first, again = (scattered_brakes(MODEL, 3, 0.1, 5) for _ in range(2))
    nominal = MODEL.brake.spec.parameters
    for a, b in zip(first, again, strict=True):
        for name, parameter in a.brake.spec.parameters.items():
            assert parameter.value == b.brake.spec.parameters[name].value
            assert abs(parameter.value / nominal[name].value - 1.0) <= 0.1


def test_claims_that_follow_from_mechanics_hold_on_scattered_brakes() -> None:
    verdicts = scattered_verdicts(MODEL, 4, 0.10, seed=3)
    for key in ("pairs", "pad", "backplate", "damping_harms"):
        assert set(verdicts[key]) == {"holds"}, key
    for key in ("damping", "inertia", "distance"):  # the sum at least: it is -1/2 tr(M^-1 D)
        assert "does not hold" not in verdicts[key], key


def test_claims_without_their_groups_cannot_be_tested() -> None:
    nominal, by_mu = MODEL.matrices({"mu": 0.0}), MODEL.derivative("mu")
    parts = {"M": nominal.mass, "D": nominal.damping, "K": nominal.stiffness, "K_mu": by_mu.stiffness}
    claims = {c.key: c for c in evaluate(MatrixModel("elsewhere", parts, {"mu": 0.4}))}
    assert claims["pad"].verdict == "cannot be tested"
    assert "no groups named contact_…" in claims["pad"].remark
    assert claims["pairs"].verdict == "holds"
    with pytest.raises(ValueError, match="brake files"):
        claims_study(MatrixModel("elsewhere", parts, {"mu": 0.4}), samples=1)


def test_command_prints_verdicts_and_writes_the_scatter(tmp_path: Path) -> None:
    app = typer.Typer()
    family.register(app)
    app.command("other")(lambda: None)
    result = CliRunner().invoke(
        app, ["claims", str(FILE), "--scatter", "2", "--out", str(tmp_path), "--format", "png,csv"],
        env={"COLUMNS": "250"},
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "does not hold: 1" in result.output
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "claims_measures.csv", "claims_scatter.png", "claims_verdicts.csv",
    ]  # fmt: skip
