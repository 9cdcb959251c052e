"""One thread for all periodic work on a bus: heartbeats, supervision, renewal of set-points.

Job: call functions with their periods; an error of one ends that one only and is handed to its owner. Not its
job: what the functions do.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

_LOG = logging.getLogger(__name__)


@dataclass(slots=True)
class _Task:
    call: Callable[[], None]
    period_s: float
    on_error: Callable[[Exception], None]
    due_s: float


class Cycle:
    """The thread runs while there are tasks.

    Parameters
    ----------
    name : str
        Of the thread.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._tasks: list[_Task] = []
        self._condition = threading.Condition()
        self._thread: threading.Thread | None = None
        self._calls = threading.RLock()  # held while a task runs

    def add(
        self, call: Callable[[], None], period_s: float, on_error: Callable[[Exception], None]
    ) -> Callable[[], None]:
        """Call a function every `period_s`, the first time at once.

        Parameters
        ----------
        call : callable
            Must not block.
        period_s : float
        on_error : callable
            Gets what `call` raised; it is not called again after that.

        Returns
        -------
        callable
            Ends it; when that returns, the function is not running and will not run again.
        """
        task = _Task(call, period_s, on_error, time.monotonic())
        with self._condition:
            self._tasks.append(task)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name=self._name, daemon=True)
                self._thread.start()
            self._condition.notify()

        def remove() -> None:
            with self._condition:
                self._remove(task)
                thread = self._thread if not self._tasks else None
                self._condition.notify()
            if thread is not None and thread is not threading.current_thread():
                thread.join(5.0)
            with self._calls:
                pass

        return remove

    def _remove(self, task: _Task) -> None:
        if task in self._tasks:
            self._tasks.remove(task)

    def _run(self) -> None:
        while True:
            with self._condition:
                if not self._tasks:
                    self._thread = None
                    return
                now_s = time.monotonic()
                task = min(self._tasks, key=lambda entry: entry.due_s)
                if task.due_s > now_s:
                    self._condition.wait(task.due_s - now_s)
                    continue
                # Late by more than a period: leave out what cannot be made up for.
                task.due_s = max(task.due_s + task.period_s, now_s + 0.5 * task.period_s)
            with self._calls:
                if task in self._tasks:
                    self._call(task)

    def _call(self, task: _Task) -> None:
        try:
            task.call()
        except Exception as error:  # whatever a driver's task raises, the others must go on
            _LOG.warning("%s: a periodic task ended: %s", self._name, error)
            with self._condition:
                self._remove(task)
            task.on_error(error)
