"""Pictures of a widget: to the clipboard, to a PNG or SVG file.

Job: render what is seen; ask for a file name without blocking the window. Not its job: figures of the
report.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QPoint, QSize, QStandardPaths, Qt
from PySide6.QtGui import QGuiApplication, QImage, QPainter
from PySide6.QtWidgets import QFileDialog, QWidget

from rigctl.gui.live.plot import LivePlot

SHARPNESS = 2.0
"""Pixels of a saved PNG per pixel of the screen."""


def copy_picture(widget: QWidget) -> None:
    """What the widget shows, to the clipboard."""
    QGuiApplication.clipboard().setPixmap(widget.grab())


def save_picture(widget: QWidget, path: Path) -> None:
    """Write a PNG, or an SVG when the name ends so.

    Raises
    ------
    OSError
        It cannot be written there.
    """
    plots = [widget] if isinstance(widget, LivePlot) else widget.findChildren(LivePlot)
    for plot in plots:
        plot.draw_finer(SHARPNESS)
    try:
        if path.suffix.lower() == ".svg":
            _save_svg(widget, path)
        else:
            _save_png(widget, path)
    finally:
        for plot in plots:
            plot.draw_finer(1.0)


def _save_png(widget: QWidget, path: Path) -> None:
    image = QImage(widget.size() * SHARPNESS, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(SHARPNESS)
    image.fill(widget.palette().window().color())
    widget.render(image)
    if not image.save(str(path)):
        raise OSError(f"{path} cannot be written")


def _save_svg(widget: QWidget, path: Path) -> None:
    from PySide6.QtSvg import QSvgGenerator

    path.touch()  # says why, when it cannot be written; the generator would not
    generator = QSvgGenerator()
    generator.setFileName(str(path))
    generator.setSize(QSize(widget.width(), widget.height()))
    generator.setViewBox(widget.rect())
    generator.setTitle("rigctl")
    painter = QPainter(generator)
    widget.render(painter, QPoint())
    painter.end()


def ask_and_save(widget: QWidget, name: str, notify: Callable[[str], None]) -> QFileDialog:
    """Ask where to, in a dialog that blocks nothing; then write, and say so.

    Parameters
    ----------
    widget : QWidget
    name : str
        Proposed name without folder and ending.
    notify : callable
        Takes one line of news.
    """
    folder = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.PicturesLocation)
    start = folder if folder and Path(folder).is_dir() else str(Path.home())
    dialog = QFileDialog(widget.window(), QCoreApplication.translate("pictures", "Save picture"), start)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.setModal(False)
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setNameFilters(
        [
            QCoreApplication.translate("pictures", "Picture (*.png)"),
            QCoreApplication.translate("pictures", "Drawing (*.svg)"),
        ]
    )
    dialog.setDefaultSuffix("png")
    dialog.filterSelected.connect(lambda kind: dialog.setDefaultSuffix("svg" if "svg" in kind else "png"))
    dialog.selectFile(name)

    def save(file: str) -> None:
        try:
            save_picture(widget, Path(file))
        except OSError as error:
            notify(QCoreApplication.translate("pictures", "Picture not saved: {0}").format(error))
        else:
            notify(QCoreApplication.translate("pictures", "Picture saved as {0}").format(file))

    dialog.fileSelected.connect(save)
    dialog.show()
    return dialog
