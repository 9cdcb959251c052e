"""Entry of the recorder process: `python -m rigctl.recording --run-dir DIR --campaign DIR`.

Job: options, signals, locks, exit code (0 all kept, 1 something was not kept, 2 could not start).
NOT its job: recording (`recorder`).
"""

from __future__ import annotations

import argparse
import ctypes
import signal
import sys
from pathlib import Path

from rigctl.core.ending import end_process
from rigctl.core.errors import RigctlError
from rigctl.core.journal import Journal
from rigctl.recording.campaign import open_campaign
from rigctl.recording.evaluation import evaluate_braking
from rigctl.recording.recorder import Recorder

_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD, _M_ARENA_MAX = -1, -3, -8  # <malloc.h> of the GNU C library
_KEPT_BYTES = 256 << 20


def keep_freed_memory() -> bool:
    """Let the allocator keep what is freed: each braking needs the same arrays of some MB again, and getting
    them from the kernel page by page is a third of the recorder's system time.

    Returns
    -------
    bool
        False where the C library has no such setting; nothing but time depends on it.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None:
        return False
    settings = ((_M_MMAP_THRESHOLD, 32 << 20), (_M_TRIM_THRESHOLD, _KEPT_BYTES), (_M_ARENA_MAX, 1))
    return all([mallopt(name, value) == 1 for name, value in settings])


def main(arguments: list[str] | None = None) -> int:
    """Run the recorder until its controller leaves; returns the exit code."""
    parser = argparse.ArgumentParser(prog="rigctl.recording", description="Recorder process of a rigctl run.")
    parser.add_argument("--run-dir", type=Path, required=True, help="folder of sockets and ring of this run")
    parser.add_argument("--campaign", type=Path, required=True, help="campaign folder to record into")
    parser.add_argument(
        "--min-free-mb", type=float, default=200.0, help="no braking begins with less free space"
    )
    options = parser.parse_args(arguments)
    keep_freed_memory()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the supervisor, which ends us in order
    try:
        campaign = open_campaign(options.campaign)
        with campaign.lock("spool", timeout_s=10.0):
            journal = Journal(campaign.journal_path, "recorder")
            recorder = Recorder(
                options.run_dir, campaign, journal, evaluate_braking, min_free_bytes=options.min_free_mb * 1e6
            )
            signal.signal(signal.SIGTERM, lambda *_: recorder.request_stop())
            failures = recorder.serve()
            journal.close()
    except (RigctlError, OSError) as error:
        print(f"recorder: {error}", file=sys.stderr)
        return 2
    return 1 if failures else 0


if __name__ == "__main__":
    end_process(main())
