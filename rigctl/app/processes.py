"""Child processes of a run: how they are started, watched and ended.

Job: start watchdog, recorder and controller with their logs; notice deaths; end what hangs. Not its job:
what they do.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any


class Child:
    """One child process in a session of its own, so that Ctrl-C in the terminal does not reach it."""

    def __init__(self, name: str, arguments: Sequence[str], log_dir: Path) -> None:
        self.name = name
        self.log_path = log_dir / f"{name}.log"
        with self.log_path.open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", *arguments],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )

    @property
    def pid(self) -> int:
        """Process id."""
        return self._process.pid

    @property
    def returncode(self) -> int | None:
        """None while it runs; negative: killed by that signal."""
        return self._process.poll()

    def describe_end(self) -> str:
        """How it ended, in words."""
        code = self.returncode
        if code is None:
            return f"the {self.name} is still running"
        if code < 0:
            return f"the {self.name} was killed by {signal.Signals(-code).name}"
        return f"the {self.name} ended with exit code {code}"

    def wait(self, timeout_s: float) -> bool:
        """True when it has ended within the time."""
        try:
            self._process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            return False
        return True

    def end(self, grace_s: float) -> None:
        """Wait, then ask (SIGTERM), then kill. The rig is safe by the relay, not by this."""
        if self.wait(grace_s):
            return
        self._process.terminate()
        if not self.wait(2.0):
            self.kill()

    def kill(self) -> None:
        """SIGKILL; also ends a frozen process."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._process.pid, signal.SIGKILL)
        self._process.wait()

    def last_words(self, lines: int = 5) -> str:
        """The last lines of its log."""
        try:
            text = self.log_path.read_text(errors="replace").strip().splitlines()
        except OSError:
            return ""
        return "\n".join(text[-lines:])


def share_processors(*, lockstep: Sequence[Child], others: Sequence[Child]) -> None:
    """Virtual time: processes that take turns share one processor, the others have the rest.

    They never work at the same time, and waking a process on another processor costs many times more than on
    the same one (on a virtual machine 90 µs against 9 µs). The rig server inherits the controller's place.
    """
    available = sorted(os.sched_getaffinity(0))
    if len(available) < 2:
        return
    own = available[os.getpid() % len(available)]
    for child, processors in [
        *((c, {own}) for c in lockstep),
        *((c, set(available) - {own}) for c in others),
    ]:
        with contextlib.suppress(ProcessLookupError):
            os.sched_setaffinity(child.pid, processors)


def start_watchdog(
    run_dir: Path, campaign: Path, limits: Path, link: tuple[str, Mapping[str, Any]], time: str
) -> Child:
    """The watchdog, with its own view of the rig."""
    target, settings = link
    arguments = [
        "rigctl.safety",
        "--run-dir", str(run_dir),
        "--limits", str(limits),
        "--journal", str(campaign / "journal.jsonl"),
        "--link", target,
        "--link-settings", json.dumps(dict(settings)),
        "--time", time,
    ]  # fmt: skip
    return Child("watchdog", arguments, campaign / "logs")


def start_recorder(run_dir: Path, campaign: Path) -> Child:
    """The recorder, owner of the files."""
    arguments = ["rigctl.recording", "--run-dir", str(run_dir), "--campaign", str(campaign)]
    return Child("recorder", arguments, campaign / "logs")


def start_controller(
    run_dir: Path, campaign: Path, attempt: int, done: Sequence[int], acknowledgement: str
) -> Child:
    """The controller, which opens the rig and runs the engine."""
    arguments = [
        "rigctl.app.controller",
        "--run-dir", str(run_dir),
        "--campaign", str(campaign),
        "--attempt", str(attempt),
        "--done", ",".join(map(str, done)),
        f"--acknowledge={acknowledgement}",
    ]  # fmt: skip
    return Child("controller", arguments, campaign / "logs")
