"""The generator of the sound's noise: the published sequence, moments, independence of pads and of times."""

import numpy as np
import pytest

from sim_hardware.plant.sound import _roughness

#: first outputs of xoshiro256++ from the state 1, 2, 3, 4 (test vector of its published implementations)
PUBLISHED = (41943041, 58720359, 3588806011781223, 3591011842654386, 9228616714210784205)


def halves(bits):
    """What both pads get from 64 bits: upper and lower half as signed parts of one."""
    return [
        int(np.array(half, np.uint32).astype(np.int32)) / 2**32 for half in (bits >> 32, bits & 0xFFFFFFFF)
    ]


def test_noise_is_the_published_sequence():
    state = np.array([1, 2, 3, 4], np.uint64)
    force = np.empty((len(PUBLISHED), 2))
    _roughness(state, 1.0, force)
    assert force.tolist() == [halves(bits) for bits in PUBLISHED]


@pytest.mark.parametrize("pads", [1, 2, 3])
def test_noise_is_uniform_and_independent(pads):
    state = np.random.default_rng(1).integers(1, 2**64, 4, dtype=np.uint64)
    force = np.empty((200_000, pads))
    _roughness(state, np.sqrt(12.0), force)
    assert np.abs(force).max() <= np.sqrt(3.0)
    assert force.mean(axis=0) == pytest.approx(0.0, abs=0.01)
    assert force.std(axis=0) == pytest.approx(1.0, abs=0.01)
    columns = [*force[:-1].T, *force[1:].T]
    correlation = np.corrcoef(columns) - np.eye(2 * pads)
    assert np.abs(correlation).max() < 0.015


def test_noise_goes_on_where_it_stopped():
    first, second = np.array([1, 2, 3, 4], np.uint64), np.array([1, 2, 3, 4], np.uint64)
    whole, parts = np.empty((100, 2)), np.empty((100, 2))
    _roughness(first, 1.0, whole)
    _roughness(second, 1.0, parts[:37])
    _roughness(second, 1.0, parts[37:])
    assert np.array_equal(whole, parts) and np.array_equal(first, second)
