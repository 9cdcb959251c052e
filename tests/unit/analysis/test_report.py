"""The report: complete, self-contained, and honest when there is little to report."""

import base64
import gc
import re
import threading
from dataclasses import replace
from html.parser import HTMLParser

import matplotlib as mpl
import numpy as np
import pytest
from campaign_files import Case

from rigctl.analysis import figures, report, style
from rigctl.analysis.campaign_table import read_campaign
from rigctl.analysis.prediction import Prediction
from rigctl.analysis.report import build_report, loudest_braking
from rigctl.analysis.spectrogram_figure import braking_spectrogram, power_pa2
from rigctl.analysis.style import Rendered, drawing
from rigctl.core.channels import ChannelData
from rigctl.core.errors import RecordingError
from rigctl.recording.braking_file import read_braking
from rigctl.signals.spectra import spectrogram

PREDICTION = Prediction(15.0, 2140.0, "model")
TONE = (2350.0, 80.0, 1.0, 2.3)
ALL_FIGURES = {
    "squeal_pressure_frequency",
    "squeal_pressure_temperature",
    "squeal_levels",
    "squeal_frequency_temperature",
    "spectrogram_loudest",
    "friction_pressure_temperature",
    "friction_number",
}


class Page(HTMLParser):
    """Collects what a page refers to, and checks that tags are closed."""

    VOID = frozenset({"meta", "img", "br", "link"})

    def __init__(self, text):
        super().__init__()
        self.sources, self.links, self.words, self.open = [], [], [], []
        self.feed(text)
        self.close()
        self.text = " ".join(" ".join(self.words).split())

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.sources += [values[k] for k in ("src",) if k in values]
        self.links += [values[k] for k in ("href",) if k in values]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


@pytest.fixture(scope="module", autouse=True)
def small_pictures():
    """A third of the resolution: fewer pixels to fill, everything else as in earnest."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(style, "PNG_DPI", 43)
        yield


@pytest.fixture
def unrendered(monkeypatch):
    """For tests of the page alone: figures are drawn, but not turned into pixels and paths."""
    monkeypatch.setattr(report, "render", lambda figure: Rendered(b"PNG", "<svg/>", 1.0))


@pytest.fixture(scope="module")
def table(matrix_campaign):
    return read_campaign(matrix_campaign)


@pytest.fixture(scope="module")
def built(matrix_campaign):
    info = {"Program": "squeal_matrix", "seed": "7", "note": "<script>alert(1)</script>"}
    result = build_report(matrix_campaign, prediction=PREDICTION, info=info)
    return result, result.path.read_text(encoding="utf-8")


def test_report_has_all_figures_and_tables(built):
    result, _ = built
    folder = result.path.parent
    assert {p.stem for p in folder.glob("*.png")} == {p.stem for p in folder.glob("*.svg")} == ALL_FIGURES
    assert all(p.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n" for p in folder.glob("*.png"))
    assert (folder / "events.csv").exists()
    assert (folder / "brakings.csv").exists()
    assert not list(folder.glob("*.part"))
    assert result.path.stat().st_size < 5_000_000


def test_report_is_self_contained(built):
    result, text = built
    page = Page(text)
    assert page.open == []
    assert len(page.sources) == len(ALL_FIGURES)
    for source in page.sources:
        kind, data = source.split(";base64,")
        assert kind in ("data:image/svg+xml", "data:image/png")
        assert base64.b64decode(data, validate=True)
    assert all((result.path.parent / link).exists() for link in page.links)
    assert not re.search(r"https?://|@import|<script|url\(", re.sub(r"base64,[\w+/=]+", "", text))


def test_report_says_what_was_found(built):
    result, text = built
    page = Page(text)
    for words in (
        "3 brakings squealed (50%)",
        "Squeal sets in at 12 bar",
        "watchdog: door open",
        "squeal_matrix",
        "threshold_db = 60.0",
        "Occurrence per threshold",
    ):
        assert words in page.text
    assert "<script>alert(1)</script>" in page.text  # shown, because escaped
    assert "&lt;script&gt;" in text
    assert "squeal_matrix · 2000-01-01" in page.text
    assert result.summary.n_squealing == 3
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text


def test_building_twice_gives_the_same_files_and_leaves_no_global_state(matrix_campaign, built):
    result, text = built
    settings = dict(mpl.rcParams)
    stop = threading.Event()
    other = threading.Thread(target=stop.wait)  # the second time in one process
    other.start()
    before = {p.name: p.read_bytes() for p in result.path.parent.iterdir()}
    try:
        build_report(
            matrix_campaign,
            prediction=PREDICTION,
            info={"Program": "squeal_matrix", "seed": "7", "note": "<script>alert(1)</script>"},
        )
    finally:
        stop.set()
        other.join()
    assert {p.name: p.read_bytes() for p in result.path.parent.iterdir()} == before
    assert text == result.path.read_text(encoding="utf-8")
    assert dict(mpl.rcParams) == settings
    assert gc.isenabled()


def test_no_squeal_is_said_and_old_figures_do_not_stay(campaign, unrendered):
    folder = campaign(Case(0, 6.0), Case(0, 20.0))
    (folder / "report").mkdir()
    (folder / "report" / "squeal_levels.png").write_bytes(b"from an earlier report")
    result = build_report(folder, prediction=PREDICTION, info={})
    page = Page(result.path.read_text(encoding="utf-8"))
    assert "No squeal was found (2 brakings with sound)" in page.text
    assert result.summary.onset_bar is None
    assert not (folder / "report" / "squeal_levels.png").exists()
    assert (folder / "report" / "squeal_pressure_frequency.png").exists()


def test_a_single_braking(campaign):
    result = build_report(campaign(Case(0, 20.0, tones=(TONE,))), prediction=PREDICTION, info={})
    assert (result.summary.n_complete, result.summary.n_squealing) == (1, 1)
    page = Page(result.path.read_text(encoding="utf-8"))
    assert "1 braking squealed (100%), with 1 event in all." in page.text
    assert len(page.sources) == len(ALL_FIGURES)


def test_no_complete_braking(campaign):
    folder = campaign(
        Case(0, status="incomplete", note="stopped"), Case(0, status="recovered", note="power cut")
    )
    result = build_report(folder, prediction=None, info={})
    page = Page(result.path.read_text(encoding="utf-8"))
    assert "There is nothing to evaluate: no complete braking." in page.text
    assert "power cut" in page.text
    assert page.sources == []


def test_no_braking_at_all(tmp_path):
    (tmp_path / "brakings").mkdir()
    result = build_report(tmp_path, prediction=PREDICTION, info={})
    assert "No braking has been recorded." in result.path.read_text(encoding="utf-8")
    assert result.sentences == ("No braking has been recorded.",)


def test_bedding_only(campaign, unrendered):
    result = build_report(campaign(Case(0, role="bedding", sound=False)), prediction=None, info={})
    assert "nothing can be said about squeal" in result.path.read_text(encoding="utf-8")
    assert (result.path.parent / "friction_number.png").exists()


def test_a_report_that_cannot_be_written_is_one_clear_error(campaign):
    folder = campaign(Case(0))
    (folder / "report").write_text("a file is in the way")
    with pytest.raises(RecordingError, match="report cannot be written"):
        build_report(folder, prediction=None, info={})


def test_loudest_braking(table, campaign):
    loudest = loudest_braking(table)
    assert loudest.squeal_level_db == max(e.level_db for e in table.squeals())
    silent = loudest_braking(read_campaign(campaign(Case(0), Case(0))))
    assert silent is not None
    assert silent.squeal_level_db is None


def test_every_squeal_is_a_dot_at_its_pressure_and_frequency_and_the_prediction_is_drawn(table):
    figure = figures.pressure_frequency(table, PREDICTION)
    top = figure.axes[0]
    dots = next(c for c in top.collections if len(c.get_offsets()) == 3 and hasattr(c, "get_sizes"))
    drawn = sorted(map(tuple, np.asarray(dots.get_offsets())))
    expected = sorted((e.pressure_bar, e.frequency_hz / 1000) for e in table.squeals())
    assert np.allclose(drawn, expected)
    markers = [line for line in top.lines if line.get_marker() == "D"]
    assert [(float(m.get_xdata()[0]), float(m.get_ydata()[0])) for m in markers] == [(15.0, 2.14)]
    without = figures.pressure_frequency(table, None)
    assert not [line for line in without.axes[0].lines if line.get_marker() == "D"]


def test_all_axes_are_labelled_with_units(table):
    made = [
        figures.pressure_frequency(table, PREDICTION),
        figures.pressure_temperature(table, PREDICTION),
        figures.friction_over_pressure_temperature(table),
        figures.level_distribution(table),
        figures.frequency_over_temperature(table),
    ]
    for figure in made:
        units = [a.get_xlabel() for a in figure.axes if a.get_xlabel()]
        assert units
        assert all("[" in text for text in units)


def _with_events(table, *changes):
    """The table with its squeals replaced by changed copies of the first one."""
    first = table.squeals()[0]
    return replace(table, events=tuple(replace(first, **change) for change in changes))


@pytest.mark.parametrize(
    ("events", "limits_khz"),
    [
        ([{"pressure_bar": 24.5}], (1.0, 4.0)),
        ([{"frequency_hz": 5600.0}], (1.0, 6.0)),
        ([{"frequency_hz": 1020.0}, {"frequency_hz": 15900.0, "pressure_bar": 31.9}], (0.0, 17.0)),
    ],
)
def test_the_axes_hold_every_dot_as_a_whole(table, events, limits_khz):
    figure = figures.pressure_frequency(_with_events(table, *events), PREDICTION)
    top = figure.axes[0]
    assert top.get_ylim() == limits_khz
    dots = next(c for c in top.collections if hasattr(c, "get_sizes") and len(c.get_offsets()) == len(events))
    centres = top.transData.transform(np.asarray(dots.get_offsets()))
    radius = np.sqrt(dots.get_sizes() / np.pi)[:, None] * figure.dpi / 72
    assert (centres - radius >= (top.bbox.x0, top.bbox.y0)).all()
    assert (centres + radius <= (top.bbox.x1, top.bbox.y1)).all()


def test_no_text_is_cut_off_at_the_edge_of_a_figure(table, matrix_campaign):
    loudest = loudest_braking(table)
    with drawing():
        made = [
            figures.pressure_frequency(table, PREDICTION),
            figures.pressure_temperature(table, PREDICTION),
            figures.friction_over_pressure_temperature(table),
            figures.friction_over_number(table),
            figures.level_distribution(table),
            figures.frequency_over_temperature(table),
            braking_spectrogram(matrix_campaign / "brakings" / loudest.file, loudest, table.events),
        ]
        for figure in made:
            box = figure.get_tightbbox()
            width, height = figure.get_size_inches()
            assert box.x0 >= 0, figure
            assert box.y0 >= 0, figure
            assert box.x1 <= width, figure
            assert box.y1 <= height, figure


def test_the_spectrogram_has_the_numbers_of_the_evaluation(table, matrix_campaign):
    sound = read_braking(matrix_campaign / "brakings" / loudest_braking(table).file).channels["microphone"]
    expected = spectrogram(
        sound.samples, sound.spec.rate_hz, fft_size=2048, hop=1024, scale=sound.spec.scale
    ).power
    found = power_pa2(sound)
    assert found.shape == expected.shape
    np.testing.assert_allclose(found, expected, rtol=1e-3, atol=1e-6 * expected.max())
    short = ChannelData(sound.spec, 0.0, sound.samples[:100])
    assert power_pa2(short).shape == (0, 1025)


def test_text_in_svg_is_text(built):
    result, _ = built
    svg = (result.path.parent / "squeal_pressure_frequency.svg").read_text(encoding="utf-8")
    assert "measured onset 12 bar" in svg
    assert "sans-serif" in svg
