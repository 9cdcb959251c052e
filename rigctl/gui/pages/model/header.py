"""The head of the model page: which brake, compared with which, and where it begins to squeal, in words.

Job: two choices of files with their errors, three lines of text. Not its job: reading and computing.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from rigctl.gui.pages.model.brake_choice import BrakeChoice
from rigctl.gui.pages.model.data import BrakeFacts, Onsets, Poles
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.pages.model.words import now_text, onset_text
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.elided import ElidedLabel


class ModelHeader(QWidget):
    """Brake, brake to compare with, onset."""

    def __init__(self, state: ModelState, theme: ThemeKeeper, folder: Path) -> None:
        super().__init__()
        self._state, self._theme = state, theme
        self.brake = BrakeChoice(theme, folder)
        self.other = BrakeChoice(theme, folder, self.tr("nothing"))
        self.brake.combo.setObjectName("model-brake")
        self.other.combo.setObjectName("model-other")
        self.brake.combo.setToolTip(self.tr("Brake file to be studied; choose it again to read it again"))
        self.other.combo.setToolTip(
            self.tr(
                "Second brake file: its poles are drawn as hollow diamonds, at the same µ, pressure and k"
            )
        )
        self.onset, self.now, self.beside = ElidedLabel(), ElidedLabel(), ElidedLabel()
        self.onset.setObjectName("model-onset")
        self.now.setObjectName("model-now")
        for label in (self.now, self.beside):
            label.setProperty("look", "muted")
        self._arrange()
        self.brake.valueChanged.connect(state.open)
        self.other.valueChanged.connect(state.compare)
        state.brakeWrong.connect(self.brake.setError)
        state.otherWrong.connect(self.other.setError)
        state.brakeRead.connect(self._show_brake)
        state.otherRead.connect(self._show_other)
        state.polesFound.connect(self._show_poles)
        state.onsetsFound.connect(self._show_onsets)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _arrange(self) -> None:
        self._row = QHBoxLayout()
        for text, choice in ((self.tr("&Brake"), self.brake), (self.tr("Compare &with"), self.other)):
            label = QLabel(text)
            label.setBuddy(choice.combo)
            choice.combo.setAccessibleName(text.replace("&", ""))
            self._row.addWidget(label)
            self._row.addWidget(choice)
        self._words = QVBoxLayout()
        self._words.addWidget(self.onset)
        self._words.addWidget(self.now)
        self._words.addWidget(self.beside)
        self._row.addLayout(self._words, 1)
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._row)
        self._column.addWidget(self.brake.error)
        self._column.addWidget(self.other.error)

    def _restyle(self) -> None:
        px = self._theme.px
        self._row.setSpacing(px(1))
        self._words.setSpacing(px(0.25))
        self._words.setContentsMargins(px(2), 0, 0, 0)
        self._column.setSpacing(px(0.5))
        self._column.setContentsMargins(px(1), px(1), px(1), px(0.5))
        self.onset.setFont(self._theme.font("large", bold=True))
        for label in (self.now, self.beside):
            label.setFont(self._theme.font("normal"))

    def _show_brake(self, facts: BrakeFacts | None) -> None:
        if facts is None:
            self.onset.setText(self.tr("No brake"))
            self.now.setText(self.tr("Choose a brake file that can be read."))
            self.beside.clear()
        else:
            self.brake.combo.setToolTip(f"{facts.file.path}\n{facts.description}")

    def _show_other(self, facts: BrakeFacts | None) -> None:
        self.beside.setVisible(facts is not None)
        if facts is None:
            self.beside.clear()

    def _show_poles(self, poles: Poles) -> None:
        self.now.setText(now_text(poles.setting, poles.poles))

    def _show_onsets(self, onsets: Onsets) -> None:
        self.onset.setText(onset_text(onsets.own))
        other = self._state.other
        if onsets.other is not None and other is not None:
            self.beside.setText(self.tr("{0}: {1}").format(other.name, onset_text(onsets.other)))
