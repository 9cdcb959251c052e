"""Composition root: the one place that names concrete hardware and puts the parts together.

Job: kinds of devices, rigs from files, the engineer's prediction. Not its job: processes
(`rigctl.app.supervisor`), command line (`rigctl.app.cli`).
"""

from __future__ import annotations

from pathlib import Path

from rigctl.config.loading import load_model, translated
from rigctl.config.rig import ROLES, RigConfig
from rigctl.core.errors import ConfigError
from rigctl.core.registry import Registry
from rigctl.hal.devices import RigContext
from rigctl.hal.rig import Rig
from rigctl.model.loading import read_brake_file
from sequences.check import CheckResult, check_program
from sequences.program import Program, load_program
from sim_hardware.brake_model import Prediction, predict

_BUILT_IN = {
    ("drive", "simulated"): "sim_hardware.devices.roles:SimulatedDrive",
    ("pressure", "simulated"): "sim_hardware.devices.roles:SimulatedPressureActuator",
    ("ventilator", "simulated"): "sim_hardware.devices.roles:SimulatedVentilator",
    ("acquisition", "simulated"): "sim_hardware.devices.roles:SimulatedAcquisition",
    ("safety", "simulated"): "sim_hardware.devices.roles:SimulatedSafetyChannel",
    ("drive", "modbus"): "drivers.dc_drive.modbus:ModbusDrive",
    ("drive", "eurotherm590"): "drivers.dc_drive.eurotherm590:Eurotherm590Drive",
    ("pressure", "canopen"): "drivers.pressure.canopen_regulator:CanopenPressureActuator",
    ("ventilator", "canopen"): "drivers.ventilator.canopen_output:CanopenVentilator",
    ("acquisition", "live"): "drivers.daq.acquisition:LiveAcquisition",
    ("safety", "can"): "drivers.safety_io.can_channel:CanSafetyChannel",
}


def registry() -> Registry:
    """All kinds of devices that come with rigctl; nothing is imported."""
    table = Registry()
    for (role, kind), target in _BUILT_IN.items():
        table.register(role, kind, target)
    return table


def read_program(path: Path) -> Program:
    """Load a program file.

    Raises
    ------
    ConfigError
        Names file, key, value and remedy.
    """
    with translated(path, model=Program):
        return load_program(path)
    raise AssertionError  # `translated` has raised


def read_rig(path: Path) -> RigConfig:
    """Load a rig file.

    Raises
    ------
    ConfigError
        Names file, key, value and remedy.
    """
    return load_model(path, RigConfig)


def build_rig(config: RigConfig, context: RigContext) -> Rig:
    """A rig, not opened yet; all settings of its devices are checked.

    Raises
    ------
    ConfigError, DeviceError
        A kind is unknown, a setting is wrong, or a library is missing.
    """
    return Rig(config, context, registry())


def resolved_paths(config: RigConfig, rig_path: Path) -> dict[str, Path]:
    """Every file that a rig file names: "devices.acquisition.brake" -> absolute path.

    Raises
    ------
    ConfigError
        A file does not exist.
    """
    named: dict[str, str] = {"safety.limits": str(config.safety.limits)}
    if config.prediction is not None:
        named["prediction.brake"] = str(config.prediction.brake)
    for role in ROLES:
        for key, value in getattr(config.devices, role).settings.items():
            if isinstance(value, str) and value.endswith(".toml"):
                named[f"devices.{role}.{key}"] = value
    paths = {key: (rig_path.resolve().parent / value).resolve() for key, value in named.items()}
    for key, path in paths.items():
        if not path.is_file():
            raise ConfigError(
                f"no such file: {path}.",
                place=f"{rig_path}: {key} = {named[key]!r}",
                value=named[key],
                remedy="Relative paths start at the folder of the rig file.",
            )
    return paths


def dry_run(program: Program, config: RigConfig) -> CheckResult:
    """Every set-point of a program against what the rig can do."""
    return check_program(program, config.capabilities)


def problems_text(result: CheckResult, place: str) -> str:
    """Errors of a dry run, a line each: ``file: place = value: problem Remedy``."""
    return "\n".join(
        f"{place}: {problem.place} = {problem.value}: {problem.problem} "
        f"({problem.count} brakings, first {problem.first_index}). {_sentence(problem.remedy)}"
        for problem in result.errors
    )


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:].rstrip(".") + "."


def prediction_of(path: Path) -> Prediction:
    """Onset of squeal over pressure as the engineer's model predicts it.

    Raises
    ------
    ConfigError
        The brake file is wrong.
    """
    return predict(read_brake_file(path))
