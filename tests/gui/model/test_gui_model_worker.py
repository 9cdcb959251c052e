"""What the model page's worker answers is what the studies and the command line say."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rigctl.analysis.campaign_table import BrakingRow, CampaignTable, EventRow
from rigctl.core.errors import ConfigError
from rigctl.gui.pages.model import studies, worker
from rigctl.gui.pages.model.data import MapAxis, Setting
from rigctl.gui.pages.model.words import advice_text, onset_text
from rigctl.model.advice import recommendation_study
from rigctl.model.loading import read_model
from rigctl.model.maps import boundary_study
from rigctl.model.modes import modes_study
from sim_hardware.brake_model.design.variations import all_variations
from sim_hardware.brake_model.eigen.boundary import growth_along

BRAKES = Path(__file__).resolve().parents[3] / "configs" / "brakes"
SETTING = Setting(mu=0.45, pressure=20.0, slope=0.05)
VALUES = {"mu": 0.45, "pressure": 20.0, "slope": 0.05}


@pytest.fixture(scope="module")
def facts():
    return worker.read(BRAKES / "model.toml")


@pytest.fixture(scope="module")
def model():
    return read_model(BRAKES / "model.toml")


@pytest.fixture(scope="module")
def ranked(facts):
    return studies.ranking(facts.file, Setting(0.4, 10.0, 0.0576), 0.1)


def test_the_file_is_read_with_its_groups_and_their_sides(facts, model):
    assert facts.operating == {name: model.quantities[name].value for name in ("mu", "pressure", "slope")}
    keys = [knob.key for knob in facts.knobs]
    assert len(keys) == len(set(keys))
    for group in model.groups:
        assert facts.knob(group.name).members == group.members
        if group.has_sides:
            assert facts.knob(f"{group.name}:trailing").members == group.trailing


def test_a_bad_file_names_place_and_remedy(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text((BRAKES / "model.toml").read_text().replace('"spring"', '"sprnig"', 1))
    with pytest.raises(ConfigError) as caught:
        worker.read(path)
    assert "bad.toml" in str(caught.value)
    assert caught.value.place != str(path)  # the key, too
    with pytest.raises(ConfigError):
        worker.read(tmp_path / "missing.toml")


def test_poles_and_shape_are_those_of_the_modes_study(facts, model):
    answer = worker.poles(facts.file, SETTING, None, None)
    study = modes_study(model, values=VALUES)
    listing = study.table("modes")
    assert [p.frequency_hz for p in answer.poles] == pytest.approx(listing.column("frequency"))
    assert [p.real_part_1_s for p in answer.poles] == pytest.approx(listing.column("real_part"))
    assert [100 * p.damping_ratio for p in answer.poles] == pytest.approx(listing.column("damping"))
    assert answer.shape.number == study.facts["mode"]  # the critical one
    assert answer.shape.dampers_1_s == pytest.approx(study.facts["damping_adds_1_s"])
    assert answer.shape.friction_1_s == pytest.approx(study.facts["friction_adds_1_s"])
    assert answer.selected.unstable


def test_a_mode_is_found_again_by_where_it_was(facts):
    before = worker.poles(facts.file, SETTING, None, None)
    chosen = before.poles[3]
    after = worker.poles(facts.file, replace(SETTING, mu=0.46), chosen.eigenvalue, None)
    assert after.shape.number == 4


def test_factors_are_the_variations_of_the_design_studies(facts, model):
    for way in all_variations(model, 0.1)[:12]:
        setting = replace(SETTING, factors=tuple(sorted(way.factors.items())))
        answer = worker.poles(facts.file, setting, None, None)
        listing = modes_study(model, values=way.values(model, VALUES)).table("modes")
        assert [p.real_part_1_s for p in answer.poles] == pytest.approx(listing.column("real_part"), rel=1e-7)


def test_a_factor_on_a_place_goes_on_top_of_a_changed_parameter(facts):
    name = "c_pis_n"
    both = replace(SETTING, factors=((name, 2.0), ("piston_l.stiffness_y", 1.5)))
    changed, values = worker.designed(facts.file, both)
    assert changed.quantities[name].value == pytest.approx(
        2.0 * worker.brake_of(facts.file).quantities[name].value
    )
    nominal = worker.brake_of(facts.file).quantities["piston_l.stiffness_y"].value
    assert values["piston_l.stiffness_y"] == pytest.approx(3.0 * nominal)


@pytest.mark.parametrize("name", ["model", "plant"])
def test_onset_is_the_command_lines_boundary(name):
    file = worker.read(BRAKES / f"{name}.toml").file
    found = worker.onsets(file, SETTING, None).own
    point = boundary_study(read_model(file.path), "pressure", (0.0, 60.0), {"mu": 0.45, "slope": 0.05}).facts
    assert found.value == pytest.approx(point["boundary"], rel=1e-9)
    assert found.frequency_hz == pytest.approx(point["boundary_frequency_hz"], rel=1e-9)


def test_onset_in_words_as_the_paper_has_it(facts):
    found = worker.onsets(facts.file, Setting(0.4, 0.0, 0.0576), None).own
    assert onset_text(found) == "Squeals from 15.0\u202fbar at 2140\u202fHz"
    assert "No squeal up to 60.0\u202fbar" in onset_text(
        worker.onsets(facts.file, Setting(0.4, 0.0, 0.001), None).own
    )


def test_without_falling_slope_the_onset_is_one_of_friction():
    file = worker.read(BRAKES / "basic.toml").file
    found = worker.onsets(file, Setting(0.4, 10.0, 0.0), None).own
    assert found.over == "mu"
    assert found.value == pytest.approx(0.64, abs=0.001)
    assert onset_text(found) == "Squeals from µ 0.640 at 2400\u202fHz, at any pressure"


def test_path_runs_through_the_poles_and_the_onset(facts):
    lines = worker.locus(facts.file, replace(SETTING, pressure=0.0), "pressure")
    onset = worker.onsets(facts.file, SETTING, None).own
    first = next(crossing for crossing in lines.crossings if crossing[2])
    assert first[:2] == pytest.approx((onset.value, onset.frequency_hz), rel=1e-6)
    row = int(np.flatnonzero(lines.values == 20.0)[0])
    poles = worker.poles(facts.file, SETTING, None, None).poles
    on_path = np.sort_complex(lines.eigenvalues[row])
    assert np.allclose(on_path, np.sort_complex([p.eigenvalue for p in poles]), rtol=1e-8)


def test_path_over_a_group_passes_the_present_poles_at_factor_one(facts):
    lines = worker.locus(facts.file, SETTING, facts.knob("piston_stiffness"))
    row = int(np.abs(lines.values - 1.0).argmin())
    assert lines.values[row] == pytest.approx(1.0)
    poles = worker.poles(facts.file, SETTING, None, None).poles
    assert np.allclose(
        np.sort_complex(lines.eigenvalues[row]), np.sort_complex([p.eigenvalue for p in poles]), rtol=1e-6
    )


def test_map_agrees_with_growth_and_onset(facts, model):
    x, y = (MapAxis("mu", 0.2, 0.6), None), (MapAxis("pressure", 0.0, 40.0), None)
    found = studies.stability_map(facts.file, SETTING, x, y, 21)
    column = growth_along(model, "pressure", found.y_values, {"mu": 0.4, "slope": 0.05})
    assert found.growth_1_s[:, 10] == pytest.approx(column, rel=1e-6, abs=1e-6)
    assert np.array_equal(np.isfinite(found.frequency_hz), found.growth_1_s > 0.0)
    onset = worker.onsets(facts.file, replace(SETTING, mu=0.4), None).own
    line_x, line_y, _ = found.boundary[0]
    nearest = int(np.abs(line_x - 0.4).argmin())
    assert line_y[nearest] == pytest.approx(onset.value, rel=1e-6)


def test_map_over_a_group_counts_in_factors(facts):
    knob = facts.knob("piston_stiffness")
    axis = MapAxis("piston_stiffness", 0.5, 2.0)
    setting = replace(SETTING, factors=tuple((member, 3.0) for member in sorted(knob.members)))
    found = studies.stability_map(
        facts.file, setting, (axis, knob), (MapAxis("pressure", 10.0, 30.0), None), 4
    )
    assert found.x_values == pytest.approx([0.5, 1.0, 1.5, 2.0])
    poles = worker.poles(facts.file, replace(SETTING, pressure=10.0), None, None).poles
    assert found.growth_1_s[0, 1] == pytest.approx(max(p.real_part_1_s for p in poles), rel=1e-6)


def test_two_equal_axes_are_refused(facts):
    axis = (MapAxis("mu", 0.2, 0.6), None)
    with pytest.raises(ConfigError, match="name two quantities"):
        studies.stability_map(facts.file, SETTING, axis, axis, 5)


def test_ranking_is_the_studys_in_order_numbers_and_words(ranked, model):
    found = ranked
    study = recommendation_study(model, ranked.setting.operating, step=0.1)
    table = study.table("ranking")
    assert [row.title for row in found.rows] == list(table.column("modification"))
    assert [row.verdict for row in found.rows] == list(table.column("verdict"))
    assert [row.gain_1_s for row in found.rows] == pytest.approx(list(table.column("gain")))
    assert [found.change_bar(row) for row in found.rows] == pytest.approx(list(table.column("onset_change")))
    said = list(study.table("in_words").column("modification"))
    assert [advice_text(row, found) for row in found.rows[: len(said)]] == said


def test_a_modification_as_sliders_is_the_modification(facts, ranked, model):
    ways = {way.title: way for way in all_variations(model, 0.1)}
    for row in ranked.rows:
        members = {}
        for key, factor in row.factors.items():
            for member in facts.knob(key).members:
                members[member] = members.get(member, 1.0) * factor
        assert members == pytest.approx(dict(ways[row.title].factors))


def test_measured_points_are_those_that_count(tmp_path):
    def braking(index, squeals, mu: float | None = 0.4, *, status="complete"):
        values: Any = dict.fromkeys(BrakingRow.__slots__)
        values |= {
            "index": index, "file": f"{index:05d}.h5", "status": status, "squeals": squeals, "mean_mu": mu,
            "pressure_mean_bar": 10.0, "sound_recorded": True, "evaluation_error": "",
        }  # fmt: skip
        return BrakingRow(**values)

    def event(braking, mu, *, harmonic=False):
        values: Any = dict.fromkeys(EventRow.__slots__)
        values |= {"braking": braking, "status": "complete", "frequency_hz": 2140.0, "level_db": 90.0}
        return EventRow(**(values | {"mu": mu, "pressure_bar": 20.0, "harmonic": harmonic}))

    table = CampaignTable(
        (braking(1, 1), braking(2, 0), braking(3, 1, status="incomplete"), braking(4, 0, None)),
        (event(1, 0.41), event(1, 0.41, harmonic=True), event(1, None), event(3, 0.5)),
        (),
    )
    points = studies.points_of(tmp_path, table)
    assert [(p.braking, p.mu, p.pressure_bar, p.frequency_hz) for p in points.squeals] == [
        (1, 0.41, 20.0, 2140.0)
    ]
    assert [p.braking for p in points.quiet] == [2]
    assert points.without_place == 2
    assert points.squeals[0].file == tmp_path / "brakings" / "00001.h5"


def test_ranking_is_written_as_the_command_line_writes_it(facts, ranked, tmp_path):
    path = studies.write_ranking(facts.file, Setting(0.4, 10.0, 0.0576), 0.1, tmp_path / "mine.csv")
    lines = path.read_text().splitlines()
    assert lines[0].startswith("modification,verdict,gain [1/s]")
    assert len(lines) == 1 + len(ranked.rows)
    with pytest.raises(ConfigError, match=r"\.csv"):
        studies.write_ranking(facts.file, SETTING, 0.1, tmp_path / "mine.doc")
