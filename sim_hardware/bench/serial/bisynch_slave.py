"""EI-Bisynch ASCII, the slave's half: addressing, polls, writes, block check, repeat and next.

Job: the protocol after appendix H of the 590SP manual, for any `Mnemonics`. Not its job: what a mnemonic
means.

Poll   EOT g g u u C1 C2 ENQ             -> STX C1 C2 data ETX BCC, or silence
Write  EOT g g u u STX C1 C2 data ETX BCC -> ACK or NAK, or silence
After a poll's answer ACK asks for the next parameter and NAK for the same again (recollection, unconfirmed).
"""

from __future__ import annotations

from typing import Protocol

STX, ETX, EOT, ENQ, ACK, NAK = 0x02, 0x03, 0x04, 0x05, 0x06, 0x15
LONGEST_MESSAGE = 32


class Refused(Exception):
    """The write is answered with NAK."""


class Mnemonics(Protocol):
    """Parameters by their two-character mnemonic."""

    def poll(self, mnemonic: str) -> str | None:
        """The value's text; None when there is no such parameter."""
        ...

    def write(self, mnemonic: str, text: str) -> None:
        """Set it. Raises `Refused`."""
        ...

    def following(self, mnemonic: str) -> str:
        """The parameter after this one."""
        ...


def block_check(data: bytes) -> int:
    """Exclusive or of all bytes from C1 to ETX inclusive."""
    check = 0
    for value in data:
        check ^= value
    return check


def tag_mnemonic(tag: int) -> str:
    """Mnemonic of a 590+ tag (590+ manual, page 253).

    Raises
    ------
    ValueError
        No such tag.
    """
    if not 0 <= tag < 936 + 26 * 26:
        raise ValueError(f"{tag} is no tag of a 590")
    if tag < 936:
        digits = "0123456789abcdefghijklmnopqrstuvwxyz"
        return digits[(tag + 360) // 36] + digits[(tag + 360) % 36]
    return chr(ord("a") + (tag - 936) // 26) + chr(ord("A") + (tag - 936) % 26)


class BisynchSlave:
    """One addressed slave, fed with bytes.

    Parameters
    ----------
    group, unit : int
        Address: group 0..7, unit 0..15.
    parameters : Mnemonics
    response_s : float
        Time that the device takes to answer.
    """

    def __init__(self, group: int, unit: int, parameters: Mnemonics, *, response_s: float) -> None:
        self._address = (f"{group}" * 2 + f"{unit:X}" * 2).encode()
        self._parameters = parameters
        self._response_s = response_s
        self._message: bytearray | None = None  # what has come since EOT; None: not after EOT
        self._check_next = False
        self._polled = ""
        self._answer, self._answer_s = b"", float("inf")

    def receive(self, data: bytes, last_s: float) -> None:
        """Bytes have arrived."""
        for value in data:
            answer = self._take(value)
            if answer:
                self._answer, self._answer_s = answer, last_s + self._response_s

    def advance(self, now_s: float) -> bytes:
        """The answer, when its time has come."""
        if now_s < self._answer_s:
            return b""
        answer, self._answer, self._answer_s = self._answer, b"", float("inf")
        return answer

    def due_s(self) -> float:
        """When `advance` wants to be called."""
        return self._answer_s

    def _take(self, value: int) -> bytes:
        if self._check_next:  # the check may have any value, EOT's too
            self._check_next = False
            message, self._message = bytes(self._message or b""), None
            return self._write(message[5:], value)
        if value > 0x7F:  # seven data bits: the parity bit was wrong
            self._message, self._polled = None, ""
            return b""
        if value == EOT:
            self._message, self._polled = bytearray(), ""
            return b""
        if self._message is None:
            return self._continue(value)
        message = self._message
        message.append(value)
        if message[:4] != self._address[: len(message[:4])] or len(message) > LONGEST_MESSAGE:
            self._message = None
        elif len(message) == 7 and value == ENQ:
            self._message = None
            return self._poll(message[4:6].decode("ascii"))
        elif len(message) > 5 and message[4] == STX and value == ETX:
            self._check_next = True
        elif len(message) == 7 and message[4] != STX:
            self._message = None
        return b""

    def _continue(self, value: int) -> bytes:
        """ACK and NAK after an answer."""
        if not self._polled or value not in {ACK, NAK}:
            self._polled = ""
            return b""
        return self._poll(self._parameters.following(self._polled) if value == ACK else self._polled)

    def _poll(self, mnemonic: str) -> bytes:
        text = self._parameters.poll(mnemonic)
        if text is None:
            self._polled = ""
            return bytes([EOT])
        self._polled = mnemonic
        body = f"{mnemonic}{text}".encode("ascii") + bytes([ETX])
        return bytes([STX]) + body + bytes([block_check(body)])

    def _write(self, body: bytes, check: int) -> bytes:
        """A write's body from C1 to ETX, and its check."""
        if block_check(body) != check or len(body) < 4:
            return bytes([NAK])
        try:
            self._parameters.write(body[:2].decode("ascii"), body[2:-1].decode("ascii"))
        except (Refused, UnicodeDecodeError):
            return bytes([NAK])
        return bytes([ACK])
