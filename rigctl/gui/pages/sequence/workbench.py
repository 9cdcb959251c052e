"""The three columns of the page: list of sequences, editor, and what becomes of the program.

Job: layout. Not its job: what is shown in them (`page`).
"""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QScrollArea, QSplitter, QStackedWidget, QVBoxLayout, QWidget

from rigctl.gui.pages.sequence.editor import SequenceEditor
from rigctl.gui.pages.sequence.preview import CoursePlots
from rigctl.gui.pages.sequence.program_list import ProgramList
from rigctl.gui.pages.sequence.start_panel import StartPanel
from rigctl.gui.pages.sequence.summary import FaultList, Figures, RigChoice
from rigctl.gui.theme import ThemeKeeper


class RightColumn(QWidget):
    """Rig, figures, course, faults, and below them the way into a run, always in sight."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.rig_choice = RigChoice(theme)
        self.figures = Figures(theme)
        self.preview = CoursePlots(theme)
        self.fault_list = FaultList(theme)
        self.start = StartPanel(theme)
        inner = QWidget()
        self._upper = QVBoxLayout(inner)
        self._upper.setContentsMargins(0, 0, 0, 0)
        for widget, stretch in (
            (self.rig_choice, 0),
            (self.figures, 0),
            (self.preview, 1),
            (self.fault_list, 0),
        ):
            self._upper.addWidget(widget, stretch)
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QScrollArea.Shape.NoFrame)
        self._area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setWidget(inner)
        self._column = QVBoxLayout(self)
        self._column.addWidget(self._area, 1)
        self._column.addWidget(self.start)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        unit = self._theme.px(1)
        self._column.setContentsMargins(unit, unit, unit, unit)
        self._column.setSpacing(unit)
        self._upper.setSpacing(unit)
        self._area.setMinimumWidth(24 * unit)


class Workbench(QSplitter):
    """The columns side by side."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__(Qt.Orientation.Horizontal)
        self.program_list = ProgramList(theme)
        self.editor = SequenceEditor(theme)
        self.right = RightColumn(theme)
        nothing = QLabel(self.tr("The program has no sequence.\nAdd one on the left."))
        nothing.setAlignment(Qt.AlignmentFlag.AlignCenter)
        nothing.setProperty("look", "muted")
        self._middle = QStackedWidget()
        self._middle.addWidget(self.editor)
        self._middle.addWidget(nothing)
        self.setChildrenCollapsible(False)
        self.setHandleWidth(1)
        for number, (widget, stretch) in enumerate(
            ((self.program_list, 2), (self._middle, 6), (self.right, 4))
        ):
            self.addWidget(widget)
            self.setStretchFactor(number, stretch)
        self.setSizes([theme.px(26), theme.px(74), theme.px(42)])

    def show_editor(self, on: bool) -> None:
        """The editor, or that there is nothing to edit."""
        self._middle.setCurrentIndex(0 if on else 1)
