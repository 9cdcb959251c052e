"""Process data objects of a node (CiA 301): mapping, event timer, inhibit time, SYNC, remote request.

Job: put values of the object dictionary into frames and take them out again, when the communication
parameters say so. Not its job: the values, and the NMT state (the node starts and stops its PDOs).
"""

from __future__ import annotations

import struct
from collections.abc import Callable

from sim_hardware.bench.can.datatypes import LETTERS, DataType, Value, encode
from sim_hardware.bench.can.dictionary import Abort, AbortCode, Access, Entry, ObjectDictionary
from sim_hardware.bench.can.frames import Frame, is_restricted
from sim_hardware.bench.can.scheduler import NS_PER_MS, Scheduler, Timer

INVALID = 1 << 31
NO_REMOTE = 1 << 30
EXTENDED = 1 << 29
MAX_ENTRIES = 8
MAX_BITS = 64
NS_PER_INHIBIT = 100_000  # unit of the inhibit time
_SYNC_MAX = 240
_EVENT_TYPES = (254, 255)
#: Dummy objects of CiA 301: their bits in an RPDO are skipped.
_DUMMIES = {
    0x0001: 1, 0x0002: 8, 0x0003: 16, 0x0004: 32, 0x0005: 8, 0x0006: 16, 0x0007: 32,
}  # fmt: skip

Mapping = tuple[tuple[int, int, int], ...]


def mapping_word(index: int, sub: int, bits: int) -> int:
    """Entry of a mapping object."""
    return index << 16 | sub << 8 | bits


class Layout:
    """How mapped objects lie in a frame: the first at the lowest bits of the first byte.

    Parameters
    ----------
    parts : sequence of (Entry or None, int)
        Object (None: dummy) and its length in bits.
    """

    def __init__(self, parts: list[tuple[Entry | None, int]]) -> None:
        self.parts = parts
        self.bits = sum(bits for _, bits in parts)
        self.bytes = (self.bits + 7) // 8
        entries = [entry for entry, _ in parts if entry is not None]
        plain = len(entries) == len(parts) and all(
            entry.kind in LETTERS and entry.kind is not DataType.BOOLEAN and bits == entry.bits
            for entry, bits in zip(entries, (bits for _, bits in parts), strict=True)
        )
        self._entries = entries
        self._struct = (
            struct.Struct("<" + "".join(LETTERS[entry.kind] for entry in entries)) if plain else None
        )

    def pack(self) -> bytes:
        """Payload of the present values."""
        if self._struct is not None:
            return self._struct.pack(*[entry.get() for entry in self._entries])
        word, position = 0, 0
        for entry, bits in self.parts:
            raw = int.from_bytes(encode(entry.kind, entry.get()), "little") if entry is not None else 0
            word |= (raw & (1 << bits) - 1) << position
            position += bits
        return word.to_bytes(self.bytes, "little")

    def unpack(self, data: bytes) -> list[tuple[Entry, Value]]:
        """Values for the mapped objects, checked as written ones are.

        Raises
        ------
        Abort
            An object refuses its value; then none may be taken.
        """
        word, position = int.from_bytes(data[: self.bytes], "little"), 0
        values: list[tuple[Entry, Value]] = []
        for entry, bits in self.parts:
            if entry is not None:
                raw = (word >> position & (1 << bits) - 1).to_bytes((bits + 7) // 8, "little")
                values.append((entry, entry.accept(raw)))
            position += bits
        return values


class Pdo:
    """What transmit and receive PDOs have in common: their parameters in the dictionary.

    Parameters
    ----------
    dictionary : ObjectDictionary
    number : int
        0-based.
    cob_id : int
        From power-on.
    mapping : sequence of (index, sub, bits)
    transmission : int
        Type from power-on.
    event_ms : int
        Event time from power-on (transmit PDOs).
    changed : callable
        The identifier or the mapping has changed.
    """

    communication = 0x1400
    mapping = 0x1600
    timed = False

    def __init__(
        self,
        dictionary: ObjectDictionary,
        number: int,
        cob_id: int,
        mapping: Mapping,
        *,
        transmission: int,
        changed: Callable[[], None],
        event_ms: int = 0,
    ) -> None:
        self._dictionary = dictionary
        self._changed = changed
        u8, u16, u32 = DataType.UNSIGNED8, DataType.UNSIGNED16, DataType.UNSIGNED32
        index, rw = self.communication + number, Access.RW
        dictionary.add_count(index, 5 if self.timed else 2)
        self._cob = dictionary.add(
            Entry(index, 1, "COB-ID", u32, rw, cob_id, check=self._check_cob, written=self._restart)
        )
        self._type = dictionary.add(
            Entry(
                index,
                2,
                "transmission type",
                u8,
                rw,
                transmission,
                check=self._check_type,
                written=self._restart,
            )
        )
        if self.timed:
            self._inhibit = dictionary.add(
                Entry(index, 3, "inhibit time, 0.1 ms", u16, rw, 0, check=self._check_unused)
            )
            self._event = dictionary.add(
                Entry(index, 5, "event timer, ms", u16, rw, event_ms, written=self._restart)
            )
        index = self.mapping + number
        self._count = dictionary.add(
            Entry(
                index,
                0,
                "number of mapped objects",
                u8,
                rw,
                len(mapping),
                high=MAX_ENTRIES,
                check=self._check_count,
                written=self._compile,
            )
        )
        words = [mapping_word(*place) for place in mapping] + [0] * (MAX_ENTRIES - len(mapping))
        self._words = [
            dictionary.add(Entry(index, sub, "mapped object", u32, rw, word, check=self._check_word))
            for sub, word in enumerate(words, start=1)
        ]
        self._layout: Layout | None = None

    @property
    def cob_id(self) -> int:
        """Identifier on the bus."""
        return self._cob.number() & 0x7FF

    @property
    def valid(self) -> bool:
        """The PDO exists and has something in it."""
        return not self._cob.number() & INVALID and self._count.number() > 0

    @property
    def transmission(self) -> int:
        """Transmission type."""
        return self._type.number()

    @property
    def layout(self) -> Layout:
        """Mapping in force."""
        if self._layout is None:
            self._layout = Layout([self._part(word.number()) for word in self._words[: self._count.number()]])
        return self._layout

    def restart(self) -> None:
        """Parameters have changed as a whole (reset): begin anew."""
        self._layout = None
        self._restart()

    def _restart(self) -> None:
        self._changed()

    def _compile(self) -> None:
        self._layout = None
        self._restart()

    def _part(self, word: int) -> tuple[Entry | None, int]:
        """Object behind an entry of the mapping; raises `Abort` when it cannot be mapped."""
        index, sub, bits = word >> 16, word >> 8 & 0xFF, word & 0xFF
        if self._takes_dummies() and index in _DUMMIES:
            if sub != 0 or bits != _DUMMIES[index]:
                raise Abort(AbortCode.NOT_MAPPABLE)
            return None, bits
        entry = self._dictionary.find(index, sub)
        if not entry.mappable or not self._fits(entry) or bits == 0:
            raise Abort(AbortCode.NOT_MAPPABLE)
        if bits != entry.bits and not (entry.kind is DataType.BOOLEAN and bits == 1):
            raise Abort(AbortCode.NOT_MAPPABLE)
        return entry, bits

    def _fits(self, entry: Entry) -> bool:
        return entry.writable

    def _takes_dummies(self) -> bool:
        return True

    def _check_unused(self, value: Value) -> None:
        if not self._cob.number() & INVALID:
            raise Abort(AbortCode.DEVICE_STATE)

    def _check_cob(self, value: Value) -> None:
        assert isinstance(value, int)
        old = self._cob.number()
        same = (value ^ old) & ~(INVALID | NO_REMOTE) == 0
        if value & EXTENDED or value & 0x1FFFF800 or is_restricted(value & 0x7FF):
            raise Abort(AbortCode.BAD_VALUE)
        if not old & INVALID and not value & INVALID and not same:
            raise Abort(AbortCode.BAD_VALUE)  # switch it off first

    def _check_type(self, value: Value) -> None:
        if value not in _EVENT_TYPES and not (isinstance(value, int) and 0 <= value <= _SYNC_MAX):
            raise Abort(AbortCode.BAD_VALUE)

    def _check_word(self, value: Value) -> None:
        if self._count.number() != 0 or not self._cob.number() & INVALID:
            raise Abort(AbortCode.DEVICE_STATE)
        assert isinstance(value, int)
        if value:
            self._part(value)

    def _check_count(self, value: Value) -> None:
        assert isinstance(value, int)
        if not self._cob.number() & INVALID:
            raise Abort(AbortCode.DEVICE_STATE)
        if sum(self._part(word.number())[1] for word in self._words[:value]) > MAX_BITS:
            raise Abort(AbortCode.PDO_TOO_LONG)


class Tpdo(Pdo):
    """A PDO that the node sends.

    Parameters beyond `Pdo`'s
    -------------------------
    scheduler : Scheduler
    send : callable
    refresh : callable
        Called with the due time before a frame is packed, to bring the values up to date.
    """

    communication = 0x1800
    mapping = 0x1A00
    timed = True

    def __init__(
        self,
        dictionary: ObjectDictionary,
        number: int,
        cob_id: int,
        mapping: Mapping,
        *,
        event_ms: int,
        changed: Callable[[], None],
        scheduler: Scheduler,
        send: Callable[[Frame], None],
        refresh: Callable[[int], None],
        transmission: int = 254,
    ) -> None:
        super().__init__(
            dictionary, number, cob_id, mapping, transmission=transmission, event_ms=event_ms, changed=changed
        )
        self._scheduler, self._send, self._refresh = scheduler, send, refresh
        self._timer: Timer | None = None
        self._waiting: Timer | None = None
        self._running = False
        self._pending = False
        self._syncs = 0
        self._sent_ns: int | None = None

    def _fits(self, entry: Entry) -> bool:
        return entry.readable

    def _takes_dummies(self) -> bool:
        return False

    def start(self) -> None:
        """The node became operational: event-driven PDOs are sent once, and then as their timer says."""
        self._running = True
        self._restart()
        self.event()

    def stop(self) -> None:
        """The node is no longer operational."""
        self._running = False
        self._pending = False
        self._restart()

    def _restart(self) -> None:
        for timer in (self._timer, self._waiting):
            if timer is not None:
                timer.cancel()
        self._timer = self._waiting = None
        period_ms = self._event.number()
        if self._running and self.valid and period_ms and self.transmission in _EVENT_TYPES:
            self._timer = self._scheduler.every(period_ms * NS_PER_MS, self._transmit)
        super()._restart()

    def event(self) -> None:
        """The application has something new; sent at once, after the inhibit time, or with the next SYNC."""
        if not (self._running and self.valid):
            return
        if self.transmission == 0:
            self._pending = True
        elif self.transmission in _EVENT_TYPES and self._waiting is None:
            now_ns = self._scheduler.now_ns
            pause_ns = self._inhibit.number() * NS_PER_INHIBIT
            free_ns = now_ns if self._sent_ns is None else self._sent_ns + pause_ns
            if free_ns <= now_ns:
                self._transmit(now_ns)
            else:
                self._waiting = self._scheduler.after(free_ns - now_ns, self._transmit_late)

    def sync(self) -> None:
        """A SYNC has been heard."""
        if not (self._running and self.valid and self.transmission <= _SYNC_MAX):
            return
        self._syncs += 1
        if self.transmission == 0:
            due, self._pending = self._pending, False
        else:
            due = self._syncs % self.transmission == 0
        if due:
            self._transmit(self._scheduler.now_ns)

    def remote(self) -> None:
        """Somebody asks for it with a remote frame."""
        if self._running and self.valid and not self._cob.number() & NO_REMOTE:
            self._transmit(self._scheduler.now_ns)

    def _transmit_late(self, due_ns: int) -> None:
        self._waiting = None
        self._transmit(due_ns)

    def _transmit(self, due_ns: int) -> None:
        self._sent_ns = due_ns
        self._refresh(due_ns)
        self._send(Frame(self.cob_id, self.layout.pack()))


class Rpdo(Pdo):
    """A PDO that the node receives.

    Parameters beyond `Pdo`'s
    -------------------------
    received : callable
        Called after the values of a frame have been taken.
    too_short : callable
        Called when a frame has fewer bytes than are mapped; its values are not taken.
    """

    def __init__(
        self,
        dictionary: ObjectDictionary,
        number: int,
        cob_id: int,
        mapping: Mapping,
        *,
        changed: Callable[[], None],
        received: Callable[[int], None],
        too_short: Callable[[int], None],
        transmission: int = 255,
    ) -> None:
        super().__init__(dictionary, number, cob_id, mapping, transmission=transmission, changed=changed)
        self._number, self._received, self._too_short = number, received, too_short
        self._kept: bytes | None = None
        self.refused = 0

    def forget(self) -> None:
        """A frame that waits for SYNC is dropped (the node is no longer operational)."""
        self._kept = None

    def frame(self, data: bytes) -> None:
        """A frame with this PDO's identifier, while the node is operational."""
        if len(data) < self.layout.bytes:
            self._too_short(self._number)
        elif self.transmission <= _SYNC_MAX:
            self._kept = data
        else:
            self._take(data)

    def sync(self) -> None:
        """A SYNC has been heard."""
        if self._kept is not None:
            data, self._kept = self._kept, None
            self._take(data)

    def _take(self, data: bytes) -> None:
        try:
            values = self.layout.unpack(data)
        except Abort:
            self.refused += 1
            return
        for entry, value in values:
            entry.value = value
        self._received(self._number)
