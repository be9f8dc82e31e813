"""Checkpoints: complete and exact, or refused."""

import os
from typing import NamedTuple

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas.base import InputError
from roughgas.simulation.checkpoint import read, restore, save
from roughgas.simulation.state_encoding import UnusableCheckpoint, arrays_of

SCENES = {
    "gas": settings("gas", 40, [25, 25]),
    "sheared": settings("sheared", 40, [25, 25]),
    "bed": settings("bed", 40, [12.5, "open"]),
    "sheared gas in cells": settings("sheared", 800, [80, 80]),
}
RECORD = {"time": np.linspace(0.0, 1.0, 3), "count": np.arange(4, dtype=np.uint16)}


STATE = {"state.key": np.full(5, 2.0), "state.plain": np.arange(4.0)}
CONTENT = STATE | {f"record.{name}": array for name, array in RECORD.items()}


class Arrays(NamedTuple):
    """Arrays that `save` takes in place of a state."""

    key: np.ndarray
    plain: np.ndarray


def save_checkpoint(path):
    save(path, "me", Arrays(*STATE.values()), RECORD)


def is_complete(arrays):
    return list(arrays) == list(CONTENT) and all(
        np.array_equal(arrays[name], array) for name, array in CONTENT.items()
    )


def content(state):
    return {name: array.tobytes() for name, array in arrays_of(state)}


def gas_after_collisions(name, samples):
    scene, state = begin(SCENES[name], 0.9, 0.3, 4)
    run(state, scene, samples, collisions=100)
    return scene, state


def test_every_array_comes_back_and_shares_memory_as_before(tmp_path):
    scene, state = gas_after_collisions("gas", 4)
    save(tmp_path / "new" / "c.npz", "me", state, RECORD)
    _, restored = begin(SCENES["gas"], 0.9, 0.3, 5)
    record = restore(tmp_path / "new" / "c.npz", "me", restored, scene)
    assert content(restored) == content(state)
    assert np.shares_memory(restored.agenda.key, restored.queue.keys)
    for name, array in RECORD.items():
        assert record[name].dtype == array.dtype and np.array_equal(record[name], array)
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["c.npz"]


@pytest.mark.parametrize("name", SCENES)
def test_a_restored_run_goes_on_with_the_same_bits(tmp_path, name):
    scene, undisturbed = gas_after_collisions(name, 4)
    assert (undisturbed.cells is not None) == (name == "sheared gas in cells")
    save(tmp_path / "c.npz", "me", undisturbed, {})
    _, again = begin(SCENES[name], 0.9, 0.3, 5)  # another seed: all of it must be overwritten
    restore(tmp_path / "c.npz", "me", again, scene)
    assert content(again) == content(undisturbed)
    rows = [run(state, scene, 6, collisions=100) for state in (undisturbed, again)]
    assert content(again) == content(undisturbed)
    for column, values in rows[0].items():
        assert values.tobytes() == rows[1][column].tobytes(), column


def test_a_checkpoint_of_another_run_is_refused_and_changes_nothing(tmp_path):
    scene, state = gas_after_collisions("gas", 1)
    save(tmp_path / "c.npz", "me", state, RECORD)
    _, unrestored = begin(SCENES["gas"], 0.9, 0.3, 5)
    before = content(unrestored)
    with pytest.raises(UnusableCheckpoint, match="other settings"):
        restore(tmp_path / "c.npz", "you", unrestored, scene)
    assert content(unrestored) == before


def test_another_kind_of_state_is_refused_and_changes_nothing(tmp_path):
    _, state = gas_after_collisions("gas", 1)
    save(tmp_path / "c.npz", "me", state, {})
    for other_settings in (settings("gas", 41, [25, 25]), SCENES["bed"]):
        scene, unrestored = begin(other_settings, 0.9, 0.3)
        before = content(unrestored)
        with pytest.raises(UnusableCheckpoint, match="another kind of state"):
            restore(tmp_path / "c.npz", "me", unrestored, scene)
        assert content(unrestored) == before


def test_a_forged_state_with_a_right_checksum_is_refused(tmp_path):
    scene, state = gas_after_collisions("gas", 1)
    state.agenda.slot_partner[0] = 2**30
    save(tmp_path / "c.npz", "me", state, {})
    _, unrestored = begin(SCENES["gas"], 0.9, 0.3)
    with pytest.raises(UnusableCheckpoint, match=r"reaches: agenda\.slot_partner is out of"):
        restore(tmp_path / "c.npz", "me", unrestored, scene)


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.99])
def test_a_truncated_checkpoint_is_refused(tmp_path, share):
    path = tmp_path / "c.npz"
    save_checkpoint(path)
    intact = path.read_bytes()
    path.write_bytes(intact[: int(share * len(intact))])
    with pytest.raises(UnusableCheckpoint, match="is damaged"):
        read(path, "me")


def test_a_flipped_byte_is_noticed_or_harmless(tmp_path):
    """Bytes of dates and similar entries are harmless."""
    path, refused = tmp_path / "c.npz", 0
    save_checkpoint(path)
    intact = path.read_bytes()
    indices = range(0, len(intact), 7)
    for index in indices:
        path.write_bytes(intact[:index] + bytes([intact[index] ^ 0x55]) + intact[index + 1 :])
        try:
            assert is_complete(read(path, "me"))
        except UnusableCheckpoint:
            refused += 1
    assert refused > 0.5 * len(indices)


@pytest.mark.parametrize("kind", ["folder", "pipe", "device"])
def test_folders_pipes_and_devices_are_refused_at_once(tmp_path, kind):
    """A pipe would be waited for, and a device fill the memory."""
    path = tmp_path / "c.npz"
    makers = {"folder": path.mkdir, "pipe": lambda: os.mkfifo(path)}
    makers.get(kind, lambda: path.symlink_to("/dev/zero"))()
    with pytest.raises(InputError, match=r"^checkpoint = .*c\.npz: must be a file$"):
        read(path, "me")


def edit_checkpoint(path, change):
    """Rewrite a checkpoint without a new checksum, as another program would."""
    with np.load(path) as archive:
        content = dict(archive)
    change(content)
    with path.open("wb") as file:
        np.savez(file, **content)


CHANGES = {
    "value": lambda content: content["state.plain"].__setitem__(0, 3.0),
    "type": lambda content: content.update({"state.plain": content["state.plain"].astype(int)}),
    "removed": lambda content: content.pop("record.time"),
    "renamed": lambda content: content.update({"state.x": content.pop("state.plain")}),
    "owner": lambda content: content.update({"belongs to": np.array(["me", "you"])}),
    "unsealed": lambda content: content.pop("sha256"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_an_edited_checkpoint_is_refused(tmp_path, change):
    path = tmp_path / "c.npz"
    save_checkpoint(path)
    edit_checkpoint(path, CHANGES[change])
    with pytest.raises(UnusableCheckpoint, match="is damaged"):
        read(path, "me")


def test_an_archive_that_unpacks_to_more_than_it_is_long_is_not_unpacked(tmp_path):
    path = tmp_path / "c.npz"
    with path.open("wb") as file:
        np.savez_compressed(file, **{"state.plain": np.zeros(10**6)})
    with pytest.raises(UnusableCheckpoint, match="is damaged"):
        read(path, "me")
