"""The fault laboratory of a running simulated rig, seen by a person or a test: ask for stimuli.

Job: the socket's name, one request and its answer, the answer in words. Standard library and words only. Not
its job: what a stimulus does (`stimuli`, in the rig server).

A request says what to do: ``{"do": "estop", "pressed": true}``, ``{"do": "doors", "open": true}``,
``{"do": "sensor", "channel": "pressure", "mode": "frozen"}`` (modes ok, invalid, frozen, offset with "value";
"seen_by": both, controller, watchdog), ``{"do": "disc", "degc": 120}``,
``{"do": "vent_valve", "stuck": true}``,
``{"do": "weight", "torque_nm": 250}``, ``{"do": "calibrator", "level_db": 94}``,
``{"do": "microphone", "drift_db": 0.4}``, ``{"do": "clear"}``, ``{"do": "status"}``. With ``"at_s"`` it waits
for that rig time, so that it falls on the same block each time. Every answer tells what is in force.
"""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rigctl.core.errors import DeviceError
from rigctl.core.wire import Link, connect

SOCKET_NAME = "laboratory.sock"
ANSWER_TIMEOUT_S = 5.0


class Laboratory:
    """One connection to the laboratory of the rig whose run folder is given; usable as a context manager.

    Parameters
    ----------
    run_dir : Path
        Private folder of the run (in /dev/shm).
    timeout_s : float
        How long to wait for the rig to appear.
    """

    def __init__(self, run_dir: Path, timeout_s: float = 0.5) -> None:
        self._run_dir = run_dir
        self._timeout_s = timeout_s
        self._link: Link | None = None

    def ask(self, do: str, **fields: Any) -> dict[str, Any]:
        """Give one stimulus; returns what is in force now.

        Raises
        ------
        DeviceError
            There is no laboratory, it does not answer, or it refuses; with reason and remedy.
        """
        link = self._connected()
        try:
            link.send({"do": do, **fields})
            answer = link.recv(ANSWER_TIMEOUT_S)
        except DeviceError:
            self.close()
            raise
        if answer is None:
            self.close()  # a late answer must not be taken for the next one's
            raise DeviceError(
                f"no answer within {ANSWER_TIMEOUT_S:g} s.",
                place="fault laboratory",
                remedy="The rig waits for somebody: see the state of the run.",
            )
        if answer.pop("m", None) != "done":
            raise DeviceError(str(answer.get("reason", "refuses.")), place="fault laboratory",
                              remedy=str(answer.get("remedy", "")))  # fmt: skip
        return answer

    def _connected(self) -> Link:
        if self._link is None:
            try:
                self._link = connect(self._run_dir / SOCKET_NAME, self._timeout_s, "fault laboratory")
            except DeviceError as error:
                raise DeviceError(
                    "no simulated rig is running here.",
                    place=str(self._run_dir),
                    remedy="Start one: rigctl run PROGRAM, or on the window's Manual page.",
                ) from error
        return self._link

    def close(self) -> None:
        """Leave; stimuli stay in force."""
        if self._link is not None:
            self._link.close()
            self._link = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def in_force(answer: dict[str, Any]) -> list[str]:
    """What an answer says is in force, a line each."""
    lines = []
    if answer["estop_pressed"]:
        lines.append("The emergency stop is pressed.")
    if answer["doors_open"]:
        lines.append("A door is open.")
    for channel, fault in answer["sensors"].items():
        value = f" by {fault['value']:g}" if fault["mode"] == "offset" else ""
        who = "" if fault["seen_by"] == "both" else f" (seen by the {fault['seen_by']} only)"
        lines.append(f"Sensor {channel}: {fault['mode']}{value}{who}.")
    if answer["vent_valve_stuck"]:
        lines.append("The vent valve is stuck.")
    if answer["weight_nm"]:
        lines.append(f"A lever puts {answer['weight_nm']:g} N·m on the torque sensor.")
    if answer["calibrator_db"]:
        lines.append(f"A calibrator gives {answer['calibrator_db']:g} dB at the microphone.")
    if answer["drift_db"]:
        lines.append(f"The microphone has drifted by {answer['drift_db']:+g} dB.")
    for request in answer["waiting"]:
        fields = ((key, value) for key, value in request.items() if key not in ("do", "at_s"))
        words = ", ".join(f"{key}={value}" for key, value in fields)
        lines.append(f"At {request['at_s']:g} s of rig time: {request['do']} {words}".rstrip())
    return lines
