"""The common plot of the live view: header with value and read-out, calm axes, mouse on the time axis.

Job: a graph in which nothing moves by itself; wheel and drag ask the shared group for another stretch;
cursors; words when there is nothing to see. Not its job: what is drawn (subclasses), menu and pictures
(`tools`).
"""

from __future__ import annotations

import time
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QObject, QPoint, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from rigctl.gui.live.axes import PlainAxis, RigTimeAxis
from rigctl.gui.live.data import LiveData
from rigctl.gui.live.graph import Graph
from rigctl.gui.live.groups import XGroup
from rigctl.gui.live.items import pen
from rigctl.gui.theme import ThemeKeeper

_WHEEL = 1.0015  # zoom per eighth of a degree: a notch is 20 %
_VALUE_EVERY_S = 0.2


class LiveViewBox(pg.ViewBox):
    """Wheel and drag change the horizontal stretch; with Ctrl, or over the vertical axis, the vertical."""

    xChosen = Signal(float, float)
    yChosen = Signal(float, float)
    followAsked = Signal()
    menuAsked = Signal(QPoint)

    def __init__(self) -> None:
        super().__init__(enableMenu=False, defaultPadding=0.0)
        self.setMouseEnabled(x=True, y=True)
        self.disableAutoRange()

    def _choose(self, axis: int, factor: float, shift: float, centre: float) -> None:
        low, high = self.viewRange()[axis]
        low, high = centre + (low - centre) * factor + shift, centre + (high - centre) * factor + shift
        (self.xChosen if axis == 0 else self.yChosen).emit(low, high)

    def wheelEvent(self, ev: Any, axis: int | None = None) -> None:
        """Zoom around the mouse."""
        if axis is None:
            axis = 1 if ev.modifiers() & Qt.KeyboardModifier.ControlModifier else 0
        centre = self.mapSceneToView(ev.scenePos())
        delta = ev.delta()  # Qt swaps the axes of a wheel that is turned with Alt
        self._choose(axis, _WHEEL**-delta, 0.0, centre.x() if axis == 0 else centre.y())
        ev.accept()

    def mouseDragEvent(self, ev: Any, axis: int | None = None) -> None:
        """Move with the mouse."""
        ev.accept()
        if ev.button() != Qt.MouseButton.LeftButton:
            return
        if axis is None:
            axis = 1 if ev.modifiers() & Qt.KeyboardModifier.ControlModifier else 0
        before, after = self.mapSceneToView(ev.lastScenePos()), self.mapSceneToView(ev.scenePos())
        shift = before.x() - after.x() if axis == 0 else before.y() - after.y()
        self._choose(axis, 1.0, shift, 0.0)

    def mouseClickEvent(self, ev: Any) -> None:
        """Right button: menu; double click: follow."""
        if ev.button() == Qt.MouseButton.RightButton:
            ev.accept()
            self.menuAsked.emit(ev.screenPos().toPoint())
        elif ev.double():
            ev.accept()
            self.followAsked.emit()


class LivePlot(QWidget):
    """One plot with its header. Subclasses add items to `graphics` and fill them in `draw`.

    Parameters
    ----------
    theme : ThemeKeeper
    group : XGroup
        Shared horizontal axis.
    title : str
        Quantity with unit, above the plot.
    x_axis : PlainAxis, optional
        Horizontal axis; rig time by default.
    """

    def __init__(self, theme: ThemeKeeper, group: XGroup, title: str, x_axis: PlainAxis | None = None,
                 y_axis: PlainAxis | None = None) -> None:  # fmt: skip
        super().__init__()
        self.theme = theme
        self.group = group
        self.data: LiveData | None = None
        self._manual_y: tuple[float, float] | None = None
        self._value_at = 0.0
        self._detail = 1.0
        self._hover: tuple[float, float] | None = None
        self.x_axis = x_axis or RigTimeAxis("bottom", theme)
        self.y_axis = y_axis or PlainAxis("left", theme)
        self.view = LiveViewBox()
        self.graphics = Graph(self.view, self.x_axis, self.y_axis)
        self._build(title)
        self.view.xChosen.connect(self._choose_x)
        self.view.yChosen.connect(self._choose_y)
        self.view.followAsked.connect(group.follow_again)
        self.view.menuAsked.connect(self._ask_menu)
        self._cursor_lines: list[pg.InfiniteLine] = []  # made when they are wanted: each costs time per frame
        group.followed.connect(self._end_manual_y)
        theme.changed.connect(self.take_look)
        self.view.scene().sigMouseMoved.connect(self._on_mouse)
        self.graphics.viewport().installEventFilter(self)
        self._take_own_look()

    menuAsked = Signal(object, QPoint)
    """This plot, and where on the screen: the right button was pressed."""
    resized = Signal()

    def _build(self, title: str) -> None:
        self.graphics.setMinimumHeight(self.theme.px(6))
        self.title = QLabel(title)
        self.value = QLabel()
        self.value.setTextFormat(Qt.TextFormat.RichText)
        self.readout = QLabel()
        self.readout.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.readout.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.cursor_text = QLabel()
        self.cursor_text.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.cursor_text.hide()
        self.hint = QLabel(self.graphics)
        self.hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.hint.setWordWrap(True)
        self.hint.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.hint.hide()
        for label, look in ((self.title, "title"), (self.readout, "muted"), (self.hint, "muted")):
            label.setProperty("look", look)
        self.header = QHBoxLayout()
        self.header.setSpacing(self.theme.px(1))
        self.header.addWidget(self.title)
        self.header.addWidget(self.value)
        self.header.addWidget(self.readout, 1)
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(0)
        self.column.addLayout(self.header)
        self.column.addWidget(self.cursor_text)
        self.column.addWidget(self.graphics, 1)
        self.setMinimumWidth(self.theme.px(30))

    # -- look -------------------------------------------------------------------------------------

    def take_look(self) -> None:
        """Colours and sizes of the present theme."""
        self._take_own_look()
        self.colour()

    def colour(self) -> None:
        """Give the items the colours of the present theme."""

    def _take_own_look(self) -> None:
        look = self.theme.current
        self.graphics.setBackground(look.plot)
        for axis in (self.x_axis, self.y_axis):
            axis.take_look()
        for label in (self.readout, self.cursor_text, self.value, self.title):
            label.setFont(self.theme.font("small", bold=label is self.title))
        self.cursor_text.setStyleSheet(f"color: {look.blue};")
        for line in self._cursor_lines:
            self._colour_cursor(line)
        self.column.setContentsMargins(self.theme.px(0.5), self.theme.px(0.25), self.theme.px(0.5), 0)

    def show_x_axis(self, shown: bool) -> None:
        """Numbers of the horizontal axis: off where a plot below shows them."""
        self.x_axis.setVisible(shown)

    # -- drawing ----------------------------------------------------------------------------------

    def refresh(self, data: LiveData) -> None:
        """Draw `data`; called for every frame in which something has changed."""
        self.data = data
        self.draw(data)
        now_s = time.monotonic()
        if now_s - self._value_at >= _VALUE_EVERY_S:
            self._value_at = now_s
            self._set_text(self.value, self.value_text(data))
            self._show_hover()
            self._show_cursors()

    def draw(self, data: LiveData) -> None:
        """Fill the items and set the ranges."""
        raise NotImplementedError

    def value_text(self, data: LiveData) -> str:
        """Present value for the header, rich text."""
        return ""

    def describe(self, x: float, y: float) -> str:
        """What is under the mouse."""
        return ""

    def cursor_value(self, x: float) -> float:
        """Value at a cursor, for the difference; NaN where there is none."""
        return float("nan")

    def cursor_words(self, a: float, b: float) -> str:
        """Both cursors and their difference in words."""
        return ""

    def pixels(self) -> int:
        """Width of the drawing area in the screen's own pixels."""
        return max(int(self.view.width() * self.graphics.devicePixelRatioF() * self._detail), 1)

    def draw_finer(self, detail: float) -> None:
        """Draw for a picture with so many times the screen's pixels; 1 again for the screen."""
        self._detail = detail
        if self.data is not None:
            self.draw(self.data)

    def set_ranges(self, x: tuple[float, float], y: tuple[float, float], *, room: bool = True) -> None:
        """Show this; a vertical range chosen by a person comes first. `room`: for the outermost numbers."""
        if self._manual_y is not None:
            y = self._manual_y
        elif room:
            space = (y[1] - y[0]) * 0.6 * self._text_height() / max(self.view.height(), 1.0)
            y = (y[0] - space, y[1] + space)
        (x0, x1), (y0, y1) = self.view.viewRange()
        new_x = x if (x0, x1) != x else None
        new_y = y if (y0, y1) != y else None
        if new_x is not None or new_y is not None:
            self.view.setRange(xRange=new_x, yRange=new_y, padding=0, disableAutoRange=False)
            self.view.prepareForPaint()  # now, not while painting: that would paint everything twice

    def _text_height(self) -> int:
        return self.value.fontMetrics().height()

    def show_hint(self, text: str) -> None:
        """Words over an empty plot; an empty text takes them away."""
        if self.hint.text() != text:
            self.hint.setText(text)
        self.hint.setVisible(bool(text))

    @staticmethod
    def _set_text(label: QLabel, text: str) -> None:
        if label.text() != text:
            label.setText(text)

    # -- mouse ------------------------------------------------------------------------------------

    def _choose_x(self, low: float, high: float) -> None:
        self.group.choose(low, high)

    def _choose_y(self, low: float, high: float) -> None:
        if high > low:
            self._manual_y = (low, high)
            self.group.changed.emit()

    def _end_manual_y(self) -> None:
        self._manual_y = None

    def _ask_menu(self, where: QPoint) -> None:
        self.menuAsked.emit(self, where)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """The mouse leaves: no read-out. The drawing area changes: hint and envelope follow."""
        if event.type() == QEvent.Type.Leave:
            self._hover = None
            self._show_hover()
        elif event.type() == QEvent.Type.Resize:
            self.hint.setGeometry(self.graphics.rect())
            self.resized.emit()
        return super().eventFilter(watched, event)

    def _on_mouse(self, position: Any) -> None:
        inside = self.view.sceneBoundingRect().contains(position)
        point = self.view.mapSceneToView(position) if inside else None
        self._hover = None if point is None else (point.x(), point.y())
        self._show_hover()

    def _show_hover(self) -> None:
        text = "" if self._hover is None or self.data is None else self.describe(*self._hover)
        self._set_text(self.readout, text)

    # -- cursors ----------------------------------------------------------------------------------

    def _make_cursor(self, number: int) -> pg.InfiniteLine:
        line = pg.InfiniteLine(
            angle=90,
            movable=True,
            label="AB"[number],
            labelOpts={"position": 1.0, "anchors": [(0, 0), (0, 0)]},
        )
        line.setZValue(50)
        line.sigDragged.connect(lambda moved: self.group.move_cursor(number, float(moved.value())))
        self._colour_cursor(line)
        self.graphics.add(line)
        return line

    def cursor_colour(self) -> str:
        """Of the cursors' lines."""
        return self.theme.current.blue

    def _colour_cursor(self, line: pg.InfiniteLine) -> None:
        colour = self.cursor_colour()
        line.setPen(pen(colour, 1.0, Qt.PenStyle.DashLine))
        line.setHoverPen(pen(colour, 3.0))
        line.label.setColor(colour)

    def _show_cursors(self) -> None:
        cursors = self.group.cursors
        self.cursor_text.setVisible(cursors is not None)
        if cursors is None:
            while self._cursor_lines:
                self.graphics.remove(self._cursor_lines.pop())
            return
        if not self._cursor_lines:
            self._cursor_lines = [self._make_cursor(number) for number in (0, 1)]
        for line, x in zip(self._cursor_lines, cursors, strict=True):
            if line.value() != x:
                line.setValue(x)
        if self.data is not None:
            self._set_text(self.cursor_text, self.cursor_words(*cursors))

    def update_cursors(self) -> None:
        """The shared cursors have moved or gone."""
        self._show_cursors()
