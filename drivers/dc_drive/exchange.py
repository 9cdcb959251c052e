"""Retries and statistics of exchanges on a serial link.

Job: repeat a lost exchange until the deadline, keep round-trip times. Not its job: bytes.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import TypeVar

from drivers.dc_drive.words import LinkError, Refused

T = TypeVar("T")
KEPT_TIMES = 1000


class Exchanges:
    """Runs exchanges.

    Parameters
    ----------
    deadline_s : float
        No attempt begins later than this after the first one.
    settle : callable
        Called after a failed attempt: wait until the line is quiet and throw away what came late.
    """

    def __init__(self, deadline_s: float, settle: Callable[[], None]) -> None:
        self._deadline_s = deadline_s
        self._settle = settle
        self.round_trips_s: deque[float] = deque(maxlen=KEPT_TIMES)
        self.retries = 0

    def run(self, attempt: Callable[[], T], what: str) -> T:
        """Attempt it until it succeeds.

        Raises
        ------
        Refused
            The drive says no; a repetition would not help.
        LinkError
            The deadline has passed.
        """
        began_s = time.monotonic()
        while True:
            start_s = time.monotonic()
            try:
                result = attempt()
            except Refused:
                raise
            except LinkError as error:
                if time.monotonic() - began_s >= self._deadline_s:
                    raise LinkError(f"{what}: {error}, for {time.monotonic() - began_s:.2f} s") from error
                self.retries += 1
                self._settle()
                continue
            self.round_trips_s.append(time.monotonic() - start_s)
            return result


class ExchangeStatistics:
    """The statistics that a `DriveLink` tells, from its exchanges."""

    _exchanges: Exchanges

    @property
    def round_trips_s(self) -> Sequence[float]:
        """See `DriveLink`."""
        return self._exchanges.round_trips_s

    @property
    def retries(self) -> int:
        """See `DriveLink`."""
        return self._exchanges.retries
