"""The block: what the rig delivers each time, and the only clock the program has.

Job: start time, length and the samples of every channel since the last block, each at its own rate.
Not its job: producing blocks (`rigctl.hal.rig`), storing them (`rigctl.recording`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

from rigctl.core.ring import SampleRing

CLOCKS = "clocks"
"""Key of `Block.status` on rigs whose sources have clocks of their own: source -> offset, drift, jitter and
counts as measured lately. The source without an offset is the master: its count is the rig's time."""


@dataclass(frozen=True, slots=True)
class Block:
    """Samples of all channels of one stretch of rig time.

    Attributes
    ----------
    k : int
        Number of the block since the start of the rig, rising by one.
    t_ns, dt_ns : int
        Rig time at the start of the block and its length, in ns.
    ranges : mapping of str to (int, int)
        For each channel the range [start, stop) of its sample count in the ring.
    ring : SampleRing
        Where the samples are.
    stride : int
        1 while recording. Otherwise a rig may deliver every `stride`-th sample of its slow channels only.
    status : mapping
        Status of the devices as they reported it: relay, drive state, faults.
    """

    k: int
    t_ns: int
    dt_ns: int
    ranges: Mapping[str, tuple[int, int]]
    ring: SampleRing
    stride: int = 1
    status: Mapping[str, Any] = field(default_factory=dict[str, Any])

    @property
    def t_s(self) -> float:
        """Rig time at the start of the block, s."""
        return self.t_ns * 1e-9

    @property
    def dt_s(self) -> float:
        """Length of the block, s."""
        return self.dt_ns * 1e-9

    @property
    def end_s(self) -> float:
        """Rig time at the end of the block, s."""
        return (self.t_ns + self.dt_ns) * 1e-9

    def samples(self, name: str) -> NDArray[Any]:
        """Samples of a channel as acquired, shape (n,); waits until the converter has delivered them."""
        start, stop = self.ranges[name]
        return self.ring.read(name, start, stop)

    def mean(self, name: str) -> float:
        """Mean physical value of a channel over the block; NaN when it delivered nothing."""
        start, stop = self.ranges[name]
        if stop <= start:
            return float("nan")
        spec = self.ring.specs[name]
        return self.ring.mean(name, start, stop) * spec.scale + spec.offset
