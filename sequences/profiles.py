"""Disc speed over the time of one braking, the dialog's (t, n1, n2), as a pure function of time.

Job: say which speed is wanted t seconds after the pressure came on. No state, no clock, no rig. Not the job:
how the drive follows (plant, engine) and whether it can (``check``). The pressure is in ``pressure``.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, Self, cast

from pydantic import model_validator

from sequences.fields import Data, SegmentS, SpeedRpm, refuse

MAX_PROFILE_S = 3600.0


class SpeedSegment(Data):
    """One row of the dialog's speed table: within `duration_s` from `start_rpm` (n1) to `end_rpm` (n2)."""

    duration_s: SegmentS
    start_rpm: SpeedRpm
    end_rpm: SpeedRpm

    @property
    def slope_rpm_s(self) -> float:
        return (self.end_rpm - self.start_rpm) / self.duration_s


class SpeedProfile(Data):
    """Disc speed during one braking: segments in order, without jumps. Its length is that of the braking."""

    segments: tuple[SpeedSegment, ...]

    @model_validator(mode="before")
    @classmethod
    def _short_forms(cls, data: Any) -> Any:
        """Accept one segment, or a list of segments, in place of the table with ``segments``."""
        if isinstance(data, list | tuple):
            return {"segments": cast("list[Any]", data)}
        one = isinstance(data, SpeedSegment) or (isinstance(data, dict) and "duration_s" in data)
        return {"segments": [cast("Any", data)]} if one else cast("Any", data)

    @model_validator(mode="after")
    def _continuous(self) -> Self:
        if not self.segments:
            raise refuse(
                "no_segments", "a speed profile without segments", "give at least one segment (t, n1, n2)"
            )
        if self.duration_s > MAX_PROFILE_S:
            raise refuse(
                "profile_too_long",
                "the segments last {value} s together",
                f"shorten the braking to at most {MAX_PROFILE_S:g} s",
                self.duration_s,
            )
        for number, (a, b) in enumerate(itertools.pairwise(self.segments), start=1):
            if a.end_rpm != b.start_rpm:
                raise refuse(
                    "speed_jump",
                    "the speed jumps by {value} 1/min after segment {number}",
                    "let the next segment start where the last one ends, or put a ramp between them",
                    b.start_rpm - a.end_rpm,
                    number=number,
                )
        return self

    @classmethod
    def constant(cls, speed_rpm: float, duration_s: float) -> Self:
        segment = SpeedSegment(duration_s=duration_s, start_rpm=speed_rpm, end_rpm=speed_rpm)
        return cls(segments=(segment,))

    @property
    def duration_s(self) -> float:
        return math.fsum(segment.duration_s for segment in self.segments)

    @property
    def start_rpm(self) -> float:
        return self.segments[0].start_rpm

    @property
    def end_rpm(self) -> float:
        return self.segments[-1].end_rpm

    @property
    def min_rpm(self) -> float:
        return min(min(s.start_rpm, s.end_rpm) for s in self.segments)

    @property
    def max_rpm(self) -> float:
        return max(max(s.start_rpm, s.end_rpm) for s in self.segments)

    @property
    def max_slope_rpm_s(self) -> float:
        return max(abs(s.slope_rpm_s) for s in self.segments)

    def speed_rpm(self, t_s: float) -> float:
        """Wanted disc speed at `t_s` after the start; before it the first, after the end the last speed."""
        left_s = max(t_s, 0.0)
        for segment in self.segments:
            if left_s < segment.duration_s:
                share = left_s / segment.duration_s
                return segment.start_rpm * (1.0 - share) + segment.end_rpm * share
            left_s -= segment.duration_s
        return self.end_rpm
