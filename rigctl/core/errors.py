"""The tree of errors. Each carries what happened, where, which value, and what to do.

Job: give every failure of the program one drawn place and one printed form. Not its job: exit codes
(`rigctl.app.exit_codes`) and the translation of validation errors (`rigctl.config.loading`).

::

    RigctlError
    ├── ConfigError        a file or an option is wrong           (nothing was started)
    ├── DeviceError        a device is missing, silent or refuses
    │   └── LinkClosed     the other end of a link is gone
    ├── SafetyTrip         the safe state was entered; latched
    ├── RunError           a program could not be carried out
    └── RecordingError     samples or files could not be kept
"""

from __future__ import annotations

from typing import Self


class RigctlError(Exception):
    """Root of all errors that the program raises on purpose.

    Parameters
    ----------
    problem : str
        What is wrong, one sentence without the place.
    place : str
        Where: a file and key, a device, a process.
    value : object
        The offending value, if there is one.
    remedy : str
        What the reader can do about it.
    """

    def __init__(self, problem: str, *, place: str = "", value: object = None, remedy: str = "") -> None:
        self.problem = problem
        self.place = place
        self.value = value
        self.remedy = remedy
        super().__init__(str(self))

    def within(self, place: str) -> Self:
        """The same error told by somebody who knows a wider place: "rig.toml: devices.drive".

        Nothing is said twice: a place that names the device already stays, and the file is named once.
        """
        file, _, inner = place.partition(": ")
        own = self.place
        if own == place or own.startswith((f"{place}.", f"{place}:")):
            return self
        own = own.removeprefix(f"{file}: ").removeprefix(inner).lstrip(": ")
        wider = f"{place}: {own}" if own else place
        named = type(self).__new__(type(self))  # a subclass may be made from other arguments
        named.__dict__.update(self.__dict__)
        RigctlError.__init__(named, self.problem, place=wider, value=self.value, remedy=self.remedy)
        return named

    def __str__(self) -> str:
        text = f"{self.place}: {self.problem}" if self.place else self.problem
        return f"{text} {self.remedy}" if self.remedy else text


class ConfigError(RigctlError):
    """A configuration file, program or command-line value is wrong; nothing has been started."""


class DeviceError(RigctlError):
    """A device cannot be opened, does not answer, or refuses a command."""


class LinkClosed(DeviceError):
    """The process or device at the other end of a link has gone away."""


class SafetyTrip(RigctlError):
    """The watchdog has put the rig into the safe state; it stays there until a person acknowledges."""


class RunError(RigctlError):
    """A program could not be carried out to its end."""


class RecordingError(RigctlError):
    """Samples could not be recorded or a braking file could not be written."""
