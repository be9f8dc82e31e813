"""Snapshots of a point lie on its trajectory, and angles of disks are integrals of their spins."""

import numpy as np
import pytest
from brute_force import kernels, scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from raw import build, initial_state, snapshots
from schedules import COOLING, STEADY

from roughgas.simulation.gas import Gas
from roughgas.simulation.trajectory import Take

R, BETA, SEED = 0.9, 0.3, 7
TOLERANCE = 1e-9
DRIVEN = {
    "bed": settings("bed", 16, [10, "open"]),
    "sheared": settings("sheared", 16, [12, 12]),
    "shaken": settings("shaken", 16, [12, 12]),
    "heated, smooth": settings("heated, smooth", 16, [12, 12]),
}


def start_of(scene, experiment):
    """The initial state of an experiment."""
    return initial_state(scene, experiment, np.random.default_rng(SEED))


def test_frames_of_a_cooling_gas_are_equally_spaced_in_scaled_time():
    experiment = settings("gas", 20, [30, 30]) | {"schedule": COOLING}
    shots = list(snapshots(build(experiment, R, BETA), experiment, SEED, Take(0.0, 60.0, 240)))
    speed = np.sqrt([shot.E_trans for shot in shots])
    intervals = np.diff([shot.time for shot in shots])
    assert intervals[-1] > 4 * intervals[0]
    assert intervals * speed[:-1] == pytest.approx(intervals[0] * speed[0])
    assert shots[-1].collisions == pytest.approx(60, rel=0.2)


def turned_until(brute, time):
    """Angles by which disks turn while the brute force advances to an instant, event by event."""
    angle, event = np.zeros(brute.number), True
    while event is not None:
        begun, spin = brute.time, brute.w[:, 2].copy()
        event = brute.step(time)
        angle += spin * (brute.time - begun)
    return angle


@pytest.mark.parametrize("name", kernels("bed", "sheared", "shaken"))
def test_positions_and_angles_are_those_of_the_brute_force(name):
    experiment = DRIVEN[name] | {"schedule": STEADY}
    scene, world = scene_of(experiment, R, BETA)
    brute = brute_force_from(world, snapshot(start_of(scene, experiment), scene))
    angle = 0.0
    for shot in snapshots(build(experiment, R, BETA), experiment, SEED, Take(0.0, 1.5, 12)):
        angle += turned_until(brute, shot.time)
        distances = [np.abs(shot.position - brute.x + s).max(axis=1) for s in brute.images()[0]]
        assert np.min(distances, axis=0).max() < TOLERANCE
        assert shot.spin[:, 0] == pytest.approx(brute.w[:, 2], abs=TOLERANCE)
        assert shot.angle == pytest.approx(angle, abs=TOLERANCE)
        if world.floor:
            assert shot.floor == pytest.approx(brute.surface(0.0)[0], abs=TOLERANCE)
        for axis, length in enumerate(scene.box):
            if length is not None:
                assert np.all((shot.position[:, axis] >= 0) & (shot.position[:, axis] <= length))
    assert np.abs(angle).max() > 0.5


@pytest.mark.slow
def test_frames_of_a_layer_of_spheres_take_one_step_each(monkeypatch):
    """Angles are not needed there; the same positions as with a step per collision, to rounding."""
    experiment = settings("layer", 24, [8, 9, "open"]) | {"schedule": STEADY | {"period": 2.0}}
    scene, steps, step = build(experiment, R, BETA), [], Gas.step_sampling
    monkeypatch.setattr(
        Gas, "step_sampling", lambda *arguments: steps.append(arguments) or step(*arguments)
    )

    def filmed():
        steps.clear()
        return list(snapshots(scene, experiment, SEED, Take(0.0, 6.0, 6))), len(steps)

    shots, step_count = filmed()
    monkeypatch.setattr("roughgas.simulation.films.DRIVEN_STEP", 0.0)
    references, step_count_of_collisions = filmed()
    assert step_count == 6 and step_count_of_collisions > 10 * step_count
    for shot, reference in zip(shots, references, strict=True):
        assert shot.position == pytest.approx(reference.position, abs=TOLERANCE)


@pytest.mark.slow
def test_many_particles_keep_their_labels():
    """Positions and angles do not jump when cells sort the particles anew in memory."""
    experiment = settings("sheared", 900, [80, 80]) | {"schedule": STEADY}
    shots = list(snapshots(build(experiment, R, 1.0), experiment, SEED, Take(0.0, 10.0, 300)))
    risen = np.diff([shot.position[:, 1] for shot in shots], axis=0)
    assert np.abs(risen - 80 * np.round(risen / 80)).max() < 3.0
    turned = np.diff([shot.angle for shot in shots], axis=0)
    spins = np.array([shot.spin[:, 0] for shot in shots])
    intervals = np.diff([shot.time for shot in shots])[:, None]
    undisturbed = spins[1:] == spins[:-1]  # particles without a contact
    assert undisturbed.mean() > 0.9
    assert turned[undisturbed] == pytest.approx((spins[:-1] * intervals)[undisturbed], abs=1e-12)


@pytest.mark.slow
def test_disks_of_a_cooling_gas_turn_as_far_as_they_spin_whatever_its_units_are():
    """Refreshing changes the units of times and of spins, here by 2^-6 or more."""
    experiment = settings("gas", 40, [30, 30]) | {"schedule": COOLING}
    scene = build(experiment, 0.5, 0.0)
    shots = list(snapshots(scene, experiment, SEED, Take(0.0, 40.0, 1200)))
    assert shots[-1].E_trans < 2.0**-12 * shots[0].E_trans
    turned = np.diff([shot.angle for shot in shots], axis=0)
    spins = np.array([shot.spin[:, 0] for shot in shots])
    intervals = np.diff([shot.time for shot in shots])[:, None]
    undisturbed = spins[1:] == spins[:-1]
    assert undisturbed.mean() > 0.9
    expected = (spins[:-1] * intervals)[undisturbed]
    assert turned[undisturbed] == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert np.abs(expected).max() > 1e-3
