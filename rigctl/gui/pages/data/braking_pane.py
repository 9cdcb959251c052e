"""A braking opened: sound, all channels on one time axis, spectrogram, events, results, notes, metadata.

Job: read it in the worker process and show it. Not its job: choosing it (the table), writing notes
(`Annotator`).
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QLabel, QMenu, QPushButton, QSplitter, QTabWidget, QVBoxLayout, QWidget

from rigctl.analysis.braking_view import LEVEL, MU, BrakingView
from rigctl.core.channels import DISC_TEMPERATURE, MICROPHONE, PRESSURE, SPEED, TORQUE
from rigctl.gui.format import frequency_text, number_text, quantity_text
from rigctl.gui.pages.data import remote
from rigctl.gui.pages.data.columns import state_text
from rigctl.gui.pages.data.details import EventsTable, LinesTable, MarksTable
from rigctl.gui.pages.data.entry import Entry
from rigctl.gui.pages.data.marks import marks_of
from rigctl.gui.pages.data.notes import NotesPanel
from rigctl.gui.pages.data.results import metadata_lines, result_lines
from rigctl.gui.pages.data.sound_bar import SoundBar, sound_rate_hz
from rigctl.gui.pages.data.time_rows import ROWS, SPECTROGRAM, TimeRows
from rigctl.gui.services import Services
from rigctl.gui.widgets.elided import ElidedLabel
from rigctl.gui.work import Job
from rigctl.recording.annotations import Annotation


class BrakingPane(QWidget):
    """One braking."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        self._entry: Entry | None = None
        self._path: Path | None = None
        self._job: Job | None = None
        self._stamp: tuple[int, int] | None = None
        self._said = Annotation()
        self._problem = ""
        self.view: BrakingView | None = None
        theme = services.theme
        self.title = ElidedLabel()
        self.title.setObjectName("data-braking-title")
        self.title.setProperty("look", "title")
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setTextFormat(Qt.TextFormat.PlainText)
        self.words.setObjectName("data-braking-words")
        self.sound = SoundBar(services)
        self.rows = TimeRows(theme, services.notify)
        self.rows.titles = self._row_titles()
        self.rows_button = QPushButton(self.tr("&Rows"))
        self.rows_button.setObjectName("data-row-choice")
        self.rows_button.setToolTip(
            self.tr("Which rows are shown; where there is little room, the large view shows all")
        )
        self.switches: dict[str, QAction] = {}
        self._make_row_menu()
        self.sound.add(self.rows_button)
        self.events = EventsTable(theme)
        self.results = LinesTable(
            theme, "data-results", (self.tr("Result"), self.tr("Value"), self.tr("Unit")), right=(1,)
        )
        self.metadata = LinesTable(theme, "data-metadata", (self.tr("Name"), self.tr("Value")))
        self.notes = NotesPanel(theme)
        self.marks = MarksTable(theme)
        self.tabs = QTabWidget()
        self.tabs.setObjectName("data-details")
        self.tabs.setDocumentMode(True)
        self._make_layout()
        self.events.chosen.connect(self.rows.show_event)
        self.marks.chosen.connect(self.rows.show_event)
        self.sound.position.connect(self.rows.set_play)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.show_nothing()

    def _make_row_menu(self) -> None:
        menu = QMenu(self)
        for name in ROWS:
            switch = menu.addAction(self._row_words(name))
            switch.setObjectName(f"data-row-{name}")
            switch.setCheckable(True)
            switch.setChecked(name in self.rows.shown)
            switch.toggled.connect(partial(self.rows.set_shown, name))
            self.switches[name] = switch
        self.rows_button.setMenu(menu)

    def _make_layout(self) -> None:
        for widget, text in (
            (self.events, self.tr("Events")),
            (self.results, self.tr("Results")),
            (self.notes, self.tr("Notes")),
            (self.marks, self.tr("Marks")),
            (self.metadata, self.tr("Metadata")),
        ):
            self.tabs.addTab(widget, text)
        self.split = QSplitter(Qt.Orientation.Vertical)
        self.split.addWidget(self.rows)
        self.split.addWidget(self.tabs)
        self.split.setStretchFactor(0, 3)
        self.split.setStretchFactor(1, 1)
        self.split.setChildrenCollapsible(True)
        self._column = QVBoxLayout(self)
        self._column.addWidget(self.title)
        self._column.addWidget(self.words)
        self._column.addWidget(self.sound)
        self._column.addWidget(self.split, 1)

    # -- what is shown ------------------------------------------------------------------------------

    def show_nothing(self) -> None:
        """No braking is chosen."""
        self._entry = self._path = self.view = self._stamp = None
        self._problem = ""
        self._drop_job()
        self.title.setText(self.tr("No braking chosen"))
        self._say(self.tr("Choose a braking in the table, or click a dot or a cell in a figure."))
        self.sound.show_braking(None, "", None)
        self._fill(None)

    def show_entry(self, entry: Entry, campaign: Path, said: Annotation) -> None:
        """Open a braking; only its words are renewed when it is open already and its file has not changed."""
        path = entry.path(campaign)
        same = self._path == path and (self.view is not None or self._job is not None)
        self._entry, self._path = entry, path
        self.title.setText(self._title(entry))
        self._show_words(said)
        stamp = _stamp(path)
        if same and stamp == self._stamp:
            return
        self._stamp = stamp
        self._problem = ""
        self._drop_job()
        self.sound.show_braking(None, "", None)
        self._said = said
        self._job = self._services.work.in_process(
            remote.view, path, done=partial(self._on_view, path), failed=partial(self._on_failed, path),
            lane=remote.LANE,
        )  # fmt: skip

    @property
    def busy(self) -> bool:
        """True while the braking is being read."""
        return self._job is not None

    def stop_sound(self) -> None:
        """Silence."""
        self.sound.player.stop()

    def set_wide(self, wide: bool) -> None:
        """Tables beside the plots instead of below them."""
        self.split.setOrientation(Qt.Orientation.Horizontal if wide else Qt.Orientation.Vertical)
        QTimer.singleShot(0, self, self._share_room)  # when the pane has its new size

    def _share_room(self) -> None:
        """Two thirds for the plots."""
        length = max(self.split.width(), self.split.height())
        self.split.setSizes([2 * length // 3, length // 3])

    def _drop_job(self) -> None:
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def _on_view(self, path: Path, view: BrakingView) -> None:
        if path != self._path:
            return
        self._job = None
        self._fill(view)
        name = f"{path.parent.parent.name}-{path.stem}"
        self.sound.show_braking(path, name, sound_rate_hz(view.summary))

    def _on_failed(self, path: Path, words: str) -> None:
        if path != self._path:
            return
        self._job = None
        self._problem = words
        self._fill(None)

    def _fill(self, view: BrakingView | None) -> None:
        self.view = view
        marks = tuple(marks_of(view.summary["marks"])) if view else ()
        self.rows.show_view(view, marks)
        available = self.rows.available()
        for name, switch in self.switches.items():
            switch.setVisible(name in available)
        self.marks.show_marks(marks)
        self.events.show_events(view.summary["events"] if view else {})
        self.results.show_lines(result_lines(view.summary) if view else [])
        self.metadata.show_lines(self._metadata(view) if view else [])
        self._show_words(self._said)

    def _show_words(self, said: Annotation) -> None:
        self._said = said
        entry = self._entry
        if entry is None:
            self.notes.show_entry(None, (), "")
            return
        self.notes.show_entry(entry, said.said, said.note)
        row = entry.row
        if self._problem:
            self._say(self._problem)
        elif row.excluded:
            self._say(self.tr("Excluded, does not count: {0} ({1})").format(row.excluded, row.excluded_by))
        elif entry.trashed:
            self._say(self.tr("In the trash: “rigctl resume” would do this braking again."))
        elif not row.complete:
            self._say(f"{state_text(row.status)}: {row.note}" if row.note else state_text(row.status))
        elif row.evaluation_error:
            self._say(row.evaluation_error)
        else:
            self._say(self._squeal_words(entry))

    def _squeal_words(self, entry: Entry) -> str:
        row = entry.row
        parts = []
        if row.mean_mu is not None:
            parts.append(self.tr("mean µ {0}").format(number_text(row.mean_mu, 3)))
        if not row.sound_recorded:
            parts.append(self.tr("recorded without sound"))
        elif row.squeals:
            level = quantity_text(row.squeal_level_db, "dB")
            parts.append(self.tr("squeal {0}, {1}").format(frequency_text(row.squeal_frequency_hz), level))
        else:
            parts.append(self.tr("no squeal"))
        return " · ".join(parts)

    def _metadata(self, view: BrakingView) -> list[tuple[str, str]]:
        summary = view.summary
        facts = {key: summary[key] for key in ("start_time", "duration_s", "attempt", "status", "note")}
        return metadata_lines(
            ("", facts),
            ("", view.metadata),
            (self.tr("channels"), summary["channels"]),
            (self.tr("ordered"), view.specification),
            (self.tr("evaluation"), view.settings),
            ("", {self.tr("file"): str(view.path)}),
        )

    def _title(self, entry: Entry) -> str:
        row = entry.row
        parts = [self.tr("Braking {0}").format(entry.index)]
        if row.set_pressure_bar is not None:
            parts.append(quantity_text(row.set_pressure_bar, "bar"))
        if row.set_temperature_degc is not None:
            parts.append(quantity_text(row.set_temperature_degc, "°C", 0))
        if row.speed_mean_rpm is not None:
            parts.append(quantity_text(row.speed_mean_rpm, "1/min", 0))
        return "   ".join(parts)

    # -- words and look -----------------------------------------------------------------------------

    def _say(self, words: str) -> None:
        self.words.setText(words)

    def _row_titles(self) -> dict[str, tuple[str, str]]:
        return {
            SPECTROGRAM: (self.tr("Frequency"), "kHz"),
            MICROPHONE: (self.tr("Sound"), "Pa"),
            LEVEL: (self.tr("Level"), "dB"),
            PRESSURE: (self.tr("Pressure"), "bar"),
            TORQUE: (self.tr("Torque"), "N·m"),
            SPEED: (self.tr("Speed"), "1/min"),
            DISC_TEMPERATURE: (self.tr("Disc"), "°C"),
            MU: (self.tr("Friction"), "µ"),
        }

    def _row_words(self, name: str) -> str:
        """Entry of the menu."""
        return {
            SPECTROGRAM: self.tr("Spectrogram, level per line"),
            MICROPHONE: self.tr("Sound pressure"),
            LEVEL: self.tr("Sound level, Fast"),
            PRESSURE: self.tr("Brake pressure"),
            TORQUE: self.tr("Friction torque"),
            SPEED: self.tr("Speed"),
            DISC_TEMPERATURE: self.tr("Disc temperature"),
            MU: self.tr("Coefficient of friction"),
        }[name]

    def _restyle(self) -> None:
        u = self._services.theme.px
        self._column.setContentsMargins(u(1), u(1), u(1), u(1))
        self._column.setSpacing(u(1))


def _stamp(path: Path) -> tuple[int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size
