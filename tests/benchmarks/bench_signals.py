"""Times of the signal processing against its peers, each with its error. Run by hand:

    python tests/benchmarks/bench_signals.py

One braking is 12 s at 40 kHz (int16) plus four channels of 4 kHz. Best of ten, one core.
"""

import os
import time
from collections.abc import Callable

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from scipy import signal
from scipy.ndimage import median_filter

from rigctl.core.channels import ChannelData, ChannelSpec
from rigctl.signals.calibration import mean_square_pa2
from rigctl.signals.decimation import StreamingDecimator, decimate, design_decimation
from rigctl.signals.evaluation import evaluate, warm_up
from rigctl.signals.friction import FrictionGeometry
from rigctl.signals.levels import leq_and_lmax_db
from rigctl.signals.spectra import hann, spectrogram
from rigctl.signals.squeal import SquealDetection, detect_squeal
from rigctl.signals.weighting import apply_weighting, weighting_db

RATE_HZ, SECONDS, F_HZ, LEVEL_DB = 40000, 12, 2351.3, 80.0


def best_ms(work: Callable[[], object], repeats: int = 10) -> float:
    """Shortest wall time of a call, ms."""
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def line(name: str, ms: float, peer_ms: float | None = None, error: str = "") -> None:
    """Print one row: time, ratio to the peer, error."""
    ratio = "" if peer_ms is None else f"peer {peer_ms:8.2f} ms = {peer_ms / ms:5.1f} x"
    print(f"{name:44s} {ms:8.2f} ms   {ratio:28s} {error}")


def braking(noise_db: float = 50.0, tone_db: float = LEVEL_DB) -> dict[str, ChannelData]:
    """Channels of one squealing braking as the recorder hands them over."""
    t = np.arange(SECONDS * RATE_HZ) / RATE_HZ
    noise = np.sqrt(mean_square_pa2(noise_db)) * np.random.default_rng(0).standard_normal(t.size)
    tone = np.sqrt(2 * mean_square_pa2(tone_db)) * np.sin(2 * np.pi * F_HZ * t) * ((t > 3) & (t < 9))
    scale = 200 / 32768 / 20
    spec = ChannelSpec("microphone", "Pa", RATE_HZ, "int16", scale)
    counts = np.clip(np.round((noise + tone) / scale), -32768, 32767).astype(np.int16)
    ts = np.arange(SECONDS * 1000) / 1000
    pressure = np.where((ts > 0.5) & (ts < 11.5), 15.0, 0.0)
    slow = {
        "pressure": pressure,
        "torque": 19.0 * pressure,
        "speed": 40 + 0 * ts,
        "disc_temperature": 100 + ts,
    }
    channels = {k: ChannelData(ChannelSpec(k, "", 1000), 0.0, v.astype(np.float32)) for k, v in slow.items()}
    return {"microphone": ChannelData(spec, 0.0, counts), **channels}


def bench_evaluation() -> None:
    cfg = SquealDetection()
    for name, noise_db in (("evaluate, background 50 dB", 50.0), ("evaluate, deafening noise 110 dB", 110.0)):
        channels = braking(noise_db)
        found = evaluate(channels, friction=FrictionGeometry(), detection=cfg)
        error = f"{len(found.events)} events"
        if len(found.events) == 1:
            event = found.events[0]
            error = f"tone: {event.frequency_hz - F_HZ:+.3f} Hz, {event.level_db - LEVEL_DB:+.3f} dB"
        line(
            name,
            best_ms(lambda c=channels: evaluate(c, friction=FrictionGeometry(), detection=cfg)),
            None,
            error,
        )


def bench_spectra() -> None:
    counts = braking()["microphone"].samples
    cfg = SquealDetection()
    stft = signal.ShortTimeFFT(hann(4096).astype(float), 2048, RATE_HZ, scale_to="magnitude")
    x = counts.astype(np.float32)
    mine = spectrogram(counts, RATE_HZ)
    theirs = 2 * np.abs(stft.stft(x, p0=1, p1=1 + mine.power.shape[0], k_offset=0)) ** 2
    difference = np.abs(mine.power[:, 1:-1].T - theirs[1:-1]).max() / theirs.max()
    peer = best_ms(lambda: np.abs(stft.stft(x)) ** 2)
    line(
        "spectrogram 4096/2048 (scipy ShortTimeFFT)",
        best_ms(lambda: spectrogram(counts, RATE_HZ)),
        peer,
        f"{difference:.1e}",
    )
    loud = spectrogram(counts, RATE_HZ, scale=200 / 32768 / 20)
    peer = best_ms(lambda: median_filter(loud.power, size=(1, 101)), 1)
    detect = best_ms(lambda: detect_squeal(loud, cfg, window_s=(0.5, 11.5)))
    line("detection (running median of all lines)", detect, peer, "the same median, at candidates only")


def bench_levels() -> None:
    counts = braking()["microphone"].samples
    x = counts * (200 / 32768 / 20)
    alpha = -np.expm1(-1 / (RATE_HZ * 0.125))

    def with_lfilter() -> tuple[float, float]:
        centred = x - x.mean()
        course = signal.lfilter([alpha], [1, alpha - 1], centred**2)
        return float(np.mean(centred**2)), float(course.max())

    leq_db, lmax_db = leq_and_lmax_db(counts, RATE_HZ, scale=200 / 32768 / 20)
    errors = [a - 10 * np.log10(b / 4e-10) for a, b in zip((leq_db, lmax_db), with_lfilter(), strict=True)]
    line(
        "Leq and LFmax (scipy lfilter)",
        best_ms(lambda: leq_and_lmax_db(counts, RATE_HZ, scale=200 / 32768 / 20)),
        best_ms(with_lfilter),
        f"{max(map(abs, errors)):.1e} dB",
    )
    t = np.arange(2 * RATE_HZ) / RATE_HZ
    worst = 0.0
    for f_hz in (100.0, 1000.0, 5000.0, 12500.0, 16000.0):
        tone = np.sin(2 * np.pi * f_hz * t)
        gain = np.std(apply_weighting(tone, RATE_HZ, "A")[20000:60000]) / np.std(tone[20000:60000])
        worst = max(worst, abs(20 * np.log10(gain) - float(weighting_db(f_hz, "A"))))
    line(
        "A weighting of 12 s",
        best_ms(lambda: apply_weighting(x, RATE_HZ, "A")),
        None,
        f"{worst:.1e} dB to 16 kHz",
    )


def bench_decimation() -> None:
    x = np.random.default_rng(1).standard_normal(SECONDS * 4000).astype(np.float32)
    filt = design_decimation(4)
    padded = np.pad(x.astype(float), filt.delay, mode="reflect")
    full = np.convolve(padded, filt.taps, mode="valid")[::4]
    error = f"{np.abs(decimate(x, 4) - full).max():.1e} (float32)"
    peer = best_ms(lambda: signal.upfirdn(filt.taps, padded, 1, 4))
    line("decimate 12 s, 4 kHz -> 1 kHz (scipy upfirdn)", best_ms(lambda: decimate(x, 4)), peer, error)

    def stream() -> np.ndarray:
        decimator = StreamingDecimator(4)
        return np.concatenate([*(decimator.push(b) for b in np.split(x, SECONDS * 20)), decimator.flush()])

    same = "equal bit for bit" if np.array_equal(stream(), decimate(x, 4)) else "DIFFERS"
    line("the same as a stream of 50 ms blocks", best_ms(stream), None, same)
    print(
        f"    {filt.taps.size} taps, ripple {filt.ripple_db:.1e} dB, attenuation {filt.attenuation_db:.1f} dB"
    )


if __name__ == "__main__":
    start = time.perf_counter()
    warm_up()
    print(f"warm-up {time.perf_counter() - start:.2f} s")
    bench_evaluation()
    bench_spectra()
    bench_levels()
    bench_decimation()
