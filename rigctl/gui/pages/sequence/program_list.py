"""Left column: the program's name and its sequences in order.

Job: show a `ProgramForm`, tell what a person does with it. Not its job: doing it (`draft`).
"""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QGridLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QMenu,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.sequence.checking import Fault
from rigctl.gui.pages.sequence.draft import ProgramDraft
from rigctl.gui.pages.sequence.section import fault_text
from rigctl.gui.pages.sequence.words import brakings_text, name_of
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel, PlainEdit, PlainText, set_wrong

_UID = Qt.ItemDataRole.UserRole


class _List(QListWidget):
    """Delete removes, Alt with arrows moves."""

    removePressed = Signal()
    movePressed = Signal(int)
    dropped = Signal()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """See QWidget."""
        step = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}.get(Qt.Key(event.key()), 0)
        if event.key() == Qt.Key.Key_Delete:
            self.removePressed.emit()
        elif step and event.modifiers() & Qt.KeyboardModifier.AltModifier:
            self.movePressed.emit(step)
        else:
            super().keyPressEvent(event)


class ProgramList(QWidget):
    """Name, description, sequences, and what can be done with them."""

    selected = Signal(int)
    """Sequence number (uid)."""
    nameEdited = Signal(str)
    descriptionEdited = Signal(str)
    enabledEdited = Signal(int, bool)
    moved = Signal(int, int)
    """(uid, place)."""
    addAsked = Signal(str)
    duplicateAsked = Signal(int)
    removeAsked = Signal(int)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.name = PlainEdit()
        self.name.setObjectName("program-name")
        self.name.setToolTip(self.tr("Name of the program; campaigns are called after it"))
        self.description = PlainText()
        self.description.setObjectName("program-description")
        self.description.setToolTip(self.tr("What the program is for, for those who find the data later"))
        self.description.setPlaceholderText(self.tr("What is it for?"))
        self.description.setTabChangesFocus(True)
        self.description.setUndoRedoEnabled(False)
        self.fault = FaultLabel(theme)
        self.list = _List()
        self.list.setObjectName("sequence-list")
        self.list.setDragDropMode(QAbstractItemView.DragDropMode.InternalMove)
        self.list.setDefaultDropAction(Qt.DropAction.MoveAction)
        self.list.setToolTip(
            self.tr(
                "The sequences run from top to bottom. Tick: it is run. Drag, or Alt with the arrow keys: "
                "move."
            )
        )
        self.list.setWordWrap(True)
        self._build()
        self._connect()
        theme.changed.connect(self._restyle)
        self._restyle()

    def _build(self) -> None:
        self.add = QPushButton(self.tr("Add"))
        menu = QMenu(self.add)
        for kind, text in (
            ("matrix", self.tr("Matrix of brakings")),
            ("bedding", self.tr("Bedding")),
            ("stop", self.tr("Stop brakings")),
        ):
            menu.addAction(text, lambda kind=kind: self.addAsked.emit(kind))
        self.add.setMenu(menu)
        self.duplicate = QPushButton(self.tr("Copy"))
        self.remove = QPushButton(self.tr("Remove"))
        self.up, self.down = QPushButton(self.tr("▲ Up")), QPushButton(self.tr("▼ Down"))
        self._grid = QGridLayout()
        for number, (button, key, tip) in enumerate(
            (
                (self.up, "up", self.tr("Run this sequence earlier (Alt+Up)")),
                (self.down, "down", self.tr("Run this sequence later (Alt+Down)")),
                (self.add, "add", self.tr("Add a sequence behind this one")),
                (self.duplicate, "duplicate", self.tr("A copy of this sequence behind it")),
                (self.remove, "remove", self.tr("Remove this sequence (Del); Ctrl+Z brings it back")),
            )
        ):
            button.setObjectName(f"sequence-{key}")
            button.setToolTip(tip)
            self._grid.addWidget(button, number // 2, number % 2)
        title = QLabel(self.tr("Program"))
        title.setProperty("look", "title")
        title.setBuddy(self.name)
        order = QLabel(self.tr("Sequences"))
        order.setProperty("look", "muted")
        self._column = QVBoxLayout(self)
        for widget, stretch in (
            (title, 0), (self.name, 0), (self.fault, 0), (self.description, 0), (order, 0), (self.list, 1),
        ):  # fmt: skip
            self._column.addWidget(widget, stretch)
        self._column.addLayout(self._grid)

    def _connect(self) -> None:
        self.name.textEdited.connect(self.nameEdited)
        self.description.textChanged.connect(self._on_description)
        self.list.currentItemChanged.connect(self._on_current)
        self.list.itemChanged.connect(self._on_item)
        self.list.model().rowsMoved.connect(self._on_dropped, Qt.ConnectionType.QueuedConnection)
        self.list.removePressed.connect(lambda: self.removeAsked.emit(self.current()))
        self.list.movePressed.connect(self._on_step)
        self.up.clicked.connect(lambda: self._on_step(-1))
        self.down.clicked.connect(lambda: self._on_step(1))
        self.duplicate.clicked.connect(lambda: self.duplicateAsked.emit(self.current()))
        self.remove.clicked.connect(lambda: self.removeAsked.emit(self.current()))

    def _restyle(self) -> None:
        unit = self._theme.px(1)
        self._column.setContentsMargins(unit, unit, unit, unit)
        self._column.setSpacing(unit)
        self._grid.setSpacing(round(unit / 2))
        self.description.setFixedHeight(self._theme.px(8))
        self.description.setFont(self._theme.font("small"))

    # -- value ------------------------------------------------------------------------------------

    def current(self) -> int:
        """Number of the selected sequence, 0 for none."""
        item = self.list.currentItem()
        return item.data(_UID) if item is not None else 0

    def show_draft(self, draft: ProgramDraft, faults: list[Fault], selected: int) -> None:
        """Show name, description and list of a draft."""
        form = draft.form
        self.name.setValue(form.name)
        if self.description.toPlainText() != form.description:
            with QSignalBlocker(self.description):
                self.description.setPlainText(form.description)
        own = [fault for fault in faults if fault.uid == 0]
        self.fault.setFault(*(fault_text(own) if own and form.sequences else ("", "error")))
        set_wrong(self.name, "error" if any(fault.place == "name" for fault in own) else "")
        with QSignalBlocker(self.list):
            while self.list.count() > len(form.sequences):
                self.list.takeItem(self.list.count() - 1)
            while self.list.count() < len(form.sequences):
                self.list.addItem(QListWidgetItem())
            for row, sequence in enumerate(form.sequences):
                wrong = [f for f in faults if f.uid == sequence.uid]
                self._fill(self.list.item(row), draft, row, wrong)
                if sequence.uid == selected:
                    self.list.setCurrentRow(row)
        row = draft.position(selected)
        self.up.setEnabled(row > 0)
        self.down.setEnabled(0 <= row < len(form.sequences) - 1)
        for button in (self.duplicate, self.remove):
            button.setEnabled(row >= 0)

    def _fill(self, item: QListWidgetItem, draft: ProgramDraft, row: int, wrong: list[Fault]) -> None:
        sequence = draft.form.sequences[row]
        errors = sum(fault.severity == "error" for fault in wrong)
        about = brakings_text(draft.count(sequence.uid)) if sequence.enabled else self.tr("off")
        mark = self.tr("✕ see the fields") if errors else ("▲ " if wrong else "") + about
        name = sequence.name.strip() or self.tr("(no name)")
        item.setText(f"{name}\n{mark} · {name_of(sequence.role)}")
        item.setData(_UID, sequence.uid)
        item.setToolTip("\n".join(fault.text for fault in wrong))
        item.setFlags(
            Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
            | Qt.ItemFlag.ItemIsDragEnabled | Qt.ItemFlag.ItemIsUserCheckable
        )  # fmt: skip
        item.setCheckState(Qt.CheckState.Checked if sequence.enabled else Qt.CheckState.Unchecked)
        item.setForeground(self._theme.colour("text" if sequence.enabled else "muted"))
        item.setSizeHint(QSize(0, self._theme.px(5.5)))

    # -- hands ------------------------------------------------------------------------------------

    def _on_description(self) -> None:
        self.descriptionEdited.emit(self.description.toPlainText())

    def _on_current(self, item: QListWidgetItem | None) -> None:
        if item is not None:
            self.selected.emit(item.data(_UID))

    def _on_item(self, item: QListWidgetItem) -> None:
        self.enabledEdited.emit(item.data(_UID), item.checkState() == Qt.CheckState.Checked)

    def _on_step(self, step: int) -> None:
        row = self.list.currentRow()
        if row >= 0:
            self.moved.emit(self.current(), row + step)

    def _on_dropped(self) -> None:
        """A row was dragged: the list shows the new order already."""
        self.moved.emit(self.current(), self.list.currentRow())
