"""Where the host's end of a bench port is: a pty with a stable name, or a TCP port.

Job: bytes in, bytes out, plug in, plug pulled. Not its job: time and faults (`ports`).
"""

from __future__ import annotations

import errno
import os
import socket
import termios
import tty
from pathlib import Path
from typing import Any, Protocol

_READ_BYTES = 4096


class Transport(Protocol):
    """The host's end of a port."""

    @property
    def address(self) -> str:
        """What the host opens."""
        ...

    def plug(self) -> None:
        """Make the port; nothing when it is there."""
        ...

    def unplug(self) -> None:
        """Take it away: a host that has it open gets an error."""
        ...

    def descriptors(self) -> list[int]:
        """Descriptors to wait for."""
        ...

    def read(self) -> bytes:
        """What the host has sent; empty when nothing."""
        ...

    def write(self, data: bytes) -> None:
        """Hand bytes to the host; they are lost when it does not take them."""
        ...

    def speed_is(self, baud: int) -> bool:
        """Whether the host has set this speed, as far as that can be known."""
        ...


class PtyTransport:
    """A pty behind a symbolic link.

    When the last host has closed it, its settings go back to where they began: the C library refuses to set 7
    data bits on a pty that has been set to them before, which no real port does.
    """

    def __init__(self, link: Path) -> None:
        self._link = link
        self._master = -1
        self._path = ""
        self._host_there = False
        self._fresh: list[Any] = []

    @property
    def address(self) -> str:
        """The link's path."""
        return str(self._link)

    def plug(self) -> None:
        """See `Transport.plug`. The link replaces one left by a bench that was killed."""
        if self._master >= 0:
            return
        self._master, slave = os.openpty()
        tty.setraw(slave)
        self._fresh = termios.tcgetattr(slave)
        os.set_blocking(self._master, False)
        self._path = os.ttyname(slave)
        os.close(slave)
        self._host_there = False
        self._link.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        fresh = self._link.with_name(f".{self._link.name}.{os.getpid()}")
        fresh.unlink(missing_ok=True)
        fresh.symlink_to(self._path)
        fresh.replace(self._link)

    def unplug(self) -> None:
        """See `Transport.unplug`."""
        if self._master < 0:
            return
        os.close(self._master)
        self._master = -1
        if self._link.is_symlink() and str(self._link.readlink()) == self._path:
            self._link.unlink(missing_ok=True)

    def descriptors(self) -> list[int]:
        """See `Transport.descriptors`."""
        return [self._master] if self._master >= 0 and self._host_there else []

    def read(self) -> bytes:
        """See `Transport.read`."""
        if self._master < 0:
            return b""
        try:
            data = os.read(self._master, _READ_BYTES)
        except BlockingIOError:
            data = b""
        except OSError as error:
            if error.errno != errno.EIO:  # EIO: no host has it open
                raise
            if self._host_there:
                self._host_there = False
                termios.tcsetattr(self._master, termios.TCSANOW, self._fresh)
            return b""
        self._host_there = True
        return data

    def write(self, data: bytes) -> None:
        """See `Transport.write`."""
        if self._master < 0 or not self._host_there:
            return
        try:
            os.write(self._master, data)
        except OSError:
            pass  # nobody reads, or the host has just gone: the bytes are lost, as on a wire

    def speed_is(self, baud: int) -> bool:
        """See `Transport.speed_is`. A pty forgets parity and character length, not the speed."""
        symbol = getattr(termios, f"B{baud}", None)
        return symbol is None or termios.tcgetattr(self._master)[5] == symbol


class TcpTransport:
    """A TCP port on this machine, for one host at a time; a new host replaces the old one."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._listener: socket.socket | None = None
        self._peer: socket.socket | None = None

    @property
    def address(self) -> str:
        """A ``socket://`` address for pyserial."""
        return f"socket://127.0.0.1:{self._port}"

    def plug(self) -> None:
        """See `Transport.plug`."""
        if self._listener is None:
            self._listener = socket.create_server(("127.0.0.1", self._port), backlog=1)
            self._listener.setblocking(False)
            self._port = self._listener.getsockname()[1]

    def unplug(self) -> None:
        """See `Transport.unplug`."""
        for end in (self._listener, self._peer):
            if end is not None:
                end.close()
        self._listener = self._peer = None

    def descriptors(self) -> list[int]:
        """See `Transport.descriptors`."""
        return [end.fileno() for end in (self._listener, self._peer) if end is not None]

    def read(self) -> bytes:
        """See `Transport.read`."""
        if self._listener is not None:
            try:
                peer, _ = self._listener.accept()
            except BlockingIOError:
                pass
            else:
                if self._peer is not None:
                    self._peer.close()
                peer.setblocking(False)
                peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._peer = peer
        if self._peer is None:
            return b""
        try:
            data = self._peer.recv(_READ_BYTES)
        except BlockingIOError:
            return b""
        except OSError:
            data = b""
        if not data:
            self._peer.close()
            self._peer = None
        return data

    def write(self, data: bytes) -> None:
        """See `Transport.write`."""
        if self._peer is not None:
            try:
                self._peer.send(data)
            except OSError:
                pass  # the host is gone; the next read notices

    def speed_is(self, baud: int) -> bool:
        """See `Transport.speed_is`: a socket has no speed."""
        return True
