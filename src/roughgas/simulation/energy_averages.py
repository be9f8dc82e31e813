"""Averages of R and of the energies over a measured window, with their errors.

Units: particle radius a = mass m = time unit T = 1, so energies are in m a^2/T^2. Each species of a
mixture has its own averages, in arrays whose first axis is the species.

R and the correlation of translation and rotation are also averaged over the collisions of pairs.
McNamara & Luding (1998) derive Lun's formula from such averages: <v_t^2> = 4 (D-1) E_tr/m and
<v_r^2> = 4 (D-1) E_rot/(q m) in a Maxwellian gas. Inverted, these give E_tr and E_rot at the
collisions.
"""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from roughgas.base import NamedValues, Record
from roughgas.simulation.energies import (
    CONTACT_SUMS,
    Columns,
    Energies,
    component_names,
    ratio,
    restored,
)
from roughgas.statistics.errors import (
    StandardError,
    autocorrelation_time,
    blocking,
    degrees_of_freedom,
    period_means,
)


def mean_energies_and_R(window, per_period, every):
    """Return E_trans, E_rot and R averaged over a window, with errors, by name; steady or not.

    `window` are the energies (samples,), `per_period` the samples in a period of the drive, and
    `every` is the interval between samples in T.
    """
    averages = {
        "E_trans": window.translational.mean(),
        "E_trans_stderr": blocking(period_means(window.translational, per_period))[0],
    }
    if window.rotational is None:
        return averages
    R = ratio(window)
    R_periods = period_means(R, per_period)
    stderr, blocks = blocking(R_periods)
    error, correlation_time = (
        StandardError(stderr, degrees_of_freedom(blocks)),
        autocorrelation_time(R_periods),
    )
    return averages | {
        "R": R.mean(),
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ratio_of_means": ratio_of_means(window),
        "E_rot": window.rotational.mean(),
        "E_rot_stderr": blocking(period_means(window.rotational, per_period))[0],
        "autocorrelation_time": correlation_time * per_period * every,
    }


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
    components = component_names(columns, "vv")
    vertical, total = columns[components[-1]] / 2, particles * len(components) * translational
    periods = period_means(np.array([vertical, total]), per_period)
    share = vertical.mean() / total.mean()
    return _variables("vertical_share", share, np.array([1.0, -share]) / total.mean(), periods)


def mean_spin_averages(
    spins: Sequence[np.ndarray], per_period: int, weights: np.ndarray | None = None
) -> NamedValues:
    """Return the mean spins, averaged over a window, with their errors, by name.

    `spins` come from `energies.mean_spins`, in the measured window; the result is empty if they
    are. Errors come from blocking over periods of the drive, of `per_period` samples. Averages have
    the `weights` (samples,), by default equal ones.
    """
    if not spins:
        return {}
    periods = [period_means(spin, per_period) for spin in spins]
    means = [np.average(spin, weights=weights) for spin in spins]
    averages = _variables("mean_spin", means[0], np.ones(1), periods[0][None])
    if spins[1:]:
        averages["mean_spin_species"] = means[1:]
        averages["mean_spin_species_stderr"] = [blocking(means)[0] for means in periods[1:]]
    return averages


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
