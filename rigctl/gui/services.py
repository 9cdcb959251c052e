"""What the pages share: the rig, background work, settings, and the way to other pages.

Not its job: what a page shows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QSettings

from rigctl.gui.rig.alarms import AlarmModel
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.work import Work


@dataclass
class Services:
    """Handed to every page.

    Attributes
    ----------
    rig : RigConnection
        The one connection to a controller; signals and commands.
    work : Work
        Long work in a process or thread of its own, with progress and cancel.
    theme : ThemeKeeper
        Present colours; `theme.changed` tells when plots must take new ones.
    settings : QSettings
        What the window remembers.
    data_folder : Path
        Folder of the campaigns.
    config_folder : Path
        Folder of rigs, brakes, programs, limits (`configs`).
    navigate : callable
        ``navigate("data", braking=path)`` shows a page and calls its `open`.
    notify : callable
        ``notify("Saved as …")``: a short line in the alarm bar, no dialog.
    alarms : AlarmModel or None
        The alarms of the session that is watched; None in tests that have none.
    """

    rig: RigConnection
    work: Work
    theme: ThemeKeeper
    settings: QSettings
    data_folder: Path
    config_folder: Path
    navigate: Callable[..., None]
    notify: Callable[[str], None]
    alarms: AlarmModel | None = None
