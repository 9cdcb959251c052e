"""The controller's side of the watchdog with clocks of their own, and in lockstep."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from rigctl.core.errors import SafetyTrip
from rigctl.core.wire import Link, Listener, connect
from rigctl.engine.guard import SILENCE_S, Guard


@pytest.fixture
def links() -> Iterator[tuple[Link, Link]]:
    """(the controller's end, the watchdog's end)"""
    path = Path("/dev/shm") / f"guard{os.getpid()}.sock"
    listener = Listener(path)
    accepted: list[Link | None] = []
    thread = threading.Thread(target=lambda: accepted.append(listener.accept(5.0)))
    thread.start()
    own = connect(path, 5.0)
    thread.join(5.0)
    listener.close()
    other = accepted[0]
    assert other is not None
    yield own, other
    own.close()
    other.close()


def status(k: int, nonce: int, state: str = "armed") -> dict[str, object]:
    return {"m": "status", "k": k, "state": state, "nonce": nonce, "cause": "why", "remedy": "do"}


def answer_nonce(link: Link, k: int, hash8: str) -> int:
    """Which nonce below 100 the next heartbeat answers."""
    from rigctl.safety.heartbeat import answer_to

    message = link.recv(1.0)
    assert message is not None and message["k"] == k
    return next(n for n in range(100) if answer_to(n, k, message["mask"], hash8) == message["answer"])


def test_in_real_time_every_answer_is_taken_whatever_its_number(links: tuple[Link, Link]) -> None:
    own, watchdog = links
    guard = Guard(own, "0123abcd", lockstep=False)
    for k, nonce in ((900, 5), (901, 6), (902, 7)):
        watchdog.send(status(k, nonce))
    guard.update(3)
    assert guard.state == "armed"
    guard.heartbeat(3, {"p": 0.0, "n": 0.0, "enable": False})
    assert answer_nonce(watchdog, 3, "0123abcd") == 7


def test_in_lockstep_answers_to_later_blocks_wait(links: tuple[Link, Link]) -> None:
    own, watchdog = links
    guard = Guard(own, "0123abcd")
    watchdog.send(status(2, 5, "locked"))
    watchdog.send(status(3, 6))
    guard.update(3)
    assert guard.state == "locked"
    guard.heartbeat(3, {"p": 0.0, "n": 0.0, "enable": False})
    assert answer_nonce(watchdog, 3, "0123abcd") == 5
    guard.update(4)
    assert guard.state == "armed"


def test_a_trip_of_any_number_stops_the_controller_in_real_time(links: tuple[Link, Link]) -> None:
    own, watchdog = links
    guard = Guard(own, "0123abcd", lockstep=False)
    watchdog.send(status(10**6, 5, "tripped"))
    with pytest.raises(SafetyTrip, match="why"):
        guard.update(0)


@pytest.mark.parametrize("lockstep", [True, False])
def test_a_silent_watchdog_is_found_in_real_time_only(links: tuple[Link, Link], lockstep: bool) -> None:
    own, watchdog = links
    now = [50.0]
    guard = Guard(own, "0123abcd", lockstep=lockstep, clock_s=lambda: now[0])
    watchdog.send(status(0, 5, "locked"))
    guard.update(1)
    now[0] += 60.0
    guard.update(2)  # locked: nothing moves, and the watchdog may take its time
    watchdog.send(status(1, 6))
    guard.update(3)
    assert guard.state == "armed"
    now[0] += SILENCE_S
    guard.update(4)
    now[0] += 0.01
    if lockstep:
        guard.update(5)
    else:
        with pytest.raises(SafetyTrip, match=r"the watchdog has been silent for 0\.5 s"):
            guard.update(5)
