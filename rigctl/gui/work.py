"""Long work beside the window: in a process of its own (numbers) or in a thread (files).

Job: run a function elsewhere, hand its result back in the event loop, report progress, cancel. A worker
process is used for whatever computes or imports much, because imports and Python loops in a thread would
make the event loop stutter. Not its job: what is computed.
"""

from __future__ import annotations

import multiprocessing
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from PySide6.QtCore import QObject, Qt, Signal

from rigctl.core.errors import RigctlError

Done = Callable[[Any], None]
Failed = Callable[[str], None]
Progress = Callable[[float, str], None]


class Job(QObject):
    """One piece of work. `cancel()` drops its result; a job that asks its `Reporter` also ends early."""

    finished = Signal(object)
    failed = Signal(str)
    progress = Signal(float, str)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._cancelled = threading.Event()
        self.done = False

    def cancel(self) -> None:
        """The result is not wanted any more."""
        self._cancelled.set()

    @property
    def cancelled(self) -> bool:
        """True after `cancel`."""
        return self._cancelled.is_set()


class Reporter:
    """Given to functions that run in a thread: tell progress, ask whether to go on."""

    def __init__(self, job: Job) -> None:
        self._job = job

    def tell(self, share: float, words: str = "") -> None:
        """Progress from 0 to 1, with words."""
        self._job.progress.emit(share, words)

    @property
    def cancelled(self) -> bool:
        """True when the result is not wanted any more."""
        return self._job.cancelled


class _Bell(QObject):
    """Carries a finished future from its thread into the event loop."""

    rung = Signal(object)


class Work(QObject):
    """Background work of one window."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._threads = ThreadPoolExecutor(max_workers=2, thread_name_prefix="window")
        self._processes: dict[str, ProcessPoolExecutor] = {}
        self._bell = _Bell(self)
        self._bell.rung.connect(self._on_rung, Qt.ConnectionType.QueuedConnection)
        self._closed = False

    def in_thread(self, function: Callable[..., Any], *args: Any, done: Done, failed: Failed | None = None,
                  progress: Progress | None = None) -> Job:  # fmt: skip
        """Run ``function(*args, reporter)`` in a thread: for reading and writing files."""
        job = self._job(done, failed, progress)
        future = self._threads.submit(function, *args, Reporter(job))
        return self._follow(job, future)

    def in_process(self, function: Callable[..., Any], *args: Any, done: Done, failed: Failed | None = None,
                   lane: str = "") -> Job:  # fmt: skip
        """Run ``function(*args)`` in the worker process: for numbers. Function and values must pickle.

        Every lane has a worker of its own: answers that a hand waits for do not queue behind long work.
        """
        job = self._job(done, failed, None)
        try:
            future = self._pool(lane).submit(function, *args)
        except BrokenProcessPool:  # the worker was killed; a new one takes over
            del self._processes[lane]
            future = self._pool(lane).submit(function, *args)
        return self._follow(job, future)

    def _pool(self, lane: str) -> ProcessPoolExecutor:
        if lane not in self._processes:
            context = multiprocessing.get_context("spawn")
            self._processes[lane] = ProcessPoolExecutor(1, mp_context=context)
        return self._processes[lane]

    def _job(self, done: Done, failed: Failed | None, progress: Progress | None) -> Job:
        job = Job(self)
        job.finished.connect(done)
        if failed is not None:
            job.failed.connect(failed)
        if progress is not None:
            job.progress.connect(progress)
        return job

    def _follow(self, job: Job, future: Future[Any]) -> Job:
        future.add_done_callback(lambda f: self._bell.rung.emit((job, f)) if not self._closed else None)
        return job

    def _on_rung(self, pair: tuple[Job, Future[Any]]) -> None:
        job, future = pair
        job.done = True
        if not job.cancelled and not self._closed:
            try:
                result = future.result()
            except CancelledError:
                pass
            except RigctlError as error:
                job.failed.emit(str(error))
            except Exception as error:  # whatever a file or a model did: the window says it and goes on
                job.failed.emit(f"{type(error).__name__}: {error}")
            else:
                job.finished.emit(result)
        job.deleteLater()

    def close(self) -> None:
        """Wait for threads, end the worker processes."""
        self._closed = True
        self._threads.shutdown(wait=True, cancel_futures=True)
        for pool in self._processes.values():
            processes = list((pool._processes or {}).values())
            keeper: Any = pool._executor_manager_thread
            pool.shutdown(wait=False, cancel_futures=True)
            for process in processes:
                process.terminate()
                process.join(2.0)
            if keeper is not None:  # it ends when it sees that the worker is gone
                keeper.join(2.0)
        self._processes.clear()
