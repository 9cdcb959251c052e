"""`CanopenNode` and `CanopenNetwork` on emulated nodes: parameters, data sheet, heartbeats, emergencies."""

from __future__ import annotations

import itertools
import os
import time

import can
import pytest

from drivers.can.canopen_network import canopen_network
from drivers.can.canopen_node import CanopenNode, Identity
from drivers.can.objects import ObjectRef
from drivers.can.pdo import PdoSetup, ensure_pdo
from rigctl.core.errors import DeviceError
from rigctl.hal.devices import RigContext
from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.signals import RigSignals

HOLD_SET_POINT = ObjectRef(0x6314, 1, "i16")
LOWER_THRESHOLD = ObjectRef(0x6373, 1, "i16")
WINDOW_DELAY = ObjectRef(0x6371, 1, "u16")
ACTUAL = ObjectRef(0x6301, 1, "i16")
STATUS = ObjectRef(0x6041, 0, "u16")
EDS = """[FileInfo]
FileName=regulator.eds
FileVersion=1
FileRevision=0
EDSVersion=4.0
[DeviceInfo]
VendorName=x
ProductName=y
[MandatoryObjects]
SupportedObjects=1
1=0x1000
[OptionalObjects]
SupportedObjects=1
1=0x6041
[ManufacturerObjects]
SupportedObjects=0
[1000]
ParameterName=Device type
ObjectType=0x7
DataType=0x0007
AccessType=ro
PDOMapping=0
[6041]
ParameterName=Status word
ObjectType=0x7
DataType=0x0006
AccessType=ro
PDOMapping=1
"""
_numbers = itertools.count()


class Wire:
    def __init__(self, folder) -> None:
        self.channel = f"node-{os.getpid()}-{next(_numbers)}"
        self.bus = can.Bus(interface="virtual", channel=self.channel, ignore_config=True)
        self.listener = can.Bus(interface="virtual", channel=self.channel, ignore_config=True)
        self.bench = BenchCan(self.bus, RigSignals())
        self.bench.start()
        self.bench.wait_booted()
        buses = {"main": {"interface": "virtual", "channel": self.channel}}
        self.context = RigContext(folder, "real", None, "rig.toml", folder, buses=buses)
        self.network = canopen_network(self.context, "main")

    def faults(self) -> dict[str, str]:
        return self.context.board.snapshot().get("faults", {})

    def heard(self, cob_id: int, duration_s: float) -> list[bytes]:
        """Data of what passed within the time."""
        while self.listener.recv(0) is not None:
            pass
        end_s, data = time.monotonic() + duration_s, []
        while (left_s := end_s - time.monotonic()) > 0:
            message = self.listener.recv(left_s)
            if message is not None and message.arbitration_id == cob_id:
                data.append(bytes(message.data))
        return data

    def close(self) -> None:
        self.bench.stop()
        self.bus.shutdown()
        self.listener.shutdown()


@pytest.fixture
def wire(tmp_path):
    made = Wire(tmp_path)
    yield made
    made.close()


@pytest.fixture
def node(wire: Wire):
    made = CanopenNode(wire.network, 0x10, "pressure")
    made.open()
    yield made
    made.close()


def test_parameters_are_written_and_read_back(node: CanopenNode):
    node.write_checked(LOWER_THRESHOLD, -123)
    assert node.read(LOWER_THRESHOLD) == -123


def test_a_refused_value_names_object_and_reason(node: CanopenNode):
    with pytest.raises(DeviceError, match=r"refuses to write 7 to 6371h:1.*0609"):
        node.write(WINDOW_DELAY, 7)
    with pytest.raises(DeviceError, match=r"refuses to write 1 to 6041h:0.*0601"):
        node.write(STATUS, 1)


def test_a_value_that_does_not_fit_is_not_sent(node: CanopenNode):
    with pytest.raises(ValueError, match="does not fit"):
        node.write(HOLD_SET_POINT, 40000)


def test_identity_is_told(node: CanopenNode):
    found = node.check_identity(408, Identity(vendor_id=0x0B1C, product_code=0x10))
    assert found["name"] == "Bench pressure regulator"


def test_pdo_is_compared_set_and_compared_again(node: CanopenNode):
    setup = PdoSetup(True, 1, 0x1F0, (ACTUAL, STATUS), transmission=254, event_ms=20)
    with pytest.raises(DeviceError) as caught:
        ensure_pdo(node, setup, configure=False)
    for word in ("190h instead of 1F0h", "every 10 ms instead of 20 ms", "60410010h, 63010110h", "configure"):
        assert word in str(caught.value)
    assert len(ensure_pdo(node, setup, configure=True)) == 3
    assert ensure_pdo(node, setup, configure=False) == []


def test_configured_pdo_is_what_comes(wire: Wire, node: CanopenNode):
    ensure_pdo(node, PdoSetup(True, 1, 0x1F0, (ACTUAL, STATUS), 254, 20), configure=True)
    node.start()
    frames = wire.heard(0x1F0, 0.5)
    assert 20 <= len(frames) <= 30
    assert PdoSetup(True, 1, 0x1F0, (ACTUAL, STATUS)).codec.unpack(frames[-1]) is not None


def test_our_heartbeat_lives_as_long_as_the_lease(wire: Wire, node: CanopenNode):
    assert wire.heard(0x701, 0.25) == []
    wire.context.lease.renew()
    assert set(wire.heard(0x701, 0.25)) == {b"\x05"}
    time.sleep(0.1)
    assert wire.heard(0x701, 0.3) == []


def test_a_node_id_belongs_to_one_device(wire: Wire, node: CanopenNode):
    with pytest.raises(DeviceError, match="used by two devices"):
        CanopenNode(wire.network, 0x10, "ventilator").open()
    assert node.read(HOLD_SET_POINT) == 0  # the first one is not disturbed


def test_tolerated_emergencies_are_shown_only(wire: Wire):
    node = CanopenNode(wire.network, 0x10, "pressure", tolerated_emcy=(0x3120,))
    node.open()
    try:
        node.start()
        node.watch()
        wire.bench.disturb("regulator", supply_low=True)
        time.sleep(0.1)
        assert "3120h" in wire.faults()["pressure"]
        node.check()
        wire.bench.disturb("regulator", supply_low=False)
        time.sleep(0.1)
        assert "pressure" not in wire.faults()
    finally:
        node.close()


def test_the_first_failure_is_kept_and_its_owner_told_once(wire: Wire):
    calls = []
    node = CanopenNode(wire.network, 0x10, "pressure")
    node.open(lambda: calls.append(1))
    try:
        node.fail("first")
        node.fail("second")
        with pytest.raises(DeviceError, match="first"):
            node.check()
        assert calls == [1] and wire.faults()["pressure"] == "first"
    finally:
        node.close()
    assert "pressure" not in wire.faults()


def test_leaving_operational_is_a_failure(wire: Wire, node: CanopenNode):
    node.start()
    node.watch()
    node.send_pre_operational()
    end_s = time.monotonic() + 1.0
    while node.failure is None and time.monotonic() < end_s:
        time.sleep(0.01)
    with pytest.raises(DeviceError, match="left the state OPERATIONAL: it is PRE-OPERATIONAL"):
        node.check()


def test_data_sheet_limits_the_objects(wire: Wire, tmp_path):
    (tmp_path / "regulator.eds").write_text(EDS)
    node = CanopenNode(wire.network, 0x10, "pressure", eds=tmp_path / "regulator.eds")
    node.open()
    try:
        assert isinstance(node.read(STATUS), int)
        with pytest.raises(DeviceError, match="data sheet has no object 6301h:1"):
            node.read(ACTUAL)
    finally:
        node.close()


def test_missing_data_sheet_is_told(wire: Wire, tmp_path):
    with pytest.raises(DeviceError, match=r"none\.eds"):
        CanopenNode(wire.network, 0x10, "pressure", eds=tmp_path / "none.eds").open()


def test_after_close_nothing_listens_and_it_opens_again(wire: Wire):
    node = CanopenNode(wire.network, 0x10, "pressure")
    for _ in range(2):
        node.open()
        node.start()
        node.close()
        with pytest.raises(DeviceError, match="not open"):
            node.read(STATUS)
