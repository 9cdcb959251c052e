"""The socket for people: who may command, who may stop, what watchers are told."""

import getpass
from collections.abc import Iterator
from pathlib import Path

import pytest

from rigctl.app.control_socket import (
    COMMAND,
    SUPERVISOR,
    WATCH,
    Answer,
    Blocks,
    Commander,
    ControlClient,
    ControlServer,
)
from rigctl.core.blocks import Block
from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import LinkClosed
from rigctl.core.ring import SampleRing
from rigctl.engine.state import Outcome, Progress, RunResult, State, Verb


class Meeting:
    """A server and any number of clients in one process."""

    def __init__(self, run_dir: Path) -> None:
        self.run_dir = run_dir
        self.server = ControlServer(run_dir)
        self.clients: list[ControlClient] = []

    def join(self, who: str, role: str) -> ControlClient:
        client = ControlClient(self.run_dir, 1.0, who=who, role=role)
        self.clients.append(client)
        self.server.next_verb()  # the listener
        self.server.take_asks()  # its hello
        return client

    def close(self) -> None:
        for client in self.clients:
            client.close()
        self.server.close()


@pytest.fixture
def meeting(tmp_path: Path) -> Iterator[Meeting]:
    meeting = Meeting(tmp_path)
    yield meeting
    meeting.close()


def news(client: ControlClient) -> list:
    found = []
    while (each := client.recv(0)) is not None:
        found.append(each)
    return found


def test_the_first_who_asks_commands_and_others_watch(meeting: Meeting):
    anna = meeting.join("anna", COMMAND)
    bert = meeting.join("bert", COMMAND)
    carl = meeting.join("carl", WATCH)
    assert news(anna) == [Commander("anna", True)]
    assert news(bert) == [Commander("anna", False)]
    assert news(carl) == [Commander("anna", False)]
    number = bert.command("set_speed", speed_rpm=40.0)
    assert meeting.server.take_asks() == []
    assert news(bert) == [Answer(number, "anna commands this rig.", "Take the command first.")]


def test_taking_over_is_told_to_whoever_commanded(meeting: Meeting):
    anna, bert = meeting.join("anna", COMMAND), meeting.join("bert", COMMAND)
    bert.take()
    meeting.server.next_verb()
    assert news(anna)[-1] == Commander("bert", False)
    assert news(bert)[-1] == Commander("bert", True)
    anna.send(Verb.PAUSE)
    assert meeting.server.next_verb() is None
    bert.send(Verb.PAUSE)
    assert meeting.server.next_verb() is Verb.PAUSE


def test_anybody_may_stop_note_and_rate(meeting: Meeting):
    meeting.join("anna", COMMAND)
    carl = meeting.join("carl", WATCH)
    carl.send(Verb.STOP)
    assert meeting.server.next_verb() is Verb.STOP
    carl.command("note", text="smells")
    carl.command("rate", rating=3)
    asks = meeting.server.take_asks()
    assert [(ask.command.do, ask.who) for ask in asks] == [("note", "carl"), ("rate", "carl")]


def test_supervisor_ends_whoever_commands(meeting: Meeting):
    boss = meeting.join("rigctl", SUPERVISOR)
    meeting.join("anna", COMMAND)
    boss.send(Verb.END)
    assert meeting.server.next_verb() is Verb.END


def test_command_is_free_again_when_its_holder_leaves(meeting: Meeting):
    anna, bert = meeting.join("anna", COMMAND), meeting.join("bert", COMMAND)
    assert meeting.server.attended
    anna.close()
    meeting.server.next_verb()
    assert not meeting.server.attended
    assert news(bert)[-1] == Commander("", False)
    bert.send(Verb.HOLD)
    assert meeting.server.next_verb() is Verb.HOLD
    assert meeting.server.attended


def test_answers_come_back_with_their_number(meeting: Meeting):
    anna = meeting.join("anna", COMMAND)
    first, second = anna.command("enable"), anna.command("disable")
    asks = meeting.server.take_asks()
    asks[1].refuse("not now.", "Wait.")
    asks[0].done()
    answers = [each for each in news(anna) if isinstance(each, Answer)]
    assert answers == [Answer(second, "not now.", "Wait."), Answer(first, "", "")]


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ({"m": "verb", "verb": "fly"}, "no verb 'fly'"),
        ({"m": "command", "command": {"do": "set_speed"}}, "speed_rpm"),
        ({"m": "command"}, "do"),
        ({"m": "sing"}, "no message 'sing'"),
    ],
)
def test_nonsense_is_answered_and_nothing_happens(meeting: Meeting, message, words):
    anna = meeting.join("anna", COMMAND)
    news(anna)
    anna._send(message)
    assert meeting.server.next_verb() is None
    assert meeting.server.take_asks() == []
    (answer,) = news(anna)
    assert words in answer.reason


def test_late_comer_gets_the_newest_progress_at_once(meeting: Meeting):
    meeting.server.tell(Progress(State.RUNNING, "braking with 5 bar", braking=3, total=9))
    late = meeting.join("dora", WATCH)
    progress = next(each for each in news(late) if isinstance(each, Progress))
    assert (progress.state, progress.braking, progress.total) == (State.RUNNING, 3, 9)


def test_blocks_go_to_those_who_look_only(meeting: Meeting, tmp_path: Path):
    ring = SampleRing.create(tmp_path / "ring", [ChannelSpec("speed", "1/min", 100.0)])
    looking, idle = meeting.join("anna", WATCH), meeting.join("bert", WATCH)
    looking.subscribe()
    meeting.server.next_verb()
    for k in range(2):
        meeting.server.watch(Block(k, k * 50_000_000, 50_000_000, {"speed": (5 * k, 5 * k + 5)}, ring))
        meeting.server._flush_at = 0.0
    blocks = [block for each in news(looking) if isinstance(each, Blocks) for block in each.blocks]
    assert [(block["t_ns"], block["ranges"]["speed"]) for block in blocks] == [
        (0, [0, 5]),
        (50_000_000, [5, 10]),
    ]
    assert not [each for each in news(idle) if isinstance(each, Blocks)]
    ring.close()


def test_end_is_told_with_its_result(meeting: Meeting):
    anna = meeting.join(getpass.getuser(), WATCH)
    meeting.server.finish(RunResult(Outcome.TRIPPED, 2, 9, [3], cause="estop"))
    meeting.server.close()
    result = next(each for each in news_until_closed(anna) if isinstance(each, RunResult))
    assert (result.outcome, result.done, result.incomplete) == (Outcome.TRIPPED, 2, [3])


def news_until_closed(client: ControlClient) -> list:
    found = []
    try:
        while (each := client.recv(1.0)) is not None:
            found.append(each)
    except LinkClosed:
        pass
    return found
