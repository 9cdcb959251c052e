"""Words of the model page: names of sliders, onset in a sentence, state of a mode.

Pure texts, translated; no widget. Not its job: numbers.
"""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.gui.format import frequency_text, number_text, quantity_text
from rigctl.gui.pages.model.data import (
    MU,
    PRESSURE,
    SLOPE,
    Advice,
    BrakeFacts,
    Knob,
    OnsetFound,
    Pole,
    Ranking,
    RankingRule,
    Setting,
)

CONTEXT = "model"
#: largest rise, as share, of which nobody speaks
_NO_RISE = 1e-4
STABLE_MARK, UNSTABLE_MARK = "●", "▲"

_NAMES = {
    MU: QT_TRANSLATE_NOOP("model", "Coefficient of friction µ"),
    PRESSURE: QT_TRANSLATE_NOOP("model", "Brake pressure p"),
    SLOPE: QT_TRANSLATE_NOOP("model", "Falling slope k"),
}
UNITS = {MU: "", PRESSURE: "bar", SLOPE: "s/m"}
DECIMALS = {MU: 2, PRESSURE: 1, SLOPE: 4}
_SIDES = {
    "leading": QT_TRANSLATE_NOOP("model", "leading side"),
    "trailing": QT_TRANSLATE_NOOP("model", "trailing side"),
}


def tr(text: str) -> str:
    """A text of this page in the window's language."""
    return QCoreApplication.translate(CONTEXT, text)


def knob_title(knob: Knob) -> str:
    """Name of a parameter group, of one side of it, or of a quantity with its unit."""
    if knob.side:
        return f"{knob.title}, {side_text(knob)}"
    return knob.title if knob.group or not knob.unit else f"{knob.title}  [{knob.unit}]"


def side_text(knob: Knob) -> str:
    """Which side of a group a knob changes; "" where it is not one side."""
    return tr(str(_SIDES[knob.side])) if knob.side else ""


def title_of(key: str, facts: BrakeFacts | None) -> str:
    """Name of a slider."""
    if key in _NAMES:
        return tr(str(_NAMES[key]))
    return key if facts is None else knob_title(facts.knob(key))


def axis_of(key: str, facts: BrakeFacts | None) -> str:
    """Name of a slider as axis, with its unit."""
    if key in UNITS:
        unit = UNITS[key]
        return f"{title_of(key, facts)} [{unit}]" if unit else title_of(key, facts)
    return QCoreApplication.translate("model", "{0}: factor").format(title_of(key, facts))


def value_text(key: str, value: float) -> str:
    """Value of a slider with its unit."""
    if key == MU:
        return f"µ {number_text(value, 3)}"
    if key in UNITS:
        return quantity_text(value, UNITS[key], DECIMALS[key])
    return f"×{number_text(value, 2)}"


def onset_text(found: OnsetFound) -> str:
    """Where the brake begins to squeal: "Squeals from 14.9 bar at 2143 Hz"."""
    translate = QCoreApplication.translate
    if found.from_start:
        if found.over == PRESSURE:
            return translate("model", "Unstable without any pressure already")
        return translate("model", "Unstable without any friction already")
    if found.value is None:
        text = translate("model", "No squeal up to {0}").format(value_text(found.over, found.limit))
    elif not found.frequency_hz:
        text = translate("model", "Diverges without vibration from {0}")
        text = text.format(value_text(found.over, found.value))
    else:
        text = translate("model", "Squeals from {0} at {1}")
        text = text.format(value_text(found.over, found.value), frequency_text(found.frequency_hz))
    if found.over == PRESSURE:
        return text
    return translate("model", "{0}, at any pressure").format(text)


def now_text(setting: Setting, poles: tuple[Pole, ...]) -> str:
    """State at the sliders' values: how many modes are unstable, or which is the next to become so."""
    translate = QCoreApplication.translate
    place = ", ".join(value_text(key, value) for key, value in setting.operating.items() if key != SLOPE)
    unstable = [pole for pole in poles if pole.unstable]
    if unstable:
        worst = max(unstable, key=lambda pole: pole.real_part_1_s)
        count = len(unstable)
        words = (
            translate("model", "1 mode unstable") if count == 1
            else translate("model", "{0} modes unstable").format(count)
        )  # fmt: skip
        return translate("model", "Now ({0}): {1}, {2} grows with {3}").format(
            place, words, frequency_text(worst.frequency_hz), quantity_text(worst.real_part_1_s, "1/s", 1)
        )
    moving = [pole for pole in poles if pole.frequency_hz > 0.0] or list(poles)
    least = min(moving, key=lambda pole: pole.damping_ratio)
    return translate("model", "Now ({0}): stable, least damping {1} at {2}").format(
        place, quantity_text(100.0 * least.damping_ratio, "%", 2), frequency_text(least.frequency_hz)
    )


def pole_text(pole: Pole) -> str:
    """A pole in one line: "Mode 5 · unstable · 2143 Hz · damping −0.02 % · 3.1 1/s"."""
    translate = QCoreApplication.translate
    return translate("model", "Mode {0} · {1} · {2} · damping {3} · {4}").format(
        pole.number,
        state_word(pole),
        frequency_text(pole.frequency_hz),
        quantity_text(100.0 * pole.damping_ratio, "%", 2),
        quantity_text(pole.real_part_1_s, "1/s", 1),
    )


def state_word(pole: Pole) -> str:
    """Stable or unstable."""
    if pole.unstable:
        return QCoreApplication.translate("model", "unstable")
    return QCoreApplication.translate("model", "stable")


def verdict_text(verdict: str) -> str:
    """Verdict over a modification, as a person's language says it."""
    texts = {
        "recommended": QCoreApplication.translate("model", "recommended"),
        "with care": QCoreApplication.translate("model", "with care"),
        "no effect": QCoreApplication.translate("model", "no effect"),
        "not recommended": QCoreApplication.translate("model", "not recommended"),
    }
    return texts[verdict]


def advice_text(row: Advice, ranking: Ranking) -> str:
    """What a modification does, in words (as `rigctl.model.advice.sentence` says it)."""
    translate, rule = QCoreApplication.translate, ranking.rule
    below, gain = f"{rule.below_hz / 1e3:g}", row.gain_1_s
    if gain > rule.least_gain_1_s:
        text = translate(
            "model", "lowers the real parts below {0} kHz by {1} 1/s in all at every friction from {2} to {3}"
        )
        words = [text.format(below, f"{gain:.3g}", f"{rule.mu_from:g}", f"{rule.mu_to:g}")]
    elif gain < -rule.least_gain_1_s:
        text = translate("model", "raises the real parts below {0} kHz by up to {1} 1/s in all")
        words = [text.format(below, f"{-gain:.3g}")]
    else:
        words = [translate("model", "hardly changes the real parts below {0} kHz").format(below)]
    if row.worst_rise <= _NO_RISE:
        words.append(translate("model", "makes no mode worse"))
    else:
        text = translate("model", "raises that of the mode at {0} Hz by {1} %")
        words.append(text.format(f"{row.rise_hz:.0f}", f"{100.0 * row.worst_rise:.2g}"))
    change = ranking.change_bar(row)
    if change is not None and ranking.onset_bar is not None and row.onset_bar is not None:
        if abs(change) <= rule.onset_share * ranking.onset_bar:
            words.append(translate("model", "leaves the onset at {0} bar").format(f"{row.onset_bar:.2f}"))
        else:
            text = translate("model", "moves the onset from {0} to {1} bar")
            words.append(text.format(f"{ranking.onset_bar:.2f}", f"{row.onset_bar:.2f}"))
    elif ranking.onset_bar is not None:
        words.append(translate("model", "stays stable over the whole range of pressure"))
    return f"{row.title}: {'; '.join(words)}"


def rule_text(rule: RankingRule) -> str:
    """How verdicts are made."""
    text = QCoreApplication.translate(
        "model",
        "Gain: the sum of real parts below {0} kHz falls at every friction from {1} to {2} by more than "
        "{3} % of their mean. Harm: a real part rises by more than {4} % of itself. "
        "Onset: moves by more than {5} %.",
    )
    return text.format(
        f"{rule.below_hz / 1e3:g}", f"{rule.mu_from:g}", f"{rule.mu_to:g}", f"{100 * rule.gain_share:g}",
        f"{100 * rule.harm_share:g}", f"{100 * rule.onset_share:g}",
    )  # fmt: skip
