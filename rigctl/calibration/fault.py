"""What speaks against a calibration, in words. Not its job: finding it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Fault:
    """One finding; with `fatal` the calibration must not be saved."""

    words: str
    remedy: str
    fatal: bool = True
