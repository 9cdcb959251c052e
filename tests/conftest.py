"""What all tests share: the shipped configuration, and a way to start `rigctl` as a user would."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from rigctl.core.journal import Record, read_journal

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy comes later; pytest itself uses all processors

ROOT = Path(__file__).resolve().parents[1]

PROGRAM = """
format = 1
name = "short"

[[sequences]]
name = "drag"
role = "check"
speed_profiles = [{{ duration_s = {duration_s}, start_rpm = 40.0, end_rpm = 40.0 }}]
pressures_bar = {pressures}
temperatures_degc = {temperatures}
conditioning = {{ tolerance_k = 10.0, soak_s = 0.0, timeout_s = 600.0 }}
limits = {{ max_degc = 480.0, cool_down_degc = 400.0 }}

[sequences.recording]
sampling_hz = 40000
channels = [
    {{ name = "microphone" }}, {{ name = "torque", decimation = 40 }}, {{ name = "speed", decimation = 40 }},
    {{ name = "pressure", decimation = 40 }}, {{ name = "disc_temperature", decimation = 40 }},
]
"""


class Cli:
    """Starts the command line in a folder of its own."""

    def __init__(self, folder: Path, configs: Path) -> None:
        self.folder = folder
        self.configs = configs
        self.rig = configs / "rigs" / "simulated.toml"
        self.started: list[subprocess.Popen[str]] = []

    def program(self, *, pressures: list[float], temperatures: list[float], duration_s: float = 1.0) -> Path:
        path = self.folder / "program.toml"
        path.write_text(
            PROGRAM.format(pressures=pressures, temperatures=temperatures, duration_s=float(duration_s))
        )
        return path

    def edited_config(self, name: str, *changes: tuple[str, str]) -> Path:
        """A shipped configuration with lines changed; every change must hit."""
        text = (self.configs / name).read_text()
        for pattern, replacement in changes:
            text, hits = re.subn(pattern, replacement, text, flags=re.MULTILINE)
            assert hits >= 1, pattern
        text = text.replace('"../', f'"{self.configs}/')
        path = self.folder / Path(name).name
        path.write_text(text)
        return path

    def start(self, *arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-m", "rigctl.app.cli", *map(str, arguments)],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "COLUMNS": "200"},
        )
        self.started.append(process)
        return process

    def run(self, *arguments: object, timeout_s: float = 120.0) -> tuple[int, str]:
        process = self.start(*arguments)
        text, _ = process.communicate(timeout=timeout_s)
        return process.returncode, text

    def start_run(self, program: Path, name: str, *arguments: object) -> subprocess.Popen[str]:
        return self.start(
            "run", program, "--rig", self.rig, "--out", self.folder, "--name", name, "--seed", 1,
            "--no-report", *arguments,
        )  # fmt: skip

    def records(self, name: str) -> list[Record]:
        path = self.folder / name / "journal.jsonl"
        return list(read_journal(path)) if path.exists() else []

    def wait_for(self, name: str, condition: Callable[[Record], bool], timeout_s: float = 90.0) -> Record:
        """Wait until the journal of a campaign has such a record."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            for record in self.records(name):
                if condition(record):
                    return record
            time.sleep(0.02)
        raise AssertionError(
            f"not in the journal within {timeout_s} s: {[r.kind for r in self.records(name)]}"
        )

    def pid_of(self, name: str, process: str) -> int:
        record = self.wait_for(name, lambda r: r.kind == "run_started")
        return int(record.payload["pids"][process])

    def logs(self, name: str) -> str:
        return "\n".join(
            f"== {path.name}\n{path.read_text()}" for path in sorted((self.folder / name / "logs").glob("*"))
        )


@pytest.fixture(scope="session")
def configs() -> Path:
    """Folder of the shipped configuration files."""
    return ROOT / "configs"


@pytest.fixture
def cli(tmp_path: Path, configs: Path) -> Iterator[Cli]:
    cli = Cli(tmp_path, configs)
    yield cli
    for process in cli.started:
        if process.poll() is None:
            process.send_signal(signal.SIGKILL)
        process.wait()
        if process.stdout is not None:
            process.stdout.close()
