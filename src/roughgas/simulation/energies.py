"""Energies per degree of freedom and their ratio R, from the kernel's sums over particles.

`Columns` are samples: arrays of shape (samples,) by the name of the column.

For each sample the kernel sums over all particles at that instant; the sums are a dict of arrays of
shape (samples,), named `vv_x` (sum of v_x^2), `ww` (sum of (a w)^2), `w` (sum of a w; in three
dimensions `w_x`, `w_y`, `w_z`), and for the sheared gas `yy` (sum of (y - L/2)^2) and `yv_x` (sum
of (y - L/2) v_x). In a mixture they are weighted with the masses (see
roughgas.kernel.record.columns). Units: particle radius a = mass m = time unit T = 1, so energies
are in m a^2/T^2. roughgas.simulation.energy_averages averages them over a window.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from roughgas.base import NamedValues
from roughgas.effects import inertia
from roughgas.effects.species import mixture_of
from roughgas.kernel.state import State
from roughgas.scene import Scene, rotation_of_medium, shear_rate, walls_drive_flow
from roughgas.scene.settings import SceneSettings

Columns = Mapping[str, np.ndarray]


class Energies(NamedTuple):
    """Energies per degree of freedom, in m a^2/T^2: McNamara & Luding (1998), Eq. (defE).

    The arrays have the samples along the last axis.
    """

    translational: np.ndarray
    rotational: np.ndarray | None = None  # None without spin

    def present_components(self) -> list[np.ndarray]:
        """Return the energies that are not None: translational, then rotational."""
        return [component for component in self if component is not None]

    def map(self, function: Callable[[np.ndarray], np.ndarray]) -> "Energies":
        """Return the energies after `function` was applied to each component that is not None."""
        return Energies(*map(function, self.present_components()))


def energies(
    columns: Columns,
    particles: int,
    inertia: float | None,
    shear_rate: float | None = None,
    spins: float | None = None,
    mass: float | None = None,
    about_mean_spin: bool = False,
) -> Energies:
    """Return E_tr = sum m v^2/2 / (N D) and E_rot = sum m q (a w)^2/2 / (N n_r) of each sample.

    `columns` are the kernel's sums over particles, see the module's docstring. `particles` is N and
    `inertia` is q (1/2 for disks, 2/5 for spheres), None without spin. D is the number of `vv_`
    columns, and n_r = 2 D - 3. McNamara & Luding (1998), Eq. (defE).

    With a `shear_rate` Gamma (1/T) the mean flow and the mean spin are subtracted, as in their
    second experiment. The mean flow is v_x = Gamma (y - L/2); the square of the difference expands
    in the columns. The mean spin is measured in each sample: sum (w - <w>)^2 = sum w^2 - (sum
    w)^2/N. Subtracting it takes one of N spins from E_rot, just as the conserved momentum takes one
    of N velocities from E_tr, so that their ratio has no bias of order 1/N. In a mixture it is the
    mean angular velocity, weighted with the moments of inertia; `spins` is the sum of these over q,
    by default N.

    Between walls that move along themselves the mean flow is unknown beforehand. If the total
    `mass` of the particles is given, the flow is the straight line that best fits the velocities of
    each sample. With `about_mean_spin` the mean spin alone is subtracted.
    """
    components = component_names(columns, "vv")
    speed_squared = np.asarray(sum(columns[name] for name in components))
    spin_squared = columns.get("ww")
    if shear_rate is not None:
        flow = shear_rate * (shear_rate * columns["yy"] - 2 * columns["yv_x"])
        speed_squared = speed_squared + flow
    if mass is not None:
        speed_squared = speed_squared - fitted_flow(columns, mass)[1]
    flows = shear_rate is not None or mass is not None
    if (flows or about_mean_spin) and spin_squared is not None:
        mean_spin = sum(columns[name] ** 2 for name in component_names(columns, "w")) / (
            spins or particles
        )
        spin_squared = spin_squared - mean_spin
        spin_squared = np.maximum(spin_squared, 0.0)  # a rounding error where all spins are equal
    translational = speed_squared / (2 * particles * len(components))
    if spin_squared is None or inertia is None:
        return Energies(translational)
    return Energies(
        translational, inertia * spin_squared / (2 * particles * (2 * len(components) - 3))
    )


def fitted_flow(columns: Columns, mass: float) -> tuple[np.ndarray, np.ndarray]:
    """Return, for each sample, the gradient of its mean flow, and the flow's sum of m v_x^2.

    The flow is the straight line v_x(y) that fits the velocities best; the gradient is in 1/T.
    `mass` is the total mass of the particles.
    """
    height, speed = columns["y"] / mass, columns["p_x"] / mass
    spread = columns["yy"] - mass * height**2
    rate = (columns["yv_x"] - mass * height * speed) / spread
    return rate, rate**2 * spread + mass * speed**2


def species_columns(columns: Columns, species: int) -> Columns:
    """Return the columns of one species, by their names without its number in brackets.

    `species` is the species' number, from 0.
    """
    ending = f"[{species}]"
    names = (name for name in columns if name.endswith(ending))
    return {name.removesuffix(ending): columns[name] for name in names}


def restored(energies: Energies, exponent: np.ndarray) -> Energies:
    """Return energies in m a^2/T^2, converted from the kernel's unit of velocity, 2^exponent a/T.

    `exponent` is an integer for each sample. Energies below the smallest number become zero.
    """
    power = 2 * np.asarray(exponent, int)
    return energies.map(lambda energy: np.ldexp(energy, power))


def ratio(energies: Energies) -> np.ndarray:
    """Return R = E_rot / (E_rot + E_tr) of each sample, in [0, 1]; NaN if both energies vanish."""
    rotational = np.asarray(energies.rotational)
    total = rotational + energies.translational
    return np.divide(rotational, total, out=np.full(np.shape(total), np.nan), where=total > 0)


def component_names(columns: Columns, quantity: str) -> list[str]:
    """Return the column names of a vector: `vv_x`, `vv_y`, ...; `w` alone for spins of disks.

    `quantity` is the name of the vector: `vv` or `w`.
    """
    names = [f"{quantity}_{axis}" for axis in "xyz"]
    return [name for name in [quantity, *names] if name in columns]


def species_names(experiment: SceneSettings) -> NamedValues:
    """Return the names and particle numbers of the species as variables; empty without species."""
    mixture = mixture_of(experiment)
    if mixture is None:
        return {}
    return {
        "species": [kind.name for kind in mixture.kinds],
        "species_particles": [kind.number for kind in mixture.kinds],
    }


def energies_of(
    columns: Columns, scene: Scene, state: State, species: int | None = None
) -> Energies:
    """Return the energies of samples, over all particles or over the species with this number.

    `columns` are the samples of the kernel, and `state` is any state of the same gas, which gives
    the number, masses and species of its particles. Energies are in the unit of the columns'
    velocities. In a sheared gas, and between walls that move along themselves, the mean flow and
    the mean spin are subtracted; in a bath whose medium rotates, the mean spin of each species.
    """
    q, bodies = inertia(scene.effects), state.bodies
    rate = None if scene.effects.shear is None else shear_rate(scene)
    flows = walls_drive_flow(scene.effects)
    rotates = rotation_of_medium(scene.effects) is not None
    if bodies is None:
        number = len(state.changes)
        return energies(
            columns, number, q, rate, mass=float(number) if flows else None, about_mean_spin=rotates
        )
    selected = np.full(len(bodies.mass), True) if species is None else bodies.species == species
    of_selected = columns if species is None else species_columns(columns, species)
    spins, mass = _sum_of_moments(state, scene, selected), float(np.sum(bodies.mass[selected]))
    total = energies(
        of_selected, int(selected.sum()), q, rate, spins, mass if flows else None, rotates
    )
    if species is not None or not rotates:
        return total
    by_species = species_energies(columns, scene, state)
    rotational = [np.asarray(species_energy.rotational) for species_energy in by_species]
    weights = np.bincount(bodies.species)
    return total._replace(rotational=np.average(rotational, axis=0, weights=weights))


def _sum_of_moments(state: State, scene: Scene, selected: np.ndarray) -> float:
    """Return the sum of moments of inertia of `selected` particles over q of the scene, in m a^2.

    `selected` is a mask (N,) of particles of a mixture.
    """
    bodies = state.bodies
    assert bodies is not None
    moments = (bodies.mass * bodies.inertia * bodies.radius**2)[selected]
    return float(np.sum(moments / (inertia(scene.effects) or 1.0)))


def mean_spins(columns: Columns, scene: Scene, state: State) -> list[np.ndarray]:
    """Return the mean spins of samples in a bath whose medium rotates, each (samples,) in a/T.

    The first is over all particles, the others are over each species, if there are several. A mean
    spin is a times the mean angular velocity about the axis of the medium, weighted with the
    moments of inertia. Other gases have none. Arguments as in `energies_of`.
    """
    rotation, bodies = rotation_of_medium(scene.effects), state.bodies
    if rotation is None:
        return []
    name = component_names(columns, "w")[rotation.axis]
    if bodies is None:
        return [columns[name] / len(state.changes)]
    masks = [np.full(len(bodies.mass), True)]
    masks += [bodies.species == species for species in range(len(bodies.pairs))]
    names = [name, *(f"{name}[{species}]" for species in range(len(bodies.pairs)))]
    return [
        columns[column] / _sum_of_moments(state, scene, mask)
        for column, mask in zip(names, masks, strict=True)
    ]


def shear_rates(columns: Columns, state: State) -> np.ndarray:
    """Return the gradient of the mean flow between moving walls, (samples,) in 1/T."""
    mass = len(state.changes) if state.bodies is None else np.sum(state.bodies.mass)
    return fitted_flow(columns, float(mass))[0]


def species_energies(columns: Columns, scene: Scene, state: State) -> list[Energies]:
    """Return the energies of samples for each species in turn.

    The list is empty if all particles are identical.
    """
    number = 0 if scene.effects.species is None else scene.effects.species.kinds
    return [energies_of(columns, scene, state, species) for species in range(number)]


CONTACT_SUMS = ("v_t^2", "v_r^2", "v_t.v_r")
"""Running sums over contacts, the columns of the effect contact_averages."""
