"""The run page."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QVBoxLayout

from rigctl.gui.pages.base import Page
from rigctl.gui.services import Services


class RunPage(Page):
    """The run page."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        QVBoxLayout(self).addWidget(QLabel("run"))
