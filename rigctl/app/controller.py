"""The controller process: opens the rig and runs the engine. ``python -m rigctl.app.controller``.

Job: read the frozen campaign, connect watchdog, recorder and rig, run, and leave everything safe. Started
by `rigctl.app.supervisor`. Not its job: progress display, reports.
"""

from __future__ import annotations

import argparse
import gc
import getpass
import os
import signal
import sys
from pathlib import Path
from typing import Any

from rigctl.app.campaign_file import CampaignFile
from rigctl.app.compose import build_rig
from rigctl.app.control_socket import ControlServer
from rigctl.core.errors import RigctlError
from rigctl.core.journal import Journal
from rigctl.core.wire import connect
from rigctl.engine.engine import Engine
from rigctl.engine.guard import Guard
from rigctl.engine.manual import ManualEngine
from rigctl.engine.state import Outcome, RunResult, Verb
from rigctl.hal.devices import RigContext
from rigctl.hal.priority import CONTROLLER, raise_priority
from rigctl.hal.rig import Rig
from rigctl.recording.campaign import open_campaign
from rigctl.recording.client import RecorderClient

CONNECT_TIMEOUT_S = 60.0


class Controller:
    """One run: everything between connecting and leaving."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._run_dir: Path = options.run_dir
        self._campaign: Path = options.campaign
        self._file = CampaignFile.load(options.campaign)
        self._attempt: int = options.attempt
        self._reason: str = options.acknowledge
        self._done = frozenset(int(index) for index in options.done.split(",") if index)
        self._journal = Journal(options.campaign / "journal.jsonl", "controller")
        self._terminated = False
        self._stop_sent = False
        self._control = ControlServer(self._run_dir)

    def run(self) -> RunResult:
        """Run the campaign; the result has been told to the clients."""
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the supervisor's: it asks for a safe stop
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self._on_terminate)
        self._control.wait_for_client(CONNECT_TIMEOUT_S)
        try:
            result = self._run()
        except RigctlError as error:
            result = RunResult(Outcome.FAILED, 0, 0, cause=error.problem, remedy=error.remedy)
            self._journal.write("failed", error=str(error))
        self._journal.write("ended", rig_s=result.rig_s, outcome=result.outcome.value, done=result.done,
                            incomplete=result.incomplete, cause=result.cause)  # fmt: skip
        self._control.finish(result)
        self._control.close()
        self._journal.close()
        return result

    def _run(self) -> RunResult:
        file = self._file
        recorder = RecorderClient.connect(self._run_dir, CONNECT_TIMEOUT_S, **file.recorder_session())
        context = RigContext(
            run_dir=self._run_dir,
            time=file.time,
            seed=file.seed_of_attempt(self._attempt),
            place=str(self._campaign / "campaign.toml"),
            folder=self._campaign,
            log_dir=self._campaign / "logs",
            corrections=tuple(calibration.correction for calibration in file.calibrations),
        )
        rig = build_rig(file.rig, context)
        with rig:
            guard = self._connect_guard()
            self._journal.write("rig_opened", devices=rig.identities(), attempt=self._attempt)
            engine = self._engine(rig, guard, recorder)
            gc.collect()
            gc.freeze()
            if file.time == "real":
                granted = raise_priority([os.getpid()], CONTROLLER)
                self._journal.write("priority", granted=granted)
            result = engine.run()
            recorder.close()
            guard.close()
        return result

    def _engine(self, rig: Rig, guard: Guard, recorder: RecorderClient) -> Engine:
        program, done = self._file.program, self._done
        shared: dict[str, Any] = {
            "done": len(done),
            "verbs": self._next_verb,
            "report": self._control.tell,
            "acknowledgement": (getpass.getuser(), self._reason) if self._reason else None,
            "asks": self._control.take_asks,
            "watch": self._control.watch,
        }
        if program is None:
            files = open_campaign(self._campaign).braking_files()
            first_index = max((int(path.stem) for path in files), default=0) + 1
            return ManualEngine(
                rig, guard, recorder, self._journal, (), total=len(done), first_index=first_index,
                attended=lambda: self._control.attended, **shared,
            )  # fmt: skip
        brakings = (braking for braking in program.brakings() if braking.index not in done)
        return Engine(rig, guard, recorder, self._journal, brakings, total=program.count, **shared)

    def _connect_guard(self) -> Guard:
        """The watchdog listens once it has its own connection to the rig."""
        link = connect(self._run_dir / "watchdog.sock", CONNECT_TIMEOUT_S, "watchdog")
        guard = Guard(link, self._file.limits_hash8, lockstep=self._file.time == "virtual")
        guard.hello(run_id=self._campaign.name, pid=os.getpid(), campaign=str(self._campaign))
        return guard

    def _next_verb(self) -> Verb | None:
        verb = self._control.next_verb()
        if (self._terminated or self._control.deserted) and not self._stop_sent:
            # Nobody is left who could stop an unattended program: end it in an orderly way.
            self._stop_sent = True
            return Verb.END
        return verb

    def _on_terminate(self, number: int, frame: object) -> None:
        self._terminated = True


def main() -> None:
    """Entry of the process; the exit code says how the run ended."""
    parser = argparse.ArgumentParser(prog="rigctl controller", description=__doc__)
    parser.add_argument("--run-dir", type=Path, required=True)
    parser.add_argument("--campaign", type=Path, required=True)
    parser.add_argument("--attempt", type=int, default=0)
    parser.add_argument("--done", default="")
    parser.add_argument("--acknowledge", default="")
    result = Controller(parser.parse_args()).run()
    sys.exit(0 if result.outcome is Outcome.FINISHED else 1)


if __name__ == "__main__":
    main()
