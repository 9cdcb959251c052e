"""The bench as one process: plant, CAN nodes, serial devices and microphone behind real wires.

Job: `Bench` starts everything in order and stops it again whatever happens, holds the folder (one bench in
each), says when it is ready, and hands commands on to who obeys them. Not its job: any of the parts.

The parts are threads. They share no more than `RigSignals`; each keeps its own time.
"""

from __future__ import annotations

import argparse
import contextlib
import fcntl
import gc
import json
import os
import secrets
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import can

from rigctl.config.loading import load_model, translated
from rigctl.core.errors import ConfigError, DeviceError, RigctlError
from rigctl.hal.bench_paths import READY_NAME, bench_folder
from rigctl.hal.priority import BENCH, raise_priority
from sim_hardware.bench import pulse
from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.commands import CommandServer
from sim_hardware.bench.serial.bench import make_ports
from sim_hardware.bench.serial.ports import SerialPort
from sim_hardware.bench.settings import BenchSettings, load_bench
from sim_hardware.bench.signals import OUTPUTS, RigSignals

if TYPE_CHECKING:  # the physics load slowly: first the folder and the bus must be ours
    from sim_hardware.bench.microphone import Microphone
    from sim_hardware.bench.plant_loop import PlantLoop
    from sim_hardware.plant import Plant
    from sim_hardware.plant.sound import Sound

LOCK_NAME = "bench.lock"
#: nodes send heartbeats every 100 ms; a bus where ours are heard already belongs to another bench
LISTEN_S = 0.25
CHECK_S = 0.25
_HEARTBEAT = 0x700


class Bench:
    """A rig behind wires. `start`, then `check` now and then, then `stop`; or use it as a context manager.

    Parameters
    ----------
    settings : BenchSettings
    folder : Path or None
        Where ports and sockets are; None: of the bench file, else of `rigctl.hal.bench_paths`.
    seed : int or None
        Of noise and scatter, in place of the bench file's.

    Attributes
    ----------
    signals : RigSignals
        Between plant and devices.
    notes : list of str
        What is not as the bench file says, for people.
    priority : str
        What the kernel has given: "real-time", "raised" or "normal".
    """

    def __init__(self, settings: BenchSettings, folder: Path | None = None, seed: int | None = None) -> None:
        self.settings = settings
        self.folder = folder or settings.folder or bench_folder()
        chosen = seed if seed is not None else settings.seed
        self.seed = secrets.randbelow(2**31) if chosen is None else chosen
        self.signals = RigSignals()
        self.notes: list[str] = []
        self.priority = "normal"
        self._pulse_pids: list[int] = []
        self._parts = ExitStack()
        self._loop: PlantLoop | None = None
        self._can: BenchCan | None = None
        self._ports: dict[str, SerialPort] = {}
        self._microphone: Microphone | None = None
        self._sound_environment: dict[str, str] = {}
        self._failure: BaseException | None = None
        self._started_s = 0.0
        self._load = _Load()

    def __enter__(self) -> Bench:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    # -- life -----------------------------------------------------------------------------------

    def start(self) -> None:
        """Bring everything up; call it from the main thread. Nothing is left when it fails.

        Raises
        ------
        ConfigError
            Plant or brake file is wrong.
        DeviceError
            The folder belongs to another bench, or a wire cannot be had.
        """
        try:
            self._parts.enter_context(_held(self.folder))
            bus = self._open_bus()
            pipe = self._start_pulse()
            plant, sound = self._make_plant()
            gc.collect()
            gc.freeze()  # what lives now lives until the end: collections stay short
            if self.settings.realtime:  # before the threads start: they inherit it
                self.priority = raise_priority([os.getpid(), *self._pulse_pids], BENCH)
            while bus.recv(0) is not None:  # devices do not hear what was said before they had power
                pass
            self._can = BenchCan(bus, self.signals, self.settings.can)
            if pipe is not None:
                self._microphone = self._make_microphone(plant, sound, pipe)
            self._loop = self._make_loop(plant)
            for part in (self._microphone, self._loop, self._can):
                if part is not None:
                    self._parts.callback(part.stop)
                    part.start()
            self._ports = make_ports(self.settings.serial, self.signals, self.folder, seed=self.seed)
            for port in self._ports.values():
                self._parts.callback(port.close)
                port.start()
            commands = CommandServer(self.folder, self.command)
            self._parts.callback(commands.stop)
            commands.start()
            self._started_s = time.monotonic()
            self._tell_ready()
        except BaseException:
            self._parts.close()
            raise

    def stop(self) -> None:
        """Take everything down: the wires go dead as in a power cut."""
        self._parts.close()

    def check(self) -> None:
        """Raise what has ended a part, if something has.

        Raises
        ------
        DeviceError
            A part cannot go on; the bench should be stopped.
        """
        if self._failure is not None:
            raise DeviceError(
                f"has failed: {self._failure}.", place="bench: plant", remedy="Start the bench anew."
            ) from self._failure
        if self._can is not None:
            self._can.check()
        for name, port in self._ports.items():
            if port.failure is not None:
                raise DeviceError(
                    f"has failed: {port.failure}.", place=f"bench: {name}", remedy="Start the bench anew."
                ) from port.failure

    # -- parts ----------------------------------------------------------------------------------

    def _start_pulse(self) -> Path | None:
        """The pipe of the microphone's server, or None where there is no microphone."""
        server = pulse.PulseServer(self.folder, self.settings.microphone)
        server.clear()
        if not self.settings.microphone.enabled:
            self.notes.append("no microphone: enabled = false in the bench file")
            return None
        if not pulse.installed():
            self.notes.append("no microphone: PulseAudio is not installed (apt-get install pulseaudio)")
            return None
        self._parts.callback(server.stop)
        server.start()
        self._pulse_pids.append(server.pid)
        self._sound_environment = server.environment()
        return server.pipe

    def _make_plant(self) -> tuple[Plant, Sound]:
        from sim_hardware.brake_model import load_brake
        from sim_hardware.plant import Plant, PlantSettings, sound_of

        s = self.settings
        plant_settings = load_model(s.plant, PlantSettings)
        with translated(s.brake):
            brake = load_brake(s.brake)
        plant = Plant(plant_settings, brake, seed=self.seed)
        plant.compile()
        return plant, sound_of(plant_settings, brake, self.seed)

    def _make_microphone(self, plant: Plant, sound: Sound, pipe: Path) -> Microphone:
        from sim_hardware.bench.microphone import Microphone

        return Microphone(self.settings.microphone, sound, plant.sound_channel.scale, pipe)

    def _make_loop(self, plant: Plant) -> PlantLoop:
        from sim_hardware.bench.plant_loop import PlantLoop

        take_sound = self._microphone.submit if self._microphone is not None else None
        return PlantLoop(plant, self.signals, sound=take_sound, failed=self._fail)

    def _open_bus(self) -> can.BusABC:
        arguments = self.settings.bus.arguments
        try:
            bus = can.Bus(**arguments, ignore_config=True)
        except (OSError, ValueError, TypeError, NotImplementedError, can.CanError) as error:
            raise DeviceError(
                f"the {arguments['interface']} interface does not open: {error}.",
                place="bench: bus",
                value=arguments.get("channel"),
                remedy="Check [bus] of the bench file; udp_multicast needs a route: "
                "ip route add 239.0.0.0/8 dev lo.",
            ) from error
        self._parts.callback(bus.shutdown)
        self._refuse_taken(bus)
        return bus

    def _refuse_taken(self, bus: can.BusABC) -> None:
        """A second bench on the same bus would answer in the name of the first."""
        s = self.settings.can
        ours = {getattr(s, name).node for name in type(s).model_fields if name != "delay_ms"}
        end_s = time.monotonic() + LISTEN_S
        while (left_s := end_s - time.monotonic()) > 0:
            message = bus.recv(left_s)
            if message is not None and message.arbitration_id - _HEARTBEAT in ours:
                node = message.arbitration_id - _HEARTBEAT
                raise DeviceError(
                    f"node {node:#x} is on the bus already: another bench, or real devices.",
                    place="bench: bus",
                    value=node,
                    remedy="Give this bench another port or channel under [bus] of its file.",
                )

    def _fail(self, error: BaseException) -> None:
        self._failure = error

    def _tell_ready(self) -> None:
        """`bench.json` is there exactly while the bench serves (and after it was killed)."""
        path = self.folder / READY_NAME
        self._parts.callback(path.unlink, missing_ok=True)
        fresh = path.with_suffix(".new")
        fresh.write_text(json.dumps(self.description(), indent=1))
        fresh.replace(path)

    # -- from outside ---------------------------------------------------------------------------

    def description(self) -> dict[str, Any]:
        """What does not change while it runs: how to reach everything."""
        s = self.settings
        microphone: dict[str, Any] = {}
        if self._microphone is not None:
            m = s.microphone
            microphone = {
                "device": m.name, "rate_hz": m.rate_hz, "format": m.format, "full_scale_pa": m.full_scale_pa,
                "environment": self._sound_environment,
            }  # fmt: skip
        return {
            "name": s.name, "pid": os.getpid(), "seed": self.seed, "folder": str(self.folder),
            "ports": {name: port.address for name, port in self._ports.items()},
            "bus": s.bus.arguments, "microphone": microphone, "notes": self.notes,
            "priority": self.priority,
        }  # fmt: skip

    def status(self) -> dict[str, Any]:
        """The rig and its wires as they are now."""
        values = {name: round(self.signals.newest(name), 4) for name in OUTPUTS}
        return {
            **self.description(),
            "uptime_s": round(time.monotonic() - self._started_s, 1),
            "cpu_percent": self._load.percent(),
            "inputs": asdict(self.signals.commands()),
            "outputs": values,
            "plant": self._loop.counts() if self._loop is not None else {},
            "can": self._can.command({"do": "status"}) if self._can is not None else {},
            "serial": {name: _port_status(port) for name, port in self._ports.items()},
            "sound": self._microphone.status() if self._microphone is not None else {},
        }

    def command(self, request: dict[str, Any]) -> dict[str, Any]:
        """Obey a request of the command socket, see `commands`.

        Raises
        ------
        ConfigError
            Nobody of this name, or no such command.
        """
        fields = dict(request)
        target = fields.pop("to", "bench")
        if target == "bench" and fields == {"do": "status"}:
            return self.status()
        if target == "rig":
            return self._command_rig(fields)
        if target == "can" and self._can is not None:
            return self._can.command(fields)
        if target in self._ports:
            return self._command_port(target, fields)
        raise ConfigError(
            f"{request!r} is no command.",
            place="bench",
            value=target,
            remedy=f"Targets are {', '.join(('bench (do = status)', 'rig', 'can', *self._ports))}.",
        )

    def _command_port(self, name: str, fields: dict[str, Any]) -> dict[str, Any]:
        try:
            return self._ports[name].command(fields)
        except KeyError as error:
            raise ConfigError(
                f"the command lacks the field {error}.", place=f"bench: {name}", value=fields
            ) from error

    def _command_rig(self, fields: dict[str, Any]) -> dict[str, Any]:
        """The hard-wired chain, and the condition of the brake."""
        action = fields.pop("do", None)
        obey: dict[Any, Callable[..., None]] = {
            "estop": self._estop, "doors": self._doors, "condition": self._condition
        }  # fmt: skip
        if action not in obey:
            raise ConfigError(
                f"there is no command {action!r}.",
                place="bench: rig",
                value=action,
                remedy="Give estop (pressed), doors (open), condition (disc_degc, bedding).",
            )
        try:
            obey[action](**fields)
        except TypeError as error:
            raise ConfigError(f"{error}.", place=f"bench: rig: {action}", value=fields) from error
        return {}

    def _estop(self, *, pressed: bool) -> None:
        self.signals.set(estop_ok=not _truth(pressed, "pressed"))

    def _doors(self, *, open: bool) -> None:
        self.signals.set(doors_ok=not _truth(open, "open"))

    def _condition(self, *, disc_degc: float | None = None, bedding: float | None = None) -> None:
        if disc_degc is not None and not -40.0 <= disc_degc <= 900.0:
            raise ConfigError("give -40 to 900.", place="bench: rig: condition: disc_degc", value=disc_degc)
        if bedding is not None and not 0.0 <= bedding < 1.0:
            raise ConfigError("give 0 to below 1.", place="bench: rig: condition: bedding", value=bedding)
        if self._loop is not None:
            self._loop.post(lambda plant: plant.set_condition(disc_degc=disc_degc, bedding=bedding))


class _Load:
    """Share of one processor that this process has used, over the last second or so."""

    WINDOW_S = 1.0

    def __init__(self) -> None:
        self._at_s, self._used_s = time.monotonic(), time.process_time()
        self._percent = 0.0

    def percent(self) -> float:
        """Newest value."""
        now_s, used_s = time.monotonic(), time.process_time()
        if now_s - self._at_s >= self.WINDOW_S:
            self._percent = round(100.0 * (used_s - self._used_s) / (now_s - self._at_s), 1)
            self._at_s, self._used_s = now_s, used_s
        return self._percent


def _truth(value: object, name: str) -> bool:
    if not isinstance(value, bool):
        raise ConfigError(f"{value!r} is neither true nor false.", place=f"bench: rig: {name}", value=value)
    return value


def _port_status(port: SerialPort) -> dict[str, Any]:
    """Counts and faults of a port; a pulled plug shows as the missing link of a pty."""
    is_file = not port.address.startswith("socket://")
    plugged = not is_file or os.path.lexists(port.address)
    return {**port.command({"do": "counts"}), **port.command({"do": "faults"}), "plugged": plugged}


@contextlib.contextmanager
def _held(folder: Path) -> Iterator[None]:
    """The folder for this process alone; the kernel gives it back whatever ends the process."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        fd = os.open(folder / LOCK_NAME, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    except OSError as error:
        raise DeviceError(
            f"cannot be used: {error.strerror}.",
            place=str(folder),
            remedy="Set RIGCTL_BENCH_DIR to a folder of yours.",
        ) from error
    try:
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = os.pread(fd, 32, 0).decode(errors="replace").strip()
            raise DeviceError(
                f"a bench is running here (process {holder or 'unknown'}).",
                place=str(folder),
                remedy="Use that one, or set RIGCTL_BENCH_DIR to another folder.",
            ) from None
        os.ftruncate(fd, 0)
        os.pwrite(fd, str(os.getpid()).encode(), 0)
        (folder / READY_NAME).unlink(missing_ok=True)  # of a bench that was killed
        yield
    finally:
        os.close(fd)


def main() -> None:
    """Entry of ``python -m sim_hardware.bench.process``: a bench without a person in front of it."""
    parser = argparse.ArgumentParser(prog="bench", description=__doc__)
    parser.add_argument("config", type=Path)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--folder", type=Path)
    options = parser.parse_args()
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    try:
        bench = Bench(load_bench(options.config), options.folder, options.seed)
        with bench:
            print(json.dumps({"m": "ready", **bench.description()}), flush=True)
            while not stop.wait(CHECK_S):
                bench.check()
    except RigctlError as error:
        print(f"bench: {error}", file=sys.stderr, flush=True)
        sys.exit(2 if isinstance(error, ConfigError) else 1)


if __name__ == "__main__":
    main()
