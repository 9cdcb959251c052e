"""A rig file whose devices are those of `devices_drivers`, one kind per class."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from rigctl.app import compose
from rigctl.core.registry import Registry

ROOT = Path(__file__).resolve().parents[3]
CLASSES = ("GoodDrive", "PlainSafety", "Silent", "Crashing", "Flaky", "Hanging")


@pytest.fixture
def write_rig(tmp_path: Path) -> Callable[..., Path]:
    """write_rig(drive="silent", …): the shipped simulated rig with other kinds of devices."""
    text = (ROOT / "configs" / "rigs" / "simulated.toml").read_text().replace('"../', f'"{ROOT}/configs/')

    def write(settings: str = "", **kinds: str) -> Path:
        changed = text
        for role, kind in kinds.items():
            pattern = rf'\[devices\.{role}\]\nkind = "simulated"(\n\w+ = .*)*'
            extra = f"\n{settings}" if settings else ""
            changed, hits = re.subn(pattern, f'[devices.{role}]\nkind = "{kind}"{extra}', changed)
            assert hits == 1
        path = tmp_path / "rig.toml"
        path.write_text(changed)
        return path

    return write


@pytest.fixture
def kinds(monkeypatch: pytest.MonkeyPatch) -> None:
    """The classes of `devices_drivers` as kinds for all roles: "gooddrive", "silent", …"""

    def table() -> Registry:
        registry = registry_of_rigctl()
        for role in ("drive", "pressure", "ventilator", "safety"):
            for name in CLASSES:
                registry.register(role, name.lower(), f"devices_drivers:{name}")
        registry.register("drive", "uninstalled", "no_such_vendor_library:Drive")
        return registry

    registry_of_rigctl = compose.registry
    monkeypatch.setattr("rigctl.app.compose.registry", table)
