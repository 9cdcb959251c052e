"""The planar multibody brake model: couplings from TOML, matrices, eigenvalues, squeal in the time domain.

Pure numerics in SI units. NOT its job: the slow physics around the brake (pressure line, temperature,
friction map), sound, clocks, devices; it imports nothing of the project. Names below are imported on first
use, so that importing the package costs nothing and numba is loaded only by whoever integrates in time.

Modules: `spec` (the TOML as frozen models), `lines` and `assembly` (coupling forces, matrices), `laws` and
`friction`, `linear` (what studies ask of a model), `parametric` (our brake as one), `stability` (onset),
`identify` (parameters from published results). Packages: `minimal` (1- and 2-DOF models of section 1),
`eigen` (eigenvalues), `design` (sensitivity to optimum), `foreign` (matrices made elsewhere), `time_domain`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sim_hardware.brake_model.assembly import Brake, load_brake
    from sim_hardware.brake_model.parametric import LinearBrake
    from sim_hardware.brake_model.spec import BrakeSpec
    from sim_hardware.brake_model.stability import Prediction, predict
    from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator, compile_kernels

_HOME = {
    "Brake": "assembly",
    "load_brake": "assembly",
    "LinearBrake": "parametric",
    "BrakeSpec": "spec",
    "SquealIntegrator": "time_domain.integrator",
    "compile_kernels": "time_domain.integrator",
    "Prediction": "stability",
    "predict": "stability",
}

__all__ = [
    "Brake",
    "BrakeSpec",
    "LinearBrake",
    "Prediction",
    "SquealIntegrator",
    "compile_kernels",
    "load_brake",
    "predict",
]


def __getattr__(name: str) -> Any:
    """Import `name` from its module on first use (PEP 562)."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
