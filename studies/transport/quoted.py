"""Numbers and tables of README.md, from the rows of evidence and from long.csv."""

from collections.abc import Iterator

import numpy as np

from roughgas.judging import Estimate, LongRow, Row, read_long_rows
from roughgas.quoting import (
    Evidence,
    in_words,
    mean_of,
    relative,
    rounded,
    rows_of,
    with_error,
)
from roughgas.tasks import markdown, with_minus_signs

from . import dilute
from .judges import HOLDS_WITHIN
from .results import COEFFICIENTS

STUDY = "transport"
KINDS = {"disks": 0.5, "spheres": 0.4}
"""Moment of inertia q of rough elastic gases by events."""
EQUILIBRIUM = "packing = 0.01, N = 200"
"""State in the table of all elastic gases; of rough spheres others are in long.csv as well."""
SPINS = (0.02, 0.1, 0.2, 0.4, 0.6667)
"""Values of q in the table of theory."""
PER_CENT = 100.0


def numbers(evidence: Evidence) -> dict[str, str]:
    """Return the numbers in sentences as texts by name."""
    long_rows = read_long_rows(dilute.TABLE)
    return {
        name: text
        for pairs in (
            _elastic_diffusion(evidence),
            _driven_diffusion(evidence, long_rows),
            _driven_viscosity(evidence),
            _elastic_errors(evidence),
            _farther_walls(evidence),
            _events(long_rows),
            _spins(long_rows),
        )
        for name, text in pairs
    }


def tables(evidence: Evidence) -> dict[str, str]:
    """Return the tables of the page, Markdown by name."""
    long_rows = read_long_rows(dilute.TABLE)
    return {
        "rough over smooth": _ratios(evidence),
        "driven disks": dilute.table_of_diffusion(long_rows),
        "elastic gases": _fluxes(evidence),
        "without positions": dilute.table_of_limits(long_rows),
        "spins": _table_of_spins(),
    }


# ---------------------------------------------------------------------- diffusion


def _ratio(evidence: Evidence, kind: str) -> Row:
    name = f"D of perfectly rough over smooth elastic {kind}, by events"
    (row,) = rows_of(evidence, STUDY, name).values()
    return row


def _ratios(evidence: Evidence) -> str:
    name = "self-diffusion of perfectly rough over smooth elastic particles"
    without_positions = rows_of(evidence, "exact", name)
    rows = []
    for kind in reversed(KINDS):
        row, name = _ratio(evidence, kind), f"{kind}, q = {KINDS[kind]:g}"
        dsmc, first = without_positions[kind].ours, row.theirs.value
        rows.append([name, with_error(row.ours), with_error(dsmc), rounded(first, 3)])
    head = ["rough over smooth, elastic", "by events", "without positions (DSMC, study `exact`)"]
    return markdown([*head, "first approximation"], rows)


def _elastic_diffusion(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield the per cent by which theory is off the ratios, and off the diffusion coefficients."""
    for kind in KINDS:
        ratio = relative(_ratio(evidence, kind))
        yield f"ratio.{kind}", rounded(PER_CENT * (1.0 - ratio.value))
        at = rows_of(evidence, STUDY, f"D nu/T of elastic {kind}, mean square displacement")
        smooth = _minus_one(relative(at["r = 1, beta = -1"]))
        yield f"smooth.{kind}", with_error(smooth, PER_CENT)
    rough = _minus_one(relative(at["r = 1, beta = 1"]))
    yield f"rough.{kind}", with_error(rough, -PER_CENT)


def _driven_diffusion(evidence: Evidence, long_rows: list[LongRow]) -> Iterator[tuple[str, str]]:
    """Yield the per cent by which driven disks diffuse less than theory says, and errors.

    Without positions (DSMC) there are more points than by events, where a steady state or the end
    of the memory may be unknown; both means are over the latter.
    """
    rows = rows_of(evidence, STUDY, "D nu/T of driven disks, mean square displacement")
    by_events = [relative(row) for row in rows.values()]
    without_positions = {
        f"r = {r:g}, beta = {beta:g}": estimate
        for (r, beta), estimate in dilute.driven(long_rows).items()
    }
    mean, dilute_mean = mean_of(by_events), mean_of(without_positions[at] for at in rows)
    yield "driven.points", in_words(len(without_positions))
    yield "driven.points_by_events", in_words(len(by_events))
    yield "driven.below", with_error(_minus_one(mean), -PER_CENT)
    yield "driven.above_dilute", with_error(mean.minus(dilute_mean), PER_CENT)
    yield from _range("driven.error", [PER_CENT * estimate.stderr for estimate in by_events], 1)


# ---------------------------------------------------------------------- viscosity and conductivity


def _driven_viscosity(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield the per cent by which driven disks are less viscous than theory says, and the points
    more than 3 % off, in descending order of their distance."""
    name = "viscosity of driven disks over theory, no shear extrapolated"
    gaps = {at: row.gap for at, row in rows_of(evidence, STUDY, name).items()}
    far = sorted((gap.value, at) for at, gap in gaps.items() if abs(gap.value) > HOLDS_WITHIN)
    yield "strained.points", f"{len(gaps)}"
    yield "strained.below", with_error(mean_of(gaps.values()), -PER_CENT)
    yield "strained.close", f"{len(gaps) - len(far)}"
    yield "strained.significant", in_words(sum(gap.is_significant for gap in gaps.values()))
    yield from _range("strained.error", [PER_CENT * gap.stderr for gap in gaps.values()], 1)
    for order, (_, at) in zip(("first", "second"), far, strict=True):
        yield f"strained.{order}", with_error(gaps[at], -PER_CENT)
        yield from _coordinates(f"strained.{order}", at)


def _coordinates(name: str, at: str) -> Iterator[tuple[str, str]]:
    """Yield the coordinates of a state such as "r = 0.7, beta = -0.5"."""
    for pair in at.split(", "):
        coordinate, value = pair.split(" = ")
        yield f"{name}.{coordinate}", with_minus_signs(value)


def _elastic(evidence: Evidence) -> dict[str, list[Estimate]]:
    """Return viscosity and conductivity over theory of elastic gases in equilibrium, and the
    conductivity between walls at each distance, by the name of the gas."""
    gases = [f"{surface} {kind}" for kind in KINDS for surface in ("smooth", "rough")]
    columns = {}
    for gas in gases:
        surface, kind = gas.split()
        elastic = f"{surface} elastic {kind}"
        names = [f"{coefficient} of {elastic} over theory" for coefficient in COEFFICIENTS]
        in_equilibrium = [rows_of(evidence, STUDY, name)[EQUILIBRIUM] for name in names]
        name = f"conductivity of {elastic} between walls over theory"
        between_walls = rows_of(evidence, STUDY, name).values()
        columns[gas] = [row.ours for row in (*in_equilibrium, *between_walls)]
    return columns


def _fluxes(evidence: Evidence) -> str:
    head = ["over theory, elastic", "viscosity, equilibrium", "conductivity, equilibrium"]
    head += ["conductivity, between walls", "twice as far apart"]
    rows = [[gas, *map(with_error, cells)] for gas, cells in _elastic(evidence).items()]
    return markdown(head, [row + [""] * (len(head) - len(row)) for row in rows])


def _elastic_errors(evidence: Evidence) -> Iterator[tuple[str, str]]:
    errors = [
        PER_CENT * estimate.stderr
        for estimates in _elastic(evidence).values()
        for estimate in estimates
    ]
    yield from _range("elastic.error", errors, 0)


def _farther_walls(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield the per cent by which spheres conduct more between walls twice as far apart."""
    for surface in ("smooth", "rough"):
        near, far = _elastic(evidence)[f"{surface} spheres"][2:]
        change = far.minus(near).scaled(1.0 / near.value)
        yield f"farther.{surface}", with_error(change, PER_CENT)


def _events(long_rows: list[LongRow]) -> Iterator[tuple[str, str]]:
    """Yield the coefficients of rough spheres by events, over theory."""
    for coefficient in COEFFICIENTS:
        by_state = dilute.events_by_state(long_rows, coefficient)
        for name, estimate in zip(("few", "many", "dense"), by_state.values(), strict=True):
            yield f"events.{name}.{coefficient}", with_error(estimate)


# ---------------------------------------------------------------------- theory of spins


def _table_of_spins() -> str:
    head = ["rough over Pidduck's approximation, theory", f"q = {SPINS[0]:g}"]
    rows = [
        [f"{name} of spheres", *(f"{dilute.corrected(name, 'spheres', q):.4f}" for q in SPINS)]
        for name in COEFFICIENTS
    ]
    return markdown([*head, *(f"{q:g}" for q in SPINS[1:])], rows)


def _spins(long_rows: list[LongRow]) -> Iterator[tuple[str, str]]:
    """Yield theory for disks, and the per cent by which it is below rough gases."""
    for name in COEFFICIENTS:
        factor = dilute.corrected(name, "disks", KINDS["disks"])
        yield f"spins.disks.{name}", rounded(factor, 4)
    gaps = [
        PER_CENT * (estimate.value / dilute.corrected(name, kind, q) - 1.0)
        for name, kind in dilute.PUBLISHED
        for q, estimate in dilute.limits(long_rows, name, kind, "equilibrium").items()
        if q > 0.0
    ]
    yield from _range("spins.left", gaps, 1)


def _range(name: str, values: list[float], decimals: int) -> Iterator[tuple[str, str]]:
    yield f"{name}.least", rounded(float(np.min(values)), decimals)
    yield f"{name}.most", rounded(float(np.max(values)), decimals)


def _minus_one(estimate: Estimate) -> Estimate:
    return estimate._replace(value=estimate.value - 1.0)
