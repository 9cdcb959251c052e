"""Entry of ``python -m rigctl.safety``: read the options, load limits and safety channel, watch.

Job: put the parts together and turn every failure into one line and an exit code: 0 ended in order, 2 wrong
options or limits, 3 a device or the controller is missing, 4 ended tripped, 70 an error in the program.
Not its job: watching (`rigctl.safety.process`).
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import signal
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from rigctl import __version__
from rigctl.core.errors import ConfigError, DeviceError, RigctlError
from rigctl.core.registry import load_target
from rigctl.core.safety_link import SafetyLink
from rigctl.core.wire import Listener
from rigctl.safety.causes import Cause
from rigctl.safety.evidence import Evidence, Past, read_past
from rigctl.safety.guard import Guard
from rigctl.safety.limits import LoadedLimits, Windows, load_limits
from rigctl.safety.process import EXIT_DEVICE, Patience, Watchdog
from rigctl.safety.realtime import (
    Granted,
    ask_for_priority,
    ignore_terminal_signals,
    quiet_garbage_collector,
    resident_mb,
)
from rigctl.safety.supervise import Supervision

SOCKET_NAME: Final = "watchdog.sock"
EXIT_CONFIG: Final = 2
EXIT_PROGRAM: Final = 70
HEAVY: Final = ("numpy", "pydantic", "h5py", "scipy", "numba")
NOT_ASKED: Final = Granted(False, False, "virtual time: not asked for")


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="rigctl.safety", description="Watchdog of a rig.")
    parser.add_argument("--run-dir", type=Path, help="folder for watchdog.sock; not with --supervise")
    parser.add_argument("--limits", type=Path, required=True, help="limits file (TOML)")
    parser.add_argument("--journal", type=Path, required=True, help="journal of the campaign")
    parser.add_argument("--link", required=True, help="safety channel, module:Class")
    parser.add_argument("--link-settings", default="{}", help="settings of the safety channel (JSON)")
    parser.add_argument("--time", choices=("virtual", "real"), required=True)
    parser.add_argument(
        "--acknowledged-by", default="", help="who has dealt with the last trip in the journal"
    )
    parser.add_argument("--acknowledged-reason", default="", help="why the rig may run again")
    parser.add_argument("--connect-timeout", type=float, default=60.0, help="seconds for the safety channel")
    parser.add_argument(
        "--controller-timeout", type=float, default=300.0, help="seconds for a controller to come"
    )
    parser.add_argument(
        "--linger", type=float, default=5.0, help="seconds to stay after a trip with a mute controller"
    )
    parser.add_argument(
        "--safe-state-timeout", type=float, default=30.0, help="seconds for the rig to come to rest"
    )
    parser.add_argument(
        "--supervise",
        action="store_true",
        help="without a controller: show and journal what is seen; the relay stays open. Ends with Ctrl-C",
    )
    parser.add_argument(
        "--for", dest="seconds", type=float, help="with --supervise: end after so many seconds"
    )
    parser.add_argument(
        "--every", type=float, default=1.0, help="with --supervise: seconds between lines of values"
    )
    options = parser.parse_args(arguments)
    if options.run_dir is None and not options.supervise:
        parser.error("the following arguments are required: --run-dir")
    return options


def main(arguments: list[str] | None = None) -> int:
    """Run the watchdog; returns the exit code."""
    options = _options(arguments)
    if not options.supervise:
        ignore_terminal_signals()
    try:
        return _supervise(options) if options.supervise else _watch(options)
    except ConfigError as error:
        print(f"watchdog: {error}", file=sys.stderr)
        return EXIT_CONFIG
    except (RigctlError, OSError) as error:
        print(f"watchdog: {error}", file=sys.stderr)
        return EXIT_DEVICE


def _watch(options: argparse.Namespace) -> int:
    loaded = load_limits(options.limits)
    settings = _link_settings(options.link_settings)
    past = read_past(options.journal)
    now_s = time.monotonic()
    resets = past.reset_book(loaded.limits.reset.same_cause_per_hour, now_s)
    listener = Listener(options.run_dir / SOCKET_NAME)  # first of all: the controller waits for it
    evidence = Evidence(options.journal)
    lockstep = options.time == "virtual"
    granted = NOT_ASKED if lockstep else ask_for_priority()
    windows = _windows(loaded, lockstep, granted)
    unacknowledged = _acknowledge(options, past, resets.exhausted, evidence, now_s)
    rig: SafetyLink = load_target(options.link, place="safety channel")(settings)
    guard = Guard(
        loaded, windows, lockstep=lockstep, nonce=new_nonce, resets=resets, unacknowledged=unacknowledged
    )
    try:
        rig.connect(options.connect_timeout)
        _tell_start(evidence, options, loaded, windows, granted)
        patience = Patience(options.controller_timeout, options.linger, options.safe_state_timeout)
        watchdog = Watchdog(guard, evidence, rig, listener, windows, lockstep=lockstep, patience=patience)
        return _run(watchdog, guard, evidence)
    except DeviceError as error:
        evidence.write("no_rig", words=str(error))
        raise
    finally:
        rig.close()
        listener.close()
        evidence.flush(5.0)


def _supervise(options: argparse.Namespace) -> int:
    """Look only: no socket for a controller, no latch, no command that could close the relay."""
    loaded = load_limits(options.limits)
    settings = _link_settings(options.link_settings)
    evidence = Evidence(options.journal)
    lockstep = options.time == "virtual"
    granted = NOT_ASKED if lockstep else ask_for_priority()
    windows = _windows(loaded, lockstep, granted)
    rig: SafetyLink = load_target(options.link, place="safety channel")(settings)
    try:
        rig.connect(options.connect_timeout)
        _tell_start(evidence, options, loaded, windows, granted)
        supervision = Supervision(loaded, evidence, rig, sample_s=windows.sample_s, every_s=options.every)

        def on_signal(_number: int, _frame: Any) -> None:
            supervision.terminate = True

        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            signal.signal(number, on_signal)
        quiet_garbage_collector()
        return supervision.run(options.seconds)
    except DeviceError as error:
        evidence.write("no_rig", words=str(error))
        raise
    finally:
        rig.close()
        evidence.flush(5.0)


def _run(watchdog: Watchdog, guard: Guard, evidence: Evidence) -> int:
    def on_sigterm(_number: int, _frame: Any) -> None:
        watchdog.terminate = True

    signal.signal(signal.SIGTERM, on_sigterm)
    quiet_garbage_collector()
    try:
        code = watchdog.run()
    except Exception as error:  # the relay opens, whatever it was
        watchdog.fail(f"{type(error).__name__}: {error}")
        traceback.print_exc()
        code = EXIT_PROGRAM
    cycles = watchdog.cycles
    evidence.write(
        "ended", exit_code=code, state=guard.state.value, cycles=cycles,
        mean_cycle_us=round(watchdog.busy_s / max(cycles, 1) * 1e6, 1),
        longest_cycle_us=round(watchdog.longest_s * 1e6, 1), resident_mb=round(resident_mb(), 1),
    )  # fmt: skip
    return code


def new_nonce() -> int:
    """Unpredictable, never the value that stands for "no status yet"."""
    return int.from_bytes(os.urandom(4), "little") or 1


def _link_settings(text: str) -> dict[str, Any]:
    try:
        settings = json.loads(text)
    except ValueError as error:
        raise ConfigError(f"is no JSON: {error}.", place=f"--link-settings: {text!r}") from error
    if not isinstance(settings, dict):
        raise ConfigError(
            "is no JSON object.", place=f"--link-settings: {text!r}", remedy='Give {"key": value}.'
        )
    return settings  # pyright: ignore[reportUnknownVariableType]


def _windows(loaded: LoadedLimits, lockstep: bool, granted: Granted) -> Windows:
    times = loaded.limits.time
    if lockstep:
        return times.virtual
    return times.real if granted.narrow_window else times.real_without_priority


def _acknowledge(
    options: argparse.Namespace,
    past: Past,
    exhausted: Callable[[str, float], bool],
    evidence: Evidence,
    now_s: float,
) -> Cause | None:
    """Acknowledge the last trip if the options say so; what stays unacknowledged keeps the rig locked."""
    who, reason = options.acknowledged_by.strip(), options.acknowledged_reason.strip()
    if bool(who) != bool(reason):
        raise ConfigError(
            "is not complete.",
            place="--acknowledged-by and --acknowledged-reason",
            remedy="Give both, or neither.",
        )
    cause = past.unacknowledged
    if cause is None or not who:
        return cause
    if exhausted(cause.id, now_s):
        evidence.write(
            "refused_reset", why="too_often", words="The same cause has been reset too often this hour."
        )
        return cause
    evidence.write("acknowledged", who=who, reason=reason, cause=cause.id)
    return None


def _tell_start(
    evidence: Evidence, options: argparse.Namespace, loaded: LoadedLimits, windows: Windows, granted: Granted
) -> None:
    evidence.write(
        "started",
        version=__version__,
        python=platform.python_version(),
        limits=loaded.hash8,
        limits_sha256=loaded.sha256,
        limits_name=loaded.limits.name,
        limits_file=loaded.path.name,
        time=options.time,
        supervises_only=options.supervise,
        real_time_priority=granted.fifo,
        memory_locked=granted.memory_locked,
        priority=granted.words,
        heartbeat_s=windows.heartbeat_s,
        sample_s=windows.sample_s,
        resident_mb=round(resident_mb(), 1),
        heavy_modules=[name for name in HEAVY if name in sys.modules],
    )


if __name__ == "__main__":
    sys.exit(main())
