"""campaign.toml: everything that a run was started with, resolved and frozen.

Job: its content, made from program, rig and options, with the list of files to copy (brake, plant, limits);
read it back for the controller, for `rigctl resume` and for `rigctl report`. Not its job: the folder itself
(`rigctl.recording.campaign`).
"""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

import rigctl
from rigctl.app.compose import resolved_paths
from rigctl.calibration.record import Calibration
from rigctl.calibration.store import calibration_folder
from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from sequences.program import Program

FILE_NAME = "campaign.toml"
CONFIG_FOLDER = "config"
_SEED_STEP = 1_000_003  # a resumed run goes on with other random numbers than the ones already used


class CampaignFile(BaseModel):
    """What `campaign.toml` holds."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    format: Literal[1] = 1
    name: str
    created: str
    time: Literal["virtual", "real"]
    seed: Annotated[int, Field(ge=0, lt=2**31)]
    limits_hash8: Annotated[str, Field(pattern="^[0-9a-f]{8}$")]
    versions: dict[str, str]
    sources: dict[str, str]
    program: Program | None = None  # None: a manual session
    rig: RigConfig
    calibrations: tuple[Calibration, ...] = ()

    @classmethod
    def load(cls, campaign: Path) -> CampaignFile:
        """Read it back.

        Raises
        ------
        ConfigError
            The folder is no campaign, or the file was damaged.
        """
        return load_model(campaign / FILE_NAME, cls)

    @property
    def mode(self) -> str:
        """ "program" or "manual"."""
        return "manual" if self.program is None else "program"

    @property
    def count(self) -> int:
        """Number of brakings of the program; 0 in a manual session, which ends when a person ends it."""
        return 0 if self.program is None else self.program.count

    @property
    def program_name(self) -> str:
        """Name of the program, or "manual"."""
        return "manual" if self.program is None else self.program.name

    def seed_of_attempt(self, attempt: int) -> int:
        """Seed of the simulated rig for the first run (attempt 0) and each resumed one."""
        return (self.seed + attempt * _SEED_STEP) % 2**31

    def recorder_session(self) -> dict[str, Any]:
        """What the recorder writes into every braking file besides samples.

        The campaign's name is not among it: the same seed gives the same data sets, whatever the name.
        """
        return {
            "metadata": {
                "rig": self.rig.name,
                "simulated": self.rig.simulated,
                "program": self.program_name,
                "seed": self.seed,
                "versions": self.versions,
                "calibrations": [calibration.summary() for calibration in self.calibrations],
            },
            "evaluation": {"friction": self.rig.friction.model_dump(mode="json")},
        }

    def limits_path(self, campaign: Path) -> Path:
        """The frozen copy of the watchdog's limits."""
        return campaign / self.rig.safety.limits

    def prediction_path(self, campaign: Path) -> Path | None:
        """The frozen copy of the engineer's brake model."""
        return None if self.rig.prediction is None else campaign / self.rig.prediction.brake


def freeze(
    name: str,
    *,
    program: Program | None,
    program_path: Path | None,
    rig: RigConfig,
    rig_path: Path,
    time: str,
    seed: int,
    limits_hash8: str,
    calibrations: tuple[Calibration, ...] = (),
) -> tuple[CampaignFile, dict[str, Path]]:
    """What a campaign is started with, and the files to be copied into it (name in the campaign -> source).

    Raises
    ------
    ConfigError
        A file that the rig names does not exist.
    """
    mapping = rig.model_dump(mode="json", exclude_none=True)
    copies: dict[str, Path] = {}
    for key, path in resolved_paths(rig, rig_path).items():
        target = f"{CONFIG_FOLDER}/{key.replace('.', '-')}.toml"
        copies[target] = path
        _assign(mapping, key, target)
    if rig.calibrations is not None:  # outside the campaign: made anew now and then
        _assign(mapping, "calibrations.folder", str(calibration_folder(rig, rig_path, Path())))
    file = CampaignFile(
        name=name,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        time="real" if time == "real" else "virtual",
        seed=seed,
        limits_hash8=limits_hash8,
        versions=_versions(),
        sources={"rig": str(rig_path), **({} if program_path is None else {"program": str(program_path)})},
        program=program,
        rig=RigConfig.model_validate(mapping),
        calibrations=calibrations,
    )
    return file, copies


def _assign(mapping: dict[str, Any], key: str, value: str) -> None:
    *parents, last = key.split(".")
    for name in parents:
        mapping = mapping[name]
    mapping[last] = value


def _versions() -> dict[str, str]:
    names = ("numpy", "scipy", "h5py", "numba")
    return {
        "rigctl": rigctl.__version__,
        "python": platform.python_version(),
        **{name: version(name) for name in names},
    }
