"""The energy account of a scene, and the largest violation of each of its invariants."""

import operator

import numpy as np
from brute_force import begin, largest_overlap, scene_of, snapshot

from hard_cases.invariants import beyond_cone, gain_of_momentum, outside
from roughgas.base import CollapseError, InputError
from roughgas.effects.walls import SIDES
from roughgas.kernel.state import BOUNDARY_HITS, COLLISIONS, LAST_FIRST, LAST_SECOND
from roughgas.simulation.gas import Gas

ROUNDING = 2.0**-53
LONGEST_STEP = 20.0  # T between checks of a scene with hardly any collisions
# a bath acts on single particles: effects/bath.py
CHANGE_MOMENTUM = {"floor", "walls", "shaken_walls", *SIDES, "langevin"}
COUNTS = {"tried", "collisions", "given_up", "broken", "backwards"}


class EnergyAccount:
    """The energy balance of a gas from now on, and its largest energy."""

    def __init__(self, gas):
        self.gas, self.before, self.largest = gas, gas.balance(), 0.0
        self.look()

    def look(self):
        """Update the energy booked, the gain of energy, and the largest energy."""
        now = self.gas.balance()
        self.booked, self.gain = now.ledger - self.before.ledger, now.energy - self.before.energy
        self.largest = max(self.largest, np.abs(self.booked).sum() + np.abs(now.energy).sum())

    def imbalance(self):
        """Return the error of the energy balance, in roundings of the largest energy per exchange.

        Each exchange rounds the energies in the gas and in the account at that moment, and these
        errors stay when the energy has decayed: hence they are relative to the largest energy.
        """
        missing = np.abs(self.gain - self.booked.sum(axis=0)).max()
        return missing / self.largest / ROUNDING / (10 + exchanges_of(self.gas.state))


class Violations:
    """The largest violation of each invariant, over all scenes."""

    def __init__(self):
        self.tried = self.collisions = self.given_up = 0
        self.imbalance = self.overlap = self.outside = self.broken = self.backwards = 0.0
        self.momentum = self.gained = self.cone = 0.0

    def simulate(self, experiment, r, beta, seed):
        """Simulate a scene for some hundreds of collisions, if its particles fit into the box."""
        try:
            gas = Gas(*begin(experiment, r, beta, seed))
        except InputError:
            return
        _, world = scene_of(experiment, r, beta)
        self.broken += (gas.state.spin is None) != ("spin" not in experiment["effects"])
        try:
            self._check_samples(gas, world, not CHANGE_MOMENTUM & set(experiment["effects"]))
            self._check_contacts(gas, world)
        except CollapseError as error:
            self.broken += "\n" in str(error)
            self.given_up += 1
        self.tried += 1
        self.collisions += contacts_of(gas.state)

    @classmethod
    def from_numbers(cls, numbers):
        """Return Violations with these numbers, which are vars() of an equal object."""
        violations = cls()
        vars(violations).update(numbers)
        return violations

    def __add__(self, second):
        """Return the violations of both: sums of counts, the larger of other numbers."""
        total = Violations()
        for name, first_value in vars(self).items():
            join = operator.add if name in COUNTS else max
            setattr(total, name, join(first_value, getattr(second, name)))
        return total

    def _check_samples(self, gas, world, keeps_momentum):
        """Check all invariants but friction at four instants."""
        state, scene, account, last = gas.state, gas.scene, EnergyAccount(gas), -1.0
        first = snapshot(state, scene)
        for _ in range(4):
            go_on(gas, account)
            self.imbalance = max(self.imbalance, account.imbalance())
            self.gained = max(self.gained, account.booked[-1].sum() / account.largest)
            shot = snapshot(state, scene)
            self.overlap = max(self.overlap, largest_overlap(state, scene, world))
            self.outside = max(self.outside, outside(shot, world))
            if keeps_momentum:
                self.momentum = max(self.momentum, gain_of_momentum(first, shot, world))
            # light particles between heavy ones make hundreds of contacts at the same instant
            self.backwards += gas.time < last
            last = gas.time
            arrays = [state.trajectory, *gas.sample.values()]
            arrays += [] if state.spin is None else [state.spin]
            self.broken += not all(np.all(np.isfinite(array)) for array in arrays)

    def _check_contacts(self, gas, world):
        """Check the friction of ten more contacts, one by one."""
        if world.mu is None or world.shear:  # velocities depend on the image under shear
            return
        for _ in range(10):
            state = gas.state
            before, changes = snapshot(state, gas.scene), changes_by_label(state)
            if not gas.step(gas.time + LONGEST_STEP, 1):
                return
            pair = state.counts[[LAST_FIRST, LAST_SECOND]]
            if np.all(
                changes_by_label(state)[pair] == changes[pair] + 1
            ):  # no other contact at the same instant
                after = snapshot(state, gas.scene)
                self.cone = max(self.cone, beyond_cone(before, after, pair, world))


def violations_in(scenes):
    """Simulate scenes (experiment, r, beta, seed); return their Violations.

    A note on an error names its scene.
    """
    violations = Violations()
    for scene in scenes:
        try:
            violations.simulate(*scene)
        except Exception as error:
            error.add_note(f"scene {scene}")
            raise
    return violations


def go_on(gas, account):
    """Go on by 150 collisions or LONGEST_STEP, in steps with small changes of energies.

    A step takes at most 1 T, over which a run judges whether particles are held.
    """
    end, collision_limit = gas.time + LONGEST_STEP, gas.collisions + 150
    while gas.time < end and gas.collisions < collision_limit:
        gas.step(min(gas.time + 1.0, end), min(10, collision_limit - gas.collisions))
        account.look()


def contacts_of(state):
    """The number of contacts of a state, with boundaries included."""
    return int(state.counts[COLLISIONS] + state.counts[BOUNDARY_HITS])


def exchanges_of(state):
    """The number of contacts and kicks of a state: a gas may have thousands of kicks alone."""
    return (int(state.changes.sum()) + int(state.counts[BOUNDARY_HITS])) / 2


def changes_by_label(state):
    """The number of changes of each particle's velocity, in the order of the start."""
    return state.changes[np.argsort(state.label)]
