"""Where a running bench puts its ports, so that rig files name them without a machine's path: "bench:drive".

Job: the folder, and the resolution of port names. Not its job: the bench (`sim_hardware.bench`), opening
ports.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

FOLDER_VARIABLE = "RIGCTL_BENCH_DIR"
PREFIX = "bench:"
READY_NAME = "bench.json"
"""There while a bench runs (and after one was killed): its own description."""


def bench_folder() -> Path:
    """$RIGCTL_BENCH_DIR, else a folder in the user's runtime folder, else in that for temporary files."""
    given = os.environ.get(FOLDER_VARIABLE)
    if given:
        return Path(given)
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return (
        Path(runtime) / "rigctl-bench"
        if runtime
        else Path(tempfile.gettempdir()) / f"rigctl-bench-{os.getuid()}"
    )


def port_path(port: str) -> str:
    """A port's name as the operating system knows it: "bench:drive" becomes a path, all others stay."""
    return str(bench_folder() / port.removeprefix(PREFIX)) if port.startswith(PREFIX) else port


def port_hint(port: str) -> str:
    """What a person can do when the port is not there."""
    if port.startswith(PREFIX):
        return "Start the bench in another terminal: rigctl bench."
    return "Check cable and power, and compare with `rigctl devices list`."
