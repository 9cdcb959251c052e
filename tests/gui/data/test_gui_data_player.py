"""Listening: with an output, without one, and what the sound is made of."""

import sys
import types

import numpy as np
import pytest

from rigctl.analysis.viewing import listenable, view_braking
from rigctl.core.errors import DeviceError
from rigctl.gui.pages.data.player import Player, find_output


class PortAudioError(Exception):
    """As sounddevice's."""


def output(rate_hz=48_000.0, *, devices=True, refuses=False):
    """A module in the place of sounddevice: one output of one rate, or none."""
    module = types.ModuleType("sounddevice")
    module.streams = []

    def query(kind):
        if not devices:
            raise PortAudioError("no device")
        return {"default_samplerate": rate_hz}

    def check(*, channels, dtype, samplerate):
        if samplerate != rate_hz:
            raise PortAudioError("invalid sample rate")

    class Stream:
        def __init__(self, *, samplerate, channels, dtype, callback, latency):
            if refuses:
                raise PortAudioError("busy")
            self.samplerate, self.callback, self.closed = samplerate, callback, False
            module.streams.append(self)

        def start(self):
            self.block = np.ones((512, 1), np.float32)
            self.callback(self.block, 512, None, None)

        def close(self):
            self.closed = True

    module.PortAudioError, module.OutputStream = PortAudioError, Stream
    module.query_devices, module.check_output_settings = query, check
    return module


def test_no_output_is_said_in_words(opened, qtbot, monkeypatch):
    monkeypatch.setitem(sys.modules, "sounddevice", output(devices=False))
    opened.table.choose(["brakings/00002.h5"])
    sound = opened.braking.sound
    qtbot.waitUntil(sound.play.isEnabled, timeout=20_000)
    sound.play.click()
    qtbot.waitUntil(lambda: "no sound output" in sound.words.text(), timeout=20_000)
    assert "WAV" in sound.words.text() and "Play" in sound.play.text().replace("&", "")


def test_a_missing_library_is_said_in_words(monkeypatch):
    class Missing:
        def find_spec(self, name, path=None, target=None):
            if name == "sounddevice":
                raise OSError("PortAudio library not found")

    monkeypatch.delitem(sys.modules, "sounddevice", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Missing(), *sys.meta_path])
    with pytest.raises(DeviceError, match="PortAudio is missing"):
        find_output(40_000.0, None)


def test_it_plays_at_the_rate_of_the_output_and_stops_when_the_page_is_left(opened, qtbot, monkeypatch):
    module = output(48_000.0)
    monkeypatch.setitem(sys.modules, "sounddevice", module)
    opened.table.choose(["brakings/00002.h5"])
    sound = opened.braking.sound
    qtbot.waitUntil(sound.play.isEnabled, timeout=20_000)
    with qtbot.waitSignal(sound.player.position, timeout=20_000):
        sound.play.click()
    (stream,) = module.streams
    assert stream.samplerate == 48_000.0 and abs(stream.block).max() <= 1.0
    assert "Stop" in sound.play.text().replace("&", "") and "Louder by" in sound.words.text()
    opened.deactivated()
    assert stream.closed and not sound.player.busy


def test_an_output_that_refuses_is_said_in_words(shared_work, made, qtbot, monkeypatch):
    monkeypatch.setitem(sys.modules, "sounddevice", output(40_000.0, refuses=True))
    player = Player(shared_work)
    with qtbot.waitSignal(player.failed, timeout=20_000) as failed:
        player.play(made / "brakings" / "00002.h5", True, 40_000.0)
    assert "cannot be used (busy)" in failed.args[0] and not player.busy


def test_equal_loudness_makes_quiet_and_loud_brakings_alike(made):
    quiet, loud = (listenable(made / "brakings" / f"0000{n}.h5") for n in (1, 2))
    assert quiet.gain_db > loud.gain_db + 10
    for sound in (quiet, loud):
        assert abs(sound.samples).max() <= 1.0
        assert abs(sound.samples[0]) < 1e-3 and abs(sound.samples[-1]) < 1e-3, "faded"
    fixed = [listenable(made / "brakings" / f"0000{n}.h5", equal_loudness=False) for n in (1, 2)]
    assert [s.gain_db for s in fixed] == [0.0, 0.0]
    faster = listenable(made / "brakings" / "00002.h5", rate_hz=48_000.0)
    assert len(faster.samples) == pytest.approx(len(loud.samples) * 1.2, abs=2)
    with pytest.raises(LookupError, match="without sound"):
        listenable(made / "brakings" / "00006.h5")


def test_a_view_holds_the_squeal_where_it_was(made):
    view = view_braking(made / "brakings" / "00002.h5")
    assert view.picture is not None and view.spectrum is not None
    time = view.picture.t0_s + np.arange(view.picture.level_db.shape[0]) * view.picture.dt_s
    line = round(2350.0 / view.picture.line_hz)
    loud = view.picture.level_db[(time > 1.2) & (time < 2.1), line]
    assert loud.min() > 85 and view.picture.level_db[time < 0.8, line].max() < 70
    assert view.spectrum.frequency_hz()[view.spectrum.peak_db.argmax()] == pytest.approx(2350, abs=15)
    level = view.curves["level"]
    assert level.values[(level.time_s() > 1.7) & (level.time_s() < 2.2)].mean() == pytest.approx(92, abs=1)
    assert np.nanmedian(view.curves["mu"].values) == pytest.approx(0.42, abs=0.02)
    assert "microphone" not in view_braking(view.path, waveform=False).curves
