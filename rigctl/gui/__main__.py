"""``python -m rigctl.gui``: what `rigctl gui` starts. Says what is missing before Qt is loaded.

Job: one clear message where there is no screen or no Qt. Not its job: the window (`rigctl.gui.main`).
"""

from __future__ import annotations

import importlib
import os
import sys

REMEDY = "On Debian or Ubuntu, from the repository: sudo sh .ci/system-packages --install"


def obstacle() -> str:
    """Why no window can be shown here; empty when one can."""
    if not any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")):
        return "there is no screen: DISPLAY and WAYLAND_DISPLAY are not set. The command line needs none."
    try:
        importlib.import_module("PySide6.QtWidgets")
    except ImportError as error:
        return f"Qt cannot be loaded ({error}). {REMEDY}"
    return ""


def main() -> int:
    """Show the window until it is closed, or say why not."""
    asks_for_help = {"-h", "--help"} & set(sys.argv[1:])
    if not asks_for_help and (problem := obstacle()):
        print(f"rigctl gui: {problem}", file=sys.stderr)
        return 1
    from rigctl.gui.main import main as show

    return show()


if __name__ == "__main__":
    sys.exit(main())
