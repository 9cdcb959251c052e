"""`Cycle`: periods, ends, and what a failing task does to the others."""

from __future__ import annotations

import threading
import time

from drivers.can.cycle import Cycle


def test_tasks_run_with_their_periods():
    cycle, calls = Cycle("test"), {0.01: 0, 0.05: 0}

    def count(period_s: float) -> None:
        calls[period_s] += 1

    ends = [cycle.add(lambda p=period_s: count(p), period_s, _no_error) for period_s in calls]
    time.sleep(0.3)
    for end in ends:
        end()
    assert 10 <= calls[0.01] <= 31
    assert 3 <= calls[0.05] <= 7


def test_after_the_end_nothing_runs_and_the_thread_is_gone():
    cycle, calls = Cycle("cycle under test"), []
    end = cycle.add(lambda: calls.append(1), 0.005, _no_error)
    time.sleep(0.03)
    end()
    count = len(calls)
    assert count > 0
    time.sleep(0.03)
    assert len(calls) == count
    assert "cycle under test" not in [thread.name for thread in threading.enumerate()]
    end()


def test_a_failing_task_ends_and_the_others_go_on():
    cycle, calls, errors = Cycle("test"), [], []
    end = cycle.add(lambda: calls.append(1), 0.005, _no_error)
    cycle.add(lambda: 1 / 0, 0.005, errors.append)
    time.sleep(0.1)
    end()
    assert [type(error) for error in errors] == [ZeroDivisionError]
    assert len(calls) > 5


def test_a_cycle_can_be_used_again():
    cycle, calls = Cycle("test"), []
    for _ in range(2):
        end = cycle.add(lambda: calls.append(1), 0.005, _no_error)
        time.sleep(0.02)
        end()
    assert len(calls) >= 2


def _no_error(error: Exception) -> None:
    raise AssertionError(error)
