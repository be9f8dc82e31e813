"""What is asked for: gases, from the options of the command line."""

import argparse
import math
import re
from collections.abc import Callable, Sequence
from decimal import Decimal

import numpy as np

from roughgas import config, theory
from roughgas.base.errors import InputError
from roughgas.cli.theory.quantities import Gas
from roughgas.theory.arguments import check_between, check_inertia, check_share

RANGE = re.compile(r"([^:]+):([^:]+):([^:]+)")
MOST = 100_000  # values in a range


def gases(options: argparse.Namespace) -> list[Gas]:
    """The gas, or those of both dimensions, at all (r, beta) of the axes.

    Raises InputError for illegal values.
    """
    found_r = _values("--r", options.r, config.restitution)
    found_beta = _values("--beta", options.beta, config.roughness)
    r, beta = (axis.ravel() for axis in np.meshgrid(found_r, found_beta, indexing="ij"))
    share = float(check_share(_number("--spin-share", options.spin_share)))
    mu = None
    if options.mu is not None:
        mu = float(check_between("friction mu", _number("--mu", options.mu), 0, math.inf))
    found = []
    for dimension in [int(options.dimension)] if options.dimension else [2, 3]:
        q = theory.moment_of_inertia(dimension)
        if options.inertia is not None:
            q = float(check_inertia(_number("--inertia", options.inertia)))
        found.append(Gas(r, beta, dimension, q, share, mu))
    return found


def _number(key: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(key, text, "be a number") from None


def _values(key: str, texts: Sequence[str], legal: Callable[[str], float]) -> list[float]:
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
