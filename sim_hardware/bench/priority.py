"""Priority of the bench: hardware does not wait for a busy machine.

Job: ask the kernel for real-time priority for all threads of processes, else for a better share of the
processors, and say what was given. Not its job: anything else of real time (memory, timers).

The lowest real-time priority is enough: before all normal programs, behind the watchdog. Round robin between
the bench's own threads keeps the one interpreter lock from being starved by one of them.
"""

from __future__ import annotations

import os
from collections.abc import Callable

NICE = -10
_ROUND_ROBIN_PRIORITY = 1


def raise_priority(pids: list[int]) -> str:
    """Raise these processes as far as permitted; returns "real-time", "raised" or "normal".

    Threads that start later inherit it from the thread that starts them.
    """
    threads = [int(name) for pid in pids for name in os.listdir(f"/proc/{pid}/task")]
    if _each(threads, lambda t: os.sched_setscheduler(t, os.SCHED_RR, os.sched_param(_ROUND_ROBIN_PRIORITY))):
        return "real-time"
    if _each(threads, lambda t: os.setpriority(os.PRIO_PROCESS, t, NICE)):
        return "raised"
    return "normal"


def _each(threads: list[int], act: Callable[[int], None]) -> bool:
    """Whether it was permitted; a thread that has ended meanwhile does not count."""
    for thread in threads:
        try:
            act(thread)
        except PermissionError:
            return False
        except ProcessLookupError:
            continue
    return True
