"""Elastic gases retrace their steps.

After n collisions per particle all velocities and spins are reversed: the gas should return to its
start. A rounding made k collisions per particle from the start, on either way, is multiplied by
exp(lambda k) until the return, with lambda the largest Lyapunov exponent; roundings at the reversal
grow most. So the error of return should be a rounding of all coordinates times exp(lambda n), as
long as this is small.
"""

from typing import NamedTuple

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot

from roughgas.kernel.layout import new_state
from roughgas.kernel.state import COLLISIONS

SEPARATION = 1e-10  # of the two paths whose divergence gives the exponent
PACKING = 0.2  # of the disks
SETTLING = 5  # steps until a difference has the direction of fastest growth
COLLISIONS_BEFORE_REVERSAL = np.arange(2, 52, 2)  # per particle
LINEAR, SATURATED = (
    1e-3,
    1e3,
)  # predicted errors (a, a/T): below they grow exponentially, above they saturate


class Gas(NamedTuple):
    """An elastic gas in equilibrium: its scene and a snapshot between collisions."""

    scene: object
    shot: object

    @property
    def number(self):
        """Number of particles."""
        return len(self.shot.position)

    @property
    def rounding(self):
        """Displacement of the gas by one rounding of each coordinate.

        The rms of a rounding is its spacing, as at half the width of the box, over root 12.
        """
        spacing = np.spacing(0.5 * np.array(self.scene.box))
        return np.sqrt(self.number * (spacing**2).sum() / 12.0)

    def advanced(self, **stop):
        """(the gas at a later time, collisions per particle in between)."""
        state = new_state(self.scene, *self.shot[1:4])
        run(state, self.scene, 1, **stop)
        later = self._replace(shot=snapshot(state, self.scene))
        return later, 2.0 * state.counts[COLLISIONS] / self.number

    def reversed(self):
        """The gas with reversed velocities and spins."""
        return self._replace(
            shot=self.shot._replace(velocity=-self.shot.velocity, spin=-self.shot.spin)
        )

    def displaced(self, step):
        """The gas with its positions, velocities and spins displaced by a step."""
        fields = zip(self.shot[1:4], step, strict=True)
        return self._replace(shot=type(self.shot)(self.shot.time, *(x + d for x, d in fields)))

    def step_to(self, target):
        """Difference of another gas in positions, velocities and spins, between nearest images."""
        x, v, w = (b - a for a, b in zip(self.shot[1:4], target.shot[1:4], strict=True))
        box = np.array(self.scene.box)
        return x - box * np.round(x / box), v, w


def length(step):
    """Euclidean norm of a step over all particles, with a = T = 1."""
    return np.sqrt(sum((d**2).sum() for d in step))


def equilibrium(experiment, beta, seed):
    """An elastic gas ten collisions per particle after its start, at a random instant."""
    scene, state = begin(experiment, 1.0, beta, seed)
    rng = np.random.default_rng(seed)
    state.spin[:] = rng.standard_normal(state.spin.shape)
    run(state, scene, 1, collisions=5 * experiment["particles"])
    run(state, scene, 1, interval=0.1 * rng.random())
    return Gas(scene, snapshot(state, scene))


def lyapunov_exponent(gas, steps, rng):
    """The largest Lyapunov exponent, per collision per particle.

    From a second path that is reset to a distance of SEPARATION after each step.
    """
    interval = gas.advanced(collisions=gas.number)[0].shot.time / 2.0
    step = [rng.standard_normal(x.shape) for x in gas.shot[1:4]]
    growth = collisions = 0.0
    for k in range(steps):
        neighbour = gas.displaced([SEPARATION / length(step) * d for d in step])
        neighbour, _ = neighbour.advanced(interval=interval)
        gas, collisions_made = gas.advanced(interval=interval)
        step = gas.step_to(neighbour)
        if k >= SETTLING:
            growth += np.log(length(step) / SEPARATION)
            collisions += collisions_made
    return growth / collisions


def return_error(gas, collisions):
    """Distance from its start of a gas that was reversed after a number of collisions per particle.

    It is reversed at the instant of a contact, which is the first contact on the way back.
    """
    reversal_point, _ = gas.advanced(collisions=round(collisions * gas.number / 2))
    returned, _ = reversal_point.reversed().advanced(interval=reversal_point.shot.time)
    return length(gas.step_to(returned.reversed()))


def errors_of_return(experiment, beta, seeds):
    """(median, smallest, predicted errors, exponent) for each of COLLISIONS_BEFORE_REVERSAL."""
    gases = [equilibrium(experiment, beta, seed) for seed in range(seeds)]
    exponent = np.mean([lyapunov_exponent(gas, 40, np.random.default_rng(7)) for gas in gases])
    errors = np.array([[return_error(gas, n) for gas in gases] for n in COLLISIONS_BEFORE_REVERSAL])
    predicted = gases[0].rounding * np.exp(exponent * COLLISIONS_BEFORE_REVERSAL)
    return np.median(errors, axis=1), errors.min(axis=1), predicted, exponent


@pytest.mark.slow
def test_reversed_gases_return_to_their_start(margins):
    """Bounds: ln(error) scatters by 1.5 from run to run, its median over 20 runs by 0.4, and its
    growth over some 20 collisions per particle by 2 %. Several flights on both ways add up to a
    prefactor of 2 to 4.
    """
    number, runs = margins.size(quick=40, full=160), margins.size(quick=20, full=120)
    disks = settings("gas", number, [np.sqrt(np.pi * number / PACKING)] * 2)
    spheres = settings("spheres", 64, [12, 12, 12])
    columns = {"collisions": COLLISIONS_BEFORE_REVERSAL}
    gases = {"rough disks": (disks, 1.0), "smooth disks": (disks, -1.0), "spheres": (spheres, 1.0)}
    for name, (experiment, beta) in gases.items():
        error, smallest_error, predicted, exponent = errors_of_return(experiment, beta, runs)
        columns |= {f"error of {name}": error, f"prediction for {name}": predicted}
        linear = predicted < LINEAR
        growth = (
            np.polyfit(COLLISIONS_BEFORE_REVERSAL[linear], np.log(error[linear]), 1)[0] / exponent
        )
        ratio = np.exp(np.mean(np.log(error[linear] / predicted[linear])))
        tried = {"tried": runs * linear.sum(), "unit": "returns"}
        quantity = f"{name}: growth of the error of return, relative to the exponent, from it"
        margins.at_most(quantity, abs(growth - 1.0), 0.1, **tried)
        margins.at_most(f"{name}: error of return, over the predicted one", ratio, 10.0, **tried)
        tried["tried"] = runs * (predicted > SATURATED).sum()
        distance = smallest_error[predicted > SATURATED].min() / np.sqrt(experiment["particles"])
        quantity = f"{name}: distance from the start where all is lost [a per particle]"
        margins.at_least(quantity, distance, 1.0, **tried)
    margins.keep("time_reversal", **columns)
