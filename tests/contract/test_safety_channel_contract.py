"""What every safety channel must do, for the simulated rig and for the safety I/O on a CAN bus.

Both ends are tested together: the controller's read-back (`SafetyChannel`) and the link that it names for the
watchdog (`SafetyLink`), as the watchdog process would load it.
"""

from __future__ import annotations

import json
import select
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import can
import pytest

from drivers.safety_io.can_channel import CanSafetyChannel
from rigctl.app.compose import build_rig, read_rig
from rigctl.core.errors import ConfigError, DeviceError, LinkClosed
from rigctl.core.registry import load_target
from rigctl.core.safety_link import SafetyLink, SafetySample
from rigctl.hal.devices import RigContext, SafetyChannel
from sim_hardware.bench.can import BenchCan, BenchCanSettings, FaultRule
from sim_hardware.bench.can.settings import AmplifierSettings, EncoderSettings
from sim_hardware.bench.signals import RigSignals

ROOT = Path(__file__).parents[2]
SIMULATED = ROOT / "configs" / "rigs" / "simulated.toml"
RELAY_S = 0.150
RESERVE_S = 0.4  # for the load of the machine; the faults' tests measure the times


@dataclass
class Party:
    """A channel and its link, open, with a way to go on and to stop."""

    channel: SafetyChannel
    link: SafetyLink
    close: Callable[[], None]
    bench: BenchCan | None = None
    samples: list[SafetySample] = field(default_factory=list[SafetySample])

    def answer(self, word: str, timeout_s: float = 3.0) -> SafetySample:
        """Take the next sample and answer it."""
        sample = self.link.recv(timeout_s)
        assert sample is not None, "no sample"
        self.samples.append(sample)
        if word == "open":
            self.link.open_relay(sample.k, "test")
        elif word != "nothing":
            {"edge": self.link.edge, "hold": self.link.hold, "close": self.link.close_relay}[word](sample.k)
        return sample

    def until(self, word: str, condition: Callable[[SafetySample], bool], blocks: int = 40) -> SafetySample:
        """Answer samples until one fulfils the condition."""
        for _ in range(blocks):
            sample = self.answer(word)
            if condition(sample):
                return sample
        raise AssertionError(self.samples[-1])

    def closed(self) -> None:
        """Close the relay and see it closed at both ends."""
        self.until("hold", healthy)
        self.answer("close")
        self.until("edge", lambda sample: sample.relay_closed)
        self.until("edge", lambda _sample: self.channel.status().relay_closed)


def healthy(sample: SafetySample) -> bool:
    """Every reading is a number and the chain is closed."""
    readings = (*sample.pressure_bar, *sample.speed_rpm, *sample.torque_nm, *sample.temperature_degc)
    return None not in readings and sample.estop_ok and sample.doors_ok and not sample.channel_fault


def link_of(channel: SafetyChannel) -> SafetyLink:
    """As the watchdog process makes it: the settings have gone through JSON."""
    target, settings = channel.watchdog_link()
    return load_target(target, place="test")(json.loads(json.dumps(dict(settings))))


def simulated(tmp_path: Path) -> Party:
    context = RigContext(tmp_path, "real", 1, str(SIMULATED), SIMULATED.parent)
    rig = build_rig(read_rig(SIMULATED), context)
    link = link_of(rig.safety)
    connected = threading.Thread(target=link.connect, args=(30.0,))
    connected.start()
    stop = threading.Event()

    def blocks() -> None:
        try:
            for _ in rig.blocks():
                if stop.is_set():
                    return
        except DeviceError:
            assert stop.is_set()

    rig.open()
    connected.join(30.0)
    pump = threading.Thread(target=blocks)
    pump.start()

    def close() -> None:
        stop.set()
        link.close()
        pump.join(10.0)
        rig.close()
        rig.safety._session._process.wait(20.0)  # type: ignore[attr-defined]

    return Party(rig.safety, link, close)


def can_context(tmp_path: Path, port: int) -> RigContext:
    table = {
        "interface": "udp_multicast", "channel": "239.74.163.2", "port": port, "hop_limit": 0, "fd": False,
    }  # fmt: skip
    return RigContext(tmp_path, "real", None, "rig.toml", tmp_path, buses={"main": table})


SETTINGS: dict[str, Any] = {"bus": "main", "start_nodes": [0x20, 0x21, 0x22, 0x30]}


def on_can(tmp_path: Path, port: int) -> Party:
    context = can_context(tmp_path, port)
    arguments = {key: value for key, value in context.buses["main"].items() if key != "interface"}
    bus = can.Bus(interface="udp_multicast", **arguments)
    settings = BenchCanSettings(amplifier=AmplifierSettings(tpdo_ms=5), encoder=EncoderSettings(tpdo_ms=5))
    bench = BenchCan(bus, RigSignals(), settings)
    bench.start()
    bench.wait_booted()
    channel = CanSafetyChannel(SETTINGS, context)
    link = link_of(channel)
    link.connect(10.0)
    channel.open()

    def close() -> None:
        link.close()
        channel.close()
        bench.stop()
        bus.shutdown()

    return Party(channel, link, close, bench)


def free_port() -> int:
    import socket

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


@pytest.fixture(params=["simulated", "can"], scope="module")
def open_party(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Party]:
    """One for all tests: the simulated rig takes seconds to start."""
    folder = tmp_path_factory.mktemp("s")
    made = simulated(folder) if request.param == "simulated" else on_can(folder, free_port())
    try:
        yield made
    finally:
        made.close()


@pytest.fixture
def party(open_party: Party) -> Party:
    """With the relay open, nothing waiting."""
    while (sample := open_party.link.recv(0.0)) is not None:
        open_party.link.open_relay(sample.k, "the next test")
    open_party.answer("open")
    open_party.until("hold", lambda new: not new.relay_closed)
    return open_party


@pytest.fixture
def on_bus(tmp_path: Path) -> Iterator[Party]:
    made = on_can(tmp_path, free_port())
    try:
        yield made
    finally:
        made.close()


# -- both -------------------------------------------------------------------------------------------


def test_samples_are_numbered_timed_and_complete(party: Party) -> None:
    party.until("hold", healthy)
    party.samples.clear()
    for _ in range(10):
        party.answer("hold")
    for before, sample in zip(party.samples, party.samples[1:], strict=False):
        assert sample.k == before.k + 1
        assert sample.t_s - before.t_s == pytest.approx(sample.dt_s, abs=1e-6)
        assert healthy(sample) and not sample.relay_closed and not sample.drive_enabled
        count = round(sample.dt_s * 100.0)
        signals = (sample.pressure_bar, sample.speed_rpm, sample.torque_nm, sample.temperature_degc)
        assert {len(values) for values in signals} == {count}


def test_the_descriptor_is_readable_when_a_sample_waits_and_only_then(party: Party) -> None:
    party.until("hold", healthy)
    seen = 0
    deadline_s = time.monotonic() + 5.0
    while seen < 10 and time.monotonic() < deadline_s:
        readable = bool(select.select([party.link], [], [], 0.01)[0])
        sample = party.link.recv(0.0)
        if readable:
            assert sample is not None
        if sample is not None:
            party.link.hold(sample.k)
            seen += 1
    assert seen == 10


def test_the_relay_closes_by_command_only_and_stays_closed_by_edges(party: Party) -> None:
    party.until("hold", healthy)
    for _ in range(5):
        assert not party.answer("edge").relay_closed
    party.closed()
    for _ in range(10):
        assert party.answer("edge").relay_closed
    status = party.channel.status()
    assert status.relay_closed and status.estop_ok and status.doors_ok


def test_the_relay_opens_on_command(party: Party) -> None:
    party.closed()
    party.answer("open")
    party.until("hold", lambda sample: not sample.relay_closed, blocks=4)
    party.until("hold", lambda _sample: not party.channel.status().relay_closed)
    for _ in range(4):
        assert not party.answer("edge").relay_closed  # edges alone do not bring it back


def test_the_relay_opens_when_the_edges_stop(party: Party) -> None:
    party.closed()
    since_s = time.monotonic()
    while party.channel.status().relay_closed:
        assert time.monotonic() - since_s < RELAY_S + RESERVE_S
        time.sleep(0.002)


def test_it_says_who_it_is(party: Party) -> None:
    identity = party.channel.identity()
    assert identity and all(isinstance(text, str) for pair in identity.items() for text in pair)


def test_the_relay_opens_when_the_watchdog_leaves(party: Party) -> None:  # the last one of this party
    party.closed()
    party.link.close()
    deadline_s = time.monotonic() + RELAY_S + RESERVE_S
    while party.channel.status().relay_closed:
        assert time.monotonic() < deadline_s
        time.sleep(0.002)
    with pytest.raises(LinkClosed):
        for _ in range(100):  # what was there before may still be had
            party.link.recv(0.1)


# -- CAN --------------------------------------------------------------------------------------------


def test_the_state_is_on_the_board(on_bus: Party) -> None:
    assert isinstance(on_bus.channel, CanSafetyChannel) and on_bus.bench is not None
    board = on_bus.channel._context.board
    assert board.snapshot() == {"relay": False, "estop": True, "doors": True, "enabled": False}
    on_bus.closed()
    assert board.snapshot()["relay"] is True
    on_bus.bench.call(lambda: on_bus.bench and on_bus.bench.devices["safety_io"]._signals.set(estop_ok=False))  # type: ignore[attr-defined]
    on_bus.until("edge", lambda sample: not sample.estop_ok)
    assert board.snapshot()["estop"] is False and board.snapshot()["relay"] is False


def test_a_state_that_is_too_old_is_no_state(on_bus: Party) -> None:
    assert isinstance(on_bus.channel, CanSafetyChannel) and on_bus.bench is not None
    on_bus.closed()
    on_bus.bench.add_fault(FaultRule(kind="mute", node=0x30))
    board = on_bus.channel._context.board
    deadline_s = time.monotonic() + 2.0
    while board.snapshot()["relay"]:
        assert time.monotonic() < deadline_s
        time.sleep(0.005)
    assert board.snapshot()["estop"] is False and "no state" in str(board.snapshot()["faults"])
    with pytest.raises(DeviceError, match=r"safety I/O 30h on bus 'main': has sent no state for \d+ ms"):
        on_bus.channel.status()
    values = on_bus.channel.diagnose(0).values
    assert [value.value for value in values] == [None] * 4 and values[0].fault
    on_bus.bench.clear_faults()
    while "faults" in board.snapshot():
        assert time.monotonic() < deadline_s + 2.0
        time.sleep(0.005)
    while on_bus.channel.status().relay_closed:  # no edge has come for 150 ms
        assert time.monotonic() < deadline_s + 2.0
        time.sleep(0.005)


def test_diagnosis_tells_states_and_rate(on_bus: Party) -> None:
    assert isinstance(on_bus.channel, CanSafetyChannel)
    time.sleep(0.3)
    diagnosis = on_bus.channel.diagnose(3)
    assert {value.name: value.value for value in diagnosis.values} == {
        "relay closed": False, "e-stop ok": True, "doors ok": True, "drive enable": False,
    }  # fmt: skip
    assert diagnosis.values[0].rate_hz is not None and 50.0 < diagnosis.values[0].rate_hz < 150.0
    assert diagnosis.warnings == () and list(diagnosis.round_trip_s) == []


def test_a_bus_without_the_node(tmp_path: Path) -> None:
    channel = CanSafetyChannel(SETTINGS, can_context(tmp_path, free_port()))
    with pytest.raises(DeviceError, match=r"sends no state .1B0h. within"):
        channel.open()
    channel.close()
    link = link_of(channel)
    with pytest.raises(DeviceError, match="heard on the bus: nothing"):
        link.connect(0.3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bus": "other"}, "buses.other: there is no bus 'other'. Buses of this rig file: main"),
        ({"bus": 3}, "devices.safety.bus: 3 is no name of a bus"),
        ({"watchdog_bus": "second"}, "there is no bus 'second'"),
        ({"node": 200}, "devices.safety.node: 200 is out of range. Give a whole number from 1 to 127"),
        ({"stat_cob_id": 1}, "devices.safety.stat_cob_id: 1 is an unknown key"),
        ({"state_stale_s": 1.0}, "devices.safety.state_stale_s: 1.0 is out of range"),
        ({"pressure": {"type": "i64"}}, "devices.safety.pressure.type: 'i64' is no type of value"),
        ({"torque": {"scale": 0.0}}, "devices.safety.torque.scale: 0.0 makes every reading the same"),
        ({"speed": {"offset": 7}}, "devices.safety.speed.offset: 7 is out of range"),
        ({"temperature": {"status_offset": 1}}, "1 lies within the value"),
        ({"temperature": 5}, "devices.safety.temperature: 5 is no table"),
        ({"temperature": {"current_loop": 1}}, "current_loop: 1 is not true or false"),
        ({"speed": {"stale_s": float("nan")}}, "devices.safety.speed.stale_s: nan is no number"),
        ({"start_nodes": [0]}, "devices.safety.start_nodes: [0] is no list of node ids"),
        ({"state_cob_id": 0x1A0}, "the identifiers of command, state and signals are not different"),
    ],
)
def test_wrong_settings(tmp_path: Path, changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError) as caught:
        CanSafetyChannel({**SETTINGS, **changes}, can_context(tmp_path, 50000))
    assert words in str(caught.value) and caught.value.remedy
