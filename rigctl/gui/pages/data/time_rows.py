"""All channels of a braking below each other on one time axis, the spectrogram among them.

Job: rows that can be switched on and off, events and marks drawn into them, one cursor with the values
below the mouse, zoom by wheel along the time. Not its job: reading the braking, tables.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QGuiApplication
from PySide6.QtWidgets import QMenu

from rigctl.analysis.braking_view import LEVEL, MU, BrakingView, SoundPicture
from rigctl.core.channels import DISC_TEMPERATURE, MICROPHONE, PRESSURE, SPEED, TORQUE
from rigctl.gui.format import number_text
from rigctl.gui.pages.data.marks import Mark
from rigctl.gui.pages.data.row import FewTicks, Row
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.file_asking import ask_save
from rigctl.gui.widgets.plot_dress import save_picture

SPECTROGRAM = "spectrogram"
ROWS = (SPECTROGRAM, MICROPHONE, LEVEL, PRESSURE, TORQUE, SPEED, DISC_TEMPERATURE, MU)
DECIMALS = {LEVEL: 1, PRESSURE: 1, TORQUE: 0, SPEED: 1, DISC_TEMPERATURE: 0, MU: 3, MICROPHONE: 3}
_TALL = 3
_LEAST_FIRST = (SPEED, LEVEL, DISC_TEMPERATURE, TORQUE, MU, PRESSURE, MICROPHONE)
"""Rows that give way first where there is little room."""
_LEAST_HEIGHT = 4.25


class TimeRows(pg.GraphicsLayoutWidget):
    """The plots of one braking."""

    timePointed = Signal(float)
    """Time below the mouse, s; NaN when it has left."""
    timeClicked = Signal(float)

    def __init__(self, theme: ThemeKeeper, notify: Callable[[str], None]) -> None:
        super().__init__()
        self._theme, self._notify = theme, notify
        self.setObjectName("data-rows")
        self.setMinimumHeight(0)
        self.titles: dict[str, tuple[str, str]] = {}
        self.shown: set[str] = {name for name in ROWS if name != LEVEL}
        self._view: BrakingView | None = None
        self._marks: Sequence[Mark] = ()
        self._rows: dict[str, Row] = {}
        self._play_s: float | None = None
        scene: Any = self.scene()
        scene.sigMouseMoved.connect(self._on_mouse)
        scene.sigMouseClicked.connect(self._on_click)
        theme.changed.connect(self._restyle)

    # -- contents -----------------------------------------------------------------------------------

    def show_view(self, view: BrakingView | None, marks: Sequence[Mark] = ()) -> None:
        """Draw a braking, from its beginning to its end."""
        self._view, self._marks = view, marks
        self.ci.setVisible(view is not None)
        if view is None:  # the rows are kept for the next braking
            return
        if list(self._rows) == self._names_that_fit():
            self._fill()
        else:
            self._build()
        self.show_all()

    def available(self) -> list[str]:
        """Rows for which the present braking has values."""
        if self._view is None:
            return []
        return [
            n for n in ROWS if n in self._view.curves or (n == SPECTROGRAM and self._view.picture is not None)
        ]

    def set_shown(self, name: str, shown: bool) -> None:
        """Switch a row on or off; the stretch of time stays."""
        (self.shown.add if shown else self.shown.discard)(name)
        self._rebuild()

    def span(self) -> tuple[float, float] | None:
        """Stretch of time that is shown, s."""
        row = self._first()
        if row is None:
            return None
        low, high = row.item.vb.viewRange()[0]
        return float(low), float(high)

    def set_span(self, start_s: float, end_s: float) -> None:
        """Show a stretch of time."""
        row = self._first()
        if row is not None:
            row.item.setXRange(start_s, end_s, padding=0)

    def show_all(self) -> None:
        """From the first sample to the last, all values."""
        if self._view is None:
            return
        self.set_span(0.0, max(float(self._view.summary.get("duration_s") or 1.0), 0.1))
        for row in self._rows.values():
            row.show_all_values()

    def show_event(self, start_s: float, end_s: float) -> None:
        """Show an event with a second around it."""
        self.set_span(start_s - 0.5, end_s + 0.5)

    def set_play(self, time_s: float | None) -> None:
        """Where the sound is; None when it is not played."""
        self._play_s = time_s
        for row in self._rows.values():
            row.play.setVisible(time_s is not None)
            if time_s is not None:
                row.play.setPos(time_s)

    def _rebuild(self) -> None:
        """Make the rows anew; the stretch of time stays."""
        span = self.span()
        self._build()
        if span is not None:
            self.set_span(*span)

    # -- making -------------------------------------------------------------------------------------

    def _first(self) -> Row | None:
        return next(iter(self._rows.values()), None)

    def _build(self) -> None:
        """Make the rows; kept as long as their names and the look are the same."""
        self.ci.clear()
        self._rows = {}
        names = self._names_that_fit()
        layout: Any = self.ci.layout
        layout.setVerticalSpacing(self._theme.px(0.25))
        layout.setContentsMargins(*[self._theme.px(0.5)] * 4)
        layout.setHorizontalSpacing(0)
        layout.setColumnFixedWidth(0, self._theme.px(8.5))
        time_name = self.tr("Time since the first sample [s]")
        first: Row | None = None
        for number, name in enumerate(names):
            axis = FewTicks(self._theme)
            item: Any = self.ci.addPlot(row=number, col=1, enableMenu=False, axisItems={"left": axis})
            row = Row(self._theme, item, name, time_name if number == len(names) - 1 else "")
            self.ci.addItem(row.title, row=number, col=0)
            self._rows[name] = row
            first = first or row
            if row is not first:
                item.setXLink(first.item)
        self._fill()
        self._share_height()

    def _fill(self) -> None:
        """Put the present braking into the rows."""
        view = self._view
        for name, row in self._rows.items():
            row.empty()
            if view is None:
                continue
            if name == SPECTROGRAM and view.picture is not None:
                row.show_picture(view.picture, view.summary["events"])
            elif name in view.curves:
                row.show_curve(view.curves[name])
            row.show_marks(self._marks)
            row.show_all_values()
            self._say(row, None)
        self.set_play(self._play_s)

    def _names_that_fit(self) -> list[str]:
        """Rows that are switched on, as far as they are not too low to be read."""
        names = [name for name in self.available() if name in self.shown]
        for name in _LEAST_FIRST:
            if len(names) > 1 and name in names and self._unit(names) < self._theme.px(_LEAST_HEIGHT):
                names.remove(name)
        return names

    def _unit(self, names: Sequence[str]) -> float:
        """Height of a curve, px."""
        edges = self._theme.px(1) + self._theme.px(0.25) * max(len(names) - 1, 0) + self._theme.px(4.5)
        parts = sum(_TALL if name == SPECTROGRAM else 1 for name in names)
        return max((self.height() - edges) / max(parts, 1), 1.0)

    def _share_height(self) -> None:
        """The spectrogram is three times as high as a curve, the last row has the time axis below it."""
        layout: Any = self.ci.layout
        axis = self._theme.px(4.5)
        names = list(self._rows)
        unit = self._unit(names)
        for number in range(layout.rowCount()):
            name = names[number] if number < len(names) else ""
            height = unit * (_TALL if name == SPECTROGRAM else 1) if name else 0.0
            layout.setRowFixedHeight(number, height + (axis if number == len(names) - 1 else 0))

    def resizeEvent(self, event: Any) -> None:
        """Share the new height."""
        super().resizeEvent(event)
        if not hasattr(self, "_rows"):  # called while it is being made
            return
        if list(self._rows) == self._names_that_fit():
            self._share_height()
        else:
            self._rebuild()

    # -- reading ------------------------------------------------------------------------------------

    def values_at(self, time_s: float) -> dict[str, float]:
        """Value of each curve at a time."""
        if self._view is None:
            return {}
        found = {}
        for name, curve in self._view.curves.items():
            place = round((time_s - curve.t0_s) / curve.dt_s)
            if 0 <= place < len(curve.values):
                found[name] = float(curve.values[place])
        return found

    def _say(self, row: Row, values: dict[str, float] | None) -> None:
        """Name and unit beside the row; with a cursor the value before the unit."""
        name, unit = self.titles.get(row.name, (row.name, ""))
        second = unit
        if values is not None and row.name in values:
            number = number_text(values[row.name], DECIMALS.get(row.name, 2))
            second = f"<b>{number}</b> {unit}"
        row.write(name, second)

    def _row_at(self, place: Any) -> tuple[Row, float, float] | None:
        for row in self._rows.values():
            if row.item.vb.sceneBoundingRect().contains(place):
                point = row.item.vb.mapSceneToView(place)
                return row, float(point.x()), float(point.y())
        return None

    def _on_mouse(self, place: Any) -> None:
        found = self._row_at(place)
        if found is None:
            self._point(None, None)
            return
        row, x, y = found
        self._point(x, y if row.name == SPECTROGRAM else None)

    def _point(self, time_s: float | None, f_khz: float | None) -> None:
        values = None if time_s is None else self.values_at(time_s)
        for row in self._rows.values():
            row.cursor.setVisible(time_s is not None)
            if time_s is not None:
                row.cursor.setPos(time_s)
            self._say(row, values)
        spectrogram = self._rows.get(SPECTROGRAM)
        if spectrogram is not None and time_s is not None and f_khz is not None and self._view is not None:
            level = _level_at(self._view.picture, time_s, f_khz * 1e3)
            if level is not None:
                spectrogram.write(f"{f_khz * 1e3:.0f} Hz", f"<b>{level:.0f}</b> dB")
        self.timePointed.emit(float("nan") if time_s is None else time_s)

    def leaveEvent(self, event: Any) -> None:
        """The mouse has left: no cursor."""
        self._point(None, None)
        super().leaveEvent(event)

    def _on_click(self, event: Any) -> None:
        found = self._row_at(event.scenePos())
        if found is not None and event.button() == Qt.MouseButton.LeftButton:
            self.timeClicked.emit(found[1])

    # -- picture ------------------------------------------------------------------------------------

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Right click: whole braking, copy, save."""
        self.menu().popup(event.globalPos() if event.globalPos() else QPoint())
        event.accept()

    def menu(self) -> QMenu:
        """The menu, made anew."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for text, action in (
            (self.tr("Whole braking"), self.show_all),
            (self.tr("Copy picture"), self.copy_picture),
            (self.tr("Save picture…"), self._ask_picture),
        ):
            menu.addAction(text).triggered.connect(partial(_call, action))
        return menu

    def copy_picture(self) -> None:
        """To the clipboard."""
        QGuiApplication.clipboard().setPixmap(self.grab())
        self._notify(self.tr("Picture copied"))

    def _ask_picture(self) -> None:
        ask_save(
            self,
            self.tr("Save picture"),
            Path.home() / "braking.png",
            self.tr("Picture (*.png)"),
            lambda path: save_picture(self, path, self._notify),
        )

    def _restyle(self) -> None:
        self.setBackground(self._theme.current.plot)
        self._rebuild()


def _call(action: Callable[[], object], _checked: bool = False) -> None:
    action()


def _level_at(picture: SoundPicture | None, time_s: float, f_hz: float) -> float | None:
    if picture is None:
        return None
    frame = round((time_s - picture.t0_s) / picture.dt_s)
    line = round(f_hz / picture.line_hz)
    frames, lines = picture.level_db.shape
    return float(picture.level_db[frame, line]) if 0 <= frame < frames and 0 <= line < lines else None
