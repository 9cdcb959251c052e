"""The brake deforming in the selected mode: animation, amplitude, phase, and who takes part in words.

Job: the clock and the controls around `BrakeItem`. Not its job: painting, computing shapes.
"""

from __future__ import annotations

import math
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QElapsedTimer, QSignalBlocker, Qt, QTimer
from PySide6.QtWidgets import QGridLayout, QLabel, QPushButton, QSlider, QVBoxLayout, QWidget

from rigctl.gui.format import number_text
from rigctl.gui.pages.model.brake_item import BrakeItem
from rigctl.gui.pages.model.data import Poles, Shape
from rigctl.gui.pages.model.words import pole_text
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.elided import ElidedLabel
from rigctl.model.drawn_brake import label_of

#: time of one period on screen, and between pictures
PERIOD_S, FRAME_MS = 1.6, 40
#: lines of words, bodies or springs named at most, and the share from which they are named
_LINES, _MOST_NAMES, _LEAST_SHARE = 3, 3, 0.1


class ModeView(QWidget):
    """Picture, [Pause], amplitude, phase."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._playing_wanted, self._seen = True, False
        self._clock = QElapsedTimer()
        self._timer = QTimer(self)
        self._timer.setInterval(FRAME_MS)
        self._timer.timeout.connect(self._tick)
        self.title = ElidedLabel()
        self.title.setProperty("look", "title")
        self.plot = pg.PlotWidget()
        plot_item: Any = self.plot.getPlotItem()
        self._plot_item = plot_item
        plot_item.hideAxis("left")
        plot_item.hideAxis("bottom")
        plot_item.setAspectLocked(True)
        plot_item.setClipToView(False)
        self._box: Any = plot_item.getViewBox()
        self.item = BrakeItem(theme)
        plot_item.addItem(self.item)
        self._names: dict[str, pg.TextItem] = {}
        self.play = QPushButton()
        self.play.setObjectName("mode-play")
        self.play.setToolTip(self.tr("Stop and start the motion (it is shown many times slower)"))
        self.amplitude, self.phase = QSlider(Qt.Orientation.Horizontal), QSlider(Qt.Orientation.Horizontal)
        self.amplitude.setRange(1, 40)
        self.amplitude.setValue(10)
        self.amplitude.setToolTip(self.tr("How far the motion is exaggerated"))
        self.phase.setRange(0, 359)
        self.phase.setPageStep(15)
        self.phase.setToolTip(self.tr("Phase within the period; moving it stops the motion"))
        self.phase_text = QLabel()
        self.facts = [ElidedLabel() for _ in range(_LINES)]
        for line in self.facts:
            line.setProperty("look", "muted")
        self._arrange()
        self.play.clicked.connect(self._toggle)
        self.amplitude.valueChanged.connect(self._show)
        self.phase.valueChanged.connect(self._on_phase)
        theme.changed.connect(self._restyle)
        self._restyle()
        self._say_play()

    def _arrange(self) -> None:
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addWidget(self.title)
        self._column.addWidget(self.plot, 1)
        self._grid = QGridLayout()
        self._grid.addWidget(self.play, 0, 0, 2, 1)
        for row, (text, slider) in enumerate(
            ((self.tr("Amplitude"), self.amplitude), (self.tr("Phase"), self.phase))
        ):
            label = QLabel(text)
            label.setBuddy(slider)
            slider.setAccessibleName(text)
            self._grid.addWidget(label, row, 1)
            self._grid.addWidget(slider, row, 2)
        self._grid.addWidget(self.phase_text, 1, 3)
        self._grid.setColumnStretch(2, 1)
        self._column.addLayout(self._grid)
        for line in self.facts:
            self._column.addWidget(line)

    def _restyle(self) -> None:
        px = self._theme.px
        self._column.setSpacing(px(0.5))
        self._grid.setHorizontalSpacing(px(1))
        self._grid.setVerticalSpacing(px(0.5))
        self.plot.setBackground(self._theme.current.plot)
        self.plot.setMinimumHeight(px(14))
        self.phase_text.setMinimumWidth(self.phase_text.fontMetrics().horizontalAdvance("000°"))
        for line in self.facts:
            line.setFont(self._theme.font("small"))
        for text in self._names.values():
            text.setColor(self._theme.current.text)
            text.setFont(self._theme.font("small"))
        self.item.restyle()

    # -- showing ----------------------------------------------------------------------------------

    def show_poles(self, poles: Poles | None) -> None:
        """The selected mode of these poles."""
        if poles is None:
            self.item.show_shape(None)
            self.title.clear()
            for line in self.facts:
                line.clear()
            self._name_bodies()
            return
        before, shape = self.item.shape_shown, poles.shape
        self.item.show_shape(shape)
        self.title.setText(pole_text(poles.selected))
        for line, text in zip(self.facts, self._words(shape), strict=True):
            line.setText(text)
        self._name_bodies()
        if before is None or before.drawing.box != shape.drawing.box:
            self._box.setRange(self.item.boundingRect(), padding=0.0)
        self._show()

    def _words(self, shape: Shape) -> list[str]:
        def listed(rows: tuple[tuple[str, float], ...], *, bodies: bool) -> str:
            kept = [row for row in rows if row[1] >= _LEAST_SHARE][:_MOST_NAMES] or list(rows[:1])
            return ", ".join(
                f"{label_of(name) if bodies else name.replace('_', ' ')} {100 * share:.0f}\u202f%"
                for name, share in kept
            )

        lines = [
            self.tr("Moves: {0}").format(listed(shape.bodies, bodies=True)),
            self.tr("Strained: {0}").format(listed(shape.couplings, bodies=False)),
            self.tr("Dampers add {0}, friction {1} to the real part").format(
                _signed(shape.dampers_1_s), _signed(shape.friction_1_s)
            ),
        ]
        if shape.doubtful:
            lines[-1] = self.tr("Two modes nearly coincide: the shape is hardly its own.")
        return lines

    def _name_bodies(self) -> None:
        places = self.item.label_places()
        for name in [name for name in self._names if name not in places]:
            self._plot_item.removeItem(self._names.pop(name))
        for name in places:
            if name not in self._names:
                text = pg.TextItem(name, color=self._theme.current.text, anchor=(0.5, 0.5))
                text.setFont(self._theme.font("small"))
                self._plot_item.addItem(text, ignoreBounds=True)
                self._names[name] = text
        if self.item.shape_shown is not None:
            for body in self.item.shape_shown.drawing.bodies:
                if body.role == "disc":
                    self._names[label_of(body.name)].setAnchor((0.0, 0.5))

    def _show(self) -> None:
        degrees = self.phase.value()
        text = "" if self.playing else f"{degrees}°"  # a text that changes lays the page out anew
        if text != self.phase_text.text():
            self.phase_text.setText(text)
        self.item.move(math.radians(degrees), self.amplitude.value() / 10.0)
        for name, (x, y) in self.item.label_places().items():
            self._names[name].setPos(x, y)

    # -- motion -----------------------------------------------------------------------------------

    @property
    def playing(self) -> bool:
        """Whether the brake moves now."""
        return self._timer.isActive()

    def setSeen(self, seen: bool) -> None:
        """The page is looked at or not: nothing moves unseen."""
        self._seen = seen
        self._run()

    def setPlaying(self, playing: bool) -> None:
        """Let the brake move, or hold it."""
        self._playing_wanted = playing
        self._say_play()
        self._run()

    def _run(self) -> None:
        if self._seen and self._playing_wanted:
            self._clock.restart()
            self._timer.start()
        else:
            self._timer.stop()
            self._show()

    def _say_play(self) -> None:
        self.play.setText(self.tr("Pause") if self._playing_wanted else self.tr("Play"))

    def _toggle(self) -> None:
        self.setPlaying(not self._playing_wanted)

    def _tick(self) -> None:
        if self.item.shape_shown is None:
            return
        step = 360.0 * self._clock.restart() / (1000.0 * PERIOD_S)
        with QSignalBlocker(self.phase):
            self.phase.setValue(round(self.phase.value() + step) % 360)
        self._show()

    def _on_phase(self, _degrees: int) -> None:
        self.setPlaying(False)
        self._show()


def _signed(value: float) -> str:
    return f"{'+' if value > 0 else ''}{number_text(value, 1)}\u202f1/s"
