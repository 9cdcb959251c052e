"""A person's path through the window, from the first start to the stored data. Run as a process of its own.

    python tests/gui/tour/tour_person.py --time virtual --data FOLDER [--pictures FOLDER] [--theme dark]

Job: the story, and what must be seen at each of its steps; prints one JSON line at the end. A screen (an X
server) and `xdotool` must be there. Not its job: starting the screen (`test_gui_tour`).
"""

import argparse
import json
import sys
import time
from pathlib import Path

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QMessageBox, QTableView, QTabWidget
from tour_hands import Hands

from rigctl.gui.application import install_language, make_application, make_theme, window_settings
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.state import Word
from rigctl.gui.window import MainWindow
from rigctl.recording.braking_file import read_braking

ROOT = Path(__file__).resolve().parents[3]
START_S = 170.0  # the first start on a machine compiles


def manual_braking(p: Hands, how: str) -> None:
    """Connect, enable, move by hand, record one braking and rate it."""
    p.see("connect")
    p.picture("manual-empty")
    p.click(f"connect-time-{how}")
    p.click("connect")
    p.wait_word(Word.LOCKED, START_S)
    assert "SIMULATED" in p.window.state_bar.kind.text()
    p.click("enable")
    assert "800" in p.see("enable-confirm-question").text()  # what will move
    p.picture("manual-enable")
    p.click("enable-confirm-yes")
    p.wait_word(Word.READY)
    p.fill("speed", "9000", enter=True)
    assert p.see("speed-error").text()  # refused at the field, with the reason
    p.fill("speed", "50", enter=True)
    p.wait(lambda: abs(p.state.readings.speed_rpm - 50) < 3, "50 1/min")
    p.wait_word(Word.RUNNING)
    p.fill("pressure", "34", enter=True)  # enough for a squeal
    p.wait(lambda: p.state.readings.pressure_bar > 32, "pressure")
    p.rest(3.0)
    p.picture("manual-dragging")
    p.click("release")
    p.wait(lambda: p.state.readings.pressure_bar < 1, "release")
    p.fill("record-duration", "2")
    p.fill("record-comment", "first try")
    p.click("start-braking")
    p.wait(lambda: p.state.recording or p.state.done == 1, "recording")  # virtual time may be quicker
    p.click("manual-rating-7")
    p.wait(lambda: p.state.done == 1 and not p.state.recording, "the braking to be stored", 90)
    p.picture("manual-recorded")


def trip_and_reset(p: Hands) -> None:
    """Somebody presses the emergency stop; seen, acknowledged, released, reset in words, enabled again."""
    p.click("nav-service")
    tab(p, "service-tabs", "laboratory")
    p.picture("service-laboratory")
    p.click("lab-estop")
    p.wait_word(Word.TRIPPED)
    assert "emergency stop" in p.see("first-out-cause").text()
    p.click("nav-manual")
    p.picture("manual-tripped")
    p.click("acknowledge")
    p.wait(lambda: "alarm_acknowledged" in [r.kind for r in p.window.rig.records], "acknowledged")
    p.click("nav-service")
    tab(p, "service-tabs", "Alarms")
    p.picture("service-alarms")
    tab(p, "service-tabs", "laboratory")
    p.click("lab-estop")
    p.rest(3.0)  # the watchdog wants to see the rig at rest for two seconds
    p.click("nav-manual")
    p.click("reset")
    p.fill("reset-reason-text", "somebody leaned on the button", enter=True)
    p.wait_word(Word.LOCKED)
    assert not p.is_seen("first-out-cause")
    p.click("enable")
    if p.is_seen("enable-confirm-yes"):
        p.click("enable-confirm-yes")
    p.wait_word(Word.READY)
    p.key("F12")  # software stop, from anywhere
    p.wait_word(Word.LOCKED)
    p.click("end-session")
    p.wait_word(Word.OFFLINE)


def matrix(p: Hands, how: str) -> None:
    """Four brakings: written, checked while typing, started, watched."""
    p.click("nav-sequence")
    p.picture("sequence-empty")
    p.click("empty-new")
    p.wait(lambda: p.is_seen("field-pressures_bar"), "the editor")
    p.paste_list("field-temperatures_degc", "40\n60\n")
    p.paste_list("field-speed_profiles", "2\t40\t40\n")
    p.paste_list("field-pressures_bar", "8\n99\n")
    p.wait(lambda: not p.see("start").isEnabled() or p.see("start-why").text(), "99 bar to be refused")
    p.picture("sequence-fault")
    p.paste_list("field-pressures_bar", "8\n25\n")
    p.wait(lambda: p.see("count-of-brakings").text().split()[0] == "4", "4 brakings")
    p.wait(lambda: p.see("start").isEnabled(), "a program that can be started")
    p.rest(1.0)
    p.picture("sequence")
    p.click("start")
    p.rest(0.3)
    if how == "virtual" and p.is_seen("start-time"):
        choose_time(p, how)
    p.picture("sequence-start")
    p.click("start-now")
    p.wait(lambda: p.state.mode == "program" and p.state.word is Word.RUNNING, "the run", START_S)
    assert p.see("run-table")
    p.wait(lambda: p.state.done >= 2, "two brakings", 400)
    p.picture("run")
    p.wait(lambda: p.state.done == 4, "four brakings", 400)
    p.wait_word(Word.OFFLINE, 120)
    p.wait(lambda: p.is_seen("run-outcome"), "the result")
    p.picture("run-result")


def choose_time(p: Hands, how: str) -> None:
    """The choice of time beside [Start now]."""
    combo = p.see("start-time")
    wanted = next(i for i in range(combo.count()) if combo.itemData(i) == how)
    p.click("start-time")
    for _ in range(abs(wanted - combo.currentIndex())):
        p.key("Down" if wanted > combo.currentIndex() else "Up")
    p.key("Return")
    assert combo.currentData() == how


def data(p: Hands) -> None:
    """What was recorded is there: the table, a braking, its sound."""
    p.click("nav-data")
    table = p.see("data-table", QTableView)
    p.wait(lambda: table.model().rowCount() >= 4, "the rows", 120)
    column = next(c for c in range(table.model().columnCount()) if table.columnWidth(c) > 0)
    p.click_widget(table.viewport(), at=table.visualRect(table.model().index(3, column)).center())
    p.wait(lambda: any(c.isdigit() for c in p.see("data-braking-title").text()), "the braking")
    p.rest(1.5)
    p.picture("data")


def model(p: Hands) -> None:
    """The prediction beside it."""
    p.click("nav-model")
    p.wait(lambda: "bar" in p.see("model-onset").text(), "the onset of squeal", 120)
    p.rest(1.0)
    p.picture("model")


def tab(p: Hands, name: str, words: str) -> None:
    """Choose a tab by what is written on it."""
    tabs = p.see(name, QTabWidget)
    bar = tabs.tabBar()
    index = next(i for i in range(tabs.count()) if words in tabs.tabText(i).replace("&", ""))
    p.click_widget(bar, at=bar.tabRect(index).center())
    p.wait(lambda: tabs.currentIndex() == index, words)


def gallery(p: Hands) -> None:
    """The other tabs, for the pictures of the documents."""
    tab(p, "model-tabs", "map")
    p.wait(lambda: not p.is_seen("map-cancel"), "the map", 240)
    p.click("map-campaign")  # its measured squeal over the predicted boundary
    p.key("Down", "Return")
    p.rest(4.0)
    p.picture("model-map")
    tab(p, "model-tabs", "helps")
    p.wait(lambda: p.see("model-ranking", QTableView).model().rowCount() > 3, "the ranking", 240)
    p.rest(1.0)
    p.picture("model-helps")
    p.click("nav-data")
    tab(p, "data-tabs", "Figures")
    p.rest(2.0)
    p.picture("data-figures")
    p.click("nav-service")
    for words in ("Calibrations", "Journal"):
        tab(p, "service-tabs", words)
        p.rest(1.0)
        p.picture(f"service-{words.lower()}")


def leave(p: Hands) -> None:
    """Close the window; the program that was never saved is asked about."""
    asked: list[str] = []

    def answer() -> None:
        question = p.app.activeModalWidget()
        if isinstance(question, QMessageBox):
            asked.append(question.text())
            p.click_widget(question.button(QMessageBox.StandardButton.Discard))
        else:
            QTimer.singleShot(100, answer)

    QTimer.singleShot(100, answer)
    assert p.window.close()
    assert asked


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--time", choices=("virtual", "real"), default="virtual")
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--theme", default="light")
    parser.add_argument("--language", default="en")
    parser.add_argument("--gallery", action="store_true", help="the other tabs, too")
    options = parser.parse_args()
    began = time.monotonic()
    app = make_application([])
    options.data.mkdir(parents=True, exist_ok=True)
    settings = window_settings(options.data / "window.ini")
    translators = install_language(app, options.language)
    theme = make_theme(app, settings, options.theme)
    rig = RigConnection(options.data)
    window = MainWindow(theme, settings, rig, options.data, ROOT / "configs")
    window.setGeometry(0, 0, 1440, 900)
    window.show()
    rig.start()
    shown_s = time.monotonic() - began
    p = Hands(app, window, options.pictures)
    p._xdotool("windowfocus", str(int(window.winId())))
    p.rest(0.5)
    p.stall_ms = 0.0
    manual_braking(p, options.time)
    stall_ms = p.stall_ms
    first = window.rig.session.campaign if window.rig.session else options.data
    trip_and_reset(p)
    matrix(p, options.time)
    data(p)
    model(p)
    if options.gallery:
        gallery(p)
    braking = read_braking(first / "brakings" / "00001.h5")
    marks = {mark.name: mark.values for mark in braking.marks}
    told = {
        "shown_s": shown_s,
        "stall_manual_ms": stall_ms,
        "stall_ms": p.stall_ms,
        "note": braking.summary["note"],
        "rating": marks.get("operator_rating", {}).get("rating"),
        "status": braking.status,
        "seconds": time.monotonic() - began,
    }
    print(json.dumps(told), flush=True)
    leave(p)
    del translators
    return 0


if __name__ == "__main__":
    sys.exit(main())
