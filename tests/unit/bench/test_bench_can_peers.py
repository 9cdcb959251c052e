"""Independent peers in real time: the `canopen` library as master, and a second process over UDP multicast.

The dictionary that the library uses is written here from the devices' manual, not taken from the emulator.
"""

from __future__ import annotations

import socket
import struct
import subprocess
import sys
import threading
import time
import uuid

import can
import canopen
import pytest
from canopen.objectdictionary import ODRecord, ODVariable, datatypes

from sim_hardware.bench.can import BenchCan, BenchCanSettings, FaultRule
from sim_hardware.bench.signals import RigSignals

REGULATOR, AMPLIFIER, SAFETY = 0x10, 0x20, 0x30
U8, U16, U32, I16, I32 = (
    datatypes.UNSIGNED8,
    datatypes.UNSIGNED16,
    datatypes.UNSIGNED32,
    datatypes.INTEGER16,
    datatypes.INTEGER32,
)


def _variable(index: int, sub: int, kind: int, name: str) -> ODVariable:
    variable = ODVariable(name, index, sub)
    variable.data_type = kind
    return variable


def _dictionary(variables: dict[str, tuple[int, int]], lists: dict[str, tuple[int, dict[int, int]]]):
    """Plain objects (name: index, type) and those with sub-indices (name: index, {sub: type})."""
    dictionary = canopen.ObjectDictionary()
    for name, (index, kind) in variables.items():
        dictionary.add_object(_variable(index, 0, kind, name))
    for name, (index, subs) in lists.items():
        record = ODRecord(name, index)
        record.add_member(_variable(index, 0, U8, "count"))
        for sub, kind in subs.items():
            record.add_member(_variable(index, sub, kind, f"{name} {sub}"))
        dictionary.add_object(record)
    for number in (0x1A00, 0x1600):
        mapping = ODRecord(f"mapping {number:X}", number)
        for sub in range(9):
            mapping.add_member(_variable(number, sub, U32 if sub else U8, f"mapped {sub}"))
        dictionary.add_object(mapping)
    return dictionary


COMMON = {"device type": (0x1000, U32), "error register": (0x1001, U8), "heartbeat": (0x1017, U16)}
COMMON_LISTS = {
    "identity": (0x1018, {1: U32, 2: U32, 3: U32, 4: U32}),
    "watched": (0x1016, {1: U32}),
    "tpdo": (0x1800, {1: U32, 2: U8, 3: U16, 5: U16}),
    "rpdo": (0x1400, {1: U32, 2: U8}),
}
REGULATOR_DICTIONARY = (
    COMMON
    | {
        "control": (0x6040, U16),
        "status": (0x6041, U16),
        "reaction": (0x2100, U8),
        "name": (0x1008, datatypes.VISIBLE_STRING),
    },
    COMMON_LISTS | {"set-point": (0x6300, {1: I16}), "actual": (0x6301, {1: I16})},
)
AMPLIFIER_DICTIONARY = (
    COMMON,
    COMMON_LISTS | {"value": (0x9130, {1: I32, 2: I32}), "state": (0x6150, {1: U8, 2: U8})},
)


@pytest.fixture
def rig():
    """Bench in its own thread, and a master made of the library."""
    channel = uuid.uuid4().hex
    signals = RigSignals({"torque_nm": 12.34, "pressure_bar": 1.5})
    bus = can.Bus(channel, interface="virtual")
    bench = BenchCan(bus, signals)
    network = canopen.Network()
    network.NOTIFIER_CYCLE = 0.05  # so long it takes to end
    network.connect(interface="virtual", channel=channel)
    yield bench, network, signals
    bench.stop()
    bench.check()
    network.disconnect()
    bus.shutdown()


def _boot(bench: BenchCan, network: canopen.Network, node_id: int) -> None:
    """Start the bench and hear the node's boot-up. Who waits for it only afterwards may have missed it."""
    heard = threading.Event()
    network.subscribe(0x700 + node_id, lambda _id, data, _time: data == b"\0" and heard.set())
    bench.start()
    assert heard.wait(5.0)


def _wait(condition, timeout_s: float = 3.0) -> None:
    deadline = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline, "it has not happened in time"
        time.sleep(0.005)


def test_the_library_configures_the_regulator_and_moves_pressure(rig):
    bench, network, signals = rig
    node = network.add_node(canopen.RemoteNode(REGULATOR, _dictionary(*REGULATOR_DICTIONARY)))
    _boot(bench, network, REGULATOR)
    assert node.sdo["device type"].raw == 0x80198
    assert node.sdo["name"].raw == "Bench pressure regulator"
    assert node.sdo["identity"][2].raw == REGULATOR
    with pytest.raises(canopen.SdoAbortedError) as caught:
        node.sdo["status"].raw = 0
    assert caught.value.code == 0x06010002
    node.sdo["reaction"].raw = 1
    node.sdo["watched"][1].raw = 1 << 16 | 300
    assert node.sdo["reaction"].raw == 1

    node.tpdo.read()
    node.rpdo.read()
    assert [variable.name for variable in node.tpdo[1]] == ["status", "actual.actual 1"]
    master = network.send_periodic(0x701, b"\x05", 0.05)
    node.nmt.state = "OPERATIONAL"
    node.rpdo[1]["control"].raw = 7
    node.rpdo[1]["set-point.set-point 1"].raw = 3277
    node.rpdo[1].transmit()
    _wait(lambda: signals.get("vent") is False and signals.get("pressure_set_bar") > 9.9)
    assert node.nmt.wait_for_heartbeat(2) == "OPERATIONAL"
    _wait(lambda: node.tpdo[1].wait_for_reception(1) and node.tpdo[1]["status"].raw & 0xF == 0xF)

    master.stop()
    emergency = node.emcy.wait(timeout=3)
    assert emergency is not None and emergency.code == 0x8130
    assert signals.get("vent") is True


def test_the_library_remaps_a_pdo_and_reads_segments(rig):
    bench, network, _ = rig
    node = network.add_node(canopen.RemoteNode(AMPLIFIER, _dictionary(*AMPLIFIER_DICTIONARY)))
    _boot(bench, network, AMPLIFIER)
    node.tpdo.read()
    pdo = node.tpdo[1]
    pdo.clear()
    pdo.add_variable("state", 1)
    pdo.add_variable("value", 1)
    pdo.event_timer = 5
    pdo.enabled = True
    pdo.save()
    node.nmt.state = "OPERATIONAL"
    assert pdo.wait_for_reception(2) is not None
    _wait(lambda: pdo.wait_for_reception(1) and pdo["value.value 1"].raw == 1234)
    assert pdo["state.state 1"].raw == 0


def test_faults_from_another_thread_while_it_runs(rig):
    bench, network, _ = rig
    node = network.add_node(canopen.RemoteNode(AMPLIFIER, _dictionary(*AMPLIFIER_DICTIONARY)))
    _boot(bench, network, AMPLIFIER)
    bench.add_fault(FaultRule(kind="mute", node=AMPLIFIER))
    node.sdo.RESPONSE_TIMEOUT = 0.1
    with pytest.raises(canopen.SdoCommunicationError):
        node.sdo["device type"].raw  # noqa: B018
    bench.clear_faults()
    assert node.sdo["device type"].raw == 0x20194
    assert bench.command({"do": "status"})["nodes"]["amplifier"]["state"] == "PRE_OPERATIONAL"
    with pytest.raises(ValueError, match="nonsense"):
        bench.call(lambda: int("nonsense"))


def test_a_bus_that_fails_ends_the_thread_with_words_and_outputs_safe():
    class Gone(Exception):
        pass

    class Bus:
        def recv(self, timeout=None):
            raise can.CanOperationError("cable pulled")

        def send(self, message):
            raise can.CanOperationError("cable pulled")

    signals = RigSignals()
    bench = BenchCan(Bus(), signals)  # pyright: ignore[reportArgumentType]
    bench.start()
    _wait(lambda: not bench._thread.is_alive())
    with pytest.raises(Exception, match=r"bench: can: the emulated nodes have stopped.*cable pulled"):
        bench.check()
    assert signals.get("vent") is True and signals.get("relay_closed") is False
    bench.stop()


_SERVER = """
import sys, can
from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.signals import RigSignals
bus = can.Bus(interface="udp_multicast", channel="239.74.163.2", port=int(sys.argv[1]), hop_limit=0, fd=False)
bench = BenchCan(bus, RigSignals({"torque_nm": 100.0}))
bench.start()
print("ready", bench.deaf_to_itself, flush=True)
sys.stdin.readline()
bench.check()
bench.stop()
print(bench.statistics.received, bench.statistics.receive_errors, bench.statistics.send_errors, flush=True)
bus.shutdown()
"""


def _multicast(port: int) -> can.BusABC:
    try:
        return can.Bus(interface="udp_multicast", channel="239.74.163.2", port=port, hop_limit=0, fd=False)
    except can.CanError as error:
        pytest.skip(f"no multicast on this machine: {error}")


def test_two_processes_over_multicast():
    """1 kHz PDOs without loss, SDO both ways; the bench does not hear itself."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        port = probe.getsockname()[1]
    with _multicast(port) as bus:
        server = subprocess.Popen(
            [sys.executable, "-c", _SERVER, str(port)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert server.stdin and server.stdout
        frames: list[can.Message] = []
        stop = threading.Event()

        def listen() -> None:
            while not stop.is_set():
                message = bus.recv(0.05)
                if message is not None:
                    frames.append(message)

        listener = threading.Thread(target=listen)
        listener.start()
        try:
            ready, deaf = server.stdout.readline().split()
            assert ready == "ready"
            try:
                _wait(lambda: any(m.arbitration_id == 0x720 for m in tuple(frames)))
            except AssertionError:
                pytest.skip("multicast frames do not arrive on this machine")
            bus.send(
                can.Message(
                    arbitration_id=0x620, data=bytes.fromhex("4000100000000000"), is_extended_id=False
                )
            )
            _wait(lambda: any(m.arbitration_id == 0x5A0 for m in tuple(frames)))
            bus.send(can.Message(arbitration_id=0x000, data=b"\x01\x00", is_extended_id=False))
            _wait(lambda: sum(m.arbitration_id == 0x1A0 for m in tuple(frames)) > 1000, 20)
        finally:
            stop.set()
            listener.join()
            out, _ = server.communicate("stop\n", timeout=10)
        heard, receive_errors, send_errors = (int(word) for word in out.split())
    assert receive_errors == send_errors == 0
    if deaf == "True":
        assert heard == 2  # the request and the start, nothing of its own
    (answer,) = [bytes(m.data) for m in frames if m.arbitration_id == 0x5A0]
    assert answer == bytes.fromhex("43001000 94010200")
    fast = [m for m in frames if m.arbitration_id == 0x1A0]
    assert {bytes(m.data) for m in fast} == {struct.pack("<ii", 10000, 0)}
    span_ms = (fast[-1].timestamp - fast[0].timestamp) * 1e3
    assert len(fast) == pytest.approx(span_ms + 1, abs=250), "lost, beyond what a loaded machine may be late"


def test_settings_refuse_nonsense():
    for wrong in ({"regulator": {"node": 0}}, {"encoder": {"node": 16}}, {"valve": {}}, {"delay_ms": -1}):
        with pytest.raises(ValueError):
            BenchCanSettings.model_validate(wrong)
    settings = BenchCanSettings.model_validate({"encoder": {"present": False}})
    bus = can.Bus(uuid.uuid4().hex, interface="virtual")
    assert "encoder" not in BenchCan(bus, RigSignals(), settings).nodes
    bus.shutdown()
