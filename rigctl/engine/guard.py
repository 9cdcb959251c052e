"""The controller's side of the watchdog: heartbeats made by the control loop, and what the watchdog says.

Job: answer the watchdog's challenge once per block, only after the loop has passed all its checkpoints;
tell the engine when the watchdog is armed, has tripped, or is gone. Not its job: limits and decisions.

In virtual time decisions use the watchdog's answer to earlier blocks only, so that a run does not depend on
which of the two processes was quicker. In real time the two count by clocks of their own: every answer is
taken as soon as it is there, and a watchdog that has fallen silent is found by the age of its newest answer.
"""

from __future__ import annotations

import time
import zlib
from collections.abc import Callable
from enum import IntFlag
from typing import Any, Final

from rigctl.core.errors import LinkClosed, SafetyTrip
from rigctl.core.wire import Link, Message

SILENCE_S: Final = 0.5
"""Real time: older than this the watchdog's newest answer means that it hangs (it answers every 50 ms)."""


class Checkpoint(IntFlag):
    """What the control loop must have done before it may say that it is alive."""

    BLOCK_RECEIVED = 1
    ENGINE_STEPPED = 2
    RECORDER_TOLD = 4
    SETPOINTS_MADE = 8


class Guard:
    """Connection of the control loop to the watchdog.

    Parameters
    ----------
    link : Link
        Connected to the watchdog's socket.
    limits_hash8 : str
        First eight characters of the hash of the limits that the controller believes are in force.
    lockstep : bool
        True in virtual time: the numbers of blocks and of the watchdog's samples are the same.
    clock_s : callable
        Monotonic clock, s.
    """

    def __init__(
        self,
        link: Link,
        limits_hash8: str,
        *,
        lockstep: bool = True,
        clock_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self._link = link
        self._hash8 = limits_hash8
        self._lockstep = lockstep
        self._clock_s = clock_s
        self._heard_at_s = clock_s()
        self._newer: list[Message] = []
        self._mask = Checkpoint(0)
        self._nonce = 0
        self.state = "locked"
        self.cause: str | None = None
        self.remedy: str | None = None
        self.reset_refused: tuple[int, str, str] = (0, "", "")
        """How many resets the watchdog has refused, the words and the remedy of the last."""

    def hello(self, *, run_id: str, pid: int, campaign: str) -> None:
        """Say who is driving."""
        self._link.send({"m": "hello", "run_id": run_id, "pid": pid, "campaign": campaign})

    def arm(self) -> None:
        """Ask for the safety relay. The watchdog closes it when it has seen enough good blocks."""
        self._link.send({"m": "arm"})

    def reset(self, who: str, reason: str) -> None:
        """A person acknowledges an earlier trip. Refused while its cause lasts; never starts motion."""
        self._link.send({"m": "reset", "who": who, "reason": reason})

    def disarm(self) -> None:
        """Motion has ceased for good: give the relay back."""
        self._link.send({"m": "disarm"})

    def passed(self, checkpoint: Checkpoint) -> None:
        """The loop has passed a checkpoint of this block."""
        self._mask |= checkpoint

    def update(self, k: int) -> None:
        """Read the watchdog's answers: in virtual time those to blocks before `k`, in real time all.

        Raises
        ------
        SafetyTrip
            The watchdog has tripped (names the first cause and the remedy), its process has gone, or, armed
            in real time, it has been silent for `SILENCE_S`.
        """
        heard = self._read(k)
        if self.state == "tripped":
            raise SafetyTrip(self.cause or "tripped", place="watchdog", remedy=self.remedy or "")
        if not self._lockstep:
            self._watch_silence(heard=heard)

    def listen(self, k: int) -> bool:
        """As `update` in the safe state: take the watchdog's words; False when it has gone."""
        try:
            self._read(k)
        except SafetyTrip:
            return False
        return True

    def _read(self, k: int) -> bool:
        try:
            messages = self._newer + self._link.drain()
        except LinkClosed as error:
            raise _gone() from error
        if self._lockstep:
            self._newer = [message for message in messages if message.get("k", -1) >= k]
        for message in messages:
            if not self._lockstep or message.get("k", -1) < k:
                self._take(message)
        return bool(messages)

    def _watch_silence(self, *, heard: bool) -> None:
        now_s = self._clock_s()
        if heard:
            self._heard_at_s = now_s
        elif self.state == "armed" and now_s - self._heard_at_s > SILENCE_S:
            raise SafetyTrip(
                f"the watchdog has been silent for {now_s - self._heard_at_s:.1f} s; "
                "the safety relay opens by itself.",
                place="watchdog",
                remedy="See logs/watchdog.log and the load of the machine, then run `rigctl resume`.",
            )

    def _take(self, message: Message) -> None:
        if message.get("m") == "status":
            self.state = str(message["state"])
            self._nonce = int(message["nonce"])
            self.cause = message.get("cause")
            self.remedy = message.get("remedy")
            count, words, remedy = message.get("reset_refused") or (0, "", "")
            self.reset_refused = (int(count), str(words), str(remedy))

    def heartbeat(self, k: int, setpoints: dict[str, Any]) -> None:
        """Tell the watchdog that the loop has worked on block `k`; the checkpoints start afresh."""
        mask = int(self._mask)
        answer = zlib.crc32(f"{self._nonce}:{k}:{mask}:{self._hash8}".encode())
        try:
            self._link.send(
                {"m": "hb", "k": k, "answer": answer, "mask": mask, "limits": self._hash8, "set": setpoints}
            )
        except LinkClosed as error:
            raise _gone() from error
        self._mask = Checkpoint(0)

    def close(self) -> None:
        """Leave. Without a disarm before, the watchdog trips."""
        self._link.close()


def _gone() -> SafetyTrip:
    return SafetyTrip(
        "the watchdog process has gone; the safety relay has opened.",
        place="watchdog",
        remedy="Nothing moves without it. See logs/watchdog.log, then run `rigctl resume`.",
    )
