"""Long studies: many independent tasks, computed in parallel, kept while they run, the same results anywhere.

    results = run_study(tasks, "rigctl.model.scatter:sample", setting={...}, folder=Path("study"), workers=4)

Job: `run_study` shares tasks out to this process, to worker processes or to a Dask cluster, keeps what is
finished in a folder, goes on where an interrupted study was, and puts results in the order of their tasks.
Results are the same bit for bit whatever computes them in whatever order (numbers travel as JSON, which
gives every float back; BLAS has one thread; a task's random numbers come from its own seed), on machines
with the same numpy and scipy. NOT its job: what a task computes; showing progress
(`rigctl.app.model.studies`).
"""

from __future__ import annotations

import json
import math
import os
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rigctl.core.errors import ConfigError, RunError
from rigctl.model.runner_checkpoint import MANIFEST, RESULTS, Checkpoint, digest, identity
from rigctl.model.runner_executors import Answer, Chunk, DaskCluster, Executor, InProcess, Job, WorkerPool
from rigctl.model.runner_work import code_identity, resolve

CHUNK_S = 0.25
"""Work handed out at once. Far above what handing out costs (1.5 ms with Dask), short enough to lose."""
LEAST_CHUNK_S = 0.05
_GROWTH = 8


@dataclass(frozen=True, slots=True)
class Progress:
    """State of a study: tasks done (of them `restored` from the folder), all tasks, seconds so far and
    left.
    """

    done: int
    total: int
    restored: int
    elapsed_s: float
    left_s: float | None


class StudyStopped(RunError):
    """A person stopped the study (Ctrl-C); `done` of `total` tasks are in `folder` (None: nothing is
    kept).
    """

    def __init__(self, done: int, total: int, folder: Path | None) -> None:
        self.done, self.total, self.folder = done, total, folder
        kept = f"{done} of {total} tasks are kept in {folder}" if folder else "nothing is kept"
        remedy = "Give the same command again: it goes on there." if folder else ""
        super().__init__(f"stopped; {kept}.", remedy=remedy)


def run_study(
    tasks: Sequence[Mapping[str, Any]],
    function: str,
    *,
    setting: Mapping[str, Any] | None = None,
    folder: Path | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    chunk_s: float = CHUNK_S,
) -> list[Any]:
    """Compute all tasks.

    Parameters
    ----------
    tasks : what differs, JSON-able; random tasks carry their seed (see `seeded`, `generator`)
    function : "module:function", called as function(task, setting); importable by the workers
    setting : what all tasks have in common, JSON-able
    folder : where finished tasks are kept, and where an interrupted study goes on; None: nowhere
    workers : processes on this machine; 1: this process
    scheduler : address of a Dask scheduler ("tcp://host:8786"), instead of `workers`
    on_progress : called after every chunk
    chunk_s : seconds of work handed out at once

    Returns
    -------
    results in the order of the tasks, as JSON gives them back

    Raises
    ------
    ConfigError
        wrong options, or the folder holds another study (other model, settings or code)
    RunError
        a task failed, a worker died, the cluster is gone; what was finished is kept
    StudyStopped
        Ctrl-C
    """
    if scheduler is not None and workers != 1:
        raise ConfigError(
            "cannot be combined with --scheduler.",
            place="--workers",
            value=workers,
            remedy="Leave one of them out.",
        )
    resolve(function)
    study = study_identity(tasks, function, setting)
    checkpoint = None if folder is None else Checkpoint(folder, study)
    job = Job(function, json.dumps(setting or {}, allow_nan=False))
    run = _Run([dict(task) for task in tasks], job, checkpoint, on_progress, chunk_s)
    try:
        if run.pending:
            with _executor(job, workers, scheduler) as executor:
                run.work(executor)
        run.tell()
    except KeyboardInterrupt:
        raise StudyStopped(len(run.results), len(tasks), folder) from None
    except RunError as error:
        if checkpoint is None or not run.results:
            raise
        kept = f"{error.problem} {len(run.results)} of {len(tasks)} tasks are kept in {folder}."
        raise RunError(kept, place=error.place, value=error.value, remedy=error.remedy) from error
    finally:
        if checkpoint is not None:
            checkpoint.close()
    return [run.results[place] for place in range(len(tasks))]


def study_identity(
    tasks: Sequence[Mapping[str, Any]], function: str, setting: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """What the results of a study depend on: function, setting, tasks, versions of code; see the manifest."""
    return identity(function, setting or {}, tasks, code_identity(function))


def default_folder(
    tasks: Sequence[Mapping[str, Any]], function: str, setting: Mapping[str, Any] | None = None
) -> Path:
    """Folder in the user's cache that belongs to exactly this study, so that the same command finds it
    again.
    """
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "rigctl" / "studies" / digest(study_identity(tasks, function, setting))


def seeded(tasks: Sequence[Mapping[str, Any]], seed: int) -> list[dict[str, Any]]:
    """The tasks with independent seeds, children of one seed (`numpy.random.SeedSequence.spawn`)."""
    return [{**task, "seed": [seed, place]} for place, task in enumerate(tasks)]


def generator(task: Mapping[str, Any]) -> np.random.Generator:
    """Random numbers of a seeded task: the same wherever and whenever it is computed."""
    seed, place = task["seed"]
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(place,)))


def _executor(job: Job, workers: int, scheduler: str | None) -> Executor:
    if scheduler is not None:
        return DaskCluster(job, scheduler)
    return InProcess(job) if workers == 1 else WorkerPool(job, workers)


class _Run:
    """A study under way."""

    def __init__(
        self,
        tasks: list[dict[str, Any]],
        job: Job,
        checkpoint: Checkpoint | None,
        on_progress: Callable[[Progress], None] | None,
        chunk_s: float,
    ) -> None:
        self.tasks, self.job, self.checkpoint = tasks, job, checkpoint
        self.results: dict[int, Any] = {} if checkpoint is None else checkpoint.results
        self.restored = len(self.results)
        self.pending = deque(place for place in range(len(tasks)) if place not in self.results)
        self._on_progress = on_progress
        self._chunk_s = max(chunk_s, LEAST_CHUNK_S)
        self._size = 1
        self._started = time.monotonic()
        self._code = code_identity(job.function)["sources"]

    def work(self, executor: Executor) -> None:
        """Compute what is pending."""
        under_way = 0
        while self.pending or under_way:
            while self.pending and under_way < executor.slots:
                executor.submit(self._next(executor.slots))
                under_way += 1
            for answer in executor.collect():
                under_way -= 1
                self._keep(answer, executor.elsewhere)
            self.tell()

    def _next(self, slots: int) -> Chunk:
        fair = math.ceil(len(self.pending) / slots)  # the last chunks are shared out evenly
        size = min(self._size, fair, len(self.pending))
        places = tuple(self.pending.popleft() for _ in range(size))
        return Chunk(places, json.dumps([self.tasks[place] for place in places], allow_nan=False))

    def _keep(self, answer: Answer, elsewhere: bool) -> None:
        content = answer.content
        if "error" in content:
            place = answer.places[content["task"]]
            raise RunError(
                f"task {place + 1} of {len(self.tasks)} failed: {content['error']}.",
                place="study",
                value=self.tasks[place],
            ) from RuntimeError(content["trace"])
        if elsewhere and content["code"] != self._code:
            raise RunError(
                "the code of a worker is not that of this process.",
                place="study",
                remedy="Install the same version of rigctl for all workers and start them again.",
            )
        if self.checkpoint is None:
            self.results.update(zip(answer.places, content["results"], strict=True))
        else:
            self.checkpoint.append(answer.places, content["results"])
        cost_s = content["seconds"] / len(answer.places)
        wanted = math.ceil(self._chunk_s / max(cost_s, 1e-6))
        self._size = max(1, min(wanted, _GROWTH * len(answer.places)))

    def tell(self) -> None:
        """Report progress."""
        if self._on_progress is None:
            return
        elapsed, done = time.monotonic() - self._started, len(self.results)
        fresh, left = done - self.restored, len(self.tasks) - done
        left_s = elapsed / fresh * left if fresh else (0.0 if left == 0 else None)
        self._on_progress(Progress(done, len(self.tasks), self.restored, elapsed, left_s))


@dataclass(slots=True)
class RunOptions:
    """How a study's tasks are computed; see `run_study`.

    Attributes
    ----------
    cached : without `folder`, keep finished tasks in the user's cache (`default_folder`) until `forget`
    """

    folder: Path | None = None
    workers: int = 1
    scheduler: str | None = None
    on_progress: Callable[[Progress], None] | None = None
    cached: bool = False
    _used: list[Path] = field(default_factory=list, repr=False)

    def run(self, tasks: Sequence[Mapping[str, Any]], function: str, setting: Mapping[str, Any]) -> list[Any]:
        """`run_study` with these options."""
        folder = self.folder
        if folder is None and self.cached:
            folder = default_folder(tasks, function, setting)
            self._used.append(folder)
        return run_study(
            tasks,
            function,
            setting=setting,
            folder=folder,
            workers=self.workers,
            scheduler=self.scheduler,
            on_progress=self.on_progress,
        )

    def forget(self) -> None:
        """Remove what was kept in the cache; call it when the study's results are written."""
        for folder in self._used:
            for name in (RESULTS, MANIFEST):
                (folder / name).unlink(missing_ok=True)
            folder.rmdir()
        self._used.clear()
