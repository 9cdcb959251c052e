"""Bad programs, rigs, brakes, limits, options: one clear message, exit code 2, nothing started."""

import re
import sys
from pathlib import Path

import pytest

from rigctl.app import cli as command_line
from rigctl.core.errors import ConfigError

GOOD_PROGRAM = """
name = "p"
[[sequences]]
name = "s"
role = "check"
temperatures_degc = [100]
speed_profiles = [{ duration_s = 10.0, start_rpm = 40.0, end_rpm = 40.0 }]
pressures_bar = [10]
[sequences.recording]
channels = [{ name = "torque", decimation = 40 }]
"""


def call(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *arguments: object
) -> tuple[int, str]:
    """Run the command line in this process; returns exit code and everything it printed."""
    monkeypatch.setattr(sys, "argv", ["rigctl", *map(str, arguments)])
    with pytest.raises(SystemExit) as caught:
        command_line.main()
    printed = capsys.readouterr()
    code = caught.value.code
    return (0 if code is None else int(code)), printed.out + printed.err


@pytest.fixture
def rigctl(capsys, monkeypatch):
    return lambda *arguments: call(capsys, monkeypatch, *arguments)


def changed(text: str, pattern: str, replacement: str) -> str:
    result, hits = re.subn(pattern, replacement, text, flags=re.MULTILINE)
    assert hits, pattern
    return result


@pytest.mark.parametrize(
    ("pattern", "replacement", "expected"),
    [
        (r"pressures_bar = \[10\]", "pressures_bar = [45]", ["45", "bar", "40"]),
        (r"pressures_bar = \[10\]", "pressures_bar = [nan]", ["pressures_bar", "nan"]),
        (r"pressures_bar = \[10\]", "pressures_bar = []", ["pressures_bar"]),
        (r"pressures_bar = \[10\]", "pressures_bar = [-3]", ["pressures_bar", "-3"]),
        (r"pressures_bar = \[10\]", 'pressures_bar = ["10 bar"]', ["pressures_bar", "10 bar"]),
        (r"pressures_bar", "presures_bar", ["presures_bar", "Did you mean 'pressures_bar'"]),
        (r"duration_s = 10.0", "duration_s = 0.0", ["duration_s", "0"]),
        (r'name = "p"', 'name = "../../etc/passwd"', ["name", "passwd"]),
        (r'name = "torque"', 'name = "torqe"', ["torqe"]),
        (r"decimation = 40", "decimation = 7", ["decimation"]),
        (r"decimation = 40", "decimation = 0", ["decimation", "0"]),
        (r"start_rpm = 40.0, end_rpm = 40.0", "start_rpm = 5000.0, end_rpm = 5000.0", ["5000"]),
        (r"temperatures_degc = \[100\]", "temperatures_degc = [600]", ["600"]),
        (r"^\[\[sequences\]\]", "[[sequence]]", ["sequence"]),
        (r'^name = "s"', "name = ", ["not valid TOML"]),
    ],
)
def test_bad_program_is_refused(rigctl, configs: Path, tmp_path: Path, pattern, replacement, expected):
    path = tmp_path / "program.toml"
    path.write_text(changed(GOOD_PROGRAM, pattern, replacement))
    code, text = rigctl(
        "run", path, "--rig", configs / "rigs/simulated.toml", "--out", tmp_path / "data", "--name", "a"
    )
    assert code == 2, text
    for part in [str(path), *expected]:
        assert part in text
    assert "Traceback" not in text
    assert text.count("\n") <= 4
    assert not (tmp_path / "data").exists()


def test_good_program_passes_the_check(rigctl, configs: Path, tmp_path: Path):
    path = tmp_path / "program.toml"
    path.write_text(GOOD_PROGRAM)
    code, text = rigctl("check", path, "--rig", configs / "rigs/simulated.toml")
    assert code == 0, text
    assert "1 brakings in all" in text
    assert "Estimated duration" in text


@pytest.mark.parametrize(
    ("file", "pattern", "replacement", "expected"),
    [
        ("rigs/simulated.toml", r"^block_s = 0.05", "block_s = 5.0", ["block_s", "5.0", "at most 0.5"]),
        ("rigs/simulated.toml", r"^\[devices.drive\]\nkind", "[devices.drive]\nkid",
         ["devices.drive.kind", "missing"]),
        ("rigs/simulated.toml", r'drive\]\nkind = "simulated"', 'drive]\nkind = "simulatd"',
         ["simulatd", "Did you mean"]),
        ("rigs/simulated.toml", r'^brake = "../brakes/plant.toml"', 'brake = "../brakes/plnt.toml"',
         ["devices.acquisition.brake", "plnt.toml"]),
        ("rigs/simulated.toml", r"^\[friction\]", "[frction]", ["friction", "missing"]),
        ("limits/a_class.toml", r"^max_bar = .*", "max_bar = nan", ["pressure", "max_bar", "nan"]),
        ("limits/a_class.toml", r"^max_bar = .*\n", "", ["max_bar"]),
        ("limits/a_class.toml", r"^max_bar =", "max_bars =", ["max_bars"]),
        ("brakes/plant.toml", r'^m_disc = \{ value = [0-9.]+', "m_disc = { value = -1.0", ["m_disc", "-1"]),
        ("brakes/plant.toml", r'^m_disc = \{ value = [0-9.]+', "m_disc = { value = nan", ["m_disc", "nan"]),
        ("brakes/plant.toml", r'^(m_disc = .*)unit = "kg"', r'\1unit = "g"', ["m_disc"]),
        ("brakes/plant.toml", r"^m_disc = .*\n", "", ["m_disc"]),
        ("plants/a_class.toml", r"^ambient_degc = .*", "ambient_degc = inf", ["ambient_degc", "inf"]),
    ],
)  # fmt: skip
def test_bad_rig_limits_brake_and_plant_are_refused(
    rigctl, configs: Path, tmp_path: Path, file, pattern, replacement, expected
):
    """The whole configuration is copied, one line of it is spoilt."""
    for source in configs.rglob("*.toml"):
        target = tmp_path / "configs" / source.relative_to(configs)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(source.read_text())
    bad = tmp_path / "configs" / file
    bad.write_text(changed(bad.read_text(), pattern, replacement))
    code, text = rigctl(
        "run",
        tmp_path / "configs/programs/quick_check.toml",
        "--rig",
        tmp_path / "configs/rigs/simulated.toml",
        "--out",
        tmp_path / "data",
    )
    assert code == 2, text
    for part in expected:
        assert part in text
    assert Path(file).name in text
    assert "Traceback" not in text
    assert not (tmp_path / "data").exists()


def test_missing_coupling_in_a_brake_is_explained(rigctl, configs: Path, tmp_path: Path):
    text = (configs / "brakes/model.toml").read_text()
    blocks = re.split(r"(?m)^(?=\[\[couplings\]\])", text)
    path = tmp_path / "brake.toml"
    kept = [b for b in blocks if not (b.startswith("[[couplings]]") and 'name = "piston_l"' in b)]
    assert len(kept) == len(blocks) - 1
    path.write_text("".join(kept))
    code, printed = rigctl("stability", path)
    assert code == 2, printed
    assert "piston" in printed
    assert "Traceback" not in printed


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["run", "no/such/program.toml"], "no such file"),
        (["run", "configs"], "folder, not a file"),
        (["stability", "configs/brakes/modl.toml"], "Did you mean 'model.toml'?"),
        (["resume", "no/such/campaign"], "no such file"),
        (["report", "."], "campaign.toml"),
        (["stability", "configs/brakes/model.toml", "--k", "nan"], "--k"),
        (["stability", "configs/brakes/model.toml", "--max-bar", "-1"], "--max-bar"),
        (["run", "configs/programs/quick_check.toml", "--seed", "-1"], "--seed"),
        (["run", "configs/programs/quick_check.toml", "--time", "fast"], "--time"),
        (["rum"], "rum"),
    ],
)
def test_bad_options_and_paths(rigctl, monkeypatch, configs: Path, arguments, expected):
    monkeypatch.chdir(configs.parent)
    code, text = rigctl(*arguments)
    assert code == 2, text
    assert expected in text
    assert "Traceback" not in text


@pytest.mark.parametrize("name", ["../evil", "a/b", ".hidden", "", "x" * 200, "a b\n"])
def test_path_tricks_in_the_name_of_a_campaign(rigctl, configs: Path, tmp_path: Path, name: str):
    code, text = rigctl(
        "run", configs / "programs/quick_check.toml", "--rig", configs / "rigs/simulated.toml",
        "--out", tmp_path / "data", "--name", name,
    )  # fmt: skip
    assert code == 2, text
    assert "Traceback" not in text
    assert not list(tmp_path.glob("**/*.toml"))


def test_errors_carry_their_place_and_remedy():
    error = ConfigError("is 45.", place="x.toml: pressure_bar", value=45, remedy="Give 40 or less.")
    assert str(error) == "x.toml: pressure_bar: is 45. Give 40 or less."
