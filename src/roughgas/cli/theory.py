"""`roughgas theory`: what theory says of R, at a point or along a curve."""

import argparse
import csv
import re
import sys
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

from roughgas.cli.layout import as_json, columns
from roughgas.cli.parser import examples
from roughgas.errors import InputError

EXAMPLES = examples(
    "roughgas theory --r 0.9 --beta 0.5",
    "roughgas theory --r 0.9 --beta -1:1:0.1 --dimension 2",
    "roughgas theory --r 0.8 0.9 0.99 --beta 0 --inertia 0.1 --json",
    "roughgas theory --r 0.9 --beta 0.5 --mu 0.3",
    "roughgas theory --r 0.9 --beta -0.9:0.9:0.1 --spin-share 0.2 --csv",
)
RANGE = re.compile(r"([^:]+):([^:]+):([^:]+)")
MOST = 100_000  # values in a range
PAPER = "S. McNamara, S. Luding, Phys. Rev. E 58, 2247 (1998)"
TOLERANCE = 0.01  # of R, within which it counts as settled


class Gas(NamedTuple):
    """Points (r, beta) of one dimension, arrays of equal shape, and what is the same at all."""

    r: Any
    beta: Any
    dimension: int
    inertia: float
    spin_share: float
    mu: float | None


class Quantity(NamedTuple):
    """What is computed: an array over the points, what it is, and which equation it is from."""

    values: Any
    meaning: str
    source: str


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "theory",
        help="what theory says of R, at a point or along a curve",
        description="Print R = E_rot/(E_rot + E_trans) of theory, driven and freely cooling, how "
        "fast it is reached, and how fast energy decays; with the equation that each number is "
        "from. r and beta take several values, or a range START:STOP:STEP with both ends.",
        epilog=EXAMPLES,
    )
    values = {"required": True, "nargs": "+", "metavar": "VALUE"}
    parser.add_argument("--r", **values, help="normal restitution, in [0, 1]: 1 is elastic")
    parser.add_argument("--beta", **values, help="roughness, in [-1, 1]: 1 is perfectly rough")
    parser.add_argument("--dimension", choices=("2", "3"), help="default: both")
    parser.add_argument(
        "--inertia",
        metavar="Q",
        help="moment of inertia in m a^2 (default: that of uniform disks, 0.5, or spheres, 0.4)",
    )
    parser.add_argument(
        "--spin-share", default="0", metavar="S", help="of the drive's power (default: 0)"
    )
    parser.add_argument("--mu", help="Coulomb friction (default: none, contacts never slide)")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="for scripts")
    form.add_argument("--csv", action="store_true", help="for spreadsheets")
    parser.set_defaults(command=theory)


def theory(options: argparse.Namespace) -> None:
    """Print theory's numbers."""
    import numpy as np

    from roughgas import config

    found_r = _values("--r", options.r, config.restitution)
    found_beta = _values("--beta", options.beta, config.roughness)
    r, beta = (axis.ravel() for axis in np.meshgrid(found_r, found_beta, indexing="ij"))
    tables = [(gas, quantities(gas)) for gas in _gases(options, r, beta)]
    if options.json:
        print(as_json(_record(tables)))
    elif options.csv:
        _write_csv(tables)
    elif len(r) == 1:
        print(_point(tables))
    else:
        print(_curve(tables))


def equation(theory: str, dimension: int, spin_share: float = 0.0, mu: float | None = None) -> str:
    """Where R of a cooling gas, `theory` "K", or of a driven one, "lun", is from."""
    if mu is not None:
        return "rate equations with Coulomb friction"
    if theory == "K":
        return "Eq. (K)" if dimension == 2 else "Eq. (Goldshtein)"
    return "Eq. (lun)" if spin_share == 0.0 else f"rate equations, spin share {spin_share:g}"


def quantities(gas: Gas) -> dict[str, Quantity]:
    """All that theory says of a gas, by name."""
    from roughgas.reduce import predicted_ratio

    about = {"dimension": gas.dimension, "inertia": gas.inertia, "spin_share": gas.spin_share}
    if gas.mu is not None:
        about["mu"] = gas.mu
    drive = "through translation" if gas.spin_share == 0.0 else f"spin share {gas.spin_share:g}"
    found = {}
    for name, kind, way in (("driven", "lun", f"driven, {drive}"), ("cooling", "K", "cooling")):
        found[f"R_{name}"] = Quantity(
            predicted_ratio(about | {"theory": kind}, gas.r, gas.beta),
            f"R, {way}",
            equation(kind, gas.dimension, gas.spin_share, gas.mu),
        )
    return found | (_relaxation(gas) if gas.mu is None else _friction(gas))


def _relaxation(gas: Gas) -> dict[str, Quantity]:
    """How R settles, and how energy decays."""
    from roughgas import theory

    material, source = (gas.r, gas.beta), "rate equations"
    spins = {"dimension": gas.dimension, "inertia": gas.inertia}
    found = {}
    for name, share in (("driven", gas.spin_share), ("cooling", None)):
        rate = theory.relaxation_rate(*material, **spins, spin_share=share)
        needed = theory.collisions_to_relax(*material, TOLERANCE, **spins, spin_share=share)
        found[f"rate_{name}"] = Quantity(rate, f"rate at which R settles, {name}", source)
        found[f"settled_{name}"] = Quantity(
            needed, f"collisions per particle until R is there to {TOLERANCE:.0%}, {name}", source
        )
    decay = theory.decay_rate(*material, **spins)
    return found | {"decay": Quantity(decay, "rate at which energy decays, cooling", "Haff's law")}


def _friction(gas: Gas) -> dict[str, Quantity]:
    """What there is to know where contacts may slide."""
    from roughgas import theory

    spins, source = (gas.mu, gas.dimension, gas.inertia), "rate equations with Coulomb friction"
    rate = theory.friction_relaxation_rate(gas.r, gas.beta, *spins)
    R = theory.friction_ratio(gas.r, gas.beta, *spins, gas.spin_share)
    sliding = theory.sliding_fraction(1.0 - R, R, gas.r, gas.beta, *spins)
    legal = "mu below which a gas of fast spins keeps them, cooling"
    return {
        "rate_cooling": Quantity(rate, "rate at which R settles, cooling", source),
        "sliding": Quantity(sliding, "share of contacts that slide, driven", source),
        "mu_c": Quantity(theory.critical_friction(gas.r), legal, "sqrt((1 - r)/(1 + r))"),
    }


def _gases(options: argparse.Namespace, r: Any, beta: Any) -> list[Gas]:
    from roughgas import theory
    from roughgas.theory.arguments import check_between, check_inertia, check_share

    share = float(check_share(_number("--spin-share", options.spin_share)))
    mu = (
        None
        if options.mu is None
        else float(check_between("friction mu", _number("--mu", options.mu), 0.0, float("inf")))
    )
    gases = []
    for dimension in [int(options.dimension)] if options.dimension else [2, 3]:
        q = theory.moment_of_inertia(dimension)
        if options.inertia is not None:
            q = float(check_inertia(_number("--inertia", options.inertia)))
        gases.append(Gas(r, beta, dimension, q, share, mu))
    return gases


def _number(key: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(key, text, "be a number") from None


def _values(key: str, texts: Sequence[str], legal: Any) -> list[float]:
    """The numbers of an axis, each of them what `legal` accepts."""
    found: list[float] = []
    for text in texts:
        ends = RANGE.fullmatch(text)
        found += [legal(one) for one in (_range(key, text, ends) if ends else [text])]
    return found


def _range(key: str, text: str, ends: re.Match[str]) -> list[str]:
    """The labels from START to STOP, as exact as they are written."""
    try:
        start, stop, step = (Decimal(part) for part in ends.groups())
        count = int((stop - start) / step) + 1
    except (ArithmeticError, ValueError):
        raise InputError(key, text, "be START:STOP:STEP, such as -1:1:0.1") from None
    if not 0 < count <= MOST or stop < start:
        raise InputError(key, text, f"go up from START to STOP in at most {MOST:,} steps")
    return [str(start + k * step) for k in range(count)]


def _titles(gas: Gas) -> str:
    return f"{gas.dimension}D, q = {gas.inertia:g}"


def _point(tables: Sequence[tuple[Gas, Mapping[str, Quantity]]]) -> str:
    """A row for each quantity, a column for each dimension."""
    gas, first = tables[0]
    friction = "" if gas.mu is None else f", mu = {gas.mu:g}"
    rows = [[f"r = {gas.r[0]:g}, beta = {gas.beta[0]:g}{friction}"]]
    rows[0] += [*(_titles(one) for one, _ in tables), ""]
    for name, quantity in first.items():
        sources = dict.fromkeys(found[name].source for _, found in tables)
        numbers = [_shown(found[name].values.flat[0]) for _, found in tables]
        rows.append([quantity.meaning, *numbers, "; ".join(sources)])
    return f"{columns(rows)}\n\n{_notes()}"


def _curve(tables: Sequence[tuple[Gas, Mapping[str, Quantity]]]) -> str:
    """A row for each point; below, what the columns are."""
    names = list(tables[0][1])
    rows = [["D", "r", "beta", *names]]
    rows += [[_shown(value) for value in row.values()] for row in _rows(tables)]
    about = []
    for name, quantity in tables[0][1].items():
        sources = dict.fromkeys(found[name].source for _, found in tables)
        about.append([name, quantity.meaning, "; ".join(sources)])
    inertia = " and ".join(_titles(gas) for gas, _ in tables)
    return f"{columns(rows, numbers=True)}\n\n{columns(about)}\n\n{inertia}.\n{_notes()}"


def _notes() -> str:
    return f"Rates are per collision per particle. Equations: docs/physics.md, and\n{PAPER}."


def _rows(tables: Sequence[tuple[Gas, Mapping[str, Quantity]]]) -> list[dict[str, float]]:
    import numpy as np

    found = []
    for gas, table in tables:
        for k in range(len(gas.r)):
            place = {"dimension": gas.dimension, "r": gas.r[k], "beta": gas.beta[k]}
            values = {n: np.broadcast_to(q.values, gas.r.shape)[k] for n, q in table.items()}
            found.append(place | values)
    return found


def _record(tables: Sequence[tuple[Gas, Mapping[str, Quantity]]]) -> dict[str, Any]:
    gas, first = tables[0]
    return {
        "inertia": {f"{one.dimension}": one.inertia for one, _ in tables},
        "spin_share": gas.spin_share,
        "mu": gas.mu,
        "reference": PAPER,
        "quantities": {
            name: {
                "meaning": quantity.meaning,
                "source": {f"{one.dimension}": table[name].source for one, table in tables},
            }
            for name, quantity in first.items()
        },
        "points": _rows(tables),
    }


def _write_csv(tables: Sequence[tuple[Gas, Mapping[str, Quantity]]]) -> None:
    """A row for each point; the last column says which equations R is from."""
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["dimension", "r", "beta", *tables[0][1], "sources"])
    sources = {
        gas.dimension: "; ".join(f"{name}: {one.source}" for name, one in found.items())
        for gas, found in tables
    }
    for row in _rows(tables):
        numbers = [format(value, ".10g") for value in row.values()]
        table.writerow([*numbers, sources[row["dimension"]]])


def _shown(value: float) -> str:
    return f"{value:.5g}"
