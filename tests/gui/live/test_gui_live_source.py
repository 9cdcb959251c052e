"""The source: announced ranges become samples with their time; late sound, losses, new rings are survived."""

from pathlib import Path

import numpy as np
import pytest

from rigctl.core.channels import ChannelSpec
from rigctl.core.ring import RING_NAME, SampleRing
from rigctl.gui.live.buffer import LiveBuffer
from rigctl.gui.live.source import LiveSource

SPECS = [
    ChannelSpec("microphone", "Pa", 4000.0, "int16", scale=0.5),
    ChannelSpec("pressure", "bar", 400.0),
]
DT_NS = 50_000_000


class Rig:
    """Writes blocks as an acquisition does; the sound can be held back."""

    def __init__(self, folder: Path, seconds: float = 4.0) -> None:
        self.ring = SampleRing.create(folder / RING_NAME, SPECS, seconds)
        self.k = 0
        self.sound = 0
        self.held: list[np.ndarray] = []

    def block(self, *, stride: int = 1, sound: bool = True, late: bool = False) -> dict:
        t_ns, self.k = self.k * DT_NS, self.k + 1
        n = 20 // stride
        values = (t_ns * 1e-9 + np.arange(n) * stride / 400.0).astype(np.float32)  # each sample is its time
        ranges = {"pressure": self.ring.write("pressure", values)}
        size = 200 if sound else 0
        ranges["microphone"] = (self.sound, self.sound + size)
        self.sound += size
        if sound:
            counts = np.arange(self.sound - size, self.sound).astype(np.int16)
            self.held.append(counts)
            if not late:
                self.release()
        return {"t_ns": t_ns, "dt_ns": DT_NS, "stride": stride, "ranges": ranges}

    def release(self, samples: int = 1 << 30) -> None:
        counts = np.concatenate(self.held)
        self.ring.write("microphone", counts[:samples])
        self.held = [counts[samples:]]


def _by_name(stretches):
    found: dict[str, list] = {}
    for stretch in stretches:
        found.setdefault(stretch.name, []).append(stretch)
    return found


def test_blocks_become_joined_physical_samples(tmp_path):
    rig, source = Rig(tmp_path), LiveSource(tmp_path)
    source.announce([rig.block() for _ in range(3)])
    assert source.end_s == pytest.approx(0.15)
    found = _by_name(source.take())
    (pressure,), (sound,) = found["pressure"], found["microphone"]
    np.testing.assert_allclose(pressure.samples, np.arange(60) / 400.0, atol=1e-6)
    np.testing.assert_array_equal(sound.samples, np.arange(600) * 0.5)
    assert (sound.t_s, sound.stride) == (0.0, 1)
    assert source.take() == []
    source.close()


def test_late_sound_is_taken_when_it_is_there(tmp_path):
    rig, source = Rig(tmp_path), LiveSource(tmp_path)
    source.announce([rig.block(late=True), rig.block(late=True)])
    assert set(_by_name(source.take())) == {"pressure"}
    rig.release(150)
    (first,) = source.take()
    rig.release()
    (second,) = source.take()
    assert first.t_s == 0.0 and len(first.samples) == 150
    assert second.t_s == pytest.approx(150 / 4000.0) and len(second.samples) == 250
    np.testing.assert_array_equal(np.concatenate([first.samples, second.samples]), np.arange(400) * 0.5)


def test_strided_blocks_without_sound(tmp_path):
    rig, source, buffer = Rig(tmp_path), LiveSource(tmp_path), LiveBuffer(SPECS)
    source.announce([rig.block()])
    buffer.feed(source.take())
    source.announce([rig.block(stride=10, sound=False) for _ in range(4)])
    stretches = source.take()
    assert [(s.name, s.stride, len(s.samples)) for s in stretches] == [("pressure", 10, 8)]
    buffer.feed(stretches)
    source.announce([rig.block()])
    buffer.feed(source.take())
    sound, pressure = buffer.channels["microphone"], buffer.channels["pressure"]
    assert sound.end_s == pressure.end_s == pytest.approx(0.3)
    assert sound.extremes(0.051, 0.249) is None  # a gap, not zero
    assert not np.isnan(pressure.envelope(0.0, 0.299, 1000).low).any()
    assert pressure.value(0.1) == pytest.approx(0.1, abs=1e-6)


def test_overwritten_samples_leave_a_gap(tmp_path):
    rig, source, buffer = Rig(tmp_path, seconds=1.0), LiveSource(tmp_path), LiveBuffer(SPECS)
    source.announce([rig.block()])
    buffer.feed(source.take())
    blocks = [rig.block() for _ in range(60)]  # 3 s into a ring of 1 s
    source.announce(blocks)
    buffer.feed(source.take())
    pressure = buffer.channels["pressure"]
    assert pressure.end_s == pytest.approx(3.05)
    assert pressure.extremes(0.06, 2.0) is None
    for t_s in (0.02, 2.2, 3.0):
        assert pressure.value(t_s) == pytest.approx(t_s, abs=2e-3)


def test_ring_that_comes_later_goes_and_comes_anew(tmp_path):
    source = LiveSource(tmp_path)
    first = {"pressure": (0, 20), "microphone": (0, 200)}
    source.announce([{"t_ns": 0, "dt_ns": DT_NS, "stride": 1, "ranges": first}])
    assert source.take() == [] and source.specs == {} and source.generation == 0
    (tmp_path / RING_NAME).write_bytes(b"not yet a ring")
    assert source.take() == []
    (tmp_path / RING_NAME).unlink()
    rig = Rig(tmp_path)
    rig.block(late=True)
    assert len(source.take()) == 1 and source.generation == 1
    assert set(source.specs) == {"microphone", "pressure"}
    rig.ring.path.unlink()  # the rig closes; the map stays readable
    rig.release()
    assert [(s.name, len(s.samples)) for s in source.take()] == [("microphone", 200)]
    again = Rig(tmp_path)
    source.announce([again.block()])
    assert len(_by_name(source.take())["pressure"][0].samples) == 20
    assert source.generation == 2
    source.close()


def test_announcements_without_samples_are_forgotten(tmp_path):
    rig, source = Rig(tmp_path), LiveSource(tmp_path, history_s=1.0)
    for k in range(400):  # with pauses between, so that they cannot be joined
        source.announce([rig.block(late=True), rig.block(sound=False)])
        source.take()
        assert len(source._pending["microphone"]) <= 12, k
    source.close()


def test_the_window_cannot_write(tmp_path):
    rig, source = Rig(tmp_path), LiveSource(tmp_path)
    source.announce([rig.block()])
    source.take()
    with pytest.raises(ValueError, match="read-only"):
        source._ring.write("pressure", np.zeros(1, np.float32))
