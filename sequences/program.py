"""A program: named sequences in order, read from and written to TOML.

Job: the whole of what a campaign shall do, as one value with an exact round trip. Not the job: wording of
errors (``rigctl.config`` translates the ``ValidationError``, ``TOMLDecodeError`` and ``OSError`` that leave
here untouched) and the limits of a rig (``check``).
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal, Self

import tomli_w
from pydantic import Field, model_validator

from sequences.braking import Braking
from sequences.fields import Data, SafeName, refuse
from sequences.matrix import Sequence
from sequences.matrix import brakings as sequence_brakings
from sequences.sense import MAX_BRAKINGS


class Program(Data):
    """Sequences in the order in which they run. ``format`` is the version of the file's structure."""

    format: Literal[1] = 1
    name: SafeName
    description: Annotated[str, Field(max_length=10_000)] = ""
    sequences: tuple[Sequence, ...]

    @model_validator(mode="after")
    def _makes_sense(self) -> Self:
        seen: set[str] = set()
        for sequence in self.sequences:
            if sequence.name.casefold() in seen:
                raise refuse(
                    "repeated_name",
                    "two sequences are called {value}",
                    "give each sequence its own name (capitals do not distinguish)",
                    repr(sequence.name),
                )
            seen.add(sequence.name.casefold())
        if self.count == 0:
            raise refuse(
                "zero_brakings",
                "the program {value} has zero brakings",
                "add a [[sequences]] table, or enable one that is switched off",
                repr(self.name),
            )
        if self.count > MAX_BRAKINGS:
            raise refuse(
                "too_many_brakings",
                "{value} brakings are more than {most}",
                "split the work into several programs",
                self.count,
                most=MAX_BRAKINGS,
            )
        return self

    @property
    def count(self) -> int:
        """Number of brakings of all sequences that are switched on."""
        return sum(sequence.count for sequence in self.sequences)

    def brakings(self) -> Iterator[Braking]:
        """Expand to brakings, numbered from 1 through the whole program."""
        first_index = 1
        for sequence in self.sequences:
            yield from sequence_brakings(sequence, first_index)
            first_index += sequence.count


def load_program(path: Path | str) -> Program:
    """Read a program file.

    Raises
    ------
    OSError
        The file cannot be read.
    tomllib.TOMLDecodeError, UnicodeDecodeError
        It is not TOML.
    pydantic.ValidationError
        It is TOML but no program that makes sense.
    """
    with open(path, "rb") as file:
        return Program.model_validate(tomllib.load(file))


def dump_program(program: Program) -> str:
    """Return the program as TOML, complete (defaults and expanded ranges included).

    ``Program.model_validate(tomllib.loads(dump_program(p))) == p``.
    """
    return tomli_w.dumps(program.model_dump(mode="json", exclude_none=True))
