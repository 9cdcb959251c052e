"""Words of the model page: names of sliders, onset in a sentence, state of a mode.

Pure texts, translated; no widget. Not its job: numbers.
"""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.gui.format import frequency_text, number_text, quantity_text
from rigctl.gui.pages.model.data import MU, PRESSURE, SLOPE, BrakeFacts, Knob, OnsetFound, Pole, Setting

CONTEXT = "model"
STABLE_MARK, UNSTABLE_MARK = "●", "▲"

_NAMES = {
    MU: QT_TRANSLATE_NOOP("model", "Coefficient of friction µ"),
    PRESSURE: QT_TRANSLATE_NOOP("model", "Brake pressure p"),
    SLOPE: QT_TRANSLATE_NOOP("model", "Falling slope of friction k"),
}
UNITS = {MU: "", PRESSURE: "bar", SLOPE: "s/m"}
DECIMALS = {MU: 2, PRESSURE: 1, SLOPE: 4}
_SIDES = {
    "leading": QT_TRANSLATE_NOOP("model", "{0}, leading side"),
    "trailing": QT_TRANSLATE_NOOP("model", "{0}, trailing side"),
}


def tr(text: str) -> str:
    """A text of this page in the window's language."""
    return QCoreApplication.translate(CONTEXT, text)


def knob_title(knob: Knob) -> str:
    """Name of a parameter group, of one side of it, or of a quantity with its unit."""
    if knob.side:
        return tr(str(_SIDES[knob.side])).format(knob.title)
    return knob.title if knob.group or not knob.unit else f"{knob.title}  [{knob.unit}]"


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
    return translate("model", "{0}, at any pressure because k = 0").format(text)


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
    """A pole in one line: "Mode 5 · 2143 Hz · +3.1 1/s · damping −0.02 % · unstable"."""
    translate = QCoreApplication.translate
    return translate("model", "Mode {0} · {1} · {2} · damping {3} · {4}").format(
        pole.number,
        frequency_text(pole.frequency_hz),
        quantity_text(pole.real_part_1_s, "1/s", 1),
        quantity_text(100.0 * pole.damping_ratio, "%", 2),
        state_word(pole),
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
