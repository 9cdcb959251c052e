"""The CANopen side of a bus: the `canopen` library on a shared `CanSession`, and our own heartbeat.

Job: `CanopenNetwork`, shared by all CANopen devices of a bus: a `canopen.Network` whose frames go through the
session, our heartbeat (one every 100 ms while the lease is in force, none otherwise), and the detection of a
second controller with our node id. Not its job: single nodes (`drivers.can.canopen_node`).

A node watches us only from the first heartbeat that it has heard (CiA 301). So when the lease comes into
force, and when a node has been started, some heartbeats follow each other quickly, and no set-point goes out
before them (`heartbeats_since`). One of them may slip; a node that is commanded but does not watch would hold
its output for ever if we died then.
"""

from __future__ import annotations

import logging
import struct
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from drivers.can.cycle import Cycle
from drivers.can.session import CanSession, can_session
from rigctl.core.errors import DeviceError
from rigctl.hal.devices import RigContext

if TYPE_CHECKING:
    import canopen

HEARTBEAT_S = 0.1
FIRST_HEARTBEATS, FIRST_HEARTBEAT_S = 3, 0.02
"""So many heartbeats come before the first set-point, with this period."""
LEASE_S = 0.25
"""How old the lease on set-points may be (contract with the rig's leases)."""
_HEARTBEAT_ID = 0x700
_OPERATIONAL = b"\x05"
_LOOK_S = 0.02
_FOREIGN_HEARTBEATS = 3


class CanopenNetwork:
    """All CANopen nodes of one bus, as their drivers share it. Made by `canopen_network`."""

    def __init__(self, session: CanSession, context: RigContext) -> None:
        self.session = session
        self.lease = context.lease
        self.board = context.board
        self.own_node = session.settings.controller_node
        self.cycle = Cycle(f"canopen {session.name}")
        self.heartbeats = 0
        """Own heartbeats sent since it was opened."""
        self._row_from = 0  # of them, before the lease came into force
        self._hurry_until = FIRST_HEARTBEATS
        self._due_s = 0.0
        self._foreign = 0
        self._users = 0
        self._lock = threading.RLock()
        self._network: canopen.Network | None = None
        self._ends: list[Callable[[], None]] = []

    @property
    def name(self) -> str:
        """Name of the bus."""
        return self.session.name

    def open(self) -> None:
        """One more user; the first opens the bus and starts looking after it.

        Raises
        ------
        DeviceError
            The bus does not open, or the `canopen` library is missing.
        """
        with self._lock:
            if self._users == 0:
                self._network = _shared_network(self.session)
                self.session.open()
                self.heartbeats = self._foreign = self._row_from = 0
                self._hurry_until, self._due_s = FIRST_HEARTBEATS, 0.0
                own_id = _HEARTBEAT_ID + self.own_node
                self._ends = [
                    self.session.subscribe(own_id, self._on_own_id),
                    self.cycle.add(self._heartbeat, FIRST_HEARTBEAT_S, self._on_error),
                    self.cycle.add(self.session.look, 5 * _LOOK_S, self._on_error),
                ]
            self._users += 1

    def close(self) -> None:
        """One user less; never raises."""
        with self._lock:
            if self._users == 0:
                return
            self._users -= 1
            if self._users == 0:
                for end in self._ends:
                    end()
                self._ends = []
                self.session.close()
                self._network = None

    def library(self) -> canopen.Network:
        """The library's network, while open."""
        if self._network is None:
            raise DeviceError("is not open.", place=f"bus {self.name!r}", remedy="Open the device first.")
        return self._network

    def lease_in_force(self) -> bool:
        """Whether the control loop still asks for blocks."""
        return self.lease.in_force(LEASE_S)

    def greet(self) -> int:
        """A node has been started: let quick heartbeats follow. Returns how many there were before."""
        self._hurry_until = max(self._hurry_until, self.heartbeats + FIRST_HEARTBEATS)
        return self.heartbeats

    def heartbeats_since(self, count: int) -> int:
        """Heartbeats sent beyond `count` since the lease is in force; 0 while it is not."""
        return self.heartbeats - max(count, self._row_from) if self.lease_in_force() else 0

    def _heartbeat(self) -> None:
        if not self.lease_in_force() or self.session.failure is not None:
            self._row_from = self.heartbeats
            self._hurry_until = self.heartbeats + FIRST_HEARTBEATS
            self._due_s = 0.0
            return
        now_s = time.monotonic()
        if now_s < self._due_s and self.heartbeats >= self._hurry_until:
            return
        self.session.send(_HEARTBEAT_ID + self.own_node, _OPERATIONAL)
        self.heartbeats += 1
        self._due_s = now_s + HEARTBEAT_S - 0.5 * FIRST_HEARTBEAT_S

    def _on_own_id(self, data: bytes, timestamp_s: float) -> None:
        self._foreign += 1
        if self._foreign >= _FOREIGN_HEARTBEATS:
            self.session.fail(f"another controller with node id {self.own_node} is on the bus: end it")

    def _on_error(self, error: Exception) -> None:
        self.session.fail(f"looking after the bus ended: {error}")


def canopen_network(context: RigContext, bus: str) -> CanopenNetwork:
    """The network of a bus of the rig file; the same object for all devices.

    Raises
    ------
    ConfigError
        The rig file has no such bus.
    """
    session = can_session(context, bus)
    return context.share(f"canopen:{bus}", lambda: CanopenNetwork(session, context))


def _shared_network(session: CanSession) -> canopen.Network:
    """A network of the library that sends and receives through the session."""
    try:
        import canopen
    except ImportError as error:
        raise DeviceError(
            f"the library {error.name!r} is missing: {error}.", place=session.settings.place,
            remedy="Install it: pip install canopen.",
        ) from error  # fmt: skip

    # The library prints time-outs and aborts that `CanopenNode` raises as errors with place and remedy.
    logging.getLogger("canopen").setLevel(logging.CRITICAL)

    class SharedNetwork(canopen.Network):
        """Own sending and subscribing, as the library's manual describes for custom interfaces."""

        def __init__(self) -> None:
            self._unsubscribe: dict[int, Callable[[], None]] = {}
            super().__init__()

        def send_message(self, can_id: int, data: Any, remote: bool = False) -> None:
            if remote:
                raise DeviceError("remote frames are not used.", place=f"bus {session.name!r}")
            session.send(can_id, bytes(data))

        def subscribe(self, can_id: int, callback: Any) -> None:
            super().subscribe(can_id, callback)
            if can_id not in self._unsubscribe:

                def feed(data: bytes, timestamp_s: float) -> None:
                    try:
                        self.notify(can_id, bytearray(data), timestamp_s)
                    except (struct.error, IndexError, ValueError):  # a frame of a wrong length
                        session.statistics.malformed += 1

                self._unsubscribe[can_id] = session.subscribe(can_id, feed)

        def unsubscribe(self, can_id: int, callback: Any = None) -> None:
            super().unsubscribe(can_id, callback)
            if can_id not in self.subscribers:
                self._unsubscribe.pop(can_id)()

        def check(self) -> None:
            session.check()

    return SharedNetwork()
