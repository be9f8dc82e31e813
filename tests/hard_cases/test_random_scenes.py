"""Random scenes."""

import itertools
import math

import numpy as np
from brute_force import begin, largest_overlap, scene_of, snapshot
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from hard_cases.catalogue import hard_case
from roughgas.initial import lattice
from roughgas.kernel.record import Plan, columns, record
from roughgas.kernel.state import BOUNDARY_HITS, COLLISIONS
from roughgas.protocols.books import books, imbalance

ROUNDING = 2.0**-53
KINDS = {  # effects besides spin and contact time, and whether there is a top
    "gas": ((), True),
    "sheared": (("shear",), True),
    "channel": (("walls",), True),
    "bed": (("gravity", "floor"), False),
    "walled bed": (("gravity", "floor", "walls"), False),
}
FEW = [("gas", True, False, 2), ("sheared", True, False, 2), ("walled bed", True, True, 2)]
ALL = [
    *itertools.product(KINDS, (True, False), (True,), (2,)),
    *(("bed", True, False, 2), ("walled bed", True, False, 2)),
    *itertools.product(("gas", "sheared", "walled bed"), (True,), (True,), (3,)),
]
"""Compositions (kind, spin, contact time, dimension): each is a kernel of its own."""

material = {
    "restitution": st.sampled_from([0.3, 0.7, 0.9, 1.0]),
    "roughness": st.sampled_from([-1.0, -0.4, 0.5, 1.0]),
}
PARAMETERS = {
    "spin": st.fixed_dictionaries({"inertia": st.floats(0.05, 1.0)}),
    "gravity": st.fixed_dictionaries({"acceleration": st.floats(0.1, 10.0)}),
    "floor": st.fixed_dictionaries(
        {"amplitude": st.floats(0.1, 8.0), "period": st.floats(0.2, 3.0), **material}
    ),
    "walls": st.fixed_dictionaries(material),
    "shear": st.fixed_dictionaries({"velocity": st.floats(0.01, 100.0)}),
    "contact_time": st.fixed_dictionaries({"duration": st.sampled_from([1e-5, 1e-3, 1e-1])}),
}


@st.composite
def scenes(draw, compositions):
    """(settings of an experiment, r, beta) of a legal scene with 2 to 40 particles."""
    kind, spin, contact_time, dimension = draw(st.sampled_from(compositions))
    names, closed = KINDS[kind]
    names = (("spin",) if spin else ()) + names + (("contact_time",) if contact_time else ())
    box = [draw(st.floats(7.0, 40.0)) for _ in range(dimension)]
    if not closed:
        box[-1] = "open"
    # what is more inelastic than that may collapse, and has a contact time
    r = draw(st.floats(0.2 if contact_time and kind != "channel" else 0.9, 1.0))
    effects = {name: draw(PARAMETERS[name]) for name in names}
    return (
        {"particles": draw(st.integers(2, 40)), "box": box, "effects": effects},
        r,
        draw(st.floats(-1.0, 1.0)),
    )


class Worst:
    """The worst that was seen of each invariant, over all scenes."""

    def __init__(self):
        self.tried = self.collisions = self.stopped = 0
        self.imbalance = self.overlap = self.outside = self.broken = 0.0

    def see(self, experiment, r, beta):
        """Simulate a scene for some hundreds of collisions."""
        scene, state = begin(experiment, r, beta, self.tried)
        _, world = scene_of(experiment, r, beta)
        row = np.empty((1, len(columns(len(scene.box), scene.effects.spin is not None))))
        before = books(state, scene)
        for _ in range(4):
            if record(state, scene, Plan(20.0, 150, 0), row) == 0:
                self.stopped += 1
                break
            after = books(state, scene)
            booked = after.ledger - before.ledger
            missing = imbalance(booked, after.energy - before.energy)
            scale = np.abs(booked).sum() / (np.abs(booked).sum() + np.abs(before.energy).sum())
            contacts = state.counts[COLLISIONS] + state.counts[BOUNDARY_HITS]
            self.imbalance = max(self.imbalance, missing * scale / ROUNDING / (10 + contacts))
            self.overlap = max(self.overlap, largest_overlap(state, scene, world))
            self.outside = max(self.outside, outside(snapshot(state, scene), scene, world))
            self.broken += not np.all(np.isfinite(state.trajectory))
        self.tried += 1
        self.collisions += int(state.counts[COLLISIONS] + state.counts[BOUNDARY_HITS])


def outside(shot, scene, world):
    """By how much a particle reaches through a wall or the floor, in a."""
    depth = 0.0
    if world.walls is not None:
        x = shot.position[:, 0]
        depth = max(depth, (1.0 - x).max(), (x + 1.0 - world.walls[0]).max())
    if world.floor is not None:
        amplitude, period = world.floor[:2]
        surface = amplitude * math.fmod(shot.time, period) / period
        depth = max(depth, (surface + 1.0 - shot.position[:, -1]).max())
    return depth


def fits(experiment, r, beta):
    """Whether the particles find room."""
    scene, _ = scene_of(experiment, r, beta)
    try:
        lattice(scene, experiment)
    except ValueError:
        return False
    return True


@hard_case(
    "any legal composition of effects, at random",
    "effects that are right on their own disturb each other: energy comes from nowhere, particles "
    "leave the box or each other's way, numbers cease to be numbers",
)
def test_invariants_of_random_scenes(margins):
    """Change of the energy = what floor, walls, shear and contacts have booked, to rounding.

    A particle may be held for ever in the corner of a rough floor that rises and a rough wall:
    then the simulation stops with an error, as it must.
    """
    worst = Worst()

    @settings(
        max_examples=margins.size(60, 1500),
        phases=[Phase.generate],
        derandomize=True,
        database=None,
        deadline=None,
    )
    @given(scenes(ALL if margins.full else FEW))
    def see(scene):
        if fits(*scene):
            worst.see(*scene)

    see()
    tried = {"tried": worst.tried, "unit": f"scenes, {worst.collisions} contacts"}
    what = "energy missing in the books, in roundings of it a contact"
    margins.at_most(what, worst.imbalance, 10.0, **tried)
    margins.at_most("overlap, in a", worst.overlap, 1e-11, **tried)
    margins.at_most("depth in a wall or the floor, in a", worst.outside, 1e-11, **tried)
    margins.at_most("scenes with numbers that are none", worst.broken, 0, **tried)
    stopped = worst.stopped / worst.tried
    margins.at_most("share of scenes that are stopped", stopped, 0.05, **tried)


def test_without_the_work_of_contacts_across_the_boundary(without):
    without(
        "booking what contacts across a sliding boundary gain",
        test_invariants_of_random_scenes,
        "kernel/contact.py",
        "    hooks.transfer(effects, None, state, dot(push, subtract(v, between)))\n",
        "",
    )
