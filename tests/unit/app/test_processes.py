"""Child processes of a run: how one ends that does not end by itself."""

import os
import signal
from pathlib import Path

import pytest

from rigctl.app.processes import Child

MODULE = """
import time
{setup}
print("up", flush=True)
time.sleep(600)
"""


def child(folder: Path, monkeypatch: pytest.MonkeyPatch, setup: str = "") -> Child:
    (folder / "sleeper.py").write_text(MODULE.format(setup=setup))
    monkeypatch.setenv("PYTHONPATH", str(folder))
    made = Child("sleeper", ["sleeper"], folder)
    while not made.log_path.read_text():
        assert made.returncode is None, made.last_words()
    return made


def test_one_that_has_not_ended_in_time_is_asked_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    sleeper = child(tmp_path, monkeypatch)
    sleeper.end(grace_s=0.05)
    assert sleeper.describe_end() == "the sleeper was killed by SIGTERM"


def test_one_that_is_frozen_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    sleeper = child(tmp_path, monkeypatch)
    os.kill(sleeper.pid, signal.SIGSTOP)
    sleeper.end(grace_s=0.05)
    assert sleeper.describe_end() == "the sleeper was killed by SIGKILL"


def test_one_that_ends_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    setup = "import os, threading\nthreading.Timer(0.3, os._exit, (3,)).start()"
    sleeper = child(tmp_path, monkeypatch, setup)
    sleeper.end(grace_s=60.0)
    assert sleeper.describe_end() == "the sleeper ended with exit code 3"
