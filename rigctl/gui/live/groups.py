"""What several plots share: the stretch of their horizontal axis, whether it follows, and two cursors.

Job: one state per axis (rig time, frequency), changed by any plot, told to all. Not its job: painting.
"""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

SPANS_S = (2.0, 5.0, 12.0, 30.0, 60.0)


class XGroup(QObject):
    """Shared horizontal axis.

    Parameters
    ----------
    least, most : float
        Smallest and largest span that a person can zoom to.
    """

    changed = Signal()
    """Range, following or cursors have changed."""
    followed = Signal()
    """Follow was pressed: all manual ranges end, vertical ones too."""

    def __init__(self, least: float, most: float, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._least, self._most = least, most
        self.follow = True
        self._chosen = (0.0, 1.0)
        self.cursors: tuple[float, float] | None = None

    def window(self, whole: tuple[float, float]) -> tuple[float, float]:
        """What is to be shown: `whole` while following, else what a person has chosen."""
        return whole if self.follow else self._chosen

    def choose(self, low: float, high: float) -> None:
        """A person has zoomed or moved: this range stays until `follow_again`."""
        span = min(max(high - low, self._least), self._most)
        middle = (low + high) / 2
        self._chosen = (middle - span / 2, middle + span / 2)
        self.follow = False
        self.changed.emit()

    def follow_again(self) -> None:
        """Back to the newest, with automatic ranges."""
        self.follow = True
        self.followed.emit()
        self.changed.emit()

    def show_cursors(self, window: tuple[float, float] | None) -> None:
        """Put both cursors into a window; None takes them away."""
        if window is None:
            self.cursors = None
        else:
            low, high = window
            self.cursors = (low + (high - low) / 3, high - (high - low) / 3)
        self.changed.emit()

    def move_cursor(self, number: int, x: float) -> None:
        """Cursor 0 or 1 is here now."""
        if self.cursors is not None:
            a, b = self.cursors
            self.cursors = (x, b) if number == 0 else (a, x)
            self.changed.emit()


class TimeGroup(XGroup):
    """Rig time: while following, the last `span_s` seconds."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(0.001, 600.0, parent)
        self.span_s = 12.0

    def set_span(self, span_s: float) -> None:
        """Length of what is shown while following; begins to follow."""
        self.span_s = span_s
        self.follow_again()

    def stretch(self, end_s: float) -> tuple[float, float]:
        """Beginning and end of what is to be shown when the newest sample is at `end_s`."""
        end_s = end_s if end_s > float("-inf") else 0.0
        return self.window((end_s - self.span_s, end_s))
