"""Momentum and angular momentum that particles pass to floor and walls, for `wall_forces`.

In a contact a particle passes the momentum J to a wall: at a thermal wall, its momentum before less
its momentum after. Its spin loses the angular momentum L = m q a (a w - a w'), with the mass m and
the radius a of the particle. About any point r the wall thus receives the angular momentum
(x - r) x J + L, x being the centre of the particle. Where a wall has a material, J acts at the
contact point x - a n, and L = a J x n, with the normal n into the gas; at a thermal wall L is drawn
independently of J.

Each side of the box that a wall closes has a sum for each component of J and L. Contacts are told
apart by their normals, which point along an axis.

The effect is passive: a run with it has the bits of a run without it.
"""

from collections.abc import Iterable
from typing import NamedTuple

from roughgas.base.fields import Settings
from roughgas.compiling.jit import jit
from roughgas.effects.contacts import AXES
from roughgas.effects.settings import register
from roughgas.effects.walls import closed_sides
from roughgas.kernel.particles import radius_of, spin_mass_of, spin_of

ABSENT = -1


class WallImpulses(NamedTuple):
    """Accumulates the momentum and the angular momentum that particles pass to each wall."""

    rows: tuple[int, ...]  # of each side of the box among the sums, at 2 axis + end; or ABSENT
    inertia: float  # q of the particles, 0 where they do not spin

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect for a SceneContext; None without floor and walls."""
        dimension, spin = len(context.box), context.effects.get("spin")
        sides = [*closed_sides(context.effects, dimension).values()]
        if not sides:
            return None
        box_sides = [(axis, end) for axis in range(dimension) for end in range(2)]
        rows = tuple(sides.index(side) if side in sides else ABSENT for side in box_sides)
        return cls(rows, 0.0 if spin is None else spin.inertia)


def columns_of_walls(walls: Iterable[str], dimension: int, spinning: bool) -> list[str]:
    """Return the column names of the sums of `walls`, by name: of J, and of L if particles spin."""
    momenta = [f"J_{axis}" for axis in AXES[:dimension]]
    angular_momenta = [f"L_{axis}" for axis in AXES[6 - 2 * dimension :]] if spinning else []
    return [f"{sum_name} {wall}" for wall in walls for sum_name in (*momenta, *angular_momenta)]


def sums(effects):
    """Return the power of velocity, 1, of each column of the sums of a scene's Effects, by name."""
    names = [name for name in effects._fields if getattr(effects, name) is not None]
    dimension = len(effects.wall_impulses.rows) // 2
    walls = closed_sides(names, dimension)
    return dict.fromkeys(columns_of_walls(walls, dimension, effects.spin is not None), 1)


@jit
def observe_impulse(effect, account, state, contact):
    """Add the momentum and the angular momentum that a Contact passes to a wall to its sums.

    Their units are m a/T and m a^2/T, in current units of velocity. Hooks `observe_wall` and
    `observe_thermal_wall` (kernel.hooks), which do without the account.
    """
    i, n, impulse, side = contact.i, contact.n, contact.impulse, 0
    for k in range(len(n)):
        if n[k] != 0.0:
            side = 2 * k + int(n[k] < 0.0)
    row, sums_of_walls = effect.rows[side], state.sums.wall_impulses
    if row == ABSENT:  # a wall of a user's effect
        return
    first = row * (len(n) if state.spin is None else 3 * len(n) - 3)
    for k in range(len(n)):
        sums_of_walls[0, first + k] += impulse[k]
    if state.spin is not None:
        before, after = contact.spins[0], spin_of(state.spin, n, i)
        moment = spin_mass_of(state.bodies, effect, i) * radius_of(state.bodies, i)
        for k in range(len(after)):
            sums_of_walls[0, first + len(n) + k] += moment * (before[k] - after[k])


register(
    WallImpulses,
    Settings,
    observe_wall=observe_impulse,
    observe_thermal_wall=observe_impulse,
    sums=sums,
)
