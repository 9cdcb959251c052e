"""A small simulated rig for the Service page: plant, stimuli, ring and laboratory in a thread, no controller.

Not its job: judging.
"""

import fcntl
import os
import select
import threading
import time
import weakref
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.core.channels import MICROPHONE, ChannelCorrection, corrected
from rigctl.core.journal import Journal
from rigctl.core.ring import RING_NAME, SampleRing
from sim_hardware.brake_model import load_brake
from sim_hardware.devices.stimuli import Door, Stimuli
from sim_hardware.plant import Commands, Plant, PlantSettings
from sim_hardware.plant.calibrator import CalibratorOnMicrophone

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
BLOCK_NS = 50_000_000


class MiniRig:
    """Steps a rig at rest about ten times as fast as the clock and serves its laboratory."""

    def __init__(self, run_dir: Path, corrections: tuple[ChannelCorrection, ...] = ()) -> None:
        settings = load_model(CONFIGS / "plants" / "a_class.toml", PlantSettings)
        self.plant = Plant(settings, load_brake(CONFIGS / "brakes" / "plant.toml"), seed=4)
        self.stimuli = Stimuli(self.plant)
        self.ring = SampleRing.create(
            run_dir / RING_NAME, corrected(self.plant.channels, corrections), seconds=16.0
        )
        self.commands = Commands(vent=True)
        self._coupler = CalibratorOnMicrophone(settings.microphone.full_scale_pa)
        self._poll = select.poll()
        self._door = Door(run_dir, self.stimuli, self._poll)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.is_set():
            for fd, _ in self._poll.poll(0):
                self._door.on_ready(fd)
            self.stimuli.begin(0.0)
            full = self.stimuli.listens
            result = self.stimuli.readings(self.plant.step(BLOCK_NS, self.commands, full_rate=full))
            for name, samples in result.samples.items():
                self.ring.write(name, samples)
            if full:
                sound = self.plant.render_sound()
                levels = self.stimuli.sound
                self.ring.write(MICROPHONE, sound if levels is None else self._coupler.heard(sound, *levels))
            time.sleep(0.005)

    def close(self) -> None:
        """Leave."""
        self._stop.set()
        self._thread.join()
        self._door.close()
        self.ring.close()


def session_of(tmp_path: Path, calibrations: tuple = (), simulated: bool = True) -> SimpleNamespace:
    """What the pages need of a session; its run folder and campaign are made."""
    run_dir, campaign = tmp_path / "run", tmp_path / "data" / "camp"
    run_dir.mkdir(exist_ok=True)
    campaign.mkdir(parents=True, exist_ok=True)
    Journal(campaign / "journal.jsonl", "supervisor").close()
    config = load_model(CONFIGS / "rigs" / "simulated.toml", RigConfig)
    limits = config.safety.model_copy(update={"limits": CONFIGS / "limits" / "a_class.toml"})
    fd = os.open(run_dir, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    fcntl.flock(fd, fcntl.LOCK_EX)  # as a supervisor holds its folder while it lives
    weakref.finalize(config, os.close, fd)
    return SimpleNamespace(
        run_dir=run_dir, campaign=campaign, pid=1, simulated=simulated,
        rig=config.model_copy(update={"safety": limits}), file=SimpleNamespace(calibrations=calibrations),
        keeps=config,
    )  # fmt: skip


def braking(rig: MiniRig) -> None:
    """Let the shaft turn under some pressure."""
    rig.commands = replace(
        rig.commands, speed_set_rpm=60.0, drive_enabled=True, relay_closed=True, vent=False,
        pressure_set_bar=5.0,
    )  # fmt: skip
