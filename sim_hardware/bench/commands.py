"""The bench's command socket: status and faults as JSON, for people, tests and `rigctl bench`.

Job: answer any number of clients from a thread of its own; `ask` is the clients' end. Not its job: what
commands mean (`process` and the devices).

A request names its target and what to do: ``{"to": "bench", "do": "status"}``, ``{"to": "rig", "do": "estop",
"pressed": true}``, ``{"to": "can", "do": "disturb", "node": "current_input", "wire": "broken"}``,
``{"to": "drive", "do": "unplug", "for_s": 2}``. The answer is ``{"m": "done", …}`` or ``{"m": "refused",
"reason": …}``.
"""

from __future__ import annotations

import os
import select
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rigctl.core.errors import DeviceError, RigctlError
from rigctl.core.wire import Link, Listener, connect

SOCKET_NAME = "bench.sock"
ANSWER_TIMEOUT_S = 5.0

Handle = Callable[[dict[str, Any]], dict[str, Any]]


class CommandServer:
    """Obeys clients in a thread of its own, one request after the other.

    Parameters
    ----------
    folder : Path
        The bench's.
    handle : callable
        Takes a request, gives the fields of the answer; raises `RigctlError` or `ValueError` to refuse.
    """

    def __init__(self, folder: Path, handle: Handle) -> None:
        self._listener = Listener(folder / SOCKET_NAME)
        self._handle = handle
        self._clients: dict[int, Link] = {}
        self._poll = select.poll()
        self._wake_read, self._wake_write = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        self._poll.register(self._listener, select.POLLIN)
        self._poll.register(self._wake_read, select.POLLIN)
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name="commands", daemon=True)

    def start(self) -> None:
        """Answer from now on."""
        self._thread.start()

    def stop(self) -> None:
        """Leave all clients."""
        self._stopping = True
        os.write(self._wake_write, b"x")
        if self._thread.is_alive():
            self._thread.join()
        for link in tuple(self._clients.values()):
            self._drop(link)
        self._listener.close()
        os.close(self._wake_read)
        os.close(self._wake_write)

    def _run(self) -> None:
        while not self._stopping:
            for fd, _ in self._poll.poll():
                if fd == self._listener.fileno():
                    self._welcome()
                elif fd in self._clients:
                    self._serve(self._clients[fd])

    def _welcome(self) -> None:
        link = self._listener.accept(0)
        if link is not None:
            self._clients[link.fileno()] = link
            self._poll.register(link, select.POLLIN)

    def _serve(self, link: Link) -> None:
        try:
            request = link.recv(0)
            if request is not None:
                link.send(self._answer(request), timeout_s=0.5)
        except DeviceError:  # it has gone, or does not speak our language
            self._drop(link)

    def _answer(self, request: dict[str, Any]) -> dict[str, Any]:
        try:
            return {"m": "done", **self._handle(request)}
        except (RigctlError, ValueError, TypeError) as error:
            return {"m": "refused", "reason": str(error)}

    def _drop(self, link: Link) -> None:
        self._poll.unregister(link)
        del self._clients[link.fileno()]
        link.close()


def ask(folder: Path, request: dict[str, Any], timeout_s: float = 0.5) -> dict[str, Any]:
    """Send one request to the bench of this folder and wait for the answer.

    Raises
    ------
    DeviceError
        No bench is running there, it does not answer, or it refuses.
    """
    try:
        link = connect(folder / SOCKET_NAME, timeout_s, "bench")
    except DeviceError as error:
        raise DeviceError(
            "no bench is running here.",
            place=str(folder),
            remedy="Start one in another terminal: rigctl bench. Another folder: RIGCTL_BENCH_DIR.",
        ) from error
    try:
        link.send(request)
        answer = link.recv(ANSWER_TIMEOUT_S)
    finally:
        link.close()
    if answer is None:
        raise DeviceError(f"no answer within {ANSWER_TIMEOUT_S:g} s.", place="bench")
    if answer.pop("m", None) != "done":
        raise DeviceError(str(answer.get("reason", "the bench refuses")))
    return answer
