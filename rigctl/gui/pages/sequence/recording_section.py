"""Section "Recording": sampling rate, channels with their decimation and stored rate, lead and lag.

Not its job: storing (`rigctl.recording`).
"""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QGridLayout, QLabel, QVBoxLayout, QWidget

from rigctl.config.rig import RigConfig
from rigctl.gui.format import MISSING, frequency_text
from rigctl.gui.pages.sequence.forms import ChannelRow, RecordingForm, SequenceForm
from rigctl.gui.pages.sequence.paste import parse_number
from rigctl.gui.pages.sequence.section import Faults, Section, fault_text, show_in_grid
from rigctl.gui.pages.sequence.words import channel_name
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel, FieldGrid, PlainEdit, set_wrong

_PLACE = "recording.channels"


class _ChannelLine:
    """Widgets of one channel."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.box = QCheckBox(channel_name(name))
        self.box.setObjectName(f"channel-{name}")
        self.decimation = PlainEdit()
        self.decimation.setObjectName(f"decimation-{name}")
        self.decimation.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.rate = QLabel()
        self.rate.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.own = QLabel()
        self.own.setProperty("look", "muted")
        self.own.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)

    @property
    def widgets(self) -> tuple[QWidget, ...]:
        return self.box, self.decimation, self.rate, self.own


class RecordingSection(Section):
    """Rates and channels."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__(theme)
        self._rig: RigConfig | None = None
        self.lines: list[_ChannelLine] = []
        self.grid = FieldGrid(theme)
        self.sampling = self.typed(
            self.grid,
            "recording.sampling_hz",
            self.tr("Sa&mpling rate"),
            "Hz",
            self.tr("All channels are sampled at this rate, then decimated"),
        )
        self.pre = self.typed(
            self.grid,
            "recording.pre_s",
            self.tr("From &before the pressure"),
            "s",
            self.tr("Recorded before the pressure comes on: the background noise"),
        )
        self.post = self.typed(
            self.grid,
            "recording.post_s",
            self.tr("To &after the release"),
            "s",
            self.tr("Recorded after the braking"),
        )
        self.fault = FaultLabel(theme)
        self._table = QGridLayout()
        heads = (self.tr("Channel"), self.tr("Decimation"), self.tr("Stored rate"), self.tr("Rig's rate"))
        self._heads = [QLabel(text) for text in heads]
        self._heads[1].setToolTip(self.tr("Every how manyth value is stored, behind an anti-alias filter"))
        for column, head in enumerate(self._heads):
            head.setProperty("look", "muted")
            right = Qt.AlignmentFlag.AlignRight if column else Qt.AlignmentFlag.AlignLeft
            self._table.addWidget(head, 0, column, right)
        self._table.setColumnStretch(4, 1)
        self._layout = QVBoxLayout(self)
        self._layout.addWidget(self.grid)
        self._layout.addLayout(self._table)
        self._layout.addWidget(self.fault)
        self._layout.addStretch(1)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._layout.setSpacing(self.theme.px(1.5))
        self._table.setHorizontalSpacing(self.theme.px(3))
        self._table.setVerticalSpacing(self.theme.px(0.5))
        for line in self.lines:
            line.decimation.setFixedWidth(self.theme.px(9))

    @property
    def places(self) -> tuple[str, ...]:
        """See Section."""
        return (*self.grid.places, _PLACE)

    def value(self, form: SequenceForm) -> SequenceForm:
        """See Section."""
        rows = tuple(
            ChannelRow(line.name, line.decimation.text()) for line in self.lines if line.box.isChecked()
        )
        recording = RecordingForm(self.sampling.text(), rows, self.pre.text(), self.post.text())
        return replace(form, recording=recording)

    def setValue(self, form: SequenceForm) -> None:
        """See Section."""
        recording = form.recording
        self.sampling.setValue(recording.sampling)
        self.pre.setValue(recording.pre)
        self.post.setValue(recording.post)
        self._make_lines(recording)
        chosen = {row.name: row.decimation for row in recording.channels}
        for line in self.lines:
            line.box.blockSignals(True)
            line.box.setChecked(line.name in chosen)
            line.box.blockSignals(False)
            if line.name in chosen:
                line.decimation.setValue(chosen[line.name])
            elif not line.decimation.text():
                line.decimation.setValue(self._fitting(line.name, recording.sampling))
            line.decimation.setEnabled(line.name in chosen)
        self._show_rates()

    def _make_lines(self, recording: RecordingForm) -> None:
        """A line for each channel: those of the sequence in its order, then the other ones of the rig."""
        named = [row.name for row in recording.channels]
        present = [line.name for line in self.lines]
        others = self._rig.capabilities.channels if self._rig is not None else {}
        wanted = list(dict.fromkeys([*named, *others]))
        kept = [name for name in present if name in wanted]
        if [name for name in kept if name in named] == named and set(kept) == set(wanted) == set(present):
            return  # nothing new; unticked channels keep their places
        decimations = {line.name: line.decimation.text() for line in self.lines}
        for line in self.lines:
            for widget in line.widgets:
                self._table.removeWidget(widget)
                widget.hide()
                widget.deleteLater()
        self.lines = []
        for row, name in enumerate(wanted, start=1):
            line = _ChannelLine(name)
            line.decimation.setText(decimations.get(name, ""))
            line.box.setToolTip(self.tr("Store this channel"))
            line.decimation.setToolTip(self.tr("1 stores every value, 40 every fortieth"))
            line.decimation.setAccessibleName(self.tr("Decimation of {0}").format(channel_name(name)))
            line.decimation.setFixedWidth(self.theme.px(9))
            line.box.toggled.connect(lambda _on: self.valueChanged.emit(_PLACE, False))
            line.decimation.textEdited.connect(lambda _text: self.valueChanged.emit(_PLACE, True))
            for column, widget in enumerate(line.widgets):
                self._table.addWidget(widget, row, column)
            self.lines.append(line)

    def _fitting(self, name: str, sampling: str) -> str:
        """A decimation to begin with: sound whole, others a thousand values per second."""
        rate = parse_number(sampling)
        channel = self._rig.capabilities.channels.get(name) if self._rig is not None else None
        if rate is None or channel is None or channel.is_sound:
            return "1"
        return str(max(round(rate / 1000.0), 1))

    def _show_rates(self) -> None:
        sampling = parse_number(self.sampling.text())
        for line in self.lines:
            every = parse_number(line.decimation.text())
            known = sampling is not None and every is not None and every > 0 and line.box.isChecked()
            line.rate.setText(frequency_text(sampling / every) if known else MISSING)  # type: ignore[operator]
            channel = self._rig.capabilities.channels.get(line.name) if self._rig is not None else None
            line.own.setText(frequency_text(channel.rate_hz) if channel is not None else MISSING)

    def show_faults(self, faults: Faults) -> None:
        """See Section."""
        show_in_grid(self.grid, faults)
        found = faults.get(_PLACE, [])
        self.fault.setFault(*(fault_text(found) if found else ("", "error")))
        wrong = {row for fault in found for row, _ in fault.cells if fault.severity == "error"}
        chosen = [line for line in self.lines if line.box.isChecked()]
        for row, line in enumerate(chosen):
            set_wrong(line.decimation, "error" if row in wrong else "")

    def show_rig(self, rig: RigConfig | None) -> None:
        """See Section; `setValue` follows and shows its channels."""
        self._rig = rig

    def focus(self, place: str) -> None:
        """See Section."""
        if place == _PLACE:
            if self.lines:
                self.lines[0].box.setFocus(Qt.FocusReason.OtherFocusReason)
        else:
            self.grid.focus(place)
