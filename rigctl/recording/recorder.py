"""The recorder process: blocks from the ring to the spool, ended brakings to their files.

Job: listen for the controller on `recorder.sock`, copy ranges of samples from the ring before they are
overwritten, flush at least once a second, say what is safe; hand ended brakings to the finaliser. When the
controller dies or a stop is asked for, the running braking is ended as incomplete and all files are made.
NOT its job: deciding what is recorded, safety of the rig, recovery of an earlier run (`recovery`).

One thread copies, a second one makes files (`finaliser`): copying a quarter of a second takes 0.2 ms, making
a file 40 ms, and in virtual time the 16 s of the ring may pass in that time.
"""

from __future__ import annotations

import os
import select
import threading
import time
from collections import deque
from pathlib import Path
from typing import Any, Final

from rigctl.core.errors import DeviceError, LinkClosed, RecordingError
from rigctl.core.journal import Journal, Record
from rigctl.core.ring import RING_NAME, SampleRing
from rigctl.core.wire import Link, Listener, Message
from rigctl.recording.braking import COMPLETE, INCOMPLETE, Evaluator
from rigctl.recording.campaign import Campaign, require_free_space
from rigctl.recording.client import SOCKET_NAME
from rigctl.recording.finaliser import Finaliser
from rigctl.recording.running import RunningBraking

COPIED_EVERY_S: Final = 2.0  # rig time between two words of progress to the controller
POLL_MS: Final = 200


class SharedJournal:
    """The journal for the two threads of this process."""

    def __init__(self, journal: Journal) -> None:
        self._journal = journal
        self._lock = threading.Lock()

    def write(self, kind: str, *, rig_s: float | None = None, **payload: Any) -> Record:
        """Append one event and wait until it is on the disk."""
        with self._lock:
            return self._journal.write(kind, rig_s=rig_s, **payload)


class Recorder:
    """The recorder of one run. `serve` returns when the controller has gone and all files are made.

    Parameters
    ----------
    run_dir : Path
        Holds the ring and the sockets.
    campaign : Campaign
    journal : Journal
    evaluate : callable
        Evaluates a braking, e.g. `rigctl.recording.evaluation.evaluate_braking`.
    min_free_bytes : float
        A braking does not begin with less space than this.
    """

    def __init__(
        self,
        run_dir: Path,
        campaign: Campaign,
        journal: Journal,
        evaluate: Evaluator,
        *,
        min_free_bytes: float = 200e6,
    ) -> None:
        self.failures = 0
        self._run_dir = run_dir
        self._campaign = campaign
        self._journal = SharedJournal(journal)
        self._min_free_bytes = min_free_bytes
        self._wake_fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        self._finaliser = Finaliser(campaign, evaluate, self._journal, self._wake)
        self._complete = set(campaign.completed_indices())
        self._outbox: deque[Message] = deque()
        self._idle_asked: deque[Message] = deque()
        self._ring: SampleRing | None = None
        self._running: RunningBraking | None = None
        self._told_s = float("-inf")
        self._stop = False

    def request_stop(self) -> None:
        """End as soon as the running braking is safe; may be called from a signal handler."""
        self._stop = True
        self._wake()

    def serve(self, accept_timeout_s: float = 60.0) -> int:
        """Serve one controller until it leaves; returns the number of brakings that could not be kept."""
        listener = Listener(self._run_dir / SOCKET_NAME)
        self._finaliser.start()
        try:
            link = self._accept(listener, accept_timeout_s)
            reason = "no controller came" if link is None else self._loop(link)
        finally:
            listener.close()
        if self._running is not None:
            self._guarded(self._end, {"status": INCOMPLETE, "note": reason})
        self._finaliser.finish()
        if link is not None:
            try:
                self._send_all(link)
            except DeviceError:
                self._outbox.clear()  # nobody listens any more; what happened is in the journal
            link.close()
        return self.failures

    def _wake(self) -> None:
        os.eventfd_write(self._wake_fd, 1)

    def _accept(self, listener: Listener, timeout_s: float) -> Link | None:
        deadline = time.monotonic() + timeout_s
        while not self._stop and time.monotonic() < deadline:
            link = listener.accept(POLL_MS / 1000.0)
            if link is not None:
                return link
        return None

    def _loop(self, link: Link) -> str:
        """Handle messages until the end; returns why it ended."""
        poll = select.poll()
        poll.register(link, select.POLLIN)
        poll.register(self._wake_fd, select.POLLIN)
        try:
            while not self._stop:
                if any(fd == self._wake_fd for fd, _ in poll.poll(POLL_MS)):
                    os.eventfd_read(self._wake_fd)
                while not (self._stop or self._finaliser.results) and (message := link.recv(0)) is not None:
                    self._guarded(self._handle, message)
                    self._guarded(self._flush_if_due)
                    self._send_all(link)
                self._guarded(self._flush_if_due)
                self._send_all(link)
        except LinkClosed:
            self._take_what_is_left(link)
            return "the controller has gone"
        except DeviceError as error:
            return f"the controller cannot be understood or does not listen: {error}"
        return "the recorder was stopped"

    def _take_what_is_left(self, link: Link) -> None:
        """Blocks that a dead controller had sent: the kernel reports its death first, then hands them out."""
        for _ in range(2):
            try:
                while (message := link.recv(0)) is not None:
                    self._guarded(self._handle, message)
            except DeviceError:
                continue

    def _guarded(self, action: Any, *arguments: Any) -> None:
        """Do something for the running braking; when it fails, the braking has failed, not the recorder."""
        running = self._running
        try:
            action(*arguments)
        except RecordingError as error:
            running = self._running or running
            self._running = None
            if running is not None:
                running.give_up()
            self._failed(running.index if running is not None else None, str(error))

    def _failed(self, index: int | None, text: str) -> None:
        self.failures += 1
        self._outbox.append({"m": "failed", "index": index, "error": text})
        self._note("RECORDING_FAILED", index=index, error=text)

    def _note(self, kind: str, **payload: Any) -> None:
        """Journal an event; with a full disk the word to the controller has to do."""
        try:
            self._journal.write(kind, **payload)
        except OSError as error:
            self._outbox.append({"m": "journal_failed", "index": payload.get("index"), "error": str(error)})

    def _handle(self, message: Message) -> None:
        kind = message["m"]
        if kind == "block":
            self._block(message)
        elif kind == "begin":
            self._begin(message)
        elif kind == "mark":
            if self._running is not None:
                self._running.mark(message["name"], message["t"], message["values"])
        elif kind == "end":
            self._end(message)
        elif kind == "idle":
            self._idle_asked.append({"m": "idle", "n": message["n"]})
        else:
            raise DeviceError(f"unknown message '{kind}'", place=SOCKET_NAME)

    def _begin(self, order: Message) -> None:
        if self._running is not None:
            self._guarded(self._end, {"status": INCOMPLETE, "note": "the next braking began"})
        self._told_s = order["t0_s"]
        index = int(order["specification"]["index"])
        try:
            if index in self._complete:
                raise RecordingError(
                    "this braking is complete already.", place=self._campaign.braking_path(index).name
                )
            require_free_space(self._campaign.folder, self._min_free_bytes)
            if self._ring is None:
                self._ring = SampleRing.attach(self._run_dir / RING_NAME)
            self._running = RunningBraking(self._campaign, self._ring, order)
        except (RecordingError, DeviceError) as error:
            self._failed(index, str(error))
            return
        self._outbox.append({"m": "begun", "index": index})

    def _block(self, message: Message) -> None:
        begin_ns, end_s = message["t"], (message["t"] + message["dt"]) * 1e-9
        running = self._running
        if running is not None:
            known_gap = running.gap
            running.block(begin_ns * 1e-9, end_s, message["r"], self._keep_waiting)
            if running.gap is not known_gap:
                self._outbox.append({"m": "gap", "index": running.index, "error": str(running.gap)})
                self._note("SAMPLES_MISSING", index=running.index, error=str(running.gap))
        if end_s - self._told_s >= COPIED_EVERY_S:
            self._told_s = end_s
            self._outbox.append({"m": "copied", "t": end_s})

    def _keep_waiting(self) -> bool:
        return not self._stop

    def _end(self, message: Message) -> None:
        running = self._running
        if running is None:
            return
        running.end(message["status"], message["note"])
        self._running = None
        self._outbox.append({"m": "spooled", "index": running.index, "t": running.synced_s})
        self._finaliser.submit(running.index, running.path)

    def _flush_if_due(self) -> None:
        running = self._running
        if running is not None and running.flush_if_due():
            self._outbox.append({"m": "spooled", "index": running.index, "t": running.synced_s})

    def _send_all(self, link: Link) -> None:
        while self._finaliser.results:
            result = self._finaliser.results.popleft()
            if result["m"] == "failed":
                self._failed(result["index"], result["error"])
                continue
            if result["status"] == COMPLETE:
                self._complete.add(result["index"])
            self._outbox.append(result)
        while self._outbox:
            link.send(self._outbox.popleft())
        while self._idle_asked and self._finaliser.idle and not self._finaliser.results:
            link.send(self._idle_asked.popleft())
