"""The drawn course: temperature, speed and pressure over the time of the first brakings of a sequence.

Job: three plots with one time axis, read-out, zoom, copy and save. Not its job: computing (`forecast`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.format import number_text, time_text
from rigctl.gui.pages.sequence.forecast import Course
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.file_asking import ask_save

SHOWN = (3, 10, 60)
_TRACES = ("temperature", "speed", "pressure")


class CoursePlots(QWidget):
    """Course of one sequence. `setCourse` is its input."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._course: Course | None = None
        self._manual = False
        self.title = QLabel()
        self.title.setProperty("look", "title")
        self.title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.shown = QComboBox()
        self.shown.setObjectName("preview-shown")
        for count in SHOWN:
            self.shown.addItem(self.tr("first {0}").format(count), count)
        self.shown.setCurrentIndex(1)
        self.shown.setToolTip(self.tr("How many brakings of the sequence are drawn"))
        self.shown.activated.connect(lambda _index: self.follow_all())
        self.whole = QPushButton(self.tr("Show all"))
        self.whole.setObjectName("preview-whole")
        self.whole.setToolTip(self.tr("Back to the whole time axis"))
        self.whole.clicked.connect(self.follow_all)
        self.view: Any = pg.GraphicsLayoutWidget()
        self.view.setObjectName("preview-plots")
        self.view.setAccessibleName(self.tr("Drawn course of the first brakings"))
        self.view.setMinimumSize(theme.px(16), theme.px(20))
        self.view.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
        self.view.ci.layout.setSpacing(0)
        self.view.ci.layout.setContentsMargins(0, 0, theme.px(0.5), 0)
        self.readout = QLabel()
        self.readout.setProperty("look", "muted")
        self.plots: dict[str, Any] = {}
        self.curves: dict[str, Any] = {}
        self._lines: list[Any] = []
        self._build()
        theme.changed.connect(self._restyle)
        self._restyle()
        self.setCourse(None)

    def _build(self) -> None:
        names = {
            "temperature": (self.tr("T"), "°C"), "speed": (self.tr("n"), "1/min"),
            "pressure": (self.tr("p"), "bar"),
        }  # fmt: skip
        first: Any = None
        for row, key in enumerate(_TRACES):
            plot = self.view.addPlot(row=row, col=0)
            name, unit = names[key]
            plot.setLabel("left", f"{name} / {unit}")
            plot.setMouseEnabled(x=True, y=False)
            plot.setMenuEnabled(False)
            plot.hideButtons()
            plot.setDownsampling(auto=True, mode="peak")
            plot.setClipToView(True)
            plot.showGrid(x=True, y=True, alpha=0.15)
            plot.getAxis("left").enableAutoSIPrefix(False)
            plot.enableAutoRange(x=False, y=True)
            if first is None:
                first = plot
            else:
                plot.setXLink(first)
            if row < len(_TRACES) - 1:
                plot.getAxis("bottom").setStyle(showValues=False)
            self.plots[key] = plot
            self.curves[key] = plot.plot()
            line = pg.InfiniteLine(angle=90, movable=False)
            line.hide()
            plot.addItem(line, ignoreBounds=True)
            self._lines.append(line)
            plot.getViewBox().sigRangeChangedManually.connect(self._on_manual)
        self.braking = self.plots["pressure"].plot(connect="finite")
        bottom = self.plots["pressure"].getAxis("bottom")
        bottom.enableAutoSIPrefix(False)
        self.plots["pressure"].setLabel("bottom", self.tr("time / min"))
        self.view.scene().sigMouseMoved.connect(self._on_mouse)
        self.view.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.view.customContextMenuRequested.connect(self._menu)
        top = QHBoxLayout()
        top.addWidget(self.title, 1)
        top.addWidget(self.whole)
        top.addWidget(self.shown)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.addLayout(top)
        self._layout.addWidget(self.view, 1)
        self._layout.addWidget(self.readout)

    def _restyle(self) -> None:
        t, theme = self._theme.current, self._theme
        self._layout.setSpacing(theme.px(0.5))
        self.readout.setFont(theme.font("small"))
        self.view.setBackground(t.plot)
        colours = {"temperature": t.temperature, "speed": t.speed, "pressure": t.pressure}
        small = theme.font("small")
        for key, plot in self.plots.items():
            for side in ("left", "bottom"):
                axis = plot.getAxis(side)
                axis.setPen(t.plot_line)
                axis.setTextPen(t.muted)
                axis.setStyle(tickFont=small)
                axis.label.setFont(small)
            plot.getAxis("left").setWidth(theme.px(8))
            self.curves[key].setPen(pg.mkPen(colours[key], width=1))
        self.braking.setPen(pg.mkPen(t.blue, width=2))
        for line in self._lines:
            line.setPen(pg.mkPen(t.muted, style=Qt.PenStyle.DashLine))

    # -- value ------------------------------------------------------------------------------------

    def value(self) -> Course | None:
        """The course that is drawn."""
        return self._course

    def setCourse(self, course: Course | None, why_none: str = "") -> None:
        """Draw a course; a range chosen by hand stays. None: nothing, and why."""
        self._course = course
        self.readout.setText(" ")
        self.whole.setVisible(self._manual)
        if course is None:
            for curve in (*self.curves.values(), self.braking):
                curve.setData([], [])
            self.title.setText(why_none or self.tr("Course"))
            return
        minutes = course.t_s / 60.0
        data = {
            "temperature": course.temperature_degc,
            "speed": course.speed_rpm,
            "pressure": course.pressure_bar,
        }
        for key, curve in self.curves.items():
            curve.setData(minutes, data[key])
        self.braking.setData(*self._brakings(course))
        self.title.setText(self.tr("From braking {0}").format(course.first_index))
        if not self._manual:
            self._show_range()

    def _brakings(self, course: Course) -> tuple[np.ndarray, np.ndarray]:
        """Pressure within brakings only, with gaps between."""
        begin, end = course.spans[:, 0], course.spans[:, 1]
        number = np.searchsorted(begin, course.t_s + 1e-9) - 1
        inside = (number >= 0) & (course.t_s <= end[np.maximum(number, 0)] + 1e-9)
        return course.t_s / 60.0, np.where(inside, course.pressure_bar, np.nan)

    def _show_range(self) -> None:
        course = self._course
        if course is None or not len(course.spans):
            return
        last = min(int(self.shown.currentData()), len(course.spans))
        end_s = course.t_s[-1] if last == len(course.spans) else course.spans[last - 1, 1]
        self.plots["temperature"].setXRange(0.0, end_s / 60.0, padding=0.02)
        for plot in self.plots.values():
            plot.enableAutoRange(y=True)

    def follow_all(self) -> None:
        """Forget the range chosen by hand."""
        self._manual = False
        self.whole.hide()
        self._show_range()

    # -- hands ------------------------------------------------------------------------------------

    def _on_manual(self, *_args: Any) -> None:
        self._manual = True
        self.whole.show()

    def _on_mouse(self, place: QPointF) -> None:
        course = self._course
        box = self.plots["pressure"].getViewBox()
        inside = course is not None and any(
            plot.sceneBoundingRect().contains(place) for plot in self.plots.values()
        )
        for line in self._lines:
            line.setVisible(inside)
        if course is None or not inside:
            self.readout.setText(" ")
            return
        minute = box.mapSceneToView(place).x()
        for line in self._lines:
            line.setPos(minute)
        self.readout.setText(self.text_at(minute * 60.0))

    def text_at(self, t_s: float) -> str:
        """Read-out at a time."""
        course = self._course
        if course is None or not len(course.t_s):
            return ""
        values = (
            np.interp(t_s, course.t_s, trace)
            for trace in (course.temperature_degc, course.speed_rpm, course.pressure_bar)
        )
        degc, rpm, bar = (number_text(float(value), 1) for value in values)
        inside = np.flatnonzero((course.spans[:, 0] <= t_s) & (t_s <= course.spans[:, 1]))
        what = self.tr("braking {0}").format(course.first_index + int(inside[0])) if len(inside) else ""
        return f"{time_text(t_s)}   {degc}\u202f°C   {rpm}\u202f1/min   {bar}\u202fbar   {what}"

    def _menu(self, place: Any) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for text, function in (
            (self.tr("Copy the picture"), self.copy_picture),
            (self.tr("Save the picture …"), self._ask_picture_file),
            (self.tr("Show all"), self.follow_all),
        ):
            action = QAction(text, menu)
            action.triggered.connect(function)
            menu.addAction(action)
        menu.popup(self.view.mapToGlobal(place))

    def copy_picture(self) -> None:
        """The plots to the clipboard."""
        QApplication.clipboard().setPixmap(self.view.grab())

    def _ask_picture_file(self) -> None:
        ask_save(
            self, self.tr("Save the picture"), Path("course.png"), self.tr("Picture (*.png)"),
            lambda path: self.view.grab().save(str(path)),
        )  # fmt: skip
