"""The simulated rig around the brake: `step` advances it, `render_sound` delivers the microphone.

Job: the seam between rig units and SI, sensor errors, random streams, bookkeeping of steps.
NOT its job: the equations (`slow_physics`, `sound`, `sim_hardware.brake_model`), time pacing and messages
(`sim_hardware.devices`).
"""

from __future__ import annotations

import math
from typing import cast

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import DISC_TEMPERATURE, MICROPHONE, PRESSURE, SPEED, TORQUE, ChannelSpec
from rigctl.core.units import KELVIN_AT_0_DEGC, M3_S_PER_M3_H, PA_PER_BAR, RAD_S_PER_RPM
from sim_hardware.brake_model import Brake
from sim_hardware.plant import slow_physics
from sim_hardware.plant.layout import TRACK, Record, constants, initial_state
from sim_hardware.plant.settings import FULL_RATE_HZ, TICK_S, PlantSettings, SensorError
from sim_hardware.plant.sound import SOUND_HZ, Sound
from sim_hardware.plant.words import Commands, PlantStep, PlantTruth

TICK_NS = round(TICK_S * 1e9)
#: while nothing is recorded: slow channels at 4000 / 200 = 20 Hz, mechanics in steps of 10 ticks = 2.5 ms
MONITOR_STRIDE = 200
MONITOR_INNER = 10
_SLOW = (TORQUE, PRESSURE, SPEED, DISC_TEMPERATURE)
_SCATTER_LIMIT = 3.0

#: course of the slow state (rows, len(TRACK)), length in ticks, whether the drive is on
SoundJob = tuple[NDArray[np.float64], int, bool]


class Plant:
    """A simulated rig with its brake. The same seed and calls give the same samples bit for bit.

    Parameters
    ----------
    settings : physical values
    brake : the brake inside the rig
    seed : of all noise and scatter

    Attributes
    ----------
    channels : everything the rig measures, microphone first
    sound_channel : the microphone
    ventilator_max_m3_h : full flow

    Raises
    ------
    ConfigError
        settings that do not fit the brake
    """

    def __init__(self, settings: PlantSettings, brake: Brake, *, seed: int) -> None:
        self.settings = settings
        self.brake = brake
        self.channels = _channels(settings)
        self.sound_channel = self.channels[0]
        self.ventilator_max_m3_h = settings.thermal.ventilator_max_m3_h
        scatter, sensors, safety, _ = _random_streams(seed)
        self._scatter_random, self._sensor_random, self._safety_random = scatter, sensors, safety
        self._sound = sound_of(settings, brake, seed)
        self._constants: dict[int, Record] = {}
        self._state = initial_state(settings)
        self._queue_tick, self._queue_value = slow_physics.empty_queue()
        self._requested_pa = 0.0
        self._relay_closed = False
        self._lever_nm = 0.0
        self._pending: SoundJob | None = None
        own, of = settings.safety_sensors, settings.sensors
        pyrometer = SensorError(gain=1.0, offset=0.0, noise=settings.pyrometer.noise_k)
        self._sensor = _errors(_TO_RIG, of.torque, of.pressure, of.speed, pyrometer)
        self._safety_sensor = _errors(_SAFETY_TO_RIG, own.pressure, own.speed, own.torque, own.temperature)
        self._draw_scatter()

    def compile(self, *, sound: bool = True) -> None:
        """Compile (or load) all kernels, or those without the sound's, without touching this rig."""
        scratch = Plant(self.settings, self.brake, seed=0)
        run = Commands(
            speed_set_rpm=40.0,
            speed_ramp_rpm_per_s=400.0,
            drive_enabled=True,
            pressure_set_bar=10.0,
            relay_closed=True,
        )
        scratch.step(500_000_000, run, full_rate=False)
        scratch.step(50_000_000, run, full_rate=True)
        if sound:
            scratch.render_sound()
            scratch._sound.compile()

    def step(self, dt_ns: int, commands: Commands, *, full_rate: bool) -> PlantStep:
        """Advance the rig.

        Parameters
        ----------
        dt_ns : length of the step, a whole number of 0.25 ms
        commands : hold for the whole step
        full_rate : True: 4 kHz samples, and `render_sound` may follow; False: 20 Hz samples, no sound

        Raises
        ------
        ValueError
            a length that is not a positive whole number of ticks, a set-point that is not finite
        """
        ticks, rest = divmod(dt_ns, TICK_NS)
        if rest or ticks <= 0:
            raise ValueError(f"dt_ns is {dt_ns}; give a positive multiple of {TICK_NS} ns")
        points = (
            commands.speed_set_rpm,
            commands.speed_ramp_rpm_per_s,
            commands.pressure_set_bar,
            commands.ventilator_m3_h,
        )
        if not all(map(math.isfinite, points)):
            raise ValueError(f"set-points (speed, ramp, pressure, air flow) {points}: give finite numbers")
        stride = 1 if full_rate else math.gcd(ticks, MONITOR_STRIDE)
        inner = 1 if full_rate else math.gcd(stride, MONITOR_INNER)
        if self._pending is not None:  # the sound of the step before was not wanted
            self._sound.forget()
        rows = -(-ticks // slow_physics.SAFETY_TICKS)
        out = np.empty((4, ticks // stride))
        safety = np.empty((4, rows))
        track = np.empty((rows + 1 if full_rate else 0, len(TRACK)))
        drive_on = commands.drive_enabled and commands.relay_closed
        self._request_pressure(commands.pressure_set_bar * PA_PER_BAR)
        flow = min(max(commands.ventilator_m3_h, 0.0), self.ventilator_max_m3_h) * M3_S_PER_M3_H
        slow_physics.advance(
            self._constants_for(inner), self._state, self._queue_tick, self._queue_value,
            ticks, inner, stride,
            commands.speed_set_rpm * RAD_S_PER_RPM, max(commands.speed_ramp_rpm_per_s, 0.0) * RAD_S_PER_RPM,
            drive_on, commands.quick_stop, commands.vent or not commands.relay_closed, flow,
            out, safety, track,
        )  # fmt: skip
        if self._lever_nm:
            out[0] += self._lever_nm
            safety[2] += self._lever_nm
        self._relay_closed = commands.relay_closed
        self._pending = (track, ticks, drive_on) if full_rate else None
        if not full_rate:
            self._sound.forget()
        if self._state["scatter_used"][0]:
            self._draw_scatter()
        return PlantStep(self._measured(out), self._safety_readings(safety), stride)

    def render_sound(self) -> NDArray[np.int16]:
        """Sound of the last step, int16 counts of `sound_channel`, 40 kHz.

        Raises
        ------
        RuntimeError
            the last step was not at full rate, or its sound was delivered already
        """
        if self._pending is None:
            raise RuntimeError("no sound: call render_sound once after a step with full_rate=True")
        track, ticks, drive_on = self._pending
        self._pending = None
        return self._sound.render(track, ticks, drive_on)

    def take_sound_job(self) -> SoundJob | None:
        """What `sound_of(...).render` needs for the sound of the last full-rate step, once; else None.

        For a microphone that is rendered elsewhere. It must `forget` the motion when a step in between was
        not rendered.
        """
        job, self._pending = self._pending, None
        return job

    @property
    def truth(self) -> PlantTruth:
        """True values at the end of the last step: for tests, and for who must know whether it is at rest."""
        s = self._state[0]
        bedding = 1.0 - math.exp(-float(s["bedding_energy"]) / self.settings.friction.bedding_energy_j)
        return PlantTruth(
            time_s=int(s["tick"]) * TICK_S,
            speed_rpm=float(s["omega"]) / RAD_S_PER_RPM,
            motor_torque_nm=float(s["motor_torque"]),
            brake_torque_nm=float(s["brake_torque"]),
            pressure_bar=float(s["pressure"]) / PA_PER_BAR,
            surface_degc=float(s["surface"]) - KELVIN_AT_0_DEGC,
            bulk_degc=float(s["bulk"]) - KELVIN_AT_0_DEGC,
            pad_degc=float(s["pad"]) - KELVIN_AT_0_DEGC,
            mu=float(s["mu"]),
            slope_s_m=float(s["slope"]),
            bedding=bedding,
            friction_energy_j=float(s["friction_energy"]),
            loss_energy_j=float(s["loss_energy"]),
            ventilator_m3_h=float(s["flow"]) / M3_S_PER_M3_H,
            relay_closed=self._relay_closed,
        )

    def set_condition(self, *, disc_degc: float | None = None, bedding: float | None = None) -> None:
        """Start from another condition of the brake; for studies and tests.

        Parameters
        ----------
        disc_degc : temperature of both disc nodes and of the sensors' lags; pads half-way to ambient
        bedding : 0 for new pads, near 1 for bedded ones

        Raises
        ------
        ValueError
            bedding outside 0 to 1, temperature not finite
        """
        if disc_degc is not None:
            if not math.isfinite(disc_degc):
                raise ValueError(f"disc_degc is {disc_degc}; give a finite temperature")
            disc_k = disc_degc + KELVIN_AT_0_DEGC
            for name in ("surface", "bulk", "safety_temperature"):
                self._state[name] = disc_k
            for name in ("pyro", "pyro_target"):
                self._state[name] = slow_physics.pyrometer_reading(self._constants_for(1)[0], disc_k)
            self._state["pad"] = 0.5 * (disc_k + self.settings.thermal.ambient_degc + KELVIN_AT_0_DEGC)
        if bedding is not None:
            if not 0.0 <= bedding < 1.0:
                raise ValueError(f"bedding is {bedding}; give 0 (new) to below 1 (bedded)")
            self._state["bedding_energy"] = -math.log1p(-bedding) * self.settings.friction.bedding_energy_j

    def set_lever(self, torque_nm: float) -> None:
        """A lever with weights on the frame that carries the brake: both torque sensors feel it."""
        self._lever_nm = torque_nm

    # -- inside ------------------------------------------------------------------------------------------

    def _constants_for(self, inner: int) -> Record:
        if inner not in self._constants:
            self._constants[inner] = constants(
                self.settings, self.brake.piston_area_m2, self.brake.effective_radius_m, inner
            )
        return self._constants[inner]

    def _request_pressure(self, pressure_pa: float) -> None:
        """A new set-point reaches the regulator after its dead time."""
        if pressure_pa == self._requested_pa:
            return
        self._requested_pa = pressure_pa
        state = self._state[0]
        place = min(int(state["queued"]), slow_physics.QUEUE - 1)
        self._queue_tick[place] = int(state["tick"]) + round(self.settings.pressure.dead_time_s / TICK_S)
        self._queue_value[place] = min(
            max(pressure_pa, 0.0), self.settings.pressure.max_pressure_bar * PA_PER_BAR
        )
        self._state["queued"] = place + 1

    def _draw_scatter(self) -> None:
        """Stop-to-stop scatter of the next braking; it takes effect when its pressure comes on."""
        friction = self.settings.friction
        draws = np.clip(self._scatter_random.standard_normal(2), -_SCATTER_LIMIT, _SCATTER_LIMIT)
        self._state["next_mu"] = 1.0 + friction.scatter_mu * draws[0]
        self._state["next_slope"] = 1.0 + friction.scatter_slope * draws[1]
        self._state["scatter_used"] = 0

    def _measured(self, true: NDArray[np.float64]) -> dict[str, NDArray[np.float32]]:
        """Readings of the controller's sensors from true values in SI, (4, n): order of `_SLOW`."""
        noise = self._sensor_random.standard_normal((true.shape[1], 4), dtype=np.float32)
        readings = np.empty(true.shape, np.float32)
        slow_physics.read_sensors(true, noise, self._sensor, 0.0, readings)
        return dict(zip(_SLOW, readings, strict=True))

    def _safety_readings(self, true: NDArray[np.float64]) -> dict[str, list[float]]:
        """Readings of the watchdog's own sensors from true values in SI, (4, n): p, n, M, T."""
        noise = self._safety_random.standard_normal((true.shape[1], 4), dtype=np.float32)
        readings = np.empty(true.shape)
        slow_physics.read_sensors(true, noise, self._safety_sensor, 1000.0, readings)
        rows = cast("list[list[float]]", readings.tolist())
        return dict(zip("pnMT", rows, strict=True))


#: from SI to rig units, (scale, zero), in the order of `_SLOW` and of the safety readings
_TO_RIG = ((1.0, 0.0), (1.0 / PA_PER_BAR, 0.0), (1.0 / RAD_S_PER_RPM, 0.0), (1.0, -KELVIN_AT_0_DEGC))
_SAFETY_TO_RIG = (_TO_RIG[1], _TO_RIG[2], _TO_RIG[0], _TO_RIG[3])


def _errors(to_rig: tuple[tuple[float, float], ...], *sensors: SensorError) -> NDArray[np.float64]:
    """Scale, offset (rig units) and noise of four sensors that read SI values, (3, 4)."""
    columns = [
        (scale * sensor.gain, zero * sensor.gain + sensor.offset, sensor.noise)
        for (scale, zero), sensor in zip(to_rig, sensors, strict=True)
    ]
    return np.array(columns).T.copy()


def _channels(settings: PlantSettings) -> tuple[ChannelSpec, ...]:
    microphone = settings.microphone
    return (
        ChannelSpec(
            MICROPHONE,
            "Pa",
            float(SOUND_HZ),
            "int16",
            scale=microphone.full_scale_pa / 32768.0,
            description=f"half-inch free-field microphone, {1000.0 * microphone.sensitivity_v_pa:g} mV/Pa, "
            f"{settings.radiation.microphone_distance_m:g} m from the brake",
        ),
        ChannelSpec(
            TORQUE, "N·m", FULL_RATE_HZ, description="force sensor of the frame that carries the brake"
        ),
        ChannelSpec(PRESSURE, "bar", FULL_RATE_HZ, description="brake line at the caliper"),
        ChannelSpec(SPEED, "1/min", FULL_RATE_HZ, description="encoder of the drive"),
        ChannelSpec(DISC_TEMPERATURE, "°C", FULL_RATE_HZ, description="pyrometer on the rub track"),
    )


def sound_of(settings: PlantSettings, brake: Brake, seed: int) -> Sound:
    """The microphone of the plant with this seed, on its own: the same jobs give the same counts."""
    return Sound(settings, brake, _random_streams(seed)[3])


def _random_streams(seed: int) -> list[np.random.Generator]:
    """Independent streams: stop-to-stop scatter, sensors, safety sensors, sound."""
    return [np.random.Generator(np.random.SFC64(stream)) for stream in np.random.SeedSequence(seed).spawn(4)]
