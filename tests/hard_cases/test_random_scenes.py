"""Random scenes."""

import math

import numpy as np
from brute_force import KERNELS, begin, largest_overlap, scene_of, snapshot
from hypothesis import Phase, given, settings

from hard_cases.catalogue import hard_case
from hard_cases.compositions import (
    PARAMETERS,
    covering,
    every_set,
    is_legal,
    mixtures,
    parameters,
    scenes,
    with_needs,
)
from hard_cases.invariants import beyond_cone, gain_of_momentum, outside
from roughgas.base.errors import InputError
from roughgas.effects import KINDS
from roughgas.effects.side import SIDES
from roughgas.kernel.record import Sampling, columns, record
from roughgas.kernel.state import BOUNDARY_HITS, COLLISIONS, LAST_FIRST, LAST_SECOND
from roughgas.scene import build, check
from roughgas.simulation.books import books, imbalance

ROUNDING = 2.0**-53
BOUNDARIES = {"floor", "walls", "shaken_walls", *SIDES}
QUICK = ("friction", "sheared", "walled", "shaken", "heated", "spheres")
FEW = [
    (set(KERNELS[name]["effects"]), len(KERNELS[name]["box"]), "sawtooth")  # the floor's, if any
    for name in QUICK
]
"""Compositions that other tests run, too: each is a kernel of its own."""


UNLIKE = [
    (set(KERNELS[name]["effects"]), len(KERNELS[name]["box"]), "sawtooth")
    for name in ("gas", "heated", "rubbed bed")
]
"""Those of which other tests run mixtures, too."""


class Worst:
    """The worst that was seen of each invariant, over all scenes."""

    def __init__(self):
        self.tried = self.collisions = self.stopped = 0
        self.imbalance = self.overlap = self.outside = self.broken = self.backwards = 0.0
        self.momentum = self.gained = self.cone = 0.0

    def see(self, experiment, r, beta):
        """Simulate a scene for some hundreds of collisions."""
        scene, state = begin(experiment, r, beta, self.tried)
        _, world = scene_of(experiment, r, beta)
        self.broken += (state.spin is None) != ("spin" not in experiment["effects"])
        row = np.empty((1, len(columns(scene))))
        before, first, last = books(state, scene), snapshot(state, scene), -1.0
        for _ in range(4):
            if record(state, scene, Sampling(20.0, 150, 0), row) == 0:
                self.stopped += 1
                break
            self._see_books(before, books(state, scene), exchanges_of(state))
            shot = snapshot(state, scene)
            self.overlap = max(self.overlap, largest_overlap(state, scene, world))
            self.outside = max(self.outside, outside(shot, world))
            if not BOUNDARIES & set(experiment["effects"]):
                self.momentum = max(self.momentum, gain_of_momentum(first, shot, world))
            self.backwards += (
                row[0, 0] < last
            )  # light ones between heavy ones make hundreds at once
            last = row[0, 0]
            self.broken += not (np.all(np.isfinite(state.trajectory)) and np.all(np.isfinite(row)))
            self.broken += state.spin is not None and not np.all(np.isfinite(state.spin))
        else:
            self._see_contacts(state, scene, world, row)
        self.tried += 1
        self.collisions += contacts_of(state)

    def _see_books(self, before, after, exchanges):
        booked = after.ledger - before.ledger
        missing = imbalance(booked, after.energy - before.energy)
        exchanged = np.abs(booked).sum()
        scale = exchanged / (exchanged + np.abs(before.energy).sum())
        self.imbalance = max(self.imbalance, missing * scale / ROUNDING / (10 + exchanges))
        self.gained = max(self.gained, booked[-1].sum() / (exchanged + np.abs(before.energy).sum()))

    def _see_contacts(self, state, scene, world, row):
        """Ten more, one by one."""
        if world.mu is None or world.shear:  # where images slide the same velocity has two values
            return
        for _ in range(10):
            before, changes = snapshot(state, scene), changes_by_label(state)
            made = state.counts[COLLISIONS]
            record(state, scene, Sampling(20.0, 1, 0), row)
            if state.counts[COLLISIONS] == made:
                return
            pair = state.counts[[LAST_FIRST, LAST_SECOND]]
            if np.all(changes_by_label(state)[pair] == changes[pair] + 1):  # by this contact alone
                after = snapshot(state, scene)
                self.cone = max(self.cone, beyond_cone(before, after, pair, world))


def contacts_of(state):
    """Contacts made so far, those with boundaries among them."""
    return int(state.counts[COLLISIONS] + state.counts[BOUNDARY_HITS])


def exchanges_of(state):
    """Contacts and kicks of a thermostat so far: a gas may have thousands of kicks alone."""
    return (int(state.changes.sum()) + int(state.counts[BOUNDARY_HITS])) / 2


def changes_by_label(state):
    """How often each particle's velocity has changed, in the order of the start."""
    return state.changes[np.argsort(state.label)]


def fits(experiment, r, beta, seed):
    """Whether the particles find room."""
    try:
        begin(experiment, r, beta, seed)
    except InputError:
        return False
    return True


JUNK = (math.nan, math.inf, -7, "x", None, True, [], {})
"""What no parameter may be, but None where there is a default."""


@hard_case(
    "any set of effects, legal or not",
    "a composition that makes no sense is simulated, or one that does is refused, or ends in an "
    "error that no user understands",
)
def test_every_set_of_effects_is_accepted_or_refused_in_one_line(margins):
    """Sets of effects, in two and three dimensions, closed and open above, and with parameters that

    are none. What is legal, and which sets are tried, is said in compositions.py.
    """
    assert set(PARAMETERS) == set(KINDS)
    tried = wrong = junk = accepted = 0

    @settings(
        max_examples=margins.size(3, 30), phases=[Phase.generate], derandomize=True, database=None
    )
    @given(parameters([*KINDS]), parameters([name for name in KINDS if name != "spin"]))
    def see(spinning, smooth):
        nonlocal tried, wrong, junk, accepted
        for effects in every_set():
            chosen = {name: (spinning if "spin" in effects else smooth)[name] for name in effects}
            for dimension, top in ((2, 30), (2, "open"), (3, 30), (3, "open")):
                is_open = "gravity" in effects and "lid" not in effects
                legal = is_legal(effects, dimension) and (top == "open") == is_open
                wrong += accepts(chosen, dimension, top) != legal
                tried += 1
                minimal = legal and any(effects == with_needs({one}) for one in effects)
                for changed in spoiled(chosen) if minimal else ():
                    accepted += accepts(changed, dimension, top)
                    junk += 1

    see()
    margins.at_most("sets of effects misjudged", wrong, 0, tried, "sets and boxes")
    margins.at_most("parameters that are none, and accepted", accepted, 0, junk, "of legal sets")


def spoiled(chosen):
    """These settings of effects with each parameter in turn being each thing that it may not be."""
    for name in chosen:
        for key, about in KINDS[name].parameters.items():
            either_sign = getattr(about, "interval", "").startswith("[-1e")
            for value in JUNK:
                legal = value == -7 and either_sign  # as a velocity may be
                if not legal and (value is not None or about.default is None):
                    yield chosen | {name: chosen[name] | {key: value}}


def accepts(effects, dimension, top):
    """Whether a scene is built and checked; errors but an InputError of one line get through."""
    experiment = {"particles": 5, "box": [30] * (dimension - 1) + [top], "effects": effects}
    verdicts = {
        verdict(build, experiment, 0.9, 0.3 if "spin" in effects else -1.0),
        verdict(check, experiment),
    }
    assert len(verdicts) == 1, experiment
    return verdicts.pop()


def verdict(judge, *arguments):
    """Whether a function takes what it is given, or else refuses it in one line."""
    try:
        judge(*arguments)
    except InputError as error:
        assert "\n" not in str(error) and ": must " in str(error)
        return False
    return True


@hard_case(
    "any legal composition of effects, at random",
    "effects that are right on their own disturb each other: energy or momentum comes from "
    "nowhere, particles leave the box or each other's way, time runs backwards, numbers cease to "
    "be numbers",
)
def test_invariants_of_random_scenes(margins):
    """Change of the energy = what its sources and the contacts have booked, to rounding.

    A particle may be held for ever in the corner of a rough floor that rises and a rough wall:
    then the simulation stops with an error, as it must.
    """
    keep_invariants(margins, scenes(FEW + covering(3) if margins.full else FEW), 90, 1500)


@hard_case(
    "any legal composition of effects, of particles that differ",
    "what one particle gives the other does not take, or they meet, walls and floor included, as "
    "if they had another radius",
)
def test_invariants_of_random_mixtures(margins):
    """As above, of up to three species of any material, with masses that differ by 1e6."""
    keep_invariants(margins, mixtures(covering(2) if margins.full else UNLIKE), 40, 600)


def keep_invariants(margins, kinds, few, many):
    """Simulate scenes of these kinds, and measure what must hold in all of them."""
    worst = Worst()

    @settings(
        max_examples=margins.size(few, many),
        phases=[Phase.generate],
        derandomize=True,
        database=None,
        deadline=None,
    )
    @given(kinds)
    def see(scene):
        if fits(*scene, worst.tried):
            worst.see(*scene)

    see()
    tried = {"tried": worst.tried, "unit": f"scenes, {worst.collisions} contacts"}
    what = "energy missing in the books, in roundings of it an exchange"
    margins.at_most(what, worst.imbalance, 10.0, **tried)
    margins.at_most("energy that contacts give, over all", worst.gained, 1e-12, **tried)
    what = "momentum gained without boundaries, over the sum of speeds"
    margins.at_most(what, worst.momentum, 1e-12, **tried)
    margins.at_most("impulses beyond the cone of friction", worst.cone, 1e-10, **tried)
    margins.at_most("overlap, in a", worst.overlap, 1e-11, **tried)
    margins.at_most("depth in a wall or the floor, in a", worst.outside, 1e-11, **tried)
    margins.at_most("scenes with numbers that are none", worst.broken, 0, **tried)
    margins.at_most("samples earlier than the one before", worst.backwards, 0, **tried)
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
