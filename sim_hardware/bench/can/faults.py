"""Fault seam between the nodes and the bus, at frame level, repeatable by seed.

Job: lose, change, delay, double and swap frames by rules; let a node fall silent, babble or lose power. Not
its job: faults inside devices (their `disturb`), and the CRC of real CAN: a corrupted frame here stands for
one that a gateway or a node's memory has changed.
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from typing import Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from sim_hardware.bench.can.frames import HIGHEST_COB_ID, MAX_BYTES, Frame
from sim_hardware.bench.can.scheduler import NS_PER_MS, Scheduler, Timer

Direction = Literal["from_node", "to_node", "both"]
Deliver = Callable[[Frame], None]
LOG_LENGTH = 10_000


class FaultRule(BaseModel):
    """One fault.

    Attributes
    ----------
    kind : str
        drop, corrupt, delay, duplicate, reorder: what happens to frames that match.
        mute: the node is off the bus, both ways. babble: frames nobody asked for. reboot: power fails once.
    node : int or None
        Node-ID; None: every node (babble: no node in particular).
    cob_id : int or None
        Identifier; None: every one (babble: a random one for each frame).
    direction : str
        As the node sees it.
    probability : float
        For each matching frame.
    skip : int
        The first so many matching frames are spared.
    count : int or None
        Ends after so many injections.
    duration_ms : int or None
        Ends after this time.
    delay_ms : int
        delay: by so much; duplicate: the second frame comes so much later; reorder: the longest wait for the
        frame that overtakes.
    corrupt : str
        "bits" flips `bits` random bits, "shorten" cuts the last byte, "lengthen" adds one, "random"
        replaces all.
    rate_hz : float
        Of babble.
    data : str or None
        Hexadecimal payload of babble; None: random, 0..8 bytes.
    outage_ms : int
        Of a reboot.
    seed : int
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    kind: Literal["drop", "corrupt", "delay", "duplicate", "reorder", "mute", "babble", "reboot"]
    node: int | None = Field(default=None, ge=1, le=127)
    cob_id: int | None = Field(default=None, ge=0, le=HIGHEST_COB_ID)
    direction: Direction = "both"
    probability: float = Field(default=1.0, gt=0.0, le=1.0)
    skip: int = Field(default=0, ge=0)
    count: int | None = Field(default=None, ge=1)
    duration_ms: int | None = Field(default=None, ge=1)
    delay_ms: int = Field(default=20, ge=0, le=60_000)
    corrupt: Literal["bits", "shorten", "lengthen", "random"] = "bits"
    bits: int = Field(default=1, ge=1, le=64)
    rate_hz: float = Field(default=1000.0, gt=0.0, le=5000.0)
    data: str | None = Field(default=None, pattern=r"^([0-9A-Fa-f]{2}){0,8}$")
    outage_ms: int = Field(default=500, ge=1, le=600_000)
    seed: int = 0

    @model_validator(mode="after")
    def _complete(self) -> FaultRule:
        if self.kind in ("mute", "reboot") and self.node is None:
            raise PydanticCustomError(
                "node",
                "{kind} needs a node",
                {"kind": self.kind, "remedy": "Give its node-ID, e.g. node = 16."},
            )
        return self


class Injection(NamedTuple):
    """One thing that a rule has done, for the record.

    `after` holds the frames that go on in place of `before`, with the delay of each in ns.
    """

    t_ns: int
    rule: int
    kind: str
    node: int
    direction: str
    before: Frame
    after: tuple[tuple[Frame, int], ...]


class _Held(NamedTuple):
    """A frame that waits for another one to overtake it."""

    frame: Frame
    node: int
    direction: str
    deliver: Deliver
    timer: Timer


class _Active:
    """A rule in force: its own random numbers, how often it has matched and acted."""

    def __init__(self, number: int, rule: FaultRule, now_ns: int) -> None:
        self.number, self.rule = number, rule
        self.random = random.Random(rule.seed)
        self.ends_ns = None if rule.duration_ms is None else now_ns + rule.duration_ms * NS_PER_MS
        self.matched = 0
        self.acted = 0
        self.held: _Held | None = None
        self.timer: Timer | None = None

    def over(self, now_ns: int) -> bool:
        if self.ends_ns is not None and now_ns >= self.ends_ns:
            return True
        return self.rule.count is not None and self.acted >= self.rule.count

    def overtaken(self, node: int, direction: str, frame: Frame) -> bool:
        """Whether this frame is the one that the held frame waits for."""
        held = self.held
        if held is None or (held.node, held.direction) != (node, direction):
            return False
        return self.rule.cob_id is None or frame.cob_id == held.frame.cob_id

    def hits(self, node: int, direction: str, frame: Frame) -> bool:
        """Whether the rule acts on this frame."""
        rule = self.rule
        if rule.node is not None and rule.node != node:
            return False
        if rule.kind != "mute":
            if rule.cob_id is not None and rule.cob_id != frame.cob_id:
                return False
            if rule.direction not in ("both", direction):
                return False
        self.matched += 1
        return self.matched > rule.skip and (
            rule.probability >= 1.0 or self.random.random() < rule.probability
        )


class FrameFaults:
    """All rules in force.

    Parameters
    ----------
    scheduler : Scheduler
    send : callable
        Puts a frame of babble onto the bus.
    reboot : callable
        Called with node-ID and outage in ms.

    Attributes
    ----------
    log : deque of Injection
        The newest injections.
    """

    def __init__(
        self, scheduler: Scheduler, send: Callable[[Frame], None], reboot: Callable[[int, int], None]
    ) -> None:
        self._scheduler, self._send, self._reboot = scheduler, send, reboot
        self._active: list[_Active] = []
        self._numbers = 0
        self.log: deque[Injection] = deque(maxlen=LOG_LENGTH)

    @property
    def quiet(self) -> bool:
        """No rule is in force."""
        return not self._active

    def rules(self) -> dict[int, tuple[FaultRule, int]]:
        """Rules in force and how often each has acted."""
        now_ns = self._scheduler.now_ns
        return {a.number: (a.rule, a.acted) for a in self._active if not a.over(now_ns)}

    def add(self, rule: FaultRule) -> int:
        """Put a rule in force; its number is for `remove`."""
        self._numbers += 1
        active = _Active(self._numbers, rule, self._scheduler.now_ns)
        if rule.kind == "reboot":
            assert rule.node is not None
            self._reboot(rule.node, rule.outage_ms)
        else:
            self._active.append(active)
            if rule.kind == "babble":
                period_ns = max(1, round(1e9 / rule.rate_hz))
                active.timer = self._scheduler.every(period_ns, lambda due_ns: self._babble(active, due_ns))
        return active.number

    def remove(self, number: int) -> bool:
        """Take a rule back. Frames that it still holds go on. False: there is none."""
        for active in self._active:
            if active.number == number:
                self._end(active)
                return True
        return False

    def clear(self) -> None:
        """Take all rules back."""
        for active in tuple(self._active):
            self._end(active)

    def carry(
        self, node: int, direction: Literal["from_node", "to_node"], frame: Frame, deliver: Deliver
    ) -> None:
        """Bring a frame from or to a node, as the rules want it."""
        now_ns = self._scheduler.now_ns
        frames: list[tuple[Frame, int]] = [(frame, 0)]
        overtaken: list[_Held] = []
        for active in tuple(self._active):
            if active.held is not None:
                if active.overtaken(node, direction, frame):
                    overtaken.append(active.held)
                    active.held = None
            elif active.over(now_ns):
                self._end(active)
            elif frames and active.hits(node, direction, frame):
                frames = self._act(active, node, direction, frames, deliver)
                active.acted += 1
                self.log.append(
                    Injection(now_ns, active.number, active.rule.kind, node, direction, frame, tuple(frames))
                )
        for part, delay_ns in frames:
            if delay_ns:
                self._scheduler.after(delay_ns, lambda _due, part=part: deliver(part))
            else:
                deliver(part)
        for held in overtaken:
            held.timer.cancel()
            held.deliver(held.frame)

    def _act(
        self,
        active: _Active,
        node: int,
        direction: str,
        frames: list[tuple[Frame, int]],
        deliver: Deliver,
    ) -> list[tuple[Frame, int]]:
        """What becomes of the frames that have come so far."""
        rule = active.rule
        wait_ns = rule.delay_ms * NS_PER_MS
        if rule.kind in ("drop", "mute"):
            return []
        if rule.kind == "corrupt":
            return [(_corrupt(frame, rule, active.random), delay_ns) for frame, delay_ns in frames]
        if rule.kind == "delay":
            return [(frame, delay_ns + wait_ns) for frame, delay_ns in frames]
        if rule.kind == "duplicate":
            return frames + [(frame, delay_ns + wait_ns) for frame, delay_ns in frames]
        if rule.kind == "reorder" and frames:
            timer = self._scheduler.after(wait_ns, lambda _due: self._release(active))
            active.held = _Held(frames[0][0], node, direction, deliver, timer)
            return frames[1:]
        return frames

    def _release(self, active: _Active) -> None:
        """Nothing has overtaken the frame in time."""
        if active.held is not None:
            held, active.held = active.held, None
            held.timer.cancel()
            held.deliver(held.frame)

    def _end(self, active: _Active) -> None:
        if active in self._active:
            self._active.remove(active)
        if active.timer is not None:
            active.timer.cancel()
        self._release(active)

    def _babble(self, active: _Active, due_ns: int) -> None:
        if active.over(due_ns):
            self._end(active)
            return
        rule, rng = active.rule, active.random
        if rng.random() >= rule.probability:
            return
        active.acted += 1
        cob_id = rng.randrange(HIGHEST_COB_ID + 1) if rule.cob_id is None else rule.cob_id
        data = rng.randbytes(rng.randrange(MAX_BYTES + 1)) if rule.data is None else bytes.fromhex(rule.data)
        self._send(Frame(cob_id, data))


def _corrupt(frame: Frame, rule: FaultRule, rng: random.Random) -> Frame:
    """The frame with another payload; a frame without one stays unless it is lengthened."""
    data = bytearray(frame.data)
    if rule.corrupt == "lengthen" and len(data) < MAX_BYTES:
        data.append(rng.randrange(256))
    elif rule.corrupt == "shorten" and data:
        data.pop()
    elif rule.corrupt == "random":
        data = bytearray(rng.randbytes(len(data)))
    elif data:
        for bit in rng.sample(range(8 * len(data)), min(rule.bits, 8 * len(data))):
            data[bit // 8] ^= 1 << bit % 8
    return frame._replace(data=bytes(data))
