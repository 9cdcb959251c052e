"""The model page with a worker that answers in this process: same functions, same pickled values."""

import pickle
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, QTimer

from rigctl.core.errors import RigctlError
from rigctl.gui.pages.model.page import ModelPage
from rigctl.gui.pages.model.state import ModelState
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
            job.done = True
            if job.cancelled:
                return
            try:
                result = function(*args)
            except RigctlError as error:
                job.failed.emit(str(error))
            else:
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

    def wait(state, timeout=10_000):
        def ready():
            done = (state.poles, state.onsets, state.locus)
            return all(done) and not state.busy and state.poles.setting == state.setting

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


@pytest.fixture
def page(inline, settled, qtbot):
    """The page as the window shows it, model brake read."""
    page = ModelPage(inline)
    qtbot.addWidget(page)
    page.resize(1280, 760)
    page.show()
    qtbot.waitExposed(page)
    page.activated()
    qtbot.waitUntil(lambda: page.state.facts is not None)
    settled(page.state)
    yield page
    page.deactivated()
