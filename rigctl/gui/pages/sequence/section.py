"""What every section of the editor offers: a part of a sequence's form, its faults, and the keyboard.

Job: the common interface. Not its job: any field.
"""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QWidget

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.checking import Fault
from rigctl.gui.pages.sequence.forms import SequenceForm
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FieldGrid, PlainEdit

Faults = dict[str, list[Fault]]


def fault_text(faults: list[Fault]) -> tuple[str, str]:
    """Text and severity of what is wrong at one field."""
    severity = "error" if any(fault.severity == "error" for fault in faults) else "warning"
    return "\n".join(fault.text for fault in faults), severity


class Section(QWidget):
    """Part of the editor."""

    valueChanged = Signal(str, bool)
    """(place, typed): a person has changed a field; `typed`: letter by letter."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self.theme = theme

    @property
    def places(self) -> tuple[str, ...]:
        """Keys of the fields of this section."""
        raise NotImplementedError

    def value(self, form: SequenceForm) -> SequenceForm:
        """`form` with this section's part as it is shown."""
        raise NotImplementedError

    def setValue(self, form: SequenceForm) -> None:
        """Show this section's part of `form`; not an edit."""
        raise NotImplementedError

    def show_faults(self, faults: Faults) -> None:
        """Show what is wrong at the fields of this section."""
        raise NotImplementedError

    def show_rig(self, rig: RigConfig | None) -> None:
        """Take limits and defaults of the rig."""

    def focus(self, place: str) -> None:
        """Bring the keyboard to a field."""
        raise NotImplementedError

    # -- for the sections -------------------------------------------------------------------------

    def typed(self, grid: FieldGrid, place: str, name: str, unit: str = "", tip: str = "",
              *, wide: bool = False) -> PlainEdit:  # fmt: skip
        """A field of text in `grid`."""
        edit = PlainEdit()
        if not wide:
            edit.setAlignment(Qt.AlignmentFlag.AlignRight)
        edit.textEdited.connect(lambda _text: self.valueChanged.emit(place, True))
        grid.add(place, name, edit, unit, tip, wide=wide)
        return edit

    def chosen(
        self, grid: FieldGrid, place: str, name: str, entries: dict[str, str], tip: str = ""
    ) -> QComboBox:
        """A choice in `grid`: keys and names."""
        combo = QComboBox()
        for key, text in entries.items():
            combo.addItem(text, key)
        combo.activated.connect(lambda _index: self.valueChanged.emit(place, False))
        combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        grid.add(place, name, combo, tip=tip, wide=True, stretch=False)
        return combo


def choose(combo: QComboBox, key: str) -> None:
    """Show the entry of that key."""
    index = combo.findData(key)
    if index >= 0 and index != combo.currentIndex():
        combo.setCurrentIndex(index)


def show_in_grid(grid: FieldGrid, faults: Faults) -> None:
    """Faults at all fields of a grid."""
    for place in grid.places:
        found = faults.get(place, [])
        grid.set_fault(place, *(fault_text(found) if found else ("", "error")))
