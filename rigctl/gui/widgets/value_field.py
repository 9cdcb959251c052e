"""A field for one number with its unit and limits beside it, and the reason of a refusal below it.

Job: typing, Enter (`committed`), the look of a wrong entry, and the set-point in force in blue. Not its job:
which limits hold, and what a number does (pages). The blank key is left to the page: a number has none.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QSizePolicy, QVBoxLayout, QWidget

from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.entries import EntryError, NumberRange


class NumberEdit(QLineEdit):
    """A line edit that leaves the space bar to the page."""

    def event(self, event: QEvent) -> bool:
        """Don't claim the space bar: on the manual page it releases the pressure."""
        blank = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Space
        if blank and event.type() in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress):
            event.ignore()
            return False
        return super().event(event)


class ValueField(QWidget):
    """One number. `value()` is None while the text is refused."""

    valueChanged = Signal(float)
    """With every edit that leaves a usable number."""
    edited = Signal()
    """With every edit, usable or not."""
    committed = Signal(float)
    """Enter was pressed on a usable number."""

    def __init__(self, theme: ThemeKeeper, limits: NumberRange, value: float | None = None) -> None:
        super().__init__()
        self._theme = theme
        self._limits = limits
        self._foreign_error = ""
        self.edit = NumberEdit()
        self.edit.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.edit.setFixedWidth(theme.px(10))
        self.limits = QLabel()
        self.limits.setProperty("look", "muted")
        self.in_force = QLabel()
        self.error = QLabel()
        self.error.setProperty("look", "error")
        self.error.setWordWrap(True)
        self.error.hide()
        policy = self.error.sizePolicy()
        policy.setHorizontalPolicy(QSizePolicy.Policy.Ignored)
        self.error.setSizePolicy(policy)
        self._row = QHBoxLayout()
        self._row.setContentsMargins(0, 0, 0, 0)
        self._row.addWidget(self.edit)
        self._row.addWidget(self.limits)
        self._row.addStretch(1)
        self._row.addWidget(self.in_force)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addLayout(self._row)
        column.addWidget(self.error)
        self.setFocusProxy(self.edit)
        self.edit.textEdited.connect(self._on_edited)
        self.edit.editingFinished.connect(self._on_finished)
        self.edit.returnPressed.connect(self._on_return)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.setLimits(limits)
        if value is not None:
            self.setValue(value)

    def setObjectName(self, name: str) -> None:
        """The edit has the name, so that mouse and keys of a test meet it; the error is NAME-error."""
        self.edit.setObjectName(name)
        self.error.setObjectName(f"{name}-error")
        super().setObjectName(f"{name}-field")

    def _restyle(self) -> None:
        self.limits.setFont(self._theme.font("small"))
        self.error.setFont(self._theme.font("small"))
        self.in_force.setStyleSheet(f"color: {self._theme.current.blue};")
        self.edit.setFixedWidth(self._theme.px(10))
        self._row.setSpacing(self._theme.px(1))
        layout = self.layout()
        if layout is not None:
            layout.setSpacing(self._theme.px(0.5))

    # -- value ------------------------------------------------------------------------------------

    def value(self) -> float | None:
        """The number, None when the text is refused."""
        try:
            return self._limits.read(self.edit.text())
        except EntryError:
            return None

    def setValue(self, value: float) -> None:
        """Show a number; no signal `committed`."""
        before = self.value()
        self.edit.setText(self._limits.show(value))
        self._check()
        if self.value() is not None and self.value() != before:
            self.valueChanged.emit(value)

    def setLimits(self, limits: NumberRange) -> None:
        """Other limits, e.g. of another rig."""
        self._limits = limits
        self.limits.setText(limits.text())
        self.edit.setAccessibleDescription(limits.text())
        if self.edit.text():
            self._check()

    def range(self) -> NumberRange:
        """What the field takes."""
        return self._limits

    def setInForce(self, value: float | None) -> None:
        """The set-point that is commanded now, in blue; None when there is none."""
        self.in_force.setText("" if value is None else "▸ " + self._limits.show(value))

    # -- errors -----------------------------------------------------------------------------------

    def problem(self) -> str:
        """Why the entry is refused, "" when it is not."""
        try:
            self._limits.read(self.edit.text())
        except EntryError as error:
            return str(error)
        return self._foreign_error

    def setError(self, text: str) -> None:
        """A reason that the page has found (e.g. together with another field); "" when there is none."""
        self._foreign_error = text
        self._check()

    def _check(self) -> bool:
        problem = self.problem()
        self.error.setText("▲ " + problem if problem else "")
        self.error.setVisible(bool(problem))
        wrong = "true" if problem else "false"
        if self.edit.property("wrong") != wrong:
            self.edit.setProperty("wrong", wrong)
            self.edit.style().polish(self.edit)
        return not problem

    def _on_edited(self, text: str) -> None:
        value = self.value()
        if value is not None or self._limits.hopeless(text):
            self._check()
        if value is not None:
            self.valueChanged.emit(value)
        self.edited.emit()

    def _on_finished(self) -> None:
        self._check()

    def _on_return(self) -> None:
        self._check()
        value = self.value()
        if value is not None:
            self.committed.emit(value)
