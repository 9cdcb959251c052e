"""Heartbeat consumer of a node (1016h): which nodes it watches, and which of them have fallen silent.

Job: start with the first heartbeat heard, report loss and return. Not its job: what the node does about it.
"""

from __future__ import annotations

from collections.abc import Callable

from sim_hardware.bench.can.datatypes import DataType, Value
from sim_hardware.bench.can.dictionary import Abort, AbortCode, Access, Entry, ObjectDictionary
from sim_hardware.bench.can.frames import HIGHEST_NODE
from sim_hardware.bench.can.scheduler import NS_PER_MS, Scheduler, Timer

SLOTS = 4


def consumer_word(node_id: int, time_ms: int) -> int:
    """Value of an entry of 1016h."""
    return node_id << 16 | time_ms


class HeartbeatConsumer:
    """Watches up to four nodes.

    Parameters
    ----------
    dictionary : ObjectDictionary
        Gets 1016h.
    defaults : sequence of (node, time in ms)
        Watched from power-on.
    lost, back : callable
        Called with the node that fell silent or is heard again.
    changed : callable
        Another set of nodes is to be heard.
    """

    def __init__(
        self,
        dictionary: ObjectDictionary,
        scheduler: Scheduler,
        defaults: list[tuple[int, int]],
        *,
        lost: Callable[[int], None],
        back: Callable[[int], None],
        changed: Callable[[], None],
    ) -> None:
        self._scheduler, self._lost, self._back, self._changed = scheduler, lost, back, changed
        dictionary.add_count(0x1016, SLOTS)
        words = [consumer_word(*entry) for entry in defaults] + [0] * (SLOTS - len(defaults))
        self._entries = [
            dictionary.add(
                Entry(
                    0x1016,
                    sub,
                    "consumer heartbeat time",
                    DataType.UNSIGNED32,
                    Access.RW,
                    word,
                    check=lambda value, sub=sub: self._check(sub, value),
                    written=self.restart,
                )
            )
            for sub, word in enumerate(words, start=1)
        ]
        self._timers: dict[int, Timer] = {}
        self._silent: set[int] = set()

    def watched(self) -> dict[int, int]:
        """Watched nodes and their times in ms."""
        words = [entry.number() for entry in self._entries]
        return {word >> 16 & 0x7F: word & 0xFFFF for word in words if word >> 16 & 0x7F and word & 0xFFFF}

    @property
    def silent(self) -> frozenset[int]:
        """Nodes that were heard once and are silent now."""
        return frozenset(self._silent)

    def restart(self) -> None:
        """Begin anew: each node is watched from its next heartbeat on; losses are forgotten."""
        for timer in self._timers.values():
            timer.cancel()
        self._timers.clear()
        for node in sorted(self._silent):
            self._back(node)
        self._silent.clear()
        self._changed()

    def heard(self, node: int) -> None:
        """A heartbeat of this node has arrived."""
        time_ms = self.watched().get(node)
        if time_ms is None:
            return
        timer = self._timers.get(node)
        if timer is not None:
            timer.cancel()
        self._timers[node] = self._scheduler.after(time_ms * NS_PER_MS, lambda _due: self._expired(node))
        if node in self._silent:
            self._silent.discard(node)
            self._back(node)

    def _expired(self, node: int) -> None:
        self._timers.pop(node, None)
        self._silent.add(node)
        self._lost(node)

    def _check(self, sub: int, value: Value) -> None:
        assert isinstance(value, int)
        node, time_ms = value >> 16 & 0xFF, value & 0xFFFF
        if value >> 24:
            raise Abort(AbortCode.BAD_VALUE)
        if node and time_ms:
            if node > HIGHEST_NODE:
                raise Abort(AbortCode.BAD_VALUE)
            others = (entry.number() for entry in self._entries if entry.sub != sub)
            if any(other >> 16 == node and other & 0xFFFF for other in others):
                raise Abort(AbortCode.INCOMPATIBLE)
