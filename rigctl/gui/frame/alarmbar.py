"""The bottom of the window: the newest alarm with its acknowledgement, short news, and STOP.

Not its job: the list of alarms (service page), what STOP does (the engine).
"""

from __future__ import annotations

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QSizePolicy, QWidget

from rigctl.gui.theme import ThemeKeeper

NEWS_MS = 8000


class AlarmBar(QWidget):
    """One line of alarm or news, [Acknowledge], and [STOP]."""

    stopPressed = Signal()
    acknowledgePressed = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.line = QLabel()
        self.line.setObjectName("alarm-line")
        self.line.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.line.setWordWrap(True)
        self.acknowledge = QPushButton(self.tr("Acknowledge"))
        self.acknowledge.setObjectName("acknowledge")
        self.acknowledge.setToolTip(self.tr("Say that this alarm has been seen; it stays in the list."))
        self.acknowledge.clicked.connect(self.acknowledgePressed)
        self.stop = QPushButton(self.tr("■  STOP  (F12)"))
        self.stop.setObjectName("stop")
        self.stop.setProperty("look", "stop")
        self.stop.setToolTip(
            self.tr(
                "Stops by software: releases the pressure, brings the disc to rest, ends the run. "
                "This is NOT the emergency stop: use the red mushroom button of the rig in danger."
            )
        )
        self.stop.clicked.connect(self.stopPressed)
        self.not_estop = QLabel(self.tr("software stop,\nnot the emergency stop"))
        self.not_estop.setProperty("look", "muted")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(*(theme.px(1),) * 4)
        layout.setSpacing(theme.px(2))
        layout.addWidget(self.line, 1)
        layout.addWidget(self.acknowledge)
        layout.addWidget(self.not_estop)
        layout.addWidget(self.stop)
        self._news = QTimer(self)
        self._news.setSingleShot(True)
        self._news.timeout.connect(lambda: self._show("", ""))
        self._alarm = ("", "")
        self.show_alarm("", severity="")
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self.not_estop.setFont(self._theme.font("small"))

    def show_alarm(self, text: str, *, severity: str) -> None:
        """The newest alarm that is not acknowledged: severity "warning" or "alarm"; "" clears the line."""
        self._alarm = (text, severity)
        self.acknowledge.setVisible(bool(text))
        self._news.stop()
        self._show(text, severity)

    def show_news(self, text: str) -> None:
        """A short line that goes by itself; an alarm is never hidden by it."""
        if not self._alarm[0]:
            self._show(text, "news")
            self._news.start(NEWS_MS)

    def _show(self, text: str, severity: str) -> None:
        mark = {"warning": "▲ ", "alarm": "▲ ", "news": ""}.get(severity, "")
        self.line.setText(mark + text if text else "")
        self.line.setProperty("look", severity if severity in ("warning", "alarm") else "")
        self.line.style().polish(self.line)
