"""Small widgets that the tabs of the Service page share.

Job: a form of named inputs, the list of faults, headlines, read-only tables. Not its job: what is in them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFormLayout,
    QFrame,
    QHeaderView,
    QLabel,
    QProgressBar,
    QScrollArea,
    QSizePolicy,
    QTableView,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from rigctl.calibration.fault import Fault
from rigctl.gui.pages.service.fault_words import fault_said
from rigctl.gui.theme import ThemeKeeper

RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter


def set_look(widget: QWidget, look: str) -> None:
    """Give a widget another look of the style sheet."""
    if widget.property("look") != look:
        widget.setProperty("look", look)
        widget.style().polish(widget)


def set_wrong(widget: QWidget, wrong: bool) -> None:
    """Frame an input that is refused."""
    word = "true" if wrong else "false"
    if widget.property("wrong") != word:
        widget.setProperty("wrong", word)
        widget.style().polish(widget)


def label(text: str = "", look: str = "", *, wrap: bool = False) -> QLabel:
    """A label; a wrapping one takes the width that there is."""
    made = QLabel(text)
    if look:
        made.setProperty("look", look)
    if wrap:
        made.setWordWrap(True)
        made.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
    return made


def pad_cells(table: QTableView, theme: ThemeKeeper) -> None:
    """Some room left and right of what stands in a cell."""
    pad = theme.px(0.75)
    table.setStyleSheet(
        f"QTableView::item {{ padding: 0 {pad}px; }} QHeaderView::section {{ padding: {pad}px; }}"
    )


class ScrollColumn(QScrollArea):
    """A part that scrolls up and down, never sideways: when text is large or the window is small."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__()
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setWidget(widget)
        self._inner = widget

    def minimumSizeHint(self) -> QSize:
        """As wide as what is in it wants."""
        inner = self._inner.minimumSizeHint().width()
        return QSize(inner + self.verticalScrollBar().sizeHint().width(), super().minimumSizeHint().height())


def scrolled(widget: QWidget) -> ScrollColumn:
    """Short for `ScrollColumn`."""
    return ScrollColumn(widget)


class ThinBar(QProgressBar):
    """A thin bar of progress, 0 to 100, that keeps its place while it is empty."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.setRange(0, 100)
        self.setTextVisible(False)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self.setFixedHeight(self._theme.px(0.75))


class Panel(QFrame):
    """A framed part with a title; `body` takes what is in it."""

    def __init__(self, theme: ThemeKeeper, title: str = "") -> None:
        super().__init__()
        self._theme = theme
        self.setProperty("look", "panel")
        self.title = label(title, "title")
        self.title.setVisible(bool(title))
        self.body = QVBoxLayout(self)
        self.body.addWidget(self.title)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        unit = self._theme.px(1)
        self.body.setContentsMargins(2 * unit, unit, 2 * unit, 2 * unit)
        self.body.setSpacing(unit)


class Form(QWidget):
    """Names and inputs under each other."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._layout = QFormLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setLabelAlignment(LEFT)
        self._layout.setFormAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        self._layout.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self._layout.setRowWrapPolicy(QFormLayout.RowWrapPolicy.DontWrapRows)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._layout.setVerticalSpacing(self._theme.px(1))
        self._layout.setHorizontalSpacing(self._theme.px(2))

    def add(self, name: str, field: QWidget, tip: str = "") -> None:
        """One row; "&" in the name makes its key."""
        caption = QLabel(name)
        caption.setBuddy(field)
        caption.setMinimumWidth(self._theme.px(18))
        if tip:
            caption.setToolTip(tip)
            field.setToolTip(tip)
        self._layout.addRow(caption, field)


class FaultList(QLabel):
    """What speaks against a result: reason and remedy, a mark before each that forbids saving."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._faults: tuple[Fault, ...] = ()
        self.setWordWrap(True)
        self.setTextFormat(Qt.TextFormat.RichText)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        theme.changed.connect(self._show)

    def show_faults(self, faults: Iterable[Fault]) -> None:
        """Show these; none hides the list."""
        self._faults = tuple(faults)
        self._show()

    def _show(self) -> None:
        t = self._theme.current
        lines = []
        for fault in self._faults:
            colour = t.red if fault.fatal else t.text
            mark = "▲" if fault.fatal else "△"
            lines.append(
                f'<p style="margin: 0 0 4px 0">'
                f'<span style="color: {colour}">{mark} {_escaped(fault_said(fault.words))}.</span> '
                f'<span style="color: {t.muted}">{_escaped(fault_said(fault.remedy))}</span></p>'
            )
        self.setText("".join(lines))
        self.setVisible(bool(lines))


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


class PlainTable(QTableWidget):
    """A table to be read; whole rows are selected.

    Parameters
    ----------
    heads : sequence of str
    stretch : int
        Column that takes the width that is left.
    """

    def __init__(self, theme: ThemeKeeper, heads: Sequence[str], stretch: int = -1) -> None:
        super().__init__(0, len(heads))
        self._theme = theme
        self.setHorizontalHeaderLabels(list(heads))
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.verticalHeader().hide()
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setDefaultAlignment(LEFT)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        if stretch >= 0:
            header.setSectionResizeMode(stretch, QHeaderView.ResizeMode.Stretch)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        pad_cells(self, self._theme)
        self.verticalHeader().setDefaultSectionSize(self._theme.px(3.25))
        for row in range(self.rowCount()):
            self.setRowHeight(row, self._theme.px(3.25))

    def align_head(self, column: int, alignment: Qt.AlignmentFlag) -> None:
        """Alignment of a column's name."""
        item = self.horizontalHeaderItem(column)
        if item is not None:
            item.setTextAlignment(alignment)

    def show_rows(self, rows: Sequence[Sequence[str]], right: frozenset[int] = frozenset()) -> None:
        """Show texts; columns of numbers on the right."""
        self.setRowCount(len(rows))
        for column in right:
            self.align_head(column, RIGHT)
        for number, cells in enumerate(rows):
            for column, text in enumerate(cells):
                item = self.item(number, column)
                if item is None:
                    item = QTableWidgetItem()
                    item.setTextAlignment(RIGHT if column in right else LEFT)
                    self.setItem(number, column, item)
                if item.text() != text:
                    item.setText(text)
                    item.setToolTip(text)
