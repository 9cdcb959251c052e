"""When to forecast: after a pause in typing, never two at once, never longer in the event loop than a
moment.

Job: `Forecaster`, small programs at once, large ones in the worker process, always the newest only. Not its
job: the numbers (`forecast`).
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from PySide6.QtCore import QObject, QTimer, Signal

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.forecast import Forecast, effort, forecast
from rigctl.gui.work import Work
from sequences.program import Program

PAUSE_MS = 200
LANE = "sequence"
"""Worker of this page: a forecast does not wait behind the model's studies."""
AT_ONCE = 300
"""Effort up to which a program is forecast in the event loop: about 20 ms."""


class Forecaster(QObject):
    """Forecasts of the newest program asked for."""

    ready = Signal(object)
    """Forecast."""
    busyChanged = Signal(bool)
    failed = Signal(str)

    def __init__(self, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self._wanted: tuple[Program, RigConfig] | None = None
        self._running = False
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(PAUSE_MS)
        self._timer.timeout.connect(self._begin)

    @property
    def busy(self) -> bool:
        """True while a forecast is due or under way."""
        return self._wanted is not None or self._running

    def ask(self, program: Program | None, rig: RigConfig | None) -> None:
        """Forecast this soon; None: nothing is wanted any more."""
        was = self.busy
        self._wanted = None if program is None or rig is None else (program, rig)
        if self._wanted is None:
            self._timer.stop()
        else:
            self._timer.start()
        if self.busy != was:
            self.busyChanged.emit(self.busy)

    def pause(self) -> None:
        """Compute nothing new until asked again."""
        self._timer.stop()

    def resume(self) -> None:
        """Go on with what was wanted."""
        if self._wanted is not None:
            self._timer.start()

    def _begin(self) -> None:
        if self._wanted is None or self._running:
            return  # when the running one ends, the newest begins
        program, rig = self._wanted
        self._wanted = None
        if program.count <= AT_ONCE and effort(program) <= AT_ONCE:
            self._finish(forecast(program, rig))
            return
        self._running = True
        self._work.in_process(
            forecast,
            program,
            rig,
            done=partial(self._on_done, program, rig),
            failed=self._on_failed,
            lane=LANE,
        )

    def _on_done(self, program: Program, rig: RigConfig, result: Forecast) -> None:
        self._running = False
        if self._wanted is None:  # what came back from the worker are copies
            self._finish(replace(result, program=program, rig=rig))
        else:
            self._begin()

    def _on_failed(self, why: str) -> None:
        self._running = False
        self.failed.emit(why)
        if self._wanted is None:
            self.busyChanged.emit(False)
        else:
            self._begin()

    def _finish(self, result: Forecast) -> None:
        self.busyChanged.emit(self.busy)
        self.ready.emit(result)
