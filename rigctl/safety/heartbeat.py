"""Is the control loop alive, awake and sane: the challenge, its answers, and the set-points they carry.

Job: judge each heartbeat (rising number, newest nonce, all checkpoints, same limits, set-points allowed) and
count good ones in a row. A heartbeat cannot be made by a helper thread or a kernel timer: it must answer
the nonce of the newest status and name the checkpoints the control loop passed. Not its job: lateness by the
clock (`rigctl.safety.guard`).
"""

from __future__ import annotations

import zlib
from collections import deque
from collections.abc import Mapping
from typing import Any, Final, cast

from rigctl.safety.causes import Cause
from rigctl.safety.limits import SetpointLimits

CHECKPOINTS: Final = 0b1111  # block received, engine stepped, recorder told, set-points computed
FIRST_NONCE: Final = 0
SETPOINTS: Final = frozenset(("p", "n", "enable"))


def answer_to(nonce: int, k: int, mask: int, limits_hash8: str) -> int:
    """The answer the control loop owes to a nonce for block `k`."""
    return zlib.crc32(f"{nonce}:{k}:{mask}:{limits_hash8}".encode())


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_finite(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value - value == 0.0


def setpoint_fault(setpoints: object, limits: SetpointLimits) -> Cause | None:
    """K-24: what the controller commands must be known, finite and within limits. Zero always passes."""
    points = cast("dict[str, Any]", setpoints) if isinstance(setpoints, dict) else {}
    if points.keys() != SETPOINTS:
        return Cause("setpoint", detail="a heartbeat names p, n and enable, and nothing else")
    pressure, speed, enable = points["p"], points["n"], points["enable"]
    if not isinstance(enable, bool):
        return Cause("setpoint", detail=f"enable is {enable!r}, not true or false")
    if not (_is_finite(pressure) and 0.0 <= pressure <= limits.max_pressure_bar):
        return Cause("setpoint", f"pressure {pressure!r} bar", f"{limits.max_pressure_bar:g} bar")
    if not (_is_finite(speed) and 0.0 <= speed <= limits.max_speed_rpm):
        return Cause("setpoint", f"speed {speed!r} 1/min", f"{limits.max_speed_rpm:g} 1/min")
    return None


class HeartbeatMonitor:
    """Judge of the heartbeats of one controller.

    Parameters
    ----------
    limits_hash8 : str
        What the controller must repeat.
    limits : SetpointLimits
    accepted_nonces : int
        How many of the newest nonces may be answered: in lockstep two, because the status of block k and the
        controller's heartbeat k cross on the way; in real time more, because the controller's blocks run by
        another clock than the statuses.

    Attributes
    ----------
    last_k : int
        Block of the newest heartbeat, as the controller counts; -1 before the first.
    good_in_a_row : int
    fault : Cause or None
        What was wrong with the newest heartbeat.
    standing_still : bool
        The newest heartbeat commanded neither pressure nor speed.
    """

    def __init__(self, limits_hash8: str, limits: SetpointLimits, accepted_nonces: int) -> None:
        self._hash8 = limits_hash8
        self._limits = limits
        self._nonces: deque[int] = deque([FIRST_NONCE], maxlen=accepted_nonces)
        self.last_k = -1
        self.seen = 0
        self.good_in_a_row = 0
        self.fault: Cause | None = None
        self.standing_still = False

    def issued(self, nonce: int) -> None:
        """A status with this nonce is on its way to the controller."""
        self._nonces.append(nonce)

    def judge(self, message: Mapping[str, Any]) -> Cause | None:
        """Check one heartbeat; None when it is good."""
        self.fault = self._fault(message)
        if self.fault is None:
            self.good_in_a_row += 1
        else:
            self.good_in_a_row = 0
        return self.fault

    def _fault(self, message: Mapping[str, Any]) -> Cause | None:
        k, mask, answer = message.get("k"), message.get("mask"), message.get("answer")
        if not (_is_whole(k) and _is_whole(mask) and _is_whole(answer)):
            return Cause("heartbeat_wrong", detail="k, mask and answer must be whole numbers")
        assert isinstance(k, int) and isinstance(mask, int)
        expected = self.last_k + 1
        first, self.seen = self.seen == 0, self.seen + 1
        self.last_k = max(self.last_k, k)
        if k != expected and not (first and k >= 0):
            return Cause("heartbeat_wrong", detail=f"block {k} instead of {expected}")
        if mask != CHECKPOINTS:
            return Cause("heartbeat_wrong", detail=f"checkpoints {mask:04b} instead of {CHECKPOINTS:04b}")
        if message.get("limits") != self._hash8:
            return Cause(
                "heartbeat_wrong", detail=f"limits {message.get('limits')!r} instead of {self._hash8!r}"
            )
        # Newest first; with the same nonce, number, mask and limits there is one right answer.
        for nonce in reversed(self._nonces):
            if answer == answer_to(nonce, k, mask, self._hash8):
                break
        else:
            return Cause("heartbeat_wrong", detail=f"block {k} does not answer the newest nonce")
        setpoints: Any = message.get("set")
        fault = setpoint_fault(setpoints, self._limits)
        self.standing_still = fault is None and setpoints["p"] == 0 and setpoints["n"] == 0
        return fault
