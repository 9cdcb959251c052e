"""A bench on python-can's virtual bus under a clock that the test advances, and a peer of raw frames.

The peer is written from CiA 301 and the devices' manual; it imports no codec of the emulated nodes.
"""

from __future__ import annotations

import itertools
import struct
from typing import NamedTuple

import can

from sim_hardware.bench.can import BenchCan, BenchCanSettings
from sim_hardware.bench.signals import RigSignals

MS = 1_000_000
_CHANNELS = itertools.count()

REGULATOR, AMPLIFIER, CURRENT, ENCODER, SAFETY, ANALOG = 0x10, 0x20, 0x21, 0x22, 0x30, 0x31
ALL = (REGULATOR, AMPLIFIER, CURRENT, ENCODER, SAFETY, ANALOG)


class Heard(NamedTuple):
    t_ms: int
    cob_id: int
    data: bytes


class SdoAborted(Exception):
    def __init__(self, code: int) -> None:
        self.code = code
        super().__init__(f"{code:08X}")


class Bench:
    """Bench, virtual bus, clock and peer."""

    def __init__(self, settings: BenchCanSettings | None = None, **outputs: float) -> None:
        channel = f"bench-can-{next(_CHANNELS)}"
        self.t_ns = 0
        self.signals = RigSignals(outputs)
        self._bus = can.Bus(channel, interface="virtual")
        self._peer = can.Bus(channel, interface="virtual")
        self.can = BenchCan(self._bus, self.signals, settings, clock_ns=lambda: self.t_ns)
        self.heard: list[Heard] = []
        self._heartbeat_due_ms: int | None = None
        self.heartbeat_ms = 0

    def close(self) -> None:
        self.can.stop()
        self._bus.shutdown()
        self._peer.shutdown()

    @property
    def t_ms(self) -> int:
        return self.t_ns // MS

    def send(self, cob_id: int, data: bytes = b"", *, remote: bool = False) -> None:
        self._peer.send(
            can.Message(arbitration_id=cob_id, data=data, is_extended_id=False, is_remote_frame=remote)
        )

    def run(self, ms: int) -> list[Heard]:
        """Advance the time in steps of 1 ms; the frames heard meanwhile."""
        first = len(self.heard)
        for _ in range(ms):
            if self.heartbeat_ms and self.t_ms % self.heartbeat_ms == 0:
                self.send(0x701, b"\x05")
            self.t_ns += MS
            self.can.advance(self.t_ns)
            while (message := self._peer.recv(0)) is not None:
                self.heard.append(Heard(self.t_ms, message.arbitration_id, bytes(message.data)))
        return self.heard[first:]

    def of(self, cob_id: int, frames: list[Heard] | None = None) -> list[bytes]:
        return [frame.data for frame in (self.heard if frames is None else frames) if frame.cob_id == cob_id]

    def boot(self, *, operational: bool = True) -> Bench:
        self.can.power_on()
        self.run(60)
        if operational:
            self.nmt(1)
        return self

    def nmt(self, command: int, node: int = 0) -> list[Heard]:
        self.send(0x000, bytes([command, node]))
        return self.run(2)

    # -- SDO, from CiA 301 ----------------------------------------------------------------------

    def ask(self, node: int, request: bytes) -> bytes:
        """One request, one answer."""
        self.send(0x600 + node, request)
        for _ in range(3):
            answers = self.of(0x580 + node, self.run(1))
            if answers:
                assert len(answers) == 1 and len(answers[0]) == 8
                if answers[0][0] == 0x80:
                    raise SdoAborted(struct.unpack_from("<I", answers[0], 4)[0])
                return answers[0]
        raise TimeoutError(f"node {node:#x} does not answer {request.hex()}")

    def read(self, node: int, index: int, sub: int = 0) -> bytes:
        answer = self.ask(node, struct.pack("<BHB4x", 0x40, index, sub))
        assert struct.unpack_from("<HB", answer, 1) == (index, sub)
        if answer[0] & 2:
            return answer[4 : 8 - (answer[0] >> 2 & 3)]
        size = struct.unpack_from("<I", answer, 4)[0]
        data, toggle = b"", 0
        while True:
            part = self.ask(node, bytes([0x60 | toggle]) + bytes(7))
            assert part[0] & 0xF0 == toggle
            data += part[1 : 8 - (part[0] >> 1 & 7)]
            toggle ^= 0x10
            if part[0] & 1:
                assert len(data) == size
                return data

    def write(self, node: int, index: int, sub: int, data: bytes) -> None:
        if 1 <= len(data) <= 4:
            head = 0x23 | (4 - len(data)) << 2
            answer = self.ask(node, struct.pack("<BHB4s", head, index, sub, data))
            assert answer == struct.pack("<BHB4x", 0x60, index, sub)
            return
        answer = self.ask(node, struct.pack("<BHBI", 0x21, index, sub, len(data)))
        assert answer == struct.pack("<BHB4x", 0x60, index, sub)
        toggle, left = 0, data
        while True:
            part, left = left[:7], left[7:]
            head = toggle | (7 - len(part)) << 1 | (not left)
            answer = self.ask(node, bytes([head]) + part.ljust(7, b"\0"))
            assert answer == bytes([0x20 | toggle]) + bytes(7)
            toggle ^= 0x10
            if not left:
                return

    def u32(self, node: int, index: int, sub: int, value: int) -> None:
        self.write(node, index, sub, struct.pack("<I", value))

    def u16(self, node: int, index: int, sub: int, value: int) -> None:
        self.write(node, index, sub, struct.pack("<H", value))

    def u8(self, node: int, index: int, sub: int, value: int) -> None:
        self.write(node, index, sub, bytes([value]))

    def number(self, node: int, index: int, sub: int = 0, *, signed: bool = False) -> int:
        return int.from_bytes(self.read(node, index, sub), "little", signed=signed)

    # -- devices --------------------------------------------------------------------------------

    def control(self, word: int, set_point: int = 0) -> None:
        """RPDO1 of the regulator."""
        self.send(0x210, struct.pack("<Hh", word, set_point))

    def safety(self, command: int, counter: int) -> None:
        """RPDO1 of the safety I/O."""
        self.send(0x230, struct.pack("<BBH", command, counter, 0))
