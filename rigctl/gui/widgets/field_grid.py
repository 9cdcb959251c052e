"""Fields under each other: name, input, unit, and below it what is wrong with the input.

Job: one grid for forms of raw texts; faults are shown by the field's place (its key). `PlainEdit` leaves
undo and redo to the page. Not its job: judging what is typed.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPlainTextEdit,
    QSizePolicy,
    QWidget,
)

from rigctl.gui.theme import ThemeKeeper

_STANDARD = QKeySequence.StandardKey


def _is_undo(event: QEvent) -> bool:
    """True for the question whether Ctrl+Z or Ctrl+Y is a shortcut of somebody else."""
    return (
        isinstance(event, QKeyEvent)
        and event.type() == QEvent.Type.ShortcutOverride
        and (event.matches(_STANDARD.Undo) or event.matches(_STANDARD.Redo))
    )


class PlainText(QPlainTextEdit):
    """A text of several lines whose Ctrl+Z and Ctrl+Y belong to the page."""

    def event(self, event: QEvent) -> bool:
        """Let the page's undo and redo pass."""
        if _is_undo(event):
            event.ignore()
            return False
        return super().event(event)


class PlainEdit(QLineEdit):
    """A line edit whose Ctrl+Z and Ctrl+Y belong to the page."""

    def event(self, event: QEvent) -> bool:
        """Let the page's undo and redo pass."""
        if _is_undo(event):
            event.ignore()
            return False
        return super().event(event)

    def setValue(self, text: str) -> None:
        """Show a text; where the cursor is does not change while the text is the same."""
        if text != self.text():
            self.setText(text)


def set_wrong(widget: QWidget, severity: str) -> None:
    """Give an input the look of a wrong ("error") or of a right one ("")."""
    wrong = "true" if severity == "error" else "false"
    if widget.property("wrong") != wrong:
        widget.setProperty("wrong", wrong)
        widget.style().unpolish(widget)
        widget.style().polish(widget)


class FaultLabel(QLabel):
    """What is wrong at a field; hidden while nothing is."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._severity = "error"
        self.setWordWrap(True)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.MinimumExpanding)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.hide()
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self.setFont(self._theme.font("small"))

    def setFault(self, text: str, severity: str = "error") -> None:
        """Show a text as "error" or "warning"; "" hides the label."""
        if severity != self._severity or self.property("look") is None:
            self._severity = severity
            self.setProperty("look", severity)
            self.style().unpolish(self)
            self.style().polish(self)
        mark = "▲ " if severity == "warning" else "✕ "
        self.setText("\n".join(mark + line for line in text.splitlines()))
        self.setVisible(bool(text))


class FieldGrid(QWidget):
    """Rows of name, input, unit and fault."""

    def __init__(self, theme: ThemeKeeper, field_units: float = 11) -> None:
        super().__init__()
        self._theme = theme
        self._field_units = field_units
        self._rows: dict[str, tuple[QWidget, FaultLabel, QLabel]] = {}
        self._units: dict[str, tuple[QLabel, ...]] = {}
        self._narrow: list[QWidget] = []
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setColumnStretch(1, 1)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._grid.setHorizontalSpacing(self._theme.px(1.5))
        self._grid.setVerticalSpacing(self._theme.px(0.5))
        for widget in self._narrow:
            widget.setFixedWidth(self._theme.px(self._field_units))

    @property
    def places(self) -> tuple[str, ...]:
        """Keys of the fields."""
        return tuple(self._rows)

    def add(self, place: str, name: str, widget: QWidget, unit: str = "", tip: str = "",
            *, wide: bool = False, stretch: bool = True) -> QWidget:  # fmt: skip
        """Add a row; returns the input. `wide`: its own width, and with `stretch` all that there is."""
        label = QLabel(name)
        label.setBuddy(widget)
        widget.setObjectName(f"field-{place}")
        widget.setToolTip(tip)
        label.setToolTip(tip)
        widget.setAccessibleName(name.replace("&", ""))
        row = 2 * len(self._rows)
        line = QHBoxLayout()
        line.setSpacing(self._theme.px(1))
        line.addWidget(widget, 1 if wide and stretch else 0)
        if wide and not stretch:
            line.addStretch(1)
        if not wide:
            widget.setSizePolicy(QSizePolicy.Policy.Fixed, widget.sizePolicy().verticalPolicy())
            self._narrow.append(widget)
            widget.setFixedWidth(self._theme.px(self._field_units))
        if unit or not wide:
            unit_label = QLabel(unit)
            unit_label.setProperty("look", "muted")
            line.addWidget(unit_label, 0 if wide else 1)
            self._units[place] = (unit_label,)
        fault = FaultLabel(self._theme)
        self._grid.addWidget(label, row, 0, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self._grid.addLayout(line, row, 1)
        self._grid.addWidget(fault, row + 1, 1)
        self._grid.setRowStretch(row, 0)
        self._grid.setRowStretch(row + 2, 1)  # what is left over stays below
        self._rows[place] = (widget, fault, label)
        return widget

    def set_fault(self, place: str, text: str, severity: str = "error") -> None:
        """Show what is wrong at a field; "" clears it."""
        widget, fault, _ = self._rows[place]
        set_wrong(widget, severity if text else "")
        fault.setFault(text, severity)

    def set_row_enabled(self, place: str, on: bool) -> None:
        """A field that has no effect now is greyed."""
        widget, _, label = self._rows[place]
        widget.setEnabled(on)
        label.setEnabled(on)

    def set_row_visible(self, place: str, on: bool) -> None:
        """A field that does not exist for the present choice is hidden."""
        widget, fault, label = self._rows[place]
        for each in (widget, label, *self._units.get(place, ())):
            each.setVisible(on)
        if not on:
            fault.setFault("")

    def focus(self, place: str) -> None:
        """Bring the keyboard to a field."""
        self._rows[place][0].setFocus(Qt.FocusReason.OtherFocusReason)
