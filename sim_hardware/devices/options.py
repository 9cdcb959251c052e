"""Command-line options that the processes of the simulated rig share. Not its job: anything else."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_plant_arguments(parser: argparse.ArgumentParser) -> None:
    """Options that rig server and microphone share."""
    parser.add_argument("--run-dir", type=Path, required=True)
    parser.add_argument("--brake", type=Path, required=True)
    parser.add_argument("--plant", type=Path, required=True)
    parser.add_argument("--seed", type=int, default=1)
