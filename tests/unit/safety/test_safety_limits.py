"""The limits file: complete, finite, ordered, frozen, hashed."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import pytest
from guard_loop import LIMITS_FILE, loaded_limits, raw_limits

from rigctl.core.errors import ConfigError
from rigctl.safety.causes import CAUSES
from rigctl.safety.limits import Fingerprint, load_limits, parse_limits


def change(path: str, value: Any) -> dict[str, Any]:
    raw = raw_limits()
    table = raw
    *tables, key = path.split(".")
    for name in tables:
        table = table[name]
    table[key] = value
    return raw


def drop(path: str) -> dict[str, Any]:
    raw = raw_limits()
    table = raw
    *tables, key = path.split(".")
    for name in tables:
        table = table[name]
    del table[key]
    return raw


def all_numbers() -> list[str]:
    paths: list[str] = []

    def walk(table: dict[str, Any], prefix: str) -> None:
        for key, value in table.items():
            if isinstance(value, dict):
                walk(value, f"{prefix}{key}.")
            elif prefix:
                paths.append(prefix + key)

    walk(raw_limits(), "")
    return [path for path in paths if not path.startswith("stop_category")]


def test_the_shipped_file_is_read_and_covers_every_cause() -> None:
    loaded = loaded_limits()
    assert loaded.limits.pressure.max_bar == 41.0
    assert loaded.limits.power.max_kw == pytest.approx(84.0 * 1.05)
    assert loaded.limits.disc_temperature.max_degc == 500.0
    assert set(loaded.limits.stop_category) == set(CAUSES)
    assert len(loaded.hash8) == 8 and loaded.sha256.startswith(loaded.hash8)


@pytest.mark.parametrize("path", all_numbers())
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, True, "7", [1.0], 1e9, -1e9])
def test_every_number_refuses_what_is_no_sensible_number(path: str, bad: Any) -> None:
    with pytest.raises(ConfigError) as caught:
        parse_limits(change(path, bad), "x.toml")
    text = str(caught.value)
    assert text.startswith(f"x.toml: {path}: {bad!r}: is ")
    assert "Give a" in text


@pytest.mark.parametrize("path", all_numbers())
def test_every_number_must_be_there(path: str) -> None:
    with pytest.raises(ConfigError, match=r"is missing\. Every limit must be given"):
        parse_limits(drop(path), "x.toml")


@pytest.mark.parametrize("path", ["pressure.max_baar", "extra", "time.virtual.tick_s", "stop_category.tired"])
def test_an_unknown_key_is_refused(path: str) -> None:
    with pytest.raises(ConfigError, match=rf"x\.toml: {path}: 1: is an unknown key\. Known: "):
        parse_limits(change(path, 1), "x.toml")


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("pressure.peak_bar", 40.5, "is not below pressure.peak_bar"),
        ("pressure.peak_bar", 41.0, "is not below pressure.peak_bar"),
        ("setpoints.max_pressure_bar", 45.0, "is not below pressure.max_bar"),
        ("setpoints.max_speed_rpm", 900.0, "is not below speed.max_rpm"),
        ("power.peak_kw", 80.0, "is not below power.peak_kw"),
        ("disc_temperature.approach_from_degc", 600.0, "is not below disc_temperature.max_degc"),
        ("rest.speed_rpm", 6.0, "is not below reset.speed_rpm"),
        ("rest.pressure_bar", 2.0, "is not below reset.pressure_bar"),
        ("sanity.invalid_readings", 3, "is not below pressure.peak_readings"),
        ("time.real.heartbeat_s", 0.2, "is not below time.real_without_priority.heartbeat_s"),
        ("time.virtual.heartbeat_s", 0.1, "is not below time.virtual.heartbeat_s"),
    ],
)
def test_limits_in_the_wrong_order_are_refused(path: str, value: float, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        parse_limits(change(path, value), "x.toml")


@pytest.mark.parametrize("bad", [1, -1, True, 0.0, "0"])
def test_a_stop_category_that_is_not_built_is_refused(bad: Any) -> None:
    with pytest.raises(ConfigError, match=r"stop_category\.estop: .*is not supported"):
        parse_limits(change("stop_category.estop", bad), "x.toml")


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("schema", 2, "schema: 2: is not known"),
        ("schema", True, "schema: True: is not known"),
        ("name", "", "name: '': is not a name"),
        ("name", 3, "name: 3: is not a name"),
        ("name", "a\nb", "is not a name"),
        ("pressure", 5, r"pressure: 5: is not a table"),
        ("time", [], r"time: \[\]: is not a table"),
        ("time.real", 1.0, r"time\.real: 1\.0: is not a table"),
    ],
)
def test_other_faults_are_named(path: str, value: Any, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        parse_limits(change(path, value), "x.toml")


def test_files_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"none\.toml: cannot be read: No such file"):
        load_limits(tmp_path / "none.toml")
    (tmp_path / "bad.toml").write_text("a = = 1")
    with pytest.raises(ConfigError, match=r"bad\.toml: is not valid TOML"):
        load_limits(tmp_path / "bad.toml")
    (tmp_path / "latin.toml").write_bytes(b'name = "\xff"')
    with pytest.raises(ConfigError, match=r"latin\.toml: is not valid TOML"):
        load_limits(tmp_path / "latin.toml")


def test_the_hash_follows_the_content_and_not_the_comments(tmp_path: Path) -> None:
    text = LIMITS_FILE.read_text(encoding="utf-8")
    same, other = tmp_path / "same.toml", tmp_path / "other.toml"
    same.write_text("# a comment\n" + text, encoding="utf-8")
    other.write_text(text.replace("max_bar = 41.0", "max_bar = 41.5"), encoding="utf-8")
    assert load_limits(same).sha256 == loaded_limits().sha256
    assert load_limits(other).sha256 != loaded_limits().sha256


def test_a_file_edited_after_loading_is_noticed(tmp_path: Path) -> None:
    path = tmp_path / "limits.toml"
    path.write_bytes(LIMITS_FILE.read_bytes())
    loaded = load_limits(path)
    assert loaded.file_unchanged()
    path.write_bytes(LIMITS_FILE.read_bytes() + b"\n")
    assert not loaded.file_unchanged()
    path.unlink()
    assert not loaded.file_unchanged()


def test_limits_are_frozen_through_and_through() -> None:
    limits = loaded_limits().limits
    for part in (limits, limits.pressure, limits.time, limits.time.virtual):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(part, dataclasses.fields(part)[0].name, 1.0)
    with pytest.raises(TypeError):
        limits.stop_category["estop"] = 1  # type: ignore[index]


@pytest.mark.parametrize("path", all_numbers())
def test_the_fingerprint_covers_every_number(path: str) -> None:
    limits = loaded_limits().limits
    fingerprint = Fingerprint(limits)
    assert fingerprint.intact()
    part: Any = limits
    *tables, key = path.split(".")
    for name in tables:
        part = getattr(part, name)
    object.__setattr__(part, key, getattr(part, key) + 1)
    assert not fingerprint.intact()
