"""What a person does with live plots: follow, freeze, cursors, span, pictures; one set for a whole view.

Job: the row of buttons, the menu of the right button, the strip that says FROZEN. The buttons tell their
wishes by signals and show what they are told. Not its job: carrying them out (`view`).
"""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QMenu, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.format import quantity_text
from rigctl.gui.live.groups import SPANS_S
from rigctl.gui.live.ranges import clock_text
from rigctl.gui.theme import ThemeKeeper


class PlotTools(QWidget):
    """Buttons of a live view.

    Parameters
    ----------
    theme : ThemeKeeper
    """

    followPressed = Signal()
    frozenChanged = Signal(bool)
    cursorsChanged = Signal(bool)
    spanChanged = Signal(float)
    copyPressed = Signal(object)
    """Widget to copy; None is the whole view."""
    savePressed = Signal(object)
    """Widget to save; None is the whole view."""
    shownChanged = Signal(str, bool)
    """Panel or row, and whether it is to be shown."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.follow = QPushButton(self.tr("&Follow"))
        self.follow.setCheckable(True)
        self.follow.setChecked(True)
        self.follow.setToolTip(self.tr("Newest data at the right, automatic ranges (Home, or double click)"))
        self.freeze = QPushButton(self.tr("Free&ze"))
        self.freeze.setCheckable(True)
        self.freeze.setToolTip(self.tr("Hold the picture. Recording goes on."))
        self.cursors = QPushButton(self.tr("&Cursors"))
        self.cursors.setCheckable(True)
        self.cursors.setToolTip(self.tr("Two cursors, to be dragged, and their difference"))
        self.span = QComboBox()
        self.span.setToolTip(self.tr("Time that is shown while following"))
        for span_s in SPANS_S:
            self.span.addItem(quantity_text(span_s, "s", 0), span_s)
        self.span.setCurrentIndex(SPANS_S.index(12.0))
        self.show_button = QPushButton(self.tr("Sho&w"))
        self.show_button.setToolTip(self.tr("Which plots and channels are shown"))
        self.show_menu = QMenu(self.show_button)
        self.show_button.setMenu(self.show_menu)
        self.picture = QPushButton(self.tr("&Picture"))
        self.picture.setToolTip(self.tr("Copy or save all plots; for a single one, right click on it"))
        menu = QMenu(self.picture)
        menu.addAction(self.tr("Copy")).triggered.connect(lambda: self.copyPressed.emit(None))
        menu.addAction(self.tr("Save…")).triggered.connect(lambda: self.savePressed.emit(None))
        self.picture.setMenu(menu)
        self.frozen_mark = QLabel()
        self.frozen_mark.setProperty("look", "warning")
        self.frozen_mark.setWordWrap(True)
        self.frozen_mark.hide()
        self._lay_out()
        self.follow.clicked.connect(self._on_follow)
        self.freeze.toggled.connect(self.frozenChanged)
        self.cursors.toggled.connect(self.cursorsChanged)
        self.span.activated.connect(lambda _: self.spanChanged.emit(self.span.currentData()))

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.setSpacing(self._theme.px(0.5))
        for widget in (self.follow, self.freeze, self.cursors, self.span, self.show_button, self.picture):
            widget.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click leaves the keyboard to the page
            row.addWidget(widget)
        row.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(self._theme.px(0.5))
        column.addLayout(row)
        column.addWidget(self.frozen_mark)

    def _on_follow(self) -> None:
        self.follow.setChecked(True)
        self.followPressed.emit()

    def show_state(self, *, follow: bool, frozen_s: float | None, cursors: bool) -> None:
        """What is the case now; `frozen_s` is the rig time at which the picture stands, None when live."""
        for button, state in (
            (self.follow, follow), (self.freeze, frozen_s is not None), (self.cursors, cursors)
        ):  # fmt: skip
            with QSignalBlocker(button):
                button.setChecked(state)
        self.frozen_mark.setVisible(frozen_s is not None)
        if frozen_s is not None:
            at = clock_text(frozen_s, 0.1) if frozen_s > float("-inf") else "—"
            self.frozen_mark.setText(
                self.tr("❚❚ FROZEN at {0} of rig time. Recording goes on. Follow shows the present.").format(
                    at
                )
            )

    def set_choices(self, choices: Iterable[tuple[str, str, bool]]) -> None:
        """What can be shown: id, words, shown now. An empty id is a line between."""
        self.show_menu.clear()
        for key, words, shown in choices:
            if not key:
                self.show_menu.addSeparator()
                continue
            action = self.show_menu.addAction(words)
            action.setCheckable(True)
            action.setChecked(shown)
            action.toggled.connect(lambda on, key=key: self.shownChanged.emit(key, on))

    def menu_of(self, plot: QWidget) -> QMenu:
        """Menu of the right button for one plot; it goes when it is closed."""
        menu = QMenu(plot)
        menu.addAction(self.tr("Follow")).triggered.connect(self._on_follow)
        for words, button in (
            (self.tr("Freeze"), self.freeze), (self.tr("Cursors"), self.cursors)
        ):  # fmt: skip
            action = menu.addAction(words)
            action.setCheckable(True)
            action.setChecked(button.isChecked())
            action.toggled.connect(button.setChecked)
        menu.addSeparator()
        menu.addAction(self.tr("Copy picture")).triggered.connect(lambda: self.copyPressed.emit(plot))
        menu.addAction(self.tr("Save picture…")).triggered.connect(lambda: self.savePressed.emit(plot))
        menu.aboutToHide.connect(menu.deleteLater)
        return menu
