"""Functions that test studies compute (a helper, no test)."""

import os
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np

from rigctl.model.runner import generator


def eigenvalues(task: dict[str, Any], setting: dict[str, Any]) -> dict[str, Any]:
    """Numbers whose last bits depend on the order of operations: eigenvalues of a random matrix."""
    n = setting["size"]
    values = np.linalg.eigvals(generator(task).standard_normal((n, n)))
    # later tasks are faster, so that they come back before earlier ones
    time.sleep(0.003 if task["number"] % 5 == 0 else 0.0)
    return {"largest": float(np.abs(values).max()), "sum": float(values.real.sum())}


def slow(task: dict[str, Any], setting: dict[str, Any]) -> int:
    """A tenth of a second, and a mark of having been computed."""
    with Path(setting["log"]).open("a") as log:
        log.write(f"{task['number']}\n")
    time.sleep(0.1)
    return 7 * task["number"]


def dies(task: dict[str, Any], setting: dict[str, Any]) -> int:
    """The third task kills the process that computes it, as the kernel does when memory runs out."""
    if task["number"] == 3:
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGKILL)
    return task["number"]


def fails(task: dict[str, Any], setting: dict[str, Any]) -> float:
    """Divides by zero at task 2."""
    return 1.0 / (task["number"] - 2)


def not_json(task: dict[str, Any], setting: dict[str, Any]) -> float:
    """Something that JSON does not know."""
    return float("nan")


def interrupts(task: dict[str, Any], setting: dict[str, Any]) -> int:
    """Task 4 presses Ctrl-C, once."""
    pressed = Path(setting["pressed"])
    if task["number"] == 4 and not pressed.exists():
        pressed.touch()
        os.kill(setting["pid"], signal.SIGINT)
        time.sleep(0.5)
    return task["number"]
