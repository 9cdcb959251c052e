"""Which brakings are to be shown: pressure, temperature, squeal, state, tag, words.

Job: fields that make a `BrakingFilter`, with the reason beside a field that cannot be read. Not its job:
filtering (`listing`).
"""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QLineEdit, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.pages.data.columns import state_text
from rigctl.gui.pages.data.entry import EXCLUDED, TRASHED, UNREADABLE
from rigctl.gui.pages.data.listing import COUNTED, BrakingFilter
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel, set_wrong
from rigctl.gui.widgets.flow import FlowLayout

Bounds = tuple[float | None, float | None]


class BoundsField(QWidget):
    """From and to of a quantity; an empty field is open. `value()` is (from, to)."""

    valueChanged = Signal()

    def __init__(self, theme: ThemeKeeper, key: str, name: str, unit: str) -> None:
        super().__init__()
        self._theme = theme
        self.low, self.high = QLineEdit(), QLineEdit()
        label, unit_label = QLabel(name), QLabel(unit)
        unit_label.setProperty("look", "muted")
        label.setBuddy(self.low)
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        for widget in (label, self.low, QLabel("–"), self.high, unit_label):
            self._row.addWidget(widget)
        for edit, side in ((self.low, "from"), (self.high, "to")):
            edit.setObjectName(f"data-filter-{key}-{side}")
            edit.setAlignment(Qt.AlignmentFlag.AlignRight)
            edit.textEdited.connect(self._on_edited)
        self.low.setPlaceholderText(self.tr("from"))
        self.high.setPlaceholderText(self.tr("to"))
        self.low.setToolTip(self.tr("Show set-points from this value; empty: all"))
        self.high.setToolTip(self.tr("Show set-points up to this value; empty: all"))
        self._value: Bounds = (None, None)
        self.problem = ""
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._row.setSpacing(self._theme.px(0.5))
        for edit in (self.low, self.high):
            edit.setFixedWidth(self._theme.px(6))

    def value(self) -> Bounds:
        """Bounds as last usable."""
        return self._value

    def setValue(self, bounds: Bounds) -> None:
        """Show bounds."""
        for edit, number in zip((self.low, self.high), bounds, strict=True):
            edit.setText("" if number is None else f"{number:g}")
        self._read()

    def _on_edited(self) -> None:
        self._read()
        self.valueChanged.emit()

    def _read(self) -> None:
        numbers: list[float | None] = []
        self.problem = ""
        for edit in (self.low, self.high):
            text = edit.text().strip().replace(",", ".")
            wrong = ""
            try:
                numbers.append(float(text) if text else None)
            except ValueError:
                wrong = self.tr("“{0}” is no number").format(edit.text())
                numbers.append(None)
            self.problem = self.problem or wrong
            set_wrong(edit, "error" if wrong else "")
        low, high = numbers
        if low is not None and high is not None and low > high:
            self.problem = self.tr("“from” is above “to”")
            set_wrong(self.high, "error")
        if not self.problem:
            self._value = (low, high)


class FilterBar(QWidget):
    """All filters. `value()` is a `BrakingFilter`."""

    valueChanged = Signal(object)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.pressure = BoundsField(theme, "pressure", self.tr("&p"), "bar")
        self.temperature = BoundsField(theme, "temperature", self.tr("&T"), "°C")
        self.squeal = QComboBox()
        self.squeal.setObjectName("data-filter-squeal")
        self.squeal.setToolTip(self.tr("With or without squeal"))
        for text, data in (
            (self.tr("Squeal or not"), None),
            (self.tr("With squeal"), True),
            (self.tr("Without squeal"), False),
        ):
            self.squeal.addItem(text, data)
        self.state = QComboBox()
        self.state.setObjectName("data-filter-state")
        self.state.setToolTip(self.tr("What counts, what is excluded, incomplete or in the trash"))
        self.state.addItem(self.tr("Any state"), "")
        self.state.addItem(self.tr("What counts"), COUNTED)
        for state in (EXCLUDED, "incomplete", "recovered", UNREADABLE, TRASHED):
            text = state_text(state)
            self.state.addItem(text[:1].upper() + text[1:], state)
        self.tag = QComboBox()
        self.tag.setObjectName("data-filter-tag")
        self.tag.setToolTip(self.tr("Brakings with this tag"))
        self.tag.addItem(self.tr("Any tag"), "")
        self.tag.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.text = QLineEdit()
        self.text.setObjectName("data-filter-text")
        self.text.setClearButtonEnabled(True)
        self.text.setPlaceholderText(self.tr("Words in notes (Ctrl+F)"))
        self.text.setToolTip(self.tr("Words in note, reason, tags, sequence or role"))
        self.clear = QPushButton(self.tr("Show all"))
        self.clear.setObjectName("data-filter-clear")
        self.clear.setToolTip(self.tr("Remove all filters"))
        self.clear.clicked.connect(lambda: self.setValue(BrakingFilter(), tell=True))
        self.fault = FaultLabel(theme)
        self.fault.setObjectName("data-filter-error")
        self.more = QPushButton()
        self.more.setObjectName("data-filter-more")
        self.more.setToolTip(self.tr("Show or hide the filters; hidden ones stay in force"))
        self._make_layout()
        for bounds in (self.pressure, self.temperature):
            bounds.valueChanged.connect(self._on_changed)
        for box in (self.squeal, self.state, self.tag):
            box.currentIndexChanged.connect(self._on_changed)
        self.text.textChanged.connect(self._on_changed)
        self._last = BrakingFilter()
        self._quiet = False
        theme.changed.connect(self._restyle)
        self._restyle()
        self._on_changed()

    def _make_layout(self) -> None:
        self._top = QHBoxLayout()
        self._top.addWidget(self.text, 1)
        self._top.addWidget(self.more)
        self._top.addWidget(self.clear)
        self._box = QWidget()
        self._flow = FlowLayout(self._box)
        for widget in (self.pressure, self.temperature, self.squeal, self.state, self.tag):
            self._flow.addWidget(widget)
        self.more.clicked.connect(lambda: self.set_open(not self.open))
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addLayout(self._top)
        self._column.addWidget(self._box)
        self._column.addWidget(self.fault)
        self.set_open(True)

    @property
    def open(self) -> bool:
        """True while the filters are seen."""
        return self._open

    def set_open(self, opened: bool) -> None:
        """Show or hide the filters; they stay in force."""
        self._open = opened
        self._box.setVisible(opened)
        self.more.setText(self.tr("&Filters ▾") if opened else self.tr("&Filters ▸"))

    def _restyle(self) -> None:
        self._flow.setSpacing(self._theme.px(1))
        self._top.setSpacing(self._theme.px(1))
        self._column.setSpacing(self._theme.px(1))

    def value(self) -> BrakingFilter:
        """What is wanted."""
        return BrakingFilter(
            self.pressure.value(), self.temperature.value(), self.squeal.currentData(),
            self.state.currentData(), self.tag.currentData() or "", self.text.text().strip(),
        )  # fmt: skip

    def setValue(self, wanted: BrakingFilter, *, tell: bool = False) -> None:
        """Show a filter."""
        self._quiet = True
        self.pressure.setValue(wanted.pressure_bar)
        self.temperature.setValue(wanted.temperature_degc)
        self.squeal.setCurrentIndex(max(self.squeal.findData(wanted.squeal), 0))
        self.state.setCurrentIndex(max(self.state.findData(wanted.state), 0))
        if wanted.tag and self.tag.findData(wanted.tag) < 0:
            self.tag.addItem(wanted.tag, wanted.tag)
        self.tag.setCurrentIndex(max(self.tag.findData(wanted.tag), 0))
        self.text.setText(wanted.text)
        self._quiet = False
        if tell:
            self._on_changed()
        else:
            self._last = self.value()
            self.clear.setEnabled(self._last != BrakingFilter())

    def set_tags(self, tags: list[str]) -> None:
        """Tags in use."""
        chosen = self.tag.currentData() or ""
        if [self.tag.itemData(i) for i in range(1, self.tag.count())] == tags:
            return
        self._quiet = True
        while self.tag.count() > 1:
            self.tag.removeItem(1)
        for tag in tags:
            self.tag.addItem(tag, tag)
        self._quiet = False
        self.tag.setCurrentIndex(max(self.tag.findData(chosen), 0))

    def _on_changed(self) -> None:
        if self._quiet:
            return
        self.fault.setFault(self.pressure.problem or self.temperature.problem)
        wanted = self.value()
        self.clear.setEnabled(wanted != BrakingFilter())
        if wanted != self._last:
            self._last = wanted
            self.valueChanged.emit(wanted)
