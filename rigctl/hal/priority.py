"""Priority of processes that work by the clock: they do not wait for a busy machine.

Job: ask the kernel for real-time priority for all threads of processes, else for a better share of the
processors, and say what was given. Not its job: anything else of real time (memory, timers), the watchdog's
own priority (`rigctl.safety.realtime`, above all others).

Round robin between the threads of a process keeps its one interpreter lock from being starved by one of them.
"""

from __future__ import annotations

import os
from collections.abc import Callable

NICE = -10
#: real-time priorities: before all normal programs, behind the watchdog
BENCH, CONTROLLER = 1, 10


def raise_priority(pids: list[int], priority: int) -> str:
    """Raise these processes as far as permitted; returns "real-time", "raised" or "normal".

    Threads that start later inherit it from the thread that starts them.
    """
    threads = [int(name) for pid in pids for name in os.listdir(f"/proc/{pid}/task")]
    if _each(threads, lambda t: os.sched_setscheduler(t, os.SCHED_RR, os.sched_param(priority))):
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
