"""`roughgas theory`: predictions of R and of relaxation, at a point or along a curve, with the
equations that they come from.

R = E_rot/(E_rot + E_trans), from energies per degree of freedom; r is the normal restitution, beta
the roughness, q = I/(m a^2) the moment of inertia. Rates are per collision per particle.
"""

import csv
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas import theory
from roughgas.base import Interval, NamedValues, NeedsError, Record, as_json, columns
from roughgas.base.labels import grid_points
from roughgas.base.reading import parse_yaml, read_yaml
from roughgas.cli.values import labels, number
from roughgas.theory.arguments import FRICTION, SHARE, check, moment_of_inertia
from roughgas.theory.prediction import equation_of, predicted_ratio


class Quantity(NamedTuple):
    """A predicted quantity: an array over the points, its meaning, and its `source`, the name of
    its equation, as texts."""

    values: Any
    meaning: str
    source: str


class GasParameters(NamedTuple):
    """Points (r, beta), arrays of equal shape, and the parameters that they share.

    `inertia` is q = I/(m a^2), `spin_share` the share of the drive's power that goes into rotation.
    `mu`, Coulomb's coefficient, is None without friction. The species of a mixture are as in
    config.yaml; its `inertia` is the default of species. `packing` is the share of the box that
    particles fill.
    """

    r: Any
    beta: Any
    dimension: int
    inertia: float
    spin_share: float
    mu: float | None
    species: Sequence[Mapping[str, Any]] | None = None
    packing: float = 0.0  # matters only for mixtures


TOLERANCE = 0.01  # relative deviation of R below which it counts as settled
PAPER = "S. McNamara, S. Luding, Phys. Rev. E 58, 2247 (1998)"
SOURCE = "rate equations of mixtures"
NOTES = f"Rates are per collision per particle. Equations: docs/physics.md, and\n{PAPER}."


Tables = Sequence[tuple[GasParameters, Mapping[str, Quantity]]]
"""Gases with the same points, each with its quantities by name."""


def print_tables(gases: Iterable[GasParameters], json: bool, csv: bool) -> None:
    """Print the quantities of gases with the same points: as text, as JSON if `json`, as CSV if
    `csv`."""
    tables = [(gas, quantities(gas)) for gas in gases]
    if csv:
        _write_csv(tables)
    elif json:
        print(as_json(_json_record(tables)))
    else:
        print(
            f"{_point_text(tables) if len(tables[0][0].r) == 1 else _curve_text(tables)}\n{NOTES}"
        )


def gases(
    r: Sequence[str],
    beta: Sequence[str],
    dimension: str | None,
    inertia: str | None,
    spin_share: str,
    mu: str | None,
    species: str | None,
    packing: str,
) -> list[GasParameters]:
    """Return the gases at all (r, beta) from the texts of the command's options: of disks and of
    spheres if no dimension is given.

    Without `inertia` particles are uniform; without `mu` there is no friction. `species` is YAML or
    the path of a YAML file, None for identical particles. Raises InputError for illegal values.
    """
    points = grid_points(labels("--r", r), labels("--beta", beta), ["1"], prefix="--")
    restitution, roughness = np.array([(point.r, point.beta) for point in points]).T
    share = SHARE.check("spin share of the drive", number("--spin-share", spin_share))
    friction = q = None
    if mu is not None:
        friction = FRICTION.check("friction mu", number("--mu", mu))
    if inertia is not None:
        q = float(check("inertia q", number("--inertia", inertia)))
    packing_fraction = number("--packing", packing, Interval("[0, 1)"))
    if packing_fraction and species is None:
        raise NeedsError("--packing", "--species: one species has the same R at any packing")
    mixture = None if species is None else species_of_text(species), packing_fraction
    dimensions = [int(dimension)] if dimension else [2, 3]
    return [
        GasParameters(
            restitution, roughness, D, q or moment_of_inertia(D), share, friction, *mixture
        )
        for D in dimensions
    ]


def quantities(gas: GasParameters) -> dict[str, Quantity]:
    """Return the quantities that theory predicts of a gas, by name, such as R_driven."""
    if gas.species is not None:
        return quantities_of_mixture(gas)
    settings = {"dimension": gas.dimension, "inertia": gas.inertia, "spin_share": gas.spin_share}
    if gas.mu is not None:
        settings["mu"] = gas.mu
    drive = "through translation" if gas.spin_share == 0.0 else f"spin share {gas.spin_share:g}"
    results = {}
    for name, equation, drive_text in (
        ("driven", "lun", f"driven, {drive}"),
        ("cooling", "K", "cooling"),
    ):
        theory_settings = settings | {"theory": equation}
        R = predicted_ratio(theory_settings, gas.r, gas.beta)
        results[f"R_{name}"] = Quantity(R, f"R, {drive_text}", equation_of(theory_settings).name)
        if gas.mu is None:
            share = gas.spin_share if equation == "lun" else None
            R = theory.sonine_state(gas.r, gas.beta, gas.dimension, gas.inertia, share).R
            drive_note = " by white noise" if equation == "lun" else ""
            meaning = f"the same{drive_note}, not Maxwellian"
            results[f"R_{name}_sonine"] = Quantity(R, meaning, "Sonine approximation")
    return results | (_relaxation_quantities(gas) if gas.mu is None else _friction_quantities(gas))


def _relaxation_quantities(gas: GasParameters) -> dict[str, Quantity]:
    """Return, by name, the relaxation rate of R, the collisions per particle until it settles, and
    the decay rate of energy of a gas without friction."""
    point, source = (gas.r, gas.beta), "rate equations"
    spins = {"dimension": gas.dimension, "inertia": gas.inertia}
    meaning = f"collisions per particle to reach R within {TOLERANCE:.0%}"
    results = {}
    for name, share in (("driven", gas.spin_share), ("cooling", None)):
        rate = theory.relaxation_rate(*point, **spins, spin_share=share)
        collisions = theory.collisions_to_relax(*point, TOLERANCE, **spins, spin_share=share)
        results[f"rate_{name}"] = Quantity(rate, f"rate at which R settles, {name}", source)
        results[f"settled_{name}"] = Quantity(collisions, f"{meaning}, {name}", source)
    decay = theory.decay_rate(*point, **spins)
    return results | {
        "decay": Quantity(decay, "rate at which energy decays, cooling", "Haff's law")
    }


def _friction_quantities(gas: GasParameters) -> dict[str, Quantity]:
    """Return, by name, the relaxation rate of R, the share of sliding contacts, and the critical
    friction of a gas with Coulomb friction."""
    spins, source = (gas.mu, gas.dimension, gas.inertia), "rate equations with Coulomb friction"
    rate = theory.friction_relaxation_rate(gas.r, gas.beta, *spins)
    R = theory.friction_ratio(gas.r, gas.beta, *spins, gas.spin_share)
    sliding = theory.sliding_fraction(1.0 - R, R, gas.r, gas.beta, *spins)
    critical = "mu below which a gas of fast spins keeps them, cooling"
    return {
        "rate_cooling": Quantity(rate, "rate at which R settles, cooling", source),
        "sliding": Quantity(sliding, "share of contacts that slide, driven", source),
        "mu_c": Quantity(theory.critical_friction(gas.r), critical, "sqrt((1 - r)/(1 + r))"),
    }


def _point_text(tables: Tables) -> str:
    """Return a table of one point as text: a row for each quantity, a column for each gas of
    `tables`."""
    gas, first = tables[0]
    friction = "" if gas.mu is None else f", mu = {gas.mu:g}"
    rows = [[f"r = {gas.r[0]:g}, beta = {gas.beta[0]:g}{friction}", *_gas_titles(tables), ""]]
    for name, quantity in first.items():
        numbers = [f"{results[name].values.flat[0]:.5g}" for _, results in tables]
        numbers = ["none" if text == "nan" else text for text in numbers]
        rows.append([quantity.meaning, *numbers, _source_text(tables, name)])
    return f"{columns(rows)}\n"


def _curve_text(tables: Tables) -> str:
    """Return a table as text, a row for each point of each gas of `tables`; below, the meaning and
    equation of each column."""
    first = tables[0][1]
    rows = [["D", "r", "beta", *first]]
    rows += [[f"{value:.5g}" for value in row.values()] for row in _rows(tables)]
    meanings = [
        [name, quantity.meaning, _source_text(tables, name)] for name, quantity in first.items()
    ]
    inertia = " and ".join(_gas_titles(tables))
    return f"{columns(rows, numbers=True)}\n\n{columns(meanings)}\n\n{inertia}."


def _json_record(tables: Tables) -> NamedValues:
    """Return the points of all gases of `tables` for JSON, with their parameters and the meanings
    and equations of quantities."""
    gas, first = tables[0]
    descriptions = {}
    for name, quantity in first.items():
        sources = {str(gas.dimension): results[name].source for gas, results in tables}
        descriptions[name] = {"meaning": quantity.meaning, "source": sources}
    return {
        "inertia": {str(gas.dimension): gas.inertia for gas, _ in tables},
        "spin_share": gas.spin_share,
        "mu": gas.mu,
        **({} if gas.species is None else {"species": gas.species, "packing": gas.packing}),
        "reference": PAPER,
        "quantities": descriptions,
        "points": list(_rows(tables)),
    }


def _write_csv(tables: Tables) -> None:
    """Print as CSV a row for each point of each gas of `tables`; the last column names the equation
    of each quantity."""
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["dimension", "r", "beta", *tables[0][1], "sources"])
    for gas, results in tables:
        sources = "; ".join(f"{name}: {quantity.source}" for name, quantity in results.items())
        for row in _rows([(gas, results)]):
            table.writerow([*(format(value, ".10g") for value in row.values()), sources])


def _gas_titles(tables: Tables) -> list[str]:
    """Return the title of each gas of `tables`: dimension and moment of inertia."""
    return [f"{gas.dimension}D, q = {gas.inertia:g}" for gas, _ in tables]


def _source_text(tables: Tables, name: str) -> str:
    """Return the equations of the quantity `name` for all gases of `tables`, without repetition."""
    return "; ".join(dict.fromkeys(results[name].source for _, results in tables))


def _rows(tables: Tables) -> Iterator[dict[str, float]]:
    """Yield, by name, the dimension, r, beta and all quantities of each point of each gas of
    `tables`."""
    for gas, results in tables:
        values = {"r": gas.r, "beta": gas.beta} | {
            name: quantity.values for name, quantity in results.items()
        }
        arrays = np.broadcast_arrays(*values.values())
        for row in zip(*arrays, strict=True):
            yield {"dimension": gas.dimension} | dict(zip(values, row, strict=True))


def species_of_text(text: str) -> Sequence[Record]:
    """Return the species of a mixture from YAML, or from the path of a YAML file, which may list
    them under `species`.

    A text that begins with a bracket is YAML. Raises InputError for another text, and as
    `theory.mixture`; OSError for a missing file.
    """
    content = parse_yaml(text, "--species") if text.lstrip().startswith("[") else read_yaml(text)
    if isinstance(content, Mapping):
        content = content.get("species", content)
    theory.mixture(content, 1.0, 1.0)
    species: Sequence[Record] = content
    return species


def quantities_of_mixture(gas: GasParameters) -> dict[str, Quantity]:
    """Return the quantities that theory predicts of a mixture, by name, such as R_driven for all
    particles and R_driven_NAME for a species."""
    points = [
        _quantities_at_point(gas, *coordinates) for coordinates in zip(gas.r, gas.beta, strict=True)
    ]
    return {
        name: Quantity(np.array([point[name].values for point in points]), *description)
        for name, (_, *description) in points[0].items()
    }


def _quantities_at_point(gas: GasParameters, r: float, beta: float) -> dict[str, Quantity]:
    """Return the quantities of a mixture at a single (r, beta), by name: R and the translational
    temperature of each species, R of all, and the rates of cooling.

    A temperature is in units of its mean over all particles.
    """
    mu = np.inf if gas.mu is None else gas.mu
    mixture = theory.mixture(gas.species, r, beta, gas.dimension, gas.inertia, mu)
    kick_powers, share = theory.kick_power(mixture), gas.spin_share
    states = {
        "driven": theory.mixture_driven(mixture, (1 - share) * kick_powers, gas.packing, share),
        "cooling": theory.mixture_cooling(mixture, gas.packing),
    }
    results = {}
    for drive, state in states.items():
        results[f"R_{drive}"] = Quantity(state.overall_ratio(mixture), f"R of all, {drive}", SOURCE)
        for k, settings in enumerate(gas.species or ()):
            name = str(settings.get("name", k + 1))
            results[f"R_{drive}_{name}"] = Quantity(state.R[k], f"R of {name}, {drive}", SOURCE)
            meaning = f"T_tr of {name} over its mean, {drive}"
            results[f"T_{drive}_{name}"] = Quantity(state.T_tr[k], meaning, SOURCE)
    rates = theory.mixture_relaxation_rate, theory.mixture_decay_rate
    relaxation_rate, decay_rate = (rate(mixture, gas.packing) for rate in rates)
    results["rate_cooling"] = Quantity(
        relaxation_rate, "rate at which ratios settle, cooling", SOURCE
    )
    return results | {"decay": Quantity(decay_rate, "rate at which energy decays, cooling", SOURCE)}
