"""Energies per degree of freedom and their ratio R, from the kernel's sums over particles.

`Columns` are samples: arrays of shape (samples,) by the name of the column.

For each sample the kernel sums over all particles at that instant; the sums are a dict of arrays of
shape (samples,), named `vv_x` (sum of v_x^2), `ww` (sum of (a w)^2), `w` (sum of a w; in three
dimensions `w_x`, `w_y`, `w_z`), and for the sheared gas `yy` (sum of (y - L/2)^2) and `yv_x` (sum
of (y - L/2) v_x). In a mixture they are weighted with the masses (see
roughgas.kernel.record.columns). Units: particle radius a = mass m = time unit T = 1, so energies
are in m a^2/T^2. Each species of a mixture has its own averages, in arrays whose first axis is the
species.

R and the correlation of translation and rotation are also averaged over the collisions of pairs.
McNamara & Luding (1998) derive Lun's formula from such averages: <v_t^2> = 4 (D-1) E_tr/m and
<v_r^2> = 4 (D-1) E_rot/(q m) in a Maxwellian gas. Inverted, these give E_tr and E_rot at the
collisions.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from roughgas.base import NamedValues, Record
from roughgas.effects import inertia
from roughgas.effects.species import mixture_of
from roughgas.kernel.state import State
from roughgas.scene import Scene, shear_rate, walls_drive_flow
from roughgas.scene.settings import SceneSettings
from roughgas.statistics.errors import StandardError, blocking, degrees_of_freedom, period_means

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
    each sample.
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


def vertical_share(
    columns: Columns, translational: np.ndarray, particles: int, per_period: int
) -> NamedValues:
    """Return the share of vertical motion in the translational energy, with its errors, by name.

    It is the mean of sum m v_k^2/2 along the last axis k, the vertical, over the mean of N D
    E_trans: 1/D in an isotropic gas. The vertical velocity includes the motion of the bed as a
    whole. `columns` are the kernel's sums and `translational` is E_trans, (samples,) in the
    measured window, `particles` is N. Errors are linearised, by blocking over periods of the drive,
    of `per_period` samples.
    """
    components = _components(columns, "vv")
    vertical, total = columns[components[-1]] / 2, particles * len(components) * translational
    periods = period_means(np.array([vertical, total]), per_period)
    share = vertical.mean() / total.mean()
    return _variables("vertical_share", share, np.array([1.0, -share]) / total.mean(), periods)


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


def ratio_of_means(energies: Energies, axis: int = -1) -> np.ndarray:
    """Return R of the energies averaged along `axis`, which differs from the mean of `ratio`.

    The result has the shape of an energy without this axis.
    """
    return ratio(energies.map(lambda energy: energy.mean(axis)))


def R_at_fixed_momentum(R: float, particles: int) -> float:
    """Return R corrected for conserved momentum: with D (N - 1) translational degrees of freedom.

    `R` is the value with D N, and `particles` is N. A gas that conserves its momentum has D (N -
    1): E_tr grows by the factor N/(N - 1), so that R becomes (N - 1) R/(N - R), lower by R (1 -
    R)/N to first order.
    """
    return (particles - 1) * R / (particles - R)


def _components(columns: Columns, quantity: str) -> list[str]:
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
    the mean spin are subtracted.
    """
    q, bodies = inertia(scene.effects), state.bodies
    rate = None if scene.effects.shear is None else shear_rate(scene)
    flows = walls_drive_flow(scene.effects)
    if bodies is None:
        number = len(state.changes)
        return energies(columns, number, q, rate, mass=float(number) if flows else None)
    selected = np.full(len(bodies.mass), True) if species is None else bodies.species == species
    columns = columns if species is None else species_columns(columns, species)
    moments = (bodies.mass * bodies.inertia * bodies.radius**2)[selected]
    spins, mass = float(np.sum(moments / (q or 1.0))), float(np.sum(bodies.mass[selected]))
    return energies(columns, int(selected.sum()), q, rate, spins, mass if flows else None)


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


def driven_species_averages(
    species: Sequence[Energies],
    per_period: int,
    samples_per_value: int,
    weights: np.ndarray | None = None,
) -> NamedValues:
    """Return time averages of E_trans, E_rot and R of each species, by name.

    The result includes errors and series. `species` are the energies (samples,) of each species in
    the measured window. Errors come from blocking over periods of the drive, of `per_period`
    samples. Each value of the stored series averages `samples_per_value` samples. Averages have the
    `weights` (samples,), by default equal ones.
    """
    if not species:
        return {}
    averages = _species_averages(
        species,
        lambda energies: energies.translational,
        lambda energies: energies.rotational,
        lambda values: blocking(period_means(values, per_period))[0],
        mean=partial(np.average, weights=weights) if weights is not None else np.mean,
    )
    series = _species_series(species, lambda values: period_means(values, samples_per_value))
    return averages | {f"{name}_series": values for name, values in series.items()}


def cooling_species_averages(
    species: Sequence[Energies], total: Energies, exponent: np.ndarray, inside: np.ndarray
) -> NamedValues:
    """Return averages of E_trans, E_rot and R of each species over replicas, by name.

    The result includes errors and series. Energies have velocities in the kernel's unit, 2^exponent
    a/T; `exponent` is (replicas, samples). `species` are the energies (replicas, samples) of each
    species, and `total` the energies of all particles in the same units; `inside` selects the
    samples of the measured window. Since all energies decay together, the ratios E_species/E_trans
    are averaged, and multiplied by E_trans at the start of the measurement.
    """
    if not species:
        return {}
    E_trans = restored(total, exponent).translational
    initial_E_trans = E_trans.mean(axis=0)[np.argmax(inside)]

    def share(values):
        """Return the mean share in E_trans of each replica, (replicas,) in m a^2/T^2."""
        return initial_E_trans * (values / total.translational)[:, inside].mean(axis=1)

    averages = _species_averages(
        species,
        lambda energies: share(energies.translational),
        lambda energies: share(energies.rotational),
        lambda values: values.std(ddof=1) / np.sqrt(len(values)),
        lambda energies: ratio(energies)[:, inside].mean(axis=1),
    )
    means = [
        restored(energies, exponent).map(lambda values: values.mean(axis=0)) for energies in species
    ]
    series = _species_series(means, np.asarray)
    return averages | {f"{name}_series": values for name, values in series.items()}


def _species_averages(species, translational, rotational, error, share=ratio, mean=np.mean):
    """Return the mean and error of E_trans, E_rot and R of each species, as lists by variable name.

    `species` are the energies of each species. `translational`, `rotational` and `share` map the
    energies of a species to the values of E_trans, E_rot and R that `mean` and `error` reduce.
    """
    quantities = {"E_trans_species": translational}
    if species[0].rotational is not None:
        quantities |= {"E_rot_species": rotational, "R_species": share}
    averages = {}
    for name, quantity in quantities.items():
        by_species = [quantity(energies) for energies in species]
        averages[name] = [mean(species_values) for species_values in by_species]
        averages[f"{name}_stderr"] = [error(species_values) for species_values in by_species]
    return averages


def _species_series(species, function):
    """Return `function` of the arrays E_trans and E_rot of each species, lists by name."""
    stacked = {"E_trans_species": [function(energies.translational) for energies in species]}
    if species[0].rotational is not None:
        stacked["E_rot_species"] = [function(energies.rotational) for energies in species]
    return stacked


CONTACT_SUMS = ("v_t^2", "v_r^2", "v_t.v_r")
"""Running sums over contacts, the columns of the effect contact_averages."""


def contact_averages(
    rows: Columns, first: int, per_period: int, inertia: float, begun: Columns | None = None
) -> NamedValues:
    """Return R and the correlation of translation and rotation over collisions, by name.

    The result includes errors. The variables R_collisional and contact_correlation are defined in
    roughgas.data.point; `per_period` is the number of samples in a period of the drive.
    R_collisional = q B/(A + q B) and contact_correlation = C/sqrt(A B), where A, B and C are the
    means of v_t^2, v_r^2 and v_t.v_r over collisions, and q is `inertia`. The columns `rows` hold
    running sums, which started from zero or from the sample `begun`. Collisions before the sample
    number `first`, and in an incomplete last period, are excluded. Errors are linearised, by
    blocking over periods. All values are NaN if nothing collides or spins; the result is empty
    without these columns.
    """
    if not set(CONTACT_SUMS) <= set(rows):
        return {}
    begun = {name: rows[name][first - 1 : first] for name in CONTACT_SUMS} if first else begun
    before = (
        np.array([begun[name] for name in CONTACT_SUMS])
        if begun
        else np.zeros((len(CONTACT_SUMS), 1))
    )
    running = np.array([rows[name][first:] for name in CONTACT_SUMS])
    periods = period_means(np.diff(running, axis=1, prepend=before), per_period)
    A, B, C = np.where(periods.any(axis=1), periods.mean(axis=1), math.nan).tolist()
    R, correlation = inertia * B / (A + inertia * B), C / math.sqrt(A * B)
    slopes = np.array([-1.0 / A, 1.0 / B, 0.0]) * R * (1.0 - R)
    tilts = np.array([-0.5 * correlation / A, -0.5 * correlation / B, 1.0 / math.sqrt(A * B)])
    shared = _variables("R_collisional", R, slopes, periods)
    return shared | _variables("contact_correlation", correlation, tilts, periods)


def _variables(name, value, gradient, periods):
    """Return a variable and its error, by name.

    The error follows from linearised propagation: `gradient` (n,) has the derivatives of `value`
    with respect to the means of n quantities, and `periods` (n, periods) are their means per
    period.
    """
    stderr, blocks = blocking((gradient[:, None] * periods).sum(axis=0))
    error = StandardError(stderr, degrees_of_freedom(blocks))
    return {
        name: value,
        f"{name}_stderr": error.stderr,
        f"{name}_dof": error.dof,
        f"{name}_ci95": error.half_width(0.95),
    }


def trust_of_means(variables: Record, flag: int) -> NamedValues:
    """Return `flag` as the variable `<name>_trusted` of each mean in `variables` that has an error.

    R is omitted: it has its own flag, R_ci95_trusted. Means of species have one flag per species.
    """
    names = (name.removesuffix("_stderr") for name in variables if name.endswith("_stderr"))
    return {
        f"{name}_trusted": np.full(np.shape(variables[name]), flag)[()]
        for name in names
        if name not in ("R", "R_series")
    }
