"""Checkpoints: complete, exact, and refused where they would not be."""

from typing import NamedTuple

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas.simulation.restart import UnusableCheckpoint, arrays_of, restore, save

SCENES = {
    "gas": settings("gas", 40, [25, 25]),
    "sheared": settings("sheared", 40, [25, 25]),
    "bed": settings("bed", 40, [12.5, "open"]),
    "sheared gas in cells": settings("sheared", 800, [80, 80]),
}
RECORD = {"time": np.linspace(0.0, 1.0, 3), "count": np.arange(4, dtype=np.uint16)}


class Inner(NamedTuple):
    key: np.ndarray
    bits: np.ndarray


class Outer(NamedTuple):
    plain: np.ndarray
    strided: np.ndarray
    absent: np.ndarray | None
    number: int
    sizes: tuple[int, ...]
    inner: Inner


def nested(value):
    """A state whose arrays partly share memory, as the kernel's do."""
    table, key = np.full((4, 3), float(value)), np.full(5, float(value))
    return Outer(table[:, 0], table[:, 1:].T, None, 7, (4, 3), Inner(key, key.view(np.int64)))


def content(state):
    return {name: array.tobytes() for name, array in arrays_of(state)}


def at_collision(name, samples):
    scene, state = begin(SCENES[name], 0.9, 0.3, 4)
    run(state, scene, samples, collisions=100)
    return scene, state


def test_every_array_comes_back_and_shares_memory_as_before(tmp_path):
    state = nested(2.0)
    state.inner.key[3] = -0.0
    save(tmp_path / "new" / "c.npz", "me", state, RECORD)
    other = nested(1.0)
    record = restore(tmp_path / "new" / "c.npz", "me", other)
    assert content(other) == content(state)
    assert np.shares_memory(other.inner.key, other.inner.bits)
    assert np.shares_memory(other.plain.base, other.strided)
    for name, array in RECORD.items():
        assert record[name].dtype == array.dtype and np.array_equal(record[name], array)
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["c.npz"]


@pytest.mark.parametrize("name", SCENES)
def test_a_restored_run_goes_on_with_the_same_bits(tmp_path, name):
    scene, undisturbed = at_collision(name, 4)
    assert (undisturbed.cells is not None) == (name == "sheared gas in cells")
    save(tmp_path / "c.npz", "me", undisturbed, {})
    _, again = begin(SCENES[name], 0.9, 0.3, 5)  # another seed: all of it must be overwritten
    restore(tmp_path / "c.npz", "me", again)
    assert content(again) == content(undisturbed)
    rows = [run(state, scene, 6, collisions=100) for state in (undisturbed, again)]
    assert content(again) == content(undisturbed)
    for column, values in rows[0].items():
        assert values.tobytes() == rows[1][column].tobytes(), column


def test_what_belongs_to_another_run_is_refused_and_changes_nothing(tmp_path):
    save(tmp_path / "c.npz", "me", nested(2.0), RECORD)
    state = nested(1.0)
    with pytest.raises(UnusableCheckpoint, match="other settings"):
        restore(tmp_path / "c.npz", "you", state)
    assert content(state) == content(nested(1.0))


def test_another_kind_of_state_is_refused_and_changes_nothing(tmp_path):
    _, state = at_collision("gas", 1)
    save(tmp_path / "c.npz", "me", state, {})
    for other in (begin(settings("gas", 41, [25, 25]), 0.9, 0.3)[1], nested(1.0)):
        before = content(other)
        with pytest.raises(UnusableCheckpoint, match="another kind of state"):
            restore(tmp_path / "c.npz", "me", other)
        assert content(other) == before


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.99])
def test_a_truncated_checkpoint_is_refused(tmp_path, share):
    path = tmp_path / "c.npz"
    save(path, "me", nested(2.0), RECORD)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(UnusableCheckpoint, match="is damaged"):
        restore(path, "me", nested(1.0))


def test_a_flipped_byte_is_noticed_or_harmless(tmp_path):
    """Harmless are those that stand for dates and the like."""
    path, refused = tmp_path / "c.npz", 0
    save(path, "me", nested(2.0), RECORD)
    whole = path.read_bytes()
    places = range(0, len(whole), 7)
    for place in places:
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        state = nested(1.0)
        try:
            restore(path, "me", state)
            assert content(state) == content(nested(2.0))
        except UnusableCheckpoint:
            refused += 1
            assert content(state) == content(nested(1.0))
    assert refused > 0.5 * len(places)
