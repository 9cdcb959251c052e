"""Section "Set-points": order of the loops above the lists, and what other orders would take.

Not its job: the lists (`setpoints`), computing durations (`forecast`).
"""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QCoreApplication, Qt, Signal
from PySide6.QtWidgets import QComboBox, QGridLayout, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.forms import SequenceForm
from rigctl.gui.pages.sequence.section import Faults, Section, choose, fault_text
from rigctl.gui.pages.sequence.setpoints import Lists
from rigctl.gui.pages.sequence.words import long_time_text, name_of
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel
from rigctl.gui.widgets.order_chips import OrderChips
from sequences.braking import AXES, Axis
from sequences.estimate import DurationEstimate, LoopOrder


def order_text(order: tuple[str, ...]) -> str:
    """ "Temperature › Speed › Pressure"."""
    return " › ".join(name_of(axis) for axis in order)


class OrdersTable(QWidget):
    """Durations of the six orders, the shortest first, each with [Use]."""

    chosen = Signal(tuple)
    closed = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setColumnStretch(0, 1)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.hide()

    def _restyle(self) -> None:
        self._grid.setHorizontalSpacing(self._theme.px(2))
        self._grid.setVerticalSpacing(self._theme.px(0.5))

    def _clear(self) -> None:
        while (item := self._grid.takeAt(0)) is not None:
            widget = item.widget()
            if widget is not None:
                widget.hide()
                widget.deleteLater()

    def show_text(self, text: str) -> None:
        """A line instead of the table."""
        self._clear()
        self._grid.addWidget(QLabel(text), 0, 0)
        self.show()

    def show_durations(self, durations: dict[LoopOrder, DurationEstimate], present: LoopOrder) -> None:
        """Orders that take the same time (loops of one value) are shown once."""
        self._clear()
        lines: dict[DurationEstimate, LoopOrder] = {}
        for order, estimate in durations.items():
            if estimate not in lines or order == present:
                lines[estimate] = order
        close = QPushButton(self.tr("Close"))
        close.setToolTip(self.tr("Hide the other orders"))
        close.clicked.connect(self.closed)
        self._grid.addWidget(
            QLabel(self.tr("The whole program would take, with this sequence in the order")), 0, 0, 1, 2
        )
        self._grid.addWidget(close, 0, 2)
        for row, (estimate, order) in enumerate(sorted(lines.items(), key=lambda e: e[0].total_s), start=1):
            duration = QLabel(long_time_text(estimate.total_s))
            duration.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            duration.setToolTip(
                self.tr("{0} heating and cooling").format(
                    long_time_text(estimate.heating_s + estimate.cooling_s)
                )
            )
            use = QPushButton(self.tr("Used") if order == present else self.tr("Use"))
            use.setEnabled(order != present)
            use.setObjectName("use-" + "-".join(order))
            use.setToolTip(self.tr("Run the loops of this sequence in this order"))
            use.clicked.connect(lambda _checked=False, order=order: self.chosen.emit(order))
            for column, widget in enumerate((QLabel(order_text(order)), duration, use)):
                self._grid.addWidget(widget, row, column)
        self.show()


class SetpointsSection(Section):
    """Order and lists."""

    ordersAsked = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__(theme)
        self.processing = QComboBox()
        self.processing.setObjectName("field-processing")
        self.processing.addItem(self.tr("All combinations"), "loops")
        self.processing.addItem(self.tr("Entry by entry"), "lists")
        self.processing.setToolTip(
            self.tr(
                "All combinations: every temperature with every speed and every pressure.\n"
                "Entry by entry: the first ones together, then the second ones, …; a list of one value "
                "holds for all."
            )
        )
        self.chips = OrderChips(theme, {axis: name_of(axis) for axis in AXES})
        self.chips.setObjectName("loop-order")
        self.chips.setToolTip(
            self.tr("Order of the loops, outermost first. Drag a chip, or use Ctrl with the arrow keys.")
        )
        self.chips.setAccessibleName(self.tr("Order of the loops"))
        self.compare = QPushButton(self.tr("Compare …"))
        self.compare.setObjectName("compare-orders")
        self.compare.setToolTip(self.tr("How long the program takes with other orders of the loops"))
        self.compare.clicked.connect(self.ordersAsked)
        self.hint = QLabel()
        self.hint.setProperty("look", "muted")
        self.hint.setWordWrap(True)
        self.fault = FaultLabel(theme)
        self.orders = OrdersTable(theme)
        self.orders.setObjectName("loop-orders")
        self.orders.chosen.connect(self._on_order)
        self.orders.closed.connect(self.orders.hide)
        self.lists = Lists(theme)
        self.lists.edited.connect(lambda place: self.valueChanged.emit(place, False))
        self.chips.valueChanged.connect(self._on_order)
        self.processing.activated.connect(lambda _index: self.valueChanged.emit("processing", False))
        self._first, self._row = QHBoxLayout(), QHBoxLayout()
        self._first.addWidget(self.processing)
        self._first.addWidget(self.hint, 1)
        for widget in (self.chips, self.compare):
            self._row.addWidget(widget)
        self._row.addStretch(1)
        self._layout = QVBoxLayout(self)
        self._layout.addLayout(self._first)
        self._layout.addLayout(self._row)
        self._layout.addWidget(self.fault)
        self._layout.addWidget(self.orders)
        self._layout.addWidget(self.lists, 1)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._row.setSpacing(self.theme.px(1.5))
        self._first.setSpacing(self.theme.px(1.5))
        self._layout.setSpacing(self.theme.px(1))
        self.hint.setFont(self.theme.font("small"))

    @property
    def places(self) -> tuple[str, ...]:
        """See Section."""
        return ("processing", "loop_order", *(column.place for column in self.lists.columns))

    def _on_order(self, order: tuple[str, ...]) -> None:
        self.chips.setValue(order)
        self.valueChanged.emit("loop_order", False)

    def value(self, form: SequenceForm) -> SequenceForm:
        """See Section."""
        order: list[Axis] = [axis for key in self.chips.value() for axis in AXES if axis == key]
        return replace(
            form,
            processing=self.processing.currentData(),
            loop_order=(order[0], order[1], order[2]),
            **self.lists.value(form),
        )

    def setValue(self, form: SequenceForm) -> None:
        """See Section."""
        choose(self.processing, form.processing)
        self.chips.setValue(form.loop_order)
        loops = form.processing == "loops"
        self.chips.setEnabled(loops)
        self.compare.setEnabled(loops)
        self.hint.setText(_order_hint(form))
        self.lists.setValue(form)

    def show_faults(self, faults: Faults) -> None:
        """See Section."""
        found = faults.get("processing", []) + faults.get("loop_order", [])
        self.fault.setFault(*(fault_text(found) if found else ("", "error")))
        for column in self.lists.columns:
            column.show_faults(faults)

    def show_rig(self, rig: RigConfig | None) -> None:
        """See Section."""
        if rig is not None:
            self.lists.show_rig(rig)

    def focus(self, place: str) -> None:
        """See Section."""
        column = next((c for c in self.lists.columns if c.place == place), None)
        target = column.table if column is not None else self.processing
        target.setFocus(Qt.FocusReason.OtherFocusReason)


def _order_hint(form: SequenceForm) -> str:
    if form.processing == "lists":
        return QCoreApplication.translate(
            "sequence", "The first entries of the lists are run together, then the second ones, …"
        )
    outer, _, inner = form.loop_order
    text = QCoreApplication.translate(
        "sequence", "Outermost first: {0} changes most rarely, {1} with every braking."
    )
    return text.format(name_of(outer), name_of(inner))
