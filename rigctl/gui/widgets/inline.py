"""Questions in place of a dialog: a confirmation, and a line to be filled in.

Job: `InlineConfirm` says what will happen and waits for one of two buttons; `AskLine` takes a text. Both show
themselves by `ask()` and hide when answered; Esc cancels. Not their job: what the answer does.
"""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.theme import ThemeKeeper


class InlineConfirm(QWidget):
    """What will happen, [yes], [Cancel]."""

    confirmed = Signal()
    cancelled = Signal()

    def __init__(self, theme: ThemeKeeper, name: str, yes: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.question = QLabel()
        self.question.setWordWrap(True)
        self.question.setObjectName(f"{name}-question")
        self.yes = QPushButton(yes)
        self.yes.setObjectName(f"{name}-yes")
        self.yes.setProperty("look", "primary")
        self.no = QPushButton(self.tr("Cancel"))
        self.no.setObjectName(f"{name}-no")
        self.no.setToolTip(self.tr("Do nothing (Esc)"))
        row = QHBoxLayout()
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(theme.px(1))
        row.addWidget(self.yes)
        row.addWidget(self.no)
        row.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(theme.px(1))
        column.addWidget(self.question)
        column.addLayout(row)
        self.yes.clicked.connect(self._on_yes)
        self.no.clicked.connect(self.cancel)
        self.hide()

    def ask(self, question: str) -> None:
        """Show the question; [Cancel] has the focus, so that a stray key does nothing."""
        self.question.setText(question)
        self.show()
        self.no.setFocus(Qt.FocusReason.OtherFocusReason)

    def cancel(self) -> None:
        """Answer no."""
        if not self.isHidden():
            self.hide()
            self.cancelled.emit()

    def _on_yes(self) -> None:
        self.hide()
        self.confirmed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc cancels."""
        if event.key() == Qt.Key.Key_Escape:
            self.cancel()
        else:
            super().keyPressEvent(event)


class AskLine(QWidget):
    """A line of text to be given: label, field, [done], [Cancel]."""

    given = Signal(str)
    cancelled = Signal()

    def __init__(self, theme: ThemeKeeper, name: str, done: str, *, required: bool = True) -> None:
        super().__init__()
        self.setObjectName(name)
        self._required = required
        self.label = QLabel()
        self.label.setWordWrap(True)
        self.edit = QLineEdit()
        self.edit.setObjectName(f"{name}-text")
        self.edit.setMaxLength(500)
        self.done = QPushButton(done)
        self.done.setObjectName(f"{name}-done")
        self.done.setProperty("look", "primary")
        self.no = QPushButton(self.tr("Cancel"))
        self.no.setObjectName(f"{name}-cancel")
        self.no.setToolTip(self.tr("Do nothing (Esc)"))
        row = QHBoxLayout()
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(theme.px(1))
        row.addWidget(self.edit, 1)
        row.addWidget(self.done)
        row.addWidget(self.no)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(theme.px(0.5))
        column.addWidget(self.label)
        column.addLayout(row)
        self.edit.textChanged.connect(self._on_text)
        self.edit.returnPressed.connect(self._on_done)
        self.done.clicked.connect(self._on_done)
        self.no.clicked.connect(self.cancel)
        self._on_text("")
        self.hide()

    def ask(self, label: str, placeholder: str = "", text: str = "") -> None:
        """Show the line, empty, with the cursor in it."""
        self.label.setText(label)
        self.edit.setPlaceholderText(placeholder)
        self.edit.setText(text)
        self.show()
        self.edit.setFocus(Qt.FocusReason.OtherFocusReason)

    def cancel(self) -> None:
        """Give nothing."""
        if not self.isHidden():
            self.hide()
            self.cancelled.emit()

    def _on_text(self, text: str) -> None:
        self.done.setEnabled(bool(text.strip()) or not self._required)

    def _on_done(self) -> None:
        text = self.edit.text().strip()
        if text or not self._required:
            self.hide()
            self.given.emit(text)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc cancels."""
        if event.key() == Qt.Key.Key_Escape:
            self.cancel()
        else:
            super().keyPressEvent(event)
