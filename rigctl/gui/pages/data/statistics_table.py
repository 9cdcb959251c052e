"""Statistics of one or two campaigns side by side.

Job: the numbers of `rigctl.analysis.summary` as lines. Not its job: deriving them.
"""

from __future__ import annotations

from rigctl.analysis.summary import Summary
from rigctl.gui.format import MISSING, number_text
from rigctl.gui.pages.data.details import LinesTable
from rigctl.gui.theme import ThemeKeeper


class StatisticsTable(LinesTable):
    """A column per campaign."""

    def __init__(self, theme: ThemeKeeper) -> None:
        titles = (self.tr("Statistics"), "", "", self.tr("Unit"))
        super().__init__(theme, "data-statistics", titles, right=(1, 2))

    def show_summaries(self, *campaigns: tuple[str, Summary | None]) -> None:
        """Name and numbers of up to two campaigns; one without numbers is not shown."""
        columns = [self._numbers(summary) if summary else {} for _, summary in campaigns]
        keys = next((list(column) for column in columns if column), [])
        self.show_lines(
            [(name, *(column.get((name, unit), "") for column in columns), unit) for name, unit in keys]
        )
        for place, (name, summary) in enumerate(campaigns, start=1):
            title = self.horizontalHeaderItem(place)
            if title is not None:
                title.setText(name)
            self.setColumnHidden(place, summary is None)
        self.resizeColumnsToContents()

    def _numbers(self, s: Summary) -> dict[tuple[str, str], str]:
        share = None if s.occurrence_share is None else 100.0 * s.occurrence_share
        friction = MISSING
        if s.mu_min is not None and s.mu_max is not None:
            friction = f"{number_text(s.mu_min, 2)} … {number_text(s.mu_max, 2)}"
        return {
            (self.tr("Brakings recorded"), ""): str(s.n_brakings),
            (self.tr("complete and counted"), ""): str(s.n_complete),
            (self.tr("excluded"), ""): str(s.n_excluded),
            (self.tr("incomplete"), ""): str(s.n_incomplete),
            (self.tr("with sound"), ""): str(s.n_with_sound),
            (self.tr("squealing"), ""): str(s.n_squealing),
            (self.tr("Occurrence"), "%"): number_text(share, 0),
            (self.tr("Onset of squeal"), "bar"): number_text(s.onset_bar, 1),
            (self.tr("Squeal frequency, median"), "Hz"): number_text(s.frequency_median_hz, 0),
            (self.tr("Loudest squeal"), "dB"): number_text(s.level_max_db, 1),
            (self.tr("Level of squeal, median"), "dB"): number_text(s.level_median_db, 1),
            (self.tr("Mean µ, from … to"), ""): friction,
        }
