"""The window in German: every text translated, nothing lost on the way, every page opens in it."""

import ast
import importlib.util
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QLocale, QSettings, QTranslator
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QGroupBox,
    QLabel,
    QLineEdit,
    QTabWidget,
    QWidget,
)

from rigctl.gui.application import TRANSLATIONS, install_language
from rigctl.gui.pages import PAGES
from rigctl.gui.pages.sequence.check_words import CHECKS, check_said
from rigctl.gui.pages.service.fault_words import fault_said
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.phases import SENTENCES, said
from rigctl.gui.rig.state import RigState, SafetyCause, Word
from rigctl.gui.window import MainWindow
from rigctl.safety.causes import CAUSES, Cause

ROOT = Path(__file__).resolve().parents[3]
GUI = ROOT / "rigctl" / "gui"
GERMAN = TRANSLATIONS / "rigctl_de.ts"
Message = tuple[str, str, str]  # context, source, comment
_ANYTHING = ("{0}: {1}.", "{0}: {1} (limit {2}).")


def tool(name: str) -> str:
    """Path of a program of PySide6; skips without it."""
    path = Path(sys.executable).parent / name
    if not path.exists():
        pytest.skip(f"{name} is not installed")
    return str(path)


def messages(ts: Path) -> dict[Message, ET.Element]:
    return {
        (
            context.findtext("name", ""),
            message.findtext("source", ""),
            message.findtext("comment", ""),
        ): message
        for context in ET.parse(ts).getroot().iter("context")
        for message in context.iter("message")
    }


def texts() -> dict[Message, str]:
    return {key: m.findtext("translation", "") for key, m in messages(GERMAN).items()}


# -- the files ----------------------------------------------------------------------------------------


def test_every_text_of_the_code_is_translated(tmp_path: Path):
    found = tmp_path / "found.ts"
    sources = sorted(str(path) for path in GUI.rglob("*.py"))
    subprocess.run(
        [tool("pyside6-lupdate"), "-silent", "-locations", "none", *sources, "-ts", str(found)],
        check=True, capture_output=True, cwd=ROOT,
    )  # fmt: skip
    known = messages(GERMAN)
    missing = sorted(set(messages(found)) - set(known))
    assert not missing, f"run make translations and translate: {missing}"
    for key, message in known.items():
        translation = message.find("translation")
        assert translation is not None
        assert translation.text, key
        assert translation.get("type") is None, key


def test_nothing_is_lost_in_translation():
    for key, german in texts().items():
        source = key[1]
        for what in (r"\{[^{}]*\}", r"</?\w+>", r"%\w"):
            assert Counter(re.findall(what, german)) == Counter(re.findall(what, source)), key
        assert len(re.findall(r"&\w", german)) == len(re.findall(r"&\w", source)), key
        assert german.count("\n") == source.count("\n"), key
        outside = [re.match(r"\s*", t)[0] + re.search(r"\s*$", t)[0] for t in (source, german)]  # type: ignore[index]
        assert outside[0] == outside[1], key
        assert "\ufffd" not in german
        assert not re.search(r"\d,\d", german), f"numbers keep the point: {key}"


def test_compiled_file_is_that_of_the_texts(qapp: QApplication, tmp_path: Path):
    made = tmp_path / "made.qm"
    subprocess.run(
        [tool("pyside6-lrelease"), "-silent", str(GERMAN), "-qm", str(made)], check=True, capture_output=True
    )
    kept, new = QTranslator(), QTranslator()
    assert kept.load("rigctl_de", str(TRANSLATIONS))
    assert new.load(str(made))
    for key, german in texts().items():
        context, source, comment = key
        assert new.translate(context, source, comment) == german, key
        assert kept.translate(context, source, comment) == german, f"run make translations: {key}"


def test_compiled_file_is_installed_with_the_package():
    spec = importlib.util.find_spec("rigctl.gui")
    assert spec is not None and spec.submodule_search_locations
    assert Path(spec.submodule_search_locations[0], "translations", "rigctl_de.qm").is_file()
    if (ROOT / ".git").exists():
        ignored = subprocess.run(
            ["git", "check-ignore", "-q", str(TRANSLATIONS / "rigctl_de.qm")], check=False, cwd=ROOT
        )
        assert ignored.returncode == 1  # hatch leaves out of the wheel what git ignores


# -- the window ---------------------------------------------------------------------------------------


@pytest.fixture
def german(qapp: QApplication) -> Iterator[None]:
    """The application speaks German; English again afterwards, for the other tests."""
    before = QLocale()
    translators = install_language(qapp, "de")
    assert translators
    yield
    for translator in translators:
        assert qapp.removeTranslator(translator)
        translator.deleteLater()
    QLocale.setDefault(before)
    assert qapp.translate("pages", "Manual") == "Manual"


def shown(widget: QWidget) -> Iterator[str]:
    """What is written on a widget and in it."""
    for part in (widget, *widget.findChildren(QWidget)):
        yield part.toolTip()
        if isinstance(part, QLineEdit):
            yield part.placeholderText()
        elif isinstance(part, QComboBox):
            yield from (part.itemText(i) for i in range(part.count()))
        elif isinstance(part, QLabel | QAbstractButton):
            yield part.text()
        elif isinstance(part, QGroupBox):
            yield part.title()
        elif isinstance(part, QTabWidget):
            yield from (part.tabText(i) for i in range(part.count()))


def bare(text: str) -> str:
    return text.replace("&", "")


def test_window_is_german_from_frame_to_pages(qtbot, theme, german: None, tmp_path: Path):
    settings = QSettings(str(tmp_path / "window.ini"), QSettings.Format.IniFormat)
    window = MainWindow(theme, settings, RigConnection(), tmp_path / "data", ROOT / "configs")
    qtbot.addWidget(window)
    window.show()
    qtbot.waitExposed(window)
    buttons = [window.findChild(QAbstractButton, f"nav-{entry.page_id}") for entry in PAGES]
    titles = [button.text() for button in buttons if isinstance(button, QAbstractButton)]
    assert titles == ["Manuell", "Sequenz", "Lauf", "Daten", "Modell", "Service"]
    assert "STOPP" in window.alarm_bar.stop.text() and "Not-Halt" in window.alarm_bar.stop.toolTip()
    assert window.state_bar.word.text() == "GETRENNT"
    tripped = RigState(
        Word.TRIPPED, "manual", simulated=True,
        cause=SafetyCause("The emergency stop is pressed.", "Release it at the rig; then reset."),
    )  # fmt: skip
    window.state_bar.show_state(tripped)
    assert window.state_bar.word.text() == "▲ AUSGELÖST"
    assert window.state_bar.kind.text() == "SIMULIERT"
    assert (
        window.state_bar.cause.text()
        == "▲ Der Not-Halt ist gedrückt. Am Prüfstand entriegeln; dann rücksetzen."
    )

    meanings: dict[str, set[str]] = defaultdict(set)
    for (_, source, _), translation in texts().items():
        meanings[bare(source)].add(bare(translation))
    english = {source for source, german in meanings.items() if source not in german}
    for entry in PAGES:
        window.navigate(entry.page_id)
        page = window.page(entry.page_id)
        assert page.isVisible()
        written = {bare(text) for text in shown(page) if text}
        assert written, entry.page_id
        assert not written & english, entry.page_id
    assert not {bare(text) for text in shown(window)} & english


# -- what comes from engine, watchdog and checks ---------------------------------------------------------


def sample(node: ast.expr) -> str | None:
    """An example of a text in the code: literal, or with a number in place of each value."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else None
    if isinstance(node, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else "60" for part in node.values)
    if isinstance(node, ast.IfExp):
        return sample(node.body)
    return None


def calls(folder: Path, name: str) -> Iterator[ast.Call]:
    for path in sorted(folder.glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call):
                called = (
                    node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
                )
                if called == name:
                    yield node


def phases() -> Iterator[str]:
    """Every phase that the engine names."""
    for path in sorted((ROOT / "rigctl" / "engine").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            targets = node.targets if isinstance(node, ast.Assign) else []
            if any(isinstance(target, ast.Attribute) and target.attr == "phase" for target in targets):
                assert isinstance(node, ast.Assign)
                options = [node.value]
                while any(isinstance(option, ast.IfExp) for option in options):
                    options = [
                        way
                        for o in options
                        for way in ((o.body, o.orelse) if isinstance(o, ast.IfExp) else (o,))
                    ]
                yield from (text for option in options if (text := sample(option)))
    yield from (
        text for call in calls(ROOT / "rigctl" / "engine", "_begin") if (text := sample(call.args[0]))
    )


def test_every_phase_of_the_engine_has_words(german: None):
    found = set(phases())
    assert {"releasing", "arming", "locked", "ready", "by hand", "heating to 60 °C"} <= found
    for phase in found:
        assert SENTENCES.template_of(phase) not in ("", *_ANYTHING), phase
        assert said(phase) != phase
    assert said("heating to 60 °C") == "heizt auf 60 °C"
    assert said("stopped: 3 of 4 brakings complete") == "angehalten: 3 von 4 Bremsungen vollständig"
    assert said("something new") == "something new"


@pytest.mark.parametrize("cause", list(CAUSES))
def test_every_cause_of_the_watchdog_has_words_and_remedy(german: None, cause: str):
    text = CAUSES[cause]
    for words in (text.words, text.remedy):
        assert SENTENCES.template_of(words) not in ("", *_ANYTHING), words
        assert said(words) != words
    with_values = Cause(cause, 31.5, 30.0).words
    assert said(with_values) == said(text.words) + ": 31.5 (Grenzwert 30)."
    capital = with_values[:1].upper() + with_values[1:]
    assert said(capital)[:1].isupper()
    assert said(f"safety trip: {with_values}").startswith("Auslösung: " + said(text.words))


def test_obstacles_and_refusals_have_words(german: None):
    told = [
        text for call in calls(ROOT / "rigctl" / "safety", "Obstacle") for text in map(sample, call.args[1:3])
    ]
    told += [sample(arg) for call in calls(ROOT / "rigctl" / "engine", "refuse") for arg in call.args]
    texts = {text for text in told if text}
    assert len(texts) > 15
    for text in texts:
        assert said(text) != text, text


def test_findings_against_the_rig_have_words(german: None):
    findings = list(calls(ROOT / "sequences", "Finding"))
    assert len(findings) > 12
    for call in findings:
        problem, remedy = sample(call.args[3]), sample(call.args[4])
        value = "torque at 60 Hz" if problem and problem.startswith("cannot be stored") else "450 degC"
        for text in (f"{value} {problem}" if problem else None, remedy):
            assert text is None or (CHECKS.template_of(text) and check_said(text) != text), text
    assert check_said("450 degC is above the 400 degC the rig allows for the disc").startswith(
        "450 degC liegt über"
    )


def test_english_stays_as_it_came():
    for text in (
        "heating to 60 °C",
        "Friction power in kW is too high: 31.5 (limit 30).",
        "Wait.",
        "nobody commands",
    ):
        assert said(text) == text
    assert check_said("450 degC is no channel of this rig") == "450 degC is no channel of this rig"


def test_what_speaks_against_a_calibration_has_words(german: None):
    told = []
    for call in calls(ROOT / "rigctl" / "calibration", "Fault"):
        words, remedy = (sample(arg) or "" for arg in call.args[:2])
        told += [re.sub("^60: ", "at 94 dB: ", re.sub("^60 60 %", "hysteresis 60 %", words)), remedy]
    assert len(told) > 20
    for text in filter(None, told):
        assert fault_said(text) != text, text
    for name in ("emissivity", "torque", "microphone"):
        for node in ast.walk(ast.parse((ROOT / "rigctl" / "calibration" / f"{name}.py").read_text("utf-8"))):
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
                why = sample(node.exc.args[0])
                assert why is not None and fault_said(why) != why, why
    assert fault_said("there is one pair only") == "es gibt nur ein Paar"
