"""EI-Bisynch ASCII, the host's half: requests, strict reading of answers, numbers, tags.

Job: pure functions. Not its job: ports and time (`eurotherm_link`). After appendix H of the 590SP manual and
page 253 of the 590+ manual.
"""

from __future__ import annotations

import re
from functools import reduce
from operator import xor

STX, ETX, EOT, ENQ, ACK, NAK = 0x02, 0x03, 0x04, 0x05, 0x06, 0x15
FIRST_CAPITAL_TAG = 936
TAGS = FIRST_CAPITAL_TAG + 26 * 26
_DIGITS = "0123456789abcdefghijklmnopqrstuvwxyz"
_NUMBER = re.compile(r"\s*[+-]?(?:\d{1,5}(?:\.\d{0,4})?|\.\d{1,4})\s*")
_HEX = re.compile(r">[0-9A-Fa-f]{1,4}")


class BadAnswer(ValueError):
    """The bytes are no correct answer to this request."""


def mnemonic(tag: int) -> str:
    """Two characters that address a 590+ tag.

    Raises
    ------
    ValueError
        No such tag.
    """
    if not 0 <= tag < TAGS:
        raise ValueError(f"{tag} is no tag: 0 to {TAGS - 1}")
    if tag < FIRST_CAPITAL_TAG:
        first, second = divmod(tag + 360, 36)
        return _DIGITS[first] + _DIGITS[second]
    first, second = divmod(tag - FIRST_CAPITAL_TAG, 26)
    return chr(ord("a") + first) + chr(ord("A") + second)


def check(data: bytes) -> int:
    """Block check character: exclusive or."""
    return reduce(xor, data, 0)


def address(group: int, unit: int) -> bytes:
    """EOT and both digits of the address, each twice."""
    return bytes([EOT]) + (f"{group:X}" * 2 + f"{unit:X}" * 2).encode("ascii")


def poll_request(group: int, unit: int, name: str) -> bytes:
    """Ask for a parameter."""
    return address(group, unit) + name.encode("ascii") + bytes([ENQ])


def write_request(group: int, unit: int, name: str, text: str) -> bytes:
    """Set a parameter."""
    body = (name + text).encode("ascii") + bytes([ETX])
    return address(group, unit) + bytes([STX]) + body + bytes([check(body)])


def poll_is_complete(answer: bytes) -> bool:
    """Whether nothing more belongs to this answer: the character after ETX is the check."""
    end = answer.find(ETX)
    return (end >= 0 and len(answer) > end + 1) or answer[:1] == bytes([EOT])


def parse_poll(answer: bytes, name: str) -> str:
    """The text of a value.

    Raises
    ------
    BadAnswer
        Check, frame or mnemonic are not right.
    """
    if answer == bytes([EOT]):
        raise BadAnswer(f"the drive does not know {name!r}")
    if len(answer) < 6 or answer[0] != STX or answer[-2] != ETX or max(answer) > 0x7F:
        raise BadAnswer(f"not an answer: {answer.hex(' ') or 'nothing'}")
    body = answer[1:-1]
    if check(body) != answer[-1]:
        raise BadAnswer(f"block check fails: {answer.hex(' ')}")
    if body[:2] != name.encode("ascii"):
        raise BadAnswer(f"answer for {body[:2]!r} instead of {name!r}")
    return body[2:-1].decode("ascii")


def parse_number(text: str) -> float:
    """A free-format number.

    Raises
    ------
    BadAnswer
        It is not one.
    """
    if not _NUMBER.fullmatch(text):
        raise BadAnswer(f"{text!r} is no number")
    return float(text)


def parse_word(text: str) -> int:
    """A word such as ``>12AB``. Raises `BadAnswer`."""
    if not _HEX.fullmatch(text):
        raise BadAnswer(f"{text!r} is no hexadecimal word")
    return int(text[1:], 16)


def format_word(word: int) -> str:
    """The inverse of `parse_word`."""
    return f">{word & 0xFFFF:04X}"
