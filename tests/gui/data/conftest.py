"""A small campaign in the real file format, and one worker process for all tests of the data page."""

import shutil
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "unit" / "analysis"))

from campaign_files import Case, numbered, write_campaign

from rigctl.core.journal import Journal
from rigctl.gui.pages.data import remote
from rigctl.gui.pages.data.page import DataPage
from rigctl.gui.work import Work

LOUD = (2350.0, 92.0, 1.0, 2.3)
TOML = """name = "{0}"
created = "2026-11-30T0{1}:00:00+00:00"
[program]
name = "test"
[rig]
name = "rig"
simulated = true
"""


@pytest.fixture(scope="session")
def made(tmp_path_factory) -> Path:
    """Two pressures at two temperatures, 20 bar squeals; one braking incomplete, one without sound."""
    cases = [
        Case(0, pressure, temperature, tones=(LOUD,) if pressure == 20.0 else ())
        for temperature in (50.0, 150.0)
        for pressure in (6.0, 20.0)
    ]
    cases.append(Case(0, 6.0, 250.0, status="incomplete", note="door open"))
    cases.append(Case(0, 10.0, 250.0, sound=False))
    return write_campaign(tmp_path_factory.mktemp("made") / "c", numbered(cases))


@pytest.fixture
def campaign(made: Path, tmp_path: Path) -> Path:
    """A copy that a test may change, in the data folder of `services`."""
    return copy(made, tmp_path / "data" / "first", 1)


@pytest.fixture
def second(made: Path, tmp_path: Path) -> Path:
    """An older campaign beside it."""
    return copy(made, tmp_path / "data" / "second", 0)


def copy(made: Path, folder: Path, hour: int) -> Path:
    """The made campaign under another name."""
    shutil.copytree(made, folder)
    (folder / "campaign.toml").write_text(TOML.format(folder.name, hour), encoding="utf-8")
    Journal(folder / "journal.jsonl", "controller").close()
    return folder


@pytest.fixture(scope="session")
def shared_work(qapp, made: Path) -> Iterator[Work]:
    """One worker process and its threads for all tests; they are running before the first test begins."""
    work = Work()
    gate, ready = threading.Event(), []
    for _ in range(2):
        work.in_thread(lambda reporter: gate.wait(20), done=ready.append)
    gate.set()
    work.in_process(
        remote.view, made / "brakings" / "00002.h5", done=ready.append, failed=ready.append, lane=remote.LANE
    )
    while len(ready) < 3:
        qapp.processEvents()
    yield work
    work.close()


@pytest.fixture
def page(services, shared_work: Work, qtbot) -> Iterator[DataPage]:
    """The page, not yet shown (its data folder may still be filled)."""
    services.work.close()
    services.work = shared_work
    page = DataPage(services)
    qtbot.addWidget(page)
    yield page
    page.stop_reading()


@pytest.fixture
def opened(page: DataPage, campaign: Path, qtbot) -> DataPage:
    """The page with the first campaign open."""
    page.resize(1280, 760)
    page.show()
    qtbot.waitExposed(page)
    page.activated()
    qtbot.waitUntil(lambda: page.table.model.rowCount() == 6 and not page.loader.busy, timeout=20_000)
    return page
