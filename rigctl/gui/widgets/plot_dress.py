"""The look of a plot, and its picture: colours of the theme, names of axes with units, copy and save.

Job: `dress` (once and with every change of look), `PictureMenu` (right click: copy, save, and what a page
adds). Not its job: what is plotted.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QObject, QPoint, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QMenu, QWidget

from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.file_asking import ask_save


def dress(plot: pg.PlotWidget, theme: ThemeKeeper, x_name: str, y_name: str) -> None:
    """Background, axes and their names in the present look."""
    t = theme.current
    plot.setBackground(t.plot)
    item: Any = plot.getPlotItem()
    for side, name in (("bottom", x_name), ("left", y_name)):
        axis = item.getAxis(side)
        axis.setPen(pg.mkPen(t.plot_line))
        axis.setTextPen(pg.mkPen(t.text))
        axis.setTickFont(theme.font("small"))
        axis.label.setFont(theme.font("normal"))
        axis.setLabel(name, siPrefixEnableRanges=(), color=t.text)
        axis.enableAutoSIPrefix(False)
    item.getAxis("left").setWidth(theme.px(8))
    item.getAxis("bottom").setHeight(theme.px(5.5))


class PictureMenu(QObject):
    """Right click on a plot: copy or save its picture; `add` lays further actions above."""

    def __init__(self, plot: pg.PlotWidget, name: str, notify: Callable[[str], None]) -> None:
        super().__init__(plot)
        self._plot, self._name, self._notify = plot, name, notify
        self._further: list[tuple[str, Callable[[], object]]] = []
        plot.setMenuEnabled(False)
        item: Any = plot.getPlotItem()
        scene: Any = plot.scene()
        item.hideButtons()
        scene.sigMouseClicked.connect(self._on_click)

    def add(self, text: str, action: Callable[[], object]) -> None:
        """A further entry of the menu."""
        self._further.append((text, action))

    def menu(self) -> QMenu:
        """The menu, made anew."""
        menu = QMenu(self._plot)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        entries = [*self._further, (self.tr("Copy picture"), self.copy), (self.tr("Save picture…"), self.ask)]
        for text, action in entries:
            entry = menu.addAction(text)
            entry.triggered.connect(lambda _checked=False, do=action: do())
        return menu

    def _on_click(self, event: Any) -> None:
        if event.button() == Qt.MouseButton.RightButton:
            event.accept()
            place = event.screenPos()
            self.menu().popup(QPoint(round(place.x()), round(place.y())))

    def copy(self) -> None:
        """The plot as a picture to the clipboard."""
        QGuiApplication.clipboard().setPixmap(self._plot.grab())
        self._notify(self.tr("Picture copied"))

    def ask(self) -> None:
        """Ask for a name and save."""
        ask_save(
            self._plot,
            self.tr("Save picture"),
            Path(f"{self._name}.png"),
            self.tr("Picture (*.png)"),
            self.save,
        )

    def save(self, path: Path) -> None:
        """Save the plot as PNG; says what has become of it."""
        path = path if path.suffix else path.with_suffix(".png")
        save_picture(self._plot, path, self._notify)


def save_picture(widget: QWidget, path: Path, notify: Callable[[str], None]) -> None:
    """Save a widget as it looks now."""
    if widget.grab().save(str(path)):
        notify(QGuiApplication.translate("plots", "Saved as {0}").format(path))
    else:
        notify(
            QGuiApplication.translate("plots", "{0} cannot be written; choose another folder").format(path)
        )
