"""The window's process: options, application, window, until it is closed.

Job: put the parts together. Not its job: whether there is a screen at all (`rigctl.gui.__main__`).
"""

from __future__ import annotations

import argparse
import signal
import sys
from pathlib import Path

from PySide6.QtCore import QTimer

from rigctl.gui.application import (
    LANGUAGES,
    install_language,
    make_application,
    make_theme,
    wanted_language,
    window_settings,
)
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.window import MainWindow


def parse(arguments: list[str]) -> argparse.Namespace:
    """Options of the window."""
    parser = argparse.ArgumentParser(prog="rigctl gui", description="The operator's window.")
    parser.add_argument(
        "--data", type=Path, help="folder of the campaigns [as chosen in the window, or data]"
    )
    parser.add_argument(
        "--configs", type=Path, default=Path("configs"), help="folder of rigs, programs [configs]"
    )
    parser.add_argument("--language", choices=LANGUAGES, help="[system's]")
    parser.add_argument("--theme", choices=("light", "dark"), help="[as left]")
    parser.add_argument("--page", help="page to begin with: manual, sequence, run, data, model, service")
    parser.add_argument("--settings", type=Path, help="file of the window's settings [user's]")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    """Show the window until it is closed."""
    options = parse(sys.argv[1:] if arguments is None else arguments)
    app = make_application([])
    settings = window_settings(options.settings)
    translators = install_language(app, wanted_language(settings, options.language))
    theme = make_theme(app, settings, options.theme)
    data: Path = (options.data or Path(str(settings.value("data-folder", "")) or "data")).resolve()
    rig = RigConnection(data)
    window = MainWindow(theme, settings, rig, data, options.configs.resolve())
    if options.page:
        window.navigate(options.page)
    window.show()
    rig.start()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: window.close())
    ticker = QTimer()  # lets Python see signals while Qt waits
    ticker.timeout.connect(lambda: None)
    ticker.start(200)
    code = app.exec()
    del translators
    return code
