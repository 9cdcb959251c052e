"""The bottom row: record a braking.

Job: duration, comment, noise rating, [Start braking]; while it is recorded, the time left. Not its job: which
speed and pressure (the boxes above), doing it (page).
"""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.format import time_text
from rigctl.gui.pages.manual.model import Permission
from rigctl.gui.pages.manual.motion_boxes import labelled, permit
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.entries import NumberRange
from rigctl.gui.widgets.rating_row import RatingRow
from rigctl.gui.widgets.value_field import ValueField

_STEPS = 1000


class RecordRow(QWidget):
    """`startAsked` carries duration in s and comment; `rated` the noise rating."""

    startAsked = Signal(float, str)
    rated = Signal(int)
    changed = Signal()
    refused = Signal(str)

    def __init__(self, theme: ThemeKeeper, limits: NumberRange) -> None:
        super().__init__()
        self.setObjectName("record-row")
        self.setProperty("look", "panel")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self._theme = theme
        self._permission = Permission(False)
        self.title = QLabel(self.tr("Record a braking"))
        self.title.setProperty("look", "title")
        self.what = QLabel()
        self.what.setObjectName("record-what")
        self.what.setWordWrap(True)
        self.duration = ValueField(theme, limits, 12.0)
        self.duration.setObjectName("record-duration")
        self.duration.setToolTip(self.tr("How long the pressure is on"))
        self.duration.limits.hide()
        self.comment = QLineEdit()
        self.comment.setObjectName("record-comment")
        self.comment.setMaxLength(500)
        self.comment.setPlaceholderText(self.tr("comment, stored with the braking"))
        self.comment.setToolTip(self.tr("Stored with the braking and shown on the Data page"))
        self.rating = RatingRow(theme, "manual-rating")
        self.start = QPushButton(self.tr("Start bra&king"))
        self.start.setObjectName("start-braking")
        self.start.setProperty("look", "primary")
        self.bar = QProgressBar()
        self.bar.setObjectName("record-left")
        self.bar.setRange(0, _STEPS)
        self._build()
        self.start.clicked.connect(self._on_start)
        self.duration.committed.connect(self._on_start)
        self.comment.returnPressed.connect(self._on_start)
        self.duration.valueChanged.connect(self.changed)
        self.duration.edited.connect(self.changed)
        self.rating.valueChanged.connect(self.rated)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.setProgress(None)

    def _build(self) -> None:
        self._first = QHBoxLayout()
        self._first.addWidget(self.title)
        self.what.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self._first.addWidget(self.what, 100)
        self._first.addStretch(1)
        self._first.addWidget(QLabel(self.tr("Noise rating")))
        self._first.addWidget(self.rating)
        self._second = QHBoxLayout()
        self._entries: list[QWidget] = [
            labelled(self.tr("Duration in s"), self.duration),
            self.duration,
            labelled(self.tr("Comme&nt"), self.comment),
            self.comment,
        ]
        for widget in self._entries:
            self._second.addWidget(widget, 1 if widget is self.comment else 0)
        self._second.addWidget(self.bar, 1)
        self._second.addWidget(self.start)
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._first)
        self._column.addLayout(self._second)

    def _restyle(self) -> None:
        t = self._theme
        self._column.setContentsMargins(*(t.px(1),) * 4)
        self._column.setSpacing(t.px(1))
        self._first.setSpacing(t.px(2))
        self._second.setSpacing(t.px(1))
        self.bar.setMinimumHeight(self.start.sizeHint().height())

    # -- value ------------------------------------------------------------------------------------

    def value(self) -> tuple[float, str] | None:
        """(duration, comment); None while the duration is refused."""
        duration = self.duration.value()
        return None if duration is None else (duration, self.comment.text().strip())

    def setValue(self, duration_s: float, comment: str) -> None:
        """Fill the row."""
        self.duration.setValue(duration_s)
        self.comment.setText(comment)

    def setWhat(self, text: str, problem: str) -> None:
        """What would be recorded, or why it cannot be."""
        self.what.setText("▲ " + problem if problem else text)
        look = "error" if problem else "muted"
        if self.what.property("look") != look:
            self.what.setProperty("look", look)
            self.what.style().polish(self.what)

    def setPermission(self, permission: Permission, may_rate: Permission) -> None:
        """Whether it may be started now."""
        self._permission = permission
        permit(
            self.start, permission,
            self.tr("Spins up to the speed, applies the pressure for the duration, and stores every signal"),
        )  # fmt: skip
        self.rating.setEnabled(may_rate.allowed)

    def setProgress(self, progress: tuple[float, float | None] | None) -> None:
        """(s gone, s left or None when unknown) while a braking is recorded, else None."""
        self.bar.setVisible(progress is not None)
        for widget in (*self._entries, self.what):
            widget.setVisible(progress is None)
        self.title.setText(self.tr("Record a braking") if progress is None else self.tr("Recording"))
        if progress is None:
            return
        gone_s, left_s = progress
        if left_s is None:
            self.bar.setRange(0, 0)
            return
        self.bar.setRange(0, _STEPS)
        total_s = gone_s + left_s
        self.bar.setValue(round(_STEPS * gone_s / total_s) if total_s > 0 else 0)
        self.bar.setFormat(self.tr("recording, {0} left").format(time_text(left_s)))

    def _on_start(self, _value: object = None) -> None:
        value = self.value()
        if not self._permission.allowed:
            self.refused.emit(self._permission.reason)
        elif value is not None:
            self.startAsked.emit(*value)
