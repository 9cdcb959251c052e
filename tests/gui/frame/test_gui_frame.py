"""What is always visible, and what holds everywhere: state, cause, STOP, look, closing."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtWidgets import QApplication, QDialog, QMessageBox, QPushButton

from rigctl.app.sessions import BASE_VARIABLE
from rigctl.gui.format import bytes_text, frequency_text, number_text, quantity_text, time_text
from rigctl.gui.frame.alarmbar import AlarmBar
from rigctl.gui.frame.statebar import StateBar
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.state import RigState, SafetyCause, Word
from rigctl.gui.theme import DARK, LIGHT, Theme
from rigctl.gui.window import MainWindow

ROOT = Path(__file__).resolve().parents[3]
RUNNING = RigState(
    Word.RUNNING, "program", rig_name="A-class", simulated=True, braking=37, done=36, total=225,
    left_s=6130.0, disk_left_bytes=53e9, phase="braking with 20 bar",
)  # fmt: skip


class StoppedRig(RigConnection):
    """Counts the stops it is asked for."""

    def __init__(self) -> None:
        super().__init__()
        self.stops = 0

    def stop(self) -> None:
        self.stops += 1


@pytest.fixture
def window(qtbot, theme, tmp_path: Path) -> MainWindow:
    settings = QSettings(str(tmp_path / "window.ini"), QSettings.Format.IniFormat)
    made = MainWindow(theme, settings, StoppedRig(), tmp_path / "data", ROOT / "configs")
    qtbot.addWidget(made)
    made.show()
    qtbot.waitExposed(made)
    return made


def test_state_is_one_word_with_rig_and_progress(qtbot, theme):
    bar = StateBar(theme)
    qtbot.addWidget(bar)
    bar.show()
    bar.show_state(RUNNING)
    assert (bar.word.text(), bar.kind.text(), bar.rig.text()) == ("RUNNING", "SIMULATED", "A-class")
    assert bar.count.text() == "Braking 37 of 225"
    assert bar.left.text() == "1:42:10 left"
    assert "53" in bar.disk.text()
    assert not bar.cause.isVisible()
    bar.show_state(replace(RUNNING, simulated=False))
    assert bar.kind.text() == "REAL RIG"


def test_trip_shows_first_cause_and_what_to_do(qtbot, theme):
    bar = StateBar(theme)
    qtbot.addWidget(bar)
    bar.resize(1200, 90)
    bar.show()
    bar.show_state(RUNNING)
    height = bar.sizeHint().height()
    cause = SafetyCause("Pressure did not fall within 1 s.", "Check the vent valve, then reset.")
    bar.show_state(replace(RUNNING, word=Word.TRIPPED, cause=cause))
    assert bar.word.text() == "▲ TRIPPED"  # never by colour alone
    assert bar.cause.text() == "▲ Pressure did not fall within 1 s. Check the vent valve, then reset."
    assert bar.sizeHint().height() == height  # nothing moves under the hand


@pytest.mark.parametrize("word", list(Word))
def test_every_state_has_its_word(qtbot, theme, word: Word):
    bar = StateBar(theme)
    qtbot.addWidget(bar)
    bar.show_state(replace(RUNNING, word=word))
    assert word.value in bar.word.text()


def test_alarm_is_not_hidden_by_news(qtbot, theme):
    bar = AlarmBar(theme)
    qtbot.addWidget(bar)
    bar.show()
    bar.show_news("Saved.")
    assert bar.line.text() == "Saved."
    bar.show_alarm("Disc temperature 452 °C", severity="warning")
    bar.show_news("Saved again.")
    assert bar.line.text() == "▲ Disc temperature 452 °C"
    with qtbot.waitSignal(bar.acknowledgePressed):
        qtbot.mouseClick(bar.acknowledge, Qt.MouseButton.LeftButton)
    bar.show_alarm("", severity="")
    assert not bar.acknowledge.isVisible()
    assert "not the emergency stop" in bar.not_estop.text()


def test_stop_works_by_mouse_by_key_and_while_a_dialog_is_open(qtbot, window: MainWindow):
    rig = window.rig
    assert isinstance(rig, StoppedRig)
    qtbot.mouseClick(window.findChild(QPushButton, "stop"), Qt.MouseButton.LeftButton)
    assert rig.stops == 1
    qtbot.keyClick(window, Qt.Key.Key_F12)
    assert rig.stops == 2
    dialog = QDialog(window)
    dialog.setModal(True)
    dialog.show()
    qtbot.waitExposed(dialog)
    qtbot.keyClick(dialog, Qt.Key.Key_F12)
    assert rig.stops == 3
    dialog.close()


def test_frame_shows_the_kind_of_rig_everywhere(qtbot, window: MainWindow):
    def corner() -> list[tuple[int, int, int]]:
        image = window.grab().toImage()
        return [image.pixelColor(x, 2).getRgb()[:3] for x in range(40, 400)]

    calm = corner()
    window.rig.stateChanged.emit(replace(RUNNING, simulated=True))
    hatched = corner()
    window.rig.stateChanged.emit(replace(RUNNING, simulated=False))
    solid = corner()
    assert len(set(calm)) == 1
    assert len(set(hatched)) > 1
    assert len(set(solid)) == 1
    assert solid[0] != calm[0]


def test_unsaved_work_is_asked_about(qtbot, window: MainWindow, monkeypatch):
    page = window.page("manual")
    monkeypatch.setattr(page, "unsaved", lambda: ["program night.toml"])
    asked: list[str] = []

    def answer(parent, title, text, *rest):
        asked.append(text)
        return QMessageBox.StandardButton.Cancel

    monkeypatch.setattr(QMessageBox, "question", answer)
    assert not window.close()
    assert "night.toml" in asked[0]
    monkeypatch.setattr(page, "unsaved", list)
    assert window.close()


def test_window_remembers_page_and_look(qtbot, theme, tmp_path: Path):
    settings = QSettings(str(tmp_path / "window.ini"), QSettings.Format.IniFormat)
    first = MainWindow(theme, settings, StoppedRig(), tmp_path, ROOT / "configs")
    qtbot.addWidget(first)
    first.show()
    first.navigate("service")
    first._other_look()
    assert theme.current.name == "dark"
    first._other_look()
    assert first.close()
    assert settings.value("theme") == "light"
    second = MainWindow(theme, settings, StoppedRig(), tmp_path, ROOT / "configs")
    qtbot.addWidget(second)
    assert second.stack.currentWidget() is second.page("service")
    second.close()


@pytest.mark.parametrize("page", ["manual", "sequence", "run", "data", "model", "service"])
def test_every_page_opens_teaches_and_has_help(qtbot, window: MainWindow, page: str):
    window.navigate(page)
    assert window.stack.currentWidget().isVisible()
    assert len(window.page(page).help_text()) > 40


# -- foundations ----------------------------------------------------------------------------------


def luminance(colour: str) -> float:
    """Relative luminance, WCAG 2.1."""
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: str, b: str) -> float:
    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("look", [LIGHT, DARK], ids=lambda look: look.name)
def test_text_is_readable_in_both_looks(look: Theme):
    grounds = [look.window, look.panel, look.field]
    pairs = [(ink, ground) for ground in grounds for ink in (look.text, look.muted)]
    pairs += [(look.on_blue, look.blue), (look.on_red, look.red), (look.on_amber, look.amber)]
    pairs += [
        (look.red, look.field),
        (look.red, look.panel),
        (look.blue, look.field),
        (look.green, look.field),
    ]
    poor = {pair: round(contrast(*pair), 2) for pair in pairs if contrast(*pair) < 4.5}
    assert not poor
    faint = {name: c for name, c in look.series.items() if contrast(c, look.plot) < 3.0}
    assert not faint


def test_numbers_as_people_read_them():
    assert [number_text(v, 1) for v in (1.25, -0.01, None, float("nan"))] == ["1.2", "0.0", "—", "—"]
    assert quantity_text(3.0, "bar") == "3.0\u202fbar"
    assert [time_text(v) for v in (0, 65, 3661, None)] == ["0:00", "1:05", "1:01:01", "—"]
    assert [frequency_text(v) for v in (2349.6, 12_340.0)] == ["2350\u202fHz", "12.34\u202fkHz"]
    assert [bytes_text(v) for v in (5e5, 2.5e6, 5.31e10, 2e12)] == [
        "500\u202fkB", "2.5\u202fMB", "53.1\u202fGB", "2\u202fTB",
    ]  # fmt: skip


def test_signals_and_repaints_keep_the_references_of_true_and_none(qtbot, theme):
    """PySide6 6.12.0 gives them away on Python 3.11 and dies of it after some seconds."""
    bar = StateBar(theme)
    qtbot.addWidget(bar)
    bar.show()
    rig = RigConnection()
    rig.refused.connect(lambda text: None)
    rig.stateChanged.connect(bar.show_state)
    before = [sys.getrefcount(thing) for thing in (None, True, False)]
    for k in range(400):
        rig.refused.emit("")
        rig.stateChanged.emit(replace(RUNNING, braking=k))
        bar.repaint()
    after = [sys.getrefcount(thing) for thing in (None, True, False)]
    if sys.version_info < (3, 12):  # immortal from there on
        assert all(b - a < 200 for a, b in zip(after, before, strict=True)), (before, after)


def test_window_starts_without_the_heavy_libraries():
    """They cost a second and more; pages load them in other processes or when they are needed."""
    code = (
        "import sys, rigctl.gui.main\n"
        "heavy = {'scipy', 'numba', 'h5py', 'matplotlib', 'can', 'canopen', 'pymodbus', 'sounddevice'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert out.stdout.strip() == "[]"


def listens_to(pid: int, number: signal.Signals) -> bool:
    """True once a process has a handler for a signal; Python sets none for SIGTERM by itself."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    caught = int(next(line.split()[1] for line in lines if line.startswith("SigCgt")), 16)
    return bool(caught >> (number - 1) & 1)


def test_rigctl_gui_opens_attaches_to_nothing_and_ends_when_asked(tmp_path: Path):
    """As a person starts it: no option but where settings are kept; SIGTERM closes it."""
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", BASE_VARIABLE: str(tmp_path)}
    command = [sys.executable, "-m", "rigctl.app.cli", "gui", "--settings", str(tmp_path / "window.ini")]
    window = subprocess.Popen(
        command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    deadline = time.monotonic() + 60.0
    while not listens_to(window.pid, signal.SIGTERM) and time.monotonic() < deadline:
        assert window.poll() is None, window.communicate()[0]
        time.sleep(0.05)
    window.send_signal(signal.SIGTERM)
    out, _ = window.communicate(timeout=60)
    assert window.returncode == 0, out
    assert "Traceback" not in out


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"DISPLAY": "", "WAYLAND_DISPLAY": "", "QT_QPA_PLATFORM": ""}, "there is no screen"),
        (
            {"QT_QPA_PLATFORM": "offscreen", "PYTHONPATH": "{broken}"},
            "Qt cannot be loaded (libGL.so.1: no file)",
        ),
    ],
)
def test_where_no_window_can_be_shown_one_line_says_why(changes: dict[str, str], words: str, tmp_path: Path):
    broken = tmp_path / "PySide6"
    broken.mkdir()
    (broken / "__init__.py").write_text("raise ImportError('libGL.so.1: no file')\n")
    environment = {**os.environ, **{key: value.format(broken=tmp_path) for key, value in changes.items()}}
    done = subprocess.run(
        [sys.executable, "-m", "rigctl.gui"],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
    )
    assert done.returncode == 1
    assert words in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_no_window_is_left(qapp: QApplication):
    assert [w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow) and w.isVisible()] == []
