"""Every shipped rig file is valid with all that it names, and the bench's rig fits the bench."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from rigctl.app import compose
from rigctl.config.rig import RigConfig
from rigctl.hal.devices import RigContext
from rigctl.safety.limits import load_limits

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
RIGS = sorted((CONFIGS / "rigs").glob("*.toml"))
MATRIX = CONFIGS / "programs" / "quick_check.toml"


def test_there_is_a_rig_for_each_way_of_working():
    assert {"simulated", "bench", "lab-example"} <= {path.stem for path in RIGS}


@pytest.mark.parametrize("path", RIGS, ids=lambda path: path.stem)
def test_rig_file_is_valid_with_all_it_names(path: Path, tmp_path: Path):
    config = compose.read_rig(path)
    compose.resolved_paths(config, path)
    load_limits((path.parent / config.safety.limits).resolve())
    time = "virtual" if config.simulated else "real"
    rig = compose.build_rig(config, RigContext(tmp_path, time, None, str(path), path.parent))
    target, settings = rig.safety.watchdog_link()
    assert ":" in target and settings
    assert list(tmp_path.iterdir()) == []  # nothing is opened before `open`


@pytest.mark.parametrize("path", RIGS, ids=lambda path: path.stem)
def test_a_shipped_program_can_be_run_on_it(path: Path, tmp_path: Path):
    rig = compose.read_rig(path)
    text = MATRIX.read_text()
    if rig.capabilities.channels["microphone"].rate_hz == 48000:  # as docs/how-to/bring-up-a-rig.md says
        text = text.replace("sampling_hz = 40000", "sampling_hz = 48000").replace(
            "decimation = 40", "decimation = 48"
        )
    (tmp_path / "program.toml").write_text(text)
    result = compose.dry_run(compose.read_program(tmp_path / "program.toml"), rig)
    assert [str(problem) for problem in result.errors] == []


def test_real_rigs_have_no_simulated_devices():
    for path in RIGS:
        config = compose.read_rig(path)
        kinds = [getattr(config.devices, role).kind for role in type(config.devices).model_fields]
        assert ("simulated" in kinds) == config.simulated, path


def test_the_benchs_rig_fits_the_bench():
    bench: dict[str, Any] = tomllib.loads((CONFIGS / "benches" / "a_class.toml").read_text())
    rig: RigConfig = compose.read_rig(CONFIGS / "rigs" / "bench.toml")
    bus = rig.buses["main"].settings
    assert {key: bench["bus"][key] for key in bus} == bus
    drive, pressure = rig.devices.drive.settings, rig.devices.pressure.settings
    assert drive["port"] == "bench:drive" and "drive" in bench["serial"]
    assert bench["serial"]["drive"]["line"]["baud"] == drive.get("baud", 115200)
    can, sources = bench["can"], rig.devices.acquisition.settings["sources"]
    assert (pressure["node"], pressure["range_bar"]) == (
        can["regulator"]["node"],
        can["regulator"]["range_bar"],
    )
    ventilator = rig.devices.ventilator.settings
    assert ventilator["node"] == can["analog_output"]["node"]
    assert ventilator["full_m3_h"] == can["analog_output"]["full_m3_h"]
    for source, node in (("amplifier", "amplifier"), ("encoder", "encoder"), ("pyrometer", "current_input")):
        assert sources[source]["node"] == can[node]["node"]
        assert sources[source]["event_ms"] == can[node]["tpdo_ms"]
    assert sources["encoder"]["steps_per_turn"] == can["encoder"]["steps_per_turn"]
    loop = can["current_input"]
    assert (sources["pyrometer"]["at_4ma"], sources["pyrometer"]["at_20ma"]) == (
        loop["at_4ma_degc"], loop["at_20ma_degc"],
    )  # fmt: skip
    microphone = sources["microphone"]
    assert microphone["device"] == f"bench:{bench['microphone']['name']}"
    assert microphone["rate_hz"] == bench["microphone"]["rate_hz"]
    assert microphone["full_scale_pa"] == bench["microphone"]["full_scale_pa"]
