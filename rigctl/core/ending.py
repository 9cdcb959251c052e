"""The end of a process that has put everything away.

Job: leave at once. Not its job: deciding when; whoever calls it has closed its files and links.
"""

from __future__ import annotations

import os
import sys
from typing import NoReturn


def end_process(code: int) -> NoReturn:
    """Write out what was printed and leave, without taking the interpreter down object by object.

    That takes most of a second where compiled code and large libraries are loaded, and a run waits for it.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
