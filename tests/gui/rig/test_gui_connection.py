"""The window's connection against real sessions: start, attach, watch, take over, deaths of either side."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from rigctl.app.sessions import BASE_VARIABLE, running_sessions
from rigctl.core.journal import read_journal
from rigctl.engine.state import Verb
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.state import RigState, Word

ROOT = Path(__file__).resolve().parents[3]
RIG = ROOT / "configs" / "rigs" / "simulated.toml"
START_MS = 120_000  # the first start on a machine compiles

PROGRAM = """
format = 1
name = "pair"
[[sequences]]
name = "drag"
role = "check"
speed_profiles = [{ duration_s = 1.0, start_rpm = 40.0, end_rpm = 40.0 }]
pressures_bar = [5, 20]
temperatures_degc = [40]
conditioning = { tolerance_k = 15.0, soak_s = 0.0 }
[sequences.recording]
channels = [{ name = "microphone" }, { name = "pressure", decimation = 40 }]
"""


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Sessions of this test only; whatever still runs is killed at the end."""
    base = Path(tempfile.mkdtemp(prefix="rg", dir="/dev/shm" if Path("/dev/shm").is_dir() else None))
    monkeypatch.setenv(BASE_VARIABLE, str(base))
    yield base
    for session in running_sessions():
        os.kill(session.pid, signal.SIGTERM)
    deadline = time.monotonic() + 60.0
    while running_sessions() and time.monotonic() < deadline:
        time.sleep(0.05)
    shutil.rmtree(base, ignore_errors=True)


class Watcher:
    """A connection and what it has told."""

    def __init__(self, qtbot, data: Path) -> None:
        self.rig = RigConnection(data)
        self.states: list[RigState] = []
        self.refusals: list[str] = []
        self.blocks = 0
        self._qtbot = qtbot
        self.rig.stateChanged.connect(self.states.append)
        self.rig.refused.connect(self.refusals.append)
        self.rig.blocksArrived.connect(self._count)

    def _count(self, blocks: list) -> None:
        self.blocks += len(blocks)

    @property
    def state(self) -> RigState:
        return self.rig.state

    def wait(self, condition: Callable[[RigState], bool], timeout_ms: int = START_MS) -> RigState:
        self._qtbot.waitUntil(lambda: condition(self.state), timeout=timeout_ms)
        return self.state

    def wait_refusal(self) -> str:
        self._qtbot.waitUntil(lambda: bool(self.refusals), timeout=START_MS)
        return self.refusals.pop()


@pytest.fixture
def watcher(qtbot, runs, tmp_path: Path) -> Iterator[Callable[[], Watcher]]:
    made: list[Watcher] = []

    def make() -> Watcher:
        made.append(Watcher(qtbot, tmp_path))
        return made[-1]

    yield make
    for each in made:
        each.rig.close()


def program(folder: Path) -> Path:
    path = folder / "pair.toml"
    path.write_text(PROGRAM)
    return path


def test_a_program_is_started_watched_and_comes_to_its_end(watcher, tmp_path: Path):
    window = watcher()
    window.rig.start()
    assert window.state.word is Word.OFFLINE
    path = program(tmp_path)
    path.write_text(path.read_text().replace("[5, 20]", "{ from = 2, to = 25, step = 1 }"))
    window.rig.start_program(path, RIG, seed=1)
    assert window.state.word is Word.STARTING
    state = window.wait(lambda s: s.done == 24 and s.word is Word.OFFLINE)
    words = {s.word for s in window.states}
    assert {Word.STARTING, Word.RUNNING} <= words
    assert (state.total, state.incomplete, state.cause) == (24, 0, None)
    assert window.blocks > 10
    assert [r.kind for r in window.rig.records].count("BRAKING_COMMITTED") == 24


def test_what_cannot_be_started_says_why(watcher, tmp_path: Path):
    window = watcher()
    window.rig.start()
    path = program(tmp_path)
    path.write_text(path.read_text().replace("[5, 20]", "[5, 90]"))
    window.rig.start_program(path, RIG)
    assert "90" in window.wait_refusal()
    assert window.state.word is Word.OFFLINE


def test_windows_come_and_go_and_the_run_goes_on(watcher, tmp_path: Path):
    first = watcher()
    first.rig.start()
    first.rig.start_manual(RIG, time="virtual", seed=1)
    first.wait(lambda s: s.word is Word.LOCKED)
    assert first.state.commanding
    # a second window shows the right state within a second, and only watches
    second = watcher()
    began = time.monotonic()
    second.rig.start()
    second.wait(lambda s: s.word is Word.LOCKED and s.commander != "", 1000)
    assert time.monotonic() - began < 1.0
    assert (second.state.mode, second.state.simulated, second.state.commanding) == ("manual", True, False)
    second.rig.enable()
    assert "commands this rig" in second.wait_refusal()
    second.rig.take_command()
    second.wait(lambda s: s.commanding)
    first.wait(lambda s: not s.commanding)
    second.rig.enable()
    second.wait(lambda s: s.word is Word.READY)
    second.rig.set_speed(50.0, 50.0)
    first.wait(lambda s: s.readings.speed_rpm > 45.0 and s.word is Word.RUNNING)
    second.rig.close()
    first.wait(lambda s: s.commander == "")
    assert first.state.word is Word.RUNNING
    first.rig.stop()
    first.wait(lambda s: s.word is Word.LOCKED)
    first.rig.end_session()
    first.wait(lambda s: s.word is Word.OFFLINE)


def test_killed_controller_is_shown_as_safe_state_with_its_reason(watcher):
    window = watcher()
    window.rig.start()
    window.rig.start_manual(RIG, time="virtual", seed=1)
    window.wait(lambda s: s.word is Word.LOCKED)
    window.rig.enable()
    window.wait(lambda s: s.word is Word.READY)
    window.rig.set_speed(60.0, 100.0)
    window.wait(lambda s: s.readings.speed_rpm > 50.0)
    assert window.rig.session is not None
    journal = window.rig.session.campaign / "journal.jsonl"
    started = next(r for r in read_journal(journal) if r.kind == "run_started")
    os.kill(started.payload["pids"]["controller"], signal.SIGKILL)
    state = window.wait(
        lambda s: s.word is Word.TRIPPED and "controller" in (s.cause.words if s.cause else "")
    )
    assert not state.relay_closed
    window.wait(lambda s: "safe state" in s.phase and "waiting" not in s.phase)
    window.rig.reset("it was me")
    window.wait(lambda s: s.word is Word.OFFLINE)
    assert "trip_acknowledged" in [r.kind for r in read_journal(journal)]


@pytest.mark.slow
def test_killed_window_changes_nothing(runs, tmp_path: Path, qtbot):
    """kill -9 of the window's process in the midst of a program: the program completes."""
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    path = program(tmp_path)
    path.write_text(path.read_text().replace("[5, 20]", "{ from = 2, to = 30, step = 1 }"))
    script = tmp_path / "starter.py"
    script.write_text(
        "import sys\nfrom pathlib import Path\n"
        "from rigctl.gui.application import make_application\n"
        "from rigctl.gui.rig.connection import RigConnection\n"
        "app = make_application([])\n"
        "rig = RigConnection(Path(sys.argv[1]))\nrig.start()\n"
        "rig.start_program(Path(sys.argv[2]), Path(sys.argv[3]), seed=1)\napp.exec()\n"
    )
    window = subprocess.Popen([sys.executable, str(script), str(tmp_path), str(path), str(RIG)],
                              env=environment, cwd=ROOT)  # fmt: skip
    qtbot.waitUntil(lambda: bool(running_sessions()), timeout=START_MS)
    (session,) = running_sessions()
    journal = session.campaign / "journal.jsonl"
    committed = lambda: sum(r.kind == "BRAKING_COMMITTED" for r in read_journal(journal))  # noqa: E731
    qtbot.waitUntil(lambda: committed() >= 1, timeout=START_MS)
    window.send_signal(signal.SIGKILL)
    window.wait()
    assert committed() < 29
    follower = RigConnection(tmp_path)
    began = time.monotonic()
    follower.start()
    qtbot.waitUntil(lambda: follower.state.word is Word.RUNNING and follower.state.total == 29, timeout=1000)
    assert time.monotonic() - began < 1.0
    follower.verb(Verb.HOLD)
    qtbot.waitUntil(lambda: follower.state.word is Word.PAUSED, timeout=START_MS)
    follower.verb(Verb.RESUME)
    qtbot.waitUntil(lambda: follower.state.word is Word.OFFLINE, timeout=START_MS)
    follower.close()
    assert follower.state.done == 29
    assert committed() == 29
