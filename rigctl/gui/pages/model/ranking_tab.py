"""Third tab of the model page: which design changes would help, ranked; applied to the sliders by a click.

Job: ask the worker for the ranking, show it, apply a row, save it. Not its job: measures and verdicts.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.model import studies
from rigctl.gui.pages.model.data import Advice, BrakeFacts, Ranking
from rigctl.gui.pages.model.latest import Latest
from rigctl.gui.pages.model.ranking_table import RankingTable
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.pages.model.words import advice_text, rule_text
from rigctl.gui.services import Services
from rigctl.gui.widgets.file_asking import ask_save

STEPS = (0.05, 0.10, 0.20)


class RankingTab(QWidget):
    """Step, table, sentence, [Apply to the sliders]."""

    def __init__(self, state: ModelState, services: Services) -> None:
        super().__init__()
        self._state, self._services, self._theme = state, services, services.theme
        self.ranking: Ranking | None = None
        self._before: dict[str, float] | None = None
        self._seen = False
        self._latest = Latest(services.work, studies.ranking, "", self)
        self.step = QComboBox()
        for step in STEPS:
            self.step.addItem(f"{100 * step:g}\u202f%", step)
        self.step.setCurrentIndex(1)
        self.step.setToolTip(self.tr("By how much every group is changed"))
        self.helpful = QCheckBox(self.tr("Only what &helps"))
        self.again = QPushButton(self.tr("Ran&k"))
        self.again.setToolTip(self.tr("Rank all modifications at the sliders' values"))
        self.stale = QLabel(self.tr("The sliders have moved since."))
        self.stale.setProperty("look", "muted")
        self.progress, self.progress_words = QProgressBar(), QLabel(self.tr("Ranking…"))
        self.progress.setRange(0, 0)
        self.cancel = QPushButton(self.tr("Cancel"))
        self.cancel.setToolTip(self.tr("Keep the ranking that is there"))
        self.table = RankingTable(services.theme)
        self.table.setObjectName("model-ranking")
        self.words, self.problem = QLabel(), QLabel()
        self.words.setWordWrap(True)
        self.problem.setWordWrap(True)
        self.problem.setProperty("look", "error")
        self.apply = QPushButton(self.tr("A&pply to the sliders"))
        self.apply.setObjectName("ranking-apply")
        self.apply.setProperty("look", "primary")
        self.apply.setToolTip(self.tr("The modification goes on top of what the sliders say (Enter)"))
        self.take_back = QPushButton(self.tr("&Take back"))
        self.take_back.setToolTip(self.tr("Sliders as they were before the modification"))
        self.save_table = QPushButton(self.tr("Sa&ve table…"))
        self.save_table.setToolTip(self.tr("The whole ranking as CSV"))
        self.save_picture = QPushButton(self.tr("Save p&icture…"))
        self.save_picture.setToolTip(self.tr("The best modifications as a figure, PNG or SVG"))
        self._arrange()
        self._connect()
        services.theme.changed.connect(self._restyle)
        self._restyle()
        self._show_work(False)
        self._show(None)

    def _arrange(self) -> None:
        self._top, self._bottom = QHBoxLayout(), QHBoxLayout()
        label = QLabel(self.tr("Change every gro&up by"))
        label.setBuddy(self.step)
        for widget in (label, self.step, self.helpful):
            self._top.addWidget(widget)
        self._top.addStretch(1)
        for widget in (self.stale, self.progress_words, self.progress, self.cancel, self.again):
            self._top.addWidget(widget)
        for widget in (self.apply, self.take_back):
            self._bottom.addWidget(widget)
        self._bottom.addStretch(1)
        for widget in (self.save_table, self.save_picture):
            self._bottom.addWidget(widget)
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._top)
        self._column.addWidget(self.problem)
        self._column.addWidget(self.table, 1)
        self._column.addWidget(self.words)
        self._column.addLayout(self._bottom)

    def _connect(self) -> None:
        self._latest.answered.connect(self._take)
        self._latest.failed.connect(self._refuse)
        self.step.activated.connect(self.rank)
        self.again.clicked.connect(self.rank)
        self.cancel.clicked.connect(self._cancel)
        self.helpful.toggled.connect(self._show_rows)
        self.table.chosen.connect(self._choose)
        self.table.applied.connect(self._apply)
        self.apply.clicked.connect(self._apply)
        self.take_back.clicked.connect(self._take_back)
        self.save_table.clicked.connect(self._ask_table)
        self.save_picture.clicked.connect(self._ask_picture)
        self._state.brakeRead.connect(self._new_brake)
        self._state.changed.connect(self._show_stale)

    def _restyle(self) -> None:
        px = self._theme.px
        self._column.setContentsMargins(px(1), px(1), px(1), px(1))
        for layout in (self._column, self._top, self._bottom):
            layout.setSpacing(px(1))
        self.progress.setFixedWidth(px(12))
        self.words.setMinimumHeight(2 * self.words.fontMetrics().lineSpacing())

    # -- asking -----------------------------------------------------------------------------------

    def set_seen(self, seen: bool) -> None:
        """A ranking is made when the tab is first looked at; afterwards by [Rank]."""
        self._seen = seen
        if seen and self.ranking is None and not self._latest.busy:
            self.rank()

    def rank(self) -> None:
        """Rank at the sliders' values."""
        if self._state.facts is not None:
            self._show_work(True)
            self._latest.ask(self._state.facts.file, self._state.setting, self.step.currentData())

    def _new_brake(self, facts: BrakeFacts | None) -> None:
        self._latest.drop()
        self._show_work(False)
        self._before = None
        self._show(None)
        if facts is not None and self._seen:
            self.rank()

    def _cancel(self) -> None:
        self._latest.drop()
        self._show_work(False)

    def _take(self, ranking: Ranking) -> None:
        self._show_work(self._latest.busy)
        self._show(ranking)

    def _refuse(self, text: str) -> None:
        self._show_work(False)
        self._show(None)
        self.problem.setText(text)
        self.problem.show()

    # -- showing ----------------------------------------------------------------------------------

    def _show(self, ranking: Ranking | None) -> None:
        self.ranking = ranking
        self.problem.hide()
        self._show_rows()
        for button in (self.save_table, self.save_picture):
            button.setEnabled(ranking is not None)
        self.table.setToolTip("" if ranking is None else rule_text(ranking.rule))
        self._show_stale()

    def _show_rows(self) -> None:
        self.table.show_ranking(self.ranking, helpful_only=self.helpful.isChecked())

    def _show_work(self, busy: bool) -> None:
        for widget in (self.progress, self.progress_words, self.cancel):
            widget.setVisible(busy)
        self.again.setVisible(not busy)

    def _show_stale(self) -> None:
        self.stale.setVisible(self.ranking is not None and self.ranking.setting != self._state.setting)
        self.take_back.setEnabled(self._before is not None)

    def _choose(self, row: Advice | None) -> None:
        self.apply.setEnabled(row is not None)
        if row is not None and self.ranking is not None:
            self.words.setText(f"{advice_text(row, self.ranking)}.")
        elif self.ranking is not None:
            self.words.setText(self.tr("Nothing helps at this step. Try a larger one."))
        else:
            self.words.setText(
                self.tr(
                    "Every parameter group is changed a little, up and down; what lowers the real parts wins."
                )
            )

    # -- doing ------------------------------------------------------------------------------------

    def _apply(self) -> None:
        row = self.table.value()
        if row is not None:
            self._before = dict(self._state.factors)
            self._state.multiply(row.factors)
            self._show_stale()

    def _take_back(self) -> None:
        if self._before is not None:
            gone = dict.fromkeys(self._state.factors, 1.0)
            before, self._before = self._before, None
            self._state.set({**gone, **before})

    def _ask_table(self) -> None:
        ask_save(self, self.tr("Save table"), Path("ranking.csv"), self.tr("Table (*.csv)"), self.save)

    def _ask_picture(self) -> None:
        kinds = self.tr("Picture (*.png *.svg)")
        ask_save(self, self.tr("Save picture"), Path("ranking.png"), kinds, self.save)

    def save(self, path: Path) -> None:
        """Save the ranking on screen; the ending says as what."""
        facts, ranking = self._state.facts, self.ranking
        if facts is not None and ranking is not None:
            self._services.work.in_process(
                studies.write_ranking, facts.file, ranking.setting, ranking.step, path,
                done=self._saved, failed=self._services.notify,
            )  # fmt: skip

    def _saved(self, path: Path) -> None:
        self._services.notify(self.tr("Saved as {0}").format(path))
