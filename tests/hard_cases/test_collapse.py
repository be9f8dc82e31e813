"""Inelastic collapse."""

import math
from fractions import Fraction

import numpy as np
from brute_force import begin, run, settings, snapshot
from brute_force.scenes import UNLIMITED

from hard_cases.catalogue import errors_of_share
from roughgas.kernel.layout import new_state
from roughgas.kernel.loop import COLLAPSED
from roughgas.kernel.record import Sampling, allocate_frames, columns, record
from roughgas.kernel.state import ALTERED_RESTITUTIONS, BASE, COLLISIONS, NOW
from roughgas.simulation.energies import ratio
from roughgas.simulation.gas import Gas

BED = settings("bed")  # 160 disks on 50 a, as in Fig. 1a
COLLAPSING_SHARE = 0.75  # of beds at r = 0.6 that collapse within 60 T
THRESHOLD = 7.0 - 4.0 * math.sqrt(3.0)  # of r, for three particles on a line


def test_a_bed_that_collapses_is_stopped(margins):
    """At beta = 0; a share COLLAPSING_SHARE of all beds collapses within 60 T."""
    seeds = margins.size(quick=4, full=24)
    ends = [collapse(seed) for seed in range(1, seeds + 1)]
    collapsed = [end for end in ends if end["collapsed"]]
    lowest_share = COLLAPSING_SHARE - errors_of_share(COLLAPSING_SHARE, seeds)
    margins.at_least(
        "share of beds that collapse", len(collapsed) / seeds, lowest_share, seeds, "beds"
    )
    margins.at_most(
        "contacts made in the quarter T of the collapse",
        max(end["contacts"] for end in collapsed),
        200_000,  # a fraction of a second
        len(collapsed),
        "collapses",
    )
    chain = collapsed[0]
    margins.keep("collapse_chain", x=chain["x"], y=chain["y"], last=chain["last"])


def collapse(seed):
    """The end of a bed that runs for 60 T or until it collapses: contacts, positions and times."""
    scene, state = begin(BED, 0.6, 0.0, seed)
    row = np.empty((1, len(columns(scene))))
    time, collapsed = 0.0, False
    while time < 60.0 and not collapsed:
        before = state.counts[COLLISIONS]
        collapsed = record(
            state, scene, Sampling(0.25, UNLIMITED, 0), row, allocate_frames(state, 0)
        ) == (COLLAPSED, 0)
        contacts = state.counts[COLLISIONS] - before
        time = state.clock[BASE] + state.clock[NOW]
    shot = snapshot(state, scene)
    time_since_contact = state.clock[NOW] - state.trajectory[np.argsort(state.label), -1]
    x, y = shot.position.T
    return {
        "collapsed": collapsed,
        "contacts": contacts,
        "x": x % 50.0,
        "y": y,
        "last": time_since_contact,
    }


def test_a_dense_bed_is_not_taken_for_a_collapse(margins):
    """No quarter of T is missing at r = 0.8, nor at 0.7, which is safely above the collapse."""
    samples = margins.size(quick=200, full=8000)
    missing = 0
    for r in (0.8, 0.7):
        scene, state = begin(BED, r, 0.0, 1)
        rows = np.empty((samples, len(columns(scene))))
        missing += (
            samples
            - record(state, scene, Sampling(0.25, UNLIMITED, 0), rows, allocate_frames(state, 0))[1]
        )
    tried = {"tried": samples // 2, "unit": "T"}
    margins.at_most("quarters of T that are missing", missing, 0, **tried)


def test_R_does_not_depend_on_the_contact_time(margins):
    """Deviations in pooled standard errors: by chance one in 3000 exceeds 4.5, of few seeds one in
    500."""
    seeds, measure = margins.size(quick=6, full=8), margins.size(quick=60, full=500)
    durations = 10.0 ** np.array([-6, -4] if not margins.full else [-8, -7, -6, -5, -4, -3, -2, -1])
    runs = np.array([[bed_with(t_c, seed, measure) for seed in range(seeds)] for t_c in durations])
    mean, error = runs[..., 0].mean(axis=1), runs[..., 0].std(axis=1, ddof=1) / math.sqrt(seeds)
    flat = durations < 5e-3
    pooled = math.sqrt(np.mean(error[flat] ** 2))
    deviation = np.abs(mean[flat] - mean[flat].mean())
    tried = {"tried": seeds * int(flat.sum()), "unit": "beds"}
    margins.at_most("deviation of R, in standard errors", deviation.max() / pooled, 4.5, **tried)
    margins.at_most("deviation of R", deviation.max(), 0.005 if margins.full else 0.05, **tried)
    touched = runs[..., 1].mean(axis=1)
    shown = touched[np.isclose(durations, 1e-4)][0]
    margins.at_most("share of contacts touched at t_c = 1e-4 T", shown, 0.1, seeds, "beds")
    margins.keep("contact_time", duration=durations, R=mean, error=error, touched=touched)


def bed_with(duration, seed, measure):
    """(R, share of contacts touched) of a bed between smooth walls, as in Fig. 1b."""
    experiment = settings("walled", walls={"roughness": -1.0}, contact_time={"duration": duration})
    scene, state = begin(experiment, 0.6, 0.0, seed)
    gas, settle = Gas(scene, state), max(40, measure)
    R = ratio(gas.energies(gas.in_time(0.25, 4 * (settle + measure))))[4 * settle :]
    return R.mean(), state.counts[ALTERED_RESTITUTIONS] / state.counts[COLLISIONS]


def test_three_particles_on_a_line_collapse_below_a_threshold(margins):
    """Numbers of contacts of smooth particles, against exact fractions.

    Below the threshold, velocities are equal to 1e-10, the lowest speed of separation, after some
    tens of contacts: the collapse then ends as it would after infinitely many contacts.
    """
    above = [0.08, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 0.9]
    below = [THRESHOLD * share for share in (0.05, 0.2, 0.5, 0.8, 0.9, 0.98)]
    difference = max(
        abs(kernel_contacts_on_a_line(r)[0] - exact_contacts_on_a_line(r, 80)) for r in above
    )
    margins.at_most(
        "contacts too many or too few above it", difference, 0, len(above), "values of r"
    )
    assert all(exact_contacts_on_a_line(r, 80) == 80 for r in below)
    ends = [kernel_contacts_on_a_line(r) for r in below]
    tried = {"tried": len(below), "unit": "values of r"}
    margins.at_most("contacts made below it", max(contacts for contacts, _ in ends), 100, **tried)
    spread = max(np.ptp(velocity) for _, velocity in ends)
    margins.at_most("difference of velocities afterwards, in a/T", spread, 3e-10, **tried)


def test_spin_draws_three_particles_into_a_collapse(margins):
    """At r = 0.6 and beta = -0.95; on a line and without spin r < 0.072 would be needed.

    First seen in a cooling gas of spheres at r = 0.8, beta = -0.95, R = 0.998.
    """
    angles = np.radians([115.0, 120.0, 130.0, 140.0, 150.0])
    spinning = [collapse_of_spinning_disks(angle, -30.0) for angle in angles]
    still = [collapse_of_spinning_disks(angle, 0.0) for angle in angles]
    tried = {"tried": len(angles), "unit": "angles"}
    stopped = np.mean([collapsed for collapsed, _ in spinning])
    margins.at_least("share that is noticed as a collapse", stopped, 1.0, **tried)
    contacts = max(contacts for _, contacts in spinning)
    margins.at_most("contacts made until it is noticed", contacts, 5000, **tried)
    if margins.full:  # which compiles another kernel
        with_model = [
            collapse_of_spinning_disks(angle, -30.0, contact_time={"duration": 1e-4})
            for angle in angles
        ]
        margins.at_most("contacts made with the model", max(c for _, c in with_model), 20, **tried)
    margins.at_most("share without spin", np.mean([c for c, _ in still]), 0.0, **tried)
    margins.at_most("their contacts", max(contacts for _, contacts in still), 20, **tried)


def collapse_of_spinning_disks(angle, spin, **model):
    """(whether three disks that meet at an angle collapse, number of contacts)."""
    gas = settings("gas", 3, [60, 60])
    scene, _ = begin(gas | {"effects": gas["effects"] | model}, 0.6, -0.95)
    across, along = 2.001 * np.sin(angle / 2), 2.001 * np.cos(angle / 2)
    position = 30.0 + np.array([[-across, -along], [0.0, 0.0], [across, -along]])
    velocity = np.array([[0.1, 0.0], [0.0, -0.2], [-0.1, 0.0]])
    state = new_state(scene, position, velocity, np.array([[spin], [0.0], [-spin]]))
    row = np.empty((1, len(columns(scene))))
    collapsed = record(
        state, scene, Sampling(50.0, UNLIMITED, 0), row, allocate_frames(state, 0)
    ) == (COLLAPSED, 0)
    return collapsed, int(state.counts[COLLISIONS])


POSITIONS, VELOCITIES = (50.0, 53.0, 56.0), (1.0, 0.125, -0.875)


def kernel_contacts_on_a_line(r):
    """(number of contacts, final velocities) of three particles on a line, by the kernel."""
    scene, _ = begin(settings("smooth", 3, [400, 40]), r, -1.0)
    position = np.array([(x, 20.0) for x in POSITIONS])
    velocity = np.array([(v, 0.0) for v in VELOCITIES])
    state = new_state(scene, position, velocity, np.zeros((3, 1)))
    run(state, scene, 1, interval=40.0)
    return int(state.counts[COLLISIONS]), state.trajectory[:, 2].copy()


def exact_contacts_on_a_line(r, limit):
    """Number of contacts of the same particles in exact arithmetic, up to a limit."""
    x, v = [Fraction(a) for a in POSITIONS], [Fraction(a) for a in VELOCITIES]
    half = (1 + Fraction(r)) / 2
    for contacts in range(limit):
        waits = [
            ((x[k + 1] - x[k] - 2) / (v[k] - v[k + 1]), k) for k in range(2) if v[k] > v[k + 1]
        ]
        if not waits:
            return contacts
        wait, k = min(waits)
        x = [a + b * wait for a, b in zip(x, v, strict=True)]
        push = half * (v[k] - v[k + 1])
        v[k], v[k + 1] = v[k] - push, v[k + 1] + push
    return limit
