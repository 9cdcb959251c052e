"""What a person sees in the terminal while a program runs.

Job: one live line on a terminal, a plain line every few seconds elsewhere (CI logs): braking, phase,
readings, simulated-time factor, time left. Not its job: the run.
"""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
from rich.progress import Progress as Bar

from rigctl.app.durations import duration_text
from rigctl.app.pace import Pace
from rigctl.engine.state import Progress
from sequences.capabilities import RigCapabilities
from sequences.program import Program

PLAIN_LINE_EVERY_S = 5.0


class ProgressView:
    """Shows the progress of a run; use it as a context manager."""

    def __init__(self, console: Console, program: Program | None, capabilities: RigCapabilities) -> None:
        self._console = console
        self._pace = None if program is None else Pace(program, capabilities)
        self._line_at = 0.0
        self._bar = Bar(
            TextColumn("{task.fields[state]}"),
            BarColumn(bar_width=24),
            MofNCompleteColumn(),
            TextColumn("{task.fields[text]}"),
            console=console,
            refresh_per_second=8,
            disable=not console.is_terminal,
        )
        total = None if program is None else program.count
        self._task = self._bar.add_task("", total=total, state="starting", text="")

    def __enter__(self) -> ProgressView:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def show(self, progress: Progress) -> None:
        """Show the newest progress."""
        text = self._text(progress)
        if self._console.is_terminal:
            self._bar.update(self._task, completed=progress.done, state=progress.state.value, text=text)
            return
        now = time.monotonic()
        if now >= self._line_at:
            self._line_at = now + PLAIN_LINE_EVERY_S
            self._console.print(
                f"{progress.state.value}  {progress.done}/{progress.total}  {text}", highlight=False
            )

    def say(self, line: str) -> None:
        """A line of news."""
        self._console.print(line, highlight=False)

    def _text(self, progress: Progress) -> str:
        parts = [
            f"#{progress.braking} {progress.phase}",
            f"{progress.temperature_degc:.0f} °C {progress.speed_rpm:.0f} 1/min",
            f"{progress.pressure_bar:.1f} bar",
            f"{progress.squealing} squealing",
        ]
        if progress.incomplete:
            parts.append(f"{progress.incomplete} incomplete")
        left = None if self._pace is None else self._pace.left_s(progress)
        if self._pace is not None and self._pace.factor is not None:
            parts.append(f"{self._pace.factor:.0f}× real time")
        if left is not None:
            parts.append(f"{duration_text(left)} left")
        return "  ".join(parts)
