"""A real rig for the real watchdog: the bench's CANopen nodes, the watchdog process, a controller process.

The nodes and their bus are in the test's process, which has real-time priority where that is allowed; the
relay is judged by what the emulated node does, with the times at which it does it.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Self

import can

from drivers.safety_io.settings import SafetyIoSettings
from rigctl.core.journal import Record, read_journal, verify_journal
from rigctl.safety.limits import load_limits
from sim_hardware.bench.can import BenchCan, BenchCanSettings
from sim_hardware.bench.can.settings import AmplifierSettings, EncoderSettings
from sim_hardware.bench.signals import RigSignals

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
WAIT_S = 15.0
QUICK = {"edges = 20": "edges = 3"}
#: The wide windows, whatever priority the machine grants: the tests share it with others.
SLOW = {
    "heartbeat_s = 0.14": "heartbeat_s = 0.15",
    "sample_s = 0.18": "sample_s = 0.20",
}
SENSORS = (0x20, 0x21, 0x22)


def free_port() -> int:
    """A UDP port that nobody uses: parallel tests do not hear each other."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


def bus_table(port: int) -> dict[str, Any]:
    """Keys of `[buses.NAME]`."""
    return {
        "interface": "udp_multicast", "channel": "239.74.163.2", "port": port, "hop_limit": 0, "fd": False,
    }  # fmt: skip


class Signals(RigSignals):
    """Signals that remember when the relay opened and closed."""

    def __init__(self) -> None:
        super().__init__({"disc_temperature_degc": 60.0})
        self.relay_at_s: list[tuple[float, bool]] = []

    def set(self, **values: float | bool) -> None:
        closed = values.get("relay_closed")
        if closed is not None and bool(closed) != self.commands().relay_closed:
            self.relay_at_s.append((time.monotonic(), bool(closed)))
        super().set(**values)


class CanRig:
    """Nodes on a bus, with a plant that is alive (small unrest in every signal). A context manager."""

    def __init__(self) -> None:
        self.port = free_port()
        self.table = bus_table(self.port)
        self.signals = Signals()
        arguments = {key: value for key, value in self.table.items() if key != "interface"}
        self.bus = can.Bus(interface="udp_multicast", **arguments)
        settings = BenchCanSettings(
            amplifier=AmplifierSettings(tpdo_ms=4), encoder=EncoderSettings(tpdo_ms=4)
        )
        self.can = BenchCan(self.bus, self.signals, settings)
        self.plant = {"pressure_bar": 0.1, "torque_nm": 1.0, "speed_rpm": 0.2, "disc_temperature_degc": 60.0}
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._live, daemon=True)

    def _live(self) -> None:
        step = 0
        while not self._stop.wait(0.01):
            step += 1
            unrest = [((step * 10 + i) * 37 % 101) / 1000.0 for i in range(10)]
            samples = {name: [value + 3.0 * u for u in unrest] for name, value in self.plant.items()}
            self.signals.publish(time.monotonic_ns(), **samples)

    def __enter__(self) -> Self:
        # Threads and processes inherit it: a thread that waits for a processor with the interpreter's lock in
        # its hands would silence the nodes.
        with contextlib.suppress(OSError):
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(20))
        self.can.start()
        self.can.wait_booted()
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join(1.0)
        self.can.stop()
        self.bus.shutdown()
        with contextlib.suppress(OSError):
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))

    @property
    def relay(self) -> bool:
        """The contact."""
        return self.can.devices["safety_io"].closed  # type: ignore[attr-defined]

    def opened_after(self, since_s: float, timeout_s: float = 3.0) -> float:
        """Seconds from `since_s` until the relay opened."""
        deadline_s = time.monotonic() + timeout_s
        while time.monotonic() < deadline_s:
            opened = [t_s for t_s, closed in self.signals.relay_at_s if not closed and t_s >= since_s]
            if opened:
                return opened[0] - since_s
            time.sleep(0.002)
        raise AssertionError(f"the relay did not open: {self.signals.relay_at_s}")


class CanWatchdog:
    """Watchdog and controller processes on a `CanRig`. A context manager."""

    def __init__(self, rig: CanRig, *, edits: dict[str, str] | None = None) -> None:
        self.rig = rig
        self.folder = Path(tempfile.mkdtemp(prefix="wdcan", dir="/dev/shm"))
        self.limits_file = self.folder / "limits.toml"
        text = (ROOT / "configs" / "limits" / "a_class.toml").read_text(encoding="utf-8")
        for old, new in {**QUICK, **SLOW, **(edits or {})}.items():
            assert old in text
            text = text.replace(old, new)
        self.limits_file.write_text(text, encoding="utf-8")
        self.hash8 = load_limits(self.limits_file).hash8
        self.journal = self.folder / "journal.jsonl"
        self.processes: list[subprocess.Popen[str]] = []
        self.watchdog: subprocess.Popen[str] | None = None
        self.controller: subprocess.Popen[str] | None = None

    def link_settings(self) -> dict[str, Any]:
        """What `CanSafetyChannel.watchdog_link` gives, for nodes that nobody else starts."""
        channel = SafetyIoSettings(start_nodes=(0x30, *SENSORS)).to_mapping()
        return {"bus_name": "main", "bus": self.rig.table, "channel": channel}

    def start(self, *arguments: str) -> Self:
        """Start the watchdog."""
        self.watchdog = self._process(
            "-m", "rigctl.safety", "--run-dir", str(self.folder), "--time", "real",
            "--limits", str(self.limits_file), "--journal", str(self.journal),
            "--link", "drivers.safety_io.watchdog_link:CanSafetyLink",
            "--link-settings", json.dumps(self.link_settings()), "--linger", "0.3",
            "--safe-state-timeout", "2.0", "--connect-timeout", "10", *arguments,
        )  # fmt: skip
        return self

    def start_controller(self, first_k: int = 100_000) -> Self:
        """Start a controller, which asks for the relay."""
        socket_path = self.folder / "watchdog.sock"
        self.controller = self._process(
            str(HERE / "can_safety_controller.py"), str(socket_path), self.hash8, str(first_k)
        )
        return self

    def arm(self) -> Self:
        """Both processes, until the watchdog is armed."""
        self.start().start_controller()
        self.wait_for(lambda: "armed" in self.kinds(), "armed")
        time.sleep(0.2)
        assert self.rig.relay and "trip" not in self.kinds(), self.records()
        return self

    def _process(self, *arguments: str) -> subprocess.Popen[str]:
        log = (self.folder / f"log{len(self.processes)}").open("w")
        with log:
            process = subprocess.Popen(
                [sys.executable, *arguments], cwd=ROOT, stdout=log, stderr=log, text=True
            )
        self.processes.append(process)
        return process

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for process in self.processes:
            if process.poll() is None:
                process.send_signal(signal.SIGCONT)
                process.kill()
            process.wait(WAIT_S)
        shutil.rmtree(self.folder)

    def wait_for(self, condition: Callable[[], bool], words: str) -> None:
        """Wait until a condition holds."""
        deadline_s = time.monotonic() + WAIT_S
        while not condition():
            assert time.monotonic() < deadline_s, f"{words}: {self.records()} {self.logs()}"
            time.sleep(0.01)

    def logs(self) -> str:
        """What the processes have printed."""
        return "\n".join(path.read_text() for path in sorted(self.folder.glob("log*")))

    def records(self) -> list[Record]:
        """Journal of the watchdog as it is now."""
        if not self.journal.exists():
            return []
        return [record for record in read_journal(self.journal) if record.source == "watchdog"]

    def kinds(self) -> list[str]:
        """Kinds of all records."""
        return [record.kind for record in self.records()]

    def trip(self) -> dict[str, Any]:
        """The one trip in the journal, which must be whole."""
        self.wait_for(lambda: "trip" in self.kinds(), "trip")
        trips = [record for record in self.records() if record.kind == "trip"]
        assert len(trips) == 1, trips
        assert verify_journal(self.journal) == []
        payload = dict(trips[0].payload)
        assert payload["words"] and payload["remedy"] and payload["samples"]
        return payload
