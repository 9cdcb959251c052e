"""Object dictionary of a CANopen node: entries with type, access, default and bounds.

Job: keep values; refuse wrong reads and writes with the abort code of CiA 301. Not its job: the transfer of
values (`sdo`, `pdo`) and what a value does (callbacks of the owner of the entry).
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Iterator

from sim_hardware.bench.can import datatypes
from sim_hardware.bench.can.datatypes import DataType, Value


class AbortCode(enum.IntEnum):
    """SDO abort codes (CiA 301)."""

    TOGGLE = 0x05030000
    TIMED_OUT = 0x05040000
    BAD_COMMAND = 0x05040001
    OUT_OF_MEMORY = 0x05040005
    UNSUPPORTED_ACCESS = 0x06010000
    WRITE_ONLY = 0x06010001
    READ_ONLY = 0x06010002
    NO_OBJECT = 0x06020000
    NOT_MAPPABLE = 0x06040041
    PDO_TOO_LONG = 0x06040042
    INCOMPATIBLE = 0x06040043
    WRONG_LENGTH = 0x06070010
    TOO_LONG = 0x06070012
    TOO_SHORT = 0x06070013
    NO_SUBINDEX = 0x06090011
    BAD_VALUE = 0x06090030
    TOO_HIGH = 0x06090031
    TOO_LOW = 0x06090032
    GENERAL = 0x08000000
    DEVICE_STATE = 0x08000022
    NO_DATA = 0x08000024


class Abort(Exception):
    """An access that the node refuses, with the code that goes onto the wire."""

    def __init__(self, code: AbortCode) -> None:
        self.code = code
        super().__init__(f"SDO abort {code:08X}h ({code.name})")


class Access(enum.Enum):
    """Access attribute; RWR and RWW may also be mapped into a TPDO or an RPDO."""

    CONST = "const"
    RO = "ro"
    WO = "wo"
    RW = "rw"
    RWR = "rwr"
    RWW = "rww"


class Entry:
    """One object (or one of its sub-objects).

    Parameters
    ----------
    index, sub : int
    name : str
    kind : DataType
    access : Access
    default : Value
        Value from power-on and after a reset.
    low, high : int or float or None
        Bounds of written values, beyond those of the type.
    mappable : bool
        May be mapped into PDOs: readable objects into TPDOs, writable ones into RPDOs.
    getter : callable or None
        Gives the value instead of the kept one.
    check : callable or None
        Called with the new value before it is kept; raises `Abort` to refuse it.
    written : callable or None
        Called after a write.
    """

    __slots__ = (
        "access", "check", "default", "getter", "high", "index", "kind", "low", "mappable", "max_bytes",
        "name", "sub", "value", "written",
    )  # fmt: skip

    def __init__(
        self,
        index: int,
        sub: int,
        name: str,
        kind: DataType,
        access: Access,
        default: Value = 0,
        *,
        low: float | None = None,
        high: float | None = None,
        mappable: bool = False,
        max_bytes: int = 256,
        getter: Callable[[], Value] | None = None,
        check: Callable[[Value], None] | None = None,
        written: Callable[[], None] | None = None,
    ) -> None:
        datatypes.encode(kind, default)
        self.index, self.sub, self.name = index, sub, name
        self.kind, self.access, self.default = kind, access, default
        self.low, self.high, self.mappable, self.max_bytes = low, high, mappable, max_bytes
        self.getter, self.check, self.written = getter, check, written
        self.value: Value = default

    @property
    def bits(self) -> int:
        """Length in a PDO; 0 where it varies."""
        return 8 * (datatypes.size_bytes(self.kind) or 0)

    @property
    def readable(self) -> bool:
        return self.access is not Access.WO

    @property
    def writable(self) -> bool:
        return self.access in (Access.WO, Access.RW, Access.RWR, Access.RWW)

    def get(self) -> Value:
        """Present value."""
        return self.value if self.getter is None else self.getter()

    def number(self) -> int:
        """Present value of an integer object."""
        value = self.get()
        assert isinstance(value, int), f"{self.index:04X}h is not an integer"
        return value

    def accept(self, data: bytes) -> Value:
        """The value of written bytes, if the entry takes it; nothing changes yet.

        Raises
        ------
        Abort
            Not writable, wrong length, out of bounds, or refused by `check`.
        """
        if not self.writable:
            raise Abort(AbortCode.READ_ONLY)
        size = datatypes.size_bytes(self.kind)
        if size is not None and len(data) != size:
            raise Abort(AbortCode.TOO_LONG if len(data) > size else AbortCode.TOO_SHORT)
        if size is None and len(data) > self.max_bytes:
            raise Abort(AbortCode.TOO_LONG)
        try:
            value = datatypes.decode(self.kind, data)
        except ValueError:
            raise Abort(AbortCode.BAD_VALUE) from None
        if isinstance(value, int | float):
            self._check_bounds(value)
        if self.check is not None:
            self.check(value)
        return value

    def _check_bounds(self, value: float) -> None:
        if self.kind is DataType.BOOLEAN and value not in (0, 1):
            raise Abort(AbortCode.TOO_HIGH)
        if self.high is not None and value > self.high:
            raise Abort(AbortCode.TOO_HIGH)
        if self.low is not None and value < self.low:
            raise Abort(AbortCode.TOO_LOW)

    def keep(self, value: Value) -> None:
        """Keep a value that `accept` has given, and tell the owner."""
        self.value = value
        if self.written is not None:
            self.written()


class ObjectDictionary:
    """All entries of a node."""

    def __init__(self) -> None:
        self._entries: dict[tuple[int, int], Entry] = {}
        self._indices: set[int] = set()

    def add(self, entry: Entry) -> Entry:
        """Take an entry in; an index and sub-index may come once only."""
        key = (entry.index, entry.sub)
        if key in self._entries:
            raise ValueError(f"object {entry.index:04X}h:{entry.sub} is there already")
        self._entries[key] = entry
        self._indices.add(entry.index)
        return entry

    def add_count(self, index: int, highest: int) -> Entry:
        """Sub-index 0 of an array or record whose highest sub-index never changes."""
        return self.add(
            Entry(index, 0, "highest sub-index supported", DataType.UNSIGNED8, Access.CONST, highest)
        )

    def __iter__(self) -> Iterator[Entry]:
        return iter(self._entries.values())

    def find(self, index: int, sub: int) -> Entry:
        """The entry.

        Raises
        ------
        Abort
            There is none: NO_OBJECT or NO_SUBINDEX.
        """
        entry = self._entries.get((index, sub))
        if entry is None:
            raise Abort(AbortCode.NO_SUBINDEX if index in self._indices else AbortCode.NO_OBJECT)
        return entry

    def read(self, index: int, sub: int) -> bytes:
        """Bytes for an SDO upload."""
        entry = self.find(index, sub)
        if not entry.readable:
            raise Abort(AbortCode.WRITE_ONLY)
        return datatypes.encode(entry.kind, entry.get())

    def write(self, index: int, sub: int, data: bytes) -> None:
        """Take the bytes of an SDO download."""
        entry = self.find(index, sub)
        entry.keep(entry.accept(data))

    def reset(self, first: int = 0x0000, last: int = 0xFFFF) -> None:
        """Power-on values for the objects of a range, without telling their owners."""
        for entry in self._entries.values():
            if first <= entry.index <= last:
                entry.value = entry.default
