"""The left column: four moving bars, and below them mu and sound level.

Job: put readings and set-points of a state on the indicators. Not its job: painting them.
"""

from __future__ import annotations

import math

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QLabel, QVBoxLayout, QWidget

from rigctl.gui.format import number_text
from rigctl.gui.rig.state import RigState
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.moving_bar import BarScale, MovingBar


class Readouts(QWidget):
    """Speed, pressure, torque, disc temperature, mu, sound level."""

    def __init__(self, theme: ThemeKeeper, scales: dict[str, BarScale]) -> None:
        super().__init__()
        self._theme = theme
        names = {
            "speed": self.tr("Speed"),
            "pressure": self.tr("Pressure"),
            "torque": self.tr("Torque"),
            "temperature": self.tr("Disc"),
        }
        tips = {
            "speed": self.tr("Speed of the disc; the blue mark is the commanded speed"),
            "pressure": self.tr("Brake pressure; the blue mark is the commanded pressure"),
            "torque": self.tr("Brake torque at the flange"),
            "temperature": self.tr("Temperature of the rub surface of the disc, by the pyrometer"),
        }
        self._column = QVBoxLayout(self)
        self.bars: dict[str, MovingBar] = {}
        for key, name in names.items():
            bar = MovingBar(theme, name, scales[key])
            bar.setObjectName(f"bar-{key}")
            bar.setToolTip(
                tips[key]
                + "\n"
                + self.tr("Hatched: amber beyond what the rig may do, red where it is stopped")
            )
            self.bars[key] = bar
            self._column.addWidget(bar, 1)
        self.mu, self.level = QLabel(), QLabel()
        self._grid = QGridLayout()
        for column, (label, value, name, unit, tip) in enumerate((
            (self.tr("Friction mu"), self.mu, "value-mu", "",
             self.tr("Momentary coefficient of friction, from torque and pressure")),
            (self.tr("Sound level"), self.level, "value-level", "dB(A)",
             self.tr("Sound level of the microphone, A-weighted, fast, dB re 20 µPa")),
        )):  # fmt: skip
            title = QLabel(label)
            title.setProperty("look", "muted")
            value.setObjectName(name)
            value.setToolTip(tip)
            value.setAlignment(Qt.AlignmentFlag.AlignLeft)
            value.setProperty("unit", unit)
            self._grid.addWidget(title, 0, column)
            self._grid.addWidget(value, 1, column)
        self._column.addLayout(self._grid)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.clear()

    def _restyle(self) -> None:
        self._column.setContentsMargins(0, 0, self._theme.px(1), 0)
        self._column.setSpacing(self._theme.px(1))
        self._grid.setVerticalSpacing(0)
        self._grid.setHorizontalSpacing(self._theme.px(2))
        for label in (self.mu, self.level):
            label.setFont(self._theme.font("large", bold=True))
        self._show_level(getattr(self, "_level_db", math.nan))

    def setScales(self, scales: dict[str, BarScale]) -> None:
        """Ends and limits of another rig."""
        for key, bar in self.bars.items():
            bar.setScale(scales[key])

    def show_state(self, state: RigState) -> None:
        """Newest readings."""
        r = state.readings
        speed_on = state.enabled or state.relay_closed
        self.bars["speed"].setReading(r.speed_rpm, r.set_speed_rpm if speed_on else math.nan, state.rig_s)
        self.bars["pressure"].setReading(
            r.pressure_bar, r.set_pressure_bar if speed_on else math.nan, state.rig_s
        )
        self.bars["torque"].setReading(r.torque_nm, t_s=state.rig_s)
        self.bars["temperature"].setReading(r.temperature_degc, t_s=state.rig_s)
        self.mu.setText(number_text(r.mu, 3))

    def setLevel(self, level_db: float) -> None:
        """Newest sound level."""
        self._show_level(level_db)

    def _show_level(self, level_db: float) -> None:
        self._level_db = level_db
        muted = self._theme.current.muted
        size = self._theme.font("normal").pointSizeF()
        self.level.setText(
            f'{number_text(level_db, 1)} <span style="color:{muted}; font-size:{size:.1f}pt;'
            f' font-weight:normal">dB(A)</span>'
        )

    def clear(self) -> None:
        """No rig."""
        for bar in self.bars.values():
            bar.clear()
        self.mu.setText(number_text(None))
        self._show_level(math.nan)
