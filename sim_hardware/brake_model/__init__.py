"""The planar multibody brake model: couplings from TOML, matrices, eigenvalues, squeal in the time domain.

Pure numerics in SI units. NOT its job: the slow physics around the brake (pressure line, temperature,
friction map), sound, clocks, devices; it imports nothing of the project. Names below are imported on first
use, so that importing the package costs nothing and numba is loaded only by whoever integrates in time.

Modules: `spec` (the TOML as frozen models), `assembly` (matrices, coupling forces), `friction` (laws),
`stability` (eigenvalues, onset), `modal`/`contact`/`kernels`/`simd`/`integrator` (fast time integration),
`reference` (slow, tight, independent time integration), `identify` (parameters from published results).
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sim_hardware.brake_model.assembly import Brake, load_brake
    from sim_hardware.brake_model.integrator import SquealIntegrator, compile_kernels
    from sim_hardware.brake_model.spec import BrakeSpec
    from sim_hardware.brake_model.stability import Prediction, predict

_HOME = {
    "Brake": "assembly",
    "load_brake": "assembly",
    "BrakeSpec": "spec",
    "SquealIntegrator": "integrator",
    "compile_kernels": "integrator",
    "Prediction": "stability",
    "predict": "stability",
}

__all__ = [
    "Brake",
    "BrakeSpec",
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
