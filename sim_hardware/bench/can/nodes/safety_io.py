"""Safety I/O: the relay that must be renewed, emergency stop, doors and read-backs.

Job: the relay's rule (rising counters within the time, closing by command 2 only), inputs, read-back. Not its
job: what the open relay does to drive and pressure (the plant), and deciding when to renew (the watchdog).
"""

from __future__ import annotations

from sim_hardware.bench.can.datatypes import DataType
from sim_hardware.bench.can.dictionary import Access
from sim_hardware.bench.can.node import Device, NmtState
from sim_hardware.bench.can.scheduler import NS_PER_MS, Timer
from sim_hardware.bench.can.settings import SafetyIoSettings
from sim_hardware.bench.signals import RigSignals

OPEN, RENEW, CLOSE = 0, 1, 2
RELAY, ESTOP_OK, DOORS_OK, DRIVE_ENABLED = 1, 2, 4, 8
_HALF = 128
_WATCH_MS = 2


def rises(counter: int, last: int | None) -> bool:
    """Whether a counter is 1..127 steps beyond the last accepted one (modulo 256)."""
    return last is None or 0 < (counter - last) % 256 < _HALF


class SafetyIo(Device):
    """See the manual, node 30h.

    Attributes
    ----------
    welded : bool
        The relay's contact stays closed whatever the coil does (a fault, set by `disturb`).
    """

    device_type = 0x0003_0191
    name = "Bench safety I/O"

    def __init__(self, settings: SafetyIoSettings, signals: RigSignals) -> None:
        self._settings, self._signals = settings, signals
        self.welded = False
        self._coil = False
        self._contact = False
        self._last_counter: int | None = None
        self._renewed_ns = 0
        self._contact_timer: Timer | None = None
        self._watch: Timer | None = None
        self._told = -1

    @property
    def closed(self) -> bool:
        """The relay's contact is closed."""
        return self._contact

    def define(self) -> None:
        add, u8, u16 = self.node.add, DataType.UNSIGNED8, DataType.UNSIGNED16
        self.node.dictionary.add_count(0x6000, 1)
        self._bits = add(0x6000, 1, "inputs and read-backs", u8, Access.RO, mappable=True)
        self.node.dictionary.add_count(0x2200, 3)
        self._command = add(0x2200, 1, "command", u8, Access.RWW, high=CLOSE, mappable=True)
        self._counter = add(0x2200, 2, "counter", u8, Access.RWW, mappable=True)
        add(0x2200, 3, "nonce", u16, Access.RWW, mappable=True)
        self._echo = add(0x2201, 0, "echo of the counter", u8, Access.RO, mappable=True)
        add(0x2202, 0, "relay timeout, ms", u16, Access.CONST, self._settings.relay_timeout_ms)
        self.node.add_rpdo(((0x2200, 1, 8), (0x2200, 2, 8), (0x2200, 3, 16)))
        self._tpdo = self.node.add_tpdo(((0x6000, 1, 8), (0x2201, 0, 8)), self._settings.tpdo_ms)

    # -- calls of the node --------------------------------------------------------------------------

    def power_on(self) -> None:
        self._last_counter = None
        self._open()
        if self._watch is not None:
            self._watch.cancel()
        self._watch = self.node.scheduler.every(_WATCH_MS * NS_PER_MS, self._look)

    def power_off(self) -> None:
        if self._watch is not None:
            self._watch.cancel()
        self._open()

    def nmt_changed(self, state: NmtState) -> None:
        if state is not NmtState.OPERATIONAL:
            self._open()

    def heartbeat_lost(self, node: int) -> None:
        self._open()

    def rpdo(self, number: int) -> None:
        command, counter = self._command.number(), self._counter.number()
        if command == OPEN:
            self._last_counter = counter
            self._open()
        elif rises(counter, self._last_counter):
            self._last_counter = counter
            self._renewed_ns = self.node.scheduler.now_ns
            if command == CLOSE and not self.node.watched_silent:
                self._close()
        self._echo.value = self._last_counter or 0
        self._look(self.node.scheduler.now_ns)

    def refresh(self, due_ns: int) -> None:
        self._bits.value = self._read()

    # -- for tests and the command line -------------------------------------------------------------

    def disturb(self, *, welded: bool) -> None:
        """Weld the contact (it stays as it is when closed), or free it."""
        self.welded = welded
        if not welded and not self._coil:
            self._set_contact(False)

    # -- relay --------------------------------------------------------------------------------------

    def _close(self) -> None:
        commands = self._signals.commands()
        if self._coil or not (commands.estop_ok and commands.doors_ok):
            return
        self._coil = True
        delay_ns = self._settings.relay_delay_ms * NS_PER_MS
        self._contact_timer = self.node.scheduler.after(delay_ns, lambda _due: self._set_contact(True))

    def _open(self) -> None:
        self._coil = False
        if self._contact_timer is not None:
            self._contact_timer.cancel()
        if not self.welded:
            self._set_contact(False)

    def _set_contact(self, closed: bool) -> None:
        self._contact = closed
        self._signals.set(relay_closed=closed)

    def _look(self, now_ns: int) -> None:
        """Every 2 ms: the time since the last rising counter, the chain, and news to tell."""
        commands = self._signals.commands()
        if self._coil:
            late = now_ns - self._renewed_ns > self._settings.relay_timeout_ms * NS_PER_MS
            if late or not commands.estop_ok or not commands.doors_ok:
                self._open()
        bits = self._read()
        if bits != self._told:
            self._told = bits
            self._tpdo.event()

    def _read(self) -> int:
        commands = self._signals.commands()
        bits = RELAY if self._contact else 0
        bits |= ESTOP_OK if commands.estop_ok else 0
        bits |= DOORS_OK if commands.doors_ok else 0
        return bits | (DRIVE_ENABLED if commands.drive_enabled and self._contact else 0)
