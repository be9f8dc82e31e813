"""`roughgas theory`: what theory says of R, at a point or along a curve, and by which equations."""

import csv
import sys
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas import config, theory
from roughgas.base import Interval, NeedsError, as_json, columns
from roughgas.cli.parser import labels, number
from roughgas.config.reading import parse_yaml, read_yaml
from roughgas.theory.arguments import FRICTION, SHARE, check, moment_of_inertia
from roughgas.theory.prediction import equation_of, predicted_ratio


class Quantity(NamedTuple):
    """An array over the points, what it is, and which equation it is from."""

    values: Any
    meaning: str
    source: str


class GasParameters(NamedTuple):
    """Points (r, beta), arrays of equal shape, and what they share; no friction: `mu` is None.

    The species of a mixture are as in config.yaml; its `inertia` is that of species without one.
    """

    r: Any
    beta: Any
    dimension: int
    inertia: float
    spin_share: float
    mu: float | None
    species: Sequence[Mapping[str, Any]] | None = None
    packing: float = 0.0  # matters for mixtures alone


TOLERANCE = 0.01  # of R, within which it counts as settled
PAPER = "S. McNamara, S. Luding, Phys. Rev. E 58, 2247 (1998)"
SOURCE = "rate equations of mixtures"
NOTES = f"Rates are per collision per particle. Equations: docs/physics.md, and\n{PAPER}."


Tables = Sequence[tuple[GasParameters, Mapping[str, Quantity]]]
"""All quantities of each gas; the gases have the same points."""


def print_theory(options: Namespace) -> None:
    """Print theory's numbers."""
    tables = [(gas, quantities(gas)) for gas in _gases(options)]
    if options.csv:
        _write_csv(tables)
    elif options.json:
        print(as_json(_record(tables)))
    else:
        print(f"{_point(tables) if len(tables[0][0].r) == 1 else _curve(tables)}\n{NOTES}")


def _gases(options: Namespace) -> list[GasParameters]:
    """Return the gas, or those of both dimensions, at all (r, beta) of the axes.

    Raises InputError for illegal values.
    """
    given = labels("--r", options.r), labels("--beta", options.beta)
    at = config.places(*given, ["1"], prefix="--")
    r, beta = np.array([(one.r, one.beta) for one in at]).T
    share = SHARE.check("spin share of the drive", number("--spin-share", options.spin_share))
    mu = q = None
    if options.mu is not None:
        mu = FRICTION.check("friction mu", number("--mu", options.mu))
    if options.inertia is not None:
        q = float(check("inertia q", number("--inertia", options.inertia)))
    packing = number("--packing", options.packing, Interval("[0, 1)"))
    if packing and options.species is None:
        raise NeedsError("--packing", "--species: one species has the same R at any packing")
    mixed = None if options.species is None else species_from(options.species), packing
    dimensions = [int(options.dimension)] if options.dimension else [2, 3]
    inertia = {D: q or moment_of_inertia(D) for D in dimensions}
    return [GasParameters(r, beta, D, inertia[D], share, mu, *mixed) for D in dimensions]


def quantities(gas: GasParameters) -> dict[str, Quantity]:
    """Return all that theory says of a gas, by name."""
    if gas.species is not None:
        return quantities_of_mixture(gas)
    about = {"dimension": gas.dimension, "inertia": gas.inertia, "spin_share": gas.spin_share}
    if gas.mu is not None:
        about["mu"] = gas.mu
    drive = "through translation" if gas.spin_share == 0.0 else f"spin share {gas.spin_share:g}"
    found = {}
    for name, kind, way in (("driven", "lun", f"driven, {drive}"), ("cooling", "K", "cooling")):
        obeying = about | {"theory": kind}
        R = predicted_ratio(obeying, gas.r, gas.beta)
        found[f"R_{name}"] = Quantity(R, f"R, {way}", equation_of(obeying).name)
        if gas.mu is None:
            share = gas.spin_share if kind == "lun" else None
            R = theory.sonine_state(gas.r, gas.beta, gas.dimension, gas.inertia, share).R
            kicked = " by white noise" if kind == "lun" else ""
            meaning = f"the same{kicked}, not Maxwellian"
            found[f"R_{name}_sonine"] = Quantity(R, meaning, "Sonine approximation")
    return found | (_relaxation(gas) if gas.mu is None else _friction(gas))


def _relaxation(gas: GasParameters) -> dict[str, Quantity]:
    """Return how fast R settles and energy decays."""
    point, source = (gas.r, gas.beta), "rate equations"
    spins = {"dimension": gas.dimension, "inertia": gas.inertia}
    until = f"collisions per particle to reach R within {TOLERANCE:.0%}"
    found = {}
    for name, share in (("driven", gas.spin_share), ("cooling", None)):
        rate = theory.relaxation_rate(*point, **spins, spin_share=share)
        needed = theory.collisions_to_relax(*point, TOLERANCE, **spins, spin_share=share)
        found[f"rate_{name}"] = Quantity(rate, f"rate at which R settles, {name}", source)
        found[f"settled_{name}"] = Quantity(needed, f"{until}, {name}", source)
    decay = theory.decay_rate(*point, **spins)
    return found | {"decay": Quantity(decay, "rate at which energy decays, cooling", "Haff's law")}


def _friction(gas: GasParameters) -> dict[str, Quantity]:
    """Return how fast R settles and how often contacts slide, if they can."""
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


def _point(tables: Tables) -> str:
    """Return a row for each quantity, a column for each dimension."""
    gas, first = tables[0]
    friction = "" if gas.mu is None else f", mu = {gas.mu:g}"
    rows = [[f"r = {gas.r[0]:g}, beta = {gas.beta[0]:g}{friction}", *_titles(tables), ""]]
    for name, quantity in first.items():
        numbers = [f"{found[name].values.flat[0]:.5g}" for _, found in tables]
        numbers = ["none" if one == "nan" else one for one in numbers]
        rows.append([quantity.meaning, *numbers, _sources(tables, name)])
    return f"{columns(rows)}\n"


def _curve(tables: Tables) -> str:
    """Return a row for each point; below, what the columns are."""
    first = tables[0][1]
    rows = [["D", "r", "beta", *first]]
    rows += [[f"{value:.5g}" for value in row.values()] for row in _rows(tables)]
    about = [[name, one.meaning, _sources(tables, name)] for name, one in first.items()]
    inertia = " and ".join(_titles(tables))
    return f"{columns(rows, numbers=True)}\n\n{columns(about)}\n\n{inertia}."


def _record(tables: Tables) -> dict[str, Any]:
    """Return a record for each point, and what its numbers are."""
    gas, first = tables[0]
    about = {}
    for name, one in first.items():
        sources = {str(gas.dimension): found[name].source for gas, found in tables}
        about[name] = {"meaning": one.meaning, "source": sources}
    return {
        "inertia": {str(gas.dimension): gas.inertia for gas, _ in tables},
        "spin_share": gas.spin_share,
        "mu": gas.mu,
        **({} if gas.species is None else {"species": gas.species, "packing": gas.packing}),
        "reference": PAPER,
        "quantities": about,
        "points": list(_rows(tables)),
    }


def _write_csv(tables: Tables) -> None:
    """Print a row for each point; the last column says which equations its numbers are from."""
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["dimension", "r", "beta", *tables[0][1], "sources"])
    for gas, found in tables:
        sources = "; ".join(f"{name}: {one.source}" for name, one in found.items())
        for row in _rows([(gas, found)]):
            table.writerow([*(format(value, ".10g") for value in row.values()), sources])


def _titles(tables: Tables) -> list[str]:
    return [f"{gas.dimension}D, q = {gas.inertia:g}" for gas, _ in tables]


def _sources(tables: Tables, name: str) -> str:
    return "; ".join(dict.fromkeys(found[name].source for _, found in tables))


def _rows(tables: Tables) -> Iterator[dict[str, float]]:
    for gas, found in tables:
        values = {"r": gas.r, "beta": gas.beta} | {name: one.values for name, one in found.items()}
        arrays = np.broadcast_arrays(*values.values())
        for row in zip(*arrays, strict=True):
            yield {"dimension": gas.dimension} | dict(zip(values, row, strict=True))


def species_from(text: str) -> Sequence[Mapping[str, Any]]:
    """Return species from a YAML file, or from YAML itself; a file may have them as `species`.

    Raises InputError for what is neither, and as `theory.mixture`; OSError for a missing file.
    """
    found = parse_yaml(text, "--species") if text.lstrip().startswith("[") else read_yaml(text)
    if isinstance(found, Mapping):
        found = found.get("species", found)
    theory.mixture(found, 1.0, 1.0)
    return found


def quantities_of_mixture(gas: GasParameters) -> dict[str, Quantity]:
    """Return all that theory says of a mixture, by name."""
    points = [_at_a_point(gas, *place) for place in zip(gas.r, gas.beta, strict=True)]
    return {
        name: Quantity(np.array([point[name].values for point in points]), *about)
        for name, (_, *about) in points[0].items()
    }


def _at_a_point(gas: GasParameters, r: float, beta: float) -> dict[str, Quantity]:
    mu = np.inf if gas.mu is None else gas.mu
    mixed = theory.mixture(gas.species, r, beta, gas.dimension, gas.inertia, mu)
    kicks, share = theory.kick_power(mixed), gas.spin_share
    states = {
        "driven": theory.mixture_driven(mixed, (1 - share) * kicks, gas.packing, share),
        "cooling": theory.mixture_cooling(mixed, gas.packing),
    }
    found = {}
    for way, state in states.items():
        found[f"R_{way}"] = Quantity(state.overall_ratio(mixed), f"R of all, {way}", SOURCE)
        for k, one in enumerate(gas.species or ()):
            name = str(one.get("name", k + 1))
            found[f"R_{way}_{name}"] = Quantity(state.R[k], f"R of {name}, {way}", SOURCE)
            about = f"T_tr of {name} over its mean, {way}"
            found[f"T_{way}_{name}"] = Quantity(state.T_tr[k], about, SOURCE)
    rates = theory.mixture_relaxation_rate, theory.mixture_decay_rate
    settles, decays = (rate(mixed, gas.packing) for rate in rates)
    found["rate_cooling"] = Quantity(settles, "rate at which ratios settle, cooling", SOURCE)
    return found | {"decay": Quantity(decays, "rate at which energy decays, cooling", SOURCE)}
