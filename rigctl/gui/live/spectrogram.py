"""Spectrogram that scrolls to the left, with the squeal band and the events in it.

Job: levels over time and frequency in viridis, frames around events, the scale of colours. Not its job:
spectra.
"""

from __future__ import annotations

import math

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QImage, QPixmap
from PySide6.QtWidgets import QLabel, QMenu, QToolButton

from rigctl.gui.format import frequency_text, quantity_text
from rigctl.gui.live.axes import PlainAxis
from rigctl.gui.live.data import LiveData
from rigctl.gui.live.groups import TimeGroup
from rigctl.gui.live.items import BoxesItem, OutsideItem, PictureItem, pen
from rigctl.gui.live.ranges import clock_text
from rigctl.gui.live.stft import LEVEL_LOWEST_DB, LEVEL_STEP_DB
from rigctl.gui.live.trend import TimePlot
from rigctl.gui.live.waveform import sound_hint
from rigctl.gui.theme import ThemeKeeper

SCALES_DB = ((0, 80), (10, 100), (30, 120))
_FRAME_HZ = 350.0
_FRAME_PX = 6.0
"""A frame around an event keeps this distance from its line, in Hz and on the screen."""


def colour_table(low_db: float, high_db: float) -> list[int]:
    """Colour of each stored level: viridis between two levels; 0 (nothing) is transparent."""
    viridis = pg.colormap.get("viridis")
    assert viridis is not None  # pyqtgraph brings it
    colours = np.asarray(viridis.getLookupTable(nPts=256))
    steps = LEVEL_LOWEST_DB + (np.arange(256) - 1) * LEVEL_STEP_DB
    at = np.clip((steps - low_db) / (high_db - low_db) * 255.0, 0, 255).astype(int)
    table = [0xFF000000 | int(r) << 16 | int(g) << 8 | int(b) for r, g, b in colours[at][:, :3]]
    table[0] = 0
    return table


class SpectrogramPlot(TimePlot):
    """Level over time and frequency."""

    def __init__(self, theme: ThemeKeeper, group: TimeGroup) -> None:
        super().__init__(theme, group, "", y_axis=PlainAxis("left", theme, factor=1e-3))
        self.title.setText(self.tr("Spectrogram (kHz, dB)"))
        self._scale_db: tuple[int, int] = SCALES_DB[1]
        self._picture = PictureItem()
        self._outside = OutsideItem("#000000", 110, vertical=False)
        self._outside.edge = pen("#ffffff", 1.0, Qt.PenStyle.DashLine)
        self._boxes = BoxesItem()
        for item in (self._picture, self._outside, self._boxes):
            self.graphics.add(item)
        self._scale = QToolButton()
        self._scale.setAutoRaise(True)
        self._scale.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self._scale.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        self._scale.setToolTip(self.tr("Scale of colours: choose its range"))
        menu = QMenu(self._scale)
        for scale in SCALES_DB:
            text = self.tr("{0} to {1} dB").format(*scale)
            menu.addAction(text).triggered.connect(lambda _=False, chosen=scale: self.set_scale(*chosen))
        self._scale.setMenu(menu)
        self._legend = [QLabel(), QLabel()]
        for widget in (self._legend[0], self._scale, self._legend[1]):
            self.header.addWidget(widget)
        self.colour()

    def colour(self) -> None:
        """Colours of the present theme."""
        self.set_scale(*self._scale_db)

    def cursor_colour(self) -> str:
        """To be seen on dark blue and on yellow."""
        return "#ff8fd8"

    def set_scale(self, low_db: int, high_db: int) -> None:
        """Levels of the first and the last colour."""
        self._scale_db = (low_db, high_db)
        table = colour_table(low_db, high_db)
        self._picture.set_table(table)
        steps = np.linspace(low_db, high_db, 96)
        stored = np.clip((steps - LEVEL_LOWEST_DB) / LEVEL_STEP_DB + 1, 1, 255).astype(int)
        bar = QImage(96, 1, QImage.Format.Format_RGB32)
        for x, level in enumerate(stored.tolist()):
            bar.setPixel(x, 0, table[level])
        size = QSize(self.theme.px(9), self.theme.px(1))
        self._scale.setIcon(QPixmap.fromImage(bar.scaled(size)))
        self._scale.setIconSize(size)
        for label, level in zip(self._legend, (low_db, high_db), strict=True):
            label.setText(quantity_text(level, "dB", 0))
            label.setProperty("look", "muted")
            label.setFont(self.theme.font("small"))

    def draw(self, data: LiveData) -> None:
        """The shown stretch, in cells of at least one pixel."""
        x, sound = self.stretch(data), data.sound
        band_hz = self._manual_y or (0.0, 20_000.0 if sound is None else sound.rate_hz / 2)
        self.show_hint(sound_hint(self, data))
        self.set_ranges(x, band_hz, room=False)
        picture = None
        if sound is not None:
            rows = max(int(self.view.height()), 1)
            picture = sound.spectrogram.picture(*x, band_hz, self.pixels(), rows)
            self._outside.band = sound.settings.band_hz
        if sound is None or picture is None:
            self._picture.set_picture(None, QRectF())
            self._outside.span = (x[0], x[0])
            self._boxes.set_boxes([])
            return
        rows, columns = picture.levels.shape
        target = QRectF(picture.start_s, picture.low_hz, columns * picture.column_s, rows * picture.row_hz)
        self._picture.set_picture(picture.levels, target)
        self._outside.span = (target.left(), target.right())
        least_hz = _FRAME_PX * (band_hz[1] - band_hz[0]) / max(self.view.height(), 1.0)
        half_hz = max(_FRAME_HZ, least_hz)
        self._boxes.set_boxes(
            [
                (
                    QRectF(event.start_s, event.frequency_hz - half_hz, event.end_s - event.start_s,
                           2 * half_hz),
                    event.harmonic,
                )
                for event in sound.events()
            ]
        )  # fmt: skip

    def describe(self, x: float, y: float) -> str:
        """Time, frequency and level under the mouse."""
        if self.data is None or self.data.sound is None:
            return ""
        level = self.data.sound.spectrogram.value_db(x, y)
        return f"{clock_text(x, 0.01)}   {frequency_text(y)}   {quantity_text(level, 'dB', 0)}"

    def cursor_words(self, a: float, b: float) -> str:
        """Times only: a cursor crosses all frequencies."""
        return f"A {clock_text(a, 0.01)}    B {clock_text(b, 0.01)}    B−A {b - a:.3f}\u202fs"

    def cursor_value(self, x: float) -> float:
        """None: a cursor crosses all frequencies."""
        return math.nan
