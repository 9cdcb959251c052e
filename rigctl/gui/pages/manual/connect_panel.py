"""The manual page without a session: what it is for, which rig, and [Connect].

Job: choose a rig file and how its time runs. Not its job: starting the controller (`RigConnection`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QButtonGroup,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.manual.rigs import RigChoice
from rigctl.gui.theme import ThemeKeeper


class ConnectPanel(QWidget):
    """Choice of a rig. `connectAsked` carries the path of the rig file and "real" or "virtual"."""

    connectAsked = Signal(object, str)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._choices: list[RigChoice] = []
        self._busy = False
        self.title = QLabel(self.tr("Move motor and brake by hand"))
        self.teaching = QLabel(
            self.tr(
                "1.  Choose a rig and connect. A controller is started for it; closing this window does not"
                " stop it.\n"
                "2.  Enable: the watchdog checks the rig at rest, then motor and brake may move.\n"
                "3.  Type speed and pressure; Enter applies. The space bar releases the pressure.\n"
                "4.  Record a braking: it is stored with all signals and shown on the Data page."
            )
        )
        self.teaching.setWordWrap(True)
        self.rig = QComboBox()
        self.rig.setObjectName("connect-rig")
        self.rig.setToolTip(self.tr("Rig files of the folder “rigs” of the configuration"))
        self.real = QRadioButton(self.tr("by the &clock"))
        self.real.setObjectName("connect-time-real")
        self.real.setToolTip(
            self.tr("The simulated rig takes as long as a real one: you can watch and listen")
        )
        self.real.setChecked(True)
        self.virtual = QRadioButton(self.tr("as &fast as possible"))
        self.virtual.setObjectName("connect-time-virtual")
        self.virtual.setToolTip(self.tr("Virtual time: heating takes seconds instead of minutes"))
        self._time = QButtonGroup(self)
        self._time.addButton(self.real)
        self._time.addButton(self.virtual)
        self.connect_button = QPushButton(self.tr("Co&nnect"))
        self.connect_button.setObjectName("connect")
        self.connect_button.setProperty("look", "primary")
        self.connect_button.setToolTip(self.tr("Start a controller for this rig; nothing moves yet"))
        self.error = QLabel()
        self.error.setObjectName("connect-error")
        self.error.setProperty("look", "error")
        self.error.setWordWrap(True)
        self.news = QLabel()
        self.news.setObjectName("connect-news")
        self.news.setWordWrap(True)
        self.news.hide()
        self.kind = QLabel()
        self.kind.setObjectName("connect-kind")
        self.kind.setProperty("look", "muted")
        self.kind.setWordWrap(True)
        self.programs = QLabel(
            self.tr(
                "While a program runs, this page shows readings and live sound only; the program is watched"
                " and held on the page Run."
            )
        )
        self.programs.setProperty("look", "muted")
        self.programs.setWordWrap(True)
        self._build()
        self.rig.currentIndexChanged.connect(self._on_choice)
        self.connect_button.clicked.connect(self._on_connect)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.setError("")
        self.setValue([])

    def _build(self) -> None:
        box = QWidget()
        box.setProperty("look", "panel")
        box.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        rig_label = QLabel(self.tr("&Rig"))
        rig_label.setBuddy(self.rig)
        time_row = QHBoxLayout()
        time_row.addWidget(self.real)
        time_row.addWidget(self.virtual)
        time_row.addStretch(1)
        self._time_label = QLabel(self.tr("Time runs"))
        self._grid = QGridLayout()
        self._grid.addWidget(rig_label, 0, 0)
        self._grid.addWidget(self.rig, 0, 1)
        self._grid.addWidget(self.kind, 1, 1)
        self._grid.addWidget(self._time_label, 2, 0)
        self._grid.addLayout(time_row, 2, 1)
        self._grid.addWidget(self.connect_button, 3, 1, Qt.AlignmentFlag.AlignLeft)
        self._grid.addWidget(self.news, 4, 0, 1, 2)
        self._grid.addWidget(self.error, 5, 0, 1, 2)
        self._grid.setColumnStretch(1, 1)
        self._column = QVBoxLayout(box)
        self._column.addWidget(self.title)
        self._column.addWidget(self.teaching)
        self._column.addLayout(self._grid)
        self._column.addWidget(self.programs)
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(box, 4)
        row.addStretch(1)
        outer = QVBoxLayout(self)
        outer.addStretch(1)
        outer.addLayout(row)
        outer.addStretch(2)

    def _restyle(self) -> None:
        t = self._theme
        self.title.setFont(t.font("large", bold=True))
        self._column.setContentsMargins(*(t.px(3),) * 4)
        self._column.setSpacing(t.px(2))
        self._grid.setHorizontalSpacing(t.px(2))
        self._grid.setVerticalSpacing(t.px(1))

    # -- value ------------------------------------------------------------------------------------

    def value(self) -> tuple[Path, str] | None:
        """Rig file and time, None while none is chosen that can be used."""
        choice = self._choice()
        if choice is None or choice.problem:
            return None
        return choice.path, "virtual" if choice.simulated and self.virtual.isChecked() else "real"

    def setValue(self, choices: list[RigChoice], wanted: Path | None = None) -> None:
        """Show rigs; the wanted one is chosen when it is there."""
        self._choices = list(choices)
        self.rig.blockSignals(True)
        self.rig.clear()
        for choice in choices:
            self.rig.addItem(self._label(choice), str(choice.path))
        place = next((i for i, choice in enumerate(choices) if choice.path == wanted), 0)
        self.rig.setCurrentIndex(place if choices else -1)
        self.rig.blockSignals(False)
        self._on_rig()

    def setBusy(self, busy: bool) -> None:
        """A controller is starting."""
        if busy == self._busy:
            return
        self._busy = busy
        if busy:
            self.setNews("")
            self.setError("")
        self.connect_button.setText(self.tr("Starting the controller …") if busy else self.tr("Co&nnect"))
        self._on_rig()

    @property
    def busy(self) -> bool:
        """True while a controller is starting."""
        return self._busy

    def setNews(self, text: str) -> None:
        """How the last session ended; "" when there was none."""
        self.news.setText(text)
        self.news.setVisible(bool(text))

    def setError(self, text: str) -> None:
        """Why there is no session, e.g. the controller could not be started."""
        self.error.setText("▲ " + text if text else "")
        self.error.setVisible(bool(text))

    def _label(self, choice: RigChoice) -> str:
        if choice.problem:
            return self.tr("▲ {0} cannot be read").format(choice.name)
        kind = self.tr("SIMULATED") if choice.simulated else self.tr("REAL RIG")
        return f"{kind}  ·  {choice.name}"

    def _choice(self) -> RigChoice | None:
        index = self.rig.currentIndex()
        return self._choices[index] if 0 <= index < len(self._choices) else None

    def _on_choice(self) -> None:
        self.setError("")
        self._on_rig()

    def _on_rig(self) -> None:
        choice = self._choice()
        self.connect_button.setEnabled(self.value() is not None and not self._busy)
        simulated = choice is not None and choice.simulated
        for widget in (self._time_label, self.real, self.virtual):
            widget.setVisible(simulated)
        if choice is None:
            self.kind.setText(self.tr("There is no rig file. Put one into the folder “rigs”."))
        elif choice.problem:
            self.kind.setText("")
        elif simulated:
            self.kind.setText(self.tr("Nothing real moves: every device is played by this computer."))
        else:
            self.kind.setText(self.tr("A real motor and a real brake: look at the rig before you enable."))
        if choice is not None and choice.problem:
            self.setError(choice.problem)

    def _on_connect(self) -> None:
        chosen = self.value()
        if chosen is not None:
            self.connectAsked.emit(*chosen)
