"""The watchdog as a process: one poll over safety channel and controller, one cycle per sample.

Job: carry messages to the guard and its answers to the relay; the relay first, the journal second. In
lockstep the sample alone wakes the process, and the heartbeat that belongs to it is read then: every cycle
waits once, and a fault of the controller is found in the same block whatever the load of the machine. In real
time the heartbeat wakes it too, since its age counts. Not its job: decisions (`rigctl.safety.guard`).
"""

from __future__ import annotations

import os
import select
import socket
import time
from dataclasses import dataclass
from typing import Any, Final

from rigctl.core.errors import DeviceError, LinkClosed
from rigctl.core.safety_link import SafetyLink
from rigctl.core.wire import Link, Listener, Message
from rigctl.safety.causes import Cause
from rigctl.safety.evidence import Evidence
from rigctl.safety.guard import Answer, Guard
from rigctl.safety.latch import State
from rigctl.safety.limits import Windows

EXIT_DONE: Final = 0
EXIT_DEVICE: Final = 3
EXIT_TRIPPED: Final = 4

LOCKSTEP_TICK_S: Final = 0.25
REAL_TICK_S: Final = 0.05
DRAIN_LIMIT: Final = 256


@dataclass(frozen=True, slots=True)
class Patience:
    """Wall-clock times that end the process; none of them keeps the relay closed.

    Attributes
    ----------
    controller_s : float
        A controller must have connected.
    linger_s : float
        After a trip, at rest, with a controller that is silent but alive.
    safe_state_s : float
        For the rig to come to rest after a trip when the controller has gone.
    """

    controller_s: float = 300.0
    linger_s: float = 5.0
    safe_state_s: float = 30.0


class Watchdog:
    """Loop around a `Guard`. `run` returns the exit code."""

    def __init__(
        self,
        guard: Guard,
        evidence: Evidence,
        rig: SafetyLink,
        listener: Listener,
        windows: Windows,
        *,
        lockstep: bool,
        patience: Patience,
    ) -> None:
        self._guard = guard
        self._evidence = evidence
        self._rig = rig
        self._listener = listener
        self._windows = windows
        self._lockstep = lockstep
        self._patience = patience
        self._tick_s = (
            min(LOCKSTEP_TICK_S, windows.heartbeat_s / 4, windows.sample_s / 4) if lockstep else REAL_TICK_S
        )
        self._poll = select.poll()
        self._poll.register(rig.fileno(), select.POLLIN)
        self._poll.register(listener.fileno(), select.POLLIN)
        self._rig_fd = rig.fileno()
        self._rig_gone = False
        self._controller: Link | None = None
        self._newcomer: Link | None = None  # connected, has not said hello
        self._pidfd = -1
        self._first_k = 0
        self._started_s = self._heard_s = self._gone_s = time.monotonic()
        self._had_controller = False
        self.terminate = False
        self._terminating = False
        self._journal_told = False
        self.cycles = 0
        self.busy_s = 0.0
        self.longest_s = 0.0

    def run(self) -> int:
        """Until the controller has left and the rig is at rest. Returns the exit code."""
        while (code := self._turn()) is None:
            pass
        return code

    def fail(self, why: str) -> None:
        """An error in the program itself: open the relay, say so."""
        self._guard.trip(Cause("watchdog_error", detail=why), time.monotonic())
        self._serve()

    # -- one turn -------------------------------------------------------------------------------

    def _turn(self) -> int | None:
        events = self._poll.poll(self._timeout_ms())
        now_s = time.monotonic()
        sample_waits = False
        for fd, _ in events:
            if fd == self._rig_fd:
                sample_waits = True
            else:
                self._on_other(fd, now_s)
        if sample_waits:
            self._cycle(now_s)
        else:
            self._on_quiet(now_s)
        if self._evidence.failure and not self._journal_told:
            self._journal_told = True
            self._guard.journal_failed(self._evidence.failure, now_s)
        if self.terminate and not self._terminating:
            self._drain_controller(now_s)
            self._on_terminate(now_s)
        self._serve()
        if self._controller is not None and self._guard.state is not State.TRIPPED and not self._rig_gone:
            return EXIT_DONE if self._terminating else None
        return self._ending(now_s)

    def _timeout_ms(self) -> float:
        if not self._lockstep:
            deadline_s = self._guard.silence_deadline_s()
            if deadline_s is not None:
                return max(0.0, min(self._tick_s, deadline_s - time.monotonic())) * 1000.0
        return self._tick_s * 1000.0

    def _serve(self) -> None:
        """Relay first, journal second."""
        reason = self._guard.take_open()
        if reason is not None:
            self._open_relay(self._guard.last_k, reason)
            if self._controller is not None:
                self._send_status(self._guard.last_k)
        for note in self._guard.take_notes():
            self._evidence.put(note)

    def _open_relay(self, k: int, reason: str) -> None:
        if not self._rig_gone:  # a relay whose link is closed is open
            try:
                self._rig.open_relay(k, reason)
            except DeviceError as error:
                self._on_rig_gone(str(error), time.monotonic())

    # -- the cycle ------------------------------------------------------------------------------

    def _cycle(self, now_s: float) -> None:
        try:
            sample = self._rig.recv(0.0)
        except LinkClosed as error:
            self._on_rig_gone(str(error), now_s)
            return
        except (DeviceError, LookupError, TypeError, ValueError) as error:
            self._guard.on_sample_garbage(f"{type(error).__name__}: {error}", now_s)
            return
        if sample is None:
            return
        guard, k = self._guard, sample.k
        if self._lockstep:
            self._await_heartbeat(k - 1, now_s)
            now_s = time.monotonic()
        answer = guard.on_sample(sample, now_s)
        if self._controller is not None:
            self._send_status(k)
        try:
            if answer is Answer.EDGE and guard.live:  # the status may have found the controller gone
                self._rig.edge(k)
            elif answer is Answer.CLOSE and guard.live:
                self._rig.close_relay(k)
            elif (reason := guard.take_open()) is not None:
                self._rig.open_relay(k, reason)
            else:
                self._rig.hold(k)
        except DeviceError as error:
            self._on_rig_gone(str(error), now_s)
        spent_s = time.monotonic() - now_s
        self.cycles += 1
        self.busy_s += spent_s
        self.longest_s = max(self.longest_s, spent_s)

    def _await_heartbeat(self, k: int, now_s: float) -> None:
        """Read the controller's messages in their order up to heartbeat `k`, and none beyond it."""
        monitor = self._guard.monitor
        if self._guard.state is State.TRIPPED:  # nobody waits for a controller that may be the cause
            self._drain_controller(now_s)
            return
        if self._controller is None or k < self._first_k:
            return
        deadline_s = now_s + self._windows.heartbeat_s
        while monitor.last_k < k:
            if self._read_controller(0.0, now_s):
                continue
            left_s = deadline_s - time.monotonic()
            if left_s <= 0.0 or not self._read_controller(left_s, now_s):
                return

    def _send_status(self, k: int) -> None:
        assert self._controller is not None
        try:
            self._controller.send(self._guard.status(k), 0.0)
        except LinkClosed as error:
            self._on_controller_gone(str(error), time.monotonic())
        except DeviceError as error:
            if self._guard.live:
                self._guard.trip(Cause("controller_deaf", detail=str(error)), time.monotonic())

    # -- controller -----------------------------------------------------------------------------

    def _on_other(self, fd: int, now_s: float) -> None:
        if fd == self._listener.fileno():
            self._accept(now_s)
        elif self._newcomer is not None and fd == self._newcomer.fileno():
            self._on_newcomer(now_s)
        elif fd == self._pidfd:
            self._drain_controller(now_s)
            self._on_controller_gone("its process has ended", now_s)
        elif self._controller is not None and fd == self._controller.fileno():
            self._drain_controller(now_s)

    def _accept(self, now_s: float) -> None:
        link = self._listener.accept(0.0)
        if link is None:
            return
        if self._controller is not None or self._newcomer is not None:
            self._evidence.write("refused_controller", words="A second controller wants to connect.")
            link.close()
            return
        self._newcomer = link
        self._poll.register(link.fileno(), select.POLLIN)
        self._on_newcomer(now_s)  # its hello is there before the first sample that depends on it

    def _on_newcomer(self, now_s: float) -> None:
        """The first message must be a hello, with the process number the kernel confirms."""
        link = self._newcomer
        assert link is not None
        problem = ""
        message: Message | None = None
        try:
            message = link.recv(0.0)
        except DeviceError as error:
            problem = str(error)
        if message is None and not problem:
            return
        self._newcomer = None
        self._poll.unregister(link.fileno())
        pid = peer_pid(link)
        if message is not None and (message.get("m") != "hello" or message.get("pid") != pid):
            problem = f"The first message is no hello of process {pid}."
        try:
            pidfd = os.pidfd_open(pid) if not problem else -1
        except OSError as error:
            problem, pidfd = f"Process {pid}: {error.strerror}.", -1
        if problem or message is None:
            self._evidence.write("refused_controller", words=problem)
            link.close()
            return
        self._controller, self._pidfd = link, pidfd
        self._poll.register(link.fileno(), select.POLLRDHUP if self._lockstep else select.POLLIN)
        self._poll.register(pidfd, select.POLLIN)
        self._had_controller, self._heard_s = True, now_s
        self._first_k = self._guard.last_k + 1
        self._guard.controller_connected()
        self._evidence.write(
            "controller_connected", process=pid, run_id=str(message.get("run_id", ""))[:64],
            campaign=str(message.get("campaign", ""))[:256],
        )  # fmt: skip

    def _drain_controller(self, now_s: float) -> None:
        for _ in range(DRAIN_LIMIT):
            if not self._read_controller(0.0, now_s):
                return

    def _read_controller(self, timeout_s: float, now_s: float) -> bool:
        """Take one message; False when none came or the controller has gone."""
        if self._controller is None:
            return False
        try:
            message = self._controller.recv(timeout_s)
        except LinkClosed:
            self._on_controller_gone("its link is closed", now_s)
            return False
        except DeviceError as error:
            self._guard.on_controller_garbage(str(error), now_s)
            return True
        if message is None:
            return False
        self._heard_s = now_s if timeout_s == 0.0 else time.monotonic()
        self._dispatch(message)
        return True

    def _dispatch(self, message: dict[str, Any]) -> None:
        kind, guard = message.get("m"), self._guard
        if kind == "hb":
            guard.on_heartbeat(message, self._heard_s)
        elif kind == "arm":
            guard.request_arm()
        elif kind == "disarm":
            guard.disarm()
        elif kind == "reset":
            guard.reset(message.get("who"), message.get("reason"), self._heard_s)
        else:
            guard.on_controller_garbage(f"unknown message {str(kind)[:40]!r}", self._heard_s)

    def _on_controller_gone(self, how: str, now_s: float) -> None:
        if self._controller is None:
            return
        self._poll.unregister(self._controller.fileno())
        self._poll.unregister(self._pidfd)
        os.close(self._pidfd)
        self._controller.close()
        self._controller, self._pidfd = None, -1
        self._gone_s = now_s
        self._guard.controller_gone(how, now_s)

    # -- quiet and end --------------------------------------------------------------------------

    def _on_quiet(self, now_s: float) -> None:
        self._drain_controller(now_s)
        self._guard.on_silence(now_s)

    def _on_rig_gone(self, how: str, now_s: float) -> None:
        if self._rig_gone:
            return
        self._rig_gone = True
        self._poll.unregister(self._rig_fd)
        if self._guard.live:
            self._guard.trip(Cause("rig_gone", detail=how), now_s)
        else:
            self._evidence.write("rig_gone", words=f"The rig's safety channel is closed: {how}")

    def _on_terminate(self, now_s: float) -> None:
        self._terminating = True
        self._gone_s = now_s
        if self._guard.live:
            self._guard.trip(Cause("terminated"), now_s)

    def _ending(self, now_s: float) -> int | None:
        """Exit code when it is time to end."""
        left = self._terminating or (self._had_controller and self._controller is None)
        if self._guard.state is State.TRIPPED:
            return EXIT_TRIPPED if self._ends_tripped(left, now_s) else None
        if left:
            return EXIT_DONE
        if self._rig_gone:
            return EXIT_DONE if self._guard.disarmed else EXIT_DEVICE
        if not self._had_controller and now_s - self._started_s > self._patience.controller_s:
            self._evidence.write("no_controller", words="No controller has connected.")
            return EXIT_DEVICE
        return None

    def _ends_tripped(self, left: bool, now_s: float) -> bool:
        """At rest and nobody to reset the trip, or no hope of learning more."""
        safe = self._guard.safe_state_reached
        if safe and (left or now_s - self._heard_s > self._patience.linger_s):
            return True
        if not self._rig_gone and not (left and now_s - self._gone_s > self._patience.safe_state_s):
            return False
        if not safe:
            words = "The relay is open, but no sample shows the rig at rest."
            self._evidence.write("safe_state_not_confirmed", words=words)
        return True


def peer_pid(link: Link) -> int:
    """Process at the other end of a local link, as the kernel knows it."""
    with socket.socket(fileno=os.dup(link.fileno())) as duplicate:
        raw = duplicate.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12)
    return int.from_bytes(raw[:4], "little", signed=True)
