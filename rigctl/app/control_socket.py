"""Socket of the controller for people: verbs come in, progress goes out, to any number of clients.

Job: `ControlServer` in the controller process, `ControlClient` in the CLI (and later the GUI). Clients
come and go without effect on the run. Not its job: what a verb does (`rigctl.engine`).
"""

from __future__ import annotations

import select
from collections import deque
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rigctl.core.errors import DeviceError, LinkClosed
from rigctl.core.wire import Link, Listener, connect
from rigctl.engine.state import Outcome, Progress, RunResult, State, Verb

SOCKET_NAME = "controller.sock"


class ControlServer:
    """Looks at its clients once per block, without waiting."""

    def __init__(self, run_dir: Path) -> None:
        self._listener = Listener(run_dir / SOCKET_NAME)
        self._clients: dict[int, Link] = {}
        self._verbs: deque[Verb] = deque()
        self._poll = select.poll()
        self._poll.register(self._listener, select.POLLIN)

    def wait_for_client(self, timeout_s: float) -> bool:
        """Wait for the first client (the supervisor)."""
        link = self._listener.accept(timeout_s)
        if link is not None:
            self._add(link)
        return link is not None

    @property
    def deserted(self) -> bool:
        """True when no client is left."""
        return not self._clients

    def next_verb(self) -> Verb | None:
        """The oldest verb that has not been obeyed yet."""
        for fd, _ in self._poll.poll(0):
            if fd == self._listener.fileno():
                link = self._listener.accept(0)
                if link is not None:
                    self._add(link)
            elif fd in self._clients:
                self._read(self._clients[fd])
        return self._verbs.popleft() if self._verbs else None

    def _add(self, link: Link) -> None:
        self._clients[link.fileno()] = link
        self._poll.register(link, select.POLLIN)

    def _read(self, link: Link) -> None:
        try:
            message = link.recv(0)
        except (LinkClosed, DeviceError):
            self._drop(link)
            return
        if message is not None and message.get("m") == "verb":
            try:
                self._verbs.append(Verb(message.get("verb")))
            except ValueError:
                self._send(link, {"m": "refused", "reason": f"there is no verb {message.get('verb')!r}"})

    def tell(self, progress: Progress) -> None:
        """Send the progress to every client; one that does not read is dropped."""
        self._broadcast({"m": "progress", **asdict(progress)})

    def finish(self, result: RunResult) -> None:
        """Tell every client how the run ended."""
        self._broadcast({"m": "result", **asdict(result)})

    def _broadcast(self, message: dict[str, Any]) -> None:
        for link in list(self._clients.values()):
            self._send(link, message)

    def _send(self, link: Link, message: dict[str, Any]) -> None:
        try:
            link.send(message, timeout_s=0.0)
        except DeviceError:
            self._drop(link)

    def _drop(self, link: Link) -> None:
        self._poll.unregister(link)
        del self._clients[link.fileno()]
        link.close()

    def close(self) -> None:
        """Leave all clients."""
        for link in list(self._clients.values()):
            self._drop(link)
        self._listener.close()


class ControlClient:
    """A person's end: reads progress, sends verbs."""

    def __init__(self, run_dir: Path, timeout_s: float) -> None:
        self._link = connect(run_dir / SOCKET_NAME, timeout_s, "controller")

    def fileno(self) -> int:
        """Descriptor for select and poll."""
        return self._link.fileno()

    def send(self, verb: Verb) -> None:
        """Ask the engine for something."""
        self._link.send({"m": "verb", "verb": verb.value})

    def recv(self, timeout_s: float) -> Progress | RunResult | None:
        """Next news, None after `timeout_s`; raises `LinkClosed` when the controller has gone."""
        message = self._link.recv(timeout_s)
        if message is None:
            return None
        kind = message.pop("m")
        if kind == "progress":
            return Progress(**{**message, "state": State(message["state"])})
        if kind == "result":
            return RunResult(**{**message, "outcome": Outcome(message["outcome"])})
        return None

    def close(self) -> None:
        """Leave; the run goes on."""
        self._link.close()
