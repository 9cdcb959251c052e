"""Long studies: the same results anywhere, kept while they run, going on after any interruption."""

import json
import os
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import pytest

from rigctl.core.errors import ConfigError, RunError
from rigctl.model.runner import Progress, StudyStopped, default_folder, generator, run_study, seeded

TASKS = seeded([{"number": n} for n in range(24)], seed=5)
NUMBERS = [{"number": n} for n in range(8)]
SIZE = {"size": 28}


def test_same_results_in_process_and_pool_bit_for_bit():
    here = run_study(TASKS, "runner_tasks:eigenvalues", setting=SIZE)
    pool = run_study(TASKS, "runner_tasks:eigenvalues", setting=SIZE, workers=2, chunk_s=0.05)
    assert json.dumps(here) == json.dumps(pool)
    assert len({result["sum"] for result in here}) == len(TASKS)


def test_same_results_on_dask_bit_for_bit():
    from distributed import LocalCluster

    here = run_study(TASKS, "runner_tasks:eigenvalues", setting=SIZE)
    with (
        warnings.catch_warnings(),
        LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None, protocol="tcp"
        ) as cluster,
    ):
        warnings.simplefilter("ignore")
        there = run_study(
            TASKS, "runner_tasks:eigenvalues", setting=SIZE, scheduler=cluster.scheduler_address
        )
    assert json.dumps(here) == json.dumps(there)


def test_dask_errors_are_clear(monkeypatch):
    with pytest.raises(ConfigError, match="no Dask scheduler answers"):
        monkeypatch.setattr("rigctl.model.runner_executors._CONNECT_S", 0.2)
        run_study(NUMBERS, "runner_tasks:fails", scheduler="tcp://127.0.0.1:9")
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ConfigError, match="not installed"):
        run_study(NUMBERS, "runner_tasks:fails", scheduler="tcp://127.0.0.1:9")
    with pytest.raises(ConfigError, match="cannot be combined"):
        run_study(NUMBERS, "runner_tasks:fails", scheduler="tcp://127.0.0.1:9", workers=2)


def test_seeds_are_children_of_one_seed():
    import numpy as np

    children = np.random.SeedSequence(5).spawn(24)
    for task, child in zip(TASKS, children, strict=True):
        assert generator(task).random() == np.random.default_rng(child).random()


def test_goes_on_after_ctrl_c(tmp_path):
    setting = {"pressed": str(tmp_path / "pressed"), "pid": os.getpid()}
    kept = tmp_path / "study"
    with pytest.raises(StudyStopped) as stopped:
        run_study(NUMBERS, "runner_tasks:interrupts", setting=setting, folder=kept)
    assert 1 <= stopped.value.done < len(NUMBERS)
    assert str(kept) in str(stopped.value)
    seen: list[Progress] = []
    found = run_study(
        NUMBERS, "runner_tasks:interrupts", setting=setting, folder=kept, on_progress=seen.append
    )
    assert found == [n["number"] for n in NUMBERS]
    assert seen[-1].restored == stopped.value.done
    assert (seen[-1].done, seen[-1].left_s) == (8, 0.0)


def test_ctrl_c_ends_the_pool_at_once(tmp_path):
    setting = {"pressed": str(tmp_path / "pressed"), "pid": os.getpid()}
    with pytest.raises(StudyStopped):
        run_study(NUMBERS, "runner_tasks:interrupts", setting=setting, workers=2, folder=tmp_path / "study")
    assert run_study(
        NUMBERS, "runner_tasks:interrupts", setting=setting, workers=2, folder=tmp_path / "study"
    ) == list(range(8))


def test_goes_on_after_kill_9(tmp_path):
    script = (
        "from rigctl.model.runner import run_study\n"
        "from pathlib import Path\n"
        f"run_study({NUMBERS}, 'runner_tasks:slow', setting={{'log': {str(tmp_path / 'log')!r}}},"
        f" folder=Path({str(tmp_path / 'study')!r}), workers=2, chunk_s=0.05)\n"
    )
    here = str(Path(__file__).parent)
    process = subprocess.Popen(
        [sys.executable, "-c", script], env={**os.environ, "PYTHONPATH": here}, cwd=Path.cwd()
    )
    results = tmp_path / "study" / "results.jsonl"
    until = time.monotonic() + 60
    while (not results.exists() or not results.stat().st_size) and time.monotonic() < until:
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()
    time.sleep(0.3)  # a worker notices at the end of its task
    before = (tmp_path / "log").read_text().split()
    assert len(before) < len(NUMBERS)
    kept = sum(len(json.loads(line[9:])["places"]) for line in results.read_text().splitlines())
    assert 1 <= kept < len(NUMBERS)
    time.sleep(0.3)
    assert (tmp_path / "log").read_text().split() == before, "workers went on without their study"
    seen: list[Progress] = []
    found = run_study(
        NUMBERS, "runner_tasks:slow", setting={"log": str(tmp_path / "log")},
        folder=tmp_path / "study", on_progress=seen.append,
    )  # fmt: skip
    assert found == [7 * n for n in range(8)]
    assert seen[-1].restored == kept
    assert len((tmp_path / "log").read_text().split()) - len(before) == len(NUMBERS) - kept


def test_death_of_a_worker_is_reported_and_the_rest_kept(tmp_path):
    kept = tmp_path / "study"
    with pytest.raises(
        RunError,
        match=r"killed \(SIGKILL\) while computing tasks? [2-4].*\d of 8 tasks are kept in .*fewer --workers",
    ):
        run_study(NUMBERS, "runner_tasks:dies", workers=2, folder=kept)
    lines = (kept / "results.jsonl").read_text().splitlines()
    places = sorted(p for line in lines for p in json.loads(line[9:])["places"])
    assert 0 in places
    assert 3 not in places


@pytest.mark.parametrize("workers", [1, 2])
def test_failure_of_a_task_names_it(workers):
    with pytest.raises(RunError, match=r"task 3 of 8 failed: ZeroDivisionError"):
        run_study(NUMBERS, "runner_tasks:fails", workers=workers)


def test_results_must_be_json():
    with pytest.raises(RunError, match="not JSON compliant"):
        run_study(NUMBERS, "runner_tasks:not_json")


def test_unknown_functions_and_workers_are_refused():
    for name in ("runner_tasks", "runner_tasks:nothing"):
        with pytest.raises(ValueError, match="function"):
            run_study(NUMBERS, name)
    with pytest.raises(ConfigError, match="at least 1"):
        run_study(NUMBERS, "runner_tasks:fails", workers=0)


def test_no_tasks_give_no_results():
    assert run_study([], "runner_tasks:fails") == []


def test_default_folder_belongs_to_the_study(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    one = default_folder(NUMBERS, "runner_tasks:fails", {"a": 1})
    assert one.is_relative_to(tmp_path)
    assert one == default_folder(list(NUMBERS), "runner_tasks:fails", {"a": 1})
    assert one != default_folder(NUMBERS, "runner_tasks:fails", {"a": 2})
    assert one != default_folder(NUMBERS[1:], "runner_tasks:fails", {"a": 1})
