"""Tests of the window: offscreen unless a display is asked for; no Qt warning, no thread left behind."""

import gc
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("PYTEST_QT_API", "pyside6")
os.environ.setdefault("PYQTGRAPH_QT_LIB", "PySide6")

import shiboken6
from PySide6.QtCore import QEvent, QSettings, QTimer
from PySide6.QtWidgets import QApplication

from rigctl.gui.pages.base import Page
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.services import Services
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.work import Work

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def theme(qapp: QApplication) -> ThemeKeeper:
    """The look, once per process."""
    return ThemeKeeper(qapp, "light")


@pytest.fixture(autouse=True)
def nothing_left(request: pytest.FixtureRequest) -> Iterator[None]:
    """Threads that a test has started have ended with it."""
    before = set(threading.enumerate())
    yield
    left = [t for t in threading.enumerate() if t not in before and t.is_alive() and not t.daemon]
    assert not left, f"threads left: {left}"


@pytest.fixture(autouse=True, scope="module")
def no_timer_or_widget_left(qapp: QApplication) -> Iterator[None]:
    """Timers and windows that the tests of a module have started have ended with them."""
    yield
    qapp.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    qapp.processEvents()
    gc.collect()
    seen = [w for w in qapp.topLevelWidgets() if shiboken6.isValid(w) and w.isVisible()]
    assert not seen, f"windows left: {seen}"
    timers = [
        each for each in gc.get_objects()
        if type(each) is QTimer and shiboken6.isValid(each) and each.isActive()
    ]  # fmt: skip
    assert not timers, f"timers left: {[(t.parent(), t.interval()) for t in timers]}"


@pytest.fixture
def services(qapp: QApplication, theme: ThemeKeeper, tmp_path: Path) -> Iterator[Services]:
    """Services without a rig; `services.shown`: calls of navigate, `services.news`: of notify."""
    settings = QSettings(str(tmp_path / "window.ini"), QSettings.Format.IniFormat)
    rig, work = RigConnection(), Work()
    shown: list[tuple[str, dict]] = []
    news: list[str] = []
    made = Services(
        rig, work, theme, settings, tmp_path / "data", ROOT / "configs",
        lambda page, **what: shown.append((page, what)), news.append,
    )  # fmt: skip
    made.shown, made.news = shown, news  # type: ignore[attr-defined]
    yield made
    rig.close()
    work.close()


def show(page: Page, qtbot, size: tuple[int, int] = (1280, 760)) -> Page:
    """Show a page as the window would; it is closed at the end of the test."""
    qtbot.addWidget(page)
    page.resize(*size)
    page.show()
    qtbot.waitExposed(page)
    page.activated()
    return page
