"""A rig connection that moves nothing: it keeps what was asked, and the test says what comes back."""

import itertools
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from PySide6.QtWidgets import QWidget

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.core.journal import Record
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.state import Readings, RigState, Word
from rigctl.gui.services import Services
from rigctl.gui.widgets.live_slot import LiveSlot

ROOT = Path(__file__).resolve().parents[2]
RIGS = ROOT / "configs" / "rigs"
_NUMBERS = itertools.count()

MANUAL = RigState(
    word=Word.READY, mode="manual", rig_name="A", simulated=True, time="real", phase="by hand",
    commander="anna", commanding=True, enabled=True, relay_closed=True, rig_s=100.0,
    readings=Readings(100.2, 20.0, 398.0, 123.4, 0.43, 100.0, 20.0, 0.0),
)  # fmt: skip
LOCKED = replace(MANUAL, word=Word.LOCKED, enabled=False, relay_closed=False)


def simulated_rig() -> RigConfig:
    """The rig of configs/rigs/simulated.toml."""
    return load_model(RIGS / "simulated.toml", RigConfig)


def session(rig: RigConfig | None = None, **more: Any) -> SimpleNamespace:
    """What the window knows of a session; the limits are found beside the shipped rig files."""
    facts = {
        "rig": rig or simulated_rig(), "campaign": RIGS, "mode": "manual", "time": "real",
        "run_dir": Path("/nonexistent"), "program": None, "simulated": True,
    }  # fmt: skip
    return SimpleNamespace(**{**facts, **more})


def record(kind: str, source: str = "controller", **payload: Any) -> Record:
    """A record of a journal."""
    number = next(_NUMBERS)
    return Record("2026-11-30T09:00:00.000+00:00", number, 1.0, source, 1, number, kind, payload, "", "")


class RecordingRig(RigConnection):
    """`asked` holds (method, arguments, keywords)."""

    def __init__(self) -> None:
        super().__init__()
        self.asked: list[tuple[str, tuple, dict]] = []

    def say(self, state: RigState) -> None:
        """News of the rig."""
        self.state = state
        self.stateChanged.emit(state)

    def attach(self, made: SimpleNamespace) -> None:
        """A session is watched now."""
        self.session = made
        self.attached.emit(made)


def _keep(name: str):
    def method(self: RecordingRig, *args: Any, **more: Any) -> None:
        self.asked.append((name, args, more))

    return method


for _name in (
    "start_manual", "start_program", "resume", "stop", "verb", "take_command", "enable", "disable",
    "set_speed", "set_pressure", "set_ventilator", "condition", "record", "reset",
    "note", "rate", "end_session",
):  # fmt: skip
    setattr(RecordingRig, _name, _keep(_name))


@pytest.fixture
def rig(services: Services) -> Iterator[RecordingRig]:
    """In place of the connection of `services`."""
    made = RecordingRig()
    services.rig = made
    yield made
    made.close()


class StillView(QWidget):
    """In place of the live plots, which have tests of their own and cost time."""

    def start(self) -> None:
        """Nothing to run."""

    def stop(self) -> None:
        """Nothing runs."""

    def save_layout(self, settings: object) -> None:
        """Nothing to keep."""

    def restore_layout(self, settings: object) -> None:
        """Nothing was kept."""


@pytest.fixture(autouse=True)
def still_plots(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Live plots are made only in tests marked with the fixture `real_plots`."""
    if "real_plots" not in request.fixturenames:
        monkeypatch.setattr(LiveSlot, "_make", StillView)


@pytest.fixture
def real_plots() -> None:
    """Ask for the real live plots."""
