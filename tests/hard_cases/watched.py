"""What is watched in a scene: its books of energy, and the worst that is seen of each invariant."""

import operator

import numpy as np
from brute_force import begin, largest_overlap, scene_of, snapshot

from hard_cases.invariants import beyond_cone, gain_of_momentum, outside
from roughgas.base import CollapseError, InputError
from roughgas.effects.walls import SIDES
from roughgas.kernel.state import BOUNDARY_HITS, COLLISIONS, LAST_FIRST, LAST_SECOND
from roughgas.simulation.gas import Gas

ROUNDING = 2.0**-53
LONGEST = 20.0  # T until a look at a scene where hardly anything collides
BOUNDARIES = {"floor", "walls", "shaken_walls", *SIDES}
COUNTS = {"tried", "collisions", "given_up", "broken", "backwards"}


class Account:
    """The books of a gas from now on, and the most energy that any look at them has found."""

    def __init__(self, gas):
        self.gas, self.before, self.most = gas, gas.balance(), 0.0
        self.look()

    def look(self):
        """Note what has been put in since, and what is there."""
        now = self.gas.balance()
        self.booked, self.gain = now.ledger - self.before.ledger, now.energy - self.before.energy
        self.most = max(self.most, np.abs(self.booked).sum() + np.abs(now.energy).sum())

    def missing(self):
        """Return the energy of a motion that the books miss, in roundings of it an exchange.

        Each exchange leaves roundings of what is in the gas and in the books at that moment, and
        these stay when the energy itself has gone: they are relative to the most that was there.
        """
        missing = np.abs(self.gain - self.booked.sum(axis=0)).max()
        return missing / self.most / ROUNDING / (10 + exchanges_of(self.gas.state))


class Worst:
    """The worst that was seen of each invariant, over all scenes."""

    def __init__(self):
        self.tried = self.collisions = self.given_up = 0
        self.imbalance = self.overlap = self.outside = self.broken = self.backwards = 0.0
        self.momentum = self.gained = self.cone = 0.0

    def see(self, experiment, r, beta, seed):
        """Simulate a scene for some hundreds of collisions, if its particles find room."""
        try:
            gas = Gas(*begin(experiment, r, beta, seed))
        except InputError:
            return
        _, world = scene_of(experiment, r, beta)
        self.broken += (gas.state.spin is None) != ("spin" not in experiment["effects"])
        try:
            self._see_samples(gas, world, not BOUNDARIES & set(experiment["effects"]))
            self._see_contacts(gas, world)
        except CollapseError as error:
            self.broken += "\n" in str(error)
            self.given_up += 1
        self.tried += 1
        self.collisions += contacts_of(gas.state)

    def __add__(self, other):
        """Return the worst of both: counts are added, of numbers the larger is kept."""
        both = Worst()
        for name, mine in vars(self).items():
            join = operator.add if name in COUNTS else max
            setattr(both, name, join(mine, getattr(other, name)))
        return both

    def _see_samples(self, gas, world, keeps_momentum):
        state, scene, account, last = gas.state, gas.scene, Account(gas), -1.0
        first = snapshot(state, scene)
        for _ in range(4):
            go_on(gas, account)
            self.imbalance = max(self.imbalance, account.missing())
            self.gained = max(self.gained, account.booked[-1].sum() / account.most)
            shot = snapshot(state, scene)
            self.overlap = max(self.overlap, largest_overlap(state, scene, world))
            self.outside = max(self.outside, outside(shot, world))
            if keeps_momentum:
                self.momentum = max(self.momentum, gain_of_momentum(first, shot, world))
            # light ones between heavy ones make hundreds of contacts at once
            self.backwards += gas.time < last
            last = gas.time
            numbers = [state.trajectory, *gas.sample.values()]
            numbers += [] if state.spin is None else [state.spin]
            self.broken += not all(np.all(np.isfinite(some)) for some in numbers)

    def _see_contacts(self, gas, world):
        """Ten more, one by one."""
        if world.mu is None or world.shear:  # where images slide the same velocity has two values
            return
        for _ in range(10):
            state = gas.state
            before, changes = snapshot(state, gas.scene), changes_by_label(state)
            if not gas.step(gas.time + LONGEST, 1):
                return
            pair = state.counts[[LAST_FIRST, LAST_SECOND]]
            if np.all(changes_by_label(state)[pair] == changes[pair] + 1):  # by this contact alone
                after = snapshot(state, gas.scene)
                self.cone = max(self.cone, beyond_cone(before, after, pair, world))


def worst_of(scenes):
    """Simulate scenes (experiment, r, beta, seed); return the Worst of them.

    An error says which scene it is of.
    """
    worst = Worst()
    for scene in scenes:
        try:
            worst.see(*scene)
        except Exception as error:
            error.add_note(f"scene {scene}")
            raise
    return worst


def go_on(gas, account):
    """Go on by 150 collisions, or LONGEST T, in steps in which energies change little.

    None is longer than a T, by which a run judges whether particles are held.
    """
    until, most = gas.time + LONGEST, gas.collisions + 150
    while gas.time < until and gas.collisions < most:
        gas.step(min(gas.time + 1.0, until), min(10, most - gas.collisions))
        account.look()


def contacts_of(state):
    """Contacts made so far, those with boundaries among them."""
    return int(state.counts[COLLISIONS] + state.counts[BOUNDARY_HITS])


def exchanges_of(state):
    """Contacts and kicks of a thermostat so far: a gas may have thousands of kicks alone."""
    return (int(state.changes.sum()) + int(state.counts[BOUNDARY_HITS])) / 2


def changes_by_label(state):
    """How often each particle's velocity has changed, in the order of the start."""
    return state.changes[np.argsort(state.label)]
