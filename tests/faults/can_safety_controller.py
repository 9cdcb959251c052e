"""A controller as a process in free-running real time: blocks of its own clock and numbers, without end.

Started by the tests, which kill or freeze it. Arguments: socket, hash of the limits, number of first block.
Prints the state that the watchdog tells whenever it changes.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from rigctl.core.errors import RigctlError
from rigctl.core.wire import connect
from rigctl.engine.guard import Checkpoint, Guard

BLOCK_S = 0.05
ALL = Checkpoint(0b1111)


def main() -> None:
    guard = Guard(connect(Path(sys.argv[1]), 10.0), sys.argv[2], lockstep=False)
    guard.hello(run_id="test", pid=os.getpid(), campaign="test")
    k = int(sys.argv[3])
    told = ""
    due_s = time.monotonic()
    while True:
        due_s += BLOCK_S
        time.sleep(max(0.0, due_s - time.monotonic()))
        try:
            guard.update(k)
            guard.passed(ALL)
            guard.heartbeat(k, {"p": 0.0, "n": 0.0, "enable": False})
        except RigctlError as error:
            print(f"stopped {error}", flush=True)
            return
        if guard.state == "locked" and k % 10 == 0:
            guard.arm()
        if guard.state != told:
            told = guard.state
            print(told, flush=True)
        k += 1


if __name__ == "__main__":
    main()
