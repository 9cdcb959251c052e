"""Real-time hygiene of the watchdog process: priority, locked memory, no garbage collector, signals.

Job: ask the system for what a watchdog needs, and say honestly what was granted; without it the wide time
windows hold. Not its job: deciding.
"""

from __future__ import annotations

import gc
import os
import signal
from dataclasses import dataclass
from typing import Final

FIFO_PRIORITY: Final = 35
_MCL_CURRENT_AND_FUTURE: Final = 1 | 2


@dataclass(frozen=True, slots=True)
class Granted:
    """What the system gave: real-time priority and memory that is never paged out."""

    fifo: bool
    memory_locked: bool
    words: str

    @property
    def narrow_window(self) -> bool:
        """Whether the narrow time windows can be kept."""
        return self.fifo and self.memory_locked


def ask_for_priority() -> Granted:
    """SCHED_FIFO and mlockall for the calling thread and process; refusal is an answer, no error."""
    refusals: list[str] = []
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY))
    except OSError as error:
        refusals.append(f"SCHED_FIFO refused ({error.strerror})")
    fifo = not refusals
    locked_problem = _lock_memory()
    if locked_problem:
        refusals.append(f"mlockall refused ({locked_problem})")
    return Granted(fifo, not locked_problem, "; ".join(refusals) or "SCHED_FIFO and mlockall granted")


def _lock_memory() -> str:
    """Empty when granted, else why not."""
    import ctypes

    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mlockall(_MCL_CURRENT_AND_FUTURE) == 0:
        return ""
    return os.strerror(ctypes.get_errno())


def quiet_garbage_collector() -> None:
    """Nothing that exists now is looked at again, and no collection interrupts a cycle."""
    gc.collect()
    gc.freeze()
    gc.disable()


def ignore_terminal_signals() -> None:
    """Ctrl-C and a closed terminal reach the whole process group; the watchdog outlives them on purpose."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)


def resident_mb() -> float:
    """Resident memory of this process."""
    with open("/proc/self/statm", encoding="ascii") as file:
        pages = int(file.read().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
