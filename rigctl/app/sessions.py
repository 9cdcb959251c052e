"""Running sessions: what a run says of itself in its private folder, and how others find it.

Job: `announce` by the supervisor, `running_sessions` for window and CLI. The folder lives in memory, is
locked as long as its supervisor lives, and belongs to one user. Not its job: talking to a controller
(`rigctl.app.control_socket`).
"""

from __future__ import annotations

import fcntl
import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from rigctl.app.campaign_file import CampaignFile
from rigctl.config.rig import RigConfig
from rigctl.core.errors import ConfigError
from sequences.program import Program

RUN_DIR_PREFIX = "rigctl-"
FILE_NAME = "session.json"
BASE_VARIABLE = "RIGCTL_RUN_BASE"


@dataclass(frozen=True)
class Session:
    """One running controller with its supervisor.

    Attributes
    ----------
    run_dir : Path
        Folder with sockets and sample ring.
    campaign : Path
        Folder of the campaign that is written.
    pid : int
        Of the supervisor.
    """

    run_dir: Path
    campaign: Path
    pid: int

    @cached_property
    def file(self) -> CampaignFile:
        """The frozen campaign; raises `ConfigError` when it cannot be read."""
        return CampaignFile.load(self.campaign)

    @property
    def rig(self) -> RigConfig:
        """The rig."""
        return self.file.rig

    @property
    def program(self) -> Program | None:
        """The program; None in a manual session."""
        return self.file.program

    @property
    def mode(self) -> str:
        """ "program" or "manual"."""
        return self.file.mode

    @property
    def time(self) -> str:
        """ "virtual" or "real"."""
        return self.file.time

    @property
    def simulated(self) -> bool:
        """True when no real device is driven."""
        return self.file.rig.simulated


def base_folder() -> Path:
    """Where the folders of runs are: as `RIGCTL_RUN_BASE` says, else in memory where there is /dev/shm."""
    if named := os.environ.get(BASE_VARIABLE):
        return Path(named)
    shm = Path("/dev/shm")
    return shm if shm.is_dir() and _writable(shm) else Path(tempfile.gettempdir())


@contextmanager
def run_folder() -> Iterator[Path]:
    """Private folder for sockets and the sample ring of one run.

    It is locked as long as this process lives; folders that a killed supervisor has left are removed.
    """
    base = base_folder()
    for left in base.glob(f"{RUN_DIR_PREFIX}*"):
        if (fd := _lock(left)) is not None:
            shutil.rmtree(left, ignore_errors=True)
            os.close(fd)
    path = Path(tempfile.mkdtemp(prefix=RUN_DIR_PREFIX, dir=base))
    fd = _lock(path)
    try:
        yield path
    finally:
        shutil.rmtree(path, ignore_errors=True)
        if fd is not None:
            os.close(fd)


def announce(run_dir: Path, campaign: Path) -> None:
    """Say what runs here; the file appears whole or not at all."""
    text = json.dumps({"campaign": str(campaign.resolve()), "pid": os.getpid()})
    part = run_dir / (FILE_NAME + ".part")
    part.write_text(text, encoding="utf-8")
    part.rename(run_dir / FILE_NAME)


def running_sessions() -> list[Session]:
    """Sessions of this user whose supervisor lives, oldest first."""
    found: list[tuple[float, Session]] = []
    for folder in base_folder().glob(f"{RUN_DIR_PREFIX}*"):
        try:
            facts: dict[str, Any] = json.loads((folder / FILE_NAME).read_text(encoding="utf-8"))
            session = Session(folder, Path(facts["campaign"]), int(facts["pid"]))
            started = (folder / FILE_NAME).stat().st_mtime
        except (OSError, ValueError, KeyError, TypeError):
            continue  # it has ended in this moment, or belongs to somebody else
        if alive(session):
            found.append((started, session))
    return [session for _, session in sorted(found, key=lambda pair: pair[0])]


def alive(session: Session) -> bool:
    """True while the supervisor of a session holds its folder."""
    fd = _lock(session.run_dir)
    if fd is None:
        return session.run_dir.is_dir()
    os.close(fd)
    return False


def the_session(campaign: Path | None) -> Session:
    """The session of a campaign, or the only one that runs.

    Raises
    ------
    ConfigError
        None runs, or several and no campaign was named.
    """
    sessions = running_sessions()
    if campaign is not None:
        sessions = [session for session in sessions if session.campaign == campaign.resolve()]
    if len(sessions) == 1:
        return sessions[0]
    if not sessions:
        raise ConfigError(
            "nothing is running." if campaign is None else "this campaign is not running.",
            place="" if campaign is None else str(campaign),
            remedy="Start it with `rigctl run`, `rigctl resume` or `rigctl manual`.",
        )
    names = ", ".join(str(session.campaign) for session in sessions)
    raise ConfigError(f"several campaigns are running: {names}.", remedy="Name one with --campaign.")


def _lock(folder: Path) -> int | None:
    """Descriptor that holds the lock of a folder; None when somebody else has it, or it is not ours."""
    try:
        fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        if os.fstat(fd).st_uid != os.getuid():
            raise BlockingIOError
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(fd)
        return None
    return fd


def _writable(folder: Path) -> bool:
    try:
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
