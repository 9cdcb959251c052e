"""The QApplication of the window: name, settings, language, look.

Not its job: the window itself.
"""

from __future__ import annotations

import sys
from pathlib import Path

from PySide6.QtCore import QLibraryInfo, QLocale, QSettings, QTranslator
from PySide6.QtWidgets import QApplication

from rigctl.gui.theme import ThemeKeeper

TRANSLATIONS = Path(__file__).parent / "translations"
LANGUAGES = ("en", "de")


def make_application(arguments: list[str]) -> QApplication:
    """The one application of this process."""
    app = QApplication.instance()
    if not isinstance(app, QApplication):
        app = QApplication([sys.argv[0], *arguments])
    app.setApplicationName("rigctl")
    app.setOrganizationName("rigctl")
    app.setApplicationDisplayName("rigctl")
    return app


def window_settings(path: Path | None) -> QSettings:
    """What the window remembers: in the user's settings, or in a file of one's own."""
    if path is not None:
        return QSettings(str(path), QSettings.Format.IniFormat)
    return QSettings(QSettings.Format.IniFormat, QSettings.Scope.UserScope, "rigctl", "window")


def install_language(app: QApplication, language: str) -> list[QTranslator]:
    """Load the translation of window and Qt's own dialogs; numbers keep the point as decimal mark.

    Numbers are written as in program files and on the command line (1.5), in every language.
    """
    QLocale.setDefault(QLocale(QLocale.Language.C))
    app.setProperty("language", language)
    translators: list[QTranslator] = []
    if language == "en":
        return translators
    for name, folder in (
        (f"rigctl_{language}", str(TRANSLATIONS)),
        (f"qtbase_{language}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)),
    ):
        translator = QTranslator(app)
        if translator.load(name, folder):
            app.installTranslator(translator)
            translators.append(translator)
    return translators


def wanted_language(settings: QSettings, option: str | None) -> str:
    """From the command line, else as remembered, else the system's, else English."""
    wanted = option or str(settings.value("language", "")) or QLocale.system().name()[:2]
    return wanted if wanted in LANGUAGES else "en"


def make_theme(app: QApplication, settings: QSettings, option: str | None) -> ThemeKeeper:
    """The look as asked for, else as remembered."""
    scale = str(settings.value("text-scale", 1.0))
    try:
        size = float(scale)
    except ValueError:
        size = 1.0
    return ThemeKeeper(app, option or str(settings.value("theme", "light")), size)
