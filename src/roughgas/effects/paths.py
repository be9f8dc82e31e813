"""Paths of particles, for the observable `mean_square_displacement`, trajectories and movies.

A path is continuous where a particle leaves a periodic box on one side and enters on the other. At
each event the kernel folds the particle back into the box; this effect counts the periods that it
is moved by. With the crossings n_k and the length L_k of axis k, the unwrapped position is x_k +
n_k L_k. Along the flow of a sheared gas it would depend on the image shift at each crossing, and is
not known.

The effect also integrates the rotation of disks: spins change at events only, so that each flight
adds spin/radius times its duration.

It is passive: a run with it has the bits of a run without it.
"""

from typing import NamedTuple

from roughgas.base.fields import Settings
from roughgas.compiling.jit import jit
from roughgas.effects.settings import register
from roughgas.kernel.mathematics import add_scaled, read, write
from roughgas.kernel.particles import radius_of


class Paths(NamedTuple):
    """Counts crossings of the periodic box, and integrates the rotation of disks."""


@jit
def count_flight(effect, account, state, i, crossings, elapsed):
    """Add the crossings and the rotation, in rad, of a flight of particle i to State.paths.

    Hook `observe_flight` (kernel.hooks), which does without the account. `crossings` are the
    periods per axis between the box and the end of the flight, `elapsed` is its duration.
    """
    counts, row = state.paths.crossings, state.label[i]
    write(counts, row, 0, add_scaled(read(counts, row, 0, crossings), crossings, 1.0))
    if state.paths.rotation is not None:
        turning = state.spin[i, 0] / radius_of(state.bodies, i)
        state.paths.rotation[row] += turning * elapsed


register(Paths, Settings, observe_flight=count_flight)
