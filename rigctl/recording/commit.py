"""From a spool to a committed braking file, in an order that any crash may interrupt.

Job: build the file in memory -> write `.part`, flushed -> re-open and compare the samples -> keep an earlier
attempt aside -> rename, flush the folder -> journal BRAKING_COMMITTED with SHA-256 -> remove the spool. Doing
it again after a crash at any point gives the same result. NOT its job: when (`recorder`, `recovery`).
"""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from rigctl.core.errors import RecordingError
from rigctl.recording import nexus
from rigctl.recording.braking import Evaluator, assemble
from rigctl.recording.braking_file import file_image, read_summary, verify
from rigctl.recording.campaign import COMMITTED, Campaign, file_sha256
from rigctl.recording.durable import disk_error, publish, sync_folder, write_part
from rigctl.recording.spool_reader import read_spool


class EventWriter(Protocol):
    """The journal, as far as it is used here."""

    def write(self, kind: str, *, rig_s: float | None = None, **payload: Any) -> Any:
        """Append one event and wait until it is on the disk."""
        ...


@dataclass(frozen=True, slots=True)
class Committed:
    """A braking that is on the disk for good."""

    index: int
    path: Path
    sha256: str
    status: str
    n_events: int
    bytes_cut: int
    summary: dict[str, Any]


def commit(campaign: Campaign, spool_path: Path, evaluate: Evaluator, journal: EventWriter) -> Committed:
    """Make the braking file of a spool and remove the spool.

    Raises
    ------
    RecordingError
        The spool cannot be read or the file not be written; the spool is kept.
    """
    spool = read_spool(spool_path)
    braking = assemble(spool, evaluate)
    image = file_image(braking)
    sha256 = hashlib.sha256(image).hexdigest()
    path = campaign.braking_path(braking.index)
    part = path.with_name(path.name + ".part")
    write_part(part, image)
    verify(part, braking)
    _keep_earlier_attempt(campaign, path, braking.attempt)
    publish(part, path)
    try:
        journal.write(
            COMMITTED,
            rig_s=braking.t0_s + braking.duration_s,
            index=braking.index,
            file=path.name,
            sha256=sha256,
            status=braking.status,
            note=braking.note,
            attempt=braking.attempt,
            bytes=len(image),
            events=braking.outcome.n_events,
            bytes_cut=braking.bytes_cut,
            evaluation_error=braking.outcome.error,
        )
        spool_path.unlink()
    except OSError as error:
        raise disk_error(error, campaign.journal_path, f"journal braking {braking.index}") from error
    return Committed(
        index=braking.index,
        path=path,
        sha256=sha256,
        status=braking.status,
        n_events=braking.outcome.n_events,
        bytes_cut=braking.bytes_cut,
        summary=nexus.summary(braking),
    )


def is_committed(campaign: Campaign, spool_path: Path) -> bool:
    """True when the file of this very attempt is committed and unchanged: only the spool was not removed.

    Raises
    ------
    UnreadableSpool
        The spool has no whole header.
    """
    header = read_spool(spool_path).header
    index = int(header["specification"]["index"])
    record = campaign.committed().get(index)
    return (
        record is not None
        and record["attempt"] == header["attempt"]
        and record["sha256"] == file_sha256(campaign.braking_path(index))
    )


def _keep_earlier_attempt(campaign: Campaign, path: Path, attempt: int) -> None:
    """Move the file of an earlier attempt aside; one of the same attempt is being made again."""
    if not path.exists():
        return
    try:
        earlier = int(read_summary(path)["attempt"])
        if earlier >= attempt:
            return
        name = f"{path.stem}-{earlier}.h5"
    except RecordingError:  # damaged: kept for whoever wants to look at it
        name = f"{path.stem}-{attempt - 1}-damaged.h5"
    try:
        campaign.superseded.mkdir(exist_ok=True)
        os.replace(path, campaign.superseded / name)
        sync_folder(campaign.superseded)
        sync_folder(path.parent)
    except OSError as error:
        raise disk_error(error, path, "keep the earlier attempt") from error
