"""Settings of the window: language, look, size of text, folder of the campaigns.

Job: the inputs and what is remembered. Not its job: taking a look on (`rigctl.gui.theme`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QCoreApplication, Qt
from PySide6.QtWidgets import (
    QButtonGroup,
    QComboBox,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QRadioButton,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.service.parts import Form, Panel, label, set_wrong
from rigctl.gui.services import Services
from rigctl.gui.widgets.file_asking import ask_open

LANGUAGES = (("en", "English"), ("de", "Deutsch"))
LOOKS = ("light", "dark")
MIN_PERCENT, MAX_PERCENT = 80, 200


class WindowTab(QWidget):
    """What the window remembers."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        theme = self._theme = services.theme
        self.language = self._make_language()
        self.folder_error = label("", "error", wrap=True)
        self.folder_error.setObjectName("window-folder-error")
        self.folder_error.hide()
        self.later = label("", "muted", wrap=True)
        self.later.setObjectName("window-later")
        form = Form(theme)
        form.add(self.tr("Lan&guage"), self.language, self.tr("Of all texts; numbers keep the decimal point"))
        form.add(
            self.tr("Look"),
            self._make_looks(),
            self.tr("Light for bright rooms, dark for the control room at night"),
        )
        form.add(
            self.tr("&Size of text"), self._make_sizes(), self.tr("Also Ctrl + and Ctrl −; Ctrl 0 is 100 %")
        )
        form.add(
            self.tr("Data &folder"), self._make_folder(), self.tr("Where campaigns and calibrations are kept")
        )
        panel = Panel(theme, self.tr("This window"))
        panel.body.addWidget(form)
        panel.body.addWidget(self.folder_error)
        panel.body.addWidget(self.later)
        panel.setMaximumWidth(theme.px(100))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(*(theme.px(1),) * 4)
        layout.addWidget(panel)
        layout.addStretch(1)
        theme.changed.connect(self._show)
        self._show()

    def _make_language(self) -> QComboBox:
        language = QComboBox()
        language.setObjectName("window-language")
        for code, name in LANGUAGES:
            language.addItem(name, code)
        app = QCoreApplication.instance()
        spoken = app.property("language") if app is not None else ""  # as started; settings may name none
        present = str(self._services.settings.value("language", "") or spoken or "en")
        language.setCurrentIndex(max(language.findData(present), 0))
        language.activated.connect(self._on_language)
        return language

    def _make_looks(self) -> QWidget:
        theme = self._theme
        self._group = QButtonGroup(self)
        looks = QWidget()
        row = QHBoxLayout(looks)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(theme.px(2))
        self.looks: dict[str, QRadioButton] = {}
        for name, text in (("light", self.tr("&light")), ("dark", self.tr("&dark"))):
            button = QRadioButton(text)
            button.setObjectName(f"window-{name}")
            button.clicked.connect(lambda _checked=False, name=name: self._on_look(name))
            self._group.addButton(button)
            row.addWidget(button)
            self.looks[name] = button
        row.addStretch(1)
        return looks

    def _make_sizes(self) -> QWidget:
        theme = self._theme
        self.text_size = QSlider(Qt.Orientation.Horizontal)
        self.text_size.setObjectName("window-size")
        self.text_size.setRange(MIN_PERCENT // 10, MAX_PERCENT // 10)
        self.text_size.setPageStep(1)
        self.text_size.setTickPosition(QSlider.TickPosition.TicksBelow)
        self.size_text = label()
        self.size_text.setMinimumWidth(theme.px(6))
        self.text_size.valueChanged.connect(self._on_size)
        sizes = QWidget()
        size_row = QHBoxLayout(sizes)
        size_row.setContentsMargins(0, 0, 0, 0)
        size_row.addWidget(self.text_size, 1)
        size_row.addWidget(self.size_text)
        return sizes

    def _make_folder(self) -> QWidget:
        theme, services, settings = self._theme, self._services, self._services.settings
        self.folder = QLineEdit(str(settings.value("data-folder", "")) or str(services.data_folder))
        self.folder.setObjectName("window-folder")
        self.folder.editingFinished.connect(self._on_folder)
        self.choose = QPushButton(self.tr("&Choose …"))
        self.choose.setObjectName("window-choose")
        self.choose.setToolTip(self.tr("Choose another folder"))
        self.choose.clicked.connect(self._choose)
        folders = QWidget()
        folder_row = QHBoxLayout(folders)
        folder_row.setContentsMargins(0, 0, 0, 0)
        folder_row.setSpacing(theme.px(1))
        folder_row.addWidget(self.folder, 1)
        folder_row.addWidget(self.choose)
        return folders

    def activated(self) -> None:
        """Shown."""
        self._show()

    def deactivated(self) -> None:
        """Another tab."""

    def _show(self) -> None:
        self.looks[self._theme.current.name].setChecked(True)
        self.text_size.blockSignals(True)
        self.text_size.setValue(round(10 * self._theme.scale))
        self.text_size.blockSignals(False)
        self.size_text.setText(f"{round(100 * self._theme.scale)}\u202f%")

    def _on_language(self, _index: int) -> None:
        self._services.settings.setValue("language", self.language.currentData())
        self._say_later(self.tr("The language changes when the window is started again; the rig goes on."))

    def _on_look(self, name: str) -> None:
        self._theme.set(name=name)
        self._services.settings.setValue("theme", name)

    def _on_size(self, tenths: int) -> None:
        self._theme.set(scale=tenths / 10.0)
        self._services.settings.setValue("text-scale", self._theme.scale)

    def _choose(self) -> None:
        ask_open(self, self.tr("Data folder"), self._services.data_folder, "", self.set_folder, folders=True)

    def set_folder(self, folder: Path) -> None:
        """Take a folder."""
        self.folder.setText(str(folder))
        self._on_folder()

    def _on_folder(self) -> None:
        text = self.folder.text().strip()
        folder = Path(text).expanduser()
        problem = ""
        if not text or not folder.is_absolute():
            problem = self.tr("Give the whole path of a folder, from the root on.")
        elif folder.exists() and not folder.is_dir():
            problem = self.tr("This is a file. Give a folder.")
        elif not folder.exists() and not folder.parent.is_dir():
            problem = self.tr("There is no folder {0}. Make it first.").format(folder.parent)
        set_wrong(self.folder, bool(problem))
        self.folder_error.setText("▲ " + problem)
        self.folder_error.setVisible(bool(problem))
        if not problem and folder != self._services.data_folder:
            self._services.settings.setValue("data-folder", str(folder))
            self._say_later(self.tr("The data folder changes when the window is started again."))

    def _say_later(self, text: str) -> None:
        self.later.setText(text)
