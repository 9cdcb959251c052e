"""Tasks shared with a forked process: same results, same order, whatever happens to that process."""

import os
import threading
import time
from pathlib import Path

import pytest

from rigctl.analysis import two_processes
from rigctl.analysis.two_processes import in_two_processes

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")


@pytest.fixture
def two_cores(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    monkeypatch.setattr(two_processes.sys, "platform", "linux")
    count, of_the_runner = threading.active_count, threading.active_count()  # pytest-xdist has one of its own
    monkeypatch.setattr(two_processes.threading, "active_count", lambda: count() - of_the_runner + 1)


def _who(k):
    def task():
        time.sleep(0.05)
        return f"{k} {os.getpid()}"

    return task


def _children() -> set[str]:
    """Children of this process, zombies included."""
    pid = os.getpid()
    return set(Path(f"/proc/{pid}/task/{pid}/children").read_text().split())


def test_both_processes_work_and_order_is_kept(two_cores):
    results = [text.split() for text in in_two_processes([_who(k) for k in range(6)])]
    assert [int(k) for k, _ in results] == list(range(6))
    pids = {int(pid) for _, pid in results}
    assert len(pids) == 2
    assert os.getpid() in pids


def test_long_texts_do_not_block(two_cores):
    texts = [chr(97 + k) * 300_000 + "µ" for k in range(4)]
    tasks = [lambda text=text: (time.sleep(0.02), text)[1] for text in texts]
    assert in_two_processes(tasks) == texts


def test_with_another_thread_everything_runs_here(two_cores):
    stop = threading.Event()
    thread = threading.Thread(target=stop.wait)
    thread.start()
    try:
        results = in_two_processes([_who(k) for k in range(3)])
    finally:
        stop.set()
        thread.join()
    assert {int(text.split()[1]) for text in results} == {os.getpid()}


def test_on_one_core_everything_runs_here(two_cores, monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0}, raising=False)
    assert {text.split()[1] for text in in_two_processes([_who(k) for k in range(3)])} == {str(os.getpid())}


def test_what_a_dying_process_leaves_undone_is_done_here(two_cores):
    parent = os.getpid()

    def dies_elsewhere(k):
        def task():
            time.sleep(0.05)
            if os.getpid() != parent:
                os._exit(9)
            return str(k)

        return task

    assert in_two_processes([dies_elsewhere(k) for k in range(4)]) == ["0", "1", "2", "3"]


def test_an_error_is_raised_here_wherever_it_happens_and_no_process_is_left(two_cores):
    def fails():
        time.sleep(0.05)
        raise OSError(28, "No space left on device", "figure.png")

    before = _children()  # of other tests in this worker
    with pytest.raises(OSError, match="No space left"):
        in_two_processes([_who(0), fails, _who(2), fails])
    assert _children() <= before


def test_nothing_to_do_is_no_error():
    assert in_two_processes([]) == []
