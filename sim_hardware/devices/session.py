"""The controller's connection to the simulated rig's process, shared by the five simulated devices.

Job: start the rig server, carry set-points out and blocks in. Not its job: physics (`sim_hardware.plant`),
the safety bus (`sim_hardware.devices.safety_link`).
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigctl.core.blocks import Block
from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import DeviceError
from rigctl.core.ring import RING_NAME, SampleRing
from rigctl.core.wire import Link, connect
from rigctl.hal.devices import Request, RigContext

SOCKET_NAME = "rig.sock"
START_TIMEOUT_S = 180.0  # the first start on a machine compiles the kernels
BLOCK_TIMEOUT_S = 20.0
DEFAULT_RELAY_TIMEOUT_S = 0.15


@dataclass
class Setpoints:
    """What the controller commands; sent whole with every block, so that a lost one cannot linger."""

    speed_rpm: float = 0.0
    ramp_rpm_per_s: float = 50.0
    enable: bool = False
    quick_stop: bool = False
    pressure_bar: float = 0.0
    vent: bool = True
    ventilator_m3_h: float = 0.0

    def to_message(self) -> dict[str, Any]:
        """Plain mapping for the wire."""
        return dict(self.__dict__)


class SimulatedSession:
    """One run of the simulated rig, seen from the controller."""

    def __init__(self, context: RigContext) -> None:
        self._context = context
        self.setpoints = Setpoints()
        self.arguments: list[str] = []
        self.relay_timeout_s = DEFAULT_RELAY_TIMEOUT_S
        self.status: Mapping[str, Any] = {}
        self.channels: tuple[ChannelSpec, ...] = ()
        self._link: Link | None = None
        self._ring: SampleRing | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._k = 0

    @property
    def socket(self) -> Path:
        """Where the rig server listens."""
        return self._context.run_dir / SOCKET_NAME

    def open(self) -> None:
        """Start the server once and wait until it has compiled and answered.

        Raises
        ------
        DeviceError
            It did not start; the log says why.
        """
        if self._link is not None:
            return
        command = [
            sys.executable, "-m", "sim_hardware.devices.server",
            "--run-dir", str(self._context.run_dir), "--time", self._context.time,
            "--relay-timeout", str(self.relay_timeout_s), *self.arguments,
        ]  # fmt: skip
        log_dir = self._context.log_dir
        log = (log_dir / "rig.log").open("ab") if log_dir else None
        try:
            # A session of its own: Ctrl-C and the controller's death do not reach "the hardware".
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True
            )
        finally:
            if log is not None:
                log.close()
        self._link = connect(self.socket, 30.0, "simulated rig")
        self._link.send({"m": "hello", "role": "controller"})
        hello = self._link.recv(START_TIMEOUT_S)
        if hello is None:
            raise DeviceError("does not start.", place="simulated rig", remedy="See logs/rig.log.")
        self.channels = tuple(ChannelSpec(**mapping) for mapping in hello["channels"])
        self._ring = SampleRing.attach(self._context.run_dir / RING_NAME)

    def next_block(self, request: Request) -> Block:
        """Send the set-points, let the plant compute, return what it measured."""
        if self._link is None or self._ring is None:
            raise DeviceError("is not open.", place="simulated rig")
        self._link.send(
            {
                "m": "step",
                "k": self._k,
                "dt_ns": request.dt_ns,
                "recording": request.recording,
                "set": self.setpoints.to_message(),
            }
        )
        message = self._link.recv(BLOCK_TIMEOUT_S)
        if message is None:
            raise DeviceError(
                f"has not delivered a block for {BLOCK_TIMEOUT_S:g} s.", place="simulated rig",
                remedy="See logs/rig.log.",
            )  # fmt: skip
        self._k = message["k"] + 1
        self.status = message["status"]
        ranges = {name: (start, stop) for name, (start, stop) in message["ranges"].items()}
        return Block(
            message["k"],
            message["t_ns"],
            message["dt_ns"],
            ranges,
            self._ring,
            message["stride"],
            self.status,
        )

    def close(self) -> None:
        """Leave; the server goes to the safe state by itself and ends when the watchdog has left too."""
        if self._link is not None:
            self._link.close()
            self._link = None
        if self._ring is not None:
            self._ring.close()
            self._ring = None
