"""The work of a study's worker: tasks in, results out, as JSON text; the same lines of code wherever they
run.

Job: `run_chunk`, called in this process, in a worker process (`main`, spoken to by
pipes) or on a Dask worker; texts in and out, so that no executor can change a bit of a number. BLAS gets one
thread: results must not depend on how many cores are free. NOT its job: sharing out tasks
(`runner_executors`), keeping results (`runner_checkpoint`).
"""

from __future__ import annotations

import hashlib
import importlib
import json
import os
import queue
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, BinaryIO

#: a study's function: (task, setting) -> anything JSON knows
StudyFunction = Callable[[dict[str, Any], dict[str, Any]], Any]


def run_chunk(function: str, setting: str, tasks: str, *, stay_limited: bool = True) -> str:
    """Compute some tasks.

    Parameters
    ----------
    function : "module:function" of a `StudyFunction`
    setting, tasks : JSON; what is common to all tasks, and a list of tasks
    stay_limited : leave BLAS at one thread afterwards (workers); False: as it was before

    Returns
    -------
    JSON: {"results", "seconds", "code"}, or {"error", "task", "trace"} where a task failed
    """
    with _one_blas_thread(stay_limited):
        results: list[Any] = []
        try:
            call = resolve(function)
            common, listed = json.loads(setting), json.loads(tasks)
            started = time.perf_counter()
            for task in listed:
                results.append(json.loads(json.dumps(call(task, common), allow_nan=False)))
        except Exception as error:  # reported to whoever started the study, with the task that caused it
            return json.dumps(
                {
                    "error": f"{type(error).__name__}: {error}",
                    "task": len(results),
                    "trace": traceback.format_exc(),
                }
            )
        seconds = time.perf_counter() - started
        return json.dumps(
            {"results": results, "seconds": seconds, "code": code_identity(function)["sources"]}
        )


def resolve(function: str) -> StudyFunction:
    """The function of that "module:function".

    Raises
    ------
    ValueError
        not "module:function", or there is none
    """
    module, _, name = function.partition(":")
    if not module or not name:
        raise ValueError(f"{function!r} is not 'module:function'")
    found = getattr(importlib.import_module(module), name, None)
    if not callable(found):
        raise ValueError(f"the module {module} has no function {name!r}")
    return found


@lru_cache(maxsize=16)
def code_identity(function: str) -> dict[str, str]:
    """Versions that results depend on: this program, numpy, scipy, and a digest of the sources that
    compute.
    """
    import numpy as np
    import scipy

    import sim_hardware.brake_model as numerics
    from rigctl import __version__

    own = sys.modules.get(function.partition(":")[0])
    own_file = getattr(own, "__file__", None) or ""
    files = sorted(Path(numerics.__path__[0]).rglob("*.py"))
    digest = hashlib.sha256()
    for path in [*files, *([Path(own_file)] if own_file else [])]:
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return {
        "rigctl": __version__,
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "sources": digest.hexdigest()[:16],
    }


@contextmanager
def _one_blas_thread(stay: bool) -> Iterator[None]:
    from threadpoolctl import threadpool_limits

    limits = threadpool_limits(1, user_api="blas")
    try:
        yield
    finally:
        if not stay:
            limits.restore_original_limits()


def write_frame(stream: BinaryIO, text: str) -> None:
    """Send a text: its length in bytes on a line, then the text."""
    data = text.encode()
    stream.write(b"%d\n" % len(data) + data)
    stream.flush()


def read_frame(stream: BinaryIO) -> str | None:
    """Receive a text; None where the other end has gone."""
    head = stream.readline()
    if not head.endswith(b"\n"):
        return None
    data = stream.read(int(head))
    return data.decode() if len(data) == int(head) else None


def main() -> None:
    """A worker process: jobs from standard input, answers to standard output, until the input ends.

    A thread reads, so that the end of whoever started the study (even by kill -9) ends this worker at once.
    What tasks print goes to standard error.
    """
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    jobs: queue.Queue[str] = queue.Queue()

    def listen() -> None:
        while (text := read_frame(sys.stdin.buffer)) is not None:
            jobs.put(text)
        os._exit(0)

    threading.Thread(target=listen, daemon=True).start()
    while True:
        job = json.loads(jobs.get())
        write_frame(answers, run_chunk(job["function"], job["setting"], job["tasks"]))
