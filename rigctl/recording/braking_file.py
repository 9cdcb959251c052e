"""Braking files: writing one in memory, checking it, and reading it.

Job: `file_image` gives the bytes of a file, `verify` compares a file with what should be in it,
`read_braking` opens it with lazy samples, `read_summary` reads everything but the samples. NOT its job: the
form (`nexus`), when files are written (`commit`).
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zlib import crc32

import h5py
import numpy as np
from h5py import h5d, h5f, h5s  # pyright: ignore[reportAttributeAccessIssue]
from numpy.typing import NDArray

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.core.errors import RecordingError
from rigctl.recording import nexus
from rigctl.recording.braking import COMPLETE, StoredBraking
from rigctl.recording.spool_reader import Mark

file_image = nexus.image


class StoredChannels(Mapping[str, ChannelData]):
    """Channels of a braking file; samples are read when a channel is asked for, and not kept."""

    def __init__(self, path: Path, specs: Mapping[str, ChannelSpec]) -> None:
        self._path = path
        self.specs = dict(specs)

    def __getitem__(self, name: str) -> ChannelData:
        spec = self.specs[name]
        with _open(self._path) as file:
            return ChannelData(spec, 0.0, file[_signal(spec)][...])

    def __iter__(self) -> Iterator[str]:
        return iter(self.specs)

    def __len__(self) -> int:
        return len(self.specs)


@dataclass(frozen=True)
class BrakingFile:
    """A braking as recorded.

    Attributes
    ----------
    summary : dict
        As `read_summary` gives it: index, sequence, role, status, set_points, results, events, marks, ...
    specification : dict
        The braking as it was ordered (`sequences.braking.Braking` by `model_validate`).
    metadata : dict
        What the controller said about rig, sensors and versions.
    settings : dict
        Settings of the evaluation.
    channels : mapping of str to ChannelData
        Lazy; time in s since the first sample.
    events : dict of str to ndarray
        Columns of the table of events.
    clocks : dict of str to dict of str to ndarray
        Clocks of a real rig's sources as measured during the braking: source -> time_s, drift_ppm, and (all
        but the master's) offset_ms, …; empty on rigs with one clock.
    """

    path: Path
    summary: dict[str, Any]
    specification: dict[str, Any]
    metadata: dict[str, Any]
    settings: dict[str, Any]
    channels: StoredChannels
    events: dict[str, NDArray[Any]]
    clocks: dict[str, dict[str, NDArray[Any]]]

    @property
    def index(self) -> int:
        """Number of the braking in its program."""
        return self.summary["index"]

    @property
    def status(self) -> str:
        """complete, incomplete or recovered."""
        return self.summary["status"]

    @property
    def complete(self) -> bool:
        """True when nothing of the braking is missing."""
        return self.status == COMPLETE

    @property
    def results(self) -> dict[str, float | int | None]:
        """Named numbers: mean_mu, lmax_db, pressure_mean_bar, ..."""
        return self.summary["results"]

    @property
    def marks(self) -> tuple[Mark, ...]:
        """What happened and when, in s since the first sample."""
        return tuple(Mark(**mark) for mark in self.summary["marks"])

    def mark_s(self, name: str) -> float | None:
        """Time of the first mark of that name, s since the first sample; None when there is none."""
        return next((mark.t_s for mark in self.marks if mark.name == name), None)


def read_braking(path: Path) -> BrakingFile:
    """Open a braking file.

    Raises
    ------
    RecordingError
        It cannot be read or is not a braking file.
    """
    with _open(path) as file:
        try:
            braking, events = file["entry/braking"], file["entry/events"]
            found = json.loads(braking["summary"][()])
            specification = json.loads(braking["specification"][()])
            metadata = json.loads(braking["metadata"][()])
            settings = json.loads(events["settings"][()])
            columns = {name: events[name][...] for name in found["events"]}
            clocks = {
                str(log.attrs["source"]): {name: log[name][...] for name in log}
                for log in file.get("entry/clocks", {}).values()
            }
        except (KeyError, TypeError, ValueError) as error:
            raise _not_a_braking(path, error) from error
    specs = {name: ChannelSpec(**mapping) for name, mapping in found["channels"].items()}
    found["path"] = str(path)
    channels = StoredChannels(path, specs)
    return BrakingFile(path, found, specification, metadata, settings, channels, columns, clocks)


def read_summary(path: Path) -> dict[str, Any]:
    """Everything of a braking file but the samples and the specification, fast (one small data set).

    Returns
    -------
    dict
        index, sequence, role, status, note, attempt, t0_s, start_time, duration_s, set_points (dict),
        channels (dict of specs), marks, results (dict), events (dict of lists, None where not defined),
        evaluation_error, path.

    Raises
    ------
    RecordingError
        It cannot be read or is not a braking file.
    """
    try:
        file = h5f.open(str(path).encode(), h5f.ACC_RDONLY)
    except OSError as error:
        raise _not_a_braking(path, error) from error
    try:
        data = h5d.open(file, b"/entry/braking/summary")
        text: Any = np.empty((), h5py.string_dtype())
        data.read(h5s.ALL, h5s.ALL, text)
        found = json.loads(text[()])
    except (KeyError, OSError, TypeError, ValueError) as error:
        raise _not_a_braking(path, error) from error
    finally:
        file.close()
    found["path"] = str(path)
    return found


def verify(path: Path, braking: StoredBraking | None = None) -> None:
    """Re-open a file and compare the CRC of all samples: with those of `braking`, else with those it states.

    Raises
    ------
    RecordingError
        Something differs or cannot be read.
    """
    wanted = None if braking is None else {n: c.crc32 for n, c in braking.channels.items()}
    found = read_summary(path)
    with _open(path) as file:
        try:
            for name in found["channels"] if wanted is None else wanted:
                spec = ChannelSpec(**found["channels"][name])
                data = h5d.open(file.id, f"/{_signal(spec)}".encode())
                samples = np.empty(data.shape, spec.dtype)
                data.read(h5s.ALL, h5s.ALL, samples)
                stated = int(file[_signal(spec)].attrs["crc32"]) if wanted is None else wanted[name]
                axis = h5d.open(file.id, f"/entry/{name}/time".encode())
                if crc32(samples.data) != stated or axis.shape != samples.shape:
                    raise RecordingError(f"samples of {name} differ from those recorded.", place=str(path))
        except (KeyError, OSError, TypeError, ValueError) as error:
            raise _not_a_braking(path, error) from error


def _signal(spec: ChannelSpec) -> str:
    return f"entry/{spec.name}/{'counts' if spec.is_counts else 'value'}"


def _open(path: Path) -> Any:  # h5py.File; its members have no useful static type
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise _not_a_braking(path, error) from error


def _not_a_braking(path: Path, error: Exception) -> RecordingError:
    return RecordingError(
        f"this is not a readable braking file ({error}).",
        place=str(path),
        remedy="If it was damaged, remove it and run `rigctl resume`: the braking is done again.",
    )
