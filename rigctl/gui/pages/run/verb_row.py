"""The row of verbs: what can be asked of the run, with the consequences in the tips; note and rating.

Job: buttons, inline question before aborting, the note line, the noise rating. Not its job: permissions
(`verbs`), sending (page).
"""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from rigctl.engine.state import Verb
from rigctl.gui.pages.run.verbs import VERBS, consequence, may
from rigctl.gui.rig.state import RigState
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.inline import AskLine, InlineConfirm
from rigctl.gui.widgets.rating_row import RatingRow


class VerbRow(QWidget):
    """`asked` carries a `Verb`."""

    asked = Signal(object)
    takeCommandAsked = Signal()
    noteGiven = Signal(str)
    rated = Signal(int)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self.setProperty("look", "panel")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self._theme = theme
        self._told: tuple[object, ...] = ()
        self._make_buttons()
        self.take = QPushButton(self.tr("&Take command"))
        self.take.setObjectName("run-take-command")
        self.take.setToolTip(self.tr("Command from this window; whoever commands now is told"))
        self.take.clicked.connect(self.takeCommandAsked)
        self._row.addWidget(self.take)
        self._row.addStretch(1)
        self.rating_name = QLabel(self.tr("Noise"))
        self.rating = RatingRow(theme, "run-rating")
        self.note = QPushButton(self.tr("&Note  (N)"))
        self.note.setObjectName("run-note")
        self.note.setToolTip(self.tr("A note with the time, stored with the present braking"))
        self._marks = QWidget()
        self._mark_row = QHBoxLayout(self._marks)
        for widget in (self.rating_name, self.rating, self.note):
            self._mark_row.addWidget(widget)
        self._grid = QGridLayout()
        self._grid.setColumnStretch(0, 1)
        self._grid.addWidget(self._verbs, 0, 0)
        self._grid.addWidget(self._marks, 0, 1)
        self._side_by_side = True
        self.refusal = QLabel()
        self.refusal.setObjectName("verb-refused")
        self.refusal.setProperty("look", "error")
        self.refusal.setWordWrap(True)
        self.refusal.hide()
        self.confirm = InlineConfirm(theme, "abort-confirm", self.tr("Abort the run"))
        self.confirm.yes.setToolTip(consequence(Verb.STOP))
        self.note_line = AskLine(theme, "note-line", self.tr("Write"))
        self.note_line.done.setToolTip(self.tr("Put it into the journal (Enter)"))
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._grid)
        self._column.addWidget(self.refusal)
        self._column.addWidget(self.confirm)
        self._column.addWidget(self.note_line)
        self.rating.valueChanged.connect(self.rated)
        self.note.clicked.connect(self.open_note)
        self.note_line.given.connect(self.noteGiven)
        self.confirm.confirmed.connect(partial(self.asked.emit, Verb.STOP))
        theme.changed.connect(self._restyle)
        self._restyle()

    def _make_buttons(self) -> None:
        names = {
            Verb.PAUSE: self.tr("&Pause now"),
            Verb.HOLD: self.tr("&Hold after this"),
            Verb.RESUME: self.tr("&Go on"),
            Verb.SKIP: self.tr("S&kip"),
            Verb.REPEAT: self.tr("R&epeat"),
            Verb.STOP: self.tr("&Abort…"),
        }
        self.buttons: dict[Verb, QPushButton] = {}
        self._verbs = QWidget()
        self._row = QHBoxLayout(self._verbs)
        for verb in VERBS:
            button = QPushButton(names[verb])
            button.setObjectName(f"verb-{verb.value}")
            button.clicked.connect(partial(self._on_verb, verb))
            self._row.addWidget(button)
            self.buttons[verb] = button

    def _restyle(self) -> None:
        self._column.setContentsMargins(*(self._theme.px(1),) * 4)
        self._column.setSpacing(self._theme.px(1))
        for layout in (self._row, self._mark_row, self._grid):
            layout.setSpacing(self._theme.px(1))
            layout.setContentsMargins(0, 0, 0, 0)
        self._arrange()

    # -- room -------------------------------------------------------------------------------------

    def minimumSizeHint(self) -> QSize:
        """As wide as the wider of the two groups: the other can go below it."""
        whole = super().minimumSizeHint()
        widest = max(self._verbs.minimumSizeHint().width(), self._marks.minimumSizeHint().width())
        return QSize(widest + 2 * self._theme.px(1), whole.height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """In a narrow window rating and note go into a line of their own."""
        super().resizeEvent(event)
        self._arrange()

    def _arrange(self) -> None:
        needed = self._verbs.minimumSizeHint().width() + self._marks.minimumSizeHint().width()
        side_by_side = self.width() >= needed + 3 * self._theme.px(1)
        if side_by_side is not self._side_by_side:
            self._side_by_side = side_by_side
            self._grid.removeWidget(self._marks)
            place = (0, 1) if side_by_side else (1, 0)
            self._grid.addWidget(self._marks, *place, Qt.AlignmentFlag.AlignRight)

    # -- what can be asked ------------------------------------------------------------------------

    def show_state(self, state: RigState, hold_asked: bool) -> None:
        """What can be asked now; cheap when nothing of it has changed."""
        told = (state.word, state.mode, state.commanding, hold_asked)
        if told == self._told:
            return
        self._told = told
        self.setRefusal("")
        program = state.mode == "program"
        for verb, button in self.buttons.items():
            permission = may(verb, state, hold_asked)
            button.setVisible(program)
            button.setEnabled(permission.allowed)
            tip = consequence(verb)
            button.setToolTip(tip if permission.allowed else f"{tip}\n{permission.reason}")
        self.buttons[Verb.HOLD].setText(self.tr("▸ Will hold") if hold_asked else self.tr("&Hold after this"))
        self.take.setVisible(not state.commanding)
        if not may(Verb.STOP, state, hold_asked).allowed:
            self.confirm.cancel()

    def setRefusal(self, why: str) -> None:
        """What the controller has refused, and why; "" for nothing. It goes when the run's state changes."""
        self.refusal.setText("▲ " + why if why else "")
        self.refusal.setVisible(bool(why))

    def open_note(self) -> None:
        """Show the note line."""
        self.note_line.ask(
            self.tr("Note on the present braking; it goes into the journal with the time."),
            self.tr("e.g. groan at the end, smell of pad"),
        )

    def _on_verb(self, verb: Verb, _checked: bool = False) -> None:
        if verb is Verb.STOP:
            self.confirm.ask(consequence(Verb.STOP))
        else:
            self.asked.emit(verb)
