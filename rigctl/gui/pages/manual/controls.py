"""The middle column: safety box, then motor, brake and disc in a scroll area, then the release.

Job: put the boxes together, give them model and limits. Not its job: commands (page).
"""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QPushButton, QScrollArea, QStyle, QVBoxLayout, QWidget

from rigctl.gui.pages.manual.model import Action, ManualModel
from rigctl.gui.pages.manual.motion_boxes import DiscBox, SpeedBox, permit
from rigctl.gui.pages.manual.pressure_box import PressureBox
from rigctl.gui.pages.manual.safety_box import SafetyBox
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.entries import NumberRange


def scrolled(widget: QWidget, name: str) -> QScrollArea:
    """A widget that scrolls up and down when the window is too low for it."""
    area = QScrollArea()
    area.setObjectName(name)
    area.setWidgetResizable(True)
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setWidget(widget)
    return area


class Controls(QWidget):
    """Everything that moves something. Safety box and release are always in sight, the rest scrolls."""

    releaseAsked = Signal()

    def __init__(self, theme: ThemeKeeper, model: ManualModel, ranges: dict[str, NumberRange]) -> None:
        super().__init__()
        self._theme = theme
        self._model = model
        self.safety = SafetyBox(theme, model)
        self.motor = SpeedBox(theme, ranges)
        self.brake = PressureBox(theme, ranges)
        self.disc = DiscBox(theme, ranges)
        self.release = QPushButton(self.tr("Release pressure   (Space)"))
        self.release.setObjectName("release")
        self.release.clicked.connect(self.releaseAsked)
        boxes = QWidget()
        self._boxes = QVBoxLayout(boxes)
        for box in (self.motor, self.brake, self.disc):
            self._boxes.addWidget(box)
        self._boxes.addStretch(1)
        self._area = scrolled(boxes, "manual-controls")
        self._column = QVBoxLayout(self)
        self._column.addWidget(self.safety)
        self._column.addWidget(self._area, 1)
        self._column.addWidget(self.release)
        self.motor.changed.connect(self.show_context)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._column.setContentsMargins(self._theme.px(1), 0, self._theme.px(1), 0)
        self._column.setSpacing(self._theme.px(1))
        self._boxes.setContentsMargins(0, 0, 0, 0)
        self._boxes.setSpacing(self._theme.px(1))
        self.release.setStyleSheet(f"font-weight: bold; min-height: {self._theme.px(4)}px;")
        self._fit()

    def _fit(self) -> None:
        """As wide as the boxes need beside their scroll bar."""
        bar = self.style().pixelMetric(QStyle.PixelMetric.PM_ScrollBarExtent)
        boxes = self._area.widget()
        if boxes is not None:
            self._area.setMinimumWidth(boxes.minimumSizeHint().width() + bar)

    def setRanges(self, ranges: dict[str, NumberRange]) -> None:
        """Limits of another rig."""
        self.motor.setRanges(ranges)
        self.brake.setRanges(ranges)
        self.disc.setRanges(ranges)
        self._fit()
        self.show_context()

    def show_context(self) -> None:
        """The brake is judged at the speed in the field of the motor."""
        rig, speed = self._model.rig, self.motor.speed.value()
        self.brake.setContext(None if rig is None else rig.capabilities, speed or 0.0)

    def show_model(self) -> None:
        """The newest state."""
        state = self._model.state
        self.safety.show_model()
        for box in (self.motor, self.brake, self.disc):
            box.show_state(state, self._model)
            box.setEnabled(state.commanding)
        permit(
            self.release, self._model.may(Action.RELEASE),
            self.tr("Takes the pressure off at once and ends a course, a recording or heating"),
        )  # fmt: skip
