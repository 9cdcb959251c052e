"""The guided tour: a person's path through the window under Xvfb, with mouse and keys of the X server.

Each tour is a process with a screen of its own; `tour_person` says what is done and what must be seen.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from rigctl.app.sessions import BASE_VARIABLE

HERE = Path(__file__).parent
MISSING = [tool for tool in ("Xvfb", "xdotool") if shutil.which(tool) is None]


@pytest.fixture
def screen() -> Iterator[str]:
    """A screen in memory; its number is chosen by the server."""
    reading, writing = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1440x900x24", "-nolisten", "tcp"],
        pass_fds=[writing],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    with os.fdopen(reading) as told:
        number = told.readline().strip()
    yield f":{number}"
    server.terminate()
    server.wait()


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)} (.ci/system-packages)")
@pytest.mark.parametrize("how", ["virtual", "real"])
def test_guided_tour(how: str, screen: str, tmp_path: Path):
    runs = tempfile.mkdtemp(prefix="rg", dir="/dev/shm" if Path("/dev/shm").is_dir() else None)
    environment = {**os.environ, "DISPLAY": screen, "QT_QPA_PLATFORM": "xcb", BASE_VARIABLE: runs}
    pictures = tmp_path / "pictures"
    done = subprocess.run(
        [sys.executable, str(HERE / "tour_person.py"), "--time", how, "--data", str(tmp_path / "data"),
         "--pictures", str(pictures)],
        env=environment, capture_output=True, text=True, timeout=580, check=False,
    )  # fmt: skip
    shutil.rmtree(runs, ignore_errors=True)
    assert done.returncode == 0, done.stderr[-4000:]
    assert "Traceback" not in done.stderr
    assert "QObject" not in done.stderr  # Qt's warnings
    told = json.loads(done.stdout.splitlines()[-1])
    print(told)
    assert (told["status"], told["note"]) == ("complete", "first try")
    if how == "real":  # in virtual time the braking is over before a person has found the key
        assert told["rating"] == 7
    assert len(list(pictures.glob("*.png"))) >= 12
