"""The identification finds the published numbers again from a disturbed brake."""

from pathlib import Path

import pytest

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.identify import identify, main, updated_text
from sim_hardware.brake_model.stability import onset_pressure

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"


def test_disturbed_model_finds_15_bar_and_2140_hz_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = load_brake(BRAKES / "model.toml")
    disturbed = {"c_fin_t": 0.9, "c_con_it": 1.08, "d_abu_t": 1.3, "d_fin_t": 1.3}
    values = {name: factor * model.spec.parameters[name].value for name, factor in disturbed.items()}
    start = model.with_parameters(**values)
    before = onset_pressure(start)
    assert before is not None
    assert abs(before.value - 15.0) > 0.5
    file = tmp_path / "start.toml"
    file.write_text(updated_text((BRAKES / "model.toml").read_text(), start, values, "disturbed"))
    out = tmp_path / "found.toml"
    arguments = [
        str(file),
        "--target",
        "onset_bar=15",
        "frequency_hz=2140",
        "--free",
        "c_fin_t,c_con_it,d_abu_t,d_fin_t",
    ]
    assert main([*arguments, "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "before: unstable" in printed
    assert "after:  unstable from pressure = 15 bar" in printed
    found = load_brake(out)
    after = onset_pressure(found)
    assert after is not None
    assert after.value == pytest.approx(15.0, abs=0.05)
    assert after.frequency_hz == pytest.approx(2140.0, abs=1.0)
    assert "onset_bar = 15" in found.spec.parameters["c_fin_t"].origin
    # what was not free has not moved
    assert found.spec.parameters["c_con_il"] == model.spec.parameters["c_con_il"]


def test_mode_coupling_target_of_the_basic_brake() -> None:
    basic = load_brake(BRAKES / "basic.toml")
    start = basic.with_parameters(c_con_it=1.04 * basic.spec.parameters["c_con_it"].value)
    result = identify(start, {"onset_mu": 0.64, "frequency_hz": 2400.0}, ["c_con_it", "c_con_ot", "c_fin_t"])
    assert result.after is not None
    assert result.after.value == pytest.approx(0.64, abs=0.005)
    assert result.after.frequency_hz == pytest.approx(2400.0, abs=5.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--target", "onset=15", "--free", "c_tie"], "unknown target 'onset'"),
        (["--target", "onset_bar=15", "onset_mu=0.6", "--free", "c_tie"], "exactly one"),
        (["--target", "onset_bar=15", "--free", "c_nothing"], "unknown parameter 'c_nothing'"),
        (["--target", "onset_bar=-15", "--free", "c_tie"], "positive"),
    ],
)
def test_nonsense_is_refused(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(BRAKES / "model.toml"), *arguments]) == 2
    assert message in capsys.readouterr().err


def test_targets_out_of_reach_are_not_called_met(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [
        str(BRAKES / "model.toml"),
        "--target",
        "onset_bar=5",
        "--free",
        "c_gui_y_l",
        "--band",
        "0.01",
    ]
    assert main(arguments) == 1
