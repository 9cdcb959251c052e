"""Which campaigns there are. No Qt.

Job: find the folders with a `campaign.toml` below a folder and say a few facts about each. Not its job:
their brakings (`loader`).
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FILE_NAME = "campaign.toml"


@dataclass(frozen=True)
class CampaignInfo:
    """Facts of a campaign; `simulated` is None when its file does not say it."""

    path: Path
    name: str
    created: str = ""
    program: str = ""
    rig: str = ""
    simulated: bool | None = None
    brakings: int = 0
    problem: str = ""

    @property
    def day_and_time(self) -> str:
        """When it was started: 2026-11-30 09:08 (UTC, as in its file)."""
        return self.created[:16].replace("T", " ")


def is_campaign(folder: Path) -> bool:
    """True for a folder that holds a campaign."""
    return (folder / FILE_NAME).is_file()


def find_campaigns(folder: Path) -> list[CampaignInfo]:
    """Campaigns in a folder (or the folder itself), newest first; one that cannot be read has a `problem`."""
    if is_campaign(folder):
        return [describe(folder)]
    if not folder.is_dir():
        return []
    found = [describe(path) for path in folder.iterdir() if is_campaign(path)]
    return sorted(found, key=lambda info: (info.created, info.name), reverse=True)


def describe(folder: Path) -> CampaignInfo:
    """Facts of one campaign."""
    count = sum(1 for _ in (folder / "brakings").glob("*.h5"))
    try:
        content: dict[str, Any] = tomllib.loads((folder / FILE_NAME).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        return CampaignInfo(folder, folder.name, brakings=count, problem=str(error))
    program, rig = (content.get(key) for key in ("program", "rig"))
    program = program if isinstance(program, dict) else {}
    rig = rig if isinstance(rig, dict) else {}
    return CampaignInfo(
        path=folder,
        name=str(content.get("name") or folder.name),
        created=str(content.get("created", "")),
        program=str(program.get("name", "")),
        rig=str(rig.get("name", "")),
        simulated=rig.get("simulated"),
        brakings=count,
    )
