"""Bench for the real watchdog process: a fake rig and a controller, block by block, under the test's hand."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from rigctl.core.journal import Record, read_journal, verify_journal
from rigctl.core.wire import Link, Listener, connect
from rigctl.safety.heartbeat import CHECKPOINTS, answer_to
from rigctl.safety.limits import load_limits

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SHIPPED_LIMITS = ROOT / "configs" / "limits" / "a_class.toml"
QUICK = {
    "heartbeat_s = 3.0": "heartbeat_s = 0.3",
    "sample_s = 8.0": "sample_s = 0.6",
    "edges = 20": "edges = 3",
}
WAIT_S = 10.0


class Bench:
    """One watchdog process. Use as a context manager.

    The controller is the test itself, or a process of its own (`own_process`), which may be killed.
    """

    def __init__(
        self, *, own_process: bool = False, clock: str = "virtual", edits: Mapping[str, str] | None = None
    ) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="wd", dir="/dev/shm"))
        self.limits_file = self.folder / "limits.toml"
        text = SHIPPED_LIMITS.read_text(encoding="utf-8")
        for old, new in {**QUICK, **(edits or {})}.items():
            assert old in text
            text = text.replace(old, new)
        self.limits_file.write_text(text, encoding="utf-8")
        self.hash8 = load_limits(self.limits_file).hash8
        self.journal = self.folder / "journal.jsonl"
        self.socket = self.folder / "watchdog.sock"
        self.own_process = own_process
        self.clock = clock
        self.rig: Link | None = None
        self.controller: Link | None = None
        self.process: subprocess.Popen[str] | None = None
        self.child: subprocess.Popen[str] | None = None
        self.k = -1
        self.nonce = 0
        self.relay = False
        self.open_reason = ""
        self.status: dict[str, Any] = {}
        self.plant = {"p": 0.0, "n": 0.0, "M": 0.0, "T": 25.0}

    # -- processes ------------------------------------------------------------------------------

    def start(
        self, *arguments: str, controller: bool = True, extra_env: Mapping[str, str] | None = None
    ) -> Self:
        """Start the watchdog, be its rig, connect the controller."""
        listener = Listener(self.folder / "rig.sock")
        settings = json.dumps({"socket": str(self.folder / "rig.sock")})
        command = [
            sys.executable, "-m", "rigctl.safety", "--run-dir", str(self.folder), "--time", self.clock,
            "--limits", str(self.limits_file), "--journal", str(self.journal),
            "--link", "watchdog_link:FakeSafetyLink", "--link-settings", settings,
            "--linger", "0.3", "--safe-state-timeout", "0.5", *arguments,
        ]  # fmt: skip
        environment = {**os.environ, "PYTHONPATH": str(HERE), **(extra_env or {})}
        self.process = subprocess.Popen(
            command, cwd=ROOT, env=environment, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.rig = listener.accept(WAIT_S)
        listener.close()
        assert self.rig is not None, self.process.communicate(timeout=1)
        if controller:
            self.connect_controller()
        return self

    def connect_controller(self) -> None:
        """The test's own link, or a child process."""
        if self.own_process:
            self.child = subprocess.Popen(
                [sys.executable, str(HERE / "watchdog_controller.py"), str(self.socket), self.hash8],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT,
            )  # fmt: skip
            assert self.child.stdout is not None
            assert self.child.stdout.readline() == "ready\n"
        else:
            self.controller = connect(self.socket, WAIT_S)
            self.controller.send({"m": "hello", "run_id": "test", "pid": os.getpid(), "campaign": "test"})

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for process in (self.child, self.process):
            if process is not None:
                if process.poll() is None:
                    process.send_signal(signal.SIGCONT)
                    process.kill()
                process.wait(WAIT_S)
                for stream in (process.stdin, process.stdout, process.stderr):
                    if stream is not None:
                        stream.close()
        for link in (self.rig, self.controller):
            if link is not None:
                link.close()
        shutil.rmtree(self.folder)

    # -- controller -----------------------------------------------------------------------------

    def tell(self, line: str) -> None:
        """Command to the controller process; waits until it is done."""
        assert self.child is not None and self.child.stdin is not None and self.child.stdout is not None
        self.child.stdin.write(line + "\n")
        self.child.stdin.flush()
        assert self.child.stdout.readline() == "done\n"

    def say(self, kind: str, **payload: Any) -> None:
        """Message of the controller."""
        if self.child is not None:
            self.tell(kind)
        else:
            assert self.controller is not None
            self.controller.send({"m": kind, **payload})

    def heartbeat(self, **changes: Any) -> None:
        """Heartbeat for the newest block."""
        if self.child is not None:
            self.tell(f"block {self.k}")
            return
        mask = changes.get("mask", CHECKPOINTS)
        k = changes.get("k", self.k)
        message = {
            "k": k, "mask": mask, "answer": answer_to(self.nonce, k, mask, self.hash8), "limits": self.hash8,
            "set": {"p": 0.0, "n": 0.0, "enable": False},
        }  # fmt: skip
        self.say("hb", **{**message, **changes})

    def read_status(self) -> None:
        """The newest status."""
        if self.controller is not None:
            for status in self.controller.drain():
                self.status = status
                self.nonce = status["nonce"]

    # -- rig ------------------------------------------------------------------------------------

    def sample(self, **changes: Any) -> None:
        """Compute one block of the plant and send the sample."""
        assert self.rig is not None
        self.k += 1
        if not self.relay:  # torque off, vented
            self.plant["n"] = max(0.0, self.plant["n"] - 40.0)
            self.plant["p"] *= 0.3
        unrest = [((self.k * 5 + i) * 37 % 101) / 1000.0 for i in range(5)]
        plant = self.plant
        message = {
            "k": self.k, "t_s": (self.k + 1) * 0.05, "dt_s": 0.05,
            "pressure_bar": [plant["p"] + u for u in unrest], "speed_rpm": [plant["n"] + u for u in unrest],
            "torque_nm": [plant["M"] + u for u in unrest],
            "temperature_degc": [plant["T"] + u for u in unrest],
            "relay_closed": self.relay, "drive_enabled": self.relay, "estop_ok": True, "doors_ok": True,
        }  # fmt: skip
        self.rig.send({**message, **changes})

    def answer(self, timeout_s: float = WAIT_S) -> dict[str, Any]:
        """The watchdog's next word to the rig; the relay follows it."""
        assert self.rig is not None
        message = self.rig.recv(timeout_s)
        assert message is not None, "no answer"
        if message["m"] in ("open", "close"):
            self.relay = message["m"] == "close"
            self.open_reason = message.get("reason", "")
        return message

    def block(self, *, beat: bool = True, **changes: Any) -> str:
        """Heartbeat for the block before, sample, answer, status."""
        if beat and self.k >= 0:
            self.heartbeat()
        self.sample(**changes)
        message = self.answer()
        if message["m"] == "open" and message["k"] != self.k:  # opened before this sample was seen
            assert self.answer()["k"] == self.k
        self.read_status()
        return message["m"]

    def blocks(self, count: int, **changes: Any) -> str:
        """Several blocks; the last answer."""
        word = ""
        for _ in range(count):
            word = self.block(**changes)
        return word

    def arm(self) -> Self:
        """The whole handshake."""
        self.say("arm")
        for _ in range(40):
            self.block()
            if self.relay and (self.child is not None or self.status["state"] == "armed"):
                break
        assert self.relay, self.records()
        self.blocks(5)
        return self

    # -- what happened --------------------------------------------------------------------------

    def ended(self) -> int:
        """Exit code of the watchdog."""
        assert self.process is not None
        return self.process.wait(WAIT_S)

    def records(self) -> list[Record]:
        """Journal of the watchdog as it is now."""
        return [record for record in read_journal(self.journal) if record.source == "watchdog"]

    def record(self, kind: str) -> Record:
        """The one record of a kind. The watchdog writes behind its answers, so wait for it."""
        deadline_s = time.monotonic() + WAIT_S
        while not (found := [record for record in self.records() if record.kind == kind]):
            assert time.monotonic() < deadline_s, self.kinds()
            time.sleep(0.005)
        assert len(found) == 1, self.kinds()
        assert verify_journal(self.journal) == []
        return found[0]

    def kinds(self) -> list[str]:
        """Kinds of all records."""
        return [record.kind for record in self.records()]
