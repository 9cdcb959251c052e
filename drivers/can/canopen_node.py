"""One remote CANopen node: parameters, network state, life signs, emergencies.

Job: SDO reads and writes with named errors, NMT commands that wait for their effect, identity check,
supervision of the node's heartbeat, collection of EMCYs. What goes wrong while the node is watched is
latched: it goes to the status board and is raised from every later `check`. Not its job: PDOs
(`drivers.can.pdo`), what the device does (`drivers.pressure`, …).
"""

from __future__ import annotations

import struct
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from drivers.can.canopen_network import FIRST_HEARTBEATS, CanopenNetwork
from drivers.can.objects import ObjectRef
from rigctl.core.errors import DeviceError

if TYPE_CHECKING:
    import canopen

Unsigned32 = Annotated[int, Field(ge=0, le=0xFFFF_FFFF)]
DEVICE_TYPE = ObjectRef(0x1000, 0, "u32")
DEVICE_NAME = ObjectRef(0x1008, 0, "u32")  # a string: read by `read_text`
_IDENTITY = {
    "vendor_id": ObjectRef(0x1018, 1, "u32"),
    "product_code": ObjectRef(0x1018, 2, "u32"),
    "revision": ObjectRef(0x1018, 3, "u32"),
    "serial": ObjectRef(0x1018, 4, "u32"),
}
NMT_STATES = {0: "booting", 4: "STOPPED", 5: "OPERATIONAL", 127: "PRE-OPERATIONAL"}
_START, _PRE_OPERATIONAL, _RESET_NODE = 0x01, 0x80, 0x81
_WAITED_FOR = {_START: 5, _PRE_OPERATIONAL: 127}
_EMCY = struct.Struct("<HB5s")
_SDO_TIMEOUT_S = 0.2
_SDO_ATTEMPTS = 3
_LATE_LOOKS = 3
_LOOK_S = 0.02
EMCY_CLASSES = (
    (0x8130, 0xFFFF, "our heartbeat was lost"), (0x8210, 0xFFFF, "PDO too short"),
    (0x1000, 0xF000, "generic error"), (0x2000, 0xF000, "current"), (0x3000, 0xF000, "supply"),
    (0x4000, 0xF000, "temperature"), (0x5000, 0xF000, "hardware"), (0x6000, 0xF000, "software"),
    (0x7000, 0xF000, "additional modules"), (0x8000, 0xF000, "communication"),
    (0x9000, 0xF000, "external error"), (0xF000, 0xF000, "device specific"),
)  # fmt: skip
"""Error codes of CiA 301: code, mask, meaning."""


class Identity(BaseModel):
    """Who a node must be; what is not given is not compared."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    device_type: Unsigned32 | None = None
    name: str | None = None
    vendor_id: Unsigned32 | None = None
    product_code: Unsigned32 | None = None
    revision: Unsigned32 | None = None
    serial: Unsigned32 | None = None


class CanopenNode:
    """A node on a shared network.

    Parameters
    ----------
    network : CanopenNetwork
    node_id : int
    device : str
        Role in the rig file, for messages and the board: "pressure".
    heartbeat_limit_s : float
        A watched node that was silent for longer has failed.
    eds : Path or None
        The maker's electronic data sheet; objects that it does not list are refused.
    emcy_names : mapping of int to str
        The device's own error codes.
    tolerated_emcy : collection of int
        Codes that are put on the board only.
    """

    def __init__(
        self,
        network: CanopenNetwork,
        node_id: int,
        device: str,
        *,
        heartbeat_limit_s: float = 0.35,
        eds: Path | None = None,
        emcy_names: Mapping[int, str] | None = None,
        tolerated_emcy: tuple[int, ...] = (),
    ) -> None:
        self.network = network
        self.node_id = node_id
        self.device = device
        self.emergencies: dict[int, str] = {}
        """EMCY codes in force and their text."""
        self._limit_s = heartbeat_limit_s
        self._eds = eds
        self._emcy_names = dict(emcy_names or {})
        self._tolerated = frozenset(tolerated_emcy)
        self._node: canopen.RemoteNode | None = None
        self._sdo_lock = threading.Lock()
        self._news = threading.Condition()
        self._state: int | None = None
        self._boots = 0
        self._heartbeat_s = float("-inf")
        self._late = 0
        self._met_at = 0
        self._watched = False
        self._failure: DeviceError | None = None
        self._on_failure: Callable[[], None] | None = None
        self._ends: list[Callable[[], None]] = []

    @property
    def place(self) -> str:
        """How messages name it."""
        return f"{self.device} (node {self.node_id:02X}h on bus {self.network.name!r})"

    @property
    def failure(self) -> DeviceError | None:
        """The first thing that went wrong, or None."""
        return self._failure or self.network.session.failure

    # -- connection -------------------------------------------------------------------------------

    def open(self, on_failure: Callable[[], None] | None = None) -> None:
        """Open the bus and find the node there.

        Parameters
        ----------
        on_failure : callable
            Called once, from any thread, when the watched node fails.

        Raises
        ------
        DeviceError
            The bus does not open, or nobody answers at the node id.
        """
        self._failure, self._watched, self._late = None, False, 0
        self.emergencies = {}
        self._on_failure = on_failure
        self.network.open()
        try:
            library = self.network.library()
            if self.node_id in library:
                raise DeviceError(
                    "this node id is used by two devices of the rig file.", place=self.place,
                    value=self.node_id, remedy="Correct `node` of one of them.",
                )  # fmt: skip
            self._node = library.add_node(self.node_id, self._dictionary())
            self._node.sdo.RESPONSE_TIMEOUT = _SDO_TIMEOUT_S
            setattr(self._node.sdo, "MAX_RETRIES", _SDO_ATTEMPTS)  # noqa: B010 - the library types it as 1
            session = self.network.session
            self._ends = [
                session.subscribe(0x700 + self.node_id, self._on_heartbeat),
                session.subscribe(0x80 + self.node_id, self._on_emcy),
            ]
            self.read(DEVICE_TYPE)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Leave the node as it is and give up the bus. Never raises."""
        self._watched = False
        while self._ends:
            self._ends.pop()()
        if self._node is not None:
            self._node = None
            del self.network.library()[self.node_id]
        self.network.board.fault(self.device, "")
        self.network.close()

    def _dictionary(self) -> Any:
        import canopen

        if self._eds is None:
            return canopen.ObjectDictionary()
        try:
            return canopen.import_od(str(self._eds), self.node_id)
        except (OSError, ValueError, KeyError) as error:
            raise DeviceError(
                f"its data sheet {self._eds} cannot be read: {error}.", place=self.place,
                remedy="Correct `eds`.",
            ) from error  # fmt: skip

    # -- parameters -------------------------------------------------------------------------------

    def read(self, entry: ObjectRef) -> Any:
        """Value of an object by SDO.

        Raises
        ------
        DeviceError
            No answer, refused by the node, or of another length than `entry.kind`.
        """
        data = self._upload(entry)
        try:
            return entry.unpack(data)
        except ValueError as error:
            raise DeviceError(
                f"{error}.", place=self.place, value=data.hex(" "),
                remedy="Correct the object's type in the rig file, or look for a second SDO client.",
            ) from error  # fmt: skip

    def read_text(self, entry: ObjectRef) -> str:
        """Value of a string object."""
        return self._upload(entry).rstrip(b"\0").decode("ascii", "replace")

    def write(self, entry: ObjectRef, value: float) -> None:
        """Set an object by SDO.

        Raises
        ------
        DeviceError
            No answer, or refused by the node.
        """
        data = entry.pack(value)
        self._transfer(
            f"write {value} to", entry, lambda node: node.sdo.download(entry.index, entry.sub, data)
        )

    def write_checked(self, entry: ObjectRef, value: float) -> None:
        """Set an object and read it back.

        Raises
        ------
        DeviceError
            The node did not keep the value.
        """
        self.write(entry, value)
        kept = self.read(entry)
        if kept != value:
            raise DeviceError(
                f"{entry} is {kept} after {value} was written.", place=self.place, value=kept,
                remedy="The device does not take this value: set it with the maker's tool.",
            )  # fmt: skip

    def _upload(self, entry: ObjectRef) -> bytes:
        return bytes(self._transfer("read", entry, lambda node: node.sdo.upload(entry.index, entry.sub)))

    def _transfer(self, what: str, entry: ObjectRef, transfer: Callable[[canopen.RemoteNode], Any]) -> Any:
        import canopen

        node = self._node
        if node is None:
            raise DeviceError("is not open.", place=self.place, remedy="Open the device first.")
        self.network.session.check()
        if self._eds is not None and node.object_dictionary.get_variable(entry.index, entry.sub) is None:
            raise DeviceError(
                f"its data sheet has no object {entry}.", place=self.place, remedy="Correct it."
            )
        try:
            with self._sdo_lock, self.network.session.hurried():
                return transfer(node)
        except canopen.SdoAbortedError as error:
            raise DeviceError(
                f"refuses to {what} {entry}: {error}.", place=self.place, value=f"{error.code:08X}h",
                remedy="Compare the object's index with the device's manual.",
            ) from error  # fmt: skip
        except canopen.SdoCommunicationError as error:
            raise DeviceError(
                f"does not answer ({what} {entry}): {error}.", place=self.place,
                remedy="Check power, cable, bit rate and `node` in the rig file.",
            ) from error  # fmt: skip
        except (struct.error, IndexError, ValueError) as error:
            raise DeviceError(
                f"gives a garbled answer ({what} {entry}): {error}.", place=self.place,
                remedy="Look at the wire log for a second device with this node id.",
            ) from error  # fmt: skip

    # -- identity ---------------------------------------------------------------------------------

    def check_identity(self, profile: int, expected: Identity) -> dict[str, str]:
        """Compare what the node says of itself with what the rig file says.

        Parameters
        ----------
        profile : int
            Number of the device profile (408, …) in 1000h; 0: any.
        expected : Identity

        Returns
        -------
        dict
            What it says, for the record.

        Raises
        ------
        DeviceError
            It is another device.
        """
        device_type = self.read(DEVICE_TYPE)
        found: dict[str, Any] = {"device_type": device_type}
        for key, entry in _IDENTITY.items():
            found[key] = self._optional(lambda entry=entry: self.read(entry))
        found["name"] = self._optional(lambda: self.read_text(DEVICE_NAME))
        if profile and device_type & 0xFFFF != profile:
            raise DeviceError(
                f"is a device of CiA {device_type & 0xFFFF} (1000h = {device_type:08X}h), not of "
                f"CiA {profile}.",
                place=self.place, value=device_type, remedy="Correct `node` in the rig file, or the wiring.",
            )  # fmt: skip
        for key, wanted in expected.model_dump(exclude_none=True).items():
            if found[key] != wanted:
                raise DeviceError(
                    f"is another device: {key} is {_shown(found[key])}, the rig file says {_shown(wanted)}.",
                    place=self.place, value=found[key],
                    remedy="Connect the right device, or correct the table `identity`.",
                )  # fmt: skip
        return {key: _shown(value) for key, value in found.items() if value is not None}

    def _optional(self, read: Callable[[], Any]) -> Any:
        """None for an object that the node does not have; it must still answer."""
        try:
            return read()
        except DeviceError as error:
            if isinstance(error.value, str) and error.value.startswith("060"):  # no such object, sub-index …
                return None
            raise

    # -- network state ----------------------------------------------------------------------------

    @property
    def operational(self) -> bool:
        """Whether its newest heartbeat said so."""
        return self._state == _WAITED_FOR[_START]

    def reset(self, timeout_s: float = 5.0) -> None:
        """NMT reset node, and wait for the boot-up message: everything as after power-on."""
        boots = self._boots
        self._command(_RESET_NODE)
        self._wait(lambda: self._boots > boots, timeout_s, "send its boot-up message after NMT reset")
        self.emergencies = {}

    def pre_operational(self, timeout_s: float = 1.0) -> None:
        """NMT enter pre-operational, and wait until a heartbeat says so."""
        self._command_and_wait(_PRE_OPERATIONAL, timeout_s)

    def start(self, timeout_s: float = 1.0) -> None:
        """NMT start, and wait until a heartbeat says so.

        Raises
        ------
        DeviceError
            It did not become operational in time.
        """
        self._command_and_wait(_START, timeout_s)

    def send_pre_operational(self) -> None:
        """NMT enter pre-operational without waiting: PDOs of both directions end."""
        self._command(_PRE_OPERATIONAL)

    def _command(self, command: int) -> None:
        self.network.session.send(0x000, bytes((command, self.node_id)))

    def _command_and_wait(self, command: int, timeout_s: float) -> None:
        wanted = _WAITED_FOR[command]
        self._state = None
        self._command(command)
        self._wait(lambda: self._state == wanted, timeout_s, f"become {NMT_STATES[wanted]}")

    def _wait(self, condition: Callable[[], bool], timeout_s: float, what: str) -> None:
        with self._news:
            if not self._news.wait_for(condition, timeout_s):
                raise DeviceError(
                    f"does not {what} within {timeout_s:g} s.", place=self.place,
                    remedy="Check that its heartbeat (1017h) is on, and power and cable.",
                )  # fmt: skip

    # -- life signs ---------------------------------------------------------------------------------

    def watch(self) -> None:
        """From now on the node must stay operational, send heartbeats, and not reboot."""
        self._heartbeat_s = max(self._heartbeat_s, time.monotonic())
        self._late = 0
        self._met_at = self.network.greet()
        self._watched = True
        self._ends.append(self.network.cycle.add(self._look, _LOOK_S, self.ended))

    @property
    def knows_us(self) -> bool:
        """Whether so many of our heartbeats have gone out that it watches us: set-points come after that."""
        return self._watched and self.network.heartbeats_since(self._met_at) >= FIRST_HEARTBEATS

    def ended(self, error: Exception) -> None:
        """A periodic task of this node has ended by an error: that is a failure of the node."""
        self.fail(
            error.problem.rstrip(".") if isinstance(error, DeviceError) else f"its driver failed: {error!r}"
        )

    def unwatch(self) -> None:
        """What the node does from now on is no failure: it is being shut down."""
        self._watched = False

    def check(self) -> None:
        """Raise what went wrong with the node or its bus.

        Raises
        ------
        DeviceError
        """
        self.network.session.check()
        if self._failure is not None:
            raise DeviceError(
                self._failure.problem, place=self._failure.place, remedy=self._failure.remedy
            ) from self._failure

    def fail(self, problem: str, remedy: str = "Remove the cause, then open the rig anew.") -> None:
        """Latch a failure of the node: the first one counts."""
        with self._news:
            if self._failure is not None:
                return
            self._failure = DeviceError(f"{problem}.", place=self.place, remedy=remedy)
        self.network.board.fault(self.device, problem)
        if self._on_failure is not None:
            self._on_failure()

    def _look(self) -> None:
        if not self._watched or self._failure is not None:
            return
        session = self.network.session
        if session.failure is not None:
            self.fail(f"the bus has failed: {session.failure.problem.rstrip('.')}")
            return
        age_s = time.monotonic() - self._heartbeat_s
        # Looked at several times: frames may still wait in the reading thread's queue.
        self._late = self._late + 1 if age_s > self._limit_s else 0
        if self._late >= _LATE_LOOKS:
            others = "the whole bus is silent" if session.silent_s() > self._limit_s else "others still talk"
            self.fail(f"has sent no heartbeat for {age_s:.2f} s; {others}", "Check its power and cable.")

    def _on_heartbeat(self, data: bytes, timestamp_s: float) -> None:
        if len(data) != 1:
            self.network.session.statistics.malformed += 1
            return
        state = data[0] & 0x7F
        with self._news:
            self._state = state
            self._heartbeat_s = timestamp_s
            if data[0] == 0:
                self._boots += 1
            self._news.notify_all()
        if not self._watched:
            return
        if data[0] == 0:
            self.fail(
                "has rebooted by itself: its settings and state are lost", "Check its supply, then open anew."
            )
        elif state != _WAITED_FOR[_START]:
            self.fail(f"has left the state OPERATIONAL: it is {NMT_STATES.get(state, state)}")

    def _on_emcy(self, data: bytes, timestamp_s: float) -> None:
        if len(data) != _EMCY.size:
            self.network.session.statistics.malformed += 1
            return
        code, register, manufacturer = _EMCY.unpack(data)
        board = self.network.board
        if code & 0xFF00 == 0:
            self.emergencies = {}
            if self._failure is None:
                board.fault(self.device, "")
            return
        text = (
            f"EMCY {code:04X}h ({self.emcy_name(code)}), register {register:02X}h, "
            f"data {manufacturer.hex(' ')}"
        )
        self.emergencies = {**self.emergencies, code: text}
        if self._watched and code not in self._tolerated:
            self.fail(f"reports {text}")
        elif self._failure is None:
            board.fault(self.device, f"reports {text}")

    def emcy_name(self, code: int) -> str:
        """Meaning of an error code."""
        if code in self._emcy_names:
            return self._emcy_names[code]
        return next((name for value, mask, name in EMCY_CLASSES if code & mask == value), "unknown")


def _shown(value: Any) -> str:
    return f"0x{value:08X}" if isinstance(value, int) else str(value)
