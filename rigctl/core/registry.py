"""Lazy registry: a kind of device ("simulated") -> "module:Class".

Job: name a concrete class without importing it, so that a missing vendor library breaks only the device
that needs it. Third parties add kinds by entry points of the group `rigctl.devices`, named "role.kind".
Not its job: building a rig (`rigctl.hal.rig`).
"""

from __future__ import annotations

import importlib
from typing import Any

from rigctl.core.errors import ConfigError, DeviceError

ENTRY_POINT_GROUP = "rigctl.devices"


class Registry:
    """Table of (role, kind) -> "module:Class"."""

    def __init__(self) -> None:
        self._table: dict[tuple[str, str], str] = {}

    def register(self, role: str, kind: str, target: str) -> None:
        """Add a kind for a role. A later registration of the same pair is refused."""
        if (role, kind) in self._table:
            raise ValueError(f"{role} of kind {kind!r} is registered already: {self._table[role, kind]}")
        self._table[role, kind] = target

    def kinds(self, role: str) -> list[str]:
        """All kinds known for a role, from the table and from installed entry points."""
        installed = [
            point.name.split(".", 1)[1] for point in self._entry_points() if point.name.startswith(f"{role}.")
        ]
        return sorted({kind for r, kind in self._table if r == role} | set(installed))

    def target(self, role: str, kind: str, *, place: str = "") -> str:
        """The "module:Class" of a kind, not imported.

        Raises
        ------
        ConfigError
            No such kind; names the nearest one.
        """
        if (role, kind) in self._table:
            return self._table[role, kind]
        values = {point.value for point in self._entry_points() if point.name == f"{role}.{kind}"}
        if len(values) > 1:
            raise ConfigError(
                f"{role} of kind {kind!r} is registered by more than one package: "
                f"{', '.join(self._owners(role, kind))}.",
                place=place,
                value=kind,
                remedy="Uninstall all but one.",
            )
        if values:
            return values.pop()
        import difflib

        known = self.kinds(role)
        near = difflib.get_close_matches(kind, known, n=1)
        hint = f"Did you mean {near[0]!r}?" if near else f"Known kinds: {', '.join(known) or 'none'}."
        raise ConfigError(f"{role} has no kind {kind!r}.", place=place, value=kind, remedy=hint)

    def origin(self, role: str, kind: str) -> str:
        """Where a kind comes from: "rigctl", or name and version of the installed package.

        Raises
        ------
        ConfigError
            No such kind.
        """
        self.target(role, kind)
        if (role, kind) in self._table:
            return "rigctl"
        owners = self._owners(role, kind)
        return ", ".join(owners) or "an installed package"

    def load(self, role: str, kind: str, *, place: str = "") -> Any:
        """Import and return the class of a kind.

        Raises
        ------
        ConfigError
            No such kind.
        DeviceError
            The module or a library it needs cannot be imported.
        """
        return load_target(self.target(role, kind, place=place), place=place or f"{role} {kind!r}")

    def _owners(self, role: str, kind: str) -> list[str]:
        """Packages whose entry points register a kind."""
        return sorted(
            f"{point.dist.name} {point.dist.version}"
            for point in self._entry_points()
            if point.name == f"{role}.{kind}" and point.dist is not None
        )

    @staticmethod
    def _entry_points() -> list[Any]:
        from importlib.metadata import entry_points

        return list(entry_points(group=ENTRY_POINT_GROUP))


def load_target(target: str, *, place: str) -> Any:
    """Import "module:Class" and return the class.

    Raises
    ------
    DeviceError
        The module, a library it needs, or the class is missing, or the module fails when it is imported.
    """
    module_name, _, attribute = target.partition(":")
    if not module_name or not attribute:
        raise DeviceError(
            f"{target!r} does not name a class.",
            place=place,
            value=target,
            remedy='The entry point must read "module:Class".',
        )
    try:
        module = importlib.import_module(module_name)
        return getattr(module, attribute)
    except ImportError as error:
        raise DeviceError(
            f"cannot import {target!r}: {error}.",
            place=place,
            value=target,
            remedy=f"Install the library that provides {error.name or module_name!r}.",
        ) from error
    except AttributeError as error:
        raise DeviceError(f"{module_name} has no {attribute!r}.", place=place, value=target) from error
    except Exception as error:  # a driver's own fault when it is imported: it must break nothing else
        raise DeviceError(
            f"importing {target!r} fails: {type(error).__name__}: {error}.",
            place=place,
            value=target,
            remedy="Correct or uninstall that driver.",
        ) from error
