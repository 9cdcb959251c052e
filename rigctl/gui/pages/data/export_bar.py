"""Export of chosen brakings: formats, folder, progress, cancel. In the page, no dialog.

Job: one braking after the other in the worker process. Not its job: the formats (`rigctl.export`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices, QKeyEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.export.braking import Format
from rigctl.gui.pages.data import remote
from rigctl.gui.pages.data.entry import UNREADABLE, Entry
from rigctl.gui.services import Services
from rigctl.gui.widgets.field_grid import FaultLabel, set_wrong
from rigctl.gui.widgets.file_asking import ask_open
from rigctl.gui.widgets.flow import FlowLayout
from rigctl.gui.work import Job


class ExportBar(QWidget):
    """Hidden until `ask`."""

    finished = Signal(int)
    """Number of files written."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        self._campaign: Path | None = None
        self._entries: list[Entry] = []
        self._waiting: list[Entry] = []
        self._written: list[Path] = []
        self._job: Job | None = None
        self.words = QLabel()
        self.formats: dict[Format, QCheckBox] = {}
        self._flow = FlowLayout()
        for kind, text, tip in (
            (Format.WAV, "WAV", self.tr("Sound as recorded, 16 bit")),
            (Format.CSV, "CSV", self.tr("All channels as text, one file per sampling rate; events")),
            (
                Format.MAT,
                "MATLAB",
                self.tr("Channels, set-points, results and events (version 5, also for Octave)"),
            ),
            (Format.HDF5, "HDF5", self.tr("A copy of the braking's file")),
        ):
            box = QCheckBox(text)
            box.setObjectName(f"data-export-{kind}")
            box.setToolTip(tip)
            box.setChecked(kind in (Format.WAV, Format.CSV))
            box.toggled.connect(self._check)
            self.formats[kind] = box
            self._flow.addWidget(box)
        self.folder = QLineEdit(str(Path.home()))
        self.folder.setObjectName("data-export-folder")
        self.folder.setToolTip(self.tr("Where the files are written; it is made if it does not exist"))
        self.browse = QPushButton(self.tr("Browse…"))
        self.browse.setObjectName("data-export-browse")
        self.browse.setToolTip(self.tr("Choose the folder"))
        self.start = QPushButton(self.tr("Export"))
        self.start.setToolTip(self.tr("Write the files; nothing that exists is replaced"))
        self.start.setObjectName("data-export-start")
        self.start.setProperty("look", "primary")
        self.cancel = QPushButton(self.tr("Cancel"))
        self.cancel.setObjectName("data-export-cancel")
        self.cancel.setToolTip(self.tr("Stop after the braking that is being written (Esc)"))
        self.fault = FaultLabel(services.theme)
        self.progress = QProgressBar()
        self.progress.hide()
        self._make_layout()
        self.folder.textEdited.connect(self._check)
        self.browse.clicked.connect(self._browse)
        self.start.clicked.connect(self._start)
        self.cancel.clicked.connect(self.stop)
        services.theme.changed.connect(self._restyle)
        self._restyle()
        self.hide()

    def _make_layout(self) -> None:
        folder_row = QHBoxLayout()
        folder_row.addWidget(self.folder, 1)
        folder_row.addWidget(self.browse)
        buttons = QHBoxLayout()
        buttons.addWidget(self.start)
        buttons.addWidget(self.cancel)
        buttons.addStretch(1)
        self._column = QVBoxLayout(self)
        self._column.addWidget(self.words)
        self._column.addLayout(self._flow)
        self._column.addLayout(folder_row)
        self._column.addWidget(self.fault)
        self._column.addWidget(self.progress)
        self._column.addLayout(buttons)

    @property
    def busy(self) -> bool:
        """True while files are written."""
        return self._job is not None

    def ask(self, campaign: Path, entries: list[Entry]) -> None:
        """Offer to export these."""
        if self.busy:
            return
        self._campaign = campaign
        self._entries = [entry for entry in entries if entry.row.status != UNREADABLE]
        one, many = self.tr("Export braking {0}"), self.tr("Export {0} brakings")
        single = len(self._entries) == 1
        self.words.setText(
            (one if single else many).format(self._entries[0].index if single else len(self._entries))
        )
        self.progress.hide()
        self._check()
        self.show()
        self.folder.setFocus(Qt.FocusReason.OtherFocusReason)

    def stop(self) -> None:
        """Stop after the present braking; files written stay. Without work: hide."""
        if self.busy:
            self._waiting = []
            self.cancel.setEnabled(False)
        else:
            self.hide()

    def chosen_formats(self) -> list[Format]:
        """Formats that are switched on."""
        return [kind for kind, box in self.formats.items() if box.isChecked()]

    def _check(self) -> bool:
        problem = ""
        text = self.folder.text().strip()
        wrong_folder = not text or (Path(text).exists() and not Path(text).is_dir())
        if wrong_folder:
            problem = self.tr("Give a folder.") if not text else self.tr("This is a file; give a folder.")
        elif not self.chosen_formats():
            problem = self.tr("Choose at least one format.")
        set_wrong(self.folder, "error" if wrong_folder else "")
        self.fault.setFault(problem)
        self.start.setEnabled(not problem and not self.busy and bool(self._entries))
        return not problem

    def _browse(self) -> None:
        ask_open(
            self,
            self.tr("Folder for the files"),
            Path(self.folder.text()),
            "",
            self._set_folder,
            folders=True,
        )

    def _set_folder(self, path: Path) -> None:
        self.folder.setText(str(path))
        self._check()

    def _start(self) -> None:
        if not self._check():
            return
        self._waiting = list(self._entries)
        self._written = []
        self.progress.setRange(0, len(self._waiting))
        self.progress.setValue(0)
        self.progress.show()
        self.cancel.setEnabled(True)
        self._next()

    def _next(self) -> None:
        if not self._waiting or self._campaign is None:
            self._finish()
            return
        entry = self._waiting.pop(0)
        self._job = self._services.work.in_process(
            remote.export, entry.path(self._campaign), Path(self.folder.text()).expanduser(),
            self.chosen_formats(), f"{self._campaign.name}-", done=self._on_written, failed=self._on_failed,
            lane=remote.LANE,
        )  # fmt: skip
        self._check()

    def _on_written(self, paths: list[Path]) -> None:
        self._job = None
        self._written += paths
        self.progress.setValue(self.progress.value() + 1)
        self._next()

    def _on_failed(self, words: str) -> None:
        self._job = None
        self._waiting = []
        self._finish()
        self.fault.setFault(words)
        self.show()

    def _finish(self) -> None:
        self._job = None
        self.cancel.setEnabled(True)
        self.progress.hide()
        self.start.setEnabled(True)
        folder = Path(self.folder.text()).expanduser()
        self._services.notify(self.tr("{0} files written to {1}").format(len(self._written), folder))
        self.hide()
        self.finished.emit(len(self._written))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc cancels."""
        if event.key() == Qt.Key.Key_Escape:
            self.stop()
        else:
            super().keyPressEvent(event)

    def _restyle(self) -> None:
        u = self._services.theme.px
        self._column.setContentsMargins(u(1), 0, u(1), u(1))
        self._column.setSpacing(u(1))
        self._flow.setSpacing(u(2))


def show_in_file_manager(path: Path) -> bool:
    """Open a folder or file with the program of the desktop; False when there is none."""
    return QDesktopServices.openUrl(QUrl.fromLocalFile(str(path.resolve())))
