"""The simulated rig as a process: stands for the hardware, and outlives the controller as hardware does.

Job: step the plant in lockstep with the controller and the watchdog (virtual time) or by the wall clock
(real time); be the safety relay: open without fresh edges or by the hard-wired chain (emergency stop, doors),
torque off and pressure vented while open; go on alone to standstill when the controller is gone. Not its job:
physics (`sim_hardware.plant`), faults on purpose (`stimuli`).

The order of messages is in `docs/explanation/processes.md`.
"""

from __future__ import annotations

import argparse
import json
import os
import select
import signal
import sys
import time
from pathlib import Path
from typing import Any

from rigctl.core.ending import end_process
from rigctl.core.errors import DeviceError, LinkClosed, RigctlError
from rigctl.core.wire import Link, Listener
from rigctl.hal.priority import BENCH, raise_priority
from sim_hardware.devices.options import add_plant_arguments
from sim_hardware.devices.session import SOCKET_NAME

# Wall clock in virtual time: the watchdog process itself is late only when it is dead. A time-out that is
# meant for such a process, and not for a relay, holds in virtual time as well.
VIRTUAL_RELAY_TIMEOUT_S, PROCESS_TIMEOUT_S = 10.0, 1.0
LEASE_S = 0.25  # real time: set-points older than this are dropped
FREE_RUN_BLOCK_NS = 50_000_000
RING_S = 32.0
REST_BLOCKS = 20
ORPHAN_TIMEOUT_S = 120.0  # nobody has connected, or nobody is left


class RigServer:
    """Lockstep between plant, controller and watchdog.

    Parameters
    ----------
    plant : sim_hardware.plant.Plant
    ring : SampleRing
        Written here, read by controller and recorder.
    microphone : SimulatedMicrophone
        Renders the sound.
    real_time : bool
        Pace blocks by the wall clock and do not wait for anybody.
    relay_timeout_s : float
        The relay opens when no edge has come for so long; in virtual time only from `PROCESS_TIMEOUT_S` on.
    run_dir : Path
        Where the fault laboratory listens.
    """

    def __init__(
        self,
        plant: Any,
        ring: Any,
        microphone: Any,
        *,
        real_time: bool,
        relay_timeout_s: float,
        run_dir: Path,
    ) -> None:
        from sim_hardware.devices.stimuli import Door, Stimuli
        from sim_hardware.plant import Commands, behind_relay

        self._plant = plant
        self._ring = ring
        self._microphone = microphone
        self._real_time = real_time
        own = real_time or relay_timeout_s >= PROCESS_TIMEOUT_S
        self._relay_timeout_s = relay_timeout_s if own else VIRTUAL_RELAY_TIMEOUT_S
        self._commands_type, self._behind_relay = Commands, behind_relay
        self._controller: Link | None = None
        self._safety: Link | None = None
        self._relay = False
        self._k = 0
        self._t_ns = 0
        self._step: dict[str, Any] | None = None
        self._step_at = 0.0
        self._answered = True
        self._watchdog_silent = False
        self._edge_at = time.monotonic()
        self._blocks_at_rest = REST_BLOCKS
        self._poll = select.poll()
        self._stimuli = Stimuli(plant)
        self._door = Door(run_dir, self._stimuli, self._poll)

    def connect(self, controller: Link | None, safety: Link | None) -> None:
        """The two parties, once they have said hello."""
        self._controller, self._safety = controller, safety
        for link in (controller, safety):
            if link is not None:
                self._poll.register(link, select.POLLIN)

    def run(self) -> None:
        """Until both parties have left and the plant is at rest."""
        next_tick = time.monotonic()
        while True:
            if self._real_time:
                next_tick = self._wait_for_tick(next_tick)
            elif not self._wait_for_lockstep():
                continue
            if self._controller is None and self._safety is None:
                self._stimuli.clear()  # nobody is left to mend a stuck valve
                if self._at_rest():
                    self._door.close()
                    return
            self._advance()

    # -- time -----------------------------------------------------------------------------------

    def _wait_for_lockstep(self) -> bool:
        """Wait for the controller's step and the watchdog's answer. True when the plant may go on."""
        if self._step is not None and self._answered:
            return True
        if time.monotonic() - self._edge_at > self._relay_timeout_s and not self._answered:
            self._watchdog_silent = self._answered = True
            self._open_relay("no edge of the watchdog in time")
        if not self._relay and self._answered and self._step is None and not self._at_rest():
            # The controller is silent or gone and the relay is open: the shaft runs down by itself.
            self._pump(0.0 if self._controller is None else 0.05)
            return self._answered
        if self._controller is None and self._safety is None:
            self._open_relay("nobody is connected")
            return True
        if self._controller is None and self._answered and self._at_rest():
            self._pump(0.2)
            return False
        self._pump(0.5)
        return False

    def _wait_for_tick(self, due: float) -> float:
        """Real time: handle messages until the block's length has passed."""
        dt_s = (self._step["dt_ns"] if self._step else FREE_RUN_BLOCK_NS) * 1e-9
        due = max(due, time.monotonic() - dt_s) + dt_s
        while (left := due - time.monotonic()) > 0:
            self._pump(left)
            if self._relay and time.monotonic() - self._edge_at > self._relay_timeout_s:
                self._open_relay("no edge of the watchdog in time")
        if self._step is not None and time.monotonic() - self._step_at > LEASE_S:
            self._step = None  # set-points are leases; nothing is recorded for a controller that is silent
        return due

    def _pump(self, timeout_s: float) -> None:
        """Read what has arrived; a closed link is dropped."""
        for fd, _ in self._poll.poll(timeout_s * 1000.0):
            if self._controller is not None and fd == self._controller.fileno():
                self._controller = self._read(self._controller, self._on_controller)
            elif self._safety is not None and fd == self._safety.fileno():
                self._safety = self._read(self._safety, self._on_safety)
                self._check_safety()
            elif self._door.on_ready(fd) and not self._stimuli.chain_ok:
                self._open_relay("emergency stop or doors")

    def _read(self, link: Link, handle: Any) -> Link | None:
        try:
            message = link.recv(0)
            if message is not None:
                handle(message)
            return link
        except RigctlError as error:
            print(f"rig server: {error}", file=sys.stderr, flush=True)
            return self._drop(link)

    def _check_safety(self) -> None:
        """A watchdog that has gone answers no more, and nobody renews the relay."""
        if self._safety is None:
            self._answered = True
            self._open_relay("the watchdog has gone")

    def _drop(self, link: Link) -> None:
        self._poll.unregister(link)
        link.close()

    # -- parties --------------------------------------------------------------------------------

    def _on_controller(self, message: dict[str, Any]) -> None:
        if message.get("m") == "step":
            self._step = message
            self._step_at = time.monotonic()

    def _on_safety(self, message: dict[str, Any]) -> None:
        self._watchdog_silent = False
        kind = message.get("m")
        if kind == "open":
            self._open_relay(str(message.get("reason", "")))
        elif kind == "close":
            self._relay = self._stimuli.chain_ok
        if kind != "open":
            self._edge_at = time.monotonic()
        if message.get("k") == self._k - 1:
            self._answered = True

    def _open_relay(self, reason: str) -> None:
        if self._relay:
            print(f"rig server: safety relay opened: {reason}", file=sys.stderr, flush=True)
        self._relay = False

    # -- plant ----------------------------------------------------------------------------------

    def _at_rest(self) -> bool:
        """At rest for so long that the watchdog has seen it, noise of its sensors included."""
        return self._blocks_at_rest >= REST_BLOCKS

    def _watch_rest(self) -> None:
        if self._relay:
            self._blocks_at_rest = 0
            return
        truth = self._plant.truth
        resting = truth.pressure_bar < 0.5 and abs(truth.speed_rpm) < 0.5
        self._blocks_at_rest = self._blocks_at_rest + 1 if resting else 0

    def _advance(self) -> None:
        step, stimuli = self._step, self._stimuli
        dt_ns = step["dt_ns"] if step else FREE_RUN_BLOCK_NS
        stimuli.begin(self._t_ns * 1e-9)
        if not stimuli.chain_ok:
            self._open_relay("emergency stop or doors")
        full_rate = bool(step and step["recording"]) or stimuli.listens
        commands = self._commands(step["set"] if step else None)
        result = stimuli.readings(self._plant.step(dt_ns, commands, full_rate=full_rate))
        self._watch_rest()
        ranges = {name: self._ring.write(name, samples) for name, samples in result.samples.items()}
        job = self._plant.take_sound_job()
        name = self._plant.sound_channel.name
        if job is None:
            ranges[name] = self._microphone.nothing()
        else:
            ranges[name] = self._microphone.submit(self._k, job, stimuli.sound)
        if job is None:
            self._microphone.flush()
        status = {
            "relay": self._relay, "enabled": commands.drive_enabled, "estop": stimuli.estop_ok,
            "doors": stimuli.doors_ok,
        }  # fmt: skip
        end_s = (self._t_ns + dt_ns) * 1e-9
        message = {
            "m": "block", "k": self._k, "t_ns": self._t_ns, "dt_ns": dt_ns, "stride": result.stride,
            "ranges": ranges, "status": status,
        }  # fmt: skip
        sample = {"m": "sample", "k": self._k, "t": end_s, "dt": dt_ns * 1e-9, **result.safety, **status}
        self._k += 1
        self._t_ns += dt_ns
        self._answered = self._safety is None or self._watchdog_silent
        if self._safety is not None:
            self._safety = self._send(self._safety, sample)
            self._check_safety()
        if self._controller is not None and (step is not None or self._real_time):
            if not self._real_time:
                self._step = None
            self._controller = self._send(self._controller, message)

    def _commands(self, points: dict[str, Any] | None) -> Any:
        """Set-points as the hardware sees them: the open relay takes torque and pressure away."""
        points = points or {}
        wanted = self._commands_type(
            speed_set_rpm=float(points.get("speed_rpm", 0.0)),
            speed_ramp_rpm_per_s=float(points.get("ramp_rpm_per_s", 50.0)),
            drive_enabled=bool(points.get("enable", False)),
            quick_stop=bool(points.get("quick_stop", False)),
            pressure_set_bar=float(points.get("pressure_bar", 0.0)),
            vent=bool(points.get("vent", True)),
            ventilator_m3_h=float(points.get("ventilator_m3_h", 0.0)),
        )
        reaching = self._behind_relay(
            wanted, closed=self._relay, ventilator_max_m3_h=self._plant.ventilator_max_m3_h
        )
        return self._stimuli.commands(reaching, relay_closed=self._relay)

    def _send(self, link: Link, message: dict[str, Any]) -> Link | None:
        try:
            link.send(message, timeout_s=0.05 if self._real_time else 5.0)
            return link
        except DeviceError as error:
            print(f"rig server: {error}", file=sys.stderr, flush=True)
            if isinstance(error, LinkClosed):
                return self._drop(link)
            return link


def accept_parties(listener: Listener) -> dict[str, Link]:
    """Wait until controller and watchdog have connected and said which they are.

    Raises
    ------
    DeviceError
        One of them has not come in time.
    """
    parties: dict[str, Link] = {}
    deadline = time.monotonic() + ORPHAN_TIMEOUT_S
    while len(parties) < 2:
        if time.monotonic() > deadline:
            raise DeviceError("controller or watchdog have not connected.", place=str(listener.path))
        link = listener.accept(1.0)
        hello = link.recv(5.0) if link is not None else None
        if link is not None and hello is not None and hello.get("role") in ("controller", "safety"):
            parties[hello["role"]] = link
        elif link is not None:
            link.close()
    return parties


def main() -> None:
    """Entry of ``python -m sim_hardware.devices.server``."""
    parser = argparse.ArgumentParser(prog="rig server", description=__doc__)
    add_plant_arguments(parser)
    parser.add_argument("--time", choices=("virtual", "real"), required=True)
    parser.add_argument("--relay-timeout", type=float, required=True)
    parser.add_argument("--corrections", default="[]", help="Calibrations in force, as JSON.")
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    listener = Listener(options.run_dir / SOCKET_NAME)  # before the slow imports: the others can connect

    from rigctl.config.loading import load_model
    from rigctl.core.channels import ChannelCorrection, corrected
    from rigctl.core.ring import RING_NAME, SampleRing
    from sim_hardware.brake_model import load_brake
    from sim_hardware.devices.microphone import BATCH, SimulatedMicrophone
    from sim_hardware.plant import Plant, PlantSettings

    settings = load_model(options.plant, PlantSettings)
    plant = Plant(settings, load_brake(options.brake), seed=options.seed)
    corrections = [ChannelCorrection(**mapping) for mapping in json.loads(options.corrections)]
    channels = corrected(plant.channels, corrections)
    ring = SampleRing.create(options.run_dir / RING_NAME, channels, seconds=RING_S)
    real_time = options.time == "real"
    arguments = ["--brake", str(options.brake), "--plant", str(options.plant), "--seed", str(options.seed)]
    microphone = SimulatedMicrophone(options.run_dir, ring, arguments, batch=1 if real_time else BATCH)
    try:
        plant.compile(sound=False)
        microphone.wait_until_ready()
        server = RigServer(
            plant, ring, microphone, real_time=real_time, relay_timeout_s=options.relay_timeout,
            run_dir=options.run_dir,
        )  # fmt: skip
        parties = accept_parties(listener)
        parties["controller"].send({"m": "hello", "channels": [s.to_mapping() for s in channels]})
        server.connect(parties["controller"], parties["safety"])
        if real_time:  # hardware does not wait for a busy machine
            raise_priority([os.getpid(), microphone.pid], BENCH)
        listener.close()
        server.run()
    finally:
        microphone.close()


if __name__ == "__main__":
    main()
    end_process(0)
