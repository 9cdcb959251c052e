"""After a crash: left-over spools become braking files, half-made files go, the journal learns about it.

Job: `recover` brings a campaign into order; doing it twice changes nothing more. Nothing that holds samples
is ever deleted: a spool goes only after its file is committed, one that cannot be read is kept beside.
NOT its job: continuing the run (`rigctl resume`).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from rigctl.core.errors import RecordingError
from rigctl.core.journal import Journal
from rigctl.recording.annotations import read_annotations
from rigctl.recording.braking import Evaluator
from rigctl.recording.braking_file import read_summary, verify
from rigctl.recording.campaign import COMMITTED, Campaign, file_sha256
from rigctl.recording.commit import Committed, commit, is_committed
from rigctl.recording.durable import disk_error, sync_folder
from rigctl.recording.evaluation import evaluate_braking
from rigctl.recording.spool_reader import UnreadableSpool

UNREADABLE_SUFFIX: Final = ".unreadable"


@dataclass(frozen=True)
class RecoveryReport:
    """What recovery found and did.

    Attributes
    ----------
    recovered : tuple of Committed
        Brakings made from left-over spools; `status` says whether something is missing, `bytes_cut` how
        much of the spool could not be read.
    removed_parts : tuple of Path
        Half-made files that were removed.
    unreadable_spools : tuple of (Path, str)
        Spools without a whole header, kept under another name, and why. Nothing of them was acknowledged.
    journaled : tuple of int
        Whole files that the journal did not know yet.
    damaged : tuple of (Path, str)
        Braking files that are not as they were committed, and why. They are done again.
    """

    recovered: tuple[Committed, ...]
    removed_parts: tuple[Path, ...]
    unreadable_spools: tuple[tuple[Path, str], ...]
    journaled: tuple[int, ...]
    damaged: tuple[tuple[Path, str], ...]

    @property
    def nothing_to_do(self) -> bool:
        """True when the campaign is in order."""
        return not (
            self.recovered or self.removed_parts or self.unreadable_spools or self.journaled or self.damaged
        )

    def lines(self) -> list[str]:
        """What was found and done, a line each, for people; empty when the campaign is in order."""
        cut = "; {} bytes of its spool could not be read"
        return [
            *(
                f"braking {r.index}: file made from its spool, {r.status}"
                + (cut.format(r.bytes_cut) if r.bytes_cut else "")
                for r in self.recovered
            ),
            *(f"removed the half-made file {path.name}" for path in self.removed_parts),
            *(f"kept the unreadable spool as {path.name}: {why}" for path, why in self.unreadable_spools),
            *(f"braking {index}: entered into the journal" for index in self.journaled),
            *(f"damaged: {why} The braking will be done again." for _, why in self.damaged),
        ]


def recover(
    campaign: Campaign, evaluate: Evaluator = evaluate_braking, lock_timeout_s: float = 30.0
) -> RecoveryReport:
    """Bring a campaign into order after whatever happened.

    Raises
    ------
    RecordingError
        A recorder still works on the campaign after `lock_timeout_s`, or the disk refuses.
    """
    with campaign.lock("spool", timeout_s=lock_timeout_s):
        parts = _remove_parts(campaign)
        journal = Journal(campaign.journal_path, "recovery")
        try:
            recovered: list[Committed] = []
            unreadable: list[tuple[Path, str]] = []
            for spool_path in sorted(campaign.spools.glob("*.spool")):
                try:
                    if is_committed(campaign, spool_path):
                        spool_path.unlink()
                        continue
                    recovered.append(commit(campaign, spool_path, evaluate, journal))
                except UnreadableSpool as error:
                    unreadable.append((_keep_aside(spool_path), str(error)))
            journaled, damaged = _check_files(campaign, journal)
            if recovered or parts or unreadable or journaled:
                journal.write(
                    "CAMPAIGN_RECOVERED",
                    recovered=[
                        {"index": r.index, "status": r.status, "bytes_cut": r.bytes_cut} for r in recovered
                    ],
                    removed_parts=[path.name for path in parts],
                    unreadable_spools=[path.name for path, _ in unreadable],
                    journaled=list(journaled),
                    damaged=[path.name for path, _ in damaged],
                )
            return RecoveryReport(tuple(recovered), parts, tuple(unreadable), journaled, damaged)
        finally:
            journal.close()


def _remove_parts(campaign: Campaign) -> tuple[Path, ...]:
    found = sorted([*campaign.brakings.glob("*.part"), *campaign.folder.glob("*.part")])
    try:
        for path in found:
            path.unlink()
    except OSError as error:
        raise disk_error(error, campaign.folder, "remove half-made files") from error
    return tuple(found)


def _keep_aside(spool_path: Path) -> Path:
    """Give a spool another name under which it does not hinder the next attempt."""
    number = 1
    while (aside := spool_path.with_name(f"{spool_path.name}{UNREADABLE_SUFFIX}{number}")).exists():
        number += 1
    try:
        spool_path.rename(aside)
        sync_folder(aside.parent)
    except OSError as error:
        raise disk_error(error, spool_path, "put the unreadable spool aside") from error
    return aside


def _check_files(
    campaign: Campaign, journal: Journal
) -> tuple[tuple[int, ...], tuple[tuple[Path, str], ...]]:
    """Compare files with the journal; whole files that it does not know are entered."""
    committed = campaign.committed()
    journaled: list[int] = []
    damaged: list[tuple[Path, str]] = []
    for path in campaign.braking_files():
        index, sha256 = int(path.stem), file_sha256(path)
        record = committed.get(index)
        if record is not None and record["sha256"] == sha256:
            continue
        try:
            verify(path)
            if record is not None:
                raise RecordingError("the file is not the one that was committed.", place=str(path))
        except RecordingError as error:
            damaged.append((path, str(error)))
            continue
        found = read_summary(path)
        journal.write(
            COMMITTED,
            index=index,
            file=path.name,
            sha256=sha256,
            status=found["status"],
            note="found without a journal record",
            attempt=found["attempt"],
        )
        journaled.append(index)
    missing = (index for index in committed if not campaign.braking_path(index).exists())
    said = read_annotations(campaign.folder)
    damaged += [
        (
            campaign.braking_path(index),
            f"braking {index} is in the trash." if said.of(index).trashed else "the file has gone.",
        )
        for index in sorted(missing)
    ]
    return tuple(journaled), tuple(damaged)
