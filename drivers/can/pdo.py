"""Process data objects of a remote node: what they must carry, compared by read-back, set where allowed.

Job: `PdoSetup`, `ensure_pdo`, and the heartbeat consumer entry (1016h) that makes the node watch us. Not its
job: decoding frames (`drivers.can.objects.PdoCodec`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from drivers.can.canopen_node import CanopenNode
from drivers.can.objects import ObjectRef, PdoCodec
from rigctl.core.errors import DeviceError

_DISABLED = 0x8000_0000
_ID_MASK = 0x1FFF_FFFF
_EVENT_DRIVEN = (254, 255)
PRODUCER = ObjectRef(0x1017, 0, "u16")
CONSUMER_COUNT = ObjectRef(0x1016, 0, "u8")


@dataclass(frozen=True, slots=True)
class PdoSetup:
    """One PDO as we need it.

    Attributes
    ----------
    transmitted : bool
        From the node's view: True for a TPDO (it sends), False for an RPDO.
    number : int
        1 to 512.
    cob_id : int
    objects : tuple of ObjectRef
        In the order of the mapping.
    transmission : int
        Type after CiA 301; 254 and 255 count as equal.
    event_ms : int or None
        Event timer of a TPDO; None: as it is.
    """

    transmitted: bool
    number: int
    cob_id: int
    objects: tuple[ObjectRef, ...]
    transmission: int = 255
    event_ms: int | None = None

    @property
    def name(self) -> str:
        """ "TPDO1"."""
        return f"{'T' if self.transmitted else 'R'}PDO{self.number}"

    @property
    def codec(self) -> PdoCodec:
        """Packs and unpacks its frames."""
        return PdoCodec(self.objects)

    def communication(self, sub: int, kind: str) -> ObjectRef:
        """Entry of the communication record."""
        return ObjectRef((0x1800 if self.transmitted else 0x1400) + self.number - 1, sub, kind)

    def mapping(self, sub: int) -> ObjectRef:
        """Entry of the mapping record."""
        base = 0x1A00 if self.transmitted else 0x1600
        return ObjectRef(base + self.number - 1, sub, "u8" if sub == 0 else "u32")


def differences(node: CanopenNode, setup: PdoSetup) -> list[str]:
    """What the node's PDO is otherwise than in `setup`, by read-back, in words."""
    found: list[str] = []
    cob = node.read(setup.communication(1, "u32"))
    if cob & _DISABLED or cob & _ID_MASK != setup.cob_id:
        off = " and off" if cob & _DISABLED else ""
        found.append(f"{setup.name} has identifier {cob & _ID_MASK:03X}h{off} instead of {setup.cob_id:03X}h")
    kind = node.read(setup.communication(2, "u8"))
    if kind != setup.transmission and not (kind in _EVENT_DRIVEN and setup.transmission in _EVENT_DRIVEN):
        found.append(f"{setup.name} has transmission type {kind} instead of {setup.transmission}")
    if setup.transmitted and setup.event_ms is not None:
        event_ms = node.read(setup.communication(5, "u16"))
        if event_ms != setup.event_ms:
            found.append(f"{setup.name} is sent every {event_ms} ms instead of {setup.event_ms} ms")
    count = node.read(setup.mapping(0))
    mapped = [node.read(setup.mapping(sub)) for sub in range(1, min(count, 8) + 1)]
    wanted = [entry.mapping for entry in setup.objects]
    if mapped != wanted:
        found.append(f"{setup.name} carries [{_shown(mapped)}] instead of [{_shown(wanted)}]")
    return found


def ensure_pdo(node: CanopenNode, setup: PdoSetup, *, configure: bool) -> list[str]:
    """Compare a PDO with what we need; set it if that is allowed; compare again.

    Returns
    -------
    list of str
        What was changed.

    Raises
    ------
    DeviceError
        It differs and may not, or could not, be set.
    """
    return _ensure(node, lambda: differences(node, setup), lambda: _set_pdo(node, setup), configure=configure)


def ensure_heartbeats(
    node: CanopenNode, *, produce_ms: int, consume_limit_ms: int, configure: bool
) -> list[str]:
    """See that the node sends heartbeats and watches ours.

    Parameters
    ----------
    node : CanopenNode
    produce_ms : int
        Its heartbeats must come at least that often.
    consume_limit_ms : int
        It must miss ours within this time.
    configure : bool
        Set what differs.

    Returns
    -------
    list of str
        What was changed.

    Raises
    ------
    DeviceError
        It differs and may not, or could not, be set.
    """
    own = node.network.own_node

    def compare() -> list[str]:
        found: list[str] = []
        produced_ms = node.read(PRODUCER)
        if not 0 < produced_ms <= produce_ms:
            found.append(f"it sends a heartbeat every {produced_ms} ms (1017h) instead of {produce_ms} ms")
        watched = [value for value in _consumers(node) if value >> 16 & 0x7F == own and value & 0xFFFF]
        if not any(value & 0xFFFF <= consume_limit_ms for value in watched):
            limits = ", ".join(f"{value & 0xFFFF} ms" for value in watched) or "not at all"
            found.append(f"it watches our heartbeat {limits} (1016h) instead of {consume_limit_ms} ms")
        return found

    def repair() -> None:
        node.write(PRODUCER, produce_ms)
        values = _consumers(node)
        free = [sub for sub, value in enumerate(values, 1) if value >> 16 & 0x7F in (0, own)]
        if not free:
            raise DeviceError(
                "has no free entry to watch our heartbeat (1016h).", place=node.place,
                remedy="Free one with the maker's tool.",
            )  # fmt: skip
        entry = next((sub for sub in free if values[sub - 1] >> 16 & 0x7F == own), free[0])
        node.write(ObjectRef(0x1016, entry, "u32"), own << 16 | consume_limit_ms)

    return _ensure(node, compare, repair, configure=configure)


def ensure_value(
    node: CanopenNode, entry: ObjectRef, value: int, meaning: str, *, configure: bool
) -> list[str]:
    """See that an object has a value; `meaning` says what it does otherwise, for the message."""

    def compare() -> list[str]:
        found = node.read(entry)
        return [] if found == value else [f"{entry} is {found} instead of {value} ({meaning})"]

    return _ensure(node, compare, lambda: node.write(entry, value), configure=configure)


def _ensure(
    node: CanopenNode, compare: Callable[[], list[str]], repair: Callable[[], None], *, configure: bool
) -> list[str]:
    found = compare()
    if not found:
        return []
    if not configure:
        raise DeviceError(
            f"is set up otherwise: {'; '.join(found)}.", place=node.place,
            remedy="Set it with the maker's tool, or allow it here: configure = true.",
        )  # fmt: skip
    repair()
    left = compare()
    if left:
        raise DeviceError(
            f"does not keep its settings: {'; '.join(left)}.", place=node.place,
            remedy="Set it with the maker's tool.",
        )  # fmt: skip
    return found


def _consumers(node: CanopenNode) -> list[int]:
    return [node.read(ObjectRef(0x1016, sub, "u32")) for sub in range(1, node.read(CONSUMER_COUNT) + 1)]


def _set_pdo(node: CanopenNode, setup: PdoSetup) -> None:
    """The order of CiA 301: off, type, timer, mapping off, entries, count, on."""
    node.write(setup.communication(1, "u32"), _DISABLED | setup.cob_id)
    node.write(setup.communication(2, "u8"), setup.transmission)
    if setup.transmitted and setup.event_ms is not None:
        node.write(setup.communication(5, "u16"), setup.event_ms)
    node.write(setup.mapping(0), 0)
    for sub, entry in enumerate(setup.objects, 1):
        try:
            node.write(setup.mapping(sub), entry.mapping)
        except DeviceError as error:
            raise DeviceError(
                f"cannot put {entry} into {setup.name}: {error.problem}", place=node.place,
                remedy="Compare the object's index and type with the device's manual.",
            ) from error  # fmt: skip
    node.write(setup.mapping(0), len(setup.objects))
    node.write(setup.communication(1, "u32"), setup.cob_id)


def _shown(mapped: list[int]) -> str:
    return ", ".join(f"{value:08X}h" for value in mapped)
