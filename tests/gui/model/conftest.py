"""The model page with a worker that answers in this process: same functions, same pickled values."""

import pickle
from pathlib import Path

import pytest
import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, QObject, QSettings, QTimer

from rigctl.core.errors import RigctlError
from rigctl.gui.pages.model.page import ModelPage
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.services import Services
from rigctl.gui.work import Job

BRAKES = Path(__file__).resolve().parents[3] / "configs" / "brakes"


class InlineWork(QObject):
    """Runs work one event later; counts questions by function."""

    def __init__(self):
        super().__init__()
        self.asked = []

    def in_process(self, function, *args, done, failed=None, lane=""):
        job = Job(self)
        job.finished.connect(done)
        if failed is not None:
            job.failed.connect(failed)
        self.asked.append((function.__name__, args))
        function, args = pickle.loads(pickle.dumps((function, args)))

        def run():
            if not shiboken6.isValid(job):
                return  # the page has gone meanwhile, and its work with it
            job.done = True
            if job.cancelled:
                return
            try:
                result = function(*args)
            except RigctlError as error:
                job.failed.emit(str(error))
                return
            if shiboken6.isValid(job):
                job.finished.emit(pickle.loads(pickle.dumps(result)))

        QTimer.singleShot(0, run)
        return job

    def count(self, name):
        return sum(1 for asked, _ in self.asked if asked == name)


@pytest.fixture
def inline(services):
    """Services whose work is done in this process."""
    services.work = InlineWork()
    return services


@pytest.fixture
def settled(qtbot):
    """Waits until a state has all answers to its present sliders."""

    def wait(state, timeout=20_000, *, onsets=True):
        def ready():
            done = state.poles and state.locus and state.poles.setting == state.setting
            if not done or state._poles.busy or state._locus.busy:
                return False
            return not onsets or (not state.busy and bool(state.onsets))

        qtbot.waitUntil(ready, timeout=timeout)

    return wait


@pytest.fixture
def state(inline, settled, qtbot):
    """State with the model brake read."""
    state = ModelState(inline)
    state.open(BRAKES / "model.toml")
    qtbot.waitUntil(lambda: state.facts is not None)
    settled(state)
    yield state
    state.deleteLater()


@pytest.fixture(scope="module")
def shown_page(qapp, theme, tmp_path_factory):
    """One page for all tests of a module, with its services: making it takes longer than most tests."""
    folder = tmp_path_factory.mktemp("model-page")
    settings = QSettings(str(folder / "window.ini"), QSettings.Format.IniFormat)
    shown, news = [], []
    services = Services(
        RigConnection(), InlineWork(), theme, settings, folder / "data", BRAKES.parent,
        lambda name, **what: shown.append((name, what)), news.append,
    )  # fmt: skip
    services.shown, services.news = shown, news
    page = ModelPage(services)
    page.resize(1280, 760)
    page.show()
    page.activated()
    yield page
    page.deactivated()
    page.close()
    page.deleteLater()
    QCoreApplication.sendPostedEvents(page, QEvent.Type.DeferredDelete)


@pytest.fixture
def page(shown_page, settled, qtbot):
    """The page as it is when a person has just chosen the model brake."""
    page = shown_page
    qtbot.waitExposed(page)
    page.tabs.setCurrentIndex(0)
    page.services.shown.clear()
    page.services.news.clear()
    page.sliders.search.clear()
    QCoreApplication.sendEvent(page.locus.plot, QEvent(QEvent.Type.Leave))
    page.map.open_campaign(None)
    page.ranking.helpful.setChecked(False)
    page.activated()
    page.locus.view.setPlaying(True)
    page.state.facts = None
    page.open(brake=BRAKES / "model.toml")
    qtbot.waitUntil(lambda: page.state.facts is not None)
    settled(page.state)
    return page
