"""A question or message in the page, with its answers as buttons: in place of a message box.

Job: showing one at a time; Esc takes the last answer, which does nothing. Not its job: what the answers do.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QSizePolicy

from rigctl.gui.theme import ThemeKeeper

Answer = tuple[str, Callable[[], None] | None]


class Notice(QFrame):
    """One line with buttons; hidden while there is nothing to ask."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.setObjectName("notice")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.words = QLabel()
        self.words.setObjectName("notice-words")
        self.words.setWordWrap(True)
        self.words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.buttons: list[QPushButton] = []
        self._row = QHBoxLayout(self)
        self._row.addWidget(self.words, 1)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.hide()

    def _restyle(self) -> None:
        unit = self._theme.px(1)
        self._row.setContentsMargins(2 * unit, unit // 2, unit, unit // 2)
        self._row.setSpacing(unit)
        t = self._theme.current
        self.setStyleSheet(
            f"QFrame#notice {{ background: {t.field}; border-left: {unit // 2}px solid {t.blue}; }}"
        )

    def ask(self, words: str, answers: list[Answer]) -> None:
        """Show words and answers; the last one should do nothing and takes Esc. Replaces what was asked."""
        self.close_notice()
        self.words.setText(words)
        for number, (text, function) in enumerate(answers):
            button = QPushButton(text)
            button.setObjectName(f"notice-{number}")
            button.clicked.connect(lambda _checked=False, function=function: self._answer(function))
            self._row.addWidget(button)
            self.buttons.append(button)
        self.show()
        if self.buttons:
            self.buttons[-1].setFocus(Qt.FocusReason.OtherFocusReason)

    def _answer(self, function: Callable[[], None] | None) -> None:
        self.close_notice()
        if function is not None:
            function()

    def close_notice(self) -> None:
        """Nothing is asked any more."""
        for button in self.buttons:
            self._row.removeWidget(button)
            button.hide()
            button.deleteLater()
        self.buttons = []
        self.hide()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc: the last answer."""
        if event.key() == Qt.Key.Key_Escape and self.buttons:
            self.buttons[-1].click()
            return
        super().keyPressEvent(event)
