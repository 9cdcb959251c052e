"""The guided tour: a person's path through the window under Xvfb, with mouse and keys of the X server.

Each tour is a process with a screen of its own; `tour_person` says what is done and what must be seen.
"""

import json
from pathlib import Path

import pytest
from tour_screen import MISSING, screen, tour


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)} (.ci/system-packages)")
@pytest.mark.parametrize("how", ["virtual", "real"])
def test_guided_tour(how: str, tmp_path: Path):
    pictures = tmp_path / "pictures"
    with screen() as display:
        where = ["--data", str(tmp_path / "data"), "--pictures", str(pictures)]
        done = tour(display, "--time", how, *where, timeout_s=580)
    assert done.returncode == 0, done.stderr[-4000:]
    assert "Traceback" not in done.stderr
    assert "QObject" not in done.stderr  # Qt's warnings
    told = json.loads(done.stdout.splitlines()[-1])
    print(told)
    assert (told["status"], told["note"]) == ("complete", "first try")
    if how == "real":  # in virtual time the braking is over before a person has found the key
        assert told["rating"] == 7
    assert len(list(pictures.glob("*.png"))) >= 12
