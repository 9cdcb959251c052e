"""The manual page: readings at the left, controls in the middle, live sound at the right, recording below.

Job: put the parts together, show the scene that the model says, turn what a person does into commands of the
rig connection. Not its job: what may be done (`model`, `orders`), how the parts look.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QSettings, Qt, QTimer
from PySide6.QtGui import QKeyEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QApplication,
    QLabel,
    QPushButton,
    QSplitter,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from rigctl.config.rig import RigConfig
from rigctl.core.errors import RigctlError
from rigctl.gui.pages.base import Page
from rigctl.gui.pages.manual.connect_panel import ConnectPanel
from rigctl.gui.pages.manual.controls import Controls, scrolled
from rigctl.gui.pages.manual.model import Action, ManualModel, Scene, WatchdogLimits
from rigctl.gui.pages.manual.orders import PressureOrder, common_ranges, ranges_of
from rigctl.gui.pages.manual.readouts import Readouts
from rigctl.gui.pages.manual.record_row import RecordRow
from rigctl.gui.pages.manual.rigs import RigChoice, list_rigs, read_watchdog_limits
from rigctl.gui.rig.phases import said
from rigctl.gui.rig.state import RigState, Word
from rigctl.gui.services import Services
from rigctl.gui.widgets.live_slot import LiveSlot
from rigctl.gui.widgets.rating_row import RATINGS

_RIG_KEY = "manual-rig"
LIVE_PANELS = ("waveform", "spectrum", "spectrogram", "level", "trend")  # the bars have trends of their own


class ManualPage(Page):
    """Moves motor and brake by hand."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        theme = services.theme
        self.model = ManualModel()
        self._active = False
        self._arranged = False
        ranges = common_ranges()
        self.panel = ConnectPanel(theme)
        self.readouts = Readouts(theme, self.model.scales())
        self.controls = Controls(theme, self.model, ranges)
        self.program = self._program_notice()
        self.live = LiveSlot(services, LIVE_PANELS, hidden=("trend",))
        self.record = RecordRow(theme, ranges["duration"])
        self._build()
        self._wire()
        theme.changed.connect(self._restyle)
        self._restyle()
        session = services.rig.session
        if session is not None:
            self._on_attached(session)
        self._on_state(services.rig.state)
        self._show_scene()

    # -- building ---------------------------------------------------------------------------------

    def _program_notice(self) -> QWidget:
        box = QWidget()
        title = QLabel(self.tr("A program is running"))
        title.setProperty("look", "title")
        text = QLabel(
            self.tr(
                "Speed, pressure and temperature are set by the program; here you can look and listen. Pause,"
                " hold, skip or abort it on the page Run. STOP works from here, too."
            )
        )
        text.setWordWrap(True)
        button = QPushButton(self.tr("Show the &run"))
        button.setObjectName("show-run")
        button.setToolTip(self.tr("Page Run: brakings, occurrence map, verbs (Alt+3)"))
        button.clicked.connect(lambda: self.services.navigate("run"))
        self._program_column = QVBoxLayout(box)
        for widget in (title, text):
            self._program_column.addWidget(widget)
        self._program_column.addWidget(button, 0, Qt.AlignmentFlag.AlignLeft)
        self._program_column.addStretch(1)
        return box

    def _build(self) -> None:
        self.middle = QStackedWidget()
        self.middle.addWidget(self.controls)
        self.middle.addWidget(self.program)
        self.splitter = QSplitter(Qt.Orientation.Horizontal)
        self.splitter.setObjectName("manual-splitter")
        self.splitter.setChildrenCollapsible(False)
        self._left = scrolled(self.readouts, "manual-readouts")
        for widget in (self._left, self.middle, self.live):
            self.splitter.addWidget(widget)
        for place, stretch in enumerate((0, 0, 1)):
            self.splitter.setStretchFactor(place, stretch)
        console = QWidget()
        self._console_column = QVBoxLayout(console)
        self._console_column.addWidget(self.splitter, 1)
        self._console_column.addWidget(self.record)
        self.scenes = QStackedWidget()
        self.scenes.addWidget(self.panel)
        self.scenes.addWidget(console)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.scenes)
        self._console = console
        self._release_key = QShortcut(
            QKeySequence(Qt.Key.Key_Space), self, context=Qt.ShortcutContext.WidgetWithChildrenShortcut
        )
        self._release_key.setAutoRepeat(False)
        self._release_key.activated.connect(self._release)
        self._rating_keys = []
        for rating in RATINGS:
            key = QShortcut(
                QKeySequence(str(rating)), self, context=Qt.ShortcutContext.WidgetWithChildrenShortcut
            )
            key.activated.connect(lambda rating=rating: self.record.rating.give(rating))
            self._rating_keys.append(key)

    def _restyle(self) -> None:
        t = self.services.theme
        self._console_column.setContentsMargins(*(t.px(1),) * 4)
        self._console_column.setSpacing(t.px(1))
        self._program_column.setContentsMargins(t.px(1), 0, t.px(1), 0)
        self._program_column.setSpacing(t.px(1))
        self.splitter.setHandleWidth(t.px(0.25))
        self._left.setMinimumWidth(t.px(29))
        self.live.setMinimumWidth(t.px(12))

    def _wire(self) -> None:
        rig = self.services.rig
        rig.stateChanged.connect(self._on_state)
        rig.attached.connect(self._on_attached)
        rig.detached.connect(self._on_detached)
        rig.refused.connect(self._on_refused)
        self.panel.connectAsked.connect(self._connect)
        safety, motor = self.controls.safety, self.controls.motor
        brake, disc = self.controls.brake, self.controls.disc
        safety.enableConfirmed.connect(rig.enable)
        safety.disableAsked.connect(rig.disable)
        safety.takeCommandAsked.connect(rig.take_command)
        safety.resetGiven.connect(rig.reset)
        safety.endAsked.connect(rig.end_session)
        motor.ordered.connect(rig.set_speed)
        motor.stopAsked.connect(self._stop_motor)
        brake.ordered.connect(self._apply)
        self.controls.releaseAsked.connect(self._release)
        disc.conditionOrdered.connect(rig.condition)
        disc.ventilatorOrdered.connect(rig.set_ventilator)
        self.record.startAsked.connect(self._start_recording)
        self.record.rated.connect(rig.rate)
        for box in (motor, brake, disc, self.record):
            box.refused.connect(self.services.notify)
        for box in (motor, brake, self.record):
            box.changed.connect(self._show_record)
        self.live.levelChanged.connect(self.readouts.setLevel)

    # -- life of the page -------------------------------------------------------------------------

    def activated(self) -> None:
        """Read the rigs anew; live plots run."""
        folder = self.services.config_folder / "rigs"
        self.services.work.in_thread(list_rigs, folder, done=self._on_rigs, failed=self.panel.setError)
        self._active = True
        self._show_scene()

    def deactivated(self) -> None:
        """Live plots rest."""
        self._active = False
        self.live.stop()

    def save_layout(self, settings: QSettings) -> None:
        """Where the columns end."""
        settings.setValue("columns", self.splitter.saveState())
        self.live.save_layout(settings)

    def restore_layout(self, settings: QSettings) -> None:
        """As left."""
        state = settings.value("columns")
        if state is not None:
            self._arranged = True
            self.splitter.restoreState(state)
        self.live.restore_layout(settings)

    # -- news -------------------------------------------------------------------------------------

    def _on_rigs(self, choices: list[RigChoice]) -> None:
        before = self.panel.value()
        wanted = before[0] if before else Path(str(self.services.settings.value(_RIG_KEY, "")))
        self.panel.setValue(choices, wanted)

    def _on_attached(self, session: Any) -> None:
        self.panel.setBusy(False)
        self.panel.setError("")
        try:
            rig: RigConfig = session.rig
        except RigctlError as error:
            self.services.notify(str(error))
            return
        self.model.session(rig)
        self.readouts.clear()
        self._take_ranges(rig)
        limits = Path(session.campaign) / rig.safety.limits
        self.services.work.in_thread(
            read_watchdog_limits, limits, done=self._on_limits, failed=self.services.notify
        )
        self.record.rating.setValue(0)

    def _take_ranges(self, rig: RigConfig) -> None:
        ranges = ranges_of(rig)
        self.readouts.setScales(self.model.scales())
        self.controls.setRanges(ranges)
        self.record.duration.setLimits(ranges["duration"])
        self._show_record()

    def _on_limits(self, limits: WatchdogLimits) -> None:
        if self.model.rig is not None:
            self.model.limits = limits
            self.readouts.setScales(self.model.scales())

    def _on_detached(self, why: str) -> None:
        self.model.session(None)
        self.readouts.clear()
        self.panel.setBusy(False)
        self.panel.setNews(why)

    def _on_refused(self, why: str) -> None:
        self.model.refused()
        self.controls.safety.setRefusal(why)
        if self.panel.busy and self.model.scene is not Scene.MANUAL:
            self.panel.setBusy(False)
            self.panel.setError(why)

    def _on_state(self, state: RigState) -> None:
        was_recording = self.model.state.recording
        self.model.show(state)
        if state.recording and not was_recording:
            self.record.rating.setValue(0)
        self.readouts.show_state(state)  # unseen, too: the trends shall have no hole
        if self.isVisible() or self.model.scene is Scene.NO_SESSION:
            self._show_scene()

    def _show_scene(self) -> None:
        state, scene = self.model.state, self.model.scene
        self.panel.setBusy(scene is Scene.STARTING or (self.panel.busy and state.word is Word.OFFLINE))
        if scene is Scene.STARTING:
            self.panel.setNews(said(state.phase))
        console = scene in (Scene.MANUAL, Scene.PROGRAM)
        self.scenes.setCurrentWidget(self._console if console else self.panel)
        if not console:
            self._release_key.setEnabled(False)
            self.live.stop()
            return
        if self._active:
            self.live.start()
            if not self._arranged:
                self._arranged = True
                QTimer.singleShot(0, self, self._arrange)
        self.middle.setCurrentIndex(0 if scene is Scene.MANUAL else 1)
        self.record.setVisible(scene is Scene.MANUAL)
        self._release_key.setEnabled(self.model.may(Action.RELEASE).allowed)
        if scene is Scene.MANUAL:
            self.controls.show_model()
            self._show_record()
            self.record.setProgress(self.model.recording_progress())

    def _arrange(self) -> None:
        """Without a remembered layout: readings and controls as narrow as they may be."""
        self.splitter.setSizes([1, 1, 10_000])

    # -- recording --------------------------------------------------------------------------------

    def _recordable(self) -> tuple[PressureOrder | None, float | None, str]:
        """Pressure and speed in the fields, and why they cannot be recorded ("" when they can)."""
        order, speed, rig = self.controls.brake.order(), self.controls.motor.speed.value(), self.model.rig
        duration = self.record.duration.value()
        if speed is None or order is None:
            return order, speed, self.tr("Mend speed or pressure above first.")
        if order.pressure_bar <= 0.0:
            return order, speed, self.tr("Type a pressure above 0 first.")
        if rig is None or duration is None:
            return order, speed, ""
        shown = PressureOrder(order.pressure_bar, order.function, duration)
        problem = shown.problem(rig.capabilities, speed) or shown.load_problem(rig.capabilities, speed)
        return order, speed, problem

    def _show_record(self) -> None:
        order, speed, problem = self._recordable()
        words = ""
        if order is not None and speed is not None:
            words = self.tr("with {0} bar ({1}) at {2} 1/min, as typed above").format(
                f"{order.pressure_bar:g}", self.controls.brake.kind.currentText(), f"{speed:g}"
            )
        self.record.setWhat(words, problem)
        allowed = self.model.may(Action.RECORD)
        self.record.setPermission(allowed, self.model.may(Action.RATE))
        self.record.start.setEnabled(allowed.allowed and not problem)

    def _start_recording(self, duration_s: float, comment: str) -> None:
        order, speed, problem = self._recordable()
        if problem or order is None or speed is None:
            self.services.notify(problem)
            return
        self.model.ordered(duration_s)
        self.services.rig.record(
            duration_s, speed_rpm=speed, pressure_bar=order.pressure_bar, function=order.function,
            comment=comment,
        )  # fmt: skip

    # -- orders -----------------------------------------------------------------------------------

    def _connect(self, path: Path, time: str) -> None:
        self.services.settings.setValue(_RIG_KEY, str(path))
        self.panel.setBusy(True)
        self.services.rig.start_manual(path, time=time)

    def _apply(self, order: PressureOrder) -> None:
        self.services.rig.set_pressure(order.pressure_bar, order.function, order.duration_s)

    def _release(self) -> None:
        permission = self.model.may(Action.RELEASE)
        if permission.allowed:
            self.services.rig.set_pressure(0.0)
        else:
            self.services.notify(permission.reason)

    def _stop_motor(self) -> None:
        rig = self.model.rig
        if rig is not None:
            self.services.rig.set_speed(0.0, rig.capabilities.max_speed_rate_rpm_s)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter presses the button that has the focus (the space bar releases the pressure here)."""
        focus = QApplication.focusWidget()
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and isinstance(focus, QPushButton):
            focus.click()
        else:
            super().keyPressEvent(event)

    def help_text(self) -> str:
        """What F1 shows."""
        return self.tr(
            "<h3>Manual</h3>"
            "<p>Move motor and brake by hand and record single brakings. Connect to a rig, enable, type a"
            " set-point and press Enter. Blue is what is commanded. Limits stand beside each field.</p>"
            "<p><b>Space</b> releases the pressure, wherever the cursor is (but in the comment)<br>"
            "<b>Enter</b> applies the field, or presses the button with the focus<br>"
            "<b>Alt + underlined letter</b> goes to a field or presses a button<br>"
            "<b>1 … 9</b> noise rating of the present or last braking (when no field has the cursor)<br>"
            "<b>Esc</b> cancels a question<br>"
            "<b>F12</b> software stop</p>"
            "<p>A course (ramp, sine, triangle, steps) ends by itself; its pressure is released then. Heating"
            " drags the brake; any other order ends it. A trip wants a reason before the rig can be enabled"
            " again.</p>"
        )
