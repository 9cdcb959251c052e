"""The sequence page: programs opened, edited, checked against a rig, saved and started.

Job: put the parts together: every change goes into the draft, and what follows from it is shown. Not its
job: any of the parts.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QApplication,
    QStackedWidget,
    QVBoxLayout,
)

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.base import Page
from rigctl.gui.pages.sequence.checking import Fault, rig_faults
from rigctl.gui.pages.sequence.draft import ProgramDraft, new_sequence
from rigctl.gui.pages.sequence.empty_state import EmptyState
from rigctl.gui.pages.sequence.files import ProgramFiles
from rigctl.gui.pages.sequence.forecast import Forecast, loop_orders
from rigctl.gui.pages.sequence.forecaster import LANE, Forecaster
from rigctl.gui.pages.sequence.forms import ProgramForm
from rigctl.gui.pages.sequence.program_file import (
    OpenedProgram,
    ShippedProgram,
    rigs_in,
    shipped_programs,
)
from rigctl.gui.pages.sequence.readiness import start_words, why_not
from rigctl.gui.pages.sequence.starter import Starter
from rigctl.gui.pages.sequence.toolbar import ProgramBar
from rigctl.gui.pages.sequence.workbench import Workbench
from rigctl.gui.services import Services
from rigctl.gui.widgets.notice import Notice

_KEYS = QKeySequence.StandardKey
_RIG = "sequence-rig"


class SequencePage(Page):
    """The sequence page."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        theme = services.theme
        self.draft = ProgramDraft()
        self.selected = 0
        self.forecast: Forecast | None = None
        self._rig_faults: tuple[Fault, ...] = ()
        self._failure = ""
        self._shipped: tuple[ShippedProgram, ...] = ()
        self.notice = Notice(theme)
        self.bar = ProgramBar(theme)
        self.bench = Workbench(theme)
        self.program_list, self.editor, right = self.bench.program_list, self.bench.editor, self.bench.right
        self.rig_choice, self.figures, self.preview = right.rig_choice, right.figures, right.preview
        self.fault_list, self.start = right.fault_list, right.start
        self.empty = EmptyState(theme)
        self.forecaster = Forecaster(services.work, self)
        self.files = ProgramFiles(services, self.draft, self.notice, self)
        self.starter = Starter(services, self.draft, self.files, self.notice)
        self._build()
        self._connect()
        self.setAcceptDrops(True)
        self._show()

    def _build(self) -> None:
        self.body = QStackedWidget()
        self.body.addWidget(self.empty)
        self.body.addWidget(self.bench)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.bar)
        layout.addWidget(self.notice)
        layout.addWidget(self.body, 1)

    def _connect(self) -> None:
        self.bar.newPressed.connect(lambda: self.files.leave(lambda: self.begin("matrix")))
        self.bar.openPressed.connect(self.files.ask_open)
        self.bar.recentPressed.connect(self.files.open)
        self.bar.savePressed.connect(self.files.save)
        self.bar.saveAsPressed.connect(self.files.ask_save_as)
        self.bar.undoPressed.connect(self.undo)
        self.bar.redoPressed.connect(self.redo)
        self.files.opened.connect(self._on_opened)
        self.files.changed.connect(self._show_bar)
        self.empty.newAsked.connect(self.begin)
        self.empty.openAsked.connect(self.files.ask_open)
        self.empty.programAsked.connect(self.files.open)
        listed = self.program_list
        listed.selected.connect(self.select)
        listed.nameEdited.connect(lambda text: self._did(self.draft.set_head(name=text)))
        listed.descriptionEdited.connect(lambda text: self._did(self.draft.set_head(description=text)))
        listed.enabledEdited.connect(self._on_enabled)
        listed.moved.connect(self._on_moved)
        listed.addAsked.connect(self.add_sequence)
        listed.duplicateAsked.connect(lambda uid: self._take(self.draft.duplicate(uid)))
        listed.removeAsked.connect(self._on_remove)
        self.editor.valueChanged.connect(self._on_edited)
        self.editor.ordersAsked.connect(self.compare_orders)
        self.rig_choice.valueChanged.connect(self._on_rig)
        self.fault_list.chosen.connect(self.go_to)
        self.start.started.connect(lambda choice: self.starter.start(choice, self.rig_choice.path))
        self.forecaster.ready.connect(self._on_forecast)
        self.forecaster.failed.connect(self._on_forecast_failed)
        self.services.rig.stateChanged.connect(lambda _state: self._show_start())
        self.services.theme.changed.connect(self._show)
        for keys, function in (
            (_KEYS.Undo, self.undo), (_KEYS.Redo, self.redo), (QKeySequence("Ctrl+Y"), self.redo),
            (_KEYS.Save, self._save_typed), (QKeySequence("Ctrl+Shift+S"), self.files.ask_save_as),
            (_KEYS.Open, self.files.ask_open), (QKeySequence("Ctrl+N"), self.bar.newPressed.emit),
        ):  # fmt: skip
            self._shortcut(QKeySequence(keys), function)

    def _shortcut(self, keys: QKeySequence, function: Any) -> None:
        if any(keys == other.key() for other in self.findChildren(QShortcut)):
            return
        shortcut = QShortcut(keys, self)
        shortcut.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        shortcut.activated.connect(function)

    # -- page ---------------------------------------------------------------------------------------

    def activated(self) -> None:
        """Read rigs and shipped programs; go on forecasting."""
        folder = self.services.config_folder
        self.services.work.in_thread(
            rigs_in, folder / "rigs", done=self._on_rigs, failed=self.services.notify
        )
        self.services.work.in_thread(
            shipped_programs, folder / "programs", done=self._on_shipped, failed=self.services.notify
        )
        self.forecaster.resume()

    def deactivated(self) -> None:
        """Compute nothing while another page is shown."""
        self.forecaster.pause()

    def open(self, **what: Any) -> None:
        """`program`: path of a program file."""
        if "program" in what:
            self.files.open(Path(what["program"]))

    def unsaved(self) -> list[str]:
        """See Page."""
        if not self.draft.dirty:
            return []
        return [self.tr("Program “{0}” on the sequence page").format(self.draft.form.name)]

    def save_layout(self, settings: QSettings) -> None:
        """See Page."""
        settings.setValue("splitter", self.bench.saveState())

    def restore_layout(self, settings: QSettings) -> None:
        """See Page."""
        state = settings.value("splitter")
        if state is not None:
            self.bench.restoreState(state)

    def help_text(self) -> str:
        """See Page."""
        return self.tr(
            "<p>A program is a list of sequences; a sequence runs its lists of temperatures, speeds and "
            "pressures. "
            "What is wrong stands at its field and in the list on the right; a click there leads to the "
            "field.</p>"
            "<p>In the lists: type numbers and press Enter, paste from a spreadsheet (Ctrl+V), Del "
            "deletes rows, + "
            "joins a speed row with the one above. The order of the loops is changed by dragging, or with "
            "Ctrl and "
            "the arrow keys.</p><p>Ctrl+N new · Ctrl+O open · Ctrl+S save · Ctrl+Shift+S save as · Ctrl+Z "
            "undo · "
            "Ctrl+Y redo · Alt+Up, Alt+Down move a sequence · Del remove it</p>"
        )

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """A program file may be dropped."""
        if self._dropped_file(event) is not None:
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open it."""
        path = self._dropped_file(event)
        if path is not None:
            event.acceptProposedAction()
            self.files.open(path)

    def _dropped_file(self, event: QDropEvent) -> Path | None:
        urls = event.mimeData().urls()
        paths = [Path(url.toLocalFile()) for url in urls if url.isLocalFile()]
        return paths[0] if len(paths) == 1 and paths[0].suffix == ".toml" else None

    # -- program ------------------------------------------------------------------------------------

    def begin(self, kind: str = "matrix") -> None:
        """A new program with one sequence."""
        form = ProgramForm(name=self.tr("new program"), sequences=(new_sequence(kind, self._channels()),))
        self.draft.load(form, saved=False)
        self.notice.close_notice()
        self.files.forget()
        self._rig_faults = ()
        self.select(form.sequences[0].uid)

    def _channels(self) -> dict[str, tuple[float, bool]]:
        rig = self.rig_choice.rig
        if rig is None:
            return {}
        return {name: (c.rate_hz, c.is_sound) for name, c in rig.capabilities.channels.items()}

    def _on_opened(self, read: OpenedProgram) -> None:
        self.draft.load(read.program)
        self._rig_faults = ()
        self.select(self.draft.form.sequences[0].uid)

    def select(self, uid: int) -> None:
        """Edit this sequence."""
        if uid != self.selected or not uid:
            self.selected = uid
            self.preview.follow_all()
        self._show()

    def add_sequence(self, kind: str) -> None:
        """A new sequence behind the selected one."""
        self._take(self.draft.add(new_sequence(kind, self._channels()), self.selected))

    def _take(self, uid: int) -> None:
        self.select(uid or self.selected)

    def _did(self, changed: bool) -> None:
        if changed:
            self._show()

    def _on_enabled(self, uid: int, on: bool) -> None:
        form = self.draft.sequence(uid)
        if form is not None:
            self._did(self.draft.set_sequence(form.__class__(**{**vars(form), "enabled": on}), "enabled"))

    def _on_moved(self, uid: int, place: int) -> None:
        self.draft.move(uid, place)
        self.select(uid)

    def _on_remove(self, uid: int) -> None:
        form = self.draft.sequence(uid)
        if form is not None:
            self.select(self.draft.remove(uid))
            self.services.notify(self.tr("“{0}” is removed; Ctrl+Z brings it back").format(form.name))

    def _on_edited(self, place: str, typed: bool) -> None:
        if self.draft.sequence(self.selected) is not None:
            self._did(self.draft.set_sequence(self.editor.value(), place, merge=typed))

    def _save_typed(self) -> None:
        """Save; a number that is still being typed in a list belongs to it."""
        focus = QApplication.focusWidget()
        if focus is not None and self.isAncestorOf(focus):
            focus.clearFocus()
        self.files.save()

    def undo(self) -> None:
        """One step back."""
        self._after_step(self.draft.undo())

    def redo(self) -> None:
        """One step forward."""
        self._after_step(self.draft.redo())

    def _after_step(self, where: tuple[int, str] | None) -> None:
        if where is None:
            return
        uid = where[0]
        if self.draft.sequence(uid) is None:
            uid = self.selected
        if self.draft.sequence(uid) is None:
            uid = self.draft.form.sequences[0].uid if self.draft.form.sequences else 0
        self.select(uid)

    def go_to(self, uid: int, place: str) -> None:
        """Show a field."""
        if uid == 0:
            target = self.program_list.name if place == "name" else self.program_list.list
            target.setFocus(Qt.FocusReason.OtherFocusReason)
            return
        self.select(uid)
        self.editor.focus(place)

    # -- rig and forecast ---------------------------------------------------------------------------

    def _on_rigs(self, found: tuple[dict[Path, RigConfig], tuple[str, ...]]) -> None:
        rigs, refused = found
        if refused:
            self.services.notify(refused[0])
        if list(rigs.items()) == list(self.rig_choice.rigs.items()):
            return
        stored = str(self.services.settings.value(_RIG, ""))
        self.rig_choice.set_rigs(rigs, self.rig_choice.path or (Path(stored) if stored else None))
        self._use_rig()

    def _on_rig(self) -> None:
        self.services.settings.setValue(_RIG, str(self.rig_choice.path or ""))
        self._use_rig()

    def _use_rig(self) -> None:
        self._rig_faults = ()
        self.editor.show_rig(self.rig_choice.rig)
        self._show()

    def _on_shipped(self, shipped: tuple[ShippedProgram, ...]) -> None:
        self._shipped = shipped
        self.empty.show_programs(shipped, self.files.recent())

    def _on_forecast(self, result: Forecast) -> None:
        if result.program is self.draft.program and result.rig is self.rig_choice.rig:
            self.forecast = result
            self._rig_faults = rig_faults(result.check, self.draft.form)
            self._show()

    def _on_forecast_failed(self, why: str) -> None:
        """The next change tries again."""
        self._failure = why
        self.figures.show_nothing(why)
        self._show_start()

    def compare_orders(self) -> None:
        """Durations of the other orders of the loops of this sequence."""
        form, program, rig = self.draft.sequence(self.selected), self.draft.program, self.rig_choice.rig
        orders = self.editor.setpoints.orders
        if form is None or program is None or rig is None:
            orders.show_text(self.tr("First put right what is marked: only then durations can be estimated."))
            return
        orders.show_text(self.tr("Estimating …"))
        uid = form.uid

        def done(durations: Any) -> None:
            if self.selected == uid and not orders.isHidden():
                present = self.draft.sequence(uid)
                if present is not None:
                    orders.show_durations(durations, present.loop_order)

        self.services.work.in_process(
            loop_orders, program, form.name.strip(), rig, done=done, failed=orders.show_text, lane=LANE
        )

    # -- show ---------------------------------------------------------------------------------------

    def all_faults(self) -> list[Fault]:
        """Errors of the fields, then what the dry run found for sequences that are right."""
        wrong = {fault.uid for fault in self.draft.faults}
        known = {sequence.uid for sequence in self.draft.form.sequences}
        rig = [f for f in self._rig_faults if f.uid in known and f.uid not in wrong]
        return [*self.draft.faults, *rig]

    def _show(self) -> None:
        """Everything that follows from the draft."""
        empty = self.draft.empty
        self.body.setCurrentIndex(0 if empty else 1)
        self._show_bar()
        if empty:
            self.forecaster.ask(None, None)
            self.empty.show_programs(self._shipped, self.files.recent())
            return
        faults = self.all_faults()
        self.program_list.show_draft(self.draft, faults, self.selected)
        form = self.draft.sequence(self.selected)
        self.bench.show_editor(form is not None)
        if form is not None:
            self.editor.setValue(form)
            self.editor.show_faults([fault for fault in faults if fault.uid == form.uid])
        self.fault_list.show_faults(faults, self.draft.form)
        self._show_figures()
        self._show_start()

    def _show_bar(self) -> None:
        self.bar.show_file(self.files.path, dirty=self.draft.dirty, recent=self.files.recent())
        self.bar.show_steps(undo=self.draft.can_undo, redo=self.draft.can_redo)

    def _current_forecast(self) -> Forecast | None:
        result = self.forecast
        fits = (
            result is not None and result.program is self.draft.program and result.rig is self.rig_choice.rig
        )
        return result if fits else None

    def _show_figures(self) -> None:
        program, rig = self.draft.program, self.rig_choice.rig
        self.figures.show_count(program.count if program is not None else None)
        form, result = self.draft.sequence(self.selected), self._current_forecast()
        if result is not None:
            self.forecaster.ask(None, None)
            self.figures.show_check(result.check, self._disk_left())
            course = result.courses.get(form.name.strip()) if form is not None else None
            off = form is not None and not form.enabled
            self.preview.setCourse(course, self.tr("No course: the sequence is off") if off else "")
        elif program is None:
            self.forecaster.ask(None, None)
            self.figures.show_nothing(self.tr("First put right what is marked."))
        elif rig is None:
            self.figures.show_nothing(self.tr("No rig file is found."))
        else:
            self._failure = ""
            self.forecaster.ask(program, rig)
            self.figures.show_waiting(self.tr("estimating …"))

    def _disk_left(self) -> int | None:
        folder = next(
            (p for p in (self.services.data_folder, *self.services.data_folder.parents) if p.is_dir()), None
        )
        return shutil.disk_usage(folder).free if folder is not None else None

    def _show_start(self) -> None:
        if self.draft.empty:
            return
        result, faults = self._current_forecast(), self.all_faults()
        reason = why_not(self.draft, faults, result, self.rig_choice.rig, self.services.rig.state)
        if self._failure and result is None:
            reason = self.tr("Cannot be started, the check failed: {0}").format(self._failure)
        words = ""
        if result is not None and not reason:
            warnings = sum(fault.severity == "warning" for fault in faults)
            saved = self.files.path is not None and not self.draft.dirty
            words = start_words(result, self._disk_left(), warnings, saved=saved)
        simulated = self.rig_choice.rig is not None and self.rig_choice.rig.simulated
        self.start.show_state(reason, words, simulated=simulated)
