"""The data page: campaigns, their brakings, a braking opened, figures, comparison.

Job: put the panes together and carry news between them. Not its job: what the panes show and do.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QVBoxLayout

from rigctl.gui.pages.base import Page
from rigctl.gui.pages.data.annotator import Annotator
from rigctl.gui.pages.data.campaigns import CampaignInfo, find_campaigns, is_campaign
from rigctl.gui.pages.data.entry import TRASHED, Entry
from rigctl.gui.pages.data.export_bar import show_in_file_manager
from rigctl.gui.pages.data.loader import PIECE, CampaignLoader
from rigctl.gui.pages.data.parts import Parts
from rigctl.gui.pages.data.reports import ReportBuilder
from rigctl.gui.services import Services
from rigctl.gui.widgets.file_asking import ask_open
from rigctl.gui.work import Job, Reporter
from rigctl.recording.catalogue import BRAKINGS
from rigctl.recording.kinds import COMMITTED


class DataPage(Page):
    """Stored data."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.loader = CampaignLoader(services.work, self)
        self.annotator = Annotator(services.work, self)
        self.reports = ReportBuilder(services.work, self)
        self.parts = Parts(services)
        self.campaigns, self.table, self.braking = self.parts.campaigns, self.parts.table, self.parts.braking
        self.figures, self.compare, self.export = self.parts.figures, self.parts.compare, self.parts.export
        self.empty, self.tabs = self.parts.empty, self.parts.tabs
        self._folder = services.data_folder
        self._scan: Job | None = None
        self._wanted: tuple[Path, int | None] | None = None
        self._asked_folder: Path | None = None
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(self.parts)
        self._connect()
        self._shortcuts()

    def _connect(self) -> None:
        c, t, a = self.campaigns, self.table, self.table.bar
        c.valueChanged.connect(lambda path: self.open_campaign(path) if path else None)
        c.otherFolder.connect(self.ask_folder)
        c.openFolder.connect(lambda: self._show(self.loader.campaign))
        c.openReport.connect(self._open_report)
        c.buildReport.connect(lambda: self.loader.campaign and self.reports.build(self.loader.campaign))
        self.reports.started.connect(lambda: c.set_building(True))
        self.reports.finished.connect(self._on_report)
        self.reports.failed.connect(self._on_report_failed)
        self.loader.opened.connect(self._on_opened)
        self.loader.changed.connect(self._on_changed)
        self.loader.progress.connect(self._on_progress)
        self.loader.failed.connect(lambda words: t.bar.say(words, can_undo=False, wrong=True))
        t.selectionChanged.connect(self._on_selection)
        t.activated.connect(lambda _entry: self.parts.show_large(self.braking))
        a.compare.connect(self._on_compare)
        a.excludeGiven.connect(lambda reason: self.annotator.exclude(self._here(), reason))
        a.restore.connect(lambda: self.annotator.restore(self._here()))
        a.tagGiven.connect(lambda tag: self.annotator.tag(self._here(), tag))
        a.trash.connect(lambda: self.annotator.trash(self._here()))
        a.putBack.connect(lambda: self.annotator.put_back([e.name for e in t.chosen() if e.trashed]))
        a.export.connect(self._on_export)
        a.undo.connect(self.annotator.undo)
        self.annotator.written.connect(self.loader.hear)
        self.annotator.moved.connect(self._on_moved)
        self.annotator.done.connect(lambda words: a.say(words, can_undo=self.annotator.can_undo))
        self.annotator.failed.connect(lambda words: a.say(words, can_undo=False, wrong=True))
        notes = self.braking.notes
        notes.tagsGiven.connect(self._on_tags)
        notes.noteGiven.connect(self._on_note)
        notes.ratingGiven.connect(self.annotator.rate)
        self.figures.picked.connect(self._on_picked)
        self.figures.pickedBeside.connect(self._on_picked_beside)
        self.tabs.currentChanged.connect(self._on_tab)
        self.empty.manual.connect(lambda: self.services.navigate("manual"))
        self.empty.sequence.connect(lambda: self.services.navigate("sequence"))
        self.empty.otherFolder.connect(self.ask_folder)
        self.services.rig.recordsAdded.connect(self._on_records)

    def _shortcuts(self) -> None:
        within = Qt.ShortcutContext.WidgetWithChildrenShortcut
        for keys, action in (
            ("Ctrl+Z", self.annotator.undo),
            ("F5", self.refresh),
            ("F11", self.parts.large.toggle),
            ("Esc", lambda: self.parts.large.setChecked(False)),
            ("Ctrl+P", self.braking.sound.play.click),
        ):
            QShortcut(QKeySequence(keys), self, action, context=within)
        QShortcut(QKeySequence("Del"), self.table.view, self.table.bar.trash_button.click, context=within)

    # -- life ---------------------------------------------------------------------------------------

    def activated(self) -> None:
        """Look for campaigns and for what has changed in the open one."""
        self.figures.set_active(self.tabs.currentWidget() is self.figures)
        self.refresh()

    def deactivated(self) -> None:
        """Silence; nothing is computed for nobody."""
        self.braking.stop_sound()
        self.figures.set_active(False)

    def stop_reading(self) -> None:
        """Results that are still to come are not wanted any more."""
        self.deactivated()
        self.loader.close()
        self.figures.close_jobs()
        self.braking.show_nothing()
        self.compare.show_nothing()
        if self._scan is not None:
            self._scan.cancel()
            self._scan = None

    def refresh(self) -> None:
        """Campaigns of the folder, changes of the open one."""
        if self._scan is None:
            self._scan = self.services.work.in_thread(
                _find, self._folder, done=self._on_campaigns, failed=self.services.notify
            )
        self.loader.refresh()

    def open(self, **what: Any) -> None:
        """``campaign=folder``, ``braking=number``; or ``braking=file``."""
        campaign, braking = what.get("campaign"), what.get("braking")
        if isinstance(braking, Path):
            campaign = campaign or braking.parent.parent
            digits = braking.stem.partition("-")[0]
            braking = int(digits) if digits.isdecimal() else None
        if campaign is None:
            campaign = self.loader.campaign
        if campaign is not None:
            self.open_campaign(Path(campaign), None if braking is None else int(braking))
            if braking is not None:
                self.tabs.setCurrentWidget(self.braking)

    def open_campaign(self, path: Path, braking: int | None = None) -> None:
        """Show the brakings of a campaign, and one of them opened."""
        path = path.absolute()
        self._wanted = (path, braking)
        if path == self.loader.campaign:
            self.loader.refresh()
            self._choose_wanted()
            return
        self.parts.show_data(True)
        self.campaigns.setValue(path)
        self.braking.show_nothing()
        self.table.bar.say("", can_undo=False)
        self.annotator.open(path)
        self.loader.open(path)
        self.figures.show_campaigns(self.campaigns.campaigns(), path)

    # -- campaigns ----------------------------------------------------------------------------------

    def ask_folder(self) -> None:
        """Another campaign, or a folder of them."""
        start = self._folder if self._folder.is_dir() else Path.home()
        ask_open(self, self.tr("Campaign or folder of campaigns"), start, "", self.open_folder, folders=True)

    def open_folder(self, folder: Path) -> None:
        """Look into another folder; a campaign in it is opened."""
        self._folder = folder.parent if is_campaign(folder) else folder
        if is_campaign(folder):
            self.open_campaign(folder)
        self.refresh()

    def _on_campaigns(self, found: tuple[Path, list[CampaignInfo]]) -> None:
        self._scan = None
        folder, campaigns = found
        if folder != self._folder:
            self.refresh()
            return
        self.empty.show_folder(folder)
        self.campaigns.show_campaigns(folder, campaigns)
        present = self.loader.campaign
        if present is None and campaigns:
            present = campaigns[0].path
            self.open_campaign(present)
        elif present is not None:
            self.campaigns.setValue(present)
        self.figures.show_campaigns(campaigns, present)
        self.parts.show_data(present is not None)

    def _show(self, path: Path | None) -> None:
        if path is not None and not show_in_file_manager(path):
            self.services.notify(self.tr("No program of this computer opens {0}").format(path))

    def _open_report(self) -> None:
        if self.loader.campaign is not None:
            self._show(self.loader.campaign / "report" / "report.html")

    def _on_report(self, path: Path) -> None:
        self.campaigns.set_building(False)
        self.campaigns.renew_buttons()
        self.services.notify(self.tr("Report built: {0}").format(path))

    def _on_report_failed(self, words: str) -> None:
        self.campaigns.set_building(False)
        self.table.bar.say(words, can_undo=False, wrong=True)

    # -- news of the loader -------------------------------------------------------------------------

    def _on_opened(self, entries: list[Entry]) -> None:
        self.table.model.replace_all(entries)
        self._renew_figures()
        self._choose_wanted()

    def _on_changed(self, entries: list[Entry], gone: list[str]) -> None:
        self.table.model.put(entries, gone)
        self._renew_figures()
        self._choose_wanted()

    def _on_progress(self, share: float) -> None:
        self.table.progress.setValue(round(100 * share))
        self.table.progress.setVisible(share < 1.0)

    def _on_records(self, records: list[Any]) -> None:
        campaign = self.services.rig.state.campaign
        if campaign is None:
            return
        if Path(campaign).absolute() != self.loader.campaign:
            if self.loader.campaign is None and self.isVisible():
                self.refresh()
            return
        self.loader.hear(records)
        new = [f"{BRAKINGS}/{r.payload['file']}" for r in records if r.kind == COMMITTED]
        if len(new) > PIECE:  # all records of a campaign that the window has just attached to
            self.loader.refresh()
        elif new:
            self.loader.read(new)

    def _on_moved(self, gone: list[str], come: list[str]) -> None:
        for name in gone:
            self.loader.forget(name)
        self.loader.read(come)

    def _renew_figures(self) -> None:
        name = self.loader.campaign.name if self.loader.campaign else ""
        self.figures.show_entries(name, self.table.model.list.all())

    def _choose_wanted(self) -> None:
        """The braking that was asked for, as soon as it is there; else the first one."""
        if self._wanted is None or self._wanted[0] != self.loader.campaign:
            return
        braking = self._wanted[1]
        if braking is None:
            if self.table.model.rowCount() and not self.table.chosen():
                self.table.choose([self.table.model.entry(0).name])
            if self.table.chosen() or not self.loader.busy:
                self._wanted = None
            return
        found = self.table.model.list.of_braking(braking)
        names = [entry.name for entry in sorted(found, key=lambda e: e.trashed)]
        if names and self.table.choose(names[:1]):
            self._wanted = None
        elif not self.loader.busy:
            self._wanted = None
            self.table.bar.say(
                self.tr("Braking {0} is not in this campaign").format(braking), can_undo=False, wrong=True
            )

    # -- what people do -----------------------------------------------------------------------------

    def _here(self) -> list[Entry]:
        return [entry for entry in self.table.chosen() if entry.state != TRASHED]

    def _on_selection(self, entries: list[Entry]) -> None:
        self.figures.set_chosen([entry.name for entry in entries])
        campaign = self.loader.campaign
        if campaign is None or not entries:
            self.braking.show_nothing()
            return
        current = self.table.current()
        entry = next((e for e in entries if e.name == current), entries[0])
        self.braking.notes.tags.set_known(self.table.model.list.tags())
        self.braking.show_entry(entry, campaign, self.loader.said.of(entry.index))

    def _on_tags(self, entry: Entry, added: list[str], removed: list[str]) -> None:
        for tag in added:
            self.annotator.tag([entry], tag)
        for tag in removed:
            self.annotator.untag([entry], tag)

    def _on_note(self, entry: Entry, text: str) -> None:
        self.annotator.note(entry, text, self.loader.said.of(entry.index).note)

    def _on_compare(self) -> None:
        if self.loader.campaign is not None:
            self.compare.compare(self.loader.campaign, self.table.chosen())
            self.tabs.setCurrentWidget(self.compare)

    def _on_export(self) -> None:
        if self.loader.campaign is not None:
            self.export.ask(self.loader.campaign, self.table.chosen())

    def _on_picked(self, names: list[str]) -> None:
        if self.table.choose(names):
            self.tabs.setCurrentWidget(self.braking)

    def _on_picked_beside(self, campaign: Path, names: list[str]) -> None:
        self.open(campaign=campaign, braking=campaign / names[0])

    def _on_tab(self) -> None:
        self.figures.set_active(self.tabs.currentWidget() is self.figures)

    # -- remembered ---------------------------------------------------------------------------------

    def save_layout(self, settings: QSettings) -> None:
        """Splitters, columns, the open campaign."""
        settings.setValue("split", self.parts.split.saveState())
        settings.setValue("rows", ",".join(sorted(self.braking.rows.shown)))
        settings.setValue("figure", self.figures.figure.currentData())
        settings.setValue("export-folder", self.export.folder.text())
        settings.setValue("campaign", str(self.loader.campaign or ""))
        self.table.save(settings)
        self.reports.cancel()

    def restore_layout(self, settings: QSettings) -> None:
        """As saved; what has gone since is passed over."""
        if (state := settings.value("split")) is not None:
            self.parts.split.restoreState(state)
        if rows := str(settings.value("rows", "")):
            for name, switch in self.braking.switches.items():
                switch.setChecked(name in rows.split(","))
        place = self.figures.figure.findData(settings.value("figure", ""))
        if place >= 0:
            self.figures.figure.setCurrentIndex(place)
        if folder := str(settings.value("export-folder", "")):
            self.export.folder.setText(folder)
        self.table.restore(settings)
        last = str(settings.value("campaign", ""))
        if last and is_campaign(Path(last)) and Path(last).parent == self._folder.absolute():
            self.open_campaign(Path(last))

    def help_text(self) -> str:
        """F1."""
        return self.tr(
            "<p><b>Data</b>: choose a campaign, then a braking. Statistics, figures and report count "
            "complete brakings that are not excluded. Nothing is deleted: excluded brakings stay in the "
            "list, the trash is a folder of the campaign.</p>"
            "<p><b>Enter</b> or <b>F11</b>: large view · <b>Esc</b>: back · <b>Ctrl+F</b>: words in notes · "
            "<b>Ctrl+P</b>: play the sound · <b>Delete</b>: move to the trash · <b>Ctrl+Z</b>: undo · "
            "<b>F5</b>: look again. Ctrl or Shift and click choose several brakings. "
            "The wheel zooms the time; a right click on a plot copies or saves its picture.</p>"
        )


def _find(folder: Path, reporter: Reporter) -> tuple[Path, list[CampaignInfo]]:
    del reporter
    return folder, find_campaigns(folder.absolute())
