"""Motion of floors (sawtooth, sine, triangle) and reflection by walls."""

import numpy as np
import pytest
from brute_force import begin, run, scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from compiled import from_python
from slow_cases import slow_but

from roughgas.base.fields import read_each
from roughgas.effects import EFFECTS, build_effects, motions
from roughgas.effects.motions import Sine, sawtooth, triangle
from roughgas.effects.settings import SceneContext
from roughgas.kernel.hooks import displacement
from roughgas.kernel.layout import new_state


def particle_above_floor(height, velocity, **floor):
    """Scene and state of a particle above a floor."""
    experiment = settings("bed", 1, [10, "open"], floor=floor)
    scene, _ = begin(experiment, 1.0, 0.0)
    position = np.array([[3.0, height]])
    return scene, new_state(scene, position, np.array([velocity]), np.zeros((1, 1)))


time_to_sine = from_python(motions.time_to_sine)
search_sine = from_python(motions.search_sine)


SPIN = read_each(EFFECTS, {"spin": {"inertia": 0.5}}, "effects")


def floor_from_settings(**parameters):
    """The Floor of these settings."""
    stated = {"amplitude": 5, "period": 2, "restitution": "particles", "roughness": 0.5}
    context = SceneContext((50.0, None), 0.9, 0.2, SPIN)
    return build_effects(read_each(EFFECTS, {"floor": stated | parameters}, "effects"), context)[
        "floor"
    ]


def test_the_wave_is_chosen_by_name():
    forms = {
        None: sawtooth(5.0, 2.0),
        "sawtooth": sawtooth(5.0, 2.0),
        "sine": Sine(5.0, 2.0),
        "triangle": triangle(5.0, 2.0, 0.5),
        "reversed_sawtooth": triangle(5.0, 2.0, 0.1),
    }
    for wave, motion in forms.items():
        floor = floor_from_settings(wave=wave)
        assert floor.motion == motion and type(floor.motion) is type(motion)
        assert (floor.restitution, floor.roughness) == (0.9, 0.5)


# each other wave compiles a kernel
FORMS = ("sawtooth", "reversed_sawtooth", "triangle", "sine")
WAVES = slow_but({"sawtooth"}, FORMS)


@pytest.mark.parametrize("wave", WAVES)
def test_a_phase_is_a_start_in_the_middle_of_a_period(wave):
    """The same 200 collisions as of a brute force that starts at the later time."""
    floor = {"amplitude": 1.0, "period": 1.7, "wave": wave, "restitution": 0.9, "roughness": 0.5}
    experiment = settings("bed", 16, [10, "open"], floor=floor)
    _, world = scene_of(experiment, 0.9, 0.2)
    experiment["effects"]["floor"]["phase"] = 0.3
    scene, state = begin(experiment, 0.9, 0.2, 5)
    for _ in range(20):
        shot = snapshot(state, scene)
        brute = brute_force_from(world, shot._replace(time=shot.time + 0.3 * 1.7))
        height = displacement(scene.effects.floor, shot.time)
        assert height == pytest.approx(brute.surface(0.0)[0], abs=1e-9)
        begun = brute.time - shot.time
        run(state, scene, 1, collisions=10)
        brute.run(10)
        shot = snapshot(state, scene)
        assert brute.time - shot.time == pytest.approx(begun, abs=1e-9)
        assert shot.position[:, 1] == pytest.approx(brute.x[:, 1], abs=1e-8)
        assert shot.velocity == pytest.approx(brute.v, abs=1e-8)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.99, 1.01])
def test_a_search_that_ends_early_has_passed_no_meeting(share):
    """A limited search ends between its limit and the meeting, or finds the meeting."""
    scene, _ = particle_above_floor(21.3, (0.3, 0.0), wave="sine")
    fall = (scene.effects.floor.motion, 1.0, 20.3, 0.0, 0.0)
    meeting, _ = time_to_sine(*fall)
    limit = share * meeting
    time, outcome = search_sine(*fall, limit)
    if share > 1.0:
        assert (time, outcome) == (meeting, motions.MEETING)
    else:
        assert limit <= time < meeting and outcome == motions.SEARCH_AGAIN


def particle_between_walls(velocity, spin=0.0, **walls):
    """Scene and state of a particle 100 a above the floor of a bed 12 a wide."""
    scene, _ = begin(settings("walled", 1, [12, "open"], walls=walls), 0.9, 0.0)
    position = np.array([[6.0, 100.0]])
    return scene, new_state(scene, position, np.array([velocity]), np.array([[spin]]))


def test_a_smooth_elastic_wall_reflects():
    scene, state = particle_between_walls((3.0, 0.0), 0.8, restitution=1.0, roughness=-1.0)
    for k in range(1, 100):
        run(state, scene, 1, interval=0.1)
        shot = snapshot(state, scene)
        folded = (5.0 + 0.3 * k) % 20.0  # x - 1 runs over a width of 10 a: unfolded position
        assert shot.position[0, 0] - 1.0 == pytest.approx(min(folded, 20.0 - folded), abs=1e-12)
        assert abs(shot.velocity[0, 0]) == pytest.approx(3.0, rel=1e-14)
        assert shot.spin[0, 0] == 0.8
