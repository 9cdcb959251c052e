"""Listen to a braking: play, equal loudness, save as WAV, and what is wrong with it.

Job: the buttons above the plots of a braking. Not its job: playing (`player`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QLabel, QPushButton, QVBoxLayout, QWidget

from rigctl.core.channels import MICROPHONE
from rigctl.gui.format import number_text
from rigctl.gui.pages.data import remote
from rigctl.gui.pages.data.player import Player
from rigctl.gui.services import Services
from rigctl.gui.widgets.file_asking import ask_save
from rigctl.gui.widgets.flow import FlowLayout


class SoundBar(QWidget):
    """For one braking at a time."""

    position = Signal(object)
    """Time that is heard, s; None while nothing is."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        self._path: Path | None = None
        self._rate_hz = 0.0
        self._name = ""
        self.player = Player(services.work, self)
        self.play = QPushButton()
        self.play.setObjectName("data-play")
        self.play.clicked.connect(self._on_play)
        self.equal = QCheckBox(self.tr("&Equal loudness"))
        self.equal.setObjectName("data-equal-loudness")
        self.equal.setChecked(True)
        self.equal.setToolTip(
            self.tr(
                "Every braking sounds equally loud. Off: all with one gain, so that they can be compared."
            )
        )
        self.save = QPushButton(self.tr("Save as &WAV…"))
        self.save.setObjectName("data-save-wav")
        self.save.setToolTip(
            self.tr("The sound as recorded, 16 bit; Pa per count stands in the file's comment")
        )
        self.save.clicked.connect(self._on_save)
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setTextFormat(Qt.TextFormat.PlainText)
        self.words.setProperty("look", "muted")
        self.words.setObjectName("data-sound-words")
        self._flow = FlowLayout()
        for widget in (self.play, self.equal, self.save):
            self._flow.addWidget(widget)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addLayout(self._flow)
        self._column.addWidget(self.words)
        self.player.started.connect(self._on_started)
        self.player.position.connect(self.position.emit)
        self.player.stopped.connect(self._on_stopped)
        self.player.failed.connect(self._say)
        services.theme.changed.connect(self._restyle)
        self._restyle()
        self._show_button()
        self.show_braking(None, "", None)

    def _restyle(self) -> None:
        self._flow.setSpacing(self._services.theme.px(1))
        self._column.setSpacing(self._services.theme.px(0.5))

    def add(self, widget: QWidget) -> None:
        """A further button at the right end."""
        self._flow.addWidget(widget)

    def show_braking(self, path: Path | None, name: str, rate_hz: float | None) -> None:
        """Another braking; its rate is None when it has no sound."""
        self.player.stop()
        self._path = path if rate_hz else None
        self._rate_hz, self._name = rate_hz or 0.0, name
        for widget in (self.play, self.save, self.equal):
            widget.setEnabled(self._path is not None)
        self._say(self.tr("Recorded without sound") if path is not None and not rate_hz else "")

    def _on_play(self) -> None:
        if self.player.busy:
            self.player.stop()
        elif self._path is not None:
            self._say(self.tr("Preparing …"))
            self.player.play(self._path, self.equal.isChecked(), self._rate_hz)
            self._show_button()

    def _on_started(self, gain_db: float) -> None:
        if self.equal.isChecked():
            self._say(self.tr("Louder by {0} dB").format(number_text(gain_db, 0)))
        else:
            self._say(self.tr("20 Pa is full scale"))
        self._show_button()

    def _on_stopped(self) -> None:
        self.position.emit(None)
        self._show_button()
        if self.words.text() == self.tr("Preparing …"):
            self._say("")

    def _show_button(self) -> None:
        busy = self.player.busy
        self.play.setText(self.tr("■ Sto&p") if busy else self.tr("▶ &Play"))
        self.play.setToolTip(
            self.tr("Stop the sound") if busy else self.tr("Listen to the microphone's sound")
        )

    def _on_save(self) -> None:
        if self._path is None:
            return
        source = self._path
        ask_save(
            self,
            self.tr("Save the sound"),
            Path.home() / f"{self._name}.wav",
            self.tr("Sound (*.wav)"),
            lambda target: self.save_to(source, target),
        )

    def save_to(self, source: Path, target: Path) -> None:
        """Save the sound of a braking file."""
        self._services.work.in_process(
            remote.save_wav, source, target,
            done=lambda path: self._services.notify(self.tr("Saved as {0}").format(path)),
            failed=self._services.notify,
            lane=remote.LANE,
        )  # fmt: skip

    def _say(self, words: str) -> None:
        self.words.setText(words[:1].upper() + words[1:])
        self.words.setVisible(bool(words))


def sound_rate_hz(summary: dict) -> float | None:
    """Sampling rate of the microphone, None when there is none."""
    spec = summary.get("channels", {}).get(MICROPHONE)
    return float(spec["rate_hz"]) if spec else None
