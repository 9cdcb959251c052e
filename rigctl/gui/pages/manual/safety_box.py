"""Above the controls: what a person must know, and the way to energy and back.

Job: the notice, [Take command], [Reset…] with a reason, [Enable] that says what will move, [Disable]. Not its
job: which of them are allowed (`model`), doing them (page).
"""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.pages.manual.model import Action, ManualModel, Notice
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.inline import AskLine, InlineConfirm


class SafetyBox(QWidget):
    """`show_model` is its input; signals say what a person has decided."""

    enableConfirmed = Signal()
    disableAsked = Signal()
    takeCommandAsked = Signal()
    resetGiven = Signal(str)
    endAsked = Signal()

    def __init__(self, theme: ThemeKeeper, model: ManualModel) -> None:
        super().__init__()
        self._theme = theme
        self._model = model
        self.title = QLabel()
        self.title.setObjectName("manual-notice")
        self.title.setWordWrap(True)
        self.text = QLabel()
        self.text.setObjectName("manual-remedy")
        self.text.setWordWrap(True)
        self.refusal = QLabel()
        self.refusal.setObjectName("manual-refused")
        self.refusal.setProperty("look", "error")
        self.refusal.setWordWrap(True)
        self.refusal.hide()
        self._notice = Notice("")
        self.take = self._button("take-command", self.tr("&Take command"))
        self.take.setToolTip(self.tr("Command from this window; whoever commands now is told"))
        self.reset = self._button("reset", self.tr("Res&et…"))
        self.reset.setToolTip(
            self.tr("Acknowledge the trip in your words. The rig is locked then; nothing moves by it.")
        )
        self.reason = AskLine(theme, "reset-reason", self.tr("Reset"))
        self.enable = self._button("enable", self.tr("&Enable"), primary=True)
        self.disable = self._button("disable", self.tr("&Disable"))
        self.disable.setToolTip(
            self.tr("Releases the pressure, brings the disc to rest, opens the safety relay")
        )
        self.end = self._button("end-session", self.tr("End session"))
        self.end.setToolTip(self.tr("Comes to rest, locks, and ends the controller of this session"))
        self.confirm = InlineConfirm(theme, "enable-confirm", self.tr("Enable &now"))
        self.confirm.yes.setToolTip(self.tr("The watchdog closes the safety relay"))
        self._build()
        self.take.clicked.connect(self.takeCommandAsked)
        self.disable.clicked.connect(self.disableAsked)
        self.end.clicked.connect(self.endAsked)
        self.reset.clicked.connect(self._ask_reason)
        self.reason.given.connect(self.resetGiven)
        self.reason.cancelled.connect(self._arrange)
        self.enable.clicked.connect(self._on_enable)
        self.confirm.confirmed.connect(self._on_confirmed)
        self.confirm.cancelled.connect(self._on_cancelled)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _button(self, name: str, text: str, *, primary: bool = False) -> QPushButton:
        button = QPushButton(text)
        button.setObjectName(name)
        if primary:
            button.setProperty("look", "primary")
        return button

    def _build(self) -> None:
        self._row = QHBoxLayout()
        for button in (self.enable, self.disable, self.take, self.reset):
            self._row.addWidget(button)
        self._row.addStretch(1)
        self._row.addWidget(self.end)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        for widget in (self.title, self.text, self.refusal):
            self._column.addWidget(widget)
        self._column.addLayout(self._row)
        self._column.addWidget(self.confirm)
        self._column.addWidget(self.reason)

    def _restyle(self) -> None:
        self._column.setSpacing(self._theme.px(1))
        self._row.setSpacing(self._theme.px(1))
        self.title.setFont(self._theme.font("normal", bold=True))

    # -- what is shown ----------------------------------------------------------------------------

    def show_model(self) -> None:
        """Take on what the model says now."""
        notice = self._model.notice()
        if notice != self._notice:
            self._notice = notice
            self._show_notice(notice)
            self.setRefusal("")
        for button, action in (
            (self.enable, Action.ENABLE),
            (self.disable, Action.DISABLE),
            (self.take, Action.TAKE_COMMAND),
            (self.reset, Action.RESET),
            (self.end, Action.END),
        ):
            button.setEnabled(self._model.may(action).allowed)
        why = self._model.may(Action.ENABLE).reason
        self.enable.setToolTip(why or self.tr("Let motor and brake be moved; says first what will move"))
        if not self._model.may(Action.ENABLE).allowed:
            self.confirm.cancel()
        if not self._model.may(Action.RESET).allowed:
            self.reason.cancel()
        self._arrange()

    def setRefusal(self, why: str) -> None:
        """What the controller has refused, and why; "" for nothing. It goes when the rig's state changes."""
        self.refusal.setText("▲ " + why if why else "")
        self.refusal.setVisible(bool(why))

    def _show_notice(self, notice: Notice) -> None:
        mark = "▲ " if notice.look else ""
        self.title.setText(mark + notice.title)
        self.text.setText(notice.text)
        self.text.setVisible(bool(notice.text))
        look = notice.look or "title"
        if self.title.property("look") != look:
            self.title.setProperty("look", look)
            self.title.style().polish(self.title)

    def _arrange(self) -> None:
        """Only what can be of use now is there."""
        asking = not self.confirm.isHidden() or not self.reason.isHidden()
        tripped = self._model.may(Action.RESET).allowed
        commanding = self._model.state.commanding
        self.take.setVisible(self._model.may(Action.TAKE_COMMAND).allowed and not asking)
        self.end.setVisible(self._model.may(Action.END).allowed and not asking)
        self.reset.setVisible(tripped and not asking)
        self.enable.setVisible(commanding and not tripped and not asking and not self._model.live_energy)
        self.disable.setVisible(commanding and not tripped and not asking and self._model.live_energy)

    # -- what a person does -----------------------------------------------------------------------

    def _on_enable(self) -> None:
        if self._model.must_ask:
            self.confirm.ask(self._model.enable_question())
            self._arrange()
        else:
            self.enableConfirmed.emit()

    def _on_confirmed(self) -> None:
        self._model.answered_yes()
        self._arrange()
        self.enableConfirmed.emit()

    def _on_cancelled(self) -> None:
        self._arrange()
        self.enable.setFocus(Qt.FocusReason.OtherFocusReason)

    def _ask_reason(self) -> None:
        self.reason.ask(
            self.tr("What was the cause, and what was done? It goes into the journal."),
            self.tr("e.g. vent valve was closed; opened it"),
        )
        self._arrange()
