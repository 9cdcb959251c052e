"""A controller as a process: reads the watchdog's status, sends a heartbeat for every block it is told of.

Started by the tests, which stop, kill or confuse it. Commands come as lines on standard input.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

from rigctl.core.wire import connect
from rigctl.safety.heartbeat import CHECKPOINTS, answer_to


def main() -> None:
    link = connect(Path(sys.argv[1]), 10.0)
    hash8 = sys.argv[2]
    link.send({"m": "hello", "run_id": "test", "pid": os.getpid(), "campaign": "test"})
    nonce = 0
    print("ready", flush=True)
    for line in sys.stdin:
        for status in link.drain():
            nonce = status["nonce"]
        word, _, rest = line.strip().partition(" ")
        if word == "block":
            k = int(rest)
            message: dict[str, Any] = {
                "m": "hb", "k": k, "mask": CHECKPOINTS, "answer": answer_to(nonce, k, CHECKPOINTS, hash8),
                "limits": hash8, "set": {"p": 0.0, "n": 0.0, "enable": False},
            }  # fmt: skip
            link.send(message)
        else:
            link.send({"m": word})
        print("done", flush=True)


if __name__ == "__main__":
    main()
