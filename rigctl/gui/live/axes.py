"""Axes of the live plots: few ticks, one size of text, rig time as a clock shows it.

Job: ticks and their words for pyqtgraph. Not its job: ranges (`ranges`), which axis a plot has.
"""

from __future__ import annotations

from collections.abc import Sequence

import pyqtgraph as pg

from rigctl.gui.format import number_text
from rigctl.gui.live.ranges import clock_text, nice_step, nice_time_step, number_decimals
from rigctl.gui.theme import ThemeKeeper


class PlainAxis(pg.AxisItem):
    """Numbers in round steps, without SI prefixes.

    Parameters
    ----------
    orientation : str
        "left", "bottom" or "right".
    theme : ThemeKeeper
    factor : float
        Numbers are the plot's own times this: 0.001 shows Hz as kHz.
    """

    def __init__(self, orientation: str, theme: ThemeKeeper, factor: float = 1.0) -> None:
        super().__init__(orientation, maxTickLength=-4)
        self._theme = theme
        self._factor = factor
        self.enableAutoSIPrefix(False)

    def take_look(self) -> None:
        """Colours and size of text of the present theme."""
        look = self._theme.current
        self.setPen(look.plot_line)
        self.setTextPen(look.muted)
        self.setStyle(
            tickFont=self._theme.font("small"),
            tickTextOffset=self._theme.px(0.5),
            autoExpandTextSpace=False,
            hideOverlappingLabels=True,
        )
        points = self._theme.font("small").pointSizeF()
        self.labelStyle = {"color": look.muted, "font-size": f"{points:.1f}pt"}
        if self.labelText:
            self.setLabel(self.labelText)
        else:
            self.showLabel(False)
        if self.orientation in ("left", "right"):
            self.setWidth(self._theme.px(6))
        else:
            self.setHeight(self._theme.px(4.5 if self.labelText else 2.5))

    def name(self, text: str) -> None:
        """Name and unit beside the axis."""
        self.labelText = text
        self.take_look()

    def _parts(self, size: float) -> float:
        if self.orientation in ("left", "right"):
            return max(size / self._theme.px(2.25), 3.0)
        return size / self._theme.px(9)

    def tickSpacing(self, minVal: float, maxVal: float, size: float) -> list[tuple[float, float]]:
        """One level of ticks."""
        return [(self._step(maxVal - minVal, self._parts(size)), 0.0)]

    def _step(self, span: float, parts: float) -> float:
        return nice_step(span * self._factor, parts) / self._factor

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float) -> list[str]:
        """Numbers with the decimals that the spacing needs."""
        decimals = number_decimals(spacing * self._factor)
        return [number_text(value * self._factor, decimals) for value in values]


class RigTimeAxis(PlainAxis):
    """Rig time as h:mm:ss."""

    def _step(self, span: float, parts: float) -> float:
        return nice_time_step(span, parts)

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float) -> list[str]:
        """Clock times."""
        return [clock_text(value, spacing) for value in values]
