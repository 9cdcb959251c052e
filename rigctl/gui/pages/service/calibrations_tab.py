"""The calibrations of a rig: what holds and until when, all that were made, and the way into the procedures.

Job: overview, history, starting and leaving a procedure. Not its job: the procedures (`torque_view`,
`sound_view`, `heat_view`), the files (`rigctl.calibration.store`).
"""

from __future__ import annotations

from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QStackedWidget, QVBoxLayout, QWidget

from rigctl.calibration.record import Calibration, Due, Quantity
from rigctl.calibration.store import DueLine, Kept, due_lines, history, newest, rig_folder
from rigctl.gui.format import number_text
from rigctl.gui.pages.service.live_session import LiveSession
from rigctl.gui.pages.service.parts import Panel, PlainTable, label, set_look
from rigctl.gui.pages.service.procedure import Procedure
from rigctl.gui.rig.phases import said
from rigctl.gui.services import Services
from rigctl.gui.widgets.notice import Notice
from rigctl.gui.work import Reporter

translate = QCoreApplication.translate


class DueCard(Panel):
    """One quantity: state in words and shape, result, [Calibrate]."""

    def __init__(self, services: Services, quantity: Quantity, title: str, tip: str) -> None:
        super().__init__(services.theme, title)
        self.quantity = quantity
        self.state = label()
        self.state.setObjectName(f"due-{quantity}")
        self.what = label("", "muted", wrap=True)
        self.start = QPushButton(self.tr("Calibrate …"))
        self.start.setObjectName(f"calibrate-{quantity}")
        self.start.setToolTip(tip)
        row = QHBoxLayout()
        row.addWidget(self.state)
        row.addStretch(1)
        bottom = QHBoxLayout()
        bottom.addWidget(self.start)
        bottom.addStretch(1)
        self.body.addLayout(row)
        self.body.addWidget(self.what, 1)
        self.body.addLayout(bottom)

    def show_line(self, line: DueLine) -> None:
        """Show what holds."""
        looks = {Due.VALID: "", Due.SOON: "warning", Due.OVERDUE: "alarm", Due.NEVER: "muted"}
        words = {
            Due.VALID: self.tr("valid until {0}"),
            Due.SOON: self.tr("▲ due on {0}"),
            Due.OVERDUE: self.tr("▲ overdue since {0}"),
            Due.NEVER: self.tr("never calibrated"),
        }
        kept = line.kept
        due = kept.calibration.due.isoformat() if kept is not None else ""
        self.state.setText(words[line.state].format(due))
        set_look(self.state, looks[line.state])
        self.what.setText(
            "" if kept is None else f"{result_text(kept.calibration)}\n{_who(kept.calibration)}"
        )


def result_text(found: Calibration) -> str:
    """The result in one line."""
    if found.quantity is Quantity.EMISSIVITY and found.emissivity is not None:
        text = f"ε = {number_text(found.emissivity, 3)}"
        return (
            text
            if found.gain == 1.0
            else translate("calibrations", "{0}, gain {1:.4f}, offset {2:+.2f} K").format(
                text, found.gain, found.offset
            )
        )
    if found.quantity is Quantity.MICROPHONE:
        return translate("calibrations", "{0:.5f} mPa/count, gain {1:.4f}").format(
            1e3 * found.gain * found.nominal_scale, found.gain
        )
    return translate("calibrations", "gain {0:.5f}, offset {1:+.2f} {2}").format(
        found.gain, found.offset, found.unit
    )


def _who(found: Calibration) -> str:
    return f"{found.date.astimezone():%Y-%m-%d %H:%M}, {found.operator}"


def details_text(kept: Kept) -> str:
    """Everything that is kept of one calibration, for people."""
    found = kept.calibration
    valid = translate("calibrations", "{0}; valid until {1}").format(_who(found), found.due)
    lines = [f"{said(found.quantity)}: {result_text(found)}", valid]
    further = (
        (translate("calibrations", "sensor"), found.instrument),
        (translate("calibrations", "reference"), found.reference),
        (translate("calibrations", "note"), found.note),
    )
    lines += [f"{name}: {text}" for name, text in further if text]
    lines += [", ".join(figure_text(name, value) for name, value in found.figures.items())]
    lines += [translate("calibrations", "{0} readings; {1}").format(len(found.points), kept.path)]
    return "\n".join(line for line in lines if line)


def figure_text(name: str, value: float) -> str:
    """A named number for people: "residual_percent" is "residual 0.08 %"."""
    words, _, unit = name.rpartition("_")
    units = {"percent": "%", "k": "K", "db": "dB", "hz": "Hz"}
    if unit not in units:
        return f"{name.replace('_', ' ')} {value:.3g}"
    return f"{words.replace('_', ' ')} {value:.3g} {units[unit]}"


def session_folder(session: Any) -> Path:
    """Where the calibrations of the rig of a session are kept."""
    named = session.rig.calibrations
    return Path(named.folder) if named is not None else rig_folder(session.campaign.parent, session.rig.name)


class CalibrationsTab(QWidget):
    """Overview and procedures."""

    def __init__(self, services: Services, live: LiveSession) -> None:
        super().__init__()
        self.services = services
        self._live = live
        self.theme = services.theme
        self._kept: list[Kept] = []
        self._folder: Path | None = None
        self.procedure: Procedure | None = None
        self._stack = QStackedWidget()
        self._stack.addWidget(self._overview())
        self.notice = Notice(self.theme)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.notice)
        layout.addWidget(self._stack, 1)
        live.began.connect(self._on_began)
        live.ended.connect(self._on_ended)

    def _overview(self) -> QWidget:
        tips = {
            Quantity.TORQUE: (self.tr("Torque"), self.tr("By lever and weights, in both directions")),
            Quantity.MICROPHONE: (self.tr("Microphone"), self.tr("By a calibrator of 94 or 114 dB")),
            Quantity.EMISSIVITY: (self.tr("Emissivity"), self.tr("By a contact thermometer")),
        }
        self.place = label(wrap=True)
        self.place.setObjectName("calibrations-place")
        self.cards = {q: DueCard(self.services, q, *texts) for q, texts in tips.items()}
        cards = QHBoxLayout()
        cards.setSpacing(self.theme.px(2))
        for quantity, card in self.cards.items():
            card.start.clicked.connect(partial(self.begin, quantity))
            cards.addWidget(card, 1)
        heads = (
            self.tr("Date"), self.tr("Quantity"), self.tr("Result"), self.tr("Operator"), self.tr("Due"),
        )  # fmt: skip
        self.table = PlainTable(self.theme, heads, stretch=2)
        self.table.setObjectName("calibrations-table")
        self.table.itemSelectionChanged.connect(self._show_details)
        self.details = label("", "muted", wrap=True)
        self.empty = label(
            self.tr(
                "No calibration has been made here yet. [Calibrate …] leads through it step by step; every "
                "result is kept with its readings, the newest of each quantity holds."
            ),
            "muted",
            wrap=True,
        )
        self.faults = label("", "error", wrap=True)
        self.faults.hide()
        widget = QWidget()
        column = QVBoxLayout(widget)
        unit = self.theme.px(1)
        column.setContentsMargins(unit, unit, unit, unit)
        column.setSpacing(unit)
        column.addWidget(self.place)
        column.addLayout(cards)
        column.addWidget(self.faults)
        column.addWidget(self.table, 1)
        column.addWidget(self.details)
        column.addWidget(self.empty)
        column.addStretch(0)
        return widget

    # -- files -----------------------------------------------------------------------------------

    def activated(self) -> None:
        """Shown: read the folder."""
        self.refresh()

    def deactivated(self) -> None:
        """Another tab or page is shown; a procedure keeps its readings."""

    def refresh(self) -> None:
        """Read the folder of the rig that is watched."""
        session = self._live.session
        for card in self.cards.values():
            card.start.setEnabled(session is not None)
        if session is None:
            self._folder = None
            self.place.setText(
                self.tr(
                    "Calibrations are made on a running rig: choose one on the Manual page and connect; it "
                    "need not be enabled. Then its calibrations and their due dates stand here."
                )
            )
            self._show_kept(([], []))
            return
        self._folder = session_folder(session)
        self.place.setText(self.tr("Rig: {0}. Kept in {1}").format(session.rig.name, self._folder))
        self.services.work.in_thread(_read, self._folder, done=self._show_kept, failed=self._on_unreadable)

    def _on_unreadable(self, why: str) -> None:
        self.faults.setText("▲ " + why)
        self.faults.show()

    def _show_kept(self, pair: tuple[list[Kept], list[str]]) -> None:
        self._kept, faults = pair
        self.faults.setText("▲ " + "\n".join(faults))
        self.faults.setVisible(bool(faults))
        for line in due_lines(self._kept, datetime.now(UTC).date()):
            self.cards[line.quantity].show_line(line)
        self.table.show_rows(
            [
                (
                    f"{k.calibration.date.astimezone():%Y-%m-%d %H:%M}", said(k.calibration.quantity),
                    result_text(k.calibration), k.calibration.operator, k.calibration.due.isoformat(),
                )
                for k in self._kept
            ]
        )  # fmt: skip
        self.table.setVisible(bool(self._kept))
        self.details.setVisible(bool(self._kept))
        self.empty.setVisible(not self._kept and self._folder is not None)
        self._show_details()

    def _show_details(self) -> None:
        row = self.table.currentRow()
        self.details.setText(details_text(self._kept[row]) if 0 <= row < len(self._kept) else "")

    # -- procedures ------------------------------------------------------------------------------

    def begin(self, quantity: Quantity, _checked: bool = False) -> None:
        """Start a procedure on the session that is watched."""
        session, folder = self._live.session, self._folder
        if session is None or folder is None or self.procedure is not None:
            return
        if quantity is Quantity.TORQUE:
            from rigctl.gui.pages.service.torque_view import TorqueView

            procedure: Procedure = TorqueView(self.services, session, folder)
        elif quantity is Quantity.MICROPHONE:
            from rigctl.gui.pages.service.sound_view import SoundView

            last = newest(self._kept).get(quantity)
            gain = None if last is None else last.calibration.gain
            procedure = SoundView(self.services, session, folder, gain)
        else:
            from rigctl.gui.pages.service.heat_view import HeatView

            procedure = HeatView(self.services, session, folder)
        procedure.left.connect(self._ask_to_leave)
        procedure.saved.connect(self._on_saved)
        self.procedure = procedure
        self._stack.addWidget(procedure)
        self._stack.setCurrentWidget(procedure)

    def _ask_to_leave(self) -> None:
        if self.procedure is not None and self.procedure.unsaved():
            self.notice.ask(
                self.tr("The readings of this calibration are not saved."),
                [(self.tr("Leave, lose them"), self.leave), (self.tr("Go on"), None)],
            )
        else:
            self.leave()

    def _on_saved(self, _path: Path) -> None:
        self.leave()

    def leave(self) -> None:
        """Back to the overview."""
        procedure, self.procedure = self.procedure, None
        if procedure is not None:
            procedure.stop()
            self._stack.removeWidget(procedure)
            procedure.deleteLater()
        self._stack.setCurrentIndex(0)
        self.refresh()

    def unsaved(self) -> list[str]:
        """What would be lost by closing the window."""
        if self.procedure is not None and self.procedure.unsaved():
            return [self.tr("Readings of a calibration that is not saved")]
        return []

    def _on_began(self, _session: Any) -> None:
        if self.procedure is None:
            self.refresh()

    def _on_ended(self) -> None:
        if self.procedure is not None:
            self.procedure.say(self.tr("The session has ended: no more readings can be taken."), "error")
        else:
            self.refresh()

    def stop(self) -> None:
        """The window closes."""
        if self.procedure is not None:
            self.procedure.stop()


def _read(folder: Path, _reporter: Reporter) -> tuple[list[Kept], list[str]]:
    return history(folder)
