"""Supervision of one run: start the processes, show progress, and know what to do when one of them dies.

Job: order of start and end; Ctrl-C becomes a safe stop; a dead or frozen controller is noticed, the
watchdog is given time to reach the safe state, and the run ends with what is known. Not its job: safety
(the watchdog needs nobody), the report.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from rigctl.app.campaign_file import CampaignFile
from rigctl.app.compose import build_rig
from rigctl.app.control_socket import SUPERVISOR, ControlClient
from rigctl.app.processes import (
    Child,
    share_processors,
    start_controller,
    start_recorder,
    start_watchdog,
)
from rigctl.app.sessions import announce, run_folder
from rigctl.core.errors import DeviceError, LinkClosed
from rigctl.core.journal import Journal, read_journal
from rigctl.engine.state import Outcome, Progress, RunResult, Verb
from rigctl.hal.devices import RigContext

START_TIMEOUT_S = 60.0
SILENCE_S = 8.0  # wall clock without news of the controller before we look at what the watchdog says
SAFE_STATE_S = 30.0  # for watchdog and rig to come to the safe state after the controller has died
RECORDER_GRACE_S = 60.0


class Supervisor:
    """Runs the processes of one campaign.

    Parameters
    ----------
    campaign : Path
        Folder, made already, with `campaign.toml` written.
    attempt : int
        0 for the first run, 1, 2 … for resumed ones.
    done : list of int
        Brakings that are complete already.
    acknowledgement : str
        A person's reason for going on after a safety trip; empty when there was none.
    show : callable
        Called with each progress.
    say : callable
        Called with one line of news for the person.
    """

    def __init__(
        self,
        campaign: Path,
        file: CampaignFile,
        *,
        attempt: int,
        done: list[int],
        acknowledgement: str,
        show: Callable[[Progress], None],
        say: Callable[[str], None],
    ) -> None:
        self._campaign = campaign
        self._file = file
        self._attempt = attempt
        self._done = done
        self._acknowledgement = acknowledgement
        self._show = show
        self._say = say
        self._stop_asked = 0
        self._stop_sent = False
        self._progress = Progress(total=file.count, done=len(done), mode=file.mode)

    def run(self) -> RunResult:
        """Start everything, wait for the end, leave nothing running."""
        journal = Journal(self._campaign / "journal.jsonl", "supervisor")
        (self._campaign / "logs").mkdir(exist_ok=True)
        with run_folder() as run_dir, self._signals():
            children: list[Child] = []
            try:
                result = self._run(run_dir, children, journal)
            finally:
                for child in children:
                    child.end(grace_s=RECORDER_GRACE_S if child.name == "recorder" else 10.0)
        journal.write("run_ended", outcome=result.outcome.value, done=result.done, cause=result.cause)
        journal.close()
        return result

    def _run(self, run_dir: Path, children: list[Child], journal: Journal) -> RunResult:
        file = self._file
        context = RigContext(run_dir, file.time, file.seed, "campaign.toml", self._campaign)
        link = build_rig(file.rig, context).safety.watchdog_link()
        controller = start_controller(
            run_dir, self._campaign, self._attempt, self._done, self._acknowledgement
        )
        watchdog = start_watchdog(run_dir, self._campaign, file.limits_path(self._campaign), link, file.time)
        recorder = start_recorder(run_dir, self._campaign)
        children += [controller, watchdog, recorder]
        if file.time == "virtual":
            share_processors(lockstep=[controller, watchdog], others=[recorder])
        journal.write(
            "run_started",
            attempt=self._attempt,
            seed=file.seed_of_attempt(self._attempt),
            pids={child.name: child.pid for child in children},
        )
        client = self._connect(run_dir, controller)
        announce(run_dir, self._campaign)
        try:
            result = self._follow(client, controller)
        finally:
            client.close()
        if result is None:
            return self._after_death(controller, watchdog)
        controller.end(grace_s=30.0)
        return result

    def _connect(self, run_dir: Path, controller: Child) -> ControlClient:
        deadline = time.monotonic() + START_TIMEOUT_S
        while True:
            try:
                return ControlClient(run_dir, 0.2, who="rigctl", role=SUPERVISOR)
            except DeviceError:
                if controller.returncode is not None or time.monotonic() > deadline:
                    raise DeviceError(
                        f"{controller.describe_end()} before it could be reached.",
                        place="controller",
                        remedy=f"Its log is {controller.log_path}:\n{controller.last_words()}",
                    ) from None

    def _follow(self, client: ControlClient, controller: Child) -> RunResult | None:
        """Show progress until the result comes; None when the controller died or froze without one."""
        last_news = time.monotonic()
        while True:
            if self._stop_asked and not self._stop_sent:
                self._stop_sent = True
                client.send(Verb.END)
                self._say("Stopping safely: releasing pressure, stopping the disc …")
            try:
                news = client.recv(0.25)
            except LinkClosed:
                return None
            if isinstance(news, RunResult):
                return news
            if news is not None:
                last_news = time.monotonic()
            if isinstance(news, Progress):
                self._progress = news
                self._show(news)
            elif news is None and time.monotonic() - last_news > SILENCE_S and self._watchdog_tripped():
                self._say("The controller does not answer; the watchdog has tripped.")
                self._wait_for_safe_state()
                controller.kill()
                return None

    # -- when the controller is gone --------------------------------------------------------------

    def _after_death(self, controller: Child, watchdog: Child) -> RunResult:
        controller.wait(5.0)
        cause = controller.describe_end()
        self._say(f"{cause[:1].upper()}{cause[1:]}. Waiting for the safe state …")
        watchdog.wait(SAFE_STATE_S)
        trip = self._records("trip")
        safe = self._records("safe_state_reached")
        state = "the rig is in the safe state" if safe else "the safe state has not been confirmed"
        if trip:
            cause = f"{cause}; the watchdog tripped ({trip[-1].payload.get('cause', 'no cause given')})"
        outcome = Outcome.TRIPPED if trip else Outcome.FAILED
        return RunResult(
            outcome,
            self._progress.done,
            self._progress.total,
            rig_s=self._progress.rig_s,
            cause=f"{cause}; {state}",
            remedy=f"See {controller.log_path}.",
        )

    def _watchdog_tripped(self) -> bool:
        return bool(self._records("trip"))

    def _wait_for_safe_state(self) -> None:
        deadline = time.monotonic() + SAFE_STATE_S
        while not self._records("safe_state_reached") and time.monotonic() < deadline:
            time.sleep(0.1)

    def _records(self, kind: str) -> list:
        """Records of the watchdog since this run has started."""
        records = list(read_journal(self._campaign / "journal.jsonl"))
        starts = [i for i, record in enumerate(records) if record.kind == "run_started"]
        return [
            record
            for record in records[starts[-1] if starts else 0 :]
            if record.source == "watchdog" and record.kind == kind
        ]

    # -- signals ----------------------------------------------------------------------------------

    @contextmanager
    def _signals(self) -> Iterator[None]:
        def ask(number: int, frame: FrameType | None) -> None:
            self._stop_asked += 1
            if self._stop_asked > 1:
                self._say("Already stopping. If the rig itself is in danger, use the emergency stop.")

        before = {
            number: signal.signal(number, ask) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
        }
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
