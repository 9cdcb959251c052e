"""`rigctl annotate`: what a person says about a braking, from the command line.

Job: options and what was done in words; the data page writes the same events. Not its job: the events
(`rigctl.recording.annotations`), the trash (`rigctl.recording.trash`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from rigctl.core.errors import ConfigError
from rigctl.recording.annotations import Action, annotate_many, read_annotations


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("annotate")(annotate_braking)


def annotate_braking(
    campaign: Annotated[Path, typer.Argument(help="Campaign folder.")],
    braking: Annotated[int, typer.Argument(min=1, help="Number of the braking.")],
    exclude: Annotated[
        str | None, typer.Option("--exclude", metavar="REASON", help="Do not count it in statistics.")
    ] = None,
    restore: Annotated[bool, typer.Option("--restore", help="Count it again.")] = False,
    tag: Annotated[list[str] | None, typer.Option("--tag", help="Add a tag; may be repeated.")] = None,
    untag: Annotated[list[str] | None, typer.Option("--untag", help="Remove a tag.")] = None,
    note: Annotated[str | None, typer.Option("--note", help='Set the note; "" removes it.')] = None,
    rating: Annotated[
        int | None, typer.Option("--rating", min=1, max=10, help="Subjective noise rating.")
    ] = None,
    trash: Annotated[
        bool, typer.Option("--trash", help="Move its file to trash/; `rigctl resume` does the braking again.")
    ] = False,
    put_back: Annotated[bool, typer.Option("--put-back", help="Move it back from trash/.")] = False,
) -> None:
    """Exclude a braking with a reason, tag it, note something; the journal keeps who and when.

    Without options it says what is known. `rigctl report` leaves excluded brakings out and lists them.
    """
    from rigctl.recording.campaign import open_campaign
    from rigctl.recording.trash import restore_braking, trash_braking

    folder = open_campaign(campaign).folder
    if exclude is not None and restore:
        raise ConfigError("--exclude and --restore contradict each other.", remedy="Give one of them.")
    _require(folder, braking)
    events: list[tuple[int, Action, str | int | None]] = []
    if exclude is not None:
        events.append((braking, Action.EXCLUDE, exclude))
    if restore:
        events.append((braking, Action.RESTORE, None))
    events += [(braking, Action.TAG, word) for word in tag or ()]
    events += [(braking, Action.UNTAG, word) for word in untag or ()]
    if note is not None:
        events.append((braking, Action.NOTE, note))
    if rating is not None:
        events.append((braking, Action.RATE, rating))
    if events:
        annotate_many(folder, events)
    if trash:
        trash_braking(folder, braking)
    if put_back:
        restore_braking(folder, read_annotations(folder).of(braking).trashed or f"{braking:05d}.h5")
    for line in _lines(folder, braking):
        Console(soft_wrap=True).print(line, highlight=False, markup=False)


def _require(folder: Path, braking: int) -> None:
    name = f"{braking:05d}.h5"
    trashed = read_annotations(folder).of(braking).trashed or name
    if not ((folder / "brakings" / name).exists() or (folder / "trash" / trashed).exists()):
        raise ConfigError(
            f"there is no braking {braking}.", place=str(folder), value=braking, remedy="See brakings/."
        )


def _lines(folder: Path, braking: int) -> list[str]:
    state = read_annotations(folder).of(braking)
    found = [f"Braking {braking} of {folder.name}"]
    if state.excluded:
        found.append(f"excluded: {state.excluded} ({state.excluded_by})")
    if state.tags:
        found.append(f"tags: {', '.join(state.tags)}")
    if state.remark:
        found.append(f"note: {state.remark}")
    if state.rating is not None:
        found.append(f"noise rating: {state.rating}")
    if state.trashed:
        found.append(f"in the trash as trash/{state.trashed}")
    return found if len(found) > 1 else [f"{found[0]}: nothing was said about it."]
