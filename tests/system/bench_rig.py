"""A bench as a process of its own and the rig file that fits it, for tests and benchmarks of the whole rig.

Job: `BenchProcess` in a folder and on a multicast port of its own, so that several run beside each other;
`rig_file` for it. Not its job: what is done with them.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

from sim_hardware.bench.commands import ask

ROOT = Path(__file__).resolve().parents[2]
START_TIMEOUT_S = 150.0  # the first start on a machine compiles the physics
SEED = 5


def free_port() -> int:
    """A UDP port that nobody uses now."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


def bench_missing() -> str:
    """What this machine lacks for a whole bench; empty when it has all."""
    if shutil.which("pulseaudio") is None:
        return "pulseaudio is not installed"
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("239.74.163.2", 9))
        except OSError as error:
            return f"no route for multicast: {error}"
    return ""


class BenchProcess:
    """A bench in a folder of its own, on a multicast port of its own.

    Parameters
    ----------
    folder : Path
        Its ports; short, since sockets lie in it. Its file is written beside it.
    port : int
        Of the multicast bus.
    path : str, optional
        PATH of the process.
    rate_hz : int
        Of the microphone.
    command : list of str, optional
        In place of ``python -m sim_hardware.bench.process``.
    """

    def __init__(
        self,
        folder: Path,
        port: int,
        path: str | None = None,
        *,
        rate_hz: int = 40_000,
        command: tuple[str, ...] = ("-m", "sim_hardware.bench.process"),
    ) -> None:
        self.folder, self.port, self.rate_hz = folder, port, rate_hz
        text = (ROOT / "configs/benches/a_class.toml").read_text()
        text = _changed(text, "port = 43113", f"port = {port}").replace('"../', f'"{ROOT}/configs/')
        text = _changed(text, "rate_hz = 40000", f"rate_hz = {rate_hz}")
        config = folder.parent / f"{folder.name}.toml"
        config.write_text(text)
        environment = {**os.environ, **({"PATH": path} if path is not None else {})}
        self.process = subprocess.Popen(
            [sys.executable, *command, str(config), "--seed", str(SEED), "--folder", str(folder)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, cwd=ROOT,
        )  # fmt: skip
        self.ready: dict[str, Any] = {}

    def wait_ready(self) -> BenchProcess:
        watchdog = threading.Timer(START_TIMEOUT_S, self.process.kill)
        watchdog.start()
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        watchdog.cancel()
        assert line, self.end()
        self.ready = json.loads(line)
        return self

    def ask(self, to: str, do: str, **fields: Any) -> dict[str, Any]:
        return ask(self.folder, {"to": to, "do": do, **fields})

    def status(self) -> dict[str, Any]:
        return self.ask("bench", "status")

    def end(self, number: int = signal.SIGTERM) -> str:
        """Returns what it has said on stderr."""
        self.process.send_signal(number)
        return self.process.communicate(timeout=20)[1]

    def rig_file(self, path: Path) -> Path:
        """configs/rigs/bench.toml for this bench. Its ports are found by RIGCTL_BENCH_DIR (`environment`)."""
        text = (ROOT / "configs/rigs/bench.toml").read_text()
        text = _changed(text, "port = 43113", f"port = {self.port}").replace('"../', f'"{ROOT}/configs/')
        path.write_text(_changed(text, "rate_hz = 40000", f"rate_hz = {self.rate_hz}"))
        return path

    def environment(self) -> dict[str, str]:
        """For processes that use the rig file."""
        return {**os.environ, "RIGCTL_BENCH_DIR": str(self.folder)}


def _changed(text: str, old: str, new: str) -> str:
    assert old in text, old
    return text.replace(old, new)
