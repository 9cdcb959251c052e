"""What the three calibration procedures have in common: session, sampler, laboratory, head, saving.

Job: the frame of a procedure. Not its job: its steps.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from rigctl.calibration.record import Calibration
from rigctl.calibration.store import save
from rigctl.gui.pages.service.form import Facts, FactsForm
from rigctl.gui.pages.service.laboratory_client import LaboratoryClient
from rigctl.gui.pages.service.parts import label
from rigctl.gui.pages.service.sampler import LiveSampler
from rigctl.gui.services import Services
from rigctl.gui.work import Reporter


class Procedure(QWidget):
    """A guided calibration on a session. Subclasses fill `content`.

    Parameters
    ----------
    services : Services
    session : Session
        That is watched: run_dir, rig, simulated, file.
    folder : Path
        Where the calibrations of its rig are kept.
    """

    left = Signal()
    """The person goes back to the overview."""
    saved = Signal(object)
    """Path of the file that was kept."""

    def __init__(self, services: Services, session: Any, folder: Path) -> None:
        super().__init__()
        self.services = services
        self.session = session
        self.folder = folder
        self.theme = services.theme
        corrections = [calibration.correction for calibration in session.file.calibrations]
        self.sampler = LiveSampler(session.run_dir, corrections, self)
        self.laboratory: LaboratoryClient | None = None
        if session.simulated:
            self.laboratory = LaboratoryClient(session.run_dir, services.work, self)
        self.back = QPushButton(self.tr("← All calibrations"))
        self.back.setObjectName("procedure-back")
        self.back.setToolTip(self.tr("Leave this procedure; what was read and not saved is lost (Esc)"))
        self.back.setShortcut("Esc")
        self.back.clicked.connect(self.left)
        self.headline = label("", "title")
        self.message = label(wrap=True)
        self.message.setObjectName("procedure-message")
        head = QHBoxLayout()
        head.addWidget(self.back)
        head.addWidget(self.headline)
        head.addWidget(self.message, 1)
        self._head = head
        self.content = QHBoxLayout()
        self._layout = QVBoxLayout(self)
        self._layout.addLayout(head)
        self._layout.addLayout(self.content, 1)
        self.theme.changed.connect(self._restyle_frame)
        self._restyle_frame()

    def _restyle_frame(self) -> None:
        unit = self.theme.px(1)
        self._layout.setContentsMargins(unit, unit, unit, unit)
        self._layout.setSpacing(unit)
        self._head.setSpacing(2 * unit)
        self.content.setSpacing(2 * unit)

    @property
    def facts(self) -> FactsForm:
        """The form with operator and instrument."""
        raise NotImplementedError

    def unsaved(self) -> bool:
        """True when readings would be lost."""
        return False

    def say(self, text: str, look: str = "") -> None:
        """A line beside the title."""
        self.message.setProperty("look", look)
        self.message.style().polish(self.message)
        self.message.setText(("▲ " if look == "error" and text else "") + text)

    def keep(self, calibration: Calibration) -> None:
        """Save a result and say so."""
        self.facts.remember()
        self.services.work.in_thread(
            _save, self.folder, calibration, done=self._on_saved,
            failed=lambda why: self.say(self.tr("Not saved: {0}").format(why), "error"),
        )  # fmt: skip

    def _on_saved(self, path: Path) -> None:
        self.services.notify(
            self.tr("Saved as {0}; it holds from the next start of the rig").format(path.name)
        )
        self.saved.emit(path)

    def common(self, facts: Facts) -> dict[str, Any]:
        """Fields of the file that every quantity has."""
        return {
            "rig": self.session.rig.name, "operator": facts.operator, "instrument": facts.instrument,
            "reference": facts.reference, "valid_days": facts.valid_days,
        }  # fmt: skip

    def stop(self) -> None:
        """End timers, leave the ring."""
        self.sampler.close()
        if self.laboratory is not None:
            self.laboratory.close()


def _save(folder: Path, calibration: Calibration, _reporter: Reporter) -> Path:
    return save(folder, calibration)
