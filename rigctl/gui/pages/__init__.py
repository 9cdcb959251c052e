"""The pages of the window, in the order of the navigation; each is loaded when it is first shown.

Job: names and places of the pages. Not its job: their contents.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

if TYPE_CHECKING:
    from rigctl.gui.pages.base import Page
    from rigctl.gui.services import Services


@dataclass(frozen=True)
class PageEntry:
    """One page: its id, title (to be translated), and "module:Class"."""

    page_id: str
    title: str
    target: str

    def title_text(self) -> str:
        """Title in the language of the window."""
        return QCoreApplication.translate("pages", self.title)

    def make(self, services: Services) -> Page:
        """Import and build the page."""
        module, _, name = self.target.partition(":")
        return getattr(importlib.import_module(module), name)(services)


_TITLES = (  # QT_TRANSLATE_NOOP marks them for lupdate
    ("manual", QT_TRANSLATE_NOOP("pages", "Manual")),
    ("sequence", QT_TRANSLATE_NOOP("pages", "Sequence")),
    ("run", QT_TRANSLATE_NOOP("pages", "Run")),
    ("data", QT_TRANSLATE_NOOP("pages", "Data")),
    ("model", QT_TRANSLATE_NOOP("pages", "Model")),
    ("service", QT_TRANSLATE_NOOP("pages", "Service")),
)
PAGES = tuple(
    PageEntry(page_id, str(title), f"rigctl.gui.pages.{page_id}.page:{page_id.capitalize()}Page")
    for page_id, title in _TITLES
)
