"""Absent effects are absent: no memory, no code."""

from brute_force import begin, run, settings

from roughgas.kernel.record import columns, record


def test_a_scene_without_spin_has_no_spins():
    scene, state = begin(settings("smooth", 16, [20, 20]), 0.9, -1.0, 1)
    assert state.spin is None and state.moments.contact_time is None
    rows = run(state, scene, 5, collisions=10)
    assert not {"ww", "w"} & set(rows)
    assert rows["collisions"][-1] == 50
    assert not {"ww", "w"} & set(columns(2, False))
    assert columns(2, True)[-2:] == ["ww", "w"]
    assert columns(3, True)[-4:] == ["ww", "w_x", "w_y", "w_z"]


def test_a_scene_without_contact_time_remembers_no_contacts():
    assert begin(settings("gas", 16, [20, 20]), 0.9, 0.0)[1].moments.contact_time is None
    _, state = begin(settings("spheres", 16), 0.9, 0.0)
    assert len(state.moments.contact_time) == 16


def test_each_composition_has_machine_code_of_its_own():
    for name in ("gas", "smooth"):
        scene, state = begin(settings(name, 16, [20, 20]), 0.9, -1.0)
        run(state, scene, 0)
    scenes = {str(signature[1]) for signature in record.signatures}
    without, having = (
        [scene for scene in scenes if ("Spin" in scene) == present] for present in (False, True)
    )
    assert without and having


def test_smooth_disks_move_as_rough_ones_at_beta_minus_1():
    """The same positions and velocities, to the last bit."""
    trajectories = []
    for name in ("gas", "smooth"):
        scene, state = begin(settings(name, 16, [20, 20]), 0.9, -1.0, 3)
        run(state, scene, 10, collisions=10)
        trajectories.append(state.trajectory.tobytes())
    assert trajectories[0] == trajectories[1]
