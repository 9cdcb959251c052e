"""Section "Set-points": the three lists side by side, and the order in which they are worked through.

Not its job: what the lists mean together (`sequences.matrix`), the duration of orders (`orders`).
"""

from __future__ import annotations

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QScrollArea, QSizePolicy, QVBoxLayout, QWidget

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.forms import SequenceForm, SpeedRow, profile_rows
from rigctl.gui.pages.sequence.paste import parse_block, parse_list, parse_number, write_number
from rigctl.gui.pages.sequence.section import Faults, fault_text
from rigctl.gui.pages.sequence.words import one_or_many
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel
from rigctl.gui.widgets.range_filler import RangeFiller
from rigctl.gui.widgets.values_table import Row, ValuesTable
from sequences.ranges import expand_range


def _list_block(text: str, _columns: int) -> list[list[str]]:
    return [["", cell] for cell in parse_list(text)]


class ListColumn(QWidget):
    """One list: name, limits of the rig, sheet, what it holds, [Fill a range], faults."""

    valueChanged = Signal()

    def __init__(
        self, theme: ThemeKeeper, name: str, place: str, unit: str, tip: str, *, speeds: bool = False
    ) -> None:
        super().__init__()
        self._theme = theme
        self._unit = unit
        self._speeds = speeds
        symbol = "T" if place == "temperatures_degc" else "p"
        self.place = place
        self.name = QLabel(name)
        self.name.setProperty("look", "title")
        self.limits = QLabel()
        self.limits.setProperty("look", "muted")
        heads = (
            (self.tr("t\ns"), self.tr("n1\n1/min"), self.tr("n2\n1/min"))
            if speeds
            else (f"{symbol}\n{unit}",)
        )
        self.table = ValuesTable(theme, heads, parse_block if speeds else _list_block, grouped=speeds)
        self.table.setObjectName(f"field-{place}")
        self.table.setAccessibleName(name)
        self.table.setToolTip(tip)
        self.table.setMinimumHeight(theme.px(10))
        self.name.setBuddy(self.table)
        self.holds = QLabel()
        self.holds.setProperty("look", "muted")
        self.holds.setWordWrap(True)
        self.holds.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.fault = FaultLabel(theme)
        self.open_filler = QPushButton(self.tr("Fill a range …"))
        self.open_filler.setObjectName(f"fill-{place}")
        self.open_filler.setToolTip(self.tr("From … to … in equal steps"))
        self.open_filler.setCheckable(True)
        self.filler = RangeFiller(theme, expand_range, parse_number, duration=speeds)
        self.filler.setObjectName(f"range-{place}")
        self.filler.hide()
        self.open_filler.toggled.connect(self._on_open_filler)
        self.filler.filled.connect(self._on_filled)
        self.table.valueChanged.connect(self._on_edited)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        for widget, stretch in (
            (self.name, 0), (self.limits, 0), (self.table, 1), (self.holds, 0), (self.fault, 0),
            (self.open_filler, 0), (self.filler, 0),
        ):  # fmt: skip
            self._column.addWidget(widget, stretch)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._column.setSpacing(self._theme.px(0.5))
        self.holds.setFont(self._theme.font("small"))
        self.limits.setFont(self._theme.font("small"))
        self.setMinimumWidth(self._theme.px(26 if self._speeds else 13))

    def value(self) -> tuple[Row, ...]:
        """Rows of the sheet."""
        return self.table.value()

    def setValue(self, rows: tuple[Row, ...]) -> None:
        """Show rows; not an edit."""
        self.table.setValue(rows)
        self._describe()

    def show_limits(self, low: float, high: float) -> None:
        """What the rig takes."""
        self.limits.setText(self.tr("rig: {0:g} … {1:g} {2}").format(low, high, self._unit))

    def _on_edited(self, _rows: object) -> None:
        self._describe()
        self.valueChanged.emit()

    def _on_open_filler(self, on: bool) -> None:
        self.filler.setVisible(on)
        if on:
            self.filler.start.setFocus()
            QTimer.singleShot(0, self, self._show_filler)

    def _show_filler(self) -> None:
        """Scroll to it, when the section is higher than its place."""
        parent = self.parentWidget()
        while parent is not None and not isinstance(parent, QScrollArea):
            parent = parent.parentWidget()
        if parent is not None and self.filler.isVisible():
            parent.ensureWidgetVisible(self.filler)

    def _on_filled(self, values: list[float], duration: str) -> None:
        texts = [write_number(value) for value in values]
        rows = [("", duration, text, text) if self._speeds else ("", text) for text in texts]
        self.table.setValue(tuple(rows))
        self._describe()
        self.valueChanged.emit()

    def _describe(self) -> None:
        rows = self.table.value()
        if not rows:
            text = self.tr("Type in the list, paste from a spreadsheet, or fill a range.")
        elif self._speeds:
            groups = profile_rows(tuple(SpeedRow(joined=bool(row[0])) for row in rows))
            text = one_or_many(len(groups), self.tr("1 profile"), self.tr("{0} profiles"))
            if any(len(group) > 1 for group in groups):
                text += self.tr(", {0} segments").format(len(rows))
        else:
            text = one_or_many(len(rows), self.tr("1 value"), self.tr("{0} values"))
            if len(rows) > 1:
                text += self.tr(": {0} … {1} {2}").format(rows[0][1], rows[-1][1], self._unit)
        self.holds.setText(text)

    def show_faults(self, faults: Faults) -> None:
        """Below the list in words, in the list as frames."""
        found = faults.get(self.place, [])
        self.fault.setFault(*(fault_text(found) if found else ("", "error")))
        self.table.set_faults({cell: fault.text for fault in found for cell in fault.cells})


class Lists(QWidget):
    """The three lists. `edited` carries the place."""

    edited = Signal(str)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        typed = self.tr(
            "Type a number and press Enter; several at once, as in 5 10 15, fill several rows. Paste from "
            "a spreadsheet with Ctrl+V."
        )
        self.temperatures = ListColumn(
            theme, self.tr("&Temperatures"), "temperatures_degc", "°C",
            self.tr("Disc temperature at the start of each braking.") + "\n" + typed,
        )  # fmt: skip
        self.speeds = ListColumn(
            theme, self.tr("&Speed profiles"), "speed_profiles", "1/min",
            self.tr("Within t seconds from n1 to n2. A row marked + goes on with the profile above it "
            "(key +).")
            + "\n" + typed, speeds=True,
        )  # fmt: skip
        self.pressures = ListColumn(
            theme, self.tr("&Pressures"), "pressures_bar", "bar",
            self.tr("Working points of the brake pressure.") + "\n" + typed,
        )  # fmt: skip
        self.columns = (self.temperatures, self.speeds, self.pressures)
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        for column, stretch in zip(self.columns, (3, 6, 3), strict=True):
            self._row.addWidget(column, stretch)
            column.valueChanged.connect(lambda place=column.place: self.edited.emit(place))
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._row.setSpacing(self._theme.px(2))

    def value(self, form: SequenceForm) -> dict[str, tuple]:
        """The three lists as parts of a form."""
        return {
            "temperatures": tuple(row[1] for row in self.temperatures.value()),
            "speeds": tuple(SpeedRow(r[1], r[2], r[3], bool(r[0])) for r in self.speeds.value()),
            "pressures": tuple(row[1] for row in self.pressures.value()),
        }

    def setValue(self, form: SequenceForm) -> None:
        """Show the lists of a form."""
        self.temperatures.setValue(tuple(("", text) for text in form.temperatures))
        self.speeds.setValue(
            tuple(("+" if row.joined else "", row.duration, row.start, row.end) for row in form.speeds)
        )
        self.pressures.setValue(tuple(("", text) for text in form.pressures))
        self.temperatures.table.setEnabled(form.conditioning.enabled)
        self.temperatures.open_filler.setEnabled(form.conditioning.enabled)
        if not form.conditioning.enabled:
            self.temperatures.holds.setText(self.tr("Not used: the conditioning is off."))

    def show_rig(self, rig: RigConfig) -> None:
        """Limits above the lists."""
        can = rig.capabilities
        self.temperatures.show_limits(can.min_conditioning_degc, can.max_disc_temperature_degc)
        self.speeds.show_limits(can.min_speed_rpm, can.max_speed_rpm)
        self.pressures.show_limits(can.min_pressure_bar, can.max_pressure_bar)
