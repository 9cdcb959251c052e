"""Where the tasks of a study are computed: in this process, in worker processes, or on a Dask cluster.

Job: `InProcess`, `WorkerPool`, `DaskCluster`: hand out chunks, give back answers in the order they come.
NOT its job: the order of results, checkpoints (`runner`), the computing (`runner_work`).

The pool is of own processes rather than `concurrent.futures`: a worker that dies names the tasks it had, the
others' answers are kept, nothing is pickled, the caller's main module is not run again, Ctrl-C reaches only
the process that must handle it, and no worker outlives the study.
"""

from __future__ import annotations

import json
import os
import selectors
import signal
import subprocess
import sys
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Any, BinaryIO, Self, cast

from rigctl.core.errors import ConfigError, RunError
from rigctl.model.runner_work import read_frame, run_chunk, write_frame

_SINGLE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
_CONNECT_S = 10.0


@dataclass(frozen=True, slots=True)
class Job:
    """What all tasks of a study have in common: "module:function", and its setting as JSON."""

    function: str
    setting: str


@dataclass(frozen=True, slots=True)
class Chunk:
    """Some tasks: their places in the study's list, and the tasks as JSON."""

    places: tuple[int, ...]
    tasks: str


@dataclass(frozen=True, slots=True)
class Answer:
    """What came of a chunk: see `runner_work.run_chunk`."""

    places: tuple[int, ...]
    content: dict[str, Any]


class Executor(ABC):
    """Context manager that computes chunks.

    Attributes
    ----------
    slots : chunks that may be under way at once
    elsewhere : workers have an installation of their own, whose code is to be checked
    """

    slots: int = 1
    elsewhere: bool = False

    @abstractmethod
    def submit(self, chunk: Chunk) -> None:
        """Take a chunk; at most `slots` are under way."""

    @abstractmethod
    def collect(self) -> list[Answer]:
        """Answers that are there; waits for at least one.

        Raises
        ------
        RunError
            a worker has died, or the cluster is gone
        """

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """End what was started; chunks under way are given up."""


class InProcess(Executor):
    """One chunk after the other in this process."""

    def __init__(self, job: Job) -> None:
        self._job = job
        self._waiting: list[Chunk] = []

    def submit(self, chunk: Chunk) -> None:
        self._waiting.append(chunk)

    def collect(self) -> list[Answer]:
        chunk = self._waiting.pop(0)
        text = run_chunk(self._job.function, self._job.setting, chunk.tasks, stay_limited=False)
        return [Answer(chunk.places, json.loads(text))]

    def close(self) -> None:
        self._waiting.clear()


class WorkerPool(Executor):
    """`workers` processes on this machine, each with one chunk at a time.

    Raises
    ------
    ConfigError
        `workers` is not at least 1
    """

    def __init__(self, job: Job, workers: int) -> None:
        if workers < 1:
            raise ConfigError("must be at least 1.", place="--workers", value=workers)
        self.slots = workers
        self._job = job
        self._idle: list[_Worker] = []
        self._busy: dict[_Worker, Chunk] = {}
        self._selector = selectors.DefaultSelector()
        self._all: list[_Worker] = []

    def submit(self, chunk: Chunk) -> None:
        if not self._idle:  # started when first needed
            worker = _Worker()
            self._all.append(worker)
            self._selector.register(worker.answers, selectors.EVENT_READ, worker)
            self._idle.append(worker)
        worker = self._idle.pop()
        self._busy[worker] = chunk
        worker.send({"function": self._job.function, "setting": self._job.setting, "tasks": chunk.tasks})

    def collect(self) -> list[Answer]:
        answers: list[Answer] = []
        dead: list[_Worker] = []
        for key, _ in self._selector.select():
            worker: _Worker = key.data
            text = read_frame(worker.answers)
            if text is None:
                dead.append(worker)
                continue
            answers.append(Answer(self._busy.pop(worker).places, json.loads(text)))
            self._idle.append(worker)
        if dead and not answers:  # answers first: they are kept; the dead one is still there next time
            raise self._death(dead[0])
        return answers

    def _death(self, worker: _Worker) -> RunError:
        code = worker.wait()
        places = self._busy[worker].places if worker in self._busy else ()
        had = f" while computing {_span(places)}" if places else ""
        reason = f"was killed ({signal.Signals(-code).name})" if code < 0 else f"ended with exit code {code}"
        memory = " If memory ran out (SIGKILL), use fewer --workers." if code == -signal.SIGKILL else ""
        return RunError(f"a worker process {reason}{had}.", place="study", remedy=memory.strip())

    def close(self) -> None:
        for worker in self._all:
            worker.end()
        self._selector.close()


class _Worker:
    """A process of its own session, so that the terminal's Ctrl-C does not reach it."""

    def __init__(self) -> None:
        environment = {**os.environ, **dict.fromkeys(_SINGLE_THREAD, "1")}
        self._process = subprocess.Popen(
            [sys.executable, "-c", "from rigctl.model.runner_work import main; main()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**environment, "PYTHONPATH": os.pathsep.join(p or os.getcwd() for p in sys.path)},
            start_new_session=True,
        )
        self._jobs = cast(BinaryIO, self._process.stdin)
        self.answers = cast(BinaryIO, self._process.stdout)

    def send(self, content: dict[str, Any]) -> None:
        try:
            write_frame(self._jobs, json.dumps(content))
        except BrokenPipeError:
            pass  # it has died: its answers end, and `collect` says so

    def wait(self) -> int:
        return self._process.wait()

    def end(self) -> None:
        self._process.kill()
        try:
            self._jobs.close()
        except BrokenPipeError:
            pass  # what was still to be sent to a dead worker is lost with it
        self.answers.close()
        self._process.wait()


class DaskCluster(Executor):
    """Workers of a Dask cluster; parameters go there, models are assembled there.

    Raises
    ------
    ConfigError
        the package distributed is missing, or nobody answers at the address
    """

    elsewhere = True

    def __init__(self, job: Job, address: str) -> None:
        try:
            from distributed import Client, as_completed
        except ImportError as error:
            raise ConfigError(
                "needs the package 'distributed', which is not installed.",
                place="--scheduler",
                value=address,
                remedy="Install it (pip install distributed), or use --workers on this machine.",
            ) from error
        self._job = job
        try:
            self._client = Client(address, timeout=_CONNECT_S, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            raise ConfigError(
                f"no Dask scheduler answers at {address!r} ({error}).",
                place="--scheduler",
                value=address,
                remedy="Start one (dask scheduler; dask worker ADDRESS), or correct the address.",
            ) from error
        threads = sum(dict(self._client.nthreads()).values())  # type: ignore[call-overload]
        if threads == 0:
            self._client.close()
            raise ConfigError(
                "the Dask cluster has no workers.",
                place="--scheduler",
                value=address,
                remedy="Start some: dask worker ADDRESS",
            )
        self.slots = 2 * threads  # one computing, one waiting
        self._chunks: dict[Any, Chunk] = {}
        self._done = as_completed(loop=self._client.loop)

    def submit(self, chunk: Chunk) -> None:
        future = self._client.submit(
            run_chunk, self._job.function, self._job.setting, chunk.tasks, pure=False, retries=0
        )
        self._chunks[future] = chunk
        self._done.add(future)

    def collect(self) -> list[Answer]:
        from distributed import CancelledError
        from distributed.scheduler import KilledWorker

        try:
            answers = []
            for future in self._done.next_batch(block=True):
                answers.append(Answer(self._chunks[future].places, json.loads(future.result())))
                del self._chunks[future]
            return answers
        except (CancelledError, KilledWorker, OSError) as error:  # OSError: the scheduler is gone
            raise RunError(
                f"the Dask cluster lost a chunk of the study: {error}.", place="--scheduler"
            ) from error

    def close(self) -> None:
        if self._chunks:
            self._client.cancel(list(self._chunks))
        self._client.close()


def _span(places: Sequence[int]) -> str:
    first, last = places[0] + 1, places[-1] + 1
    return f"task {first}" if first == last else f"tasks {first} to {last}"
