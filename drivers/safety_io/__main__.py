"""``python -m drivers.safety_io RIG.toml``: options that give `python -m rigctl.safety` this rig's channel.

Job: print ``--link`` and ``--link-settings`` of a rig file whose safety channel is of kind "can", for running
the watchdog alone at bring-up. Reads the tables of buses and safety channel only. Not its job: running it,
and checking the rest of the rig file.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from drivers.safety_io.can_channel import CanSafetyChannel
from drivers.safety_io.settings import parse_settings
from rigctl.config.loading import read_toml
from rigctl.core.errors import ConfigError, RigctlError
from rigctl.hal.devices import RigContext

EXIT_CONFIG = 2
_NODE_MASK = 0x7F


def link_options(rig_file: Path, *, start_sensors: bool) -> list[str]:
    """The options for the watchdog.

    Parameters
    ----------
    rig_file : Path
    start_sensors : bool
        Have the watchdog also start the sensors' nodes (NMT), since no controller does it.

    Raises
    ------
    ConfigError
        The rig file is wrong, or its safety channel is of another kind.
    """
    tables = read_toml(rig_file)
    entry = dict(_table(_table(tables, "devices", rig_file), "safety", rig_file))
    kind = entry.pop("kind", None)
    if kind != "can":
        raise ConfigError(
            f"is of kind {kind!r}.", place=f"{rig_file}: devices.safety", value=kind,
            remedy='Only kind "can" has a channel that the watchdog can use without a controller.',
        )  # fmt: skip
    buses = _table(tables, "buses", rig_file)
    context = RigContext(Path(), "real", None, str(rig_file), rig_file.parent, buses=buses)
    target, link = CanSafetyChannel(entry, context).watchdog_link()
    settings: dict[str, Any] = dict(link)
    if start_sensors:
        io = parse_settings(settings["channel"], str(rig_file))
        sensors = {signal.cob_id & _NODE_MASK for signal in io.signals().values()}
        settings["channel"] = {**settings["channel"], "start_nodes": sorted(sensors | set(io.start_nodes))}
    return ["--link", target, "--link-settings", json.dumps(settings, separators=(",", ":"))]


def _table(tables: Mapping[str, Any], key: str, rig_file: Path) -> Mapping[str, Any]:
    table = tables.get(key)
    if not isinstance(table, Mapping):
        raise ConfigError(f"has no table [{key}].", place=str(rig_file), remedy="Name a complete rig file.")
    return cast("Mapping[str, Any]", table)


def main(arguments: list[str] | None = None) -> int:
    """Print the options, each on one line; the exit code is 2 when the rig file is wrong."""
    parser = argparse.ArgumentParser(prog="drivers.safety_io", description="Options for the watchdog alone.")
    parser.add_argument("rig", type=Path, help="rig file (TOML)")
    parser.add_argument("--start-sensors", action="store_true", help="start the sensors' nodes too")
    options = parser.parse_args(arguments)
    try:
        print("\n".join(link_options(options.rig, start_sensors=options.start_sensors)))
    except RigctlError as error:
        print(f"safety_io: {error}", file=sys.stderr)
        return EXIT_CONFIG
    return 0


if __name__ == "__main__":
    sys.exit(main())
