"""Right column, top and middle: rig, how many brakings, how long, how much data, and what is wrong.

Not its job: computing (`forecast`), starting (`start_panel`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QGridLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from rigctl.config.rig import RigConfig
from rigctl.gui.format import bytes_text
from rigctl.gui.pages.sequence.checking import Fault
from rigctl.gui.pages.sequence.forms import ProgramForm
from rigctl.gui.pages.sequence.words import brakings_text, long_time_text, place_name
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.split_bar import SplitBar
from sequences.check import CheckResult


class RigChoice(QWidget):
    """Which rig the program is held against."""

    valueChanged = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._rigs: dict[Path, RigConfig] = {}
        self.combo = QComboBox()
        self.combo.setObjectName("rig-choice")
        self.combo.setToolTip(
            self.tr("Limits and channels are those of this rig, and it is the one that is started")
        )
        self.combo.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.combo.setMinimumContentsLength(12)
        self.combo.activated.connect(lambda _index: self.valueChanged.emit())
        label = QLabel(self.tr("R&ig"))
        label.setProperty("look", "muted")
        label.setBuddy(self.combo)
        self.kind = QLabel()
        self.kind.setObjectName("rig-choice-kind")
        self.kind.setProperty("look", "title")
        self.combo.currentIndexChanged.connect(lambda _index: self._show_kind())
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setHorizontalSpacing(theme.px(1))
        layout.setVerticalSpacing(theme.px(0.25))
        layout.addWidget(label, 0, 0)
        layout.addWidget(self.kind, 0, 1, Qt.AlignmentFlag.AlignRight)
        layout.addWidget(self.combo, 1, 0, 1, 2)

    def _show_kind(self) -> None:
        rig = self.rig
        simulated = rig is None or rig.simulated
        self.kind.setText("" if rig is None else self.tr("simulated") if simulated else self.tr("REAL RIG"))

    def set_rigs(self, rigs: dict[Path, RigConfig], wanted: Path | None) -> None:
        """Offer rigs; choose `wanted` or the first."""
        self._rigs = dict(rigs)
        with QSignalBlocker(self.combo):
            self.combo.clear()
            for path, rig in rigs.items():
                self.combo.addItem(rig.name, str(path))
                self.combo.setItemData(self.combo.count() - 1, str(path), Qt.ItemDataRole.ToolTipRole)
            index = self.combo.findData(str(wanted)) if wanted is not None else -1
            self.combo.setCurrentIndex(max(index, 0) if rigs else -1)
        self._show_kind()

    @property
    def rigs(self) -> dict[Path, RigConfig]:
        """What is offered."""
        return self._rigs

    @property
    def path(self) -> Path | None:
        """File of the chosen rig."""
        data = self.combo.currentData()
        return Path(data) if data else None

    @property
    def rig(self) -> RigConfig | None:
        """The chosen rig."""
        path = self.path
        return self._rigs.get(path) if path is not None else None


class Figures(QWidget):
    """Count, duration and its parts, data volume."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.count, self.duration, self.data = QLabel(), QLabel(), QLabel()
        self.count.setObjectName("count-of-brakings")
        self.duration.setObjectName("duration")
        self.data.setObjectName("data-volume")
        self.duration.setProperty("look", "title")
        self.data.setProperty("look", "muted")
        for label in (self.duration, self.data):
            label.setWordWrap(True)
        self.bar = SplitBar(theme)
        self.parts = QLabel()
        self.parts.setObjectName("duration-parts")
        self.parts.setProperty("look", "muted")
        self.parts.setWordWrap(True)
        tip = self.tr("Estimated from heat and rates of the rig, good enough to plan a night")
        for widget in (self.bar, self.duration, self.parts):
            widget.setToolTip(tip)
        self.data.setToolTip(self.tr("Samples before compression; the disk is the one of the data folder"))
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        for widget in (self.count, self.duration, self.bar, self.parts, self.data):
            self._column.addWidget(widget)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._column.setSpacing(self._theme.px(0.5))
        self.count.setFont(self._theme.font("large"))
        for label in (self.parts, self.data):
            label.setFont(self._theme.font("small"))

    def show_count(self, count: int | None) -> None:
        """Known at once, before anything is estimated."""
        self.count.setText(brakings_text(count))

    def show_waiting(self, text: str) -> None:
        """An estimate is under way; the parts of the last one stay."""
        self.duration.setText(text)

    def show_nothing(self, why: str) -> None:
        """Nothing can be estimated."""
        self.duration.setText(why)
        for widget in (self.bar, self.parts, self.data):
            widget.hide()

    def show_check(self, check: CheckResult, disk_left: int | None) -> None:
        """Estimated duration and volume."""
        e = check.estimate
        for widget in (self.bar, self.parts, self.data):
            widget.show()
        conditioning, other = e.heating_s + e.cooling_s, e.soaking_s + e.other_s
        self.duration.setText(self.tr("about {0}").format(long_time_text(e.total_s)))
        self.parts.setText(
            self.tr("▨ {0} heating and cooling   ■ {1} braking   □ {2} other").format(
                long_time_text(conditioning), long_time_text(e.braking_s), long_time_text(other)
            )
        )
        self.bar.setValue(
            ((conditioning, "muted", True), (e.braking_s, "muted", False), (other, "field", False))
        )
        text = self.tr("{0} of data").format(bytes_text(check.data_bytes))
        if disk_left is not None:
            text += self.tr(", {0} of disk left").format(bytes_text(disk_left))
        self.data.setText(text)


class FaultList(QWidget):
    """Everything that is wrong; a click leads to the field."""

    chosen = Signal(int, str)
    """(sequence, field)."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.title = QLabel()
        self.title.setProperty("look", "title")
        self.list = QListWidget()
        self.list.setObjectName("fault-list")
        self.list.setWordWrap(True)
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setToolTip(self.tr("Click: go to the field"))
        self.list.itemClicked.connect(self._on_item)
        self.list.itemActivated.connect(self._on_item)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addWidget(self.title)
        self._column.addWidget(self.list)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.hide()

    def _restyle(self) -> None:
        self._column.setSpacing(self._theme.px(0.5))
        self.list.setFont(self._theme.font("small"))
        self._fit()

    def _fit(self) -> None:
        """As high as its entries need, within bounds; more scroll."""
        units = min(max(4 * self.list.count() + 1, 6), 15)
        self.list.setMinimumHeight(self._theme.px(min(units, 8)))
        self.list.setMaximumHeight(self._theme.px(units))

    def show_faults(self, faults: list[Fault], form: ProgramForm) -> None:
        """Errors first."""
        names = {sequence.uid: sequence.name for sequence in form.sequences}
        ordered = sorted(faults, key=lambda fault: fault.severity != "error")
        errors = sum(fault.severity == "error" for fault in faults)
        warnings = len(faults) - errors
        words = []
        if errors:
            words.append(self.tr("1 error") if errors == 1 else self.tr("{0} errors").format(errors))
        if warnings:
            words.append(self.tr("1 warning") if warnings == 1 else self.tr("{0} warnings").format(warnings))
        self.title.setText(", ".join(words))
        self.list.clear()
        for fault in ordered:
            mark = "✕ " if fault.severity == "error" else "▲ "
            where = ", ".join(part for part in (names.get(fault.uid, ""), place_name(fault.place)) if part)
            item = QListWidgetItem(mark + (f"{where}: " if where else "") + fault.text)
            item.setToolTip(f"{fault.note}\n".lstrip() + self.tr("Click: go to the field"))
            item.setData(Qt.ItemDataRole.UserRole, (fault.uid, fault.place))
            if fault.severity == "error":
                item.setForeground(self._theme.colour("red"))
            self.list.addItem(item)
        self._fit()
        self.setVisible(bool(faults))

    def _on_item(self, item: QListWidgetItem) -> None:
        uid, place = item.data(Qt.ItemDataRole.UserRole)
        self.chosen.emit(uid, place)
