"""Fixtures of the manual page: a connection that keeps what was asked."""

from collections.abc import Iterator

import pytest
from recording_rig import RecordingRig

from rigctl.gui.services import Services


@pytest.fixture
def rig(services: Services) -> Iterator[RecordingRig]:
    """In place of the connection of `services`."""
    made = RecordingRig()
    services.rig = made
    yield made
    made.close()
