"""The watchdog alone, for bring-up: it looks, says what it sees, and never closes the relay.

Job: read the safety channel, run every check on every sample, tell values and verdicts once a second and
every change of a verdict, both in plain lines and in the journal. Not its job: arming (there is no controller
here, and nothing that could close the relay), the checks (`rigctl.safety.checks`).
"""

from __future__ import annotations

import select
import time
from collections import Counter
from typing import Final

from rigctl.core.errors import DeviceError, LinkClosed
from rigctl.core.safety_link import SafetyLink, SafetySample
from rigctl.safety.causes import plain_json
from rigctl.safety.checks import CheckRunner
from rigctl.safety.evidence import Evidence
from rigctl.safety.guard import Note
from rigctl.safety.limits import LoadedLimits
from rigctl.safety.observe import Signal, View

EXIT_DONE: Final = 0
EXIT_DEVICE: Final = 3
TICK_S: Final = 0.05


class Supervision:
    """Loop around the checks. `run` returns the exit code.

    Parameters
    ----------
    loaded : LoadedLimits
    evidence : Evidence
        Journal and lines.
    rig : SafetyLink
        Connected.
    sample_s : float
        Without a sample for so long the channel is called silent.
    every_s : float
        Between two lines of values.
    """

    def __init__(
        self, loaded: LoadedLimits, evidence: Evidence, rig: SafetyLink, *, sample_s: float, every_s: float
    ) -> None:
        self._evidence, self._rig = evidence, rig
        self._sample_s, self._every_s = sample_s, every_s
        self._runner = CheckRunner(loaded.limits)
        self._view: View | None = None
        self._verdicts: tuple[str, ...] = ()
        self._counts: Counter[str] = Counter()
        self._sample_at_s = self._told_at_s = time.monotonic()
        self._silent = False
        self.samples = 0
        self.terminate = False

    def run(self, seconds: float | None) -> int:
        """Look until `terminate` or the time is over (None: no end). Exit code 3: the channel has gone."""
        ends_s = None if seconds is None else time.monotonic() + seconds
        poll = select.poll()
        poll.register(self._rig.fileno(), select.POLLIN)
        code = EXIT_DONE
        while not self.terminate and (ends_s is None or time.monotonic() < ends_s):
            try:
                sample = self._rig.recv(0.0) if poll.poll(TICK_S * 1000.0) else None
                if sample is not None:
                    self._on_sample(sample)
                    self._rig.hold(sample.k)
            except LinkClosed as error:
                self._evidence.write("rig_gone", words=f"The rig's safety channel is closed: {error}")
                code = EXIT_DEVICE
                break
            except DeviceError as error:
                self._evidence.write("refused_sample", words=str(error))
            self._watch_silence()
        self._evidence.write(
            "supervised", samples=self.samples, verdicts=dict(sorted(self._counts.items())),
            words=f"{self.samples} samples seen; verdicts: {self._told_counts() or 'none'}",
        )  # fmt: skip
        return code

    def _on_sample(self, sample: SafetySample) -> None:
        now_s = time.monotonic()
        before = self._view
        view = self._view = View(sample, before, False)
        verdicts = self._runner.run(view, before)
        self.samples += 1
        self._sample_at_s, self._silent = now_s, False
        self._counts.update(verdict.cause.id for verdict in verdicts)
        ids = tuple(verdict.cause.id for verdict in verdicts)
        if ids != self._verdicts:
            self._verdicts = ids
            words = " ".join(verdict.cause.words for verdict in verdicts) or "All checks pass."
            self._evidence.put(Note("verdicts", sample.t_s, {"verdicts": list(ids), "words": words}))
        if now_s - self._told_at_s >= self._every_s:
            self._told_at_s = now_s
            self._tell(view)

    def _tell(self, view: View) -> None:
        sample = view.sample
        values = {
            "pressure_bar": _mean(view.pressure), "speed_rpm": _mean(view.speed),
            "torque_nm": _mean(view.torque), "temperature_degc": _mean(view.temperature),
        }  # fmt: skip
        states = {
            "relay_closed": sample.relay_closed, "drive_enabled": sample.drive_enabled,
            "estop_ok": sample.estop_ok, "doors_ok": sample.doors_ok,
        }  # fmt: skip
        told = [
            f"{name.rpartition('_')[0]} {'-' if value is None else format(value, '.2f')}"
            for name, value in values.items()
        ]
        told += [f"{name} {'yes' if state else 'no'}" for name, state in states.items()]
        told.append(f"would trip or stay locked: {', '.join(self._verdicts) or 'no'}")
        payload = {
            "k": sample.k,
            **values,
            **states,
            "verdicts": list(self._verdicts),
            "words": ", ".join(told),
        }
        self._evidence.put(Note("seen", sample.t_s, payload))

    def _watch_silence(self) -> None:
        silent_s = time.monotonic() - self._sample_at_s
        if not self._silent and silent_s > self._sample_s:
            self._silent = True
            self._counts["samples_late"] += 1
            self._evidence.write("verdicts", verdicts=["samples_late"], words="The safety channel is silent.")

    def _told_counts(self) -> str:
        return ", ".join(f"{cause} {count}" for cause, count in sorted(self._counts.items()))


def _mean(signal: Signal) -> float | None:
    """Mean of the block; None where nothing valid was read."""
    mean = plain_json(signal.mean)
    return round(mean, 4) if isinstance(mean, float) else None
