"""Exit codes of the command line, the same for all commands."""

from __future__ import annotations

from typing import Final

from rigctl.core.errors import ConfigError, RigctlError, SafetyTrip

OK: Final = 0
FAILED: Final = 1
"""The command could not do what it was asked to (a device, a disk, a process)."""
USAGE: Final = 2
"""A file or an option is wrong; nothing was started."""
STOPPED: Final = 3
"""The run was stopped by a person; `rigctl resume` goes on."""
TRIPPED: Final = 4
"""The watchdog tripped; the rig is in the safe state."""
INCOMPLETE: Final = 5
"""The program came to its end, but some brakings are incomplete."""


def of(error: RigctlError) -> int:
    """Exit code of an error that reached the command line."""
    if isinstance(error, ConfigError):
        return USAGE
    return TRIPPED if isinstance(error, SafetyTrip) else FAILED
