"""Errors of configuration files name file, key, value and remedy."""

from pathlib import Path
from typing import Annotated

import pytest
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, field_validator
from pydantic_core import PydanticCustomError

from rigctl.config.loading import load_model, read_toml, translated
from rigctl.config.rig import RigConfig
from rigctl.core.errors import ConfigError


class Inner(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)
    pressure_bar: Annotated[float, Field(gt=0, le=40)]


class Outer(BaseModel):
    model_config = ConfigDict(extra="forbid")
    name: str
    parts: list[Inner] = []


def _error(tmp_path: Path, text: str) -> str:
    path = tmp_path / "rig.toml"
    path.write_text(text)
    with pytest.raises(ConfigError) as caught:
        load_model(path, Outer)
    message = str(caught.value)
    assert message.startswith(str(path))
    return message


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('nme = "x"', ["nme", "unknown key", "Did you mean 'name'?"]),
        ('nme = "x"', ["name: missing", "Add this key."]),
        ('name = "x"\nzzz = 1', ["zzz", "unknown key", "Known keys here: name, parts."]),
        ('name = "x"\n[[parts]]\npressure_bar = 45', ["parts[0].pressure_bar = 45", "at most 40"]),
        ('name = "x"\n[[parts]]\npressure_bar = nan', ["parts[0].pressure_bar = nan", "finite"]),
        (
            'name = "x"\n[[parts]]\npressure_bar = "3 bar"',
            ["parts[0].pressure_bar = '3 bar'", "Give a number"],
        ),
        ('name = "x"\n[[parts]]\npresure_bar = 3', ["parts[0].presure_bar", "Did you mean 'pressure_bar'?"]),
        ("name = = 1", ["not valid TOML", "line 1"]),
    ],
)
def test_fault_is_named_with_key_value_and_remedy(tmp_path: Path, text: str, expected: list[str]):
    message = _error(tmp_path, text)
    for part in expected:
        assert part in message


def test_missing_file_names_the_nearest(tmp_path: Path):
    (tmp_path / "simulated.toml").write_text("")
    with pytest.raises(ConfigError, match=r"no such file.*Did you mean 'simulated.toml'\?"):
        read_toml(tmp_path / "simulatd.toml")
    with pytest.raises(ConfigError, match="There is no folder"):
        read_toml(tmp_path / "nowhere" / "x.toml")
    with pytest.raises(ConfigError, match="folder, not a file"):
        read_toml(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match="UTF-8"):
        read_toml(tmp_path / "binary.toml")


def test_own_errors_bring_their_remedy(tmp_path: Path):
    class Own(BaseModel):
        value: float

        @field_validator("value")
        @classmethod
        def _check(cls, value: float) -> float:
            raise PydanticCustomError(
                "own", "{value} is odd", {"value": value, "remedy": "Take an even one."}
            )

    expected = r"x\.toml: value = 3\.0: 3\.0 is odd\. Take an even one\."
    with pytest.raises(ConfigError, match=expected), translated(tmp_path / "x.toml"):
        TypeAdapter(Own).validate_python({"value": 3.0})


def test_long_lists_of_faults_are_cut(tmp_path: Path):
    text = 'name = "x"\n' + "[[parts]]\npressure_bar = -1\n" * 30
    message = _error(tmp_path, text)
    assert message.count("\n") == 12
    assert "18 more faults" in message


def test_every_shipped_rig_loads(configs: Path):
    rigs = sorted((configs / "rigs").glob("*.toml"))
    assert rigs
    for path in rigs:
        assert load_model(path, RigConfig).name
