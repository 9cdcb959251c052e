"""Sessions as processes of their own: started by the window, not owned by it.

Job: start `rigctl run`, `resume` or `manual` in a session of the operating system of its own, so that nothing
that happens to the window reaches it; keep what it prints. Not its job: following the run
(`rigctl.gui.rig.connection`).
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

LOG_FOLDER = ".sessions"
_ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


class Launch:
    """One started command. It lives on when this object or the window goes."""

    def __init__(self, arguments: Sequence[str], data: Path) -> None:
        folder = data / LOG_FOLDER
        folder.mkdir(parents=True, exist_ok=True)
        self.log_path = folder / f"{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}-{arguments[0]}.log"
        with self.log_path.open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "rigctl.app.cli", *arguments],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )

    @property
    def pid(self) -> int:
        """Process id of the supervisor."""
        return self._process.pid

    @property
    def ended(self) -> int | None:
        """Exit code; None while it runs."""
        return self._process.poll()

    def words(self, lines: int = 6) -> str:
        """The last lines it has printed, without the marks of a terminal."""
        try:
            text = self.log_path.read_text(errors="replace")
        except OSError:
            return ""
        kept = [line.strip() for line in _ESCAPES.sub("", text).splitlines() if line.strip()]
        return "\n".join(kept[-lines:])
