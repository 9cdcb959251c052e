"""`rigctl compare`: pairs, tolerances, and everything that must not pass as agreement."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from campaign_files import Case, numbered, write_campaign
from typer.testing import CliRunner

from rigctl.analysis.campaign_table import CampaignTable, read_campaign
from rigctl.analysis.compare import Tolerance, Tolerances, compare, quantities, read_tolerances
from rigctl.app.cli import app
from rigctl.core.errors import ConfigError, RecordingError

SHIPPED = Path(__file__).parents[3] / "configs" / "tolerances" / "same_program.toml"
TONE = ((2350.0, 90.0, 0.8, 2.2),)
CASES = numbered([Case(0, pressure_bar=6.0), Case(0, pressure_bar=20.0, tones=TONE), Case(0, mu=0.4)])


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Two campaigns; in the second the torque of the third braking is 15 % higher."""
    parent = tmp_path_factory.mktemp("campaigns")
    changed = [*CASES[:2], replace(CASES[2], mu=0.46)]
    return write_campaign(parent / "a", CASES), write_campaign(parent / "b", changed)


@pytest.fixture
def tables(folders: tuple[Path, Path]) -> tuple[CampaignTable, CampaignTable]:
    a, b = (read_campaign(folder) for folder in folders)
    return a, b


def tolerances(**quantities: tuple[float, float]) -> Tolerances:
    return Tolerances(
        quantities={
            name: Tolerance(absolute=absolute, relative=relative)
            for name, (absolute, relative) in quantities.items()
        }
    )


def test_a_campaign_agrees_with_itself(tables: tuple[CampaignTable, CampaignTable]) -> None:
    found = compare(tables[0], tables[0], tolerances(**{name: (0.0, 0.0) for name in quantities()}))
    assert found.agree and found.pairs == 3
    mu = next(entry for entry in found.quantities if entry.name == "mean_mu")
    assert (mu.pairs, mu.worst, mu.outside) == (3, 0.0, ())
    squeal = next(entry for entry in found.quantities if entry.name == "squeal_frequency_hz")
    assert squeal.pairs == 1 and squeal.mean_a == pytest.approx(2350.0, abs=2.0)


def test_the_braking_outside_is_named(tables: tuple[CampaignTable, CampaignTable]) -> None:
    found = compare(*tables, tolerances(mean_mu=(0.02, 0.0), pressure_mean_bar=(0.01, 0.0)))
    mu, pressure = found.quantities
    assert not found.agree
    assert (mu.outside, mu.worst_index) == ((3,), 3)
    assert mu.worst == pytest.approx(0.06, abs=0.002) and mu.allowed == 0.02
    assert mu.mean_b - mu.mean_a == pytest.approx(0.06 / 3, abs=0.001)
    assert pressure.outside == ()
    assert compare(*tables, tolerances(mean_mu=(0.0, 0.16))).agree  # 0.16 * 0.4 = 0.064


def test_means_have_a_tolerance_of_their_own(tables: tuple[CampaignTable, CampaignTable]) -> None:
    for mean, agree in ((0.025, True), (0.015, False)):  # one of three differs by 0.06
        limits = Tolerances(quantities={"mean_mu": Tolerance(absolute=0.07, mean=mean)})
        found = compare(*tables, limits)
        assert found.agree is agree and found.quantities[0].outside == ()


def test_relative_tolerances_are_shares_of_the_reference(
    tables: tuple[CampaignTable, CampaignTable],
) -> None:
    limits = tolerances(mean_mu=(0.0, 0.14))
    assert not compare(tables[0], tables[1], limits).agree  # 0.06 of 0.40
    assert compare(tables[1], tables[0], limits).agree  # 0.06 of 0.46


def test_what_is_missing_does_not_agree(tables: tuple[CampaignTable, CampaignTable]) -> None:
    a = tables[0]
    without = CampaignTable(a.brakings[:2], a.events, ())
    limits = tolerances(pressure_mean_bar=(1.0, 0.0))
    found = compare(a, without, limits)
    assert not found.agree and (found.pairs, found.only_a, found.only_b) == (2, (3,), ())
    assert compare(without, a, limits).only_b == (3,)
    incomplete = CampaignTable((*a.brakings[:2], replace(a.brakings[2], status="incomplete")), a.events, ())
    assert compare(a, incomplete, limits).only_a == (3,)
    excluded = CampaignTable((*a.brakings[:2], replace(a.brakings[2], excluded="hit")), a.events, ())
    assert compare(a, excluded, limits).only_a == (3,)
    nothing = CampaignTable((), (), ())
    assert not compare(nothing, nothing, limits).agree


def test_a_value_in_one_campaign_only_does_not_agree(tables: tuple[CampaignTable, CampaignTable]) -> None:
    a = tables[0]
    without_mu = CampaignTable((replace(a.brakings[0], mean_mu=None), *a.brakings[1:]), a.events, ())
    found = compare(a, without_mu, tolerances(mean_mu=(1.0, 0.0)))
    assert not found.agree and found.quantities[0].outside == (1,)
    none = CampaignTable(tuple(replace(row, mean_mu=None) for row in a.brakings), a.events, ())
    assert compare(a, none, tolerances(mean_mu=(1.0, 0.0))).quantities[0].outside == (1, 2, 3)


def test_squeal_in_one_campaign_only(tables: tuple[CampaignTable, CampaignTable]) -> None:
    a = tables[0]
    silent = replace(a.brakings[1], squeals=0, squeal_frequency_hz=None, squeal_level_db=None)
    other = CampaignTable((a.brakings[0], silent, a.brakings[2]), (), ())
    limits = tolerances(squeal_frequency_hz=(1.0, 0.0))
    found = compare(a, other, limits)
    assert found.squeal_differs == (2,) and not found.agree
    assert compare(a, other, limits.model_copy(update={"squeal_may_differ": 1})).agree


def test_other_programs_are_refused(tables: tuple[CampaignTable, CampaignTable]) -> None:
    a = tables[0]
    other = CampaignTable((replace(a.brakings[0], set_pressure_bar=7.0), *a.brakings[1:]), a.events, ())
    with pytest.raises(RecordingError, match=r"braking 1.*set_pressure_bar = 7\.0.*6\.0"):
        compare(a, other, tolerances(mean_mu=(1.0, 0.0)))


@pytest.mark.parametrize("path", sorted(SHIPPED.parent.glob("*.toml")), ids=lambda path: path.stem)
def test_shipped_tolerances_are_read(path: Path) -> None:
    names = read_tolerances(path).quantities
    assert {"pressure_mean_bar", "speed_mean_rpm", "torque_mean_nm", "mean_mu"} < names.keys()
    assert {"squeal_frequency_hz", "squeal_level_db"} < names.keys()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[quantities]\nmu = { absolute = 1 }", ("'mu' is no result", "mean_mu")),
        ("[quantities]\nmean_mu = { absolute = -1 }", ("quantities.mean_mu.absolute",)),
        ("squeal_may_differ = 0", ("quantities",)),
    ],
)
def test_wrong_files_are_told(tmp_path: Path, text: str, words: tuple[str, ...]) -> None:
    path = tmp_path / "tolerances.toml"
    path.write_text(text)
    with pytest.raises(ConfigError) as caught:
        read_tolerances(path)
    for word in ("tolerances.toml", *words):
        assert word in str(caught.value)


def test_command_line(folders: tuple[Path, Path]) -> None:
    a, b = map(str, folders)
    runner = CliRunner()
    same = runner.invoke(app, ["compare", a, a, "--tolerances", str(SHIPPED)])
    assert same.exit_code == 0, same.output
    assert "3 pairs" in same.output and "The campaigns agree" in same.output
    other = runner.invoke(app, ["compare", a, b, "--tolerances", str(SHIPPED)])
    assert other.exit_code == 1
    assert "outside: braking 3" in other.output and "do NOT agree" in other.output
    told = runner.invoke(app, ["compare", a, b, "--tolerances", str(SHIPPED), "--json"])
    found = json.loads(told.output)
    assert told.exit_code == 1 and found["agree"] is False
    assert next(q for q in found["quantities"] if q["name"] == "mean_mu")["outside"] == [3]
