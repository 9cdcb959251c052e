"""What a person has chosen on the model page, and the answers to it: brake, sliders, selected mode.

Job: keep slider values, ask the worker, hand answers on; no widget. Not its job: computing (`worker`), maps
and rankings (`map_tab`, `ranking_tab`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from rigctl.gui.pages.model import worker
from rigctl.gui.pages.model.data import (
    FACTORS,
    OPERATING,
    PRESSURE,
    BrakeFacts,
    Knob,
    LocusLines,
    Onsets,
    Pole,
    Poles,
    Setting,
)
from rigctl.gui.pages.model.latest import Latest
from rigctl.gui.services import Services

LANE = "model"
#: a slider's own pressure at first: the middle of what rigs brake with
START_PRESSURE_BAR = 10.0
#: the onset takes longer than the poles: while a slider is dragged it is asked for this seldom
ONSET_MS = 80


class ModelState(QObject):
    """Brake, sliders, selection; see the signals.

    Signals
    -------
    brakeRead : BrakeFacts, or None while there is no usable brake
    brakeWrong, otherWrong : why a file was refused; "" when it is well
    changed : a slider has another value
    polesFound, onsetsFound, locusFound : answers of the worker
    locusWrong : why there is no path
    locusAway : the path on screen no longer belongs to the sliders; a new one is asked for
    wrong : the sliders' values are impossible for this brake, or ""
    """

    brakeRead = Signal(object)
    brakeWrong = Signal(str)
    otherRead = Signal(object)
    otherWrong = Signal(str)
    changed = Signal()
    polesFound = Signal(object)
    onsetsFound = Signal(object)
    locusFound = Signal(object)
    locusAway = Signal()
    locusWrong = Signal(str)
    wrong = Signal(str)

    def __init__(self, services: Services, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.facts: BrakeFacts | None = None
        self.other: BrakeFacts | None = None
        self.operating: dict[str, float] = {}
        self.factors: dict[str, float] = {}
        self.active = PRESSURE
        self.poles: Poles | None = None
        self.onsets: Onsets | None = None
        self.locus: LocusLines | None = None
        self._near: complex | None = None
        self._pick = 0
        self._locus_key: object = None
        work = services.work
        self._readers = {which: Latest(work, worker.read, LANE, self) for which in ("brake", "other")}
        self._readers["brake"].answered.connect(self._take_brake)
        self._readers["brake"].failed.connect(self._refuse_brake)
        self._readers["other"].answered.connect(self._take_other)
        self._readers["other"].failed.connect(self._refuse_other)
        self._poles = Latest(work, worker.poles, LANE, self)
        self._onsets = Latest(work, worker.onsets, LANE, self)
        self._locus = Latest(work, worker.locus, LANE, self)
        self._poles.answered.connect(self._take_poles)
        self._poles.failed.connect(self.wrong)
        self._onset_timer = QTimer(self)
        self._onset_timer.setSingleShot(True)
        self._onset_timer.setInterval(ONSET_MS)
        self._onset_timer.timeout.connect(self._ask_onsets)
        self._onsets.answered.connect(self._take_onsets)
        self._onsets.failed.connect(self.wrong)
        self._locus.answered.connect(self._take_locus)
        self._locus.failed.connect(self.locusWrong)

    # -- files ------------------------------------------------------------------------------------

    def open(self, path: Path) -> None:
        """Read a brake file; sliders go to the file's values."""
        self._readers["brake"].ask(path)

    def compare(self, path: Path | None) -> None:
        """Read a brake file to compare with; None: none."""
        if path is not None:
            self._readers["other"].ask(path)
            return
        self._readers["other"].drop()
        self._take_other(None)

    def _take_brake(self, facts: BrakeFacts) -> None:
        self.facts = facts
        self.factors = {}
        self.operating = {name: _clipped(value, OPERATING[name]) for name, value in facts.operating.items()}
        if self.operating[PRESSURE] == 0.0:
            self.operating[PRESSURE] = START_PRESSURE_BAR
        self.active = PRESSURE
        self._near, self._locus_key = None, None
        self._pick += 1
        self.brakeWrong.emit("")
        self.brakeRead.emit(facts)
        self._ask()

    def _refuse_brake(self, text: str) -> None:
        for latest in (self._poles, self._onsets, self._locus):
            latest.drop()
        self.facts, self.poles, self.onsets, self.locus, self._locus_key = None, None, None, None, None
        self.brakeWrong.emit(text)
        self.brakeRead.emit(None)

    def _take_other(self, facts: BrakeFacts | None) -> None:
        self.other = facts
        self.otherWrong.emit("")
        self.otherRead.emit(facts)
        self._ask()

    def _refuse_other(self, text: str) -> None:
        self._take_other(None)
        self.otherWrong.emit(text)

    # -- sliders ----------------------------------------------------------------------------------

    @property
    def setting(self) -> Setting:
        """Present values for the worker."""
        factors: dict[str, float] = {}
        if self.facts is not None:
            for key, factor in self.factors.items():
                for member in self.facts.knob(key).members:
                    factors[member] = factors.get(member, 1.0) * factor
        return Setting(**self.operating, factors=tuple(sorted(factors.items())))

    def value(self, key: str) -> float:
        """Value of a slider: operating value or factor."""
        return self.operating[key] if key in OPERATING else self.factors.get(key, 1.0)

    def home(self, key: str) -> float:
        """Value of a slider after `reset`: the file's, a factor of 1."""
        assert self.facts is not None
        if key not in OPERATING:
            return 1.0
        value = _clipped(self.facts.operating[key], OPERATING[key])
        return START_PRESSURE_BAR if key == PRESSURE and value == 0.0 else value

    def set(self, values: Mapping[str, float], *, active: str | None = None) -> None:
        """Move sliders; the one named `active` is what the path runs over from now on."""
        if self.facts is None:
            return
        for key, value in values.items():
            if key in OPERATING:
                self.operating[key] = _clipped(value, OPERATING[key])
            elif value == 1.0:
                self.factors.pop(key, None)
            else:
                self.factors[key] = _clipped(value, FACTORS)
        if active is not None:
            self.active = active
        self.changed.emit()
        self._ask()

    def multiply(self, factors: Mapping[str, float]) -> None:
        """Lay further factors on sliders (a design modification)."""
        self.set({key: self.value(key) * factor for key, factor in factors.items()})

    def reset(self, keys: Iterable[str] | None = None) -> None:
        """Sliders back to the file's values; None: all."""
        if self.facts is None:
            return
        chosen = [*OPERATING, *self.factors] if keys is None else list(keys)
        self.set({key: self.home(key) for key in chosen})

    def changed_keys(self) -> list[str]:
        """Sliders that are not where `reset` puts them."""
        if self.facts is None:
            return []
        moved = [key for key in OPERATING if self.operating[key] != self.home(key)]
        return [*moved, *self.factors]

    @property
    def busy(self) -> bool:
        """Whether answers are still to come."""
        latests = (*self._readers.values(), self._poles, self._onsets, self._locus)
        return self._onset_timer.isActive() or any(latest.busy for latest in latests)

    # -- modes ------------------------------------------------------------------------------------

    def select(self, pole: Pole | None) -> None:
        """Look at a mode; None: at the critical one."""
        self._near = None if pole is None else pole.eigenvalue
        self._pick += 1
        self._ask_poles()

    @property
    def selected(self) -> Pole | None:
        """The mode whose shape is shown."""
        return None if self.poles is None else self.poles.selected

    # -- questions and answers --------------------------------------------------------------------

    def _ask(self) -> None:
        if self.facts is None:
            return
        self._ask_poles()
        if not self._onset_timer.isActive():
            self._onset_timer.start()
        self._ask_locus()

    def _ask_poles(self) -> None:
        if self.facts is not None:
            other = None if self.other is None else self.other.file
            self._poles.ask(self.facts.file, self.setting, self._near, other, self._pick)

    def _ask_onsets(self) -> None:
        if self.facts is not None:
            other = None if self.other is None else self.other.file
            self._onsets.ask(self.facts.file, self.setting, other)

    def _ask_locus(self) -> None:
        """Ask for a path where the one there is does not belong to the sliders any more."""
        assert self.facts is not None
        over: str | Knob = self.active
        if self.active in OPERATING:
            setting = replace(self.setting, **{self.active: 0.0})
        else:
            over = self.facts.knob(self.active)
            kept, self.factors = self.factors, {k: f for k, f in self.factors.items() if k != self.active}
            setting, self.factors = self.setting, kept
        key = (self.facts.file, setting, self.active)
        if key != self._locus_key:
            self._locus_key = key
            self.locusAway.emit()
            self._locus.ask(self.facts.file, setting, over)

    def _take_poles(self, poles: Poles) -> None:
        self.poles = poles
        if self._near is not None and poles.pick == self._pick:
            self._near = poles.selected.eigenvalue  # the same mode a little further
        self.wrong.emit("")
        self.polesFound.emit(poles)

    def _take_onsets(self, onsets: Onsets) -> None:
        self.onsets = onsets
        self.onsetsFound.emit(onsets)

    def _take_locus(self, locus: LocusLines) -> None:
        self.locus = locus
        self.locusFound.emit(locus)


def _clipped(value: float, ends: tuple[float, float]) -> float:
    return min(max(value, ends[0]), ends[1])
