"""Work on two cores: independent tasks shared between this process and one forked copy of it.

Job: `in_two_processes`. NOT its job: what the tasks do (`report`: drawing figures).

A fork takes the loaded plotting library along; a fresh process would need longer to load it than the figures
take. Forking is safe only while no other Python thread runs, so with threads, on one core, or where there is
no safe fork, the tasks run here, one after the other, with the same results.
"""

import json
import os
import sys
import threading
from collections.abc import Callable, Sequence
from typing import NoReturn


def in_two_processes(tasks: Sequence[Callable[[], str]]) -> list[str]:
    """Results of the tasks, in their order.

    Parameters
    ----------
    tasks : sequence of callables without arguments, at most 256
        Each gives a text, may run in either process, and again in this one should the other end early.

    Returns
    -------
    list of str
        One text per task.

    Raises
    ------
    Exception
        Whatever a task raises: what failed elsewhere is done again here.
    """
    if len(tasks) < 2 or not _may_fork():
        return [task() for task in tasks]
    numbers, fill = os.pipe()  # one byte per task; whoever reads it does it
    os.write(fill, bytes(range(len(tasks))))
    os.close(fill)
    source, sink = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        _end_after(lambda: _send(sink, _take(numbers, tasks)))
    os.close(sink)
    try:
        results = _take(numbers, tasks)
        results.update(_received(source))
    finally:
        os.close(numbers)
        os.close(source)  # ends a child that still has something to say when a task failed here
        os.waitpid(child, 0)
    return [results[k] if k in results else task() for k, task in enumerate(tasks)]


def _may_fork() -> bool:
    alone = threading.active_count() == 1
    return sys.platform == "linux" and alone and len(os.sched_getaffinity(0)) > 1


def _take(numbers: int, tasks: Sequence[Callable[[], str]]) -> dict[int, str]:
    results = {}
    while number := os.read(numbers, 1):
        results[number[0]] = tasks[number[0]]()
    return results


def _end_after(work: Callable[[], None]) -> NoReturn:
    """Run the child's work and end it at once: nothing of the parent (buffers, exit handlers) runs twice."""
    code = 1
    try:
        work()
        code = 0
    finally:
        os._exit(code)


def _send(sink: int, results: dict[int, str]) -> None:
    with os.fdopen(sink, "w", encoding="utf-8") as stream:
        json.dump(list(results.items()), stream)


def _received(source: int) -> dict[int, str]:
    """Results of the child; empty when it ended early."""
    with os.fdopen(source, encoding="utf-8", closefd=False) as stream:
        text = stream.read()
    try:
        return dict(json.loads(text))
    except json.JSONDecodeError:
        return {}
