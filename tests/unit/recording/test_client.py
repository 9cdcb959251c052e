"""The controller's side of the recorder: which blocks share a message, and when they are passed on."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import closing
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_samples import SPECS, specification

from rigctl.core.blocks import Block
from rigctl.core.errors import LinkClosed
from rigctl.core.ring import SampleRing
from rigctl.core.wire import Link
from rigctl.recording.client import MERGED_NS, RecorderClient

BLOCK_NS = 50_000_000
PER_MESSAGE = MERGED_NS // BLOCK_NS


class Controller:
    """A client with the other end of its link, and a rig that only counts."""

    def __init__(self, ring: SampleRing, **options: Any) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.client, self.recorder = RecorderClient(Link(ours, "recorder"), **options), Link(theirs, "test")
        self.ring = ring
        self.t_ns = 0
        self.counts = {spec.name: 0 for spec in SPECS}

    def begin(self) -> None:
        self.client.begin(specification(), t0_s=self.t_ns * 1e-9)
        assert self.said() == ["begin"]

    def block(self, dt_ns: int = BLOCK_NS, skip: str = "", lost_ns: int = 0) -> Block:
        """The next block; with `skip` 7 samples of a channel are lost before it, with `lost_ns` time."""
        self.t_ns += lost_ns
        ranges = {}
        for spec in SPECS:
            start = self.counts[spec.name] + (7 if spec.name == skip else 0)
            ranges[spec.name] = (start, start + round(spec.rate_hz * dt_ns * 1e-9))
            self.counts[spec.name] = ranges[spec.name][1]
        made = Block(0, self.t_ns, dt_ns, ranges, self.ring)
        self.t_ns += dt_ns
        self.client.block(made)
        return made

    def close(self) -> None:
        self.client.close()
        self.recorder.close()

    def heard(self) -> list[dict[str, Any]]:
        return self.recorder.drain()

    def said(self) -> list[str]:
        return [message["m"] for message in self.heard()]


@pytest.fixture(scope="module")
def ring(tmp_path_factory: pytest.TempPathFactory) -> SampleRing:
    return SampleRing.create(tmp_path_factory.mktemp("ring") / "ring", SPECS, 1.0)


@pytest.fixture
def controller(ring: SampleRing) -> Iterator[Controller]:
    with closing(Controller(ring)) as made:
        yield made


def test_clocks_are_told_when_they_are_new(controller: Controller, ring: SampleRing) -> None:
    def block(clocks: dict[str, Any]) -> None:
        ranges = {spec.name: (0, 0) for spec in SPECS}
        controller.client.block(Block(0, controller.t_ns, BLOCK_NS, ranges, ring, status={"clocks": clocks}))
        controller.t_ns += BLOCK_NS

    first, second = {"name": {"drift_ppm": 1.0}}, {"name": {"drift_ppm": 2.0}}
    block(first)
    assert controller.heard() == []  # nothing is recorded
    controller.begin()
    for clocks in (first, dict(first), second, {}):
        block(clocks)
    marks = [message for message in controller.heard() if message["m"] == "mark"]
    assert [(mark["name"], mark["values"]) for mark in marks] == [("clocks", first), ("clocks", second)]
    assert [mark["t"] for mark in marks] == [0.1, 0.2]
    controller.client.end()
    controller.heard()
    controller.begin()  # each braking has its own
    block(second)
    assert [message["values"] for message in controller.heard()] == [second]


def test_a_full_message_goes_when_the_next_block_has_come(controller: Controller) -> None:
    controller.begin()
    blocks = [controller.block() for _ in range(PER_MESSAGE)]
    assert controller.heard() == []  # the sound of the last one may still be on its way
    controller.block()
    (message,) = controller.heard()
    assert (message["t"], message["dt"]) == (0, MERGED_NS)
    assert message["r"] == [[0, blocks[-1].ranges[spec.name][1]] for spec in SPECS]


@pytest.mark.parametrize("what", ["mark", "end", "wait_idle", "close"])
def test_nothing_is_held_back_beyond(controller: Controller, what: str) -> None:
    controller.begin()
    controller.block()
    controller.block()
    if what == "mark":
        controller.client.mark("pressure_onset", 0.1)
    elif what == "end":
        controller.client.end()
    elif what == "wait_idle":
        controller.recorder.send({"m": "idle", "n": 1})
        controller.client.wait_idle(5.0)
    else:
        controller.client.close()
    heard = controller.heard()
    assert [m["m"] for m in heard] == ["block", *{"wait_idle": ["idle"], "close": []}.get(what, [what])]
    assert heard[0]["dt"] == 2 * BLOCK_NS


def test_the_next_braking_starts_afresh(controller: Controller) -> None:
    controller.begin()
    controller.block()
    controller.client.end()
    assert controller.said() == ["block", "end"]
    controller.block()  # between brakings
    controller.begin()
    controller.block()
    controller.client.end("incomplete", "why")
    block, end = controller.heard()
    assert (block["t"], block["dt"]) == (2 * BLOCK_NS, BLOCK_NS) and end["status"] == "incomplete"


@pytest.mark.parametrize("gap", [{"skip": "speed"}, {"skip": "microphone"}, {"lost_ns": 1000}])
def test_blocks_that_do_not_join_do_not_share_a_message(controller: Controller, gap: dict[str, Any]) -> None:
    controller.begin()
    first = controller.block()
    second = controller.block(**gap)
    controller.client.end()
    messages = controller.heard()[:-1]
    assert [m["r"] for m in messages] == [
        [list(block.ranges[spec.name]) for spec in SPECS] for block in (first, second)
    ]
    assert [m["t"] for m in messages] == [first.t_ns, second.t_ns]


_steps = st.one_of(
    st.tuples(
        st.just("block"), st.sampled_from([5, 20, 50, 100, 500]), st.sampled_from(["", "", "", "torque"])
    ),
    st.tuples(st.just("mark"), st.just(0), st.just("")),
)


@settings(max_examples=60, deadline=None)
@given(steps=st.lists(_steps, max_size=40))
def test_every_sample_is_passed_on_once_and_in_order(ring: SampleRing, steps: list[Any]) -> None:
    expected: list[Any] = []  # single samples of a channel and marks, in order
    heard: list[Any] = []
    with closing(Controller(ring)) as controller:
        controller.begin()
        for kind, ms, skip in steps:
            if kind == "mark":
                controller.client.mark("m", 0.0)
                expected.append("mark")
            else:
                block = controller.block(dt_ns=ms * 1_000_000, skip=skip)
                expected += range(*block.ranges["torque"])
        controller.client.end()
        messages = controller.heard()[:-1]
    for message in messages:
        if message["m"] == "mark":
            heard.append("mark")
            continue
        samples = range(*message["r"][1])
        assert message["dt"] * 4 == len(samples) * 1_000_000 and message["dt"] < MERGED_NS + 500_000_000
        heard += samples
    assert heard == expected


def test_a_channel_that_the_rig_does_not_deliver_is_empty(controller: Controller) -> None:
    controller.client.begin(specification(channels=[{"name": "force"}]), t0_s=0.0)
    controller.block()
    controller.client.end()
    assert controller.heard()[1]["r"] == [[0, 0]]


def test_the_window_counts_what_was_passed_on(ring: SampleRing) -> None:
    with closing(Controller(ring, window_s=1.0)) as controller:
        controller.begin()
        controller.recorder.send({"m": "copied", "t": 0.5})
        for _ in range(5 * PER_MESSAGE + 1):  # 1.25 s: more than the window, but 0.5 s are copied
            controller.block()
        assert len(controller.heard()) == 5


def test_a_dead_recorder_is_told_once_and_leaving_it_is_no_error(controller: Controller) -> None:
    controller.begin()
    controller.recorder.close()
    controller.block()
    with pytest.raises(LinkClosed):
        controller.client.mark("pressure_onset", 0.0)
    controller.block()
    controller.client.close()
