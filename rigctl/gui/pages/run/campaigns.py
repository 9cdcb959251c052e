"""What could be run: shipped programs, and campaigns that are not complete. Read in a thread.

Job: short facts for the empty page. Not its job: validating everything (`sequences.check`), the data page.
"""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rigctl.recording.kinds import COMMITTED
from sequences.program import Program, load_program

NEWEST = 30


@dataclass(frozen=True)
class ProgramChoice:
    """A program file; `problem` says why it cannot be read."""

    path: Path
    name: str
    description: str = ""
    count: int = 0
    problem: str = ""


@dataclass(frozen=True)
class OpenCampaign:
    """A campaign that is not complete. `trip`: words of a trip that nobody has reset, "" for none."""

    path: Path
    program: str
    rig: str
    done: int
    total: int
    trip: str = ""
    changed: float = 0.0


def list_programs(folder: Path, _reporter: Any = None) -> list[ProgramChoice]:
    """Program files of a folder by name; wrong ones with what is wrong, last."""
    found: list[ProgramChoice] = []
    for path in sorted(folder.glob("*.toml")):
        try:
            program = load_program(path)
        except (OSError, ValueError) as error:  # TOMLDecodeError and ValidationError are ValueErrors
            found.append(ProgramChoice(path, path.stem, problem=str(error).splitlines()[0]))
        else:
            found.append(ProgramChoice(path, program.name, program.description, program.count))
    return sorted(found, key=lambda choice: (bool(choice.problem), choice.name))


def list_open_campaigns(folder: Path, reporter: Any = None) -> list[OpenCampaign]:
    """Campaigns with brakings left, the one written last first."""
    if not folder.is_dir():
        return []
    campaigns = [path.parent for path in folder.glob("*/campaign.toml")]
    campaigns.sort(key=_changed, reverse=True)
    found: list[OpenCampaign] = []
    for path in campaigns[:NEWEST]:
        if reporter is not None and reporter.cancelled:
            break
        campaign = read_campaign(path)
        if campaign is not None and campaign.done < campaign.total:
            found.append(campaign)
    return found


def _changed(campaign: Path) -> float:
    path = campaign / "journal.jsonl"
    return path.stat().st_mtime if path.exists() else 0.0


def read_campaign(path: Path) -> OpenCampaign | None:
    """Facts of one campaign; None for a manual session and for what cannot be read."""
    try:
        resolved = tomllib.loads((path / "campaign.toml").read_text(encoding="utf-8"))
        if "program" not in resolved:
            return None
        program = Program.model_validate(resolved["program"])
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, ValidationError):
        return None  # the data page says what is wrong with a damaged campaign
    status, trip = _journal(path / "journal.jsonl")
    done = sum(state == "complete" for state in status.values())
    rig = str(resolved.get("rig", {}).get("name", ""))
    return OpenCampaign(path, program.name, rig, done, program.count, trip, _changed(path))


def _journal(path: Path) -> tuple[dict[int, str], str]:
    """Status of each committed braking, and words of a trip that was not reset."""
    status: dict[int, str] = {}
    trip = ""
    if not path.exists():
        return status, trip
    with path.open("rb") as file:
        for line in file:
            if COMMITTED.encode() not in line and b'"watchdog"' not in line:
                continue
            try:
                record = json.loads(line)
                kind, payload = record["kind"], record["payload"]
                if kind == COMMITTED:
                    status[int(payload["index"])] = payload["status"]
                elif kind == "trip" and record["source"] == "watchdog":
                    trip = str(payload.get("words", payload.get("cause", "")))
                elif kind in ("reset", "acknowledged"):
                    trip = ""
            except (ValueError, KeyError, TypeError):
                continue  # a torn line after a power cut
    return status, trip
