"""Colours, sizes and fonts of the window: one set of tokens, light and dark.

Job: the tokens, the style sheet made of them, pyqtgraph's colours, and the news that they have changed. Grey
while all is well; blue for set-points and selection, amber for a warning, red for an alarm or trip, green
only for "none measured, test passed". Contrast of text is at least 4.5 : 1 (WCAG 2.1, 1.4.3; tested). Not
its job: layout.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pyqtgraph as pg
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QColor, QFont, QPalette
from PySide6.QtWidgets import QApplication

GRID_PX = 8
ASSETS = Path(__file__).parent / "assets"


@dataclass(frozen=True)
class Theme:
    """Tokens of one look. Colours as "#rrggbb"."""

    name: str
    window: str
    panel: str
    field: str
    line: str
    text: str
    muted: str
    blue: str
    on_blue: str
    amber: str
    on_amber: str
    red: str
    on_red: str
    green: str
    plot: str
    plot_line: str
    pressure: str
    torque: str
    speed: str
    temperature: str
    friction: str
    sound: str

    @property
    def series(self) -> dict[str, str]:
        """Colour of each channel's line, by channel name ("mu" for friction)."""
        return {
            "pressure": self.pressure,
            "torque": self.torque,
            "speed": self.speed,
            "disc_temperature": self.temperature,
            "mu": self.friction,
            "microphone": self.sound,
        }


LIGHT = Theme(
    name="light", window="#e9eaec", panel="#f6f7f8", field="#ffffff", line="#b9bdc3",
    text="#1d2127", muted="#555c66",
    blue="#1f5fae", on_blue="#ffffff", amber="#f2b632", on_amber="#2b2100", red="#c3202b", on_red="#ffffff",
    green="#1e7145", plot="#ffffff", plot_line="#8a9099",
    pressure="#2b2f36", torque="#6a4c93", speed="#33707a", temperature="#8a5a2b", friction="#4a5a2f",
    sound="#3c4654",
)  # fmt: skip
DARK = Theme(
    name="dark", window="#202327", panel="#2a2e33", field="#191c1f", line="#4a5058",
    text="#e7e9ec", muted="#a4abb5",
    blue="#7db1f2", on_blue="#10161d", amber="#f2b632", on_amber="#2b2100", red="#ff6b6b", on_red="#1d0507",
    green="#67c58f", plot="#16181b", plot_line="#737a84",
    pressure="#d6d9de", torque="#b79ae0", speed="#79c0cc", temperature="#d9a26b", friction="#b3c782",
    sound="#b4bfcd",
)  # fmt: skip
THEMES = {theme.name: theme for theme in (LIGHT, DARK)}


class ThemeKeeper(QObject):
    """The look in force. `changed` is emitted after the application has taken it on."""

    changed = Signal()

    def __init__(self, app: QApplication, name: str = "light", scale: float = 1.0) -> None:
        super().__init__()
        self._app = app
        self._base_pt = 10.0
        self.current = THEMES.get(name, LIGHT)
        self.scale = scale
        app.setStyle("Fusion")
        self._apply()

    def set(self, *, name: str | None = None, scale: float | None = None) -> None:
        """Choose "light" or "dark", and the size of all text (0.8 to 2.0)."""
        self.current = THEMES.get(name or self.current.name, self.current)
        self.scale = min(max(scale or self.scale, 0.8), 2.0)
        self._apply()
        self.changed.emit()

    def font(self, size: str = "normal", *, bold: bool = False) -> QFont:
        """One of the three sizes of text: "small", "normal", "large"; figures of equal width."""
        points = {"small": 0.85, "normal": 1.0, "large": 1.7}[size] * self._base_pt * self.scale
        font = QFont(self._app.font())
        font.setPointSizeF(points)
        font.setBold(bold)
        return font

    def colour(self, name: str) -> QColor:
        """A token as QColor."""
        return QColor(getattr(self.current, name))

    def px(self, units: float) -> int:
        """Multiples of the 8 px grid, scaled with the text."""
        return round(units * GRID_PX * self.scale)

    def _apply(self) -> None:
        font = QFont(self._app.font())
        font.setFamilies(["DejaVu Sans", "Noto Sans", "Segoe UI", "Sans Serif"])
        font.setPointSizeF(self._base_pt * self.scale)
        font.setFeature(QFont.Tag("tnum"), 1)
        self._app.setFont(font)
        self._app.setPalette(_palette(self.current))
        self._app.setStyleSheet(style_sheet(self.current, self.scale))
        pg.setConfigOptions(
            background=self.current.plot, foreground=self.current.muted, antialias=False, useOpenGL=False,
            imageAxisOrder="row-major",
        )  # fmt: skip


def _palette(t: Theme) -> QPalette:
    palette = QPalette()
    roles = QPalette.ColorRole
    for role, colour in {
        roles.Window: t.window, roles.WindowText: t.text, roles.Base: t.field, roles.AlternateBase: t.panel,
        roles.Text: t.text, roles.Button: t.panel, roles.ButtonText: t.text, roles.ToolTipBase: t.field,
        roles.ToolTipText: t.text, roles.Highlight: t.blue, roles.HighlightedText: t.on_blue,
        roles.Link: t.blue,
        roles.PlaceholderText: t.muted, roles.Mid: t.line, roles.Dark: t.line,
    }.items():  # fmt: skip
        palette.setColor(role, QColor(colour))
    for role in (roles.Text, roles.WindowText, roles.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, role, QColor(t.plot_line))
    return palette


def _asset(name: str, theme: Theme) -> str:
    return (ASSETS / f"{name}-{theme.name}.svg").as_posix()


def style_sheet(t: Theme, scale: float) -> str:
    """The style sheet. Widgets ask for a look by the property "look": see the selectors."""
    u = max(round(GRID_PX * scale), 4)
    return f"""
    QWidget[look="panel"] {{ background: {t.panel}; border: 1px solid {t.line}; border-radius: 3px; }}
    QLabel[look="title"] {{ font-weight: bold; }}
    QLabel[look="muted"] {{ color: {t.muted}; }}
    QLabel[look="error"] {{ color: {t.red}; }}
    QLabel[look="warning"] {{ background: {t.amber}; color: {t.on_amber}; padding: 2px {u // 2}px; }}
    QLabel[look="alarm"] {{ background: {t.red}; color: {t.on_red}; padding: 2px {u // 2}px;
        font-weight: bold; }}
    QPushButton {{ padding: {u // 2}px {u}px; min-height: {2 * u}px; border: 1px solid {t.line};
        border-radius: 3px; background: {t.panel}; }}
    QPushButton:hover {{ border-color: {t.blue}; }}
    QPushButton:focus {{ border: 2px solid {t.blue}; }}
    QPushButton:pressed, QPushButton:checked {{ background: {t.blue}; color: {t.on_blue}; }}
    QPushButton:disabled {{ color: {t.plot_line}; }}
    QPushButton[look="primary"] {{ background: {t.blue}; color: {t.on_blue}; font-weight: bold; }}
    QPushButton[look="primary"]:disabled {{ background: {t.panel}; color: {t.plot_line}; }}
    QPushButton[look="stop"] {{ background: {t.red}; color: {t.on_red}; font-weight: bold;
        font-size: {round(14 * scale)}pt; min-width: {18 * u}px; min-height: {5 * u}px; border: 2px solid
        {t.text}; }}
    QPushButton[look="nav"] {{ text-align: left; border: none; border-radius: 0; background: transparent;
        padding: {u}px {2 * u}px; min-height: {3 * u}px; }}
    QPushButton[look="nav"]:hover {{ background: {t.panel}; }}
    QPushButton[look="nav"]:checked {{ background: {t.panel}; color: {t.text}; font-weight: bold;
        border-left: 4px solid {t.blue}; }}
    QLineEdit, QAbstractSpinBox, QComboBox, QPlainTextEdit, QTextEdit {{ background: {t.field};
        color: {t.text}; border: 1px solid {t.line}; border-radius: 2px; padding: {u // 4}px {u // 2}px;
        min-height: {2 * u + u // 2}px; }}
    QComboBox::drop-down {{ subcontrol-origin: padding; subcontrol-position: center right; border: none;
        width: {2 * u + u // 2}px; }}
    QComboBox::down-arrow {{ image: url("{_asset("arrow-down", t)}"); width: {u + u // 2}px; }}
    QAbstractSpinBox::up-button, QAbstractSpinBox::down-button {{ subcontrol-origin: border; border: none;
        background: transparent; width: {2 * u}px; }}
    QAbstractSpinBox::up-button {{ subcontrol-position: top right; }}
    QAbstractSpinBox::down-button {{ subcontrol-position: bottom right; }}
    QAbstractSpinBox::up-arrow {{ image: url("{_asset("arrow-up", t)}"); width: {u}px; }}
    QAbstractSpinBox::down-arrow {{ image: url("{_asset("arrow-down", t)}"); width: {u}px; }}
    QLineEdit:focus, QAbstractSpinBox:focus, QComboBox:focus, QPlainTextEdit:focus {{
        border: 2px solid {t.blue}; }}
    QLineEdit[wrong="true"], QAbstractSpinBox[wrong="true"], QPlainTextEdit[wrong="true"] {{
        border: 2px solid {t.red}; }}
    QCheckBox::indicator:unchecked, QListView::indicator:unchecked {{ width: 11px; height: 11px;
        border: 1px solid {t.muted}; border-radius: 2px; background: {t.field}; }}
    QTableView, QTreeView, QListView {{ background: {t.field}; alternate-background-color: {t.panel};
        border: 1px solid {t.line}; gridline-color: {t.line}; selection-background-color: {t.blue};
        selection-color: {t.on_blue}; }}
    QHeaderView::section {{ background: {t.panel}; color: {t.muted}; border: none;
        border-bottom: 1px solid {t.line}; padding: {u // 2}px; }}
    QGroupBox {{ border: 1px solid {t.line}; border-radius: 3px; margin-top: {2 * u}px; padding-top: {u}px; }}
    QGroupBox::title {{ subcontrol-origin: margin; left: {u}px; color: {t.muted}; }}
    QSplitter::handle {{ background: {t.line}; }}
    QToolTip {{ background: {t.field}; color: {t.text}; border: 1px solid {t.line}; padding: {u // 2}px; }}
    QProgressBar {{ border: 1px solid {t.line}; background: {t.field}; text-align: center;
        border-radius: 2px; }}
    QProgressBar::chunk {{ background: {t.muted}; }}
    QTabBar::tab {{ padding: {u // 2}px {2 * u}px; border: 1px solid {t.line}; background: {t.window};
        color: {t.muted}; }}
    QTabBar::tab:selected {{ background: {t.panel}; color: {t.text}; border-bottom: 3px solid {t.blue}; }}
    """
