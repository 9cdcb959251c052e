"""A private PulseAudio server in the bench's folder, with the microphone as its only source.

Job: write its configuration, start it so that it ends with the bench, wait until it serves, stop it; say how
a recorder reaches it. Not its job: samples (`microphone`).

A pipe-source needs no rights, no D-Bus and no kernel module; it works in containers. Recorders reach it by
ALSA (`ALSA_CONFIG_PATH`, device = the source's name), or by PulseAudio (`PULSE_SERVER`).
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import stat
import subprocess
import time
from pathlib import Path

from rigctl.core.errors import DeviceError
from sim_hardware.bench.settings import MicrophoneSettings

START_TIMEOUT_S = 10.0
STOP_TIMEOUT_S = 3.0
SYSTEM_ALSA = "/usr/share/alsa/alsa.conf"
_POLL_S = 0.01
_MAX_SOCKET_PATH = 107
_FORMATS = {"float32": "float32le", "int16": "s16le"}
_LOG = "pulseaudio.log"


def installed() -> bool:
    """Whether this machine has PulseAudio."""
    return shutil.which("pulseaudio") is not None


class PulseServer:
    """The server. Everything of it is in the folder `sound` of the bench's folder.

    Parameters
    ----------
    folder : Path
        The bench's.
    settings : MicrophoneSettings

    Attributes
    ----------
    pipe : Path
        Where the microphone writes.
    """

    def __init__(self, folder: Path, settings: MicrophoneSettings) -> None:
        self._folder = folder / "sound"
        self._settings = settings
        self.pipe = self._folder / "microphone.pipe"
        self._socket = self._folder / "native"
        self._pid_file = self._folder / "pulseaudio.pid"
        self._alsa = self._folder / "asound.conf"
        self._process: subprocess.Popen[bytes] | None = None

    def environment(self) -> dict[str, str]:
        """Variables with which a recording program finds the microphone."""
        return {
            "ALSA_CONFIG_PATH": f"{SYSTEM_ALSA}:{self._alsa}",
            "PULSE_SERVER": f"unix:{self._socket}",
        }

    def start(self) -> None:
        """Start it and wait until it serves.

        The kernel ends it with the thread that calls this: call it from the main thread.

        Raises
        ------
        DeviceError
            It does not start.
        """
        if len(str(self._socket)) > _MAX_SOCKET_PATH:
            raise DeviceError(
                "the path is too long for a socket.",
                place=str(self._socket),
                remedy="Set RIGCTL_BENCH_DIR to a folder with a shorter path.",
            )
        self.clear()
        self._folder.mkdir(mode=0o700, exist_ok=True)
        self._write_configuration()
        command = [
            "pulseaudio", "-n", "-F", str(self._folder / "default.pa"), "--daemonize=no",
            "--exit-idle-time=-1", "--use-pid-file=no", "--disable-shm=yes", "--high-priority=no",
            "--realtime=no",
        ]  # fmt: skip
        if (setpriv := shutil.which("setpriv")) is not None:  # util-linux: ends it with us, even by SIGKILL
            command = [setpriv, "--pdeathsig", "KILL", *command]
        runtime = str(self._folder)
        environment = {
            **os.environ, "XDG_RUNTIME_DIR": runtime, "XDG_CONFIG_HOME": runtime,
            "PULSE_RUNTIME_PATH": runtime,
            "PULSE_STATE_PATH": runtime, "HOME": runtime,
        }  # fmt: skip
        with (self._folder / _LOG).open("wb") as log:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=environment,
                start_new_session=True,
            )
        self._pid_file.write_text(str(self._process.pid))
        self._wait()

    def stop(self) -> None:
        """End it and remove its sockets."""
        process, self._process = self._process, None
        if process is not None:
            process.terminate()
            try:
                process.wait(STOP_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.clear()

    def clear(self) -> None:
        """Remove what a bench leaves, so that nobody looks for a microphone here; its log stays."""
        self._end_leftover()
        for path in (self._socket, self.pipe, self._pid_file, self._alsa):
            path.unlink(missing_ok=True)

    @property
    def pid(self) -> int:
        """Of the process; 0 when it has not been started."""
        return self._process.pid if self._process is not None else 0

    @property
    def running(self) -> bool:
        """It has been started and has not ended."""
        return self._process is not None and self._process.poll() is None

    def _write_configuration(self) -> None:
        s = self._settings
        (self._folder / "default.pa").write_text(
            f"load-module module-native-protocol-unix auth-anonymous=1 socket={self._socket}\n"
            f"load-module module-pipe-source source_name={s.name} file={self.pipe} "
            f"format={_FORMATS[s.format]} rate={s.rate_hz} channels=1\n"
            f"set-default-source {s.name}\n"
        )
        self._alsa.write_text(
            f'pcm.{s.name} {{ type pulse server "unix:{self._socket}" device "{s.name}"\n'
            f'  hint {{ show on description "Microphone of the bench" }} }}\n'
        )

    def _wait(self) -> None:
        """The pipe is there and the socket answers."""
        deadline = time.monotonic() + START_TIMEOUT_S
        while time.monotonic() < deadline:
            if not self.running:
                break
            with contextlib.suppress(OSError):
                if stat.S_ISFIFO(self.pipe.stat().st_mode) and self._answers():
                    return
            time.sleep(_POLL_S)
        words = (self._folder / _LOG).read_text(errors="replace").strip().splitlines()[-3:]
        self.stop()
        raise DeviceError(
            f"does not start: {' '.join(words) or 'it says nothing'}.",
            place="pulseaudio",
            remedy="Set enabled = false under [microphone] of the bench file to go without sound.",
        )

    def _answers(self) -> bool:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
            probe.connect(str(self._socket))
        return True

    def _end_leftover(self) -> None:
        """End the server of a bench that was killed where the kernel has not done so (no `setpriv`)."""
        try:
            pid = int(self._pid_file.read_text())
            command = Path(f"/proc/{pid}/cmdline").read_bytes()
        except (OSError, ValueError):
            return
        if str(self._folder / "default.pa").encode() in command:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
