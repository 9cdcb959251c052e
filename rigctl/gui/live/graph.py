"""A bare plot: one view, a left and a bottom axis.

Job: pyqtgraph's view and axes laid out in a graphics view. pyqtgraph's own PlotItem brings four axes, a
title, buttons and a menu with forms, which a window with nine plots would build in vain at its start. Not
its job: header, mouse, items.
"""

from __future__ import annotations

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGraphicsGridLayout, QGraphicsItem

from rigctl.gui.live.axes import PlainAxis


class Graph(pg.GraphicsView):
    """View with two axes.

    Parameters
    ----------
    view : ViewBox
    x_axis, y_axis : PlainAxis
    """

    def __init__(self, view: pg.ViewBox, x_axis: PlainAxis, y_axis: PlainAxis) -> None:
        super().__init__()
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.enableMouse(False)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)  # nothing in it is for the tab key
        self.view = view
        frame = pg.GraphicsWidget()
        grid = QGraphicsGridLayout()
        grid.setContentsMargins(0.0, 0.0, 0.0, 0.0)
        grid.setHorizontalSpacing(0.0)
        grid.setVerticalSpacing(0.0)
        frame.setLayout(grid)
        grid.addItem(y_axis, 0, 0)
        grid.addItem(view, 0, 1)
        grid.addItem(x_axis, 1, 1)
        grid.setRowStretchFactor(0, 100)
        grid.setColumnStretchFactor(1, 100)
        for axis in (x_axis, y_axis):
            axis.linkToView(view)
            axis.setZValue(0.5)
        view.setZValue(-100)
        self.setCentralItem(frame)

    def add(self, item: QGraphicsItem) -> None:
        """Draw an item in the view; it takes no part in ranges."""
        self.view.addItem(item, ignoreBounds=True)

    def remove(self, item: QGraphicsItem) -> None:
        """Draw it no more."""
        self.view.removeItem(item)
