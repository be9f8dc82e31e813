"""Snapshots of a point: they lie on its trajectory, and disks have turned as far as they spun."""

import numpy as np
import pytest
from brute_force import scene_of, settings, snapshot
from brute_force.beside import brute_force_from
from schedules import COOLING, STEADY

from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.simulation import trajectory
from roughgas.simulation.gas import Gas
from roughgas.simulation.trajectory import Frames, snapshots

R, BETA, SEED = 0.9, 0.3, 7
TINY = 1e-9
DRIVEN = {
    "bed": settings("bed", 16, [10, "open"]),
    "sheared": settings("sheared", 16, [12, 12]),
    "shaken": settings("shaken", 16, [12, 12]),
    "heated, smooth": settings("heated, smooth", 16, [12, 12]),
}


def start_of(scene, experiment):
    return initial_state(scene, experiment, np.random.default_rng(SEED))


def test_frames_of_a_cooling_gas_are_equally_spaced_in_scaled_time():
    experiment = settings("gas", 20, [30, 30]) | {"schedule": COOLING}
    shots = list(snapshots(build(experiment, R, BETA), experiment, SEED, Frames(0.0, 60.0, 240)))
    speed = np.sqrt([shot.E_trans for shot in shots])
    intervals = np.diff([shot.time for shot in shots])
    assert intervals[-1] > 4 * intervals[0]
    assert intervals * speed[:-1] == pytest.approx(intervals[0] * speed[0])
    assert shots[-1].collisions == pytest.approx(60, rel=0.2)


def turned_until(brute, time):
    """Angles by which disks turn while the brute force goes on to an instant, event by event."""
    angle, event = np.zeros(brute.number), True
    while event is not None:
        begun, spin = brute.time, brute.w[:, 2].copy()
        event = brute.step(time)
        angle += spin * (brute.time - begun)
    return angle


@pytest.mark.parametrize("name", ["bed", "sheared", "shaken"])
def test_particles_are_where_brute_force_has_them_and_have_turned_as_far(name):
    experiment = DRIVEN[name] | {"schedule": STEADY}
    scene, world = scene_of(experiment, R, BETA)
    brute = brute_force_from(world, snapshot(start_of(scene, experiment), scene))
    angle = 0.0
    for shot in snapshots(build(experiment, R, BETA), experiment, SEED, Frames(0.0, 1.5, 12)):
        angle += turned_until(brute, shot.time)
        apart = [np.abs(shot.position - brute.x + s).max(axis=1) for s in brute.images()[0]]
        assert np.min(apart, axis=0).max() < TINY
        assert shot.spin[:, 0] == pytest.approx(brute.w[:, 2], abs=TINY)
        assert shot.angle == pytest.approx(angle, abs=TINY)
        if world.floor:
            assert shot.floor == pytest.approx(brute.surface(0.0)[0], abs=TINY)
        for axis, length in enumerate(scene.box):
            if length is not None:
                assert np.all((shot.position[:, axis] >= 0) & (shot.position[:, axis] <= length))
    assert np.abs(angle).max() > 0.5


def test_spheres_of_a_layer_go_from_frame_to_frame_at_once(monkeypatch):
    """One step a frame, where no angles are watched; to roundings as in steps of a collision."""
    experiment = settings("layer", 24, [8, 9, "open"]) | {"schedule": STEADY | {"period": 2.0}}
    scene, steps, step = build(experiment, R, BETA), [], Gas.step
    monkeypatch.setattr(Gas, "step", lambda *given: steps.append(given) or step(*given))

    def filmed():
        steps.clear()
        return list(snapshots(scene, experiment, SEED, Frames(0.0, 6.0, 6))), len(steps)

    shots, made = filmed()
    monkeypatch.setattr(trajectory, "LONG", 0.0)
    slow, many = filmed()
    assert made == 6 and many > 10 * made
    for shot, other in zip(shots, slow, strict=True):
        assert shot.position == pytest.approx(other.position, abs=TINY)


def test_many_particles_keep_their_numbers():
    """They are sorted into cells, hence anew in memory now and then, and turn none the less."""
    experiment = settings("sheared", 900, [80, 80]) | {"schedule": STEADY}
    shots = list(snapshots(build(experiment, R, 1.0), experiment, SEED, Frames(0.0, 10.0, 300)))
    risen = np.diff([shot.position[:, 1] for shot in shots], axis=0)
    assert np.abs(risen - 80 * np.round(risen / 80)).max() < 3.0
    turned = np.diff([shot.angle for shot in shots], axis=0)
    spins = np.array([shot.spin[:, 0] for shot in shots])
    intervals = np.diff([shot.time for shot in shots])[:, None]
    alike = spins[1:] == spins[:-1]  # those that met nobody
    assert alike.mean() > 0.9
    assert turned[alike] == pytest.approx((spins[:-1] * intervals)[alike], abs=1e-12)


def test_disks_of_a_cooling_gas_turn_as_far_as_they_spin_whatever_its_units_are():
    """Refreshing changes the units of times and of spins, here by 2^-6 or more."""
    experiment = settings("gas", 40, [30, 30]) | {"schedule": COOLING}
    scene = build(experiment, 0.5, 0.0)
    shots = list(snapshots(scene, experiment, SEED, Frames(0.0, 40.0, 1200)))
    assert shots[-1].E_trans < 2.0**-12 * shots[0].E_trans
    turned = np.diff([shot.angle for shot in shots], axis=0)
    spins = np.array([shot.spin[:, 0] for shot in shots])
    intervals = np.diff([shot.time for shot in shots])[:, None]
    undisturbed = spins[1:] == spins[:-1]
    assert undisturbed.mean() > 0.9
    expected = (spins[:-1] * intervals)[undisturbed]
    assert turned[undisturbed] == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert np.abs(expected).max() > 1e-3
