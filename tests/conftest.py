"""What all tests share: where the shipped configuration is."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def configs() -> Path:
    """Folder of the shipped configuration files."""
    return ROOT / "configs"
