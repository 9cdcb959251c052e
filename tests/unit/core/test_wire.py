"""Links keep message boundaries, notice death, and never block without a limit."""

import os
import signal
import threading
import time
from pathlib import Path

import pytest

from rigctl.core.errors import DeviceError, LinkClosed
from rigctl.core.wire import MAX_MESSAGE_BYTES, Link, Listener, connect


@pytest.fixture
def pair(tmp_path: Path):
    listener = Listener(tmp_path / "s")
    client = connect(tmp_path / "s", 1.0)
    server = listener.accept(1.0)
    assert server is not None
    yield client, server
    client.close()
    server.close()
    listener.close()


def test_messages_keep_their_boundaries_and_order(pair: tuple[Link, Link]):
    client, server = pair
    sent = [{"m": "a", "n": i, "x": [0.1, None, "ü"]} for i in range(50)]
    for message in sent:
        client.send(message)
    assert [server.recv(1.0) for _ in sent] == sent
    assert server.recv(0) is None
    assert server.drain() == []


def test_recv_gives_up_after_its_time(pair: tuple[Link, Link]):
    _, server = pair
    start = time.monotonic()
    assert server.recv(0.05) is None
    assert 0.04 < time.monotonic() - start < 2.0


def test_peer_that_has_gone_is_noticed_by_both_calls(pair: tuple[Link, Link]):
    client, server = pair
    client.send({"m": "last"})
    client.close()
    assert server.recv(1.0) == {"m": "last"}  # what was sent before the end is not lost
    with pytest.raises(LinkClosed):
        server.recv(1.0)
    with pytest.raises(LinkClosed):
        server.send({"m": "x"})


def test_last_words_of_a_peer_are_heard_before_its_end(pair: tuple[Link, Link]):
    client, server = pair
    server.send({"m": "never read"})
    client.send({"m": "a"})
    client.send({"m": "b"})
    client.close()  # with unread data: the kernel reports a reset
    assert [message["m"] for message in server.drain()] == ["a", "b"]
    with pytest.raises(LinkClosed):
        server.drain()


def test_killed_process_is_noticed(tmp_path: Path):
    listener = Listener(tmp_path / "s")
    pid = os.fork()
    if pid == 0:
        connect(tmp_path / "s", 5.0)
        time.sleep(60)
        os._exit(0)
    server = listener.accept(5.0)
    assert server is not None
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    with pytest.raises(LinkClosed):
        server.recv(5.0)
    server.close()
    listener.close()


def test_peer_that_does_not_read_does_not_block_for_ever(pair: tuple[Link, Link]):
    client, _ = pair
    with pytest.raises(DeviceError, match="has not read"):
        for _ in range(100_000):
            client.send({"m": "x" * 1000}, timeout_s=0.05)


def test_too_large_and_foreign_messages_are_refused(pair: tuple[Link, Link]):
    client, server = pair
    with pytest.raises(DeviceError, match="too large"):
        client.send({"m": "x" * MAX_MESSAGE_BYTES})
    client._sock.send(b"not json")
    with pytest.raises(DeviceError, match="not JSON"):
        server.recv(1.0)
    client._sock.send(b"[1]")
    with pytest.raises(DeviceError, match="not an object"):
        server.recv(1.0)


def test_connect_waits_for_the_listener_and_names_the_path(tmp_path: Path):
    with pytest.raises(DeviceError, match="nobody"):
        connect(tmp_path / "nobody", 0.05)
    listeners: list[Listener] = []
    timer = threading.Timer(0.1, lambda: listeners.append(Listener(tmp_path / "late")))
    timer.start()
    connect(tmp_path / "late", 5.0).close()
    timer.join()
    listeners[0].close()


def test_socket_is_private(tmp_path: Path):
    listener = Listener(tmp_path / "s")
    assert (tmp_path / "s").stat().st_mode & 0o077 == 0
    listener.close()
    assert not (tmp_path / "s").exists()
