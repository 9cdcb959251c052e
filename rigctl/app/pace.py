"""How fast a program goes, and how long it will still take.

Job: time left by the dry run's estimate and the pace so far; for terminal and window. Not its job: showing
it.
"""

from __future__ import annotations

import time

from rigctl.engine.state import Progress
from sequences.capabilities import RigCapabilities
from sequences.estimate import ThermalWalk
from sequences.program import Program

MOST_WALKED = 3000  # brakings; longer programs are taken to go at an even pace
LEAST_ELAPSED_S = 1.0


class Pace:
    """Pace of one run.

    Parameters
    ----------
    program : Program
    capabilities : RigCapabilities
    """

    def __init__(self, program: Program, capabilities: RigCapabilities) -> None:
        self._starts_s = [0.0]
        if program.count <= MOST_WALKED:
            walk = ThermalWalk(capabilities, None)
            for braking in program.brakings():
                walk.step(braking)
                self._starts_s.append(walk.estimate.total_s)
        else:
            self._starts_s = [float(number) for number in range(program.count + 1)]
        self._first: tuple[float, float] | None = None
        self.factor: float | None = None
        """Rig seconds per second of the wall clock; None until it can be said."""

    def left_s(self, progress: Progress, now_s: float | None = None) -> float | None:
        """Wall-clock seconds left; None until there is a pace to go by."""
        now_s = time.monotonic() if now_s is None else now_s
        done_s = self._starts_s[min(max(progress.braking - 1, 0), len(self._starts_s) - 1)]
        if self._first is None:
            self._first = (now_s, done_s)
            return None
        elapsed_s, progressed_s = now_s - self._first[0], done_s - self._first[1]
        if elapsed_s < LEAST_ELAPSED_S:
            return None
        self.factor = progress.rig_s / elapsed_s
        if progressed_s <= 0.0:
            return None
        return (self._starts_s[-1] - done_s) * elapsed_s / progressed_s
