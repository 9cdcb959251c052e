"""`rigctl bench`: its options and words; the bench itself is tested in tests/system."""

from __future__ import annotations

from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.bench import live_line, register
from rigctl.app.fields import parsed_fields
from rigctl.core.errors import ConfigError, DeviceError
from sim_hardware.bench.commands import CommandServer
from sim_hardware.bench.settings import load_bench

ROOT = Path(__file__).parents[3]
STATUS = {
    "uptime_s": 61.2,
    "cpu_percent": 20.4,
    "outputs": {"speed_rpm": -0.01, "pressure_bar": 9.996, "torque_nm": 123.4, "disc_temperature_degc": 99.7},
    "inputs": {"relay_closed": True, "estop_ok": False, "doors_ok": True},
    "plant": {"latest_ms": 0.42},
    "can": {
        "nodes": {"a": {"node": 16, "state": "OPERATIONAL"}, "b": {"node": 32, "state": "OFF"}},
        "sent": 10,
        "faults": {"1": {}},
    },
    "serial": {"drive": {"plugged": False, "faults": [], "bytes_in": 1, "bytes_out": 2}},
    "sound": {"failure": "", "recording": True},
}


@pytest.fixture
def app() -> typer.Typer:
    app = typer.Typer()
    register(app)

    @app.command()
    def other() -> None:
        """A second command, so that typer keeps the names."""

    return app


def test_live_line_says_what_matters() -> None:
    line = live_line(STATUS)
    for words in (
        "1:01", "0.0 1/min", "10.00 bar", "123 N·m", "100 °C", "relay closed, E-STOP", "1 of 2 operational",
        "drive UNPLUGGED", "faults in force: 1", "sound is recorded", "20 % CPU", "0.4 ms late",
    ):  # fmt: skip
        assert words in line
    assert "-0.0" not in line


def test_fields_are_json_hexadecimal_or_text() -> None:
    found = parsed_fields(
        ["on=false", "for_s=2.5", "node=0x10", "wire=broken", "text=a=b", "count=null"], "rigctl bench fault"
    )
    assert found == {
        "on": False, "for_s": 2.5, "node": 16, "wire": "broken", "text": "a=b", "count": None
    }  # fmt: skip


@pytest.mark.parametrize("field", ["pressed", "=1", "do=clear", "to=can", "a b=1"])
def test_no_pairs_are_refused(field: str) -> None:
    with pytest.raises(ConfigError, match="is not KEY=VALUE"):
        parsed_fields([field], "rigctl bench fault")


def test_fault_reaches_the_bench_of_the_folder(
    app: typer.Typer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[dict[str, object]] = []

    def handle(request: dict[str, object]) -> dict[str, object]:
        seen.append(request)
        if request["do"] == "explode":
            raise ConfigError("there is no such command.")
        return {"id": 7}

    monkeypatch.setenv("RIGCTL_BENCH_DIR", str(tmp_path))
    server = CommandServer(tmp_path, handle)
    server.start()
    try:
        result = CliRunner().invoke(app, ["bench", "fault", "can", "fault", "kind=drop", "node=0x20"])
        assert result.exit_code == 0
        assert '{"id": 7}' in result.output
        refused = CliRunner().invoke(app, ["bench", "fault", "rig", "explode"])
        assert isinstance(refused.exception, DeviceError)
        assert "there is no such command" in str(refused.exception)
    finally:
        server.stop()
    assert seen[0] == {"to": "can", "do": "fault", "kind": "drop", "node": 32}


def test_without_a_bench_it_says_what_to_do(
    app: typer.Typer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RIGCTL_BENCH_DIR", str(tmp_path))
    result = CliRunner().invoke(app, ["bench", "status"])
    assert isinstance(result.exception, DeviceError)
    assert "rigctl bench" in str(result.exception)


def test_a_file_alone_runs_a_bench(app: typer.Typer, tmp_path: Path) -> None:
    """`rigctl bench FILE` is `rigctl bench run FILE`: the file is read."""
    result = CliRunner().invoke(app, ["bench", str(tmp_path / "missing.toml"), "--seed", "1"])
    assert isinstance(result.exception, ConfigError)
    assert "no such file" in str(result.exception)


def test_help_names_the_commands(app: typer.Typer) -> None:
    result = CliRunner().invoke(app, ["bench", "--help"])
    assert result.exit_code == 0
    assert "fault" in result.output
    assert "status" in result.output


def test_shipped_bench_file_is_valid() -> None:
    settings = load_bench(ROOT / "configs/benches/a_class.toml")
    assert settings.plant.exists()
    assert settings.brake.exists()
    assert settings.serial.drive is not None
    assert settings.bus.arguments["port"] == 43113


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("rate_hz = 40000", "rate_hz = 44100", "rate_hz"),
        ("node = 0x20", "node = 0x10", "node 16 is given to"),
        ("[microphone]", "[mikrophone]", "mikrophone"),
        ("full_scale_pa = 20.0", "full_scale_pa = 0", "full_scale_pa"),
    ],
)
def test_wrong_bench_files_name_the_key(tmp_path: Path, old: str, new: str, says: str) -> None:
    text = (ROOT / "configs/benches/a_class.toml").read_text()
    assert old in text
    path = tmp_path / "bench.toml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(ConfigError, match=says):
        load_bench(path)
