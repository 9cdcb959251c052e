"""Stimuli in force at a simulated rig: what the fault laboratory has done to it, and the door for asking.

Job: `Stimuli` checks requests, holds what is in force, and lets it act on commands and readings of a block;
`Door` is the socket, read when the rig server reads its other links. Without a stimulus nothing of the rig is
changed, bit for bit. Not its job: physics (`sim_hardware.plant`), lockstep (`server`).
"""

from __future__ import annotations

import inspect
import math
import select
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED, TORQUE
from rigctl.core.errors import DeviceError, RigctlError
from rigctl.core.wire import Link, Listener
from sim_hardware.devices.laboratory import SOCKET_NAME

SENSORS = {PRESSURE: "p", SPEED: "n", TORQUE: "M", DISC_TEMPERATURE: "T"}
"""Channels that can be disturbed, with the watchdog's letter for its own sensor of the same quantity."""
MODES = ("ok", "invalid", "frozen", "offset")
VIEWERS = ("both", "controller", "watchdog")
CALIBRATOR_LEVELS_DB = (0.0, 94.0, 114.0)
MAX_WEIGHT_NM = 1200.0
MAX_DRIFT_DB = 6.0
DISC_DEGC = (0.0, 700.0)
STANDSTILL_RPM = 0.5


@dataclass(frozen=True)
class SensorFault:
    """How a sensor is disturbed, and who sees it: the watchdog has sensors of its own."""

    mode: str = "ok"
    value: float = 0.0
    seen_by: str = "both"


class Stimuli:
    """What is done to one simulated rig.

    Parameters
    ----------
    plant : sim_hardware.plant.Plant
    """

    def __init__(self, plant: Any) -> None:
        self._plant = plant
        self.estop_ok = True
        self.doors_ok = True
        self.calibrator_db = 0.0
        self.drift_db = 0.0
        self._sensors: dict[str, SensorFault] = {}
        self._held: dict[str, tuple[float, float]] = {}  # frozen: last reading of controller, of watchdog
        self._vent_stuck = False
        self._held_bar: float | None = None
        self._weight_nm = 0.0
        self._waiting: list[tuple[float, dict[str, Any]]] = []
        self._last: Any = None  # the newest step of the plant
        self._rig_s = 0.0
        self._actions: dict[str, Callable[..., None]] = {
            "estop": self._estop, "doors": self._doors, "sensor": self._sensor, "disc": self._disc,
            "vent_valve": self._vent_valve, "weight": self._weight, "calibrator": self._calibrator,
            "microphone": self._microphone, "clear": self.clear,
        }  # fmt: skip

    # -- what the rig asks, block by block -------------------------------------------------------

    @property
    def chain_ok(self) -> bool:
        """Emergency stop and doors are wired in series with the relay's contact."""
        return self.estop_ok and self.doors_ok

    @property
    def listens(self) -> bool:
        """The microphone is wanted though nothing is recorded: a calibrator sits on it."""
        return self.calibrator_db > 0.0

    @property
    def sound(self) -> list[float] | None:
        """(level of the calibrator, drift of the microphone) in dB, None when there is neither."""
        return [self.calibrator_db, self.drift_db] if self.calibrator_db or self.drift_db else None

    def begin(self, rig_s: float) -> None:
        """A block begins at this rig time: what waited for it comes into force."""
        self._rig_s = rig_s
        if self._waiting and self._waiting[0][0] <= rig_s:
            due = [request for at_s, request in self._waiting if at_s <= rig_s]
            self._waiting = [entry for entry in self._waiting if entry[0] > rig_s]
            for request in due:
                try:
                    self._do(request)
                except DeviceError as error:  # the shaft may turn by now: left undone, and said in the log
                    print(f"rig server: stimulus {request}: {error}", file=sys.stderr, flush=True)

    def commands(self, wanted: Any, *, relay_closed: bool) -> Any:
        """A stuck vent valve: the line keeps the pressure that the regulator had when it lost its power."""
        if not self._vent_stuck:
            return wanted
        if relay_closed:
            self._held_bar = None
            return replace(wanted, vent=False)
        if self._held_bar is None:
            self._held_bar = self._plant.truth.pressure_bar
        return replace(wanted, vent=False, pressure_set_bar=self._held_bar, relay_closed=True)

    def readings(self, result: Any) -> Any:
        """The step of the plant as the disturbed sensors tell it."""
        before, self._last = self._last, result
        if not self._sensors:
            return result
        samples, safety = dict(result.samples), dict(result.safety)
        for channel, fault in self._sensors.items():
            letter = SENSORS[channel]
            if channel not in self._held:
                self._held[channel] = _newest(before or result, channel)
            own, other = self._held[channel]
            if fault.seen_by != "watchdog":
                samples[channel] = _disturbed(samples[channel], fault, own)
            if fault.seen_by != "controller":
                safety[letter] = _disturbed_list(safety[letter], fault, other)
        return replace(result, samples=samples, safety=safety)

    # -- what a person asks ----------------------------------------------------------------------

    def handle(self, request: dict[str, Any]) -> dict[str, Any]:
        """Carry out a request; the answer tells what is in force.

        Raises
        ------
        DeviceError
            It is refused, with reason and remedy.
        """
        fields = dict(request)
        at_s = fields.pop("at_s", None)
        if fields.get("do") != "status":
            if at_s is None:
                self._do(fields)
            else:
                self._known(fields)
                self._waiting.append((_number(at_s, "at_s", 0.0, math.inf), fields))
                self._waiting.sort(key=lambda entry: entry[0])
        return self.status()

    def status(self) -> dict[str, Any]:
        """What is in force, what waits, and the truth behind the sensors."""
        truth = self._plant.truth
        return {
            "rig_s": round(self._rig_s, 6),
            "estop_pressed": not self.estop_ok,
            "doors_open": not self.doors_ok,
            "sensors": {name: dict(fault.__dict__) for name, fault in self._sensors.items()},
            "vent_valve_stuck": self._vent_stuck,
            "weight_nm": self._weight_nm,
            "calibrator_db": self.calibrator_db,
            "drift_db": self.drift_db,
            "waiting": [{**request, "at_s": at_s} for at_s, request in self._waiting],
            "truth": {
                "speed_rpm": truth.speed_rpm, "pressure_bar": truth.pressure_bar,
                "torque_nm": truth.brake_torque_nm + self._weight_nm, "disc_degc": truth.surface_degc,
            },
        }  # fmt: skip

    def clear(self) -> None:
        """Everything is well again; the disc keeps its temperature."""
        self.estop_ok = self.doors_ok = True
        self.calibrator_db = self.drift_db = self._weight_nm = 0.0
        self._plant.set_lever(0.0)
        self._sensors.clear()
        self._held.clear()
        self._vent_stuck, self._held_bar = False, None
        self._waiting.clear()

    def _known(self, request: dict[str, Any]) -> Callable[[], None]:
        """The action of a request with its fields."""
        action = self._actions.get(str(request.get("do")))
        if action is None:
            raise DeviceError(f"there is no stimulus {request.get('do')!r}.",
                              remedy=f"Use one of: {', '.join(self._actions)}, status.")  # fmt: skip
        fields = {key: value for key, value in request.items() if key != "do"}
        wanted = inspect.signature(action)
        try:
            wanted.bind(**fields)
        except TypeError as error:
            names = ", ".join(wanted.parameters) or "no fields"
            raise DeviceError(f"{request['do']}: {error}.", remedy=f"It takes {names}.") from error
        return partial(action, **fields)

    def _do(self, request: dict[str, Any]) -> None:
        self._known(request)()

    def _estop(self, *, pressed: bool) -> None:
        self.estop_ok = not _truth(pressed, "pressed")

    def _doors(self, *, open: bool) -> None:
        self.doors_ok = not _truth(open, "open")

    def _sensor(self, *, channel: str, mode: str, value: float = 0.0, seen_by: str = "both") -> None:
        _one_of(channel, "channel", tuple(SENSORS))
        _one_of(mode, "mode", MODES)
        _one_of(seen_by, "seen_by", VIEWERS)
        self._held.pop(channel, None)
        if mode == "ok":
            self._sensors.pop(channel, None)
        else:
            offset = _number(value, "value", -1e5, 1e5)
            self._sensors[channel] = SensorFault(mode, offset if mode == "offset" else 0.0, seen_by)

    def _disc(self, *, degc: float) -> None:
        self._plant.set_condition(disc_degc=_number(degc, "degc", *DISC_DEGC))

    def _vent_valve(self, *, stuck: bool) -> None:
        self._vent_stuck, self._held_bar = _truth(stuck, "stuck"), None

    def _weight(self, *, torque_nm: float) -> None:
        torque = _number(torque_nm, "torque_nm", -MAX_WEIGHT_NM, MAX_WEIGHT_NM)
        if torque and abs(self._plant.truth.speed_rpm) > STANDSTILL_RPM:
            raise DeviceError(
                "the shaft turns: no lever can be put on.", remedy="Bring the rig to rest first."
            )
        self._weight_nm = torque
        self._plant.set_lever(torque)

    def _calibrator(self, *, level_db: float) -> None:
        level = _number(level_db, "level_db", 0.0, 114.0)
        if level not in CALIBRATOR_LEVELS_DB:
            raise DeviceError(f"no calibrator gives {level:g} dB.", remedy="Use 94, 114, or 0 for none.")
        self.calibrator_db = level

    def _microphone(self, *, drift_db: float) -> None:
        self.drift_db = _number(drift_db, "drift_db", -MAX_DRIFT_DB, MAX_DRIFT_DB)


class Door:
    """The laboratory's socket: any number of clients, read with the rig server's other links.

    Parameters
    ----------
    run_dir : Path
    stimuli : Stimuli
    poll : select.poll
        The rig server's.
    """

    def __init__(self, run_dir: Path, stimuli: Stimuli, poll: select.poll) -> None:
        self._listener = Listener(run_dir / SOCKET_NAME)
        self._stimuli = stimuli
        self._poll = poll
        self._clients: dict[int, Link] = {}
        poll.register(self._listener, select.POLLIN)

    def on_ready(self, fd: int) -> bool:
        """Serve a descriptor that is ready; True when it was one of the laboratory's."""
        if fd == self._listener.fileno():
            link = self._listener.accept(0)
            if link is not None:
                self._clients[link.fileno()] = link
                self._poll.register(link, select.POLLIN)
            return True
        link = self._clients.get(fd)
        if link is None:
            return False
        try:
            request = link.recv(0)
            if request is not None:
                link.send(self._answer(request), timeout_s=0.0)
        except DeviceError:  # it has gone, does not read, or does not speak our language
            self._drop(link)
        return True

    def _answer(self, request: dict[str, Any]) -> dict[str, Any]:
        try:
            return {"m": "done", **self._stimuli.handle(request)}
        except RigctlError as error:
            return {"m": "refused", "reason": error.problem, "remedy": error.remedy}

    def _drop(self, link: Link) -> None:
        self._poll.unregister(link)
        self._clients.pop(link.fileno(), None)
        link.close()

    def close(self) -> None:
        """Leave all clients, remove the socket."""
        for link in list(self._clients.values()):
            self._drop(link)
        self._poll.unregister(self._listener)
        self._listener.close()


def _newest(result: Any, channel: str) -> tuple[float, float]:
    samples, safety = result.samples[channel], result.safety[SENSORS[channel]]
    return float(samples[-1]), float(safety[-1])


def _disturbed(samples: Any, fault: SensorFault, held: float) -> Any:
    if fault.mode == "offset":
        return samples + np.float32(fault.value)
    return np.full_like(samples, np.nan if fault.mode == "invalid" else held)


def _disturbed_list(readings: list[float], fault: SensorFault, held: float) -> list[float | None]:
    if fault.mode == "offset":
        return [value + fault.value for value in readings]
    return [None if fault.mode == "invalid" else held] * len(readings)


def _truth(value: Any, name: str) -> bool:
    if not isinstance(value, bool):
        raise DeviceError(f"{name} is {value!r}.", remedy="Give true or false.")
    return value


def _one_of(value: Any, name: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise DeviceError(f"{name} is {value!r}.", remedy=f"Use one of: {', '.join(known)}.")


def _number(value: Any, name: str, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        span = f"from {low:g} to {high:g}" if math.isfinite(high) else f"from {low:g} on"
        raise DeviceError(f"{name} is {value!r}.", remedy=f"Give a number {span}.")
    return float(value)
