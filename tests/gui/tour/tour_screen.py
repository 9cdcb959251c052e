"""A screen in memory and a tour on it.

Job: start Xvfb and the tour's process, hand over what it says. Not its job: what the person does
(`tour_person`).
"""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rigctl.app.sessions import BASE_VARIABLE, FILE_NAME

HERE = Path(__file__).parent
MISSING = [tool for tool in ("Xvfb", "xdotool") if shutil.which(tool) is None]


@contextmanager
def screen(size: str = "1440x900x24") -> Iterator[str]:
    """A screen; its number is chosen by the server."""
    reading, writing = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", size, "-nolisten", "tcp"],
        pass_fds=[writing],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    with os.fdopen(reading) as told:
        number = told.readline().strip()
    try:
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()


def tour(display: str, *options: str, timeout_s: float) -> subprocess.CompletedProcess[str]:
    """Run `tour_person` on a screen; sessions of other people are not seen."""
    runs = tempfile.mkdtemp(prefix="rg", dir="/dev/shm" if Path("/dev/shm").is_dir() else None)
    environment = {**os.environ, "DISPLAY": display, "QT_QPA_PLATFORM": "xcb", BASE_VARIABLE: runs}
    try:
        return subprocess.run(
            [sys.executable, str(HERE / "tour_person.py"), *options],
            env=environment,
            capture_output=True,
            text=True,
            timeout=timeout_s,
            check=False,
        )
    finally:
        end_sessions(Path(runs))
        shutil.rmtree(runs, ignore_errors=True)


def end_sessions(runs: Path) -> None:
    """A tour that was cut short has left its session, which lives on by design."""
    for told in runs.glob(f"*/{FILE_NAME}"):
        with contextlib.suppress(ProcessLookupError):
            os.kill(json.loads(told.read_text())["pid"], signal.SIGTERM)
    deadline = time.monotonic() + 30.0
    while any(runs.iterdir()) and time.monotonic() < deadline:
        time.sleep(0.05)
