"""Fixtures of the run page: a connection that keeps what was asked; live plots are left out."""

from collections.abc import Iterator

import pytest
from PySide6.QtWidgets import QWidget
from recording_rig import RecordingRig

from rigctl.gui.services import Services
from rigctl.gui.widgets.live_slot import LiveSlot


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
