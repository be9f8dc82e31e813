"""Energies per degree of freedom and their ratio R, from the kernel's sums over particles.

The kernel hands over, for each sample, sums over all particles at that instant; here they are a
dict of arrays of shape (samples,), named `vv_x` (sum of v_x^2), `ww` (sum of (a w)^2), `w` (sum of
a w; in three dimensions `w_x`, `w_y`, `w_z`), and for the sheared gas `yy` (sum of (y - L/2)^2)
and `yv_x` (sum of (y - L/2) v_x). Where particles differ they weigh with their masses (see
roughgas.kernel.record.columns). Units: particle radius a = mass m = time unit T = 1, so energies
are in m a^2/T^2. Of a mixture each species has variables of its own, arrays with the species first.

R and the correlation of translation and rotation are also averaged over the collisions of pairs.
McNamara & Luding (1998) derive Lun's formula from such averages: <v_t^2> = 4 (D-1) E_tr/m and
<v_r^2> = 4 (D-1) E_rot/(q m) in a Maxwellian gas. Read backwards, these say what E_tr and E_rot are
where collisions happen.

The energy balance is how much each source has put in, and each sink taken out. Effects that do
work, and the contacts, each have an account in the kernel's ledger. All that they have booked is
the change of the energy, to rounding. Gravity has no account: its potential counts as translational
energy.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.effects import inertia
from roughgas.effects.species import mixture_of
from roughgas.kernel import hooks
from roughgas.kernel.state import EXPONENT, State
from roughgas.scene import Scene, moves_along, shear_rate
from roughgas.statistics.errors import Error, blocking, degrees_of_freedom, period_means

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


def free_of_momentum(R: float, particles: int) -> float:
    """Return R of energies for D (N - 1) translational degrees of freedom in place of D N.

    A gas that conserves its momentum has no others: E_tr is N/(N - 1) of what it is per velocity,
    so that R becomes (N - 1) R/(N - R), lower by R (1 - R)/N to first order.
    """
    return (particles - 1) * R / (particles - R)


def _components(columns: Columns, quantity: str) -> list[str]:
    """Names of the columns of a vector: `vv_x`, `vv_y`, ...; a spin in the plane has one, `w`."""
    names = [f"{quantity}_{axis}" for axis in "xyz"]
    return [name for name in [quantity, *names] if name in columns]


def species_names(experiment: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the species are called, and how many particles each has."""
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
    """Return the energies of samples, of all particles or of one species; of a sheared gas without
    mean flow and mean spin."""
    q, bodies = inertia(scene.effects), state.bodies
    rate = None if scene.effects.shear is None else shear_rate(scene)
    flows = moves_along(scene.effects)
    if bodies is None:
        number = len(state.changes)
        return energies(columns, number, q, rate, mass=float(number) if flows else None)
    which = np.full(len(bodies.mass), True) if species is None else bodies.species == species
    columns = columns if species is None else of_species(columns, species)
    moments = (bodies.mass * bodies.inertia * bodies.radius**2)[which]
    spins, mass = float(np.sum(moments / (q or 1.0))), float(np.sum(bodies.mass[which]))
    return energies(columns, int(which.sum()), q, rate, spins, mass if flows else None)


def shear_rates(columns: Columns, state: State) -> np.ndarray:
    """Return the gradient of the mean flow of samples between walls that move, in 1/T."""
    mass = len(state.changes) if state.bodies is None else np.sum(state.bodies.mass)
    return fitted_flow(columns, float(mass))[0]


def energies_of_each(columns: Columns, scene: Scene, state: State) -> list[Energies]:
    """Return the energies of the particles of each species; none where all particles are alike."""
    number = 0 if scene.effects.species is None else scene.effects.species.kinds
    return [energies_of(columns, scene, state, species) for species in range(number)]


def driven_species(parts: Sequence[Energies], per_period: int, together: int) -> dict[str, Any]:
    """Return averages over time, with errors by blocking over periods.

    `parts` are the energies (samples,) of each species in the measured window; of so many samples
    each, `together`, the stored series have the means.
    """
    if not parts:
        return {}
    found = _averages(
        parts,
        lambda part: part.translational,
        lambda part: part.rotational,
        lambda values: blocking(period_means(values, per_period))[0],
    )
    series = _of_each(parts, lambda values: period_means(values, together))
    return found | {f"{name}_series": values for name, values in series.items()}


def cooling_species(
    parts: Sequence[Energies], total: Energies, exponent: np.ndarray, inside: np.ndarray
) -> dict[str, Any]:
    """Return averages over replicas and over the samples that are `inside` the measured window.

    `parts` are the energies (replicas, samples) of each species and `total` those of all particles,
    in the same units. Since all decay together, the shares E_species/E_trans are averaged, and
    given in units of E_trans when the measurement begins.
    """
    if not parts:
        return {}
    whole = restored(total, exponent).translational
    begun = whole.mean(axis=0)[np.argmax(inside)]

    def share(values):
        return begun * (values / total.translational)[:, inside].mean(axis=1)

    found = _averages(
        parts,
        lambda part: share(part.translational),
        lambda part: share(part.rotational),
        lambda values: values.std(ddof=1) / np.sqrt(len(values)),
        lambda part: ratio(part)[:, inside].mean(axis=1),
    )
    means = [restored(part, exponent).map(lambda values: values.mean(axis=0)) for part in parts]
    series = _of_each(means, np.asarray)
    return found | {f"{name}_series": values for name, values in series.items()}


def _averages(parts, translational, rotational, error, share=ratio):
    """Return the mean and the error of both energies and of R, of each species."""
    quantities = {"E_trans_species": translational}
    if parts[0].rotational is not None:
        quantities |= {"E_rot_species": rotational, "R_species": share}
    found = {}
    for name, quantity in quantities.items():
        values = [quantity(part) for part in parts]
        found[name] = [one.mean() for one in values]
        found[f"{name}_stderr"] = [error(one) for one in values]
    return found


def _of_each(parts, function):
    """Return a function of both energies of each species, by name."""
    stacked = {"E_trans_species": [function(part.translational) for part in parts]}
    if parts[0].rotational is not None:
        stacked["E_rot_species"] = [function(part.rotational) for part in parts]
    return stacked


SUMS = ("v_t^2", "v_r^2", "v_t.v_r")
"""Columns that the effect contact_averages adds."""


def contact_averages(
    rows: Columns, first: int, per_period: int, inertia: float, begun: Columns | None = None
) -> dict[str, Any]:
    """Return variables of a point (see roughgas.data.point) from running sums over collisions.

    Collisions before the sample number `first` do not count, nor those of an incomplete last
    period. R_collisional = q B/(A + q B) and contact_correlation = C/sqrt(A B), where A, B and C
    are the means of v_t^2, v_r^2 and v_t.v_r over collisions, and q is `inertia`. Errors are those
    of the linearised ratios, by blocking over periods. All are NaN where nothing collides or spins,
    and none is there where nothing was summed. The sums were zero at the start, or as in the sample
    `begun`.
    """
    if not set(SUMS) <= set(rows):
        return {}
    begun = {name: rows[name][first - 1 : first] for name in SUMS} if first else begun
    before = np.array([begun[name] for name in SUMS]) if begun else np.zeros((len(SUMS), 1))
    running = np.array([rows[name][first:] for name in SUMS])
    periods = period_means(np.diff(running, axis=1, prepend=before), per_period)
    A, B, C = np.where(periods.any(axis=1), periods.mean(axis=1), math.nan).tolist()
    R, correlation = inertia * B / (A + inertia * B), C / math.sqrt(A * B)
    slopes = np.array([-1.0 / A, 1.0 / B, 0.0]) * R * (1.0 - R)
    tilts = np.array([-0.5 * correlation / A, -0.5 * correlation / B, 1.0 / math.sqrt(A * B)])
    shared = _variables("R_collisional", R, slopes, periods)
    return shared | _variables("contact_correlation", correlation, tilts, periods)


def _variables(name, value, gradient, periods):
    """Return a function of means with its error, from its gradient and the means (3, periods)."""
    stderr, blocks = blocking((gradient[:, None] * periods).sum(axis=0))
    error = Error(stderr, degrees_of_freedom(blocks))
    return {
        name: value,
        f"{name}_stderr": error.stderr,
        f"{name}_dof": error.dof,
        f"{name}_ci95": error.half_width(0.95),
    }


def verdicts_on_means(variables: Mapping[str, Any], known: int) -> dict[str, Any]:
    """Return `<name>_trusted` of every mean with an error but R, which has a verdict of its own.

    Means of species have a flag for each.
    """
    names = (name.removesuffix("_stderr") for name in variables if name.endswith("_stderr"))
    return {
        f"{name}_trusted": np.full(np.shape(variables[name]), known)[()]
        for name in names
        if name not in ("R", "R_series")
    }


MOTIONS = ("translation", "rotation")
CONTACTS = "contacts"
STAGES = "stages"
"""What the beginnings of stages put in, among the sources of a gas that goes through stages."""
LEAST = (
    1e-3  # of the energy: of what exchanges less, roundings of the energy are all that is missing
)


class EnergyBalance(NamedTuple):
    """The energies of all particles, in m a^2/T^2."""

    energy: np.ndarray  # (2,) of translation and rotation
    ledger: np.ndarray  # (accounts, 2) what each effect, and last the contacts, have put into them


def balance(state: State, scene: Scene) -> EnergyBalance:
    """Return the energy balance now."""
    unit = np.ldexp(1.0, 2 * int(state.counts[EXPONENT]))
    return EnergyBalance(_energy(state, scene) * unit, state.ledger[0] * unit + state.ledger[1])


def _energy(state, scene):
    """Return translational (kinetic and potential) and rotational energy, in the kernel's units.

    Velocities are those of the images that the particles last were in, as in the ledger.
    """
    dimension, gravity, spin = len(scene.box), scene.effects.gravity, scene.effects.spin
    mass, bodies = np.ones(1), state.bodies
    if bodies is not None:
        mass = bodies.mass
    translational = 0.5 * np.sum(mass[:, None] * state.trajectory[:, dimension:-1] ** 2)
    if gravity is not None:
        # free flight keeps the sum of both: take it where the flight began
        translational += gravity.acceleration * np.sum(mass * state.trajectory[:, dimension - 1])
    if spin is None:
        return np.array([translational, 0.0])
    share = mass if bodies is None else mass * bodies.inertia / spin.inertia
    rotational = 0.5 * spin.inertia * np.sum(share[:, None] * state.spin**2)
    return np.array([translational, rotational])


def energy_exchange(
    before: EnergyBalance,
    after: EnergyBalance,
    scene: Scene,
    particles: int,
    changes: np.ndarray | None = None,
) -> dict[str, Any]:
    """Return variables of a point (see roughgas.data.point): what was put in between two instants.

    With drives and spin, these say how the drives' input is shared between the two motions.
    `changes` is what the beginnings of stages have put in, (2,).
    """
    booked = (after.ledger - before.ledger) / particles
    gain = (after.energy - before.energy) / particles
    accounts = _accounts(scene)
    if changes is not None:
        accounts = accounts | {STAGES: len(booked)}
        booked = np.vstack([booked, changes / particles])
    found = {
        "source": list(accounts),
        "motion": list(MOTIONS),
        "energy_input": booked[list(accounts.values())],
        "energy_gain": gain,
        "energy_imbalance": imbalance(booked, gain, before.energy.sum() / particles),
    }
    if scene.effects.spin is None or not hooks.present(scene.effects, "drives"):
        return found
    sources = [number for name, number in accounts.items() if name not in (CONTACTS, STAGES)]
    put_in = booked[sources].sum(axis=0)
    total = put_in.sum()
    return found | {"input_spin_share": put_in[1] / total if total else math.nan}


def as_columns(books: EnergyBalance) -> Columns:
    """Return an energy balance as columns of one sample."""
    found = {f"energy {k}": books.energy[k : k + 1] for k in range(len(MOTIONS))}
    parts = np.ndenumerate(books.ledger)
    return found | {f"booked {account} {k}": np.array([one]) for (account, k), one in parts}


def exchange_series(
    columns: Columns,
    before: EnergyBalance,
    scene: Scene,
    particles: int,
    changes: np.ndarray,
    counts: Sequence[int],
) -> dict[str, np.ndarray]:
    """Return what was put in up to each sample since `before`, and the gain of energy.

    `changes` is what the beginning of each stage has put in, (stages, 2), and `counts` are the
    samples of each stage.
    """

    def motions(name):
        return np.stack([columns[f"{name} {k}"] for k in range(len(MOTIONS))], axis=1)

    accounts = _accounts(scene).values()
    booked = [motions(f"booked {account}") - before.ledger[account] for account in accounts]
    booked.append(np.repeat(changes.cumsum(axis=0), counts, axis=0))
    return {
        "energy_input_series": np.stack(booked, axis=1) / particles,
        "energy_gain_series": (motions("energy") - before.energy) / particles,
    }


def imbalance(booked: np.ndarray, gain: np.ndarray, energy: float = 0.0) -> float:
    """Return the largest energy of a motion that the balance does not explain, over all exchanged.

    Where hardly anything is exchanged, as by particles that are nearly elastic and smooth, it is
    over a thousandth of the `energy` that was there, whose roundings are missing.
    """
    exchanged = max(np.abs(booked).sum(), LEAST * energy)
    missing = np.abs(gain - booked.sum(axis=0)).max()
    return float(missing / exchanged) if exchanged > 0.0 else float(missing)


def _accounts(scene):
    """Return name -> number of the accounts that can change: those of effects that do work."""
    effects = scene.effects
    working = [part for hook in ("resolve", "transfer") for part in hooks.present(effects, hook)]
    ranks = {effects._fields[part.place]: part.rank for part in working}
    return dict(sorted(ranks.items(), key=lambda item: item[1])) | {
        CONTACTS: hooks.accounts(effects)
    }
