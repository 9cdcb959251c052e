"""Fill a list: from … to … step … or count …, and for speeds how long each lasts.

Job: four small fields and [Fill]; what cannot be filled is said below. Not its job: the list.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pydantic_core import PydanticCustomError
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QGridLayout, QLabel, QPushButton, QWidget

from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel, PlainEdit, set_wrong

Expand = Callable[[Mapping[str, Any]], list[float]]
Read = Callable[[str], float | None]


class RangeFiller(QWidget):
    """`filled` carries the values and the duration ("" when it is not asked for)."""

    filled = Signal(list, str)

    def __init__(self, theme: ThemeKeeper, expand: Expand, read: Read, *, duration: bool = False) -> None:
        super().__init__()
        self._theme = theme
        self._expand, self._read = expand, read
        self.start, self.stop, self.step = PlainEdit(), PlainEdit(), PlainEdit()
        self.duration = PlainEdit() if duration else None
        self.by = QComboBox()
        self.by.addItems([self.tr("step"), self.tr("count")])
        self.by.setToolTip(self.tr("Distance of the values, or how many there are; both ends belong to them"))
        self.fill = QPushButton(self.tr("Fill the list"))
        self.fill.setToolTip(self.tr("Replace the list by this range"))
        self.fill.clicked.connect(self._on_fill)
        self.fault = FaultLabel(theme)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        tips = (
            (self.start, self.tr("First value")),
            (self.stop, self.tr("Last value; smaller than the first for a falling range")),
            (self.step, self.tr("Distance, or number of values")),
        )
        for edit, tip in tips:
            edit.setToolTip(tip)
            edit.setAlignment(Qt.AlignmentFlag.AlignRight)
            edit.returnPressed.connect(self._on_fill)
        self._grid.addWidget(self._label(self.tr("from")), 0, 0)
        self._grid.addWidget(self.start, 0, 1)
        self._grid.addWidget(self._label(self.tr("to")), 0, 2)
        self._grid.addWidget(self.stop, 0, 3)
        self._grid.addWidget(self.by, 1, 0, 1, 2)
        self._grid.addWidget(self.step, 1, 2, 1, 2)
        if self.duration is not None:
            self.duration.setText("12")
            self.duration.setAlignment(Qt.AlignmentFlag.AlignRight)
            self.duration.setToolTip(self.tr("How long each braking lasts"))
            self._grid.addWidget(self._label(self.tr("each for, s")), 0, 4)
            self._grid.addWidget(self.duration, 0, 5)
            self._grid.addWidget(self.fill, 1, 4, 1, 2)
            self._grid.setColumnStretch(5, 1)
        else:
            self._grid.addWidget(self.fill, 2, 0, 1, 4)
        self._grid.addWidget(self.fault, 3, 0, 1, 6 if duration else 4)
        self._grid.setColumnStretch(1, 1)
        self._grid.setColumnStretch(3, 1)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _label(self, text: str) -> QLabel:
        label = QLabel(text)
        label.setProperty("look", "muted")
        return label

    def _restyle(self) -> None:
        self._grid.setHorizontalSpacing(self._theme.px(0.75))
        self._grid.setVerticalSpacing(self._theme.px(0.5))

    def _on_fill(self) -> None:
        edits = (self.start, self.stop, self.step)
        numbers = [self._read(edit.text()) for edit in edits]
        for edit, number in zip(edits, numbers, strict=True):
            set_wrong(edit, "error" if number is None else "")
        start, stop, step = numbers
        if start is None or stop is None or step is None:
            self.fault.setFault(self.tr("Enter three numbers, for example from 2 to 30 step 2."))
            return
        table: dict[str, Any] = {"from": start, "to": stop}
        if self.by.currentIndex() == 0:
            table["step"] = step
        else:
            table["count"] = int(step) if step.is_integer() else step
        try:
            values = self._expand(table)
        except PydanticCustomError as error:
            context = error.context or {}
            self.fault.setFault(f"{error.message()}. {context.get('remedy', '')}")
            set_wrong(self.step, "error")
            return
        self.fault.setFault("")
        self.filled.emit(values, self.duration.text() if self.duration is not None else "")
