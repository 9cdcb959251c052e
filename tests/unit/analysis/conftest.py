"""Makes `campaign_files` importable and gives the campaigns that several tests look at."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from campaign_files import Case, numbered, write_campaign

SQUEAL = (2350.0, 80.0, 1.0, 2.3)


@pytest.fixture(scope="session")
def matrix_campaign(tmp_path_factory) -> Path:
    """Two bedding brakings, 3 pressures x 2 temperatures with onset 12 bar and a harmonic, one incomplete."""
    cases = [
        Case(0, 10.0, 100.0, role="bedding", sound=False, mu=0.36),
        Case(0, 10.0, 100.0, "bedding", sound=False),
    ]
    for temperature in (50.0, 150.0):
        for pressure in (6.0, 12.0, 20.0):
            tones: tuple = ()
            if pressure == 12.0 and temperature == 150.0:
                tones = ((2340.0, 66.0, 1.0, 2.3),)
            if pressure == 20.0:
                tones = ((2360.0, 92.0, 1.0, 2.3), (4720.0, 70.0, 1.0, 2.3))
            cases.append(Case(0, pressure, temperature, mu=0.3 + pressure / 100, tones=tones))
    cases.append(Case(0, 6.0, 250.0, status="incomplete", note="watchdog: door open", tones=(SQUEAL,)))
    return write_campaign(tmp_path_factory.mktemp("matrix") / "c", numbered(cases))


@pytest.fixture
def campaign(tmp_path):
    """Writes a campaign of given cases."""

    def make(*cases: Case) -> Path:
        return write_campaign(tmp_path / "campaign", numbered(list(cases)))

    return make
