"""The top of the window: which rig, real or simulated, its state in one word, progress, time and disk left.

Not its job: deciding anything; it shows a `RigState`.
"""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QBrush, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QHBoxLayout, QLabel, QProgressBar, QSizePolicy, QVBoxLayout, QWidget

from rigctl.gui.format import bytes_text, time_text
from rigctl.gui.rig.phases import said
from rigctl.gui.rig.state import RigState, Word
from rigctl.gui.theme import ThemeKeeper

_LOOKS = {
    Word.OFFLINE: ("panel", "muted"),
    Word.STARTING: ("panel", "text"),
    Word.LOCKED: ("panel", "text"),
    Word.READY: ("panel", "text"),
    Word.RUNNING: ("blue", "on_blue"),
    Word.PAUSED: ("amber", "on_amber"),
    Word.STOPPING: ("amber", "on_amber"),
    Word.TRIPPED: ("red", "on_red"),
}


class StateBar(QWidget):
    """State bar. `show_state` is its only input."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.rig = QLabel()
        self.kind = QLabel()
        self.word = QLabel()
        self.cause = QLabel()
        self.count = QLabel()
        self.bar = QProgressBar()
        self.left = QLabel()
        self.disk = QLabel()
        self.phase = QLabel()
        self.commander = QLabel()
        self._build()
        theme.changed.connect(self._restyle)
        self.show_state(RigState())

    def _build(self) -> None:
        self.kind.setObjectName("rig-kind")
        self.word.setObjectName("state-word")
        self.word.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.kind.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.bar.setTextVisible(False)
        self.bar.setFixedHeight(self._theme.px(1.5))
        self.bar.setMinimumWidth(self._theme.px(12))
        self.cause.setWordWrap(True)
        self.cause.setObjectName("first-out-cause")
        for label in (self.phase, self.disk, self.commander):
            label.setProperty("look", "muted")
        self.rig.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.rig.setMinimumWidth(self._theme.px(16))
        top = QHBoxLayout()
        top.setSpacing(self._theme.px(2))
        top.addWidget(self.kind)
        top.addWidget(self.rig, 2)
        top.addWidget(self.word)
        top.addWidget(self.count)
        top.addWidget(self.bar, 1)
        top.addWidget(self.left)
        below = QHBoxLayout()
        below.setSpacing(self._theme.px(2))
        below.addWidget(self.cause, 1)  # in place of the phase: nothing below moves when something trips
        below.addWidget(self.phase, 1)
        below.addWidget(self.commander)
        below.addWidget(self.disk)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(*(self._theme.px(1),) * 4)
        layout.setSpacing(self._theme.px(0.5))
        layout.addLayout(top)
        layout.addLayout(below)
        self._restyle()

    def _restyle(self) -> None:
        for label in (self.word, self.kind):
            label.setFont(self._theme.font("normal", bold=True))
            label.setMinimumWidth(self._theme.px(13))
            label.setMinimumHeight(self._theme.px(4))
        for label in (self.phase, self.disk, self.commander):
            label.setFont(self._theme.font("small"))
            label.setMinimumHeight(self._theme.px(3))
        self.cause.setMinimumHeight(self._theme.px(3))
        self._paint_word(getattr(self, "_state", RigState()))

    def show_state(self, state: RigState) -> None:
        """Show a state; cheap enough for ten times a second."""
        self._state = state
        self.rig.setText(state.rig_name or self.tr("No rig is connected"))
        self.rig.setToolTip(state.rig_name)
        self._show_words(state)
        running = state.mode == "program" and state.total > 0 and state.word is not Word.OFFLINE
        self.count.setVisible(running)
        self.bar.setVisible(running)
        if running:
            self.count.setText(self.tr("Braking {0} of {1}").format(state.braking, state.total))
            self.bar.setMaximum(state.total)
            self.bar.setValue(state.done)
            self.bar.setToolTip(
                self.tr("{0} complete, {1} broken off, {2} with squeal").format(
                    state.done, state.incomplete, state.squealing
                )
            )
        self.left.setVisible(running and state.left_s is not None)
        if state.left_s is not None:
            self.left.setText(self.tr("{0} left").format(time_text(state.left_s)))
        self.phase.setText(said(state.phase))
        self.disk.setVisible(state.disk_left_bytes is not None)
        if state.disk_left_bytes is not None:
            self.disk.setText(self.tr("{0} of disk left").format(bytes_text(state.disk_left_bytes)))
        if not state.commander:
            self.commander.setText("")
        elif state.commanding:
            self.commander.setText(self.tr("This window commands"))
        else:
            self.commander.setText(self.tr("{0} commands; this window watches").format(state.commander))

    def _show_words(self, state: RigState) -> None:
        self.kind.setVisible(state.simulated is not None)
        self.kind.setText(self.tr("SIMULATED") if state.simulated else self.tr("REAL RIG"))
        words = {
            Word.OFFLINE: self.tr("OFFLINE"),
            Word.STARTING: self.tr("STARTING"),
            Word.LOCKED: self.tr("LOCKED"),
            Word.READY: self.tr("READY"),
            Word.RUNNING: self.tr("RUNNING"),
            Word.PAUSED: self.tr("PAUSED"),
            Word.STOPPING: self.tr("STOPPING"),
            Word.TRIPPED: self.tr("TRIPPED"),
        }
        self.word.setText(("▲ " if state.word is Word.TRIPPED else "") + words[state.word])
        self._paint_word(state)
        cause = state.cause
        self.cause.setVisible(cause is not None)
        self.phase.setVisible(cause is None)
        if cause is not None:
            self.cause.setProperty("look", "alarm")
            self.cause.setText("▲ " + " ".join(said(part) for part in (cause.words, cause.remedy) if part))
            self.cause.style().polish(self.cause)

    def _paint_word(self, state: RigState) -> None:
        ground, ink = _LOOKS[state.word]
        t = self._theme.current
        self.word.setStyleSheet(
            f"background: {getattr(t, ground)}; color: {getattr(t, ink)}; border: 1px solid {t.line};"
            f"border-radius: 3px; padding: 0 {self._theme.px(1)}px;"
        )
        real = state.simulated is False
        self.kind.setStyleSheet(
            f"background: {t.text if real else t.panel}; color: {t.window if real else t.text};"
            f"border: 2px {'solid' if real else 'dashed'} {t.text}; padding: 0 {self._theme.px(1)}px;"
        )


class RigFrame(QWidget):
    """Border around the window: solid for a real rig, hatched for a simulated one, none without."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._simulated: bool | None = None
        width = theme.px(0.75)
        self.setContentsMargins(width, width, width, width)
        theme.changed.connect(self.update)

    def show_kind(self, simulated: bool | None) -> None:
        """True simulated, False real, None no rig."""
        if simulated is not self._simulated:
            self._simulated = simulated
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """See QWidget."""
        super().paintEvent(event)
        if self._simulated is None:
            return
        painter = QPainter(self)
        width = self.contentsMargins().left()
        ink = self._theme.colour("text")
        if self._simulated:
            painter.setPen(QPen(Qt.PenStyle.NoPen))
            brush = QBrush(ink, Qt.BrushStyle.BDiagPattern)
        else:
            brush = QBrush(ink)
        whole = QRectF(self.rect())
        inner = whole.adjusted(width, width, -width, -width)
        for edge in (
            QRectF(whole.left(), whole.top(), whole.width(), width),
            QRectF(whole.left(), inner.bottom(), whole.width(), width),
            QRectF(whole.left(), inner.top(), width, inner.height()),
            QRectF(inner.right(), inner.top(), width, inner.height()),
        ):
            painter.fillRect(edge, brush)
