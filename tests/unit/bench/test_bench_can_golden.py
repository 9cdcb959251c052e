"""Golden transcripts: boot-up, configuration and PDO exchange, frame by frame, as candump logs.

`golden/can_*.log` holds what the peer sent (channel ``tester``) and what the nodes sent (channel ``bench``)
on a clock of whole milliseconds. To write them anew after a deliberate change: run this file as a script and
read the diff.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import can
import pytest
from bench_can_peer import ANALOG, MS, REGULATOR, SAFETY, Bench
from hypothesis import given
from hypothesis import strategies as st

from sim_hardware.bench.can.frames import Frame, candump_line, parse_candump_line

GOLDEN = Path(__file__).parent / "golden"


class Recorded(Bench):
    """Writes down both directions."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        super().__init__(None, torque_nm=321.09, pressure_bar=20.0, position_turns=0.25, speed_rpm=40.0)

    def send(self, cob_id: int, data: bytes = b"", *, remote: bool = False) -> None:
        self.lines.append(candump_line(self.t_ns * 1e-9, Frame(cob_id, data, remote), "tester"))
        super().send(cob_id, data, remote=remote)

    def run(self, ms: int):
        heard = super().run(ms)
        self.lines += [
            candump_line(frame.t_ms * 1e-3, Frame(frame.cob_id, frame.data), "bench") for frame in heard
        ]
        return heard


def regulator(bench: Recorded) -> None:
    """Only the regulator talks: boot, identity, configuration, start, pressure, lost heartbeat."""
    for name in ("amplifier", "current_input", "encoder", "safety_io", "analog_output"):
        bench.can.nodes.pop(name)
    bench.can.power_on()
    bench.run(55)
    for index, sub in ((0x1000, 0), (0x1018, 1), (0x1008, 0), (0x2100, 0)):
        bench.read(REGULATOR, index, sub)
    bench.u8(REGULATOR, 0x2100, 0, 1)
    bench.u32(REGULATOR, 0x1016, 1, 1 << 16 | 50)
    bench.u16(REGULATOR, 0x1017, 0, 40)
    bench.nmt(1, REGULATOR)
    bench.send(0x701, b"\x05")
    bench.control(0x0007, 3277)
    bench.run(30)
    bench.signals.publish(bench.t_ns, regulator_pressure_bar=[9.9])
    bench.send(0x701, b"\x05")
    bench.run(100)  # and then silence: vents, tells, goes pre-operational


def safety(bench: Recorded) -> None:
    """Only the safety I/O and the analog output talk: close, renew, let expire; air."""
    for name in ("regulator", "amplifier", "current_input", "encoder"):
        bench.can.nodes.pop(name)
    bench.can.power_on()
    bench.run(55)
    bench.nmt(1)
    bench.safety(2, 17)
    bench.run(40)
    bench.safety(1, 18)
    bench.run(170)
    bench.send(0x231, struct.pack("<h", 8192))
    bench.read(ANALOG, 0x6411, 1)
    bench.read(SAFETY, 0x2202, 0)


SCENES: dict[str, Callable[[Recorded], None]] = {"can_regulator": regulator, "can_safety_io": safety}


def transcript(name: str) -> list[str]:
    bench = Recorded()
    try:
        SCENES[name](bench)
    finally:
        bench.close()
    return bench.lines


@pytest.mark.parametrize("name", SCENES)
def test_transcript_is_the_golden_one(name: str):
    assert transcript(name) == (GOLDEN / f"{name}.log").read_text("ascii").splitlines()


@pytest.mark.parametrize("name", SCENES)
def test_golden_files_are_read_by_others(name: str):
    """python-can's own reader of candump logs understands them and sees the same frames."""
    path = GOLDEN / f"{name}.log"
    with can.CanutilsLogReader(path) as reader:
        theirs = [(message.arbitration_id, bytes(message.data)) for message in reader]
    ours = [parse_candump_line(line)[1] for line in path.read_text("ascii").splitlines()]
    assert theirs == [(frame.cob_id, frame.data) for frame in ours]


@pytest.mark.parametrize("name", SCENES)
def test_golden_nodes_answer_a_replay_with_the_same_frames(name: str):
    """The tester's side of the file alone, sent again at its times, brings the nodes' side back."""
    lines = (GOLDEN / f"{name}.log").read_text("ascii").splitlines()
    bench = Recorded()
    keep = {"can_regulator": {"regulator"}, "can_safety_io": {"safety_io", "analog_output"}}[name]
    for other in set(bench.can.nodes) - keep:
        bench.can.nodes.pop(other)
    bench.can.power_on()
    for line in lines:
        t_s, frame = parse_candump_line(line)
        if " tester " in line:
            bench.run(round(t_s * 1e3) - bench.t_ms)
            if frame.cob_id == 0x701 and bench.t_ms > 80:  # where the scene's pressure arrived
                bench.signals.publish(bench.t_ns, regulator_pressure_bar=[9.9])
            bench.send(frame.cob_id, frame.data, remote=frame.remote)
    bench.run(round(parse_candump_line(lines[-1])[0] * 1e3) - bench.t_ms)
    replayed = [line for line in bench.lines if " bench " in line]
    bench.close()
    assert replayed == [line for line in lines if " bench " in line]


@given(st.integers(0, 10**9), st.integers(0, 0x7FF), st.binary(max_size=8), st.booleans())
def test_candump_lines_round_trip(t_us: int, cob_id: int, data: bytes, remote: bool):
    frame = Frame(cob_id, b"" if remote else data, remote)
    t_s, again = parse_candump_line(candump_line(t_us * 1e-6, frame))
    assert again == frame and round(t_s * 1e6) == t_us


@pytest.mark.parametrize(
    "line", ["", "701#05", "(1.0) can0 701", "(1.0) can0 701#000102030405060708", "(x) can0 1#00"]
)
def test_lines_that_are_none(line: str):
    with pytest.raises(ValueError):
        parse_candump_line(line)


if __name__ == "__main__":
    assert MS == 1_000_000
    for scene in SCENES:
        (GOLDEN / f"{scene}.log").write_text("\n".join(transcript(scene)) + "\n", "ascii")
        print(f"{scene}: {len(transcript(scene))} frames")
