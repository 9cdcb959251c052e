"""The main window: frame, navigation, pages, and what holds everywhere (STOP, F1, look, closing).

Job: put the parts together and remember the layout. Not its job: what the parts show.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QEvent, QObject, QSettings, Qt
from PySide6.QtGui import QCloseEvent, QKeyEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QApplication,
    QButtonGroup,
    QHBoxLayout,
    QMainWindow,
    QMessageBox,
    QPushButton,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.format import clock_text
from rigctl.gui.frame.alarmbar import AlarmBar
from rigctl.gui.frame.statebar import RigFrame, StateBar
from rigctl.gui.pages import PAGES
from rigctl.gui.pages.base import Page
from rigctl.gui.rig.alarm_list import Alarm
from rigctl.gui.rig.alarms import AlarmModel
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.state import RigState
from rigctl.gui.services import Services
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.work import Work

WINDOW_TITLE = "rigctl"
START_SIZE = (1440, 900)


class MainWindow(QMainWindow):
    """The operator's window."""

    def __init__(
        self, theme: ThemeKeeper, settings: QSettings, rig: RigConnection, data: Path, configs: Path
    ) -> None:
        super().__init__()
        self.setWindowTitle(WINDOW_TITLE)
        self.work = Work(self)
        self.rig = rig
        self.alarms = AlarmModel(rig, self.work, self)
        self.services = Services(
            rig, self.work, theme, settings, data, configs, self.navigate, self._notify, self.alarms
        )
        self._theme = theme
        self._settings = settings
        self._pages: dict[str, Page] = {}
        self._shown: Page | None = None
        self.state_bar = StateBar(theme)
        self.alarm_bar = AlarmBar(theme)
        self.frame = RigFrame(theme)
        self.stack = QStackedWidget()
        self._buttons: dict[str, QPushButton] = {}
        self._build()
        rig.stateChanged.connect(self._show_state)
        rig.refused.connect(self._notify)
        self.alarm_bar.stopPressed.connect(rig.stop)
        self.alarm_bar.acknowledgePressed.connect(self.alarms.acknowledge_newest)
        self.alarms.newestChanged.connect(self._show_alarm)
        self._app().installEventFilter(self)
        self._restore()

    def _app(self) -> QApplication:
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        return app

    def _build(self) -> None:
        self._navigation = navigation = QWidget()
        column = QVBoxLayout(navigation)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        group = QButtonGroup(self)
        for number, entry in enumerate(PAGES, start=1):
            button = QPushButton(entry.title_text())
            button.setObjectName(f"nav-{entry.page_id}")
            button.setProperty("look", "nav")
            button.setCheckable(True)
            button.setToolTip(self.tr("Alt+{0}").format(number))
            button.clicked.connect(partial(self.navigate, entry.page_id))
            QShortcut(QKeySequence(f"Alt+{number}"), self, partial(self.navigate, entry.page_id))
            group.addButton(button)
            column.addWidget(button)
            self._buttons[entry.page_id] = button
        column.addStretch(1)
        column.addWidget(self._look_buttons())
        self._respace()
        self._theme.changed.connect(self._respace)
        middle = QHBoxLayout()
        middle.setSpacing(0)
        middle.addWidget(navigation)
        middle.addWidget(self.stack, 1)
        layout = QVBoxLayout(self.frame)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.state_bar)
        layout.addLayout(middle, 1)
        layout.addWidget(self.alarm_bar)
        self.setCentralWidget(self.frame)
        for keys, action in (
            ("F1", self.show_help),
            ("Ctrl++", partial(self._zoom, 1.1)),
            ("Ctrl+=", partial(self._zoom, 1.1)),
            ("Ctrl+-", partial(self._zoom, 1 / 1.1)),
            ("Ctrl+0", partial(self._zoom, 0.0)),
        ):
            QShortcut(QKeySequence(keys), self, action)

    def _respace(self) -> None:
        self._navigation.setFixedWidth(self._theme.px(17))

    def _look_buttons(self) -> QWidget:
        box = QWidget()
        layout = QVBoxLayout(box)
        layout.setSpacing(self._theme.px(0.5))
        self.look = QPushButton(self.tr("Light / dark"))
        self.look.setToolTip(self.tr("Change between the light and the dark look"))
        self.look.clicked.connect(self._other_look)
        help_button = QPushButton(self.tr("Help (F1)"))
        help_button.clicked.connect(self.show_help)
        layout.addWidget(self.look)
        layout.addWidget(help_button)
        return box

    # -- pages ------------------------------------------------------------------------------------

    def page(self, page_id: str) -> Page:
        """The page of that id; made and restored when first asked for."""
        if page_id not in self._pages:
            entry = next(entry for entry in PAGES if entry.page_id == page_id)
            page = entry.make(self.services)
            self._pages[page_id] = page
            self.stack.addWidget(page)
            self._settings.beginGroup(f"page-{page_id}")
            page.restore_layout(self._settings)
            self._settings.endGroup()
        return self._pages[page_id]

    def navigate(self, page_id: str, _checked: bool = False, **what: Any) -> None:
        """Show a page; with keywords, let it open something particular."""
        page = self.page(page_id)
        if page is not self._shown:
            if self._shown is not None:
                self._shown.deactivated()
            self._shown = page
            self.stack.setCurrentWidget(page)
            page.activated()
        self._buttons[page_id].setChecked(True)
        if what:
            page.open(**what)

    # -- news -------------------------------------------------------------------------------------

    def _show_state(self, state: RigState) -> None:
        self.state_bar.show_state(state)
        self.frame.show_kind(state.simulated)

    def _notify(self, text: str) -> None:
        self.alarm_bar.show_news(text)

    def _show_alarm(self, alarm: Alarm | None) -> None:
        if alarm is None:
            self.alarm_bar.show_alarm("", severity="")
            return
        times = self.tr(" ({0} times)").format(alarm.count) if alarm.count > 1 else ""
        text = f"{clock_text(alarm.last_utc)}  {alarm.words}{times} {alarm.remedy}".rstrip()
        self.alarm_bar.show_alarm(text, severity=alarm.severity)

    # -- what holds everywhere --------------------------------------------------------------------

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """F12 stops, whatever has the focus and whatever dialog is open."""
        if (
            event.type() in (QEvent.Type.KeyPress, QEvent.Type.ShortcutOverride)
            and isinstance(event, QKeyEvent)
            and event.key() == Qt.Key.Key_F12
        ):
            if event.type() == QEvent.Type.KeyPress and not event.isAutoRepeat():
                self.rig.stop()
            event.accept()
            return True
        return super().eventFilter(watched, event)

    def show_help(self) -> None:
        """F1: what this page is for, and its keys."""
        page = self.stack.currentWidget()
        text = page.help_text() if isinstance(page, Page) else ""
        box = QMessageBox(self)
        box.setWindowTitle(self.tr("Help"))
        box.setTextFormat(Qt.TextFormat.RichText)
        box.setText(text or self.tr("No help for this page."))
        box.setInformativeText(
            self.tr("Alt+1 … Alt+6 pages · F12 software stop · Ctrl + and Ctrl − size of text · F1 this help")
        )
        box.setModal(False)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.show()

    def _other_look(self) -> None:
        self._theme.set(name="dark" if self._theme.current.name == "light" else "light")
        self._settings.setValue("theme", self._theme.current.name)

    def _zoom(self, factor: float) -> None:
        self._theme.set(scale=self._theme.scale * factor if factor else 1.0)
        self._settings.setValue("text-scale", self._theme.scale)

    # -- beginning and end ------------------------------------------------------------------------

    def _restore(self) -> None:
        self.resize(*START_SIZE)
        geometry = self._settings.value("geometry")
        if geometry is not None:
            self.restoreGeometry(geometry)
        page = str(self._settings.value("page", "manual"))
        self.navigate(page if page in self._buttons else "manual")

    def closeEvent(self, event: QCloseEvent) -> None:
        """Ask about unsaved work; the rig is not touched."""
        unsaved = [line for page in self._pages.values() for line in page.unsaved()]
        if unsaved and not self._may_lose(unsaved):
            event.ignore()
            return
        self._settings.setValue("geometry", self.saveGeometry())
        for page_id, page in self._pages.items():
            self._settings.beginGroup(f"page-{page_id}")
            page.save_layout(self._settings)
            self._settings.endGroup()
            if page is self.stack.currentWidget():
                self._settings.setValue("page", page_id)
                page.deactivated()
            page.closing()
        self._app().removeEventFilter(self)
        self.rig.close()
        self.work.close()
        super().closeEvent(event)

    def _may_lose(self, unsaved: list[str]) -> bool:
        answer = QMessageBox.question(
            self,
            self.tr("Unsaved changes"),
            self.tr("Close without saving?") + "\n\n" + "\n".join(unsaved),
            QMessageBox.StandardButton.Discard | QMessageBox.StandardButton.Cancel,
            QMessageBox.StandardButton.Cancel,
        )
        return answer == QMessageBox.StandardButton.Discard
