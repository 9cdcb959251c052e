"""Local links between the processes: one JSON object per datagram over AF_UNIX SOCK_SEQPACKET.

Job: keep message boundaries, notice the death of the other end, never block without a limit. SEQPACKET
does the framing and reports end-of-file when the peer dies, even by SIGKILL. Only plain JSON crosses a
process border (no pickle). Not its job: samples (they travel in `rigctl.core.ring`), meaning of messages.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import socket
import time
from pathlib import Path
from typing import Any, Final, cast

from rigctl.core.errors import DeviceError, LinkClosed

Message = dict[str, Any]

MAX_MESSAGE_BYTES: Final = 128 * 1024
_encode = json.JSONEncoder(separators=(",", ":"), ensure_ascii=True).encode
_decode = json.JSONDecoder().decode


class Link:
    """One end of a connection. Sends and receives dictionaries of plain JSON values.

    `recv` returns None when nothing came within the time given; both calls raise `LinkClosed` when the
    other end has gone. After `close` the link cannot be used again.
    """

    def __init__(self, sock: socket.socket, name: str) -> None:
        self._sock = sock
        self._sock.setblocking(False)
        self.name = name
        self._poll = select.poll()
        self._poll.register(sock, select.POLLIN)

    def fileno(self) -> int:
        """Descriptor for select and poll."""
        return self._sock.fileno()

    def send(self, message: Message, timeout_s: float = 5.0) -> None:
        """Send one message; waits at most `timeout_s` for room in the peer's buffer.

        Raises
        ------
        LinkClosed
            The peer is gone.
        DeviceError
            The message is too large, or the peer has not read for `timeout_s`.
        """
        data = _encode(message).encode("ascii")
        if len(data) > MAX_MESSAGE_BYTES:
            raise DeviceError(f"message of {len(data)} bytes is too large", place=self.name)
        deadline = None
        while True:
            try:
                self._sock.send(data, socket.MSG_NOSIGNAL)
                return
            except BlockingIOError:
                now = time.monotonic()
                deadline = deadline or now + timeout_s
                if now >= deadline:
                    raise DeviceError(f"peer has not read for {timeout_s:g} s", place=self.name) from None
                select.select([], [self._sock], [], deadline - now)
            except OSError as error:
                raise LinkClosed("the other end has gone", place=self.name) from error

    def recv(self, timeout_s: float | None = None) -> Message | None:
        """Next message, or None if none came within `timeout_s` (None waits for ever)."""
        waits = timeout_s is None or timeout_s > 0
        if waits and not self._poll.poll(None if timeout_s is None else timeout_s * 1000.0):
            return None
        try:
            data = self._receive()
        except BlockingIOError:
            return None
        except OSError as error:
            raise LinkClosed("the other end has gone", place=self.name) from error
        if not data:
            raise LinkClosed("the other end has gone", place=self.name)
        try:
            message = _decode(data.decode("ascii"))
        except ValueError as error:
            raise DeviceError("received something that is not JSON", place=self.name) from error
        if not isinstance(message, dict):
            raise DeviceError("received JSON that is not an object", place=self.name)
        return cast(Message, message)

    def _receive(self) -> bytes:
        try:
            return self._sock.recv(MAX_MESSAGE_BYTES)
        except ConnectionResetError:
            # The peer left without reading everything; what it had sent before is still to be had.
            return self._sock.recv(MAX_MESSAGE_BYTES)

    def drain(self) -> list[Message]:
        """All messages that are there now, without waiting.

        When the peer has gone, its last messages come first; `LinkClosed` is raised by the next call.
        """
        messages: list[Message] = []
        try:
            while (message := self.recv(0)) is not None:
                messages.append(message)
        except LinkClosed:
            if not messages:
                raise
        return messages

    def close(self) -> None:
        """Close this end; the peer sees `LinkClosed`."""
        with contextlib.suppress(OSError):
            self._sock.close()


class Listener:
    """Listening end of a local socket path. Only processes of the same user can connect (0700 folder)."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with contextlib.suppress(FileNotFoundError):
            os.unlink(path)
        self._sock = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            self._sock.bind(str(path))
        except OSError as error:
            raise DeviceError(
                f"cannot listen: {error.strerror or error}",
                place=str(path),
                remedy="The path must be writable and shorter than 108 characters: set TMPDIR.",
            ) from error
        os.chmod(path, 0o600)
        self._sock.listen(8)
        self._sock.setblocking(False)

    def fileno(self) -> int:
        """Descriptor for select and poll."""
        return self._sock.fileno()

    def accept(self, timeout_s: float | None = None) -> Link | None:
        """Next connection by a process of the same user, or None after `timeout_s`."""
        ready, _, _ = select.select([self._sock], [], [], timeout_s)
        if not ready:
            return None
        connection, _ = self._sock.accept()
        _pid, uid, _gid = _peer_credentials(connection)
        if uid != os.getuid():
            connection.close()
            return None
        return Link(connection, self.path.name)

    def close(self) -> None:
        """Stop listening and remove the path."""
        self._sock.close()
        with contextlib.suppress(FileNotFoundError):
            os.unlink(self.path)


def _peer_credentials(sock: socket.socket) -> tuple[int, int, int]:
    raw = sock.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12)
    pid, uid, gid = (int.from_bytes(raw[i : i + 4], "little", signed=True) for i in (0, 4, 8))
    return pid, uid, gid


def connect(path: Path, timeout_s: float = 10.0, name: str = "") -> Link:
    """Connect to a listening process, waiting up to `timeout_s` for it to appear.

    Raises
    ------
    DeviceError
        Nobody listens at `path` within the time.
    """
    deadline = time.monotonic() + timeout_s
    while True:
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            sock.connect(str(path))
            return Link(sock, name or path.name)
        except OSError as error:
            sock.close()
            if time.monotonic() >= deadline:
                raise DeviceError(
                    f"no process answers within {timeout_s:g} s",
                    place=str(path),
                    remedy="Look at the log of that process in the campaign folder.",
                ) from error
            time.sleep(0.01)
