"""Frame rate and longest stall of the event loop of the live plots, beside pyqtgraph's own peak mode.

    python tests/benchmarks/bench_window.py [--platform offscreen|xcb] [--seconds 6] [--pictures FOLDER]

Three runs in one process, software rendering, 1280 x 900 pixels:

1. pyqtgraph: 4 channels x 12 s x 40 kHz, each a PlotDataItem with setDownsampling(auto, mode="peak") and
setClipToView on its PlotItem, data from a ring that is rolled as a plain program would do. 2. rigctl: the
same channels and size with incremental envelopes. 3. rigctl: the whole live view (5 trends, waveform,
spectrum, spectrogram, levels) of a rig that writes 4 slow channels at 4 kHz and sound at 40 kHz, fed through
a real ring and block messages.

Each is driven by the clock: 50 ms of samples every 50 ms, and drawn as often as the event loop allows, at
most once in 4 ms. "Longest stall" is the largest time between two turns of a 2 ms timer, less these 2 ms. On
a busy machine it holds the time that other programs took; the load is printed, and the most CPU time that the
event loop's own thread used between two turns.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

CHANNELS = 4
RATE_HZ = 40_000.0
SPAN_S = 12.0
BLOCK_S = 0.05
SIZE = (1280, 900)


def parse() -> argparse.Namespace:
    """Options."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--platform", default=os.environ.get("QT_QPA_PLATFORM", "offscreen"))
    parser.add_argument("--seconds", type=float, default=6.0, help="of each run [6]")
    parser.add_argument(
        "--pictures", type=Path, help="save pictures of all plots in both themes there, and end"
    )
    return parser.parse_args()


OPTIONS = parse()
os.environ["QT_QPA_PLATFORM"] = OPTIONS.platform

import pyqtgraph as pg  # noqa: E402
from PySide6.QtCore import QEvent, QEventLoop, QObject, QSettings, Qt, QTimer  # noqa: E402
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget  # noqa: E402

from rigctl.core.channels import ChannelSpec  # noqa: E402
from rigctl.core.ring import RING_NAME, SampleRing  # noqa: E402
from rigctl.gui.live.buffer import Friction, Stretch  # noqa: E402
from rigctl.gui.live.data import LiveData  # noqa: E402
from rigctl.gui.live.groups import TimeGroup  # noqa: E402
from rigctl.gui.live.trend import RowSpec, TrendRow  # noqa: E402
from rigctl.gui.live.view import LiveView  # noqa: E402
from rigctl.gui.rig.connection import RigConnection  # noqa: E402
from rigctl.gui.rig.state import Readings, RigState  # noqa: E402
from rigctl.gui.services import Services  # noqa: E402
from rigctl.gui.theme import ThemeKeeper  # noqa: E402
from rigctl.gui.work import Work  # noqa: E402


class Watch(QObject):
    """Counts paintings of one widget and remembers the longest time between two turns of the event loop."""

    def __init__(self, painted: QWidget) -> None:
        super().__init__()
        self.frames = 0
        self.worst_s = self.worst_cpu_s = 0.0
        self._last_s = self._last_cpu_s = 0.0
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(2)
        self._timer.timeout.connect(self._turn)
        painted.installEventFilter(self)

    def begin(self) -> None:
        """From now on."""
        self.frames, self.worst_s, self.worst_cpu_s = 0, 0.0, 0.0
        self._last_s, self._last_cpu_s = time.perf_counter(), time.thread_time()
        self._timer.start()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Qt's call."""
        self.frames += event.type() == QEvent.Type.Paint
        return False

    def _turn(self) -> None:
        now_s, cpu_s = time.perf_counter(), time.thread_time()
        self.worst_s = max(self.worst_s, now_s - self._last_s - 0.002)
        self.worst_cpu_s = max(self.worst_cpu_s, cpu_s - self._last_cpu_s)
        self._last_s, self._last_cpu_s = now_s, cpu_s


def spin(seconds: float) -> None:
    """Run the event loop."""
    loop = QEventLoop()
    QTimer.singleShot(round(1000 * seconds), loop.quit)
    loop.exec()


def measure(
    name: str, widget: QWidget, frame: Callable[[], None], feed: Callable[[], None], fill: int
) -> None:
    """Show the widget, fill its history, then feed by the clock and draw as often as the loop lets us."""
    widget.resize(*SIZE)
    widget.show()
    for _ in range(fill):
        feed()
    fed, begin_s = 0, time.perf_counter()

    def turn() -> None:
        nonlocal fed
        due = int((time.perf_counter() - begin_s) / BLOCK_S)
        while fed < due:
            feed()
            fed += 1
        frame()

    frames = QTimer()
    frames.setInterval(4)
    frames.timeout.connect(turn)
    frames.start()
    spin(1.0)
    watch = Watch(widget.findChildren(pg.GraphicsView)[0].viewport())
    watch.begin()
    begin, cpu = time.perf_counter(), time.process_time()
    spin(OPTIONS.seconds)
    passed_s, cpu_s = time.perf_counter() - begin, time.process_time() - cpu
    frames.stop()
    cpu_ms = 1e3 * cpu_s / max(watch.frames, 1)
    print(
        f"{name:42s} {watch.frames / passed_s:6.1f} frames/s   {cpu_ms:6.1f} ms of CPU a frame   "
        f"longest stall {1e3 * watch.worst_s:6.1f} ms, own work in it {1e3 * watch.worst_cpu_s:5.1f} ms",
        flush=True,
    )
    widget.close()


def noise(seed: int) -> np.ndarray:
    """Ten seconds of noise with rare peaks of one sample."""
    rng = np.random.default_rng(seed)
    x = rng.normal(0, 1, round(10 * RATE_HZ)).astype(np.float32)
    x[rng.integers(0, len(x), 20)] *= 6.0
    return x


def run_pyqtgraph() -> None:
    """Peak mode of pyqtgraph."""
    n, step = round(SPAN_S * RATE_HZ), round(BLOCK_S * RATE_HZ)
    widget = QWidget()
    layout = QVBoxLayout(widget)
    t = np.arange(n) / RATE_HZ
    data = [np.zeros(n, np.float32) for _ in range(CHANNELS)]
    source = [noise(seed) for seed in range(CHANNELS)]
    curves = []
    for _ in range(CHANNELS):
        plot = pg.PlotWidget()
        layout.addWidget(plot)
        item = plot.getPlotItem()
        item.setDownsampling(auto=True, mode="peak")
        item.setClipToView(True)
        curves.append(item.plot(pen=pg.mkPen("#3c4654", width=1)))
        item.setYRange(-8, 8, padding=0)
        item.setXRange(0, SPAN_S, padding=0)
    at = [0]

    def feed() -> None:
        begin = at[0] % (len(source[0]) - step)
        at[0] += step
        for values, new in zip(data, source, strict=True):
            values[:-step] = values[step:]
            values[-step:] = new[begin : begin + step]

    def frame() -> None:
        for curve, values in zip(curves, data, strict=True):
            curve.setData(t, values)

    measure("pyqtgraph, peak mode, 4 x 12 s x 40 kHz", widget, frame, feed, 3)


def run_envelopes(theme: ThemeKeeper) -> None:
    """Our plots, same data."""
    specs = [ChannelSpec(f"channel {k}", "V", RATE_HZ) for k in range(CHANNELS)]
    data = LiveData(specs)
    source = [noise(seed) for seed in range(CHANNELS)]
    step = round(BLOCK_S * RATE_HZ)
    group = TimeGroup()
    group.set_span(SPAN_S)
    widget = QWidget()
    layout = QVBoxLayout(widget)
    rows = [TrendRow(theme, group, RowSpec(spec.name, spec.name, "V", 2, 1.0)) for spec in specs]
    for row in rows:
        layout.addWidget(row)
    at = [0]

    def feed() -> None:
        begin = at[0] % (len(source[0]) - step)
        t_s = at[0] / RATE_HZ
        at[0] += step
        pairs = zip(specs, source, strict=True)
        data.feed([Stretch(s.name, t_s, x[begin : begin + step]) for s, x in pairs], at[0] / RATE_HZ)

    def frame() -> None:
        for row in rows:
            row.refresh(data)

    measure("rigctl, envelopes, 4 x 12 s x 40 kHz", widget, frame, feed, 260)


class DemoRig:
    """Brakings of 12 s with pauses of 4 s: shaft noise, a squeal that grows, its harmonic, a second one."""

    SPECS = (
        ChannelSpec("microphone", "Pa", 40_000.0, "int16", scale=20.0 / 32768),
        ChannelSpec("torque", "N·m", 4000.0), ChannelSpec("pressure", "bar", 4000.0),
        ChannelSpec("speed", "1/min", 4000.0), ChannelSpec("disc_temperature", "°C", 4000.0),
    )  # fmt: skip
    FRICTION = Friction(2.29e-3, 0.105)

    def __init__(self, run_dir: Path, rig: RigConnection) -> None:
        self.run_dir, self.campaign = run_dir, None
        self._rig = rig
        self._ring = SampleRing.create(run_dir / RING_NAME, self.SPECS)
        self._rng = np.random.default_rng(4)
        self._k = 0
        self._temperature = 120.0

    def block(self) -> None:
        """Write one block, announce it, tell the set-points."""
        t0, self._k = self._k * BLOCK_S, self._k + 1
        rng = self._rng
        t = t0 + np.arange(200) / 4000.0
        in_braking = t0 % 16.0
        set_bar = 20.0 if 1.0 <= in_braking < 13.0 else 0.0
        p = np.clip(np.minimum((t % 16.0 - 1.0) * 60, 20.0), 0, None) * (t % 16.0 < 13.1) + rng.normal(
            0, 0.04, 200
        )
        mu = 0.42 + 0.02 * np.sin(2 * np.pi * 2.5 * t) + rng.normal(0, 0.004, 200)
        torque = np.clip(p - 0.5, 0, None) * 48.1 * mu + rng.normal(0, 1.0, 200)
        speed = 150.0 + 2.0 * np.sin(2 * np.pi * 2.5 * t) + rng.normal(0, 0.3, 200)
        self._temperature += 0.06 * (set_bar > 0) - 0.05
        slow = {"torque": torque, "pressure": p, "speed": speed,
                "disc_temperature": self._temperature + rng.normal(0, 0.4, 200)}  # fmt: skip
        ranges = {name: self._ring.write(name, x.astype(np.float32)) for name, x in slow.items()}
        ranges["microphone"] = self._ring.write("microphone", self._sound(t0))
        block = {"t_ns": round(t0 * 1e9), "dt_ns": round(BLOCK_S * 1e9), "stride": 1, "ranges": ranges}
        self._rig.blocksArrived.emit([block])
        if self._k % 2 == 0:
            self._rig.stateChanged.emit(
                RigState(readings=Readings(set_speed_rpm=150.0, set_pressure_bar=set_bar))
            )

    def _sound(self, t0: float) -> np.ndarray:
        t = t0 + np.arange(2000) / 40_000.0
        within = t % 16.0
        x = self._rng.normal(0, 0.02, 2000) + 0.03 * np.sin(2 * np.pi * 50 * t) * (
            1 + np.sin(2 * np.pi * 2.5 * t)
        )
        grow = np.clip((within - 3.0) / 4.0, 0, 1) * (within < 10.5)
        f = 2350.0
        x += 0.8 * grow * np.sin(2 * np.pi * f * t) + 0.08 * grow * np.sin(4 * np.pi * f * t)
        x += 0.25 * ((within > 8.0) & (within < 11.5)) * np.sin(2 * np.pi * 6800.0 * t)
        return np.round(x / 20.0 * 32768).astype(np.int16)

    def fill(self, seconds: float) -> None:
        """Blocks without waiting."""
        for _ in range(round(seconds / BLOCK_S)):
            self.block()


def demo(theme: ThemeKeeper, folder: Path, **options: object) -> tuple[LiveView, DemoRig, Services]:
    """A live view that watches a synthetic rig."""
    rig, work = RigConnection(), Work()
    settings = QSettings(str(folder / "window.ini"), QSettings.Format.IniFormat)
    services = Services(rig, work, theme, settings, folder, Path("configs"), lambda *_, **__: None, print)
    view = LiveView(services, **options)  # type: ignore[arg-type]
    source = DemoRig(folder, rig)
    rig.attached.emit(source)
    source.block()
    view.feed._values = type(view.feed._values)({}, DemoRig.FRICTION)
    view.feed.data.buffer.friction = DemoRig.FRICTION
    view.set_limits({"pressure": (-1.0, 41.0), "disc_temperature": (5.0, 500.0), "torque": (-150.0, 1300.0)})
    return view, source, services


def run_view(theme: ThemeKeeper, folder: Path) -> None:
    """The whole live view."""
    view, source, services = demo(theme, folder, columns=2)
    view.start()

    def frame() -> None:
        view.feed.data.version += 1  # as if something had changed: draw as fast as it goes
        view._tick()

    measure("rigctl, whole live view, 9 plots, flat out", view, frame, source.block, 300)
    view.stop()
    view.show()
    view.start()
    measure("the same at its own pace (30 Hz)", view, lambda: None, source.block, 0)
    view.stop()
    services.work.close()


def save_pictures(theme: ThemeKeeper, folder: Path, into: Path) -> None:
    """All plots in both themes, several sizes and states."""
    into.mkdir(parents=True, exist_ok=True)
    sound = ("waveform", "spectrum", "spectrogram", "level")
    for number, (name, scale, size, state, seconds, options) in enumerate(
        (
            ("light", 1.0, (1140, 640), "follow", 9.0, {"columns": 2}),
            ("dark", 1.0, (1140, 640), "follow", 9.0, {"columns": 2}),
            ("light", 1.0, (1780, 900), "cursors", 13.5, {"columns": 2}),
            ("dark", 1.5, (1780, 900), "frozen", 21.0, {"columns": 2}),
            ("light", 1.0, (520, 560), "follow", 9.0, {"panels": sound}),
            ("dark", 1.0, (520, 560), "follow", 23.0, {"panels": sound}),
            ("light", 1.5, (760, 800), "cursors", 9.0, {"panels": sound}),
            ("light", 1.0, (520, 560), "empty", 0.0, {"panels": sound}),
        )
    ):
        own = folder / str(number)
        own.mkdir()
        theme.set(name=name, scale=scale)
        view, source, services = demo(theme, own, **options)
        view.resize(*size)
        view.show()
        for _ in range(round(seconds)):
            source.fill(1.0)
            view.feed.data.work(1.0)
        view.start()
        view.set_frozen(state == "frozen")
        view.set_cursors(state == "cursors")
        for _ in range(8):
            if state != "empty":
                source.block()
            spin(0.05)
        view.grab().save(str(into / f"live-{number}-{name}-{scale}-{size[0]}-{state}.png"))
        view.stop()
        view.close()
        services.work.close()


def main() -> int:
    """Measure, or save pictures."""
    app = QApplication(sys.argv[:1])
    theme = ThemeKeeper(app, "light")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if OPTIONS.pictures is not None:
            save_pictures(theme, folder, OPTIONS.pictures)
            return 0
        print(
            f"platform {OPTIONS.platform}, {os.cpu_count()} processors, {SIZE[0]} x {SIZE[1]} pixels, "
            f"load {os.getloadavg()[0]:.1f}"
        )
        run_pyqtgraph()
        run_envelopes(theme)
        run_view(theme, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
