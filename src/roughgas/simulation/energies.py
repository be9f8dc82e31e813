"""Energies per degree of freedom and their ratio R, from the kernel's sums over particles.

The kernel hands over, for each sample, sums over all particles at that instant; here they are a
dict of arrays of shape (samples,), named `vv_x` (sum of v_x^2), `ww` (sum of (a w)^2), `w` (sum of
a w; in three dimensions `w_x`, `w_y`, `w_z`), and for the sheared gas `yy` (sum of (y - L/2)^2)
and `yv_x` (sum of (y - L/2) v_x). Where particles differ they weigh with their masses (see
roughgas.kernel.record.columns). Units: particle radius a = mass m = time unit T = 1, so energies
are in m a^2/T^2.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

Columns = Mapping[str, np.ndarray]


class Energies(NamedTuple):
    """Energies per degree of freedom, in m a^2/T^2: McNamara & Luding (1998), Eq. (defE)."""

    translational: np.ndarray
    rotational: np.ndarray | None = None  # None where particles do not spin

    def there(self) -> list[np.ndarray]:
        """Those that are there."""
        return [part for part in self if part is not None]

    def map(self, function: Callable[[np.ndarray], np.ndarray]) -> "Energies":
        """The energies that a function makes of those that are there."""
        return Energies(*map(function, self.there()))


def energies(
    columns: Columns,
    particles: int,
    inertia: float | None,
    shear_rate: float | None = None,
    spins: float | None = None,
    mass: float | None = None,
) -> Energies:
    """Return E_tr = sum m v^2/2 / (N D) and E_rot = sum m q (a w)^2/2 / (N n_r).

    `particles` is N and `inertia` q (1/2 for disks, 2/5 for spheres), None where none spins. There
    are as many dimensions D as `vv_` columns, and n_r = 2 D - 3. McNamara & Luding (1998),
    Eq. (defE).

    With a `shear_rate` Gamma (1/T) these are the energies that remain without the mean flow and the
    mean spin, as in their second experiment. The mean flow is v_x = Gamma (y - L/2); the square of
    v_x minus that expands in the columns. The mean spin is the one observed in each sample:
    sum (w - <w>)^2 = sum w^2 - (sum w)^2/N. Removing it takes one of N spins from E_rot, just as
    the conserved momentum takes one of N velocities from E_tr, so that their ratio has no bias of
    order 1/N. Where particles differ it is the mean angular velocity, weighted with the moments of
    inertia; `spins` is the sum of these over q, N if not given.

    Between walls that move along themselves the mean flow is not known before. If the `mass` of the
    particles is given, it is the straight line that fits the velocities of each sample best.
    """
    components = _components(columns, "vv")
    speed_squared = np.asarray(sum(columns[name] for name in components))
    spin_squared = columns.get("ww")
    if shear_rate is not None:
        flow = shear_rate * (shear_rate * columns["yy"] - 2 * columns["yv_x"])
        speed_squared = speed_squared + flow
    if mass is not None:
        speed_squared = speed_squared - fitted_flow(columns, mass)[1]
    if (shear_rate is not None or mass is not None) and spin_squared is not None:
        mean_spin = sum(columns[name] ** 2 for name in _components(columns, "w")) / (
            spins or particles
        )
        spin_squared = spin_squared - mean_spin
    translational = speed_squared / (2 * particles * len(components))
    if spin_squared is None or inertia is None:
        return Energies(translational)
    return Energies(
        translational, inertia * spin_squared / (2 * particles * (2 * len(components) - 3))
    )


def fitted_flow(columns: Columns, mass: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the gradient of the line that fits v_x over y best, and the sum of its m v_x^2."""
    height, speed = columns["y"] / mass, columns["p_x"] / mass
    spread = columns["yy"] - mass * height**2
    rate = (columns["yv_x"] - mass * height * speed) / spread
    return rate, rate**2 * spread + mass * speed**2


def of_species(columns: Columns, kind: int) -> Columns:
    """The columns of one species."""
    ending = f"[{kind}]"
    own = (name for name in columns if name.endswith(ending))
    return {name.removesuffix(ending): columns[name] for name in own}


def restored(energies: Energies, exponent: np.ndarray) -> Energies:
    """Energies in m a^2/T^2 from those of a gas whose unit of velocity is 2^exponent a/T.

    What is smaller than the smallest number becomes zero.
    """
    power = 2 * np.asarray(exponent, int)
    return energies.map(lambda part: np.ldexp(part, power))


def ratio(energies: Energies) -> np.ndarray:
    """R = E_rot / (E_rot + E_tr) of each sample, in [0, 1]; NaN where both energies vanish."""
    rotational = np.asarray(energies.rotational)
    total = rotational + energies.translational
    return np.divide(rotational, total, out=np.full(np.shape(total), np.nan), where=total > 0)


def ratio_of_means(energies: Energies, axis: int = -1) -> np.ndarray:
    """R of the energies averaged along `axis`: not the same as the mean of `ratio`."""
    return ratio(energies.map(lambda part: part.mean(axis)))


def _components(columns: Columns, quantity: str) -> list[str]:
    """Names of the columns of a vector: `vv_x`, `vv_y`, ...; a spin in the plane has one, `w`."""
    names = [f"{quantity}_{axis}" for axis in "xyz"]
    return [name for name in [quantity, *names] if name in columns]
