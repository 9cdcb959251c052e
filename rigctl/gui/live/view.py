"""The live view: trends, waveform, spectrum, spectrogram and levels, with their tools; for any page.

Job: arrange the plots, draw them when something has changed and somebody looks, carry out what the tools
ask for. Not its job: reading samples (`feed`), commands to the rig.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import QPoint, QSettings, Qt, QTimer
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QSplitter, QVBoxLayout, QWidget

from rigctl.gui.live.data import LiveData
from rigctl.gui.live.feed import LiveFeed
from rigctl.gui.live.groups import SPANS_S, TimeGroup, XGroup
from rigctl.gui.live.limits import limit_bands
from rigctl.gui.live.pictures import ask_and_save, copy_picture
from rigctl.gui.live.plot import LivePlot
from rigctl.gui.live.spectrogram import SpectrogramPlot
from rigctl.gui.live.spectrum import SpectrumPlot
from rigctl.gui.live.tools import PlotTools
from rigctl.gui.live.trend import TrendPlot
from rigctl.gui.live.waveform import LevelPlot, WaveformPlot
from rigctl.gui.services import Services

FRAME_MS = 33
PANELS = ("trend", "waveform", "spectrum", "spectrogram", "level")
_SHARES = {"trend": 5, "waveform": 2, "spectrum": 3, "spectrogram": 3, "level": 2}


class LiveView(QWidget):
    """Live plots of the session that the window watches.

    Parameters
    ----------
    services : Services
    panels : sequence of str
        Which of `PANELS`, in this order; all can be shown or hidden by the person later.
    columns : int
        2 puts the trends to the left of the sound.
    """

    def __init__(self, services: Services, panels: Sequence[str] = PANELS, columns: int = 1) -> None:
        super().__init__()
        theme = services.theme
        self._services = services
        self._frozen: LiveData | None = None
        self._drawn: object = None
        self._dialogs: list[QWidget] = []
        self.feed = LiveFeed.of(services)
        self.time = TimeGroup(self)
        self.frequency = XGroup(10.0, 100_000.0, self)
        self.tools = PlotTools(theme)
        makers: dict[str, Callable[[], QWidget]] = {
            "trend": lambda: TrendPlot(theme, self.time),
            "waveform": lambda: WaveformPlot(theme, self.time),
            "spectrum": lambda: SpectrumPlot(theme, self.frequency, self.time),
            "spectrogram": lambda: SpectrogramPlot(theme, self.time),
            "level": lambda: LevelPlot(theme, self.time),
        }
        self.panels: dict[str, Any] = {name: makers[name]() for name in panels}
        self._splitters = self._arrange(columns)
        self._timer = QTimer(self)
        self._timer.setInterval(FRAME_MS)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._tick)
        self._connect()
        self._on_session()
        if self.feed.limits:
            self.set_limits(self.feed.limits)

    # -- arrangement ------------------------------------------------------------------------------

    def _arrange(self, columns: int) -> list[QSplitter]:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(self._services.theme.px(0.5))
        layout.addWidget(self.tools)
        outer = QSplitter(Qt.Orientation.Horizontal if columns == 2 else Qt.Orientation.Vertical)
        splitters = [outer]
        inner = outer
        if columns == 2:
            inner = QSplitter(Qt.Orientation.Vertical)
            splitters.append(inner)
        for name, panel in self.panels.items():
            into = outer if name == "trend" else inner
            into.addWidget(panel)
            into.setStretchFactor(into.indexOf(panel), _SHARES[name])
        if columns == 2:
            outer.addWidget(inner)
            outer.setStretchFactor(outer.indexOf(inner), 5)
        for splitter in splitters:
            splitter.setChildrenCollapsible(False)
        layout.addWidget(outer, 1)
        return splitters

    def _connect(self) -> None:
        tools = self.tools
        tools.followPressed.connect(self.follow)
        tools.frozenChanged.connect(self.set_frozen)
        tools.cursorsChanged.connect(self.set_cursors)
        tools.spanChanged.connect(self._on_span)
        tools.shownChanged.connect(self._on_shown)
        tools.copyPressed.connect(lambda widget: self.copy_picture(widget or self))
        tools.savePressed.connect(lambda widget: self.save_picture(widget or self))
        for group in (self.time, self.frequency):
            group.changed.connect(self._on_group)
        for panel in self.panels.values():
            panel.menuAsked.connect(self._on_menu)
            panel.resized.connect(self._forget_drawn)
        self.feed.sessionChanged.connect(self._on_session)
        self.feed.limitsChanged.connect(self.set_limits)
        self._services.theme.changed.connect(self._forget_drawn)
        for keys, action in (
            ("Home", self.follow),
            ("Left", lambda: self._shift(-0.25)),
            ("Right", lambda: self._shift(0.25)),
            ("+", lambda: self._zoom(1 / 1.5)),
            ("-", lambda: self._zoom(1.5)),
        ):
            shortcut = QShortcut(QKeySequence(keys), self, action)
            shortcut.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)

    def plots(self) -> list[LivePlot]:
        """All single plots that are shown."""
        shown: list[LivePlot] = []
        for panel in self.panels.values():
            if not panel.isHidden():
                shown += panel.plots() if isinstance(panel, TrendPlot) else [panel]
        return shown

    # -- for the page -----------------------------------------------------------------------------

    def set_limits(self, limits: Any) -> None:
        """Limit bands: `rigctl.safety.limits.Limits`, or channel name to (lower, upper)."""
        trend = self.panels.get("trend")
        if trend is not None:
            trend.set_limits(limit_bands(limits))
        self._forget_drawn()

    def start(self) -> None:
        """The page is shown: draw."""
        self._forget_drawn()
        self._timer.start()
        self._tick()

    def stop(self) -> None:
        """Another page is shown."""
        self._timer.stop()

    def save_layout(self, settings: QSettings) -> None:
        """Write sizes, span and what is shown."""
        for number, splitter in enumerate(self._splitters):
            settings.setValue(f"live-split-{number}", splitter.saveState())
        settings.setValue("live-span", self.time.span_s)
        settings.setValue("live-hidden", ",".join(self._hidden()))
        trend = self.panels.get("trend")
        if trend is not None:
            settings.setValue("live-split-trend", trend.splitter.saveState())

    def restore_layout(self, settings: QSettings) -> None:
        """Read what `save_layout` has written; anything may be missing."""
        pairs = [(f"live-split-{number}", splitter) for number, splitter in enumerate(self._splitters)]
        trend = self.panels.get("trend")
        if trend is not None:
            pairs.append(("live-split-trend", trend.splitter))
        for key, splitter in pairs:
            state = settings.value(key)
            if state is not None:
                splitter.restoreState(state)
        hidden = str(settings.value("live-hidden", "")).split(",")
        for key in hidden:
            self._on_shown(key, False)
        self._offer()
        span_s = str(settings.value("live-span", ""))
        for number, offered_s in enumerate(SPANS_S):
            if span_s == str(offered_s):
                self.tools.span.setCurrentIndex(number)
                self._on_span(offered_s)

    # -- what the tools ask for -------------------------------------------------------------------

    @property
    def data(self) -> LiveData:
        """What is shown: the present, or the frozen copy."""
        return self._frozen or self.feed.data

    @property
    def frozen(self) -> bool:
        """True while the picture stands."""
        return self._frozen is not None

    def follow(self) -> None:
        """Back to the present: newest data at the right, automatic ranges."""
        self._frozen = None
        self.frequency.follow_again()
        self.time.follow_again()

    def set_frozen(self, frozen: bool) -> None:
        """Hold the picture, or go on; reading and recording never stop."""
        self._frozen = self.feed.data.copy() if frozen else None
        self._on_group()

    def set_cursors(self, shown: bool) -> None:
        """Two cursors in every plot, or none."""
        sound = self.data.sound
        whole = (0.0, 20_000.0 if sound is None else sound.rate_hz / 2)
        self.frequency.show_cursors(self.frequency.window(whole) if shown else None)
        self.time.show_cursors(self.time.stretch(self.data.end_s) if shown else None)

    def copy_picture(self, widget: QWidget) -> None:
        """A plot, or the view, to the clipboard."""
        copy_picture(widget)
        self._services.notify(self.tr("Picture copied"))

    def save_picture(self, widget: QWidget) -> QWidget:
        """Ask for a file and write the picture; returns the dialog, which blocks nothing."""
        title = widget.title.text() if isinstance(widget, LivePlot) else self.tr("Live")
        return ask_and_save(widget, title.split(" (")[0], self._services.notify)

    def _on_span(self, span_s: float) -> None:
        self.time.set_span(span_s)

    def _shift(self, share: float) -> None:
        t0, t1 = self.time.stretch(self.data.end_s)
        self.time.choose(t0 + share * (t1 - t0), t1 + share * (t1 - t0))

    def _zoom(self, factor: float) -> None:
        t0, t1 = self.time.stretch(self.data.end_s)
        middle, half = (t0 + t1) / 2, factor * (t1 - t0) / 2
        self.time.choose(middle - half, middle + half)

    def _on_menu(self, plot: QWidget, where: QPoint) -> None:
        self.tools.menu_of(plot).popup(where)

    # -- what is shown ----------------------------------------------------------------------------

    def _words(self) -> dict[str, str]:
        return {
            "trend": self.tr("Pressure, torque, speed, temperature, µ"),
            "waveform": self.tr("Sound pressure"),
            "spectrum": self.tr("Spectrum"),
            "spectrogram": self.tr("Spectrogram"),
            "level": self.tr("Sound level"),
        }

    def _offer(self) -> None:
        words = self._words()
        choices = [(name, words[name], not panel.isHidden()) for name, panel in self.panels.items()]
        trend = self.panels.get("trend")
        if trend is not None:
            choices.append(("", "", False))
            for row, title in trend.titles().items():
                choices.append((f"row-{row}", title, not trend.rows[row].isHidden()))
        self.tools.set_choices(choices)

    def _hidden(self) -> list[str]:
        hidden = [name for name, panel in self.panels.items() if panel.isHidden()]
        trend = self.panels.get("trend")
        if trend is not None:
            hidden += [f"row-{row}" for row, plot in trend.rows.items() if plot.isHidden()]
        return hidden

    def _on_shown(self, key: str, shown: bool) -> None:
        trend = self.panels.get("trend")
        if key.startswith("row-") and trend is not None and key[4:] in trend.rows:
            trend.set_shown(key[4:], shown)
        elif key in self.panels:
            others = [name for name, panel in self.panels.items() if name != key and not panel.isHidden()]
            if shown or others:
                self.panels[key].setVisible(shown)
        self._forget_drawn()

    # -- drawing ----------------------------------------------------------------------------------

    def _on_session(self) -> None:
        trend = self.panels.get("trend")
        if trend is not None:
            trend.set_channels(list(self.feed.data.buffer.specs.values()))
            trend.set_limits(limit_bands(self.feed.limits))
        self._offer()
        self._forget_drawn()

    def _on_group(self) -> None:
        self.tools.show_state(
            follow=self.time.follow and self.frequency.follow and not self.frozen,
            frozen_s=self._frozen.end_s if self._frozen is not None else None,
            cursors=self.time.cursors is not None,
        )
        self._forget_drawn()
        for plot in self.plots():
            plot.update_cursors()
        if self._timer.isActive():
            self._draw()

    def _forget_drawn(self) -> None:
        self._drawn = None

    def _tick(self) -> None:
        self.feed.pump()
        self._draw()

    def _draw(self) -> None:
        """Draw when there is something new and the view can be seen."""
        data = self.data
        state = (id(data), data.version)
        if state == self._drawn or not self.isVisible():
            return
        self._drawn = state
        for panel in self.panels.values():
            if panel.isVisible():
                panel.refresh(data)
