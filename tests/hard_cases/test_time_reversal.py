"""Elastic gases retrace their steps.

After n collisions per particle all velocities and spins are reversed: the gas should come back to
where it was. What either way rounds k collisions per particle from the start is multiplied by
exp(lambda k) until the gas is back, lambda being the largest Lyapunov exponent; most of all what is
rounded where it turns. So a gas should come back to within one rounding of all its coordinates
times exp(lambda n), for as long as that is small, and no longer.
"""

from typing import NamedTuple

import numpy as np
from brute_force import begin, run, settings, snapshot

from roughgas.kernel.memory import new_state
from roughgas.kernel.state import COLLISIONS

SEPARATION = 1e-10  # of the two paths whose parting tells the exponent
PACKING = 0.2  # of the disks
SETTLING = 5  # steps in which a small difference turns into the direction that grows fastest
COLLISIONS_THERE = np.arange(2, 52, 2)  # per particle, up to where a gas is reversed
LINEAR, LOST = 1e-3, 1e3  # predictions (a, a/T) below which errors grow, above which all is lost


class Gas(NamedTuple):
    """A scene, and where an elastic gas in equilibrium is at some instant between collisions."""

    scene: object
    shot: object

    @property
    def number(self):
        return len(self.shot.position)

    @property
    def rounding(self):
        """By how much one flight of every particle moves the gas: each coordinate is rounded once.

        The rms of a rounding is its spacing, as at half the width of the box, over root 12.
        """
        spacing = np.spacing(0.5 * np.array(self.scene.box))
        return np.sqrt(self.number * (spacing**2).sum() / 12.0)

    def flown(self, **stop):
        """(the gas later on, collisions per particle on the way)."""
        state = new_state(self.scene, *self.shot[1:4])
        run(state, self.scene, 1, **stop)
        later = self._replace(shot=snapshot(state, self.scene))
        return later, 2.0 * state.counts[COLLISIONS] / self.number

    def reversed(self):
        return self._replace(
            shot=self.shot._replace(velocity=-self.shot.velocity, spin=-self.shot.spin)
        )

    def moved(self, step):
        """The gas with its positions, velocities and spins off by a step."""
        fields = zip(self.shot[1:4], step, strict=True)
        return self._replace(shot=type(self.shot)(self.shot.time, *(x + d for x, d in fields)))

    def step_to(self, other):
        """What has to be added to positions, velocities and spins."""
        x, v, w = (b - a for a, b in zip(self.shot[1:4], other.shot[1:4], strict=True))
        box = np.array(self.scene.box)
        return x - box * np.round(x / box), v, w


def length(step):
    """Euclidean length over all particles; a and T being 1."""
    return np.sqrt(sum((d**2).sum() for d in step))


def equilibrium(experiment, beta, seed):
    """An elastic gas ten collisions per particle after its start, at an instant of its own."""
    scene, state = begin(experiment, 1.0, beta, seed)
    rng = np.random.default_rng(seed)
    state.spin[:] = rng.standard_normal(state.spin.shape)
    run(state, scene, 1, collisions=5 * experiment["particles"])
    run(state, scene, 1, interval=0.1 * rng.random())
    return Gas(scene, snapshot(state, scene))


def lyapunov_exponent(gas, steps, rng):
    """Per collision per particle, from a second path set back to SEPARATION after each."""
    interval = gas.flown(collisions=gas.number)[0].shot.time / 2.0
    step = [rng.standard_normal(x.shape) for x in gas.shot[1:4]]
    growth = collisions = 0.0
    for k in range(steps):
        other = gas.moved([SEPARATION / length(step) * d for d in step])
        other, _ = other.flown(interval=interval)
        gas, made = gas.flown(interval=interval)
        step = gas.step_to(other)
        if k >= SETTLING:
            growth += np.log(length(step) / SEPARATION)
            collisions += made
    return growth / collisions


def return_error(gas, collisions):
    """How far from its start a gas comes back that was reversed after so many per particle.

    It is reversed at the very instant of a contact, which is the first one on the way back.
    """
    there, _ = gas.flown(collisions=round(collisions * gas.number / 2))
    back, _ = there.reversed().flown(interval=there.shot.time)
    return length(gas.step_to(back.reversed()))


def errors_of_return(experiment, beta, seeds):
    """(median errors, least errors, predicted errors, exponent) after COLLISIONS_THERE."""
    gases = [equilibrium(experiment, beta, seed) for seed in range(seeds)]
    exponent = np.mean([lyapunov_exponent(gas, 40, np.random.default_rng(7)) for gas in gases])
    errors = np.array([[return_error(gas, n) for gas in gases] for n in COLLISIONS_THERE])
    predicted = gases[0].rounding * np.exp(exponent * COLLISIONS_THERE)
    return np.median(errors, axis=1), errors.min(axis=1), predicted, exponent


def test_return(margins):
    """Bounds: ln(error) scatters by 1.5 from run to run, and so does what it has grown by: medians
    of 20 runs by 0.4, and the growth over some 20 collisions per particle by 2 % of itself. A
    prefactor of 2 to 4 is what several flights on both ways add up to.
    """
    number, runs = margins.size(quick=40, full=160), margins.size(quick=20, full=120)
    disks = settings("gas", number, [np.sqrt(np.pi * number / PACKING)] * 2)
    spheres = settings("spheres", 64, [12, 12, 12])
    columns = {"collisions": COLLISIONS_THERE}
    gases = {"rough disks": (disks, 1.0), "smooth disks": (disks, -1.0), "spheres": (spheres, 1.0)}
    for name, (experiment, beta) in gases.items():
        error, least, predicted, exponent = errors_of_return(experiment, beta, runs)
        columns |= {f"error of {name}": error, f"prediction for {name}": predicted}
        linear = predicted < LINEAR
        growth = np.polyfit(COLLISIONS_THERE[linear], np.log(error[linear]), 1)[0] / exponent
        ratio = np.exp(np.mean(np.log(error[linear] / predicted[linear])))
        tried = {"tried": runs * linear.sum(), "unit": "returns"}
        what = f"{name}: growth of the error of return, relative to the exponent, from it"
        margins.at_most(what, abs(growth - 1.0), 0.1, **tried)
        margins.at_most(f"{name}: error of return, over the predicted one", ratio, 10.0, **tried)
        tried["tried"] = runs * (predicted > LOST).sum()
        far = least[predicted > LOST].min() / np.sqrt(experiment["particles"])
        what = f"{name}: distance from the start where all is lost [a per particle]"
        margins.at_least(what, far, 1.0, **tried)
    margins.keep("time_reversal", **columns)
