"""What is connected to this machine: serial ports, CAN interfaces, sound devices, ports of a running bench.

Job: ask the vendor libraries, each by itself, and give plain data. A missing library or sound server is one
`DeviceError` of that question. Not its job: opening devices of a rig, printing (`rigctl.app.devices`).
"""

from __future__ import annotations

import contextlib
import errno
import json
import logging
import os
import socket
import stat
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigctl.core.errors import DeviceError
from rigctl.hal.bench_paths import PREFIX, READY_NAME, bench_folder

PROBED_RATES_HZ = (40_000, 44_100, 48_000, 51_200, 96_000, 192_000)
_ON_THE_NETWORK = ("socketcand",)  # asks by broadcast and waits four seconds
_ONLY_FOR_TESTS = ("virtual",)


@dataclass(frozen=True, slots=True)
class SerialPort:
    """A serial port.

    Attributes
    ----------
    port : str
        As it is written into a rig file.
    description, hardware_id : str
        What the operating system knows of it.
    stable_name : str
        A name under /dev/serial/by-id that survives replugging, "" where there is none.
    usable : bool
        Whether this user may open it.
    """

    port: str
    description: str
    hardware_id: str
    stable_name: str
    usable: bool


@dataclass(frozen=True, slots=True)
class CanInterface:
    """A CAN channel that can be opened here: keys of a `[buses.NAME]` table, and a remark."""

    interface: str
    channel: str
    remark: str = ""


@dataclass(frozen=True, slots=True)
class SoundDevice:
    """A sound device with inputs.

    Attributes
    ----------
    name, host_api : str
        As written into a rig file.
    inputs : int
        Number of channels.
    default_rate_hz : float
    rates_hz : tuple of int
        Those of `PROBED_RATES_HZ` that it accepts.
    latency_s : float
        Lowest that it states for inputs.
    default : bool
        The machine's default input.
    """

    name: str
    host_api: str
    inputs: int
    default_rate_hz: float
    rates_hz: tuple[int, ...]
    latency_s: float
    default: bool


@dataclass(frozen=True, slots=True)
class BenchPort:
    """A port or the microphone of a running bench: name for the rig file, and where it leads."""

    port: str
    path: str


def serial_ports() -> list[SerialPort]:
    """All serial ports.

    Raises
    ------
    DeviceError
        pyserial is missing.
    """
    with _library("serial ports", "pyserial"):
        from serial.tools import list_ports

    stable = _stable_names()
    return [
        SerialPort(
            info.device,
            "" if info.description in (None, "n/a") else info.description,
            "" if info.hwid in (None, "n/a") else info.hwid,
            stable.get(os.path.realpath(info.device), ""),
            os.access(info.device, os.R_OK | os.W_OK),
        )
        for info in sorted(list_ports.comports())
    ]


def can_interfaces(*, network: bool = False) -> tuple[list[CanInterface], list[str]]:
    """CAN channels that python-can finds, and remarks on what it could not look for.

    Parameters
    ----------
    network : bool
        Ask for socketcand servers too (four seconds).

    Raises
    ------
    DeviceError
        python-can is missing.
    """
    with _library("CAN interfaces", "python-can"):
        import can
        import can.interfaces

    found: list[CanInterface] = []
    remarks: list[str] = []
    with _silent("can"):
        for name in sorted(can.interfaces.BACKENDS):
            if name in _ONLY_FOR_TESTS or (name in _ON_THE_NETWORK and not network):
                continue
            try:
                configurations = can.detect_available_configs(name)
            except Exception as error:  # a vendor's library, half installed
                remarks.append(f"{name}: cannot be searched: {type(error).__name__}: {error}.")
                continue
            found += [
                CanInterface(name, str(configuration["channel"]), _remark(name))
                for configuration in configurations
            ]
    problem = _kernel_can()
    if problem:
        remarks.append(problem)
    elif not any(channel.interface == "socketcan" for channel in found):
        remarks.append(
            "socketcan: the kernel knows CAN, but there is no interface: plug one in, or `modprobe vcan`."
        )
    return found, remarks


def sound_devices() -> list[SoundDevice]:
    """All sound devices with inputs.

    Raises
    ------
    DeviceError
        sounddevice or PortAudio is missing, or there is no sound system.
    """
    with _quiet_stderr():
        sounddevice = _sounddevice()
        try:
            apis = sounddevice.query_hostapis()
            devices = sounddevice.query_devices()
        except sounddevice.PortAudioError as error:
            raise DeviceError(
                f"the sound system does not answer: {error}.", place="sound devices",
                remedy="Start the sound server (pulseaudio --start, or PipeWire) or check the card.",
            ) from error  # fmt: skip
        result: list[SoundDevice] = []
        for device in devices:
            if device["max_input_channels"] < 1:
                continue
            api = apis[device["hostapi"]]
            result.append(
                SoundDevice(
                    device["name"],
                    api["name"],
                    device["max_input_channels"],
                    device["default_samplerate"],
                    tuple(rate for rate in PROBED_RATES_HZ if _accepts(sounddevice, device["index"], rate)),
                    device["default_low_input_latency"],
                    api["default_input_device"] == device["index"],
                )
            )
    return result


def bench_ports() -> list[BenchPort]:
    """Ports of a running bench; none where no bench runs. What a dead bench has left is not listed."""
    folder = bench_folder()
    ports: list[BenchPort] = []
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return []
    for entry in entries:
        try:
            mode = entry.stat().st_mode
        except OSError:
            continue  # the link of a bench that is gone
        if stat.S_ISCHR(mode):
            ports.append(BenchPort(f"{PREFIX}{entry.name}", os.path.realpath(entry)))
    return ports + _bench_microphone(folder)


def _bench_microphone(folder: Path) -> list[BenchPort]:
    """The microphone of a running bench: one whose sound server takes connections."""
    server = folder / "sound" / "native"
    try:
        microphone = json.loads((folder / READY_NAME).read_text()).get("microphone")
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
            probe.connect(str(server))
    except (OSError, ValueError):
        return []
    return [BenchPort(f"{PREFIX}{microphone['device']}", str(server))] if microphone else []


def _sounddevice() -> Any:
    try:
        import sounddevice
    except ImportError as error:
        raise _missing("sound devices", error, "sounddevice") from error
    except OSError as error:  # its own way to say that PortAudio is not there
        raise DeviceError(
            f"{error}.", place="sound devices",
            remedy="Install PortAudio: apt install libportaudio2 (Fedora: portaudio).",
        ) from error  # fmt: skip
    return sounddevice


def _accepts(sounddevice: Any, index: int, rate_hz: int) -> bool:
    try:
        sounddevice.check_input_settings(device=index, channels=1, samplerate=rate_hz, dtype="float32")
    except (sounddevice.PortAudioError, ValueError):
        return False
    return True


def _remark(interface: str) -> str:
    return {
        "udp_multicast": "network of this machine: the bench",
        "serial": "only for an adapter with python-can's own serial protocol",
    }.get(interface, "")


def _kernel_can() -> str:
    """Why SocketCAN cannot be used here, "" where it can."""
    family = getattr(socket, "AF_CAN", None)
    if family is None:
        return "socketcan: not on this operating system; use the adapter's own interface (pcan, …)."
    try:
        socket.socket(family, socket.SOCK_RAW, socket.CAN_RAW).close()
    except OSError as error:
        if error.errno in (errno.EAFNOSUPPORT, errno.EPROTONOSUPPORT):
            return (
                "socketcan: this kernel has no CAN: `modprobe can_raw` and the adapter's module (as root), "
                "or use another interface."
            )
        return f"socketcan: {error.strerror}."
    return ""


def _stable_names() -> dict[str, str]:
    folder = "/dev/serial/by-id"
    try:
        names = sorted(os.listdir(folder))
    except OSError:
        return {}
    return {os.path.realpath(f"{folder}/{name}"): f"{folder}/{name}" for name in names}


@contextlib.contextmanager
def _library(what: str, package: str) -> Iterator[None]:
    try:
        yield
    except ImportError as error:
        raise _missing(what, error, package) from error


def _missing(what: str, error: ImportError, package: str) -> DeviceError:
    return DeviceError(
        f"cannot be listed: {error}.", place=what, remedy=f"Install the library: pip install {package}."
    )


@contextlib.contextmanager
def _silent(logger: str) -> Iterator[None]:
    """python-can warns of every vendor's library that is not installed."""
    log = logging.getLogger(logger)
    before = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        log.setLevel(before)


@contextlib.contextmanager
def _quiet_stderr() -> Iterator[None]:
    """ALSA writes past Python of every plugin that is not installed."""
    sys.stderr.flush()
    try:
        kept = os.dup(2)
    except OSError:  # no standard error at all
        yield
        return
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
