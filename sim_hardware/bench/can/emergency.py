"""Errors of a node: error register 1001h, history 1003h and emergency frames (CiA 301).

Job: remember which errors are present, tell the bus of each that comes or goes. Not its job: finding errors.
"""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Callable

from sim_hardware.bench.can.datatypes import DataType, Value
from sim_hardware.bench.can.dictionary import Abort, AbortCode, Access, Entry, ObjectDictionary
from sim_hardware.bench.can.frames import EMCY, Frame, is_restricted

NO_ERROR = 0x0000
HEARTBEAT_LOST = 0x8130
PDO_TOO_SHORT = 0x8210

GENERIC, CURRENT, VOLTAGE, TEMPERATURE, COMMUNICATION, PROFILE, MANUFACTURER = (
    1 << n for n in (0, 1, 2, 3, 4, 5, 7)
)
HISTORY = 8
_INVALID = 1 << 31


class Emergencies:
    """Errors of one node.

    Parameters
    ----------
    dictionary : ObjectDictionary
        Gets 1001h, 1003h and 1014h.
    node_id : int
    send : callable
        Sends a frame if the node's NMT state allows it.
    """

    def __init__(self, dictionary: ObjectDictionary, node_id: int, send: Callable[[Frame], None]) -> None:
        self._send = send
        self._present: dict[tuple[int, int], int] = {}
        self._history: deque[int] = deque(maxlen=HISTORY)
        self._register = dictionary.add(
            Entry(0x1001, 0, "error register", DataType.UNSIGNED8, Access.RO, mappable=True)
        )
        dictionary.add(
            Entry(
                0x1003,
                0,
                "number of errors",
                DataType.UNSIGNED8,
                Access.RW,
                getter=lambda: len(self._history),
                check=self._check_clear,
                written=self._history.clear,
            )
        )
        for sub in range(1, HISTORY + 1):
            dictionary.add(
                Entry(
                    0x1003,
                    sub,
                    "error field",
                    DataType.UNSIGNED32,
                    Access.RO,
                    getter=lambda sub=sub: self._past(sub),
                )
            )
        self._cob = dictionary.add(
            Entry(
                0x1014,
                0,
                "COB-ID EMCY",
                DataType.UNSIGNED32,
                Access.RW,
                EMCY + node_id,
                check=self._check_cob,
            )
        )

    @property
    def cob_id(self) -> int:
        """Identifier of the emergency frames."""
        return self._cob.number() & 0x7FF

    @property
    def newest(self) -> int:
        """Code of the newest error that is present; 0 without errors."""
        return next(reversed(self._present))[0] if self._present else NO_ERROR

    def present(self, code: int) -> bool:
        """Whether an error of this code is present."""
        return any(known == code for known, _ in self._present)

    def clear_all(self) -> None:
        """After a reset of the node: no error, no history, no frame."""
        self._present.clear()
        self._history.clear()
        self._register.value = 0

    def came(self, code: int, register: int, detail: int = 0) -> None:
        """An error is present; told once for each code and detail (a channel or node)."""
        if (code, detail) in self._present:
            return
        self._present[code, detail] = register | GENERIC
        self._history.appendleft(detail << 16 | code)
        self._tell(code, detail)

    def went(self, code: int, detail: int = 0) -> None:
        """An error is no longer present."""
        if self._present.pop((code, detail), None) is not None:
            self._tell(NO_ERROR, 0)

    def once(self, code: int, register: int, detail: int = 0) -> None:
        """Something happened that is over already."""
        self._history.appendleft(detail << 16 | code)
        self._tell(code, detail, register | GENERIC)

    def _tell(self, code: int, detail: int, extra: int = 0) -> None:
        register = 0
        for bits in self._present.values():
            register |= bits
        self._register.value = register
        if not self._cob.number() & _INVALID:
            self._send(Frame(self.cob_id, struct.pack("<HBB4x", code, register | extra, detail & 0xFF)))

    def _past(self, sub: int) -> int:
        if sub > len(self._history):
            raise Abort(AbortCode.NO_DATA)
        return self._history[sub - 1]

    def _check_clear(self, value: Value) -> None:
        if value != 0:
            raise Abort(AbortCode.BAD_VALUE)

    def _check_cob(self, value: Value) -> None:
        assert isinstance(value, int)
        old = self._cob.number()
        if not old & _INVALID and not value & _INVALID and value != old:
            raise Abort(AbortCode.BAD_VALUE)  # the identifier of a valid object stays
        if value & 0x7FFFF800 or is_restricted(value & 0x7FF):
            raise Abort(AbortCode.BAD_VALUE)
