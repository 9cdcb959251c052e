"""Socket of the controller for people: verbs and commands come in, progress and blocks go out, to any number.

Job: `ControlServer` in the controller process; `ControlClient` for supervisor, CLI and window; who may
command. Several may watch, one commands: the first who asks to, until somebody takes over or it leaves.
Anybody may stop, note and rate. Clients come and go without effect on the run. Not its job: what a verb or
command does (`rigctl.engine`), finding the socket (`rigctl.app.sessions`).

Messages of a client: hello (who, role), subscribe, verb, command, take. Of the server: welcome, commander,
progress, blocks, answer (id, reason, remedy), result. Plain JSON (`rigctl.core.wire`).
"""

from __future__ import annotations

import select
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from rigctl.core.blocks import Block
from rigctl.core.errors import ConfigError, DeviceError, LinkClosed
from rigctl.core.wire import Link, Listener, Message, connect
from rigctl.engine.commands import FREE_FOR_ALL, Ask, Command, parse_command
from rigctl.engine.state import Outcome, Progress, RunResult, State, Verb

SOCKET_NAME = "controller.sock"
SUPERVISOR, COMMAND, WATCH = "supervisor", "command", "watch"
ANYBODY = frozenset({Verb.STOP})
FLUSH_S = 0.04  # wall clock between two messages of blocks
MOST_BLOCKS = 200  # in one message; in virtual time what is older is left out


@dataclass
class _Client:
    link: Link
    who: str = "somebody"
    role: str = WATCH
    blocks: bool = False


class ControlServer:
    """Looks at its clients once per block, without waiting."""

    def __init__(self, run_dir: Path) -> None:
        self._listener = Listener(run_dir / SOCKET_NAME)
        self._clients: dict[int, _Client] = {}
        self._verbs: deque[Verb] = deque()
        self._asks: list[Ask] = []
        self._commander: int | None = None
        self._progress: Message = {}
        self._blocks: deque[Message] = deque(maxlen=MOST_BLOCKS)
        self._flush_at = 0.0
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

    @property
    def attended(self) -> bool:
        """True while somebody commands."""
        return self._commander is not None

    def next_verb(self) -> Verb | None:
        """The oldest verb that has not been obeyed yet."""
        self._serve()
        return self._verbs.popleft() if self._verbs else None

    def take_asks(self) -> Sequence[Ask]:
        """Commands since the last call."""
        self._serve()
        asks, self._asks = self._asks, []
        return asks

    def _serve(self) -> None:
        for fd, _ in self._poll.poll(0):
            if fd == self._listener.fileno():
                link = self._listener.accept(0)
                if link is not None:
                    self._add(link)
            elif fd in self._clients:
                self._read(self._clients[fd])

    def _add(self, link: Link) -> None:
        self._clients[link.fileno()] = _Client(link)
        self._poll.register(link, select.POLLIN)

    # -- what clients say -------------------------------------------------------------------------

    def _read(self, client: _Client) -> None:
        fd = client.link.fileno()
        try:
            while fd in self._clients and (message := client.link.recv(0)) is not None:
                self._take(client, message)
        except (LinkClosed, DeviceError):
            self._drop(client)

    def _take(self, client: _Client, message: Message) -> None:
        kind = message.get("m")
        if kind == "hello":
            client.who = str(message.get("who", ""))[:80] or client.who
            client.role = str(message.get("role", WATCH))
            if client.role == COMMAND and self._commander is None:
                self._set_commander(client)
            else:
                self._tell_commander(client)
            if self._progress:
                self._send(client, self._progress)
        elif kind == "subscribe":
            client.blocks = bool(message.get("blocks"))
        elif kind == "take":
            self._set_commander(client)
        elif kind == "verb":
            self._take_verb(client, message)
        elif kind == "command":
            self._take_command(client, message)
        else:
            self._answer(client, message.get("id"), f"there is no message {str(kind)[:40]!r}", "")

    def _take_verb(self, client: _Client, message: Message) -> None:
        try:
            verb = Verb(message.get("verb"))
        except ValueError:
            self._answer(client, message.get("id"), f"there is no verb {message.get('verb')!r}", "")
            return
        if client.role != SUPERVISOR and verb not in ANYBODY and not self._may_command(client, message):
            return
        self._verbs.append(verb)
        self._answer(client, message.get("id"), "", "")

    def _take_command(self, client: _Client, message: Message) -> None:
        try:
            command: Command = parse_command(message.get("command") or {})
        except ConfigError as error:
            self._answer(client, message.get("id"), str(error), error.remedy)
            return
        if isinstance(command, FREE_FOR_ALL) or self._may_command(client, message):
            answer = partial(self._answer, client, message.get("id"))
            self._asks.append(Ask(command, client.who, answer))

    def _may_command(self, client: _Client, message: Message) -> bool:
        if self._commander is None:
            self._set_commander(client)
        if self._commander == client.link.fileno():
            return True
        other = self._clients[self._commander].who if self._commander is not None else ""
        self._answer(client, message.get("id"), f"{other} commands this rig.", "Take the command first.")
        return False

    def _set_commander(self, client: _Client) -> None:
        self._commander = client.link.fileno()
        for each in list(self._clients.values()):
            self._tell_commander(each)

    def _tell_commander(self, client: _Client) -> None:
        commander = self._clients.get(self._commander) if self._commander is not None else None
        self._send(
            client,
            {"m": "commander", "who": commander.who if commander else "", "you": commander is client},
        )

    def _answer(self, client: _Client, number: Any, reason: str, remedy: str) -> None:
        if client.link.fileno() in self._clients and number is not None:
            self._send(client, {"m": "answer", "id": number, "reason": reason, "remedy": remedy})

    # -- what clients are told --------------------------------------------------------------------

    def tell(self, progress: Progress) -> None:
        """Send the progress to every client; one that does not read is dropped."""
        self._progress = {"m": "progress", **asdict(progress)}
        self._broadcast(self._progress)

    def watch(self, block: Block) -> None:
        """Tell those who look at the signals where the samples of a block are."""
        if not any(client.blocks for client in self._clients.values()):
            return
        self._blocks.append(
            {"t_ns": block.t_ns, "dt_ns": block.dt_ns, "stride": block.stride, "ranges": dict(block.ranges)}
        )
        now = time.monotonic()
        if now >= self._flush_at:
            self._flush_at = now + FLUSH_S
            message = {"m": "blocks", "blocks": list(self._blocks)}
            self._blocks.clear()
            for client in [client for client in self._clients.values() if client.blocks]:
                self._send(client, message)

    def finish(self, result: RunResult) -> None:
        """Tell every client how the run ended."""
        self._broadcast({"m": "result", **asdict(result)})

    def _broadcast(self, message: Message) -> None:
        for client in list(self._clients.values()):
            self._send(client, message)

    def _send(self, client: _Client, message: Message) -> None:
        try:
            client.link.send(message, timeout_s=0.0)
        except DeviceError:
            self._drop(client)

    def _drop(self, client: _Client) -> None:
        fd = client.link.fileno()
        if self._clients.pop(fd, None) is None:
            return
        self._poll.unregister(fd)
        client.link.close()
        if fd == self._commander:
            self._commander = None
            for each in list(self._clients.values()):
                self._tell_commander(each)

    def close(self) -> None:
        """Leave all clients."""
        self._commander = None
        for client in list(self._clients.values()):
            self._drop(client)
        self._listener.close()


@dataclass(frozen=True)
class Commander:
    """Who commands ("" nobody), and whether it is this client."""

    who: str
    you: bool


@dataclass(frozen=True)
class Answer:
    """What became of a verb or command; `reason` is empty when it was taken."""

    number: int
    reason: str
    remedy: str


@dataclass(frozen=True)
class Blocks:
    """Blocks since the last ones: mappings with t_ns, dt_ns, stride, ranges."""

    blocks: list[Message]


News = Progress | RunResult | Commander | Answer | Blocks


class ControlClient:
    """A person's end: reads news, sends verbs and commands.

    Parameters
    ----------
    run_dir : Path
        Folder of the run (`rigctl.app.sessions`).
    timeout_s : float
        For the controller to answer at all.
    who : str
        User and program, for journal and other clients.
    role : str
        `SUPERVISOR`, `COMMAND` (commands if nobody else does) or `WATCH`.
    """

    def __init__(self, run_dir: Path, timeout_s: float, *, who: str = "", role: str = WATCH) -> None:
        self._link = connect(run_dir / SOCKET_NAME, timeout_s, "controller")
        self._number = 0
        self._link.send({"m": "hello", "who": who, "role": role})

    def fileno(self) -> int:
        """Descriptor for select and poll."""
        return self._link.fileno()

    def send(self, verb: Verb) -> int:
        """Ask the engine for something; the number comes back with the `Answer`."""
        return self._send({"m": "verb", "verb": verb.value})

    def command(self, do: str, **fields: Any) -> int:
        """Give a command (`rigctl.engine.commands`)."""
        plain = {key: value for key, value in fields.items() if value is not None}
        return self._send({"m": "command", "command": {"do": do, **plain}})

    def take(self) -> None:
        """Command from here on; whoever did is told."""
        self._link.send({"m": "take"})

    def subscribe(self, blocks: bool = True) -> None:
        """Be told where the samples of each block are, or no more."""
        self._link.send({"m": "subscribe", "blocks": blocks})

    def _send(self, message: Message) -> int:
        self._number += 1
        self._link.send({**message, "id": self._number})
        return self._number

    def recv(self, timeout_s: float) -> News | None:
        """Next news, None after `timeout_s`; raises `LinkClosed` when the controller has gone."""
        message = self._link.recv(timeout_s)
        if message is None:
            return None
        reader = _READERS.get(message.pop("m"))
        return None if reader is None else reader(message)

    def close(self) -> None:
        """Leave; the run goes on."""
        self._link.close()


_READERS: dict[str, Callable[[Message], News]] = {
    "progress": lambda m: Progress(**{**m, "state": State(m["state"])}),
    "result": lambda m: RunResult(**{**m, "outcome": Outcome(m["outcome"])}),
    "commander": lambda m: Commander(m["who"], m["you"]),
    "answer": lambda m: Answer(m["id"], m["reason"], m["remedy"]),
    "blocks": lambda m: Blocks(m["blocks"]),
}
