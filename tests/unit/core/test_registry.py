"""The registry names classes without importing them."""

import sys

import pytest

from rigctl.core.errors import ConfigError, DeviceError
from rigctl.core.registry import Registry


def registry() -> Registry:
    table = Registry()
    table.register("drive", "simulated", "json:JSONDecoder")
    table.register("drive", "broken", "no_such_library_xyz:Drive")
    table.register("drive", "nameless", "json:NoSuchClass")
    return table


def test_kind_is_loaded_on_demand():
    import json

    assert registry().load("drive", "simulated") is json.JSONDecoder
    assert "no_such_library_xyz" not in sys.modules
    assert registry().kinds("drive") == ["broken", "nameless", "simulated"]


def test_unknown_kind_names_the_nearest():
    with pytest.raises(ConfigError, match="Did you mean 'simulated'") as caught:
        registry().load("drive", "simulted", place="rig.toml: devices.drive.kind")
    assert "rig.toml: devices.drive.kind" in str(caught.value)
    with pytest.raises(ConfigError, match="Known kinds: none"):
        registry().load("pressure", "x")


def test_missing_library_breaks_only_its_own_device():
    table = registry()
    with pytest.raises(DeviceError, match="Install the library that provides 'no_such_library_xyz'"):
        table.load("drive", "broken")
    with pytest.raises(DeviceError, match="has no 'NoSuchClass'"):
        table.load("drive", "nameless")
    table.load("drive", "simulated")


def test_a_kind_is_registered_once():
    with pytest.raises(ValueError, match="registered already"):
        registry().register("drive", "simulated", "a:B")
