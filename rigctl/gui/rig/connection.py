"""The window's one connection to a controller: signals for what comes, methods for what a person asks.

Job: find running sessions, watch one, start new ones as processes of their own, send commands. Everything is
asked of the controller, which decides; a refusal comes back as `refused` with the reason. When the controller
goes without a word, the journal says what has happened. Not its job: samples (`rigctl.gui.live`), words for
the state (`rigctl.gui.rig.fold`).
"""

from __future__ import annotations

import getpass
import os
import shutil
import time as clock
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QSocketNotifier, QTimer, Signal

from rigctl.app.control_socket import COMMAND, Answer, Blocks, Commander, ControlClient
from rigctl.app.pace import Pace
from rigctl.app.sessions import Session, alive, running_sessions
from rigctl.core.errors import ConfigError, DeviceError, LinkClosed
from rigctl.core.journal import Journal, Record
from rigctl.engine.state import Progress, RunResult, Verb
from rigctl.gui.rig.fold import after_loss, after_result, with_progress, with_record
from rigctl.gui.rig.journal_tail import JournalTail
from rigctl.gui.rig.launch import Launch
from rigctl.gui.rig.phases import said
from rigctl.gui.rig.state import RigState, Word

LOOK_MS = 300  # how often new sessions, journal and started commands are looked at
DISK_EVERY_S = 5.0
CONNECT_TIMEOUT_S = 0.3
SILENT_S = 3.0
TURN_S = 0.012  # for messages of the controller in one turn of the event loop; the rest waits for the next


class RigConnection(QObject):
    """Signals and commands of the rig.

    Parameters
    ----------
    data : Path
        Folder of new campaigns.
    """

    stateChanged = Signal(object)
    """RigState, at most ten times a second and with every change of its word."""
    recordsAdded = Signal(list)
    """Newly read records of the campaign's journal (`rigctl.core.journal.Record`); first all."""
    attached = Signal(object)
    """`rigctl.app.sessions.Session` that the window watches now."""
    detached = Signal(str)
    """It has ended or gone; why."""
    refused = Signal(str)
    """The controller or this window refused something; why."""
    blocksArrived = Signal(list)
    """Blocks since the last time, for live plots: t_ns, dt_ns, stride and ranges of each (as `Block`)."""

    def __init__(self, data: Path = Path("data"), parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.state = RigState()
        self.session: Session | None = None
        """Session that is watched, as `attached` gave it; pages that are made later look here."""
        self.records: list[Record] = []
        """All records of its journal so far."""
        self._data = data
        self._who = f"{getpass.getuser()} (window {os.getpid()})"
        self._client: ControlClient | None = None
        self._notifier: QSocketNotifier | None = None
        self._tail: JournalTail | None = None
        self._pace: Pace | None = None
        self._blocks: list[Mapping[str, Any]] = []
        self._result: RunResult | None = None
        self._lost = self._safe = False
        self._launch: Launch | None = None
        self._heard_at = 0.0
        self._disk_at = 0.0
        self._ended: set[Path] = set()
        self._timer = QTimer(self)
        self._timer.setInterval(LOOK_MS)
        self._timer.timeout.connect(self._look)

    def start(self) -> None:
        """Begin to look for sessions; one that runs is attached before this returns."""
        self._look()
        self._timer.start()

    # -- sessions ---------------------------------------------------------------------------------

    def sessions(self) -> list[Session]:
        """What runs on this machine."""
        return running_sessions()

    def start_manual(self, rig: Path, *, time: str = "real", seed: int | None = None) -> None:
        """Start a controller for manual brakings on a rig, and watch it."""
        self._start(["manual", "--rig", str(rig), "--time", time, *_seed(seed)])

    def start_program(
        self, program: Path, rig: Path, *, time: str | None = None, seed: int | None = None
    ) -> None:
        """Start a program run (`rigctl run`), and watch it."""
        how = [] if time is None else ["--time", time]
        self._start(["run", str(program), "--rig", str(rig), *how, *_seed(seed)])

    def resume(self, campaign: Path, reason: str) -> None:
        """Go on with a campaign (`rigctl resume --acknowledge REASON`)."""
        word = [f"--acknowledge={reason}"] if reason else []
        self._ended.discard(campaign)
        self._start(["resume", str(campaign), *word], out=False)

    def _start(self, arguments: list[str], *, out: bool = True) -> None:
        if self._client is not None:
            self.refused.emit(self.tr("A session is running already. End it first."))
            return
        if out:
            arguments = [*arguments, "--out", str(self._data)]
        try:
            self._launch = Launch(arguments, self._data)
        except OSError as error:
            self.refused.emit(self.tr("The session cannot be started: {0}").format(error))
            return
        self.session, self._tail, self._result, self.records = None, None, None, []
        self._lost = False
        self._set(RigState(word=Word.STARTING, phase=self.tr("starting …")))

    def watch(self, session: Session) -> None:
        """Watch this session; the one watched before goes on by itself."""
        self._leave()
        try:
            rig = session.rig
            client = ControlClient(session.run_dir, CONNECT_TIMEOUT_S, who=self._who, role=COMMAND)
            client.subscribe()
        except (ConfigError, DeviceError) as error:
            self._ended.add(session.run_dir)
            self.refused.emit(str(error))
            return
        self.session, self._client, self._blocks = session, client, []
        self._result, self._lost, self._safe = None, False, False
        self._pace = Pace(session.program, rig.capabilities) if session.program is not None else None
        self._heard_at, self._disk_at = clock.monotonic(), 0.0
        self._tail = JournalTail(session.campaign / "journal.jsonl")
        self.records = []
        self.state = RigState(
            word=Word.STARTING, mode=session.mode, campaign=session.campaign, rig_name=rig.name,
            simulated=session.simulated, time=session.time,
        )  # fmt: skip
        self._notifier = QSocketNotifier(client.fileno(), QSocketNotifier.Type.Read, self)
        self._notifier.activated.connect(self._read)
        self.attached.emit(session)
        self._read_journal()
        self._read()
        self._set(self.state)

    def _leave(self) -> None:
        if self._notifier is not None:
            self._notifier.setEnabled(False)
            self._notifier.deleteLater()
            self._notifier = None
        if self._client is not None:
            self._client.close()
            self._client = None

    # -- looking ----------------------------------------------------------------------------------

    def _look(self) -> None:
        self._look_at_launch()
        if self._client is None:
            self._look_for_session()
        elif clock.monotonic() - self._heard_at > SILENT_S:
            seconds = clock.monotonic() - self._heard_at
            words = self.tr("no news of the controller for {0} s").format(f"{seconds:.0f}")
            self._set(replace(self.state, phase=words))
        self._read_journal()
        self._look_at_disk()

    def _look_for_session(self) -> None:
        sessions = [s for s in running_sessions() if s.run_dir not in self._ended]
        if self._launch is not None:
            sessions = [s for s in sessions if s.pid == self._launch.pid]
        if sessions:
            self.watch(sessions[-1])

    def _look_at_launch(self) -> None:
        """What was started says by its output what is wrong, when it ends before it can be watched."""
        launch = self._launch
        if launch is None:
            return
        if not launch.ended:
            if self._client is None and self.session is None and (words := launch.words(1)):
                self._set(replace(self.state, phase=words))
            return
        self._launch = None
        if self.session is None:
            self._set(RigState())
            self.refused.emit(launch.words() or self.tr("The session has ended at once, without a word."))

    def _look_at_disk(self) -> None:
        now = clock.monotonic()
        if self.session is None or now - self._disk_at < DISK_EVERY_S:
            return
        self._disk_at = now
        try:
            free = float(shutil.disk_usage(self.session.campaign).free)
        except OSError:
            return  # the folder is gone; the recorder is the one who says so
        self._set(replace(self.state, disk_left_bytes=free))

    def _read_journal(self) -> None:
        if self._tail is None:
            return
        records = self._tail.read()
        if not records:
            if self._lost and self.session is not None and not alive(self.session):
                self._over(self.tr("The session has ended after its controller had gone."))
            return
        state = self.state
        for record in records:
            state = with_record(state, record)
            if record.kind == "run_started":
                self._safe = False
            elif record.kind == "safe_state_reached":
                self._safe = True
        if self._lost:
            state = after_loss(state, safe=self._safe)
        self.state = state
        self.records.extend(records)
        self.recordsAdded.emit(records)
        self._set(state)

    # -- news of the controller -------------------------------------------------------------------

    def _read(self) -> None:
        """Messages that have come; those about blocks are passed on together: samples are read once."""
        self._take_waiting()
        blocks, self._blocks = self._blocks, []
        if blocks:
            self.blocksArrived.emit(blocks)

    def _take_waiting(self) -> None:
        until = clock.monotonic() + TURN_S
        while self._client is not None:
            try:
                news = self._client.recv(0)
            except LinkClosed:
                self._gone()
                return
            except DeviceError as error:
                self.refused.emit(str(error))
                return
            if news is None:
                return
            self._heard_at = clock.monotonic()
            self._take(news)
            if clock.monotonic() > until:
                return

    def _take(self, news: object) -> None:
        if isinstance(news, Progress):
            left_s = self._pace.left_s(news) if self._pace is not None else None
            self._set(with_progress(self.state, news, left_s))
        elif isinstance(news, Blocks):
            self._blocks += news.blocks
        elif isinstance(news, Commander):
            self._set(replace(self.state, commander=news.who, commanding=news.you))
        elif isinstance(news, Answer) and news.reason:
            self.refused.emit(" ".join(said(part) for part in (_sentence(news.reason), news.remedy) if part))
        elif isinstance(news, RunResult):
            self._result = news
            self._set(after_result(self.state, news))

    def _gone(self) -> None:
        """The link is closed: at the end of the session, or because the controller has died."""
        self._leave()
        self._read_journal()
        if self._result is not None:
            self._over(self.tr("The session has ended: {0}.").format(self._result.outcome.value))
            return
        self._lost = True
        self._set(after_loss(self.state, safe=self._safe))

    def _over(self, why: str) -> None:
        self._lost = False
        if self.session is not None:
            self._ended.add(self.session.run_dir)
        self._read_journal()
        self.detached.emit(why)

    def _set(self, state: RigState) -> None:
        self.state = state
        self.stateChanged.emit(state)

    # -- commands: any of them may be refused ------------------------------------------------------

    def stop(self) -> None:
        """Software stop: from anybody, at any time."""
        if self._client is None:
            self.refused.emit(self.tr("No controller is connected. In danger use the emergency stop."))
            return
        self._say(lambda client: client.send(Verb.STOP))

    def verb(self, verb: Verb) -> None:
        """Pause, hold, resume, skip, repeat, stop the program, or end a manual session."""
        self._say(lambda client: client.send(verb))

    def end_session(self) -> None:
        """Manual: run down and end the session."""
        self.verb(Verb.END)

    def take_command(self) -> None:
        """Command from this window from now on; whoever had it is told."""
        self._say(lambda client: client.take())

    def enable(self) -> None:
        """Manual: arm the watchdog and allow torque and pressure. The page has asked the person."""
        self._command("enable")

    def disable(self) -> None:
        """Manual: release, run down, open the relay."""
        self._command("disable")

    def set_speed(self, speed_rpm: float, ramp_rpm_per_s: float) -> None:
        """Manual: go to a speed."""
        self._command("set_speed", speed_rpm=speed_rpm, ramp_rpm_per_s=ramp_rpm_per_s)

    def set_pressure(
        self,
        pressure_bar: float,
        function: Mapping[str, Any] | None = None,
        duration_s: float | None = None,
    ) -> None:
        """Manual: apply a pressure; with a function (as in a program file) for a duration around it."""
        self._command(
            "set_pressure", pressure_bar=pressure_bar, function=_plain(function), duration_s=duration_s
        )

    def set_ventilator(self, flow_m3_h: float) -> None:
        """Manual: cooling air; 0 is off."""
        self._command("set_ventilator", flow_m3_h=flow_m3_h)

    def condition(self, temperature_degc: float) -> None:
        """Manual: bring the disc to a temperature by dragging or cooling; any other command ends it."""
        self._command("condition", temperature_degc=temperature_degc)

    def record(
        self,
        duration_s: float,
        *,
        speed_rpm: float,
        pressure_bar: float,
        function: Mapping[str, Any] | None = None,
        comment: str = "",
    ) -> None:
        """Manual: record one braking of that duration at a speed and pressure."""
        self._command(
            "record", duration_s=duration_s, speed_rpm=speed_rpm, pressure_bar=pressure_bar,
            function=_plain(function), comment=comment,
        )  # fmt: skip

    def reset(self, reason: str) -> None:
        """After a trip: acknowledged by a person in words; leads to LOCKED or OFFLINE, never to motion."""
        if self._client is not None:
            self._command("reset", reason=reason)
        elif self.session is not None and self.state.word is Word.TRIPPED:
            self._write_operator("trip_acknowledged", reason=reason)
            self._set(
                replace(self.state, word=Word.OFFLINE, cause=None, phase=self.tr("reset; nothing runs"))
            )
        else:
            self.refused.emit(self.tr("Nothing has tripped."))

    def acknowledge_alarm(self, alarm: str) -> None:
        """A person has seen an alarm; journaled."""
        if self._client is not None:
            self._command("acknowledge_alarm", alarm=alarm)
        elif self.session is not None:
            self._write_operator("alarm_acknowledged", alarm=alarm)

    def _write_operator(self, kind: str, **payload: Any) -> None:
        assert self.session is not None
        try:
            journal = Journal(self.session.campaign / "journal.jsonl", "operator")
            journal.write(kind, who=self._who, **payload)
            journal.close()
        except OSError as error:
            self.refused.emit(str(error))
        self._read_journal()

    def note(self, text: str) -> None:
        """An operator's note, journaled with time, stored with the present braking."""
        self._command("note", text=text)

    def rate(self, rating: int) -> None:
        """Subjective noise rating 1 (nothing heard) to 9 of the present or last braking."""
        self._command("rate", rating=rating)

    def _command(self, do: str, **fields: Any) -> None:
        self._say(lambda client: client.command(do, **fields))

    def _say(self, what: Callable[[ControlClient], object]) -> None:
        if self._client is None:
            self.refused.emit(self.tr("No controller is connected."))
            return
        try:
            what(self._client)
        except LinkClosed:
            self._gone()
        except DeviceError as error:
            self.refused.emit(str(error))

    def close(self) -> None:
        """Leave; the run goes on."""
        self._timer.stop()
        self._leave()


def _seed(seed: int | None) -> list[str]:
    return [] if seed is None else ["--seed", str(seed)]


def _plain(function: Mapping[str, Any] | None) -> dict[str, Any] | None:
    return None if function is None else dict(function)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]
