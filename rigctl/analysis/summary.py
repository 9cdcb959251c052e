"""The findings of a campaign as numbers and in plain words.

Job: `summarise` and `in_words`. NOT its job: drawing, files.
"""

from dataclasses import dataclass

from rigctl.analysis import occurrence
from rigctl.analysis.campaign_table import CampaignTable
from rigctl.analysis.friction_map import BEDDING, brakings_with_mu
from rigctl.analysis.prediction import Prediction

_FINE_HZ = 10.0
"""Frequencies closer together than this are told with a decimal."""


@dataclass(frozen=True, slots=True)
class Summary:
    """Numbers of a campaign; None where there is no braking or no squeal to derive them from."""

    n_brakings: int
    n_complete: int
    n_incomplete: int
    n_unreadable: int
    n_with_sound: int
    n_squealing: int
    n_events: int
    occurrence_share: float | None
    onset_bar: float | None
    onset_below_bar: float | None
    frequency_median_hz: float | None
    frequency_low_hz: float | None
    frequency_high_hz: float | None
    level_median_db: float | None
    level_max_db: float | None
    level_max_dba: float | None
    mu_min: float | None
    mu_max: float | None
    n_clipped: int
    predicted_onset_bar: float | None
    predicted_frequency_hz: float | None
    predicted_by: str
    n_excluded: int = 0


def summarise(table: CampaignTable, prediction: Prediction | None) -> Summary:
    """Derive the numbers.

    `frequency_low_hz` and `frequency_high_hz` are the quartiles of the loudest squeal of each squealing
    braking; `onset_below_bar` is the highest pressure set-point below the onset (there every braking was
    quiet).
    """
    base, loud = table.with_sound(), table.squealing()
    frequency = occurrence.spread(b.squeal_frequency_hz for b in loud)
    level = occurrence.spread(b.squeal_level_db for b in loud)
    level_a = occurrence.spread(b.squeal_level_dba for b in loud)
    mu = occurrence.spread(b.mean_mu for b in brakings_with_mu(table) if b.role != BEDDING)
    onset = occurrence.onset_bar(table)
    quiet = [
        r.pressure_bar for r in occurrence.by_pressure(table) if onset is not None and r.pressure_bar < onset
    ]
    return Summary(
        n_brakings=len(table.brakings),
        n_complete=len(table.complete()),
        n_incomplete=len(table.incomplete()),
        n_unreadable=len(table.unreadable),
        n_with_sound=len(base),
        n_squealing=len(loud),
        n_events=len(table.squeals()),
        occurrence_share=len(loud) / len(base) if base else None,
        onset_bar=onset,
        onset_below_bar=max(quiet, default=None),
        frequency_median_hz=frequency.median if frequency else None,
        frequency_low_hz=frequency.lower_quartile if frequency else None,
        frequency_high_hz=frequency.upper_quartile if frequency else None,
        level_median_db=level.median if level else None,
        level_max_db=level.maximum if level else None,
        level_max_dba=level_a.maximum if level_a else None,
        mu_min=mu.minimum if mu else None,
        mu_max=mu.maximum if mu else None,
        n_clipped=sum(1 for b in base if b.clipped_share),
        predicted_onset_bar=prediction.onset_bar if prediction else None,
        predicted_frequency_hz=prediction.frequency_hz if prediction else None,
        predicted_by=prediction.label if prediction else "",
        n_excluded=len(table.excluded()),
    )


def in_words(s: Summary) -> tuple[str, ...]:
    """The findings as sentences, most important first."""
    return (*_brakings(s), *_squeal(s), *_comparison(s), *_friction(s), *_warnings(s))


def _brakings(s: Summary) -> tuple[str, ...]:
    if s.n_brakings == 0:
        return ("No braking has been recorded.",)
    text = f"{s.n_complete} of {s.n_brakings} recorded brakings are complete"
    if s.n_excluded:
        text += f" and count; {s.n_excluded} {_are(s.n_excluded)} excluded by a person, see below"
    if s.n_incomplete:
        text += f"; {s.n_incomplete} incomplete {_are(s.n_incomplete)} listed below and not counted"
    if s.n_complete == 0:
        return (f"{text}.", "There is nothing to evaluate: no complete braking.")
    if s.n_with_sound == 0:
        return (f"{text}.", "None of them recorded sound, so nothing can be said about squeal.")
    return (f"{text}; sound was recorded in {s.n_with_sound}.",)


def _squeal(s: Summary) -> tuple[str, ...]:
    if s.n_with_sound == 0:
        return ()
    if s.n_squealing == 0:
        return (f"No squeal was found ({_count(s.n_with_sound, 'braking')} with sound).",)
    low, high = s.frequency_low_hz or 0.0, s.frequency_high_hz or 0.0
    digits = 0 if high - low >= _FINE_HZ else 1
    sentences = [
        f"{_count(s.n_squealing, 'braking')} squealed ({_percent(s.occurrence_share)}), "
        f"with {_count(s.n_events, 'event')} in all.",
        f"The squeal frequency is {s.frequency_median_hz:.0f} Hz (median; half of the brakings lie between "
        f"{low:.{digits}f} and {high:.{digits}f} Hz).",
        f"The loudest squeal reached {s.level_max_db:.1f} dB"
        + (f" ({s.level_max_dba:.1f} dB(A))" if s.level_max_dba is not None else "")
        + f", the median of the squealing brakings is {s.level_median_db:.1f} dB.",
    ]
    if s.onset_bar is not None:
        quiet = s.onset_below_bar
        below = f"; all brakings up to {quiet:g} bar were quiet" if quiet is not None else ""
        onset = f"Squeal sets in at {s.onset_bar:g} bar (lowest pressure set-point that squealed{below})."
        sentences.insert(1, onset)
    return tuple(sentences)


def _comparison(s: Summary) -> tuple[str, ...]:
    if s.predicted_onset_bar is None or s.predicted_frequency_hz is None or s.n_complete == 0:
        return ()
    predicted = f"{s.predicted_frequency_hz:.0f} Hz from {s.predicted_onset_bar:.1f} bar"
    text = f"Predicted ({s.predicted_by}): {predicted}"
    if s.onset_bar is None or s.frequency_median_hz is None:
        return (f"{text}; there is no measured squeal to compare it with.",)
    d_bar = s.onset_bar - s.predicted_onset_bar
    d_share = s.frequency_median_hz / s.predicted_frequency_hz - 1.0
    return (
        f"{text}. Measured squeal sets in {abs(d_bar):.1f} bar {_side(d_bar)} the prediction, "
        f"its frequency is {abs(d_share):.1%} {_side(d_share)} it.",
    )


def _friction(s: Summary) -> tuple[str, ...]:
    if s.mu_min is None or s.mu_max is None:
        return ()
    return (f"The mean coefficient of friction of a braking lies between {s.mu_min:.2f} and {s.mu_max:.2f}.",)


def _warnings(s: Summary) -> tuple[str, ...]:
    found = []
    if s.n_clipped:
        where = _count(s.n_clipped, "braking")
        found.append(f"Caution: in {where} the microphone signal was clipped; levels there are too low.")
    if s.n_unreadable:
        found.append(f"Caution: {_count(s.n_unreadable, 'braking file')} cannot be read; listed below.")
    return tuple(found)


def _count(n: int, noun: str) -> str:
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def _percent(share: float | None) -> str:
    return "–" if share is None else f"{share:.0%}"


def _side(difference: float) -> str:
    return "above" if difference > 0 else "below"


def _are(n: int) -> str:
    return "is" if n == 1 else "are"
