"""Keep a node's own frames from coming back to it on python-can's `udp_multicast` bus.

Job: mark what we send, and let the kernel drop what bears the mark before it costs anything (a socket filter
of six instructions). A real CAN controller does not hear itself either. Not its job: other buses, where this
does nothing; and correctness: without the filter the nodes sort their own frames out by identifier.

The mark stands in the time stamp, which every receiver of `udp_multicast` replaces by its own.
"""

from __future__ import annotations

import ctypes
import os
import random
import socket
import struct

import can

_SO_ATTACH_FILTER = 26  # Linux, <asm-generic/socket.h>
_UDP_HEADER = 8
#: Bytes of python-can's message before the eight of the time stamp: map head, key "timestamp", float head.
_BEFORE_TIMESTAMP = 1 + 1 + len("timestamp") + 1
_LOAD_WORD, _JUMP_IF_EQUAL, _RETURN = 0x20, 0x15, 0x06
_WHOLE, _DROP = 0xFFFFFFFF, 0


def new_mark() -> float:
    """A time stamp that nobody else sends: some nanoseconds after 1970, different for every bench."""
    return (1 + random.Random(os.urandom(8)).getrandbits(48)) * 1e-18


def drop_marked(bus: can.BusABC, mark: float) -> bool:
    """Have frames with the mark dropped from what this bus receives. False: not possible here."""
    if type(bus).__module__.partition(".interfaces.")[2].partition(".")[0] != "udp_multicast":
        return False
    high, low = struct.unpack(">II", struct.pack(">d", mark))
    first = _UDP_HEADER + _BEFORE_TIMESTAMP
    program = b"".join(
        struct.pack("HBBI", *step)
        for step in (
            (_LOAD_WORD, 0, 0, first),
            (_JUMP_IF_EQUAL, 0, 3, high),
            (_LOAD_WORD, 0, 0, first + 4),
            (_JUMP_IF_EQUAL, 0, 1, low),
            (_RETURN, 0, 0, _DROP),
            (_RETURN, 0, 0, _WHOLE),
        )
    )
    code = ctypes.create_string_buffer(program)
    argument = struct.pack("HP", len(program) // 8, ctypes.addressof(code))
    try:
        with socket.socket(fileno=os.dup(bus.fileno())) as same:
            same.setsockopt(socket.SOL_SOCKET, _SO_ATTACH_FILTER, argument)
    except OSError:
        return False  # another operating system, or a sandbox that forbids it
    return True
