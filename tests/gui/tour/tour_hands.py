"""Hands and eyes of a person before the window: real mouse and key events of the X server, and pictures.

Job: find widgets by name, move the mouse there and click with `xdotool`, type, wait for what a person would
wait for. Not its job: what to do (`tour_person`).
"""

import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from PySide6.QtCore import QPoint, QTimer
from PySide6.QtWidgets import QApplication, QTableView, QWidget

from rigctl.gui.rig.state import RigState, Word
from rigctl.gui.window import MainWindow

W = TypeVar("W", bound=QWidget)
PATIENCE_S = 60.0


class Hands:
    """One person at one window. `stall_ms` is the longest time the event loop has not come round."""

    def __init__(self, app: QApplication, window: MainWindow, pictures: Path | None) -> None:
        self.app, self.window, self.pictures = app, window, pictures
        self.stall_ms = 0.0
        self.steps: list[str] = []
        self._beat_at = time.monotonic()
        self._beat = QTimer(window)
        self._beat.setInterval(5)
        self._beat.timeout.connect(self._on_beat)
        self._beat.start()

    def _on_beat(self) -> None:
        now = time.monotonic()
        self.stall_ms = max(self.stall_ms, 1000.0 * (now - self._beat_at))
        self._beat_at = now

    # -- eyes -------------------------------------------------------------------------------------

    @property
    def state(self) -> RigState:
        return self.window.rig.state

    def see(self, name: str, kind: type[W] = QWidget) -> W:
        """The visible widget of that name on the page that is shown, or in the frame."""
        places = [self.window.stack.currentWidget(), self.window, *self.app.topLevelWidgets()]
        for place in places:
            for widget in place.findChildren(QWidget, name) if place is not None else []:
                if widget.isVisible() and isinstance(widget, kind):
                    return widget
        raise AssertionError(f"{name!r} is not to be seen on {self.window.stack.currentWidget()}")

    def is_seen(self, name: str) -> bool:
        try:
            self.see(name)
        except AssertionError:
            return False
        return True

    def wait(self, what: Callable[[], Any], words: str, patience_s: float = PATIENCE_S) -> None:
        """Look on until something holds."""
        deadline = time.monotonic() + patience_s
        while not what():
            if time.monotonic() > deadline:
                self.picture("lost")
                raise AssertionError(
                    f"waited for {words} in vain; state {self.state}; steps {self.steps[-5:]}"
                )
            self.rest(0.02)

    def wait_word(self, word: Word, patience_s: float = PATIENCE_S) -> None:
        """Wait for the one word of the state bar, as it is written there."""
        self.wait(lambda: self.state.word is word, word.value, patience_s)
        self.wait(lambda: word.value in self.window.state_bar.word.text(), f"{word.value} to be written")

    def rest(self, seconds: float) -> None:
        deadline = time.monotonic() + seconds
        while True:
            self.app.processEvents()
            if time.monotonic() >= deadline:
                return
            time.sleep(0.002)

    def picture(self, name: str) -> None:
        """Keep what is to be seen now."""
        if self.pictures is not None:
            self.rest(0.3)
            self.pictures.mkdir(parents=True, exist_ok=True)
            self.window.grab().save(str(self.pictures / f"{name}.png"))

    # -- hands ------------------------------------------------------------------------------------

    def click(self, name: str, *, at: QPoint | None = None, double: bool = False) -> None:
        """Move the mouse onto a widget and press."""
        widget = self.see(name)
        self.wait(widget.isEnabled, f"{name} to be enabled")
        self.click_widget(widget, at=at, double=double)
        self.steps.append(f"click {name}")

    def click_widget(self, widget: QWidget, *, at: QPoint | None = None, double: bool = False) -> None:
        self.rest(0.05)
        point = widget.mapToGlobal(at or widget.rect().center())
        repeat = ["--repeat", "2", "--delay", "50"] if double else []
        self._xdotool("mousemove", str(point.x()), str(point.y()), "click", *repeat, "1")
        self.rest(0.15)

    def type(self, text: str, *, enter: bool = False) -> None:
        """Type where the focus is."""
        self._xdotool("type", "--delay", "15", text)
        if enter:
            self.key("Return")
        self.rest(0.1)
        self.steps.append(f"type {text!r}")

    def key(self, *names: str) -> None:
        """Press keys, e.g. "ctrl+a"."""
        self._xdotool("key", "--delay", "15", *names)
        self.rest(0.1)
        self.steps.append(f"keys {names}")

    def fill(self, name: str, text: str, *, enter: bool = False) -> None:
        """Click into a field, replace what is there."""
        self.click(name)
        self.key("ctrl+a")
        self.type(text, enter=enter)

    def paste_list(self, name: str, text: str) -> None:
        """Put a column of a spreadsheet in place of what a list holds."""
        QApplication.clipboard().setText(text)
        table = self.see(name, QTableView)
        first = table.visualRect(table.model().index(0, table.model().columnCount() - 1))
        self.click_widget(table.viewport(), at=first.center())
        self.key("ctrl+a")
        self.key("Delete")
        self.key("ctrl+v")
        self.steps.append(f"paste into {name}")

    def _xdotool(self, *words: str) -> None:
        process = subprocess.Popen(["xdotool", *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        while process.poll() is None:  # the window goes on while the hand moves
            self.app.processEvents()
            time.sleep(0.001)
        out = process.stdout.read().decode() if process.stdout else ""
        if process.stdout:
            process.stdout.close()
        assert process.returncode == 0, (words, out)
