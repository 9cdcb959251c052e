"""Belt oscillator: closed phases with exact events against general integrators with event search.

Run by hand: `python tests/benchmarks/bench_minimal.py`. Prints times, and errors against a tight DOP853 that
restarts at every event. On a busy machine the ratios hold, the times do not.
"""

import math
import time

import numpy as np
from scipy.integrate import solve_ivp

from rigctl.model.minimal import BELT, COULOMB, FALLING
from sim_hardware.brake_model.minimal.belt import BeltOscillator
from sim_hardware.brake_model.minimal.cycles import coulomb_period_s, stick_slip_cycle
from sim_hardware.brake_model.minimal.motion import simulate

DURATION_S = 0.05


def smoothed(belt: BeltOscillator, x0: float, width: float, rtol: float) -> tuple[float, float]:
    """The usual shortcut: sgn(v) as tanh(v / width). Returns seconds and the final position."""

    def rate(_, y):
        v = belt.belt_speed_m_s - y[1]
        friction = belt.normal_force_n * belt.law.sliding(abs(v)) * math.tanh(v / width)
        return [y[1], (friction - belt.stiffness_n_m * y[0]) / belt.mass_kg]

    begin = time.perf_counter()
    result = solve_ivp(rate, (0.0, DURATION_S), [x0, 0.0], method="LSODA", rtol=rtol, atol=rtol * 1e-5)
    return time.perf_counter() - begin, float(result.y[0, -1])


def restarted(belt: BeltOscillator, x0: float, rtol: float) -> tuple[float, float]:
    """Event search by DOP853 and restart at every change: accurate, general."""
    speed, force, stiff, mass = belt.belt_speed_m_s, belt.normal_force_n, belt.stiffness_n_m, belt.mass_kg
    sliding, hold = belt.law.sliding, belt.holding_force_n
    begin = time.perf_counter()
    t, x, v, kind = 0.0, x0, 0.0, 1.0
    while t < DURATION_S:
        if kind == 0.0:
            t, x = t + (hold / stiff - x) / speed, hold / stiff
            if t >= DURATION_S:
                x -= (t - DURATION_S) * speed
                break
            kind, v = 1.0, speed

        def rate(_, y, kind=kind):
            return [y[1], (kind * force * sliding(kind * (speed - y[1])) - stiff * y[0]) / mass]

        def stop(_, y):
            return speed - y[1]

        stop.terminal, stop.direction = True, -kind
        r = solve_ivp(
            rate, (t, DURATION_S), [x, v], method="DOP853", rtol=rtol, atol=[rtol * 1e-6, rtol * 0.1],
            events=stop, max_step=2e-5,
        )  # fmt: skip
        t, x, v = float(r.t[-1]), float(r.y[0, -1]), speed
        if r.t_events[0].size:
            kind = 0.0 if abs(stiff * x) <= hold else -kind
    return time.perf_counter() - begin, x


def main() -> None:
    print(f"{DURATION_S} s of motion from 30 µm outside the cycle; error of the final position")
    for law in (COULOMB, FALLING):
        belt = BELT.changed(law=law)
        x0 = belt.equilibrium_m + 30e-6
        simulate(belt, x0, 0.0, 1e-3)
        begin = time.perf_counter()
        ours = float(simulate(belt, x0, 0.0, DURATION_S).at(np.array([DURATION_S]))[0][0])
        exact_s = time.perf_counter() - begin
        reference_s, reference = restarted(belt, x0, 1e-12)
        print(f"{law.law}: closed phases {exact_s * 1e3:.1f} ms, error {abs(ours - reference) * 1e6:.1e} µm")
        ratio = reference_s / exact_s
        print(f"  DOP853 with events, rtol 1e-12 (reference): {reference_s * 1e3:.0f} ms, {ratio:.0f}x")
        for width in (1e-3, 1e-5):
            seconds, x = smoothed(belt, x0, width, 1e-8)
            words = (
                f"{seconds * 1e3:.0f} ms, {seconds / exact_s:.0f}x, error {abs(x - reference) * 1e6:.1e} µm"
            )
            print(f"  LSODA, tanh over {width:g} m/s: {words}")
    belt = BELT.changed(law=COULOMB)
    begin = time.perf_counter()
    cycle = stick_slip_cycle(belt)
    seconds = time.perf_counter() - begin
    error = abs(cycle.period_s / coulomb_period_s(belt) - 1.0)
    print(f"stick-slip cycle: {seconds * 1e3:.2f} ms, relative error of the period {error:.1e}")


if __name__ == "__main__":
    main()
