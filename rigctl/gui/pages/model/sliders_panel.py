"""The left column of the model page: friction, pressure, falling slope, and any parameter group.

Job: sliders that show and move `ModelState`. Not its job: what their values do.
"""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QModelIndex, Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QFrame,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.model.data import FACTORS, MU, OPERATING, PRESSURE, SLOPE, BrakeFacts
from rigctl.gui.pages.model.knob_list import KnobTable, rows_of
from rigctl.gui.pages.model.slider import KnobSlider
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.pages.model.words import DECIMALS, UNITS, knob_title, title_of
from rigctl.gui.theme import ThemeKeeper

_STEPS = {MU: 0.01, PRESSURE: 0.1, SLOPE: 0.0005}


class SlidersPanel(QWidget):
    """Sliders over one another; the group is chosen in a searchable list."""

    def __init__(self, state: ModelState, theme: ThemeKeeper) -> None:
        super().__init__()
        self._state, self._theme = state, theme
        self.chosen: str | None = None
        self._restoring = False
        self.sliders = {
            key: KnobSlider(theme, title_of(key, None), ends, _STEPS[key], DECIMALS[key], UNITS[key])
            for key, ends in OPERATING.items()
        }
        self.factor = KnobSlider(theme, "", FACTORS, 0.05, 3, logarithmic=True)
        self.search = QLineEdit()
        self.singles = QCheckBox(self.tr("Sin&gle quantities too"))
        self.only_changed = QCheckBox(self.tr("Only &changed"))
        self.table = QTableView()
        self.knobs = KnobTable(theme)
        self.reset_all = QPushButton(self.tr("&Reset all sliders"))
        self._dress()
        self._arrange()
        self._connect()
        theme.changed.connect(self._restyle)
        self._restyle()
        self.show_brake(None)

    def _dress(self) -> None:
        for key, slider in self.sliders.items():
            slider.setObjectName(f"slider-{key}")
        self.factor.setObjectName("slider-factor")
        self.search.setPlaceholderText(self.tr("Search, e.g. piston stiffness"))
        self.search.setToolTip(self.tr("Words of a group's name, in any order"))
        self.search.setClearButtonEnabled(True)
        self.singles.setToolTip(self.tr("Every number of the brake file, not only its groups"))
        self.only_changed.setToolTip(self.tr("Only what has another factor than 1"))
        self.reset_all.setToolTip(self.tr("All sliders back to the values of the brake file"))
        table = self.table
        table.setModel(self.knobs)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        table.setShowGrid(False)
        table.setWordWrap(False)
        table.setTabKeyNavigation(False)
        table.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        table.verticalHeader().hide()
        header = table.horizontalHeader()
        header.setHighlightSections(False)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.Fixed)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        table.setToolTip(self.tr("Choose what the slider below changes"))

    def _arrange(self) -> None:
        self._column = QVBoxLayout(self)
        for key in (MU, PRESSURE, SLOPE):
            self._column.addWidget(self.sliders[key])
        line = QFrame()
        line.setFrameShape(QFrame.Shape.HLine)
        self._column.addWidget(line)
        heading = QLabel(self.tr("Parameters of the brake"))
        heading.setProperty("look", "title")
        self._column.addWidget(heading)
        self._column.addWidget(self.search)
        self._checks = QHBoxLayout()
        self._checks.addWidget(self.singles)
        self._checks.addWidget(self.only_changed)
        self._checks.addStretch(1)
        self._column.addLayout(self._checks)
        self._column.addWidget(self.table, 1)
        self.nothing = QLabel(self.tr("Nothing of this name."))
        self.nothing.setProperty("look", "muted")
        self._column.addWidget(self.nothing)
        self._column.addWidget(self.factor)
        self._column.addWidget(self.reset_all)

    def _connect(self) -> None:
        for key, slider in self.sliders.items():
            slider.valueChanged.connect(partial(self._move, key))
            slider.resetAsked.connect(partial(self._reset, key))
        self.factor.valueChanged.connect(self._move_factor)
        self.factor.resetAsked.connect(self._reset_factor)
        self.reset_all.clicked.connect(self._reset_all)
        self.search.textChanged.connect(self._filter)
        self.singles.toggled.connect(self._filter)
        self.only_changed.toggled.connect(self._filter)
        self.table.selectionModel().currentRowChanged.connect(self._choose_row)
        self.knobs.modelReset.connect(self._restore_row)
        self._state.brakeRead.connect(self.show_brake)
        self._state.changed.connect(self.refresh)

    def _restyle(self) -> None:
        px = self._theme.px
        self._column.setContentsMargins(px(1), px(1), px(1), px(1))
        self._column.setSpacing(px(1))
        self._checks.setSpacing(px(1))
        self.table.verticalHeader().setDefaultSectionSize(px(3))
        self.table.setMinimumHeight(px(12))
        self.table.setColumnWidth(1, px(9))
        self.knobs.restyle()
        for slider in (*self.sliders.values(), self.factor):
            slider.setActive(False)
        self.refresh()

    # -- showing ----------------------------------------------------------------------------------

    def show_brake(self, facts: BrakeFacts | None) -> None:
        """Another brake, or none."""
        self.setEnabled(facts is not None)
        if facts is None or self.chosen not in {knob.key for knob in facts.knobs}:
            self.chosen = facts.knobs[0].key if facts is not None and facts.knobs else None
        self._filter()
        self.refresh()

    def refresh(self) -> None:
        """Show the state's values."""
        facts = self._state.facts
        if facts is None:
            return
        moved = set(self._state.changed_keys())
        for key, slider in self.sliders.items():
            slider.setValue(self._state.value(key))
            slider.setResettable(key in moved)
            slider.setActive(self._state.active == key)
        self.factor.setEnabled(self.chosen is not None)
        if self.chosen is not None:
            self.factor.setTitle(knob_title(facts.knob(self.chosen)))
            self.factor.setValue(self._state.value(self.chosen))
            self.factor.setResettable(self.chosen in moved)
            self.factor.setActive(self._state.active == self.chosen)
        self.reset_all.setEnabled(bool(moved))
        self._filter()

    def choose(self, key: str) -> None:
        """Lay the factor slider on another knob."""
        self.chosen = key
        self.refresh()
        self._restore_row()

    def _filter(self) -> None:
        facts = self._state.facts
        rows = [] if facts is None else rows_of(
            facts.knobs, self.search.text(), self._state.factors,
            singles=self.singles.isChecked(), changed_only=self.only_changed.isChecked(),
        )  # fmt: skip
        self.knobs.show(rows, self._state.factors)
        self.nothing.setVisible(facts is not None and not rows)

    def _restore_row(self) -> None:
        row = None if self.chosen is None else self.knobs.row_of(self.chosen)
        self._restoring = True
        if row is None:
            self.table.clearSelection()
        else:
            self.table.selectRow(row)
        self._restoring = False

    # -- a person's doings ------------------------------------------------------------------------

    def _choose_row(self, index: QModelIndex, _before: QModelIndex) -> None:
        if index.isValid() and not self._restoring:
            self.chosen = self.knobs.rows[index.row()].key
            self.refresh()

    def _move(self, key: str, value: float) -> None:
        self._state.set({key: value}, active=key)

    def _move_factor(self, value: float) -> None:
        if self.chosen is not None:
            self._state.set({self.chosen: value}, active=self.chosen)

    def _reset(self, key: str) -> None:
        self._state.reset([key])

    def _reset_all(self) -> None:
        self._state.reset()

    def _reset_factor(self) -> None:
        if self.chosen is not None:
            self._state.reset([self.chosen])
