"""The table of brakings with filters above and actions below.

Job: one QTableView over `BrakingTableModel`; columns that can be chosen, moved and are remembered;
selection by file, kept while rows come, go and are sorted. Not its job: what happens with the chosen
brakings.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial
from typing import Any

from PySide6.QtCore import QItemSelection, QItemSelectionModel, QPoint, QSettings, Qt, Signal
from PySide6.QtGui import QKeySequence, QResizeEvent, QShortcut
from PySide6.QtWidgets import QAbstractItemView, QMenu, QProgressBar, QTableView, QVBoxLayout, QWidget

from rigctl.gui.pages.data.actions_bar import ActionsBar
from rigctl.gui.pages.data.columns import COLUMNS, state_text
from rigctl.gui.pages.data.entry import Entry
from rigctl.gui.pages.data.filter_bar import FilterBar
from rigctl.gui.pages.data.table_model import BrakingTableModel
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.elided import ElidedLabel

_PLACE = {column.key: number for number, column in enumerate(COLUMNS)}
_WIDTHS = {
    "index": 6, "start": 19, "sequence": 12, "role": 9, "set_pressure": 7, "set_temperature": 7, "mu": 8,
    "frequency": 7.5, "level": 7, "state": 11, "tags": 12, "remark": 30,
}  # fmt: skip
_LOW = 60
"""Below this height (units of the grid) the filters are folded."""


class TablePane(QWidget):
    """Brakings of one campaign."""

    selectionChanged = Signal(list)
    """Chosen entries, in the order of the table."""
    activated = Signal(object)
    """Double click or Enter on an entry."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.model = BrakingTableModel(theme)
        self.filters = FilterBar(theme)
        self.count = ElidedLabel()
        self.count.setObjectName("data-count")
        self.count.setProperty("look", "muted")
        self.progress = QProgressBar()
        self.progress.setObjectName("data-progress")
        self.progress.setFormat(self.tr("reading brakings … %p %"))
        self.progress.hide()
        self.view = QTableView()
        self.view.setObjectName("data-table")
        self.bar = ActionsBar(theme)
        self._column = QVBoxLayout(self)
        self._column.addWidget(self.filters)
        self._column.addWidget(self.count)
        self._column.addWidget(self.progress)
        self._column.addWidget(self.view, 1)
        self._column.addWidget(self.bar)
        self._quiet = False
        self._chosen: list[str] = []
        self._current = ""
        self._prepare_view()
        self.filters.valueChanged.connect(self.model.set_filter)
        for signal in (self.model.modelReset, self.model.rowsInserted, self.model.dataChanged):
            signal.connect(self._on_model)
        QShortcut(QKeySequence.StandardKey.Find, self, self.filters.text.setFocus)
        theme.changed.connect(self._restyle)
        self._restyle()
        self._count()

    def _prepare_view(self) -> None:
        view = self.view
        view.setModel(self.model)
        view.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        view.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        view.setAlternatingRowColors(True)
        view.setShowGrid(False)
        view.setWordWrap(False)
        view.setTabKeyNavigation(False)
        view.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        view.setToolTip(self.tr("Ctrl or Shift and click: several. Enter: large view. Delete: to the trash."))
        view.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerItem)
        view.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        view.verticalHeader().hide()
        header = view.horizontalHeader()
        header.setSectionsMovable(True)
        header.setHighlightSections(False)
        header.setStretchLastSection(True)
        header.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        header.customContextMenuRequested.connect(self._on_header_menu)
        header.setSectionsClickable(True)
        header.sectionClicked.connect(self._on_header)
        for number, column in enumerate(COLUMNS):
            view.setColumnHidden(number, not column.shown)
        view.selectionModel().selectionChanged.connect(self._on_selection)
        view.selectionModel().currentChanged.connect(self._on_current)
        view.activated.connect(lambda index: self.activated.emit(self.model.entry(index.row())))

    # -- selection ----------------------------------------------------------------------------------

    def chosen(self) -> list[Entry]:
        """Chosen entries that are shown, in the order of the table."""
        entries = [entry for name in self._chosen if (entry := self.model.list.get(name)) is not None]
        return sorted(entries, key=lambda entry: self.model.list.row_of(entry.name) or 0)

    def current(self) -> str:
        """File of the row with the focus."""
        return self._current

    def choose(self, names: Iterable[str], current: str = "") -> bool:
        """Choose these; a filter that hides the first of them is removed. False when there is none."""
        wanted = [name for name in names if self.model.list.get(name) is not None]
        if not wanted:
            return False
        current = current or wanted[0]
        if self.model.list.row_of(current) is None:
            self.filters.clear.click()
        self._chosen, self._current = wanted, current
        self._restore(current, scroll=True)
        self._tell()
        return True

    def _restore(self, current: str, *, scroll: bool = False) -> None:
        selection = QItemSelection()
        last = self.model.columnCount() - 1
        rows = sorted(row for name in self._chosen if (row := self.model.list.row_of(name)) is not None)
        for first, final in _stretches(rows):
            selection.select(self.model.index(first, 0), self.model.index(final, last))
        self._quiet = True
        chooser = self.view.selectionModel()
        row = self.model.list.row_of(current)
        if row is not None:
            index = self.model.index(row, max(self.view.horizontalHeader().logicalIndex(0), 0))
            chooser.setCurrentIndex(index, QItemSelectionModel.SelectionFlag.NoUpdate)
            if scroll:
                self.view.scrollTo(index)
        chooser.select(selection, QItemSelectionModel.SelectionFlag.ClearAndSelect)
        self._quiet = False

    def _on_model(self) -> None:
        """After news of the model the same files are chosen as before."""
        before = list(self._chosen)
        self._chosen = [name for name in before if self.model.list.row_of(name) is not None]
        self._restore(self._current)
        self.filters.set_tags(self.model.list.tags())
        self._tell()

    def _on_selection(self) -> None:
        if self._quiet:
            return
        stretches: Any = self.view.selectionModel().selection()  # a list of ranges
        rows = {row for part in stretches for row in range(part.top(), part.bottom() + 1)}
        self._chosen = [self.model.entry(row).name for row in sorted(rows)]
        self._tell()

    def _on_current(self, index: object) -> None:
        del index
        row = self.view.currentIndex().row()
        if 0 <= row < self.model.rowCount():
            self._current = self.model.entry(row).name

    def _tell(self) -> None:
        entries = self.chosen()
        self.bar.show_selection(entries)
        self._count()
        self.selectionChanged.emit(entries)

    def _count(self) -> None:
        shown = self.model.rowCount()
        here = self.model.list.count_here()
        words = self.tr("{0} of {1} brakings").format(shown, max(here, shown))
        words += " · " + self.tr("{0} squealing").format(self.model.list.squealing)
        if len(self._chosen) > 1:
            words += " · " + self.tr("{0} chosen").format(len(self._chosen))
        self.count.setText(words)

    def _on_header(self, number: int) -> None:
        """Sort by this column; again: the other way round. The shape in the header says which."""
        listing = self.model.list
        down = COLUMNS[number].key == listing.sort_by and not listing.descending
        self.model.sort(number, Qt.SortOrder.DescendingOrder if down else Qt.SortOrder.AscendingOrder)

    # -- columns ------------------------------------------------------------------------------------

    def _on_header_menu(self, place: QPoint) -> None:
        self.column_menu().popup(self.view.horizontalHeader().mapToGlobal(place))

    def column_menu(self) -> QMenu:
        """Columns to be switched on and off."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for number, column in enumerate(COLUMNS):
            text = column.title_text() + (f" [{column.unit}]" if column.unit else "")
            entry = menu.addAction(text)
            entry.setObjectName(f"column-{column.key}")
            entry.setCheckable(True)
            entry.setChecked(not self.view.isColumnHidden(number))
            entry.setEnabled(number > 0)
            entry.setToolTip(column.tip_text())
            entry.toggled.connect(partial(self._show_column, number))
        menu.addSeparator()
        menu.addAction(self.tr("As delivered")).triggered.connect(self.reset_columns)
        return menu

    def _show_column(self, number: int, shown: bool) -> None:
        self.view.setColumnHidden(number, not shown)

    def reset_columns(self) -> None:
        """Columns, widths and order as delivered."""
        header = self.view.horizontalHeader()
        for number, column in enumerate(COLUMNS):
            header.moveSection(header.visualIndex(number), number)
            self.view.setColumnHidden(number, not column.shown)
        self._widths()

    def shown_columns(self) -> list[str]:
        """Keys of the shown columns, from left to right."""
        header = self.view.horizontalHeader()
        order = [header.logicalIndex(place) for place in range(len(COLUMNS))]
        return [COLUMNS[number].key for number in order if not self.view.isColumnHidden(number)]

    def save(self, settings: QSettings) -> None:
        """Columns with widths, order of sorting, filter is not remembered: all is shown at the next start."""
        header = self.view.horizontalHeader()
        settings.setValue("filters", int(self.filters.open))
        settings.setValue("columns", ",".join(self.shown_columns()))
        widths = [f"{c.key}:{header.sectionSize(n)}" for n, c in enumerate(COLUMNS) if header.sectionSize(n)]
        settings.setValue("widths", ",".join(widths))
        settings.setValue("sort", f"{self.model.list.sort_by}:{int(self.model.list.descending)}")

    def restore(self, settings: QSettings) -> None:
        """As saved; unknown names are passed over."""
        self.filters.set_open(str(settings.value("filters", 1)) == "1")
        keys = [key for key in str(settings.value("columns", "")).split(",") if key in _PLACE]
        header = self.view.horizontalHeader()
        if keys:
            for number, column in enumerate(COLUMNS):
                self.view.setColumnHidden(number, column.key not in keys)
            for place, key in enumerate(keys):
                header.moveSection(header.visualIndex(_PLACE[key]), place)
        for part in str(settings.value("widths", "")).split(","):
            key, _, width = part.partition(":")
            if key in _PLACE and width.isdecimal():
                header.resizeSection(_PLACE[key], int(width))
        key, _, down = str(settings.value("sort", "")).partition(":")
        if key in _PLACE:
            order = Qt.SortOrder.DescendingOrder if down == "1" else Qt.SortOrder.AscendingOrder
            self.model.sort(_PLACE[key], order)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Where the pane becomes low, the filters give their room to the table."""
        super().resizeEvent(event)
        low = self._theme.px(_LOW)
        if event.size().height() < low and not 0 <= event.oldSize().height() < low:
            self.filters.set_open(False)

    # -- look ---------------------------------------------------------------------------------------

    def _restyle(self) -> None:
        u = self._theme.px
        self._column.setContentsMargins(u(1), u(1), u(1), u(1))
        self._column.setSpacing(u(1))
        self.view.setStyleSheet(f"QTableView::item {{ padding: 0 {u(0.75)}px; }}")
        self.view.verticalHeader().setDefaultSectionSize(u(3.25))
        self.view.verticalHeader().setMinimumSectionSize(u(2))
        self._widths()

    def _widths(self) -> None:
        header = self.view.horizontalHeader()
        metrics = header.fontMetrics()
        for number, column in enumerate(COLUMNS):
            wanted = self._theme.px(_WIDTHS.get(column.key, 8))
            words = str(self.model.headerData(number, Qt.Orientation.Horizontal) or "").splitlines()
            widest = max((metrics.horizontalAdvance(word) for word in words), default=0) + self._theme.px(2)
            if column.key == "state":  # the padding of cells is wider than that of titles
                widest = max(widest, metrics.horizontalAdvance(state_text("complete")) + self._theme.px(3.5))
            header.resizeSection(number, max(wanted, widest))


def _stretches(rows: list[int]) -> Iterator[tuple[int, int]]:
    """First and last of each stretch of consecutive numbers."""
    begin = end = None
    for row in rows:
        if begin is None or end is None:
            begin = end = row
        elif row == end + 1:
            end = row
        else:
            yield begin, end
            begin = end = row
    if begin is not None and end is not None:
        yield begin, end
