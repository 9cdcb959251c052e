"""Sessions as processes of their own: started by the window, not owned by it.

Job: start `rigctl run`, `resume` or `manual` detached from the window, so that nothing that happens to the
window reaches it; keep what it prints; know when it has ended. Not its job: following the run
(`rigctl.gui.rig.connection`).
"""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Sequence
from pathlib import Path

LOG_FOLDER = ".sessions"
_ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


class Launch:
    """One started command. It lives on when this object or the window goes.

    Raises
    ------
    OSError
        It cannot be started, or its log cannot be written.
    """

    def __init__(self, arguments: Sequence[str], data: Path) -> None:
        folder = data / LOG_FOLDER
        folder.mkdir(parents=True, exist_ok=True)
        self.log_path = folder / f"{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}-{arguments[0]}.log"
        log = os.open(self.log_path, os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o644)
        try:
            # Not subprocess: its object would want to see the end of a process that outlives the window.
            self.pid = os.posix_spawn(
                sys.executable,
                [sys.executable, "-m", "rigctl.app.cli", *arguments],
                os.environ,
                file_actions=[
                    (os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0),
                    (os.POSIX_SPAWN_DUP2, log, 1),
                    (os.POSIX_SPAWN_DUP2, log, 2),
                ],
                setsid=True,
            )
        finally:
            os.close(log)
        self._ended = False

    @property
    def ended(self) -> bool:
        """True when it has ended."""
        if not self._ended:
            try:
                self._ended = os.waitpid(self.pid, os.WNOHANG)[0] == self.pid
            except ChildProcessError:
                self._ended = True
        return self._ended

    def words(self, lines: int = 6) -> str:
        """The last lines it has printed, without the marks of a terminal."""
        try:
            text = self.log_path.read_text(errors="replace")
        except OSError:
            return ""
        kept = [line.strip() for line in _ESCAPES.sub("", text).splitlines() if line.strip()]
        return "\n".join(kept[-lines:])
