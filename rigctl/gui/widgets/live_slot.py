"""Where the live view of the signals goes on a page: made when first shown, started and stopped with it.

Job: import and build the plots only when somebody looks, keep their layout until then, tell the newest sound
level. Not its job: the plots and what feeds them (`rigctl.gui.live`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSettings, QTimer, Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from rigctl.gui.services import Services

if TYPE_CHECKING:
    from rigctl.gui.live.view import LiveView

LEVEL_EVERY_MS = 250
_PREFIX = "live-"


class _Kept(QSettings):
    """Layout of a view that is not made yet: answers like settings, writes nothing."""

    def __init__(self, values: dict[str, Any]) -> None:
        super().__init__()
        self._values = values

    def value(self, arg__1: str, defaultValue: Any = None, type: Any = None) -> Any:
        """See QSettings."""
        return self._values.get(arg__1, defaultValue)


class LiveSlot(QWidget):
    """Holds a `LiveView`.

    Parameters
    ----------
    services : Services
    panels : sequence of str, optional
        Which of its panels; all by default.
    hidden : sequence of str
        Panels and rows that are hidden until a person wants them.
    """

    levelChanged = Signal(float)
    """Newest sound level, dB; NaN when no sound comes."""

    def __init__(
        self, services: Services, panels: Sequence[str] | None = None, hidden: Sequence[str] = ()
    ) -> None:
        super().__init__()
        self._services = services
        self._panels = panels
        self._kept: dict[str, Any] = {"live-hidden": ",".join(hidden)}
        self.view: LiveView | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        self._timer = QTimer(self)
        self._timer.setInterval(LEVEL_EVERY_MS)
        self._timer.timeout.connect(self._tell_level)

    def start(self) -> None:
        """Make the view if need be; plots run."""
        if self.view is None:
            self.view = self._make()
        if not self._timer.isActive():
            self._timer.start()
            self.view.start()

    def stop(self) -> None:
        """Plots rest."""
        if self.view is not None and self._timer.isActive():
            self._timer.stop()
            self.view.stop()

    @property
    def running(self) -> bool:
        """True between `start` and `stop`."""
        return self._timer.isActive()

    def _make(self) -> LiveView:
        from rigctl.gui.live.view import PANELS, LiveView

        view = LiveView(self._services, PANELS if self._panels is None else self._panels)
        layout = self.layout()
        assert layout is not None
        layout.addWidget(view)
        view.restore_layout(_Kept(self._kept))
        return view

    def _tell_level(self) -> None:
        from rigctl.gui.live.feed import LiveFeed

        self.levelChanged.emit(LiveFeed.of(self._services).data.level_db())

    # -- layout -----------------------------------------------------------------------------------

    def save_layout(self, settings: QSettings) -> None:
        """As the view wants it."""
        if self.view is not None:
            self.view.save_layout(settings)

    def restore_layout(self, settings: QSettings) -> None:
        """Now, or when the view is made."""
        self._kept |= {key: settings.value(key) for key in settings.childKeys() if key.startswith(_PREFIX)}
        if self.view is not None:
            self.view.restore_layout(settings)
