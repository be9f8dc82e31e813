"""`roughgas theory`: what theory says of R, at a point or along a curve."""

import re
from argparse import Namespace
from collections.abc import Callable, Sequence
from decimal import Decimal

import numpy as np

from roughgas import config
from roughgas.base.errors import InputError
from roughgas.cli.options import number
from roughgas.cli.theory import output
from roughgas.cli.theory.quantities import Gas, quantities
from roughgas.theory.arguments import FRICTION, SHARE, check, moment_of_inertia

RANGE = re.compile(r"([^:]+):([^:]+):([^:]+)")
MOST = 100_000  # values in a range


def theory(options: Namespace) -> None:
    """Print theory's numbers."""
    tables = [(gas, quantities(gas)) for gas in _gases(options)]
    if options.csv:
        output.write_csv(tables)
    elif options.json:
        print(output.as_record(tables))
    else:
        print(output.point(tables) if len(tables[0][0].r) == 1 else output.curve(tables))


def _gases(options: Namespace) -> list[Gas]:
    """Return the gas, or those of both dimensions, at all (r, beta) of the axes.

    Raises InputError for illegal values.
    """
    found_r = _values("--r", options.r, config.restitution)
    found_beta = _values("--beta", options.beta, config.roughness)
    r, beta = (axis.ravel() for axis in np.meshgrid(found_r, found_beta, indexing="ij"))
    share = SHARE.check("spin share of the drive", number("--spin-share", options.spin_share))
    mu = q = None
    if options.mu is not None:
        mu = FRICTION.check("friction mu", number("--mu", options.mu))
    if options.inertia is not None:
        q = float(check("inertia q", number("--inertia", options.inertia)))
    dimensions = [int(options.dimension)] if options.dimension else [2, 3]
    return [Gas(r, beta, D, q or moment_of_inertia(D), share, mu) for D in dimensions]


def _values(key: str, texts: Sequence[str], legal: Callable[[str], float]) -> list[float]:
    """Return the numbers of an axis, each of them as `legal` accepts it."""
    found: list[float] = []
    for text in texts:
        ends = RANGE.fullmatch(text)
        found += [legal(one) for one in (_range(key, text, ends) if ends else [text])]
    return found


def _range(key: str, text: str, ends: re.Match[str]) -> list[str]:
    """Return the labels from START to STOP, as exact as they are written."""
    try:
        start, stop, step = (Decimal(part) for part in ends.groups())
        count = int((stop - start) / step) + 1
    except (ArithmeticError, ValueError):
        raise InputError(key, text, "be START:STOP:STEP, such as -1:1:0.1") from None
    if not 0 < count <= MOST or stop < start:
        raise InputError(key, text, f"go up from START to STOP in at most {MOST:,} steps")
    return [str(start + k * step) for k in range(count)]
