"""The brake in Exudyn, as a peer of the benchmarks: the same matrices and friction, its own integrators.

One ObjectGenericODE2 with M, K(mu), D(mu) of the brake. Friction beyond the linear part, (mu(v) - mu)
(N0 + N~) with the saturating law of `friction`, is one more ObjectGenericODE2 per pad, on nodes of pad and
disc, with a force user function: by default a symbolic one, which Exudyn evaluates in C++ without calling
Python. While the pads slide forwards the law is smooth and needs no regularisation; sticking and lift-off are
not in it, and do not happen in the motion that is measured. The Jacobian is that of the matrices and kept
(modified Newton).
NOT its job: measuring (`bench_batch`).
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.time_domain.modal import FrictionGroup, friction_groups

sys.exudynFast = True  # type: ignore[attr-defined]  # its build without range checks
try:
    import exudyn as exu  # pyright: ignore[reportMissingImports]
    from exudyn import itemInterface as exu_items  # noqa: N813  # pyright: ignore[reportMissingImports]
except ImportError:  # an optional peer
    exu: Any = None
    exu_items: Any = None

HOW_TO_INSTALL = """Exudyn is not installed here. In an environment of its own, outside the repository:
  python -m venv /tmp/exu && /tmp/exu/bin/pip install exudyn numpy scipy numba pydantic
  NUMBA_CACHE_DIR=/tmp/exu/cache PYTHONPATH=. /tmp/exu/bin/python tests/benchmarks/bench_batch.py"""


class ExudynBrake:
    """The brake at a constant working point; `seen`: degrees of freedom whose velocities are recorded.

    `friction`: "symbolic", "python" or "none": the linear part alone, what no friction can be faster than.
    """

    def __init__(
        self,
        brake: Brake,
        *,
        pad_force_n: float,
        mu: float,
        k_s_m: float,
        saturation_m_s: float,
        friction: str = "symbolic",
    ) -> None:
        symbolic = friction == "symbolic"
        self._container = exu.SystemContainer()
        self._system = self._container.AddSystem()
        self._functions: list[Any] = []
        bodies = list(dict.fromkeys(name.split(".")[0] for name in brake.freedoms))
        places = {
            body: [i for i, name in enumerate(brake.freedoms) if name.split(".")[0] == body]
            for body in bodies
        }
        self._places = places
        self._nodes = {body: self._node(len(places[body])) for body in bodies}
        self._system.AddObject(
            exu_items.ObjectGenericODE2(
                nodeNumbers=list(self._nodes.values()),
                massMatrix=brake.mass_matrix,
                stiffnessMatrix=brake.stiffness_matrix(mu),
                dampingMatrix=brake.damping_matrix(mu, 0.0, 0.0),
            )
        )
        rubbing: list[str] = []
        for group in friction_groups(brake):
            own = [body for body in bodies if any(_touches(group, i) for i in places[body])]
            rubbing += [body for body in own if body not in rubbing]
            columns = [i for body in own for i in places[body]]
            if friction == "none":
                continue
            force = _friction(group, columns, pad_force_n, k_s_m, 1.0 / saturation_m_s, symbolic)
            item = self._system.AddObject(
                exu_items.ObjectGenericODE2(
                    nodeNumbers=[self._nodes[body] for body in own],
                    forceUserFunction=0 if symbolic else force,
                )
            )
            if symbolic:
                self._functions.append(_recorded(self._system, force, item, len(columns)))
                self._system.SetObjectParameter(item, "forceUserFunction", self._functions[-1])
        self.seen = [i for body in rubbing for i in places[body]]
        self._sensors = [
            self._system.AddSensor(
                exu_items.SensorNode(
                    nodeNumber=self._nodes[body],
                    storeInternal=True,
                    writeToFile=False,
                    outputVariableType=exu.OutputVariableType.Coordinates_t,
                )
            )
            for body in rubbing
        ]
        self._system.Assemble()

    def _node(self, size: int) -> Any:
        zero = [0.0] * size
        return self._system.AddNode(
            exu_items.NodeGenericODE2(
                numberOfODE2Coordinates=size,
                referenceCoordinates=zero,
                initialCoordinates=zero,
                initialCoordinates_t=zero,
            )
        )

    def simulate(
        self,
        state: Array,
        seconds: float,
        step_hz: float,
        *,
        output_hz: float = 40_000.0,
        method: str = "alpha",
    ) -> tuple[Array, tuple[float, float]]:
        """Integrate from a state (2 n,): "alpha", generalised alpha without numerical damping, or "rk4".

        Returns
        -------
        velocities : (samples, len(seen)) at 0, 1/output_hz, ...
        elapsed : s of wall clock and of processor
        """
        n = len(state) // 2
        initial = exu.ConfigurationType.Initial
        self._system.systemData.SetODE2Coordinates(state[:n], configuration=initial)
        self._system.systemData.SetODE2Coordinates_t(state[n:], configuration=initial)
        settings = exu.SimulationSettings()
        integration = settings.timeIntegration
        integration.numberOfSteps, integration.endTime = round(seconds * step_hz), seconds
        integration.verboseMode = 0
        integration.generalizedAlpha.spectralRadius = 1.0
        integration.newton.useModifiedNewton = True
        integration.newton.modifiedNewtonJacUpdatePerStep = False
        integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-6, 1e-10
        settings.linearSolverType = exu.LinearSolverType.EXUdense
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = 1.0 / output_hz
        solvers = {"alpha": exu.DynamicSolverType.GeneralizedAlpha, "rk4": exu.DynamicSolverType.RK44}
        begin = time.perf_counter(), time.process_time()
        self._system.SolveDynamic(settings, solverType=solvers[method])
        elapsed = time.perf_counter() - begin[0], time.process_time() - begin[1]
        recorded = [np.asarray(self._system.GetSensorStoredData(sensor))[:, 1:] for sensor in self._sensors]
        return np.hstack(recorded), elapsed


def _touches(group: FrictionGroup, freedom: int) -> bool:
    return bool(
        group.slip_row[freedom] != 0.0 or any(contact.row_y[freedom] != 0.0 for contact in group.contacts)
    )


def _friction(
    group: FrictionGroup, columns: list[int], pad_force_n: float, k_s_m: float, inverse: float, symbolic: bool
) -> Any:
    """Force user function of a pad, on the right side of the equations."""
    slip_row = group.slip_row[columns].tolist()
    stiffness = sum(c.side * c.stiffness_n_m[1] * c.row_y for c in group.contacts)[columns].tolist()  # type: ignore[index]
    damping = sum(c.side * c.damping_ns_m[1] * c.row_y for c in group.contacts)[columns].tolist()  # type: ignore[index]
    n0 = float(group.load_share * pad_force_n)
    root = exu.symbolic.sqrt if symbolic else np.sqrt

    def dot(row: list[float], vector: Any) -> Any:
        total: Any = None
        for i, factor in enumerate(row):
            if factor != 0.0:
                total = factor * vector[i] if total is None else total + factor * vector[i]
        return total

    def force(mbs: Any, t: float, itemNumber: int, q: Any, q_t: Any) -> Any:
        slip = dot(slip_row, q_t)
        x = slip * inverse
        g = k_s_m * slip / root(1.0 + x * x) * (n0 + dot(stiffness, q) + dot(damping, q_t))
        return [factor * g for factor in slip_row]

    return force


def _recorded(system: Any, force: Any, item: Any, n: int) -> Any:
    """The force as a symbolic user function.

    Exudyn's own helper records vectors of length 0 only; and vectors of more than 7 elements crash (1.13.6).
    """
    recording = exu.symbolic.GetRecording()
    exu.symbolic.SetRecording(True)
    arguments = [
        system,
        exu.symbolic.Real("t", 0.0),
        exu.symbolic.Real("itemNumber", 0),
        exu.symbolic.Vector("q", [0.0] * n),
        exu.symbolic.Vector("q_t", [0.0] * n),
    ]
    result = exu.symbolic.Vector(force(*arguments))
    exu.symbolic.SetRecording(recording)
    described = {
        "functionName": "friction",
        "argList": arguments,
        "argTypeList": ["MainSystem", "Real", "Index", "StdVector", "StdVector"],
        "returnValue": result,
        "returnType": "StdVector",
    }
    function = exu.symbolic.UserFunction()
    function.SetUserFunctionFromDict(system, described, "forceUserFunction", item, "None")
    return function
