"""Numbers and tables of README.md, from the rows of evidence and from long.csv."""

from collections.abc import Iterable, Iterator

import numpy as np

from roughgas import theory
from roughgas.judging import Estimate, Row, read_long_rows
from roughgas.quoting import Evidence, in_words, mean_of, rounded, rows_of, with_error
from roughgas.tasks import markdown, with_minus_signs

from .long import (
    EVENT_LIMIT,
    EVENT_R,
    EVENT_SIZE_EFFECT,
    HOMOGENEOUS_R,
    KICK_EFFECT,
    SIZE_EFFECT,
    TABLE,
    committed,
)
from .published import CUMULANTS, published_R
from .tasks import State

STUDY = "megias_santos"
NAMES = {"R": "R", "a20": "a₂₀", "a11": "a₁₁", "a02": "a₀₂"}
THOUSANDTHS = 1000.0
PROBE = State(0.7, 0.0, 0.25)
"""State whose gases vary in number, packing and kicks."""
GASES = {
    "usual": (1000, 0.005, 0.3),
    "fewer": (250, 0.02, 0.3),
    "fewest": (100, 0.05, 0.3),
    "long": (1000, 0.05, 0.3),
    "rare_kicks": (1000, 0.005, 1.2),
}
"""Number, packing and interval of kicks of the event-driven gases that the page quotes."""


def numbers(evidence: Evidence) -> dict[str, str]:
    """Return the numbers in sentences as texts by name."""
    groups = (_cumulants(evidence), _ratios(evidence), _homogeneous(evidence), _events(evidence))
    texts = {name: text for pairs in groups for name, text in pairs}
    return texts | dict(_theories(evidence)) | dict(_methods(evidence))


def tables(evidence: Evidence) -> dict[str, str]:
    """Return the tables of the page, Markdown by name."""
    return {"all states": _states(evidence), "homogeneous": _homogeneous_states()}


def _rows(evidence: Evidence, name: str, source: str = "DSMC") -> dict[str, Row]:
    """Return the rows of R or of a cumulant beside a source, by state."""
    quantity = f"{name} of disks driven by white noise, {source}"
    return dict(rows_of(evidence, STUDY, quantity))


def _gaps(evidence: Evidence, name: str) -> list[Estimate]:
    """Return R or a cumulant minus the value published by DSMC, at all states."""
    return [row.gap for row in _rows(evidence, name).values()]


def _rms(values: Iterable[float]) -> float:
    return float(np.sqrt(np.mean(np.square(list(values)))))


def _signed(estimate: Estimate, scale: float = 1.0) -> str:
    """Return a difference as text with its sign."""
    return "+" * (estimate.value >= 0.0) + with_error(estimate, scale)


# ---------------------------------------------------------------------- all states


def _states(evidence: Evidence) -> str:
    lines, count = [], 0
    for name, symbol in NAMES.items():
        gaps = _gaps(evidence, name)
        count, differ = len(gaps), sum(gap.is_significant for gap in gaps)
        rms = rounded(_rms(gap.sigma for gap in gaps), 1)
        lines.append([symbol, _signed(mean_of(gaps)), rms, f"{differ}"])
    head = [f"{count} points", "mean difference", "root mean square of z", "|z| ≥ 3"]
    return markdown(head, lines)


def _cumulants(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield the number of cumulants, and their combined errors in the middle."""
    gaps = {name: _gaps(evidence, name) for name in CUMULANTS}
    yield "cumulants", f"{sum(map(len, gaps.values()))}"
    for name in CUMULANTS:
        yield f"{name}.error", rounded(float(np.median([gap.stderr for gap in gaps[name]])), 4)


def _ratios(evidence: Evidence) -> Iterator[tuple[str, str]]:
    gaps = _gaps(evidence, "R")
    yield "R", f"{len(gaps)}"
    yield "R.error", rounded(float(np.median([gap.stderr for gap in gaps])), 4)
    yield "R.largest", rounded(max(abs(gap.value) for gap in gaps), 4)
    yield "R.mean", _signed(mean_of(gaps))


def _theories(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield root mean square and largest differences of theories from published numbers."""
    for name in NAMES:
        published = {at: row.theirs.value for at, row in _rows(evidence, name).items()}
        sonine = {
            at: row.theirs.value
            for at, row in _rows(evidence, name, "Sonine approximation").items()
        }
        off = {at: sonine[at] - published[at] for at in published}
        yield f"sonine.{name}", rounded(_rms(off.values()), 4)
        if name != "R":
            yield f"{name}.size", rounded(_rms(published.values()), 3)
            continue
        rates = [_rate_equations(at) - value for at, value in published.items()]
        yield "sonine.R.most", rounded(max(map(abs, off.values())), 4)
        yield "rates.R", rounded(_rms(rates), 4)
        yield "rates.R.most", rounded(max(map(abs, rates)), 4)
    at = "r = 0.7, beta = -0.7, spin_share = 1"
    yield (
        "sonine.a11.worst",
        rounded(_rows(evidence, "a11", "Sonine approximation")[at].theirs.value, 3),
    )
    yield "a11.worst", rounded(_rows(evidence, "a11")[at].theirs.value, 3)


def _rate_equations(at: str) -> float:
    """Return R of the rate equations with Maxwellian velocities in a state."""
    r, beta, share = (float(pair.partition(" = ")[2]) for pair in at.split(", "))
    return float(theory.stationary_ratio(r, beta, spin_share=share))


def _methods(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield differences of the published event-driven values from the published DSMC values."""
    gaps = {
        name: [
            row.theirs.minus(_rows(evidence, name)[at].theirs)
            for at, row in _rows(evidence, name, "EDMD").items()
        ]
        for name in NAMES
    }
    errors = [abs(gap.value) / gap.stderr for of_name in gaps.values() for gap in of_name]
    yield "methods.errors", rounded(max(errors))
    yield "methods.R", rounded(max(abs(gap.value) for gap in gaps["R"]), 4)
    yield "methods.a20.not_lower", in_words(sum(gap.value >= 0.0 for gap in gaps["a20"]))
    yield "methods.a20", rounded(-mean_of(gaps["a20"]).value, 4)


# ---------------------------------------------------------------------- gases without positions


def _homogeneous_gaps() -> dict[State, Estimate]:
    """Return R of homogeneous gases minus the value published by DSMC, by state."""
    return {
        state: ours.minus(published_R(*state)) for state, ours in committed(HOMOGENEOUS_R).items()
    }


def _homogeneous_states() -> str:
    ratios, gaps, slopes = committed(HOMOGENEOUS_R), _homogeneous_gaps(), committed(SIZE_EFFECT)
    lines = [
        [
            with_minus_signs(", ".join(f"{value:g}" for value in state)),
            with_error(ratios[state]),
            _signed(gaps[state], THOUSANDTHS),
            rounded(gaps[state].sigma, 1),
            with_error(slopes[state]),
        ]
        for state in sorted(ratios, key=lambda s: (s.r, -s.beta, s.spin_share))
    ]
    head = ["r, β, share", "homogeneous", "minus published DSMC, thousandths", "z", "N (R_N − R)"]
    return markdown(head, lines)


def _homogeneous(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield what homogeneous gases tell of the difference between ours and published R."""
    gaps = _homogeneous_gaps()
    differ = [gap for gap in gaps.values() if gap.is_significant]
    mean, all_states = mean_of(gaps.values()), mean_of(_gaps(evidence, "R"))
    yield "homogeneous.share", rounded(100.0 * mean.value / all_states.value)
    yield "homogeneous.mean", _signed(mean)
    yield "homogeneous.differ", in_words(len(differ))
    yield "homogeneous.states", in_words(len(gaps))
    yield "homogeneous.largest", with_error(max(differ, key=lambda gap: gap.value))
    ours = committed(HOMOGENEOUS_R)
    sonine = {s: float(theory.sonine_state(s.r, s.beta, spin_share=s.spin_share).R) for s in ours}
    off = [sonine[state] - ours[state].value for state in ours]
    above = [sonine[state] - published_R(*state).value for state in ours]
    yield "homogeneous.sonine.most", rounded(max(map(abs, off)), 4)
    yield "homogeneous.sonine.mean", rounded(float(np.mean(off)), 5)
    yield "homogeneous.sonine.published", rounded(float(np.mean(above)), 4)
    by_events = [published_R(*state, "EDMD").minus(published_R(*state)) for state in ours]
    yield "homogeneous.methods", rounded(max(abs(gap.value) for gap in by_events), 4)
    (kicks,) = committed(KICK_EFFECT).values()
    yield "homogeneous.kicks", with_error(kicks, THOUSANDTHS)


# ---------------------------------------------------------------------- events


def _events(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield R by events of gases in the state PROBE, and its limit for many particles."""
    names = ("particles", "packing", "interval")
    by_gas = {
        tuple(row.parameters[name] for name in names): row.estimate
        for row in read_long_rows(TABLE)
        if row.quantity == EVENT_R
    }
    for name, gas in GASES.items():
        yield f"events.{name}", with_error(by_gas[gas])
    (limit,), (slope,) = (committed(key).values() for key in (EVENT_LIMIT, EVENT_SIZE_EFFECT))
    yield "events.limit", with_error(limit)
    yield "events.slope", with_error(slope)
    yield "probe", with_error(committed(HOMOGENEOUS_R)[PROBE])
    particles = GASES["usual"][0]
    yield "events.size", rounded(slope.value / particles, 4)
    mean, homogeneous = mean_of(_gaps(evidence, "R")), mean_of(_homogeneous_gaps().values())
    yield "left.all", rounded(THOUSANDTHS * mean.value, 2)
    yield "left.homogeneous", rounded(THOUSANDTHS * homogeneous.value, 2)
    yield "left.size", rounded(THOUSANDTHS * slope.value / particles, 2)
    yield "left.error", rounded(THOUSANDTHS * mean.stderr, 2)
