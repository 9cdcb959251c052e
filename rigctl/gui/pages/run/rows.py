"""One row per braking: what was planned, what has become of it. No Qt.

Job: `Row` and its states, rows of a program without looking at files. Not its job: what has happened
(`model`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum

from rigctl.core.channels import MICROPHONE
from sequences.program import Program


class RowState(StrEnum):
    """What has become of a braking."""

    WAITING = "waiting"
    CONDITIONING = "conditioning"
    BRAKING = "braking"
    COMPLETE = "complete"
    INCOMPLETE = "incomplete"
    SKIPPED = "skipped"
    RECOVERED = "recovered"


UNDER_WAY = (RowState.CONDITIONING, RowState.BRAKING)
NOT_DONE = (RowState.INCOMPLETE, RowState.SKIPPED, RowState.RECOVERED)


@dataclass(slots=True)
class Row:
    """One braking.

    Attributes
    ----------
    index : int
        Number in the program, from 1.
    sequence : str
    temperature_degc : float or None
        Set-point; None when the disc is taken as it is.
    speed_rpm, end_speed_rpm : float or None
        Set-points at its beginning and end.
    pressure_bar : float or None
    sound : bool
        The microphone is recorded.
    state : RowState
    start_degc, mean_mu, squeal_level_db, squeal_frequency_hz : float or None
        Measured.
    judged : bool
        Complete, with sound that could be evaluated: it counts for squeal.
    rating : int
        Noise rating, 0 for none.
    notes : list of str
        What the operator has said.
    reason : str
        Why it is not complete.
    attempt : int
        Number of the recording that is kept, 0 before there is one.
    """

    index: int
    sequence: str = ""
    temperature_degc: float | None = None
    speed_rpm: float | None = None
    end_speed_rpm: float | None = None
    pressure_bar: float | None = None
    sound: bool = True
    state: RowState = RowState.WAITING
    start_degc: float | None = None
    mean_mu: float | None = None
    squeal_level_db: float | None = None
    squeal_frequency_hz: float | None = None
    judged: bool = False
    rating: int = 0
    notes: list[str] = field(default_factory=list)
    reason: str = ""
    attempt: int = 0

    @property
    def note(self) -> str:
        """All words about the braking in one line."""
        return " · ".join(text for text in (*self.notes, self.reason) if text)

    def begin(self) -> None:
        """It is tried (again): what was measured and said of an earlier attempt is not of this one."""
        self.state = RowState.CONDITIONING
        self.mean_mu = self.squeal_level_db = self.squeal_frequency_hz = self.start_degc = None
        self.judged = False
        self.rating = 0
        self.notes = []
        self.reason = ""


def rows_of(program: Program) -> Iterator[Row]:
    """Rows of a program in its order, made one at a time."""
    for braking in program.brakings():
        profile = braking.speed_profile
        yield Row(
            braking.index,
            braking.sequence,
            braking.temperature_degc,
            profile.start_rpm,
            profile.end_rpm,
            braking.pressure_bar,
            sound=MICROPHONE in braking.recording.names,
        )
