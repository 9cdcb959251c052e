"""Microphone through PortAudio (`sounddevice`): the master clock of a real rig.

Job: find the device by name and host API, open it at one rate, copy what its callback brings into a ring,
and say when it has overflowed, ended or gone. Not its job: finding lost frames by time
(`drivers.daq.rig_time`), calibration of the microphone.

Settings: see `MicrophoneSettings`. ``device = "bench:rigmic"`` is the microphone of a running bench: its
private sound server is reached by variables that are set here, before PortAudio starts.
"""

# numpy's and sounddevice's types are partly unknown:
# pyright: reportUnknownMemberType=false

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drivers.daq.source import SourceSettings, checked
from rigctl.core.channels import MICROPHONE, ChannelSpec
from rigctl.core.errors import DeviceError
from rigctl.hal.bench_paths import PREFIX, bench_folder, port_hint
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading

FULL_SCALE = 32768
STAMPS = 1 << 14  # callbacks that may wait: more than the ring's seconds at 1000 callbacks/s
SYSTEM_ALSA = "/usr/share/alsa/alsa.conf"
SHARING = ("pulse", "pipewire", "default", "dmix", "dsnoop", "sysdefault")


class MicrophoneSettings(SourceSettings):
    """Settings of kind "sounddevice".

    Attributes
    ----------
    device : str
        Name of the device, or a part of it that only one has.
    host_api : str
        "ALSA", "JACK Audio Connection Kit", "Windows WASAPI", … ; empty: any.
    input : int
        Input of the device, from 1.
    rate_hz : int
        Sampling rate. Must be the device's own: a sound server resamples without saying so.
    format : str
        "float32" or "int16", as asked of PortAudio; stored are int16 counts.
    latency : str or float
        "low", "high", or seconds. "high" survives more load of the machine.
    full_scale_pa : float
        Sound pressure of full scale (1.0, or 32768 counts).
    channel, description : str
        Name of the channel; sensor and place, for the record.
    ring_s : float
        The controller may be behind for so long.
    gap_limit_s, max_drift_ppm : float
        See `drivers.daq.rig_time`.
    """

    device: str = Field(min_length=1)
    host_api: str = ""
    input: int = Field(default=1, ge=1, le=256)
    rate_hz: int = Field(default=40_000, ge=8_000, le=384_000)
    format: Literal["float32", "int16"] = "float32"
    latency: Literal["low", "high"] | float = "high"
    full_scale_pa: float = Field(gt=0.0, le=1e5)
    channel: str = MICROPHONE
    description: str = "microphone"
    ring_s: float = Field(default=16.0, ge=1.0, le=120.0)
    gap_limit_s: float = Field(default=0.02, gt=0.0, le=1.0)
    max_drift_ppm: float = Field(default=1000.0, gt=0.0, le=10_000.0)


def sound_library(place: str) -> Any:
    """The sounddevice module.

    Raises
    ------
    DeviceError
        It, or PortAudio, is not installed.
    """
    try:
        import sounddevice
    except ImportError as error:
        raise DeviceError(
            f"the library {error.name!r} is missing.",
            place=place,
            remedy="Install it: pip install sounddevice.",
        ) from error
    except OSError as error:
        raise DeviceError(
            f"PortAudio cannot be loaded: {error}.", place=place,
            remedy="Install it: apt-get install libportaudio2 (Debian), or the wheel that brings it.",
        ) from error  # fmt: skip
    return sounddevice


class SoundDeviceMicrophone:
    """A `drivers.daq.source.Master`."""

    def __init__(self, name: str, settings: Mapping[str, Any], context: RigContext, place: str) -> None:
        self.name = name
        self.place = place
        self.settings = checked(MicrophoneSettings, settings, place)
        self.rate_hz = float(self.settings.rate_hz)
        self._context = context
        dtype = np.float32 if self.settings.format == "float32" else np.int16
        self._ring: NDArray[Any] = np.zeros(round(self.rate_hz * self.settings.ring_s), dtype)
        self._stamp_frames = np.zeros(STAMPS, np.int64)
        self._stamp_s = np.zeros(STAMPS)
        self._written = self._callbacks = self._read_callbacks = 0
        self._last_s = float("-inf")
        self._overflows = 0
        self._ended = False
        self._closing = False
        self._stream: Any = None
        self._identity: dict[str, str] = {}
        self._findings: list[Finding] = []

    def open(self) -> None:
        """See `AnySource.open`.

        Raises
        ------
        DeviceError
            PortAudio or the device is missing, or does not take rate, format or input.
        """
        settings = self.settings
        self._use_bench()
        library = sound_library(self.place)
        try:
            # devices plugged in since, and variables set since, are seen only by a fresh PortAudio
            library._terminate()
            library._initialize()
            number, device, api = self._find(library)
        except library.PortAudioError as error:
            raise DeviceError(
                f"PortAudio does not start: {error}.", place=self.place, remedy="Check the sound system."
            ) from error
        if settings.input > device["max_input_channels"]:
            raise DeviceError(
                f"{device['name']!r} has {device['max_input_channels']} inputs.", place=f"{self.place}.input",
                value=settings.input, remedy="Give one of them, from 1.",
            )  # fmt: skip
        self._written = self._callbacks = self._read_callbacks = self._overflows = 0
        self._ended = self._closing = False
        try:
            library.check_input_settings(
                device=number, channels=settings.input, dtype=settings.format, samplerate=self.rate_hz
            )
            self._stream = library.InputStream(
                device=number, channels=settings.input, dtype=settings.format, samplerate=self.rate_hz,
                latency=settings.latency, callback=self._callback, finished_callback=self._on_end,
            )  # fmt: skip
            self._last_s = time.monotonic()
            self._stream.start()
        except (library.PortAudioError, ValueError) as error:
            self.close()
            raise DeviceError(
                f"{device['name']!r} does not open with {settings.rate_hz} Hz, {settings.format}, input "
                f"{settings.input}: {error}.", place=self.place, value=settings.rate_hz,
                remedy=f"Its own rate is {device['default_samplerate']:g} Hz; set rate_hz to what it "
                "supports, and see that no other program has it open.",
            ) from error  # fmt: skip
        actual_hz = float(self._stream.samplerate)
        if abs(actual_hz / self.rate_hz - 1.0) > 1e-3:
            self.close()
            raise DeviceError(
                f"{device['name']!r} runs at {actual_hz:g} Hz instead of {settings.rate_hz} Hz.",
                place=f"{self.place}.rate_hz", value=settings.rate_hz, remedy="Set its own rate.",
            )  # fmt: skip
        self._note(device, api, actual_hz)

    def close(self) -> None:
        """See `AnySource.close`."""
        self._closing = True
        stream, self._stream = self._stream, None
        if stream is not None:
            stream.close(ignore_errors=True)
        self._context.board.fault(f"{self.name}: overload", "")

    def identity(self) -> Mapping[str, str]:
        """See `AnySource.identity`."""
        return dict(self._identity)

    def channels(self) -> Sequence[ChannelSpec]:
        """See `AnySource.channels`."""
        settings = self.settings
        return (
            ChannelSpec(settings.channel, "Pa", self.rate_hz, "int16", settings.full_scale_pa / FULL_SCALE,
                        description=settings.description),
        )  # fmt: skip

    def check(self) -> None:
        """Raise when frames were lost or the stream has ended.

        Raises
        ------
        DeviceError
        """
        if self._overflows:
            raise DeviceError(
                f"PortAudio reports {self._overflows} overflows: frames are lost.", place=self.place,
                remedy="The machine is overloaded: raise `latency`, end other programs.",
            )  # fmt: skip
        if self._ended and not self._closing:
            raise DeviceError(
                "the sound stream has ended by itself.", place=self.place,
                remedy="Check that the device is plugged in, and its sound server.",
            )  # fmt: skip
        if self._callbacks - self._read_callbacks > STAMPS:
            raise DeviceError(
                "the controller has not asked for sound for too long.", place=self.place,
                remedy="The machine is overloaded.",
            )  # fmt: skip

    def frames(self) -> int:
        """See `Master.frames`."""
        return self._written

    def last_arrival_s(self) -> float:
        """See `Master.last_arrival_s`."""
        return self._last_s

    def stamps(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """See `Master.stamps`."""
        stop = self._callbacks
        at = np.arange(self._read_callbacks, stop) % STAMPS
        self._read_callbacks = stop
        return self._stamp_frames[at], self._stamp_s[at]

    def read(self, start: int, stop: int) -> NDArray[np.int16]:
        """See `Master.read`."""
        size = len(self._ring)
        at, n = start % size, stop - start
        first = min(n, size - at)
        samples = np.empty(n, self._ring.dtype)
        samples[:first] = self._ring[at : at + first]
        samples[first:] = self._ring[: n - first]
        if self._written - start > size:
            raise DeviceError(
                f"{self._written - start - size} frames were overwritten before they were read.",
                place=self.place, remedy="The machine is overloaded, or raise ring_s.",
            )  # fmt: skip
        counts = to_counts(samples)
        clipped = int(np.count_nonzero((counts == FULL_SCALE - 1) | (counts == -FULL_SCALE)))
        problem = (
            f"{clipped} of {n} frames at full scale ({self.settings.full_scale_pa:g} Pa)" if clipped else ""
        )
        self._context.board.fault(f"{self.name}: overload", problem)
        return counts

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `AnySource.diagnose`."""
        self.check()
        recent = min(self._written, len(self._ring), round(0.1 * self.rate_hz))
        counts = self.read(self._written - recent, self._written) if recent else np.zeros(1, np.int16)
        rms_pa = float(np.sqrt(np.mean(np.square(counts, dtype=np.float64)))) * self.channels()[0].scale
        age_s = time.monotonic() - self._last_s
        fault = "silent" if age_s > self.settings.silent_s else ""
        value = None if fault or not recent else rms_pa
        reading = Reading(self.settings.channel, value, "Pa rms", age_s, self.rate_hz, fault)
        return Diagnosis((reading,), warnings=tuple(self._findings), identity=self.identity())

    # -- PortAudio's thread -------------------------------------------------------------------------

    def _callback(self, data: NDArray[Any], frames: int, times: Any, status: Any) -> None:
        now_s = time.monotonic()
        ring, size = self._ring, len(self._ring)
        at = self._written % size
        first = min(frames, size - at)
        column = self.settings.input - 1
        ring[at : at + first] = data[:first, column]
        if first < frames:
            ring[: frames - first] = data[first:, column]
        if status and status.input_overflow:
            self._overflows += 1
        slot = self._callbacks % STAMPS
        self._stamp_frames[slot] = self._written + frames
        self._stamp_s[slot] = now_s
        self._last_s = now_s
        self._written += frames
        self._callbacks += 1

    def _on_end(self) -> None:
        self._ended = True

    # -- finding the device -------------------------------------------------------------------------

    def _use_bench(self) -> None:
        """The bench's sound server is its own; see `sim_hardware.bench`'s folder "sound"."""
        if not self.settings.device.startswith(PREFIX):
            return
        folder = bench_folder() / "sound"
        configuration = folder / "asound.conf"
        if not configuration.exists():
            raise DeviceError(
                f"there is no microphone {self.settings.device!r}: no {configuration}.",
                place=f"{self.place}.device", value=self.settings.device, remedy=port_hint(PREFIX),
            )  # fmt: skip
        os.environ["ALSA_CONFIG_PATH"] = f"{SYSTEM_ALSA}:{configuration}"
        os.environ["PULSE_SERVER"] = f"unix:{folder / 'native'}"

    def _find(self, library: Any) -> tuple[int, Mapping[str, Any], str]:
        apis = [api["name"] for api in library.query_hostapis()]
        inputs = [
            (number, device, apis[device["hostapi"]])
            for number, device in enumerate(library.query_devices())
            if device["max_input_channels"] > 0
        ]
        wanted = self.settings.device.removeprefix(PREFIX).casefold()
        api = self.settings.host_api.casefold()
        fitting = [entry for entry in inputs if api in entry[2].casefold()]
        found = [entry for entry in fitting if entry[1]["name"].casefold() == wanted]
        found = found or [entry for entry in fitting if wanted in entry[1]["name"].casefold()]
        if len(found) == 1:
            return found[0]
        there = "; ".join(f"{device['name']!r} ({name})" for _, device, name in inputs) or "none"
        problem = (
            "no sound device has this name" if not found else f"{len(found)} sound devices have this name"
        )
        raise DeviceError(
            f"{problem}: {self.settings.device!r}.", place=f"{self.place}.device", value=self.settings.device,
            remedy=f"Inputs of this machine: {there}. Set device, and host_api where a name is there twice.",
        )  # fmt: skip

    def _note(self, device: Mapping[str, Any], api: str, actual_hz: float) -> None:
        default_hz = float(device["default_samplerate"])
        self._identity = {
            "model": str(device["name"]), "host_api": api, "rate": f"{actual_hz:g} Hz",
            "latency": f"{1e3 * float(self._stream.latency):.1f} ms (reported)",
        }  # fmt: skip
        shared = any(word in str(device["name"]).casefold() for word in SHARING) or (
            self.settings.device.startswith(PREFIX)
        )
        self._findings = []
        if abs(default_hz - self.rate_hz) > 1.0:
            through = " through a sound server, which resamples without saying so" if shared else ""
            self._findings.append(Finding(
                f"{device['name']!r} gives {default_hz:g} Hz as its own rate and is opened at "
                f"{self.rate_hz:g} Hz{through}.",
                remedy="See that the source itself runs at rate_hz (pactl list sources, the card's manual).",
            ))  # fmt: skip


def to_counts(samples: NDArray[Any]) -> NDArray[np.int16]:
    """Samples of PortAudio (int16, or float32 with 1.0 as full scale) as int16 counts; clipped."""
    if samples.dtype == np.int16:
        return samples
    scaled = np.nan_to_num(samples.astype(np.float32) * np.float32(FULL_SCALE), nan=0.0)
    return np.clip(np.rint(scaled), -FULL_SCALE, FULL_SCALE - 1).astype(np.int16)
