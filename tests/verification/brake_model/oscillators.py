"""The smallest brake files: one mass on a belt, free along the belt and across it."""

from typing import Any

from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.spec import BrakeSpec


def belt_data(
    *,
    mass: float = 0.5,
    stiffness_x: float = 0.5e6,
    damping_x: float = 0.0,
    contact: float = 1e8,
    freedoms: tuple[str, ...] = ("x",),
    extra: dict[str, tuple[float, str]] | None = None,
    contact_keys: dict[str, Any] | None = None,
    spring_keys: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """A mass rubbing on a belt at rest in the frame, held by a spring along the belt, as data of a brake
    file."""
    values = {"m": (mass, "kg"), "c": (stiffness_x, "N/m"), "c_n": (contact, "N/m"), **(extra or {})}
    if damping_x:
        values["d"] = (damping_x, "N s/m")
    parameters = {k: {"value": v, "unit": u, "origin": "test"} for k, (v, u) in values.items()}
    spring = {
        "kind": "spring",
        "name": "spring",
        "between": ["mass.spring", "belt.spring"],
        "stiffness_x": "c",
    }
    if damping_x:
        spring["damping_x"] = "d"
    rub = {
        "kind": "contact", "name": "rub", "between": ["mass.rub", "belt.rub"], "side": 1, "load_share": 1.0,
        "stiffness": "c_n",
    }  # fmt: skip
    return {
        "name": "belt",
        "description": "a mass on a belt",
        "operating": {
            "mu": {"value": 0.4, "unit": "1", "origin": "test"},
            "slope": {"value": 0.0, "unit": "s/m", "origin": "test"},
            "piston_area": {"value": 1e-3, "unit": "m2", "origin": "test"},
            "effective_radius": {"value": 0.1, "unit": "m", "origin": "test"},
        },
        "parameters": parameters,
        "bodies": [{"name": "mass", "freedoms": list(freedoms), "mass": "m"}, {"name": "belt"}],
        "points": [
            {"body": b, "name": n, "x": "0", "y": "0"} for b in ("mass", "belt") for n in ("rub", "spring")
        ],
        "couplings": [rub | (contact_keys or {}), spring | (spring_keys or {})],
    }


def belt(**keys: Any) -> Brake:
    """The same, assembled."""
    return Brake(BrakeSpec.model_validate(belt_data(**keys)))
