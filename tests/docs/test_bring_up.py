"""docs/how-to/bring-up-a-rig.md: its commands, run against a bench of their own."""

import json
import os
import re
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "how-to" / "bring-up-a-rig.md"
BLOCKS = re.findall(r"^```sh\n(.*?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)
NEEDED = ("pulseaudio",)


def multicast_is_possible() -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("239.74.163.2", 9))
        except OSError:
            return False
    return True


@pytest.fixture
def work(tmp_path: Path) -> Iterator[Path]:
    """A copy of the configuration with a bus of its own, and a bench that runs it."""
    missing = [name for name in NEEDED if shutil.which(name) is None]
    if missing or not multicast_is_possible():
        pytest.skip(f"the bench needs {', '.join(missing) or 'a route for multicast'}")
    shutil.copytree(ROOT / "configs", tmp_path / "configs")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        port = probe.getsockname()[1]
    for name in ("benches/a_class.toml", "rigs/bench.toml"):
        path = tmp_path / "configs" / name
        text, hits = re.subn(r"^port = 43113", f"port = {port}", path.read_text(), flags=re.MULTILINE)
        assert hits == 1
        path.write_text(text)
    bench = subprocess.Popen(
        [sys.executable, "-m", "sim_hardware.bench.process", "configs/benches/a_class.toml", "--seed", "1",
         "--folder", str(tmp_path / "ports")],
        cwd=tmp_path, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert bench.stdout is not None
        ready = json.loads(bench.stdout.readline())
        assert ready["m"] == "ready", ready
        yield tmp_path
    finally:
        bench.terminate()
        bench.communicate(timeout=30)


def rigctl(work: Path, tools: Path) -> dict[str, str]:
    tools.mkdir()
    (tools / "rigctl").write_text(f'#!/bin/sh\nexec {sys.executable} -m rigctl.app.cli "$@"\n')
    (tools / "rigctl").chmod(0o755)
    return {
        **os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "RIGCTL_BENCH_DIR": str(work / "ports"),
        "PYTHONPATH": str(ROOT), "COLUMNS": "200",
    }  # fmt: skip


@pytest.mark.slow
def test_the_commands_do_on_the_bench_what_the_page_says(work: Path):
    environment = rigctl(work, work / "tools")
    printed: list[str] = []
    for block in BLOCKS:
        done = subprocess.run(
            ["sh", "-ec", block],
            cwd=work,
            env=environment,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
        assert done.returncode == 0, f"{block}\n{done.stdout}\n{done.stderr}"
        assert "Traceback" not in done.stderr
        printed.append(done.stdout)
    listed, checked, tested, monitored = printed
    assert "bench:drive" in listed
    assert "The program can be run." in checked
    kinds = dict(drive="modbus", pressure="canopen", ventilator="canopen", acquisition="live", safety="can")
    for role, kind in kinds.items():
        assert re.search(rf"^{role} \({kind}\): (ok|warning)$", tested, re.MULTILINE), tested
        assert f"{role} ({kind})" in monitored
    assert "None failed" in tested
    assert re.search(r"actual pressure +-?\d", monitored)
    assert re.search(r"doors ok +yes", monitored)
