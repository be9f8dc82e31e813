"""Numbers and tables of README.md, from evidence, reference.csv, theory and settings."""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.judging import Estimate, Row
from roughgas.quoting import (
    Evidence,
    relative,
    rounded,
    rows_of,
    settings_at_paper_scale,
    with_error,
)
from roughgas.tasks import markdown, with_minus_signs

from .curves import Crossing, Curve, crossing_of_published, expected, published
from .evidence import COMPARED, LOWEST
from .judges import SIGNIFICANT_DEPTH, curve_limit

FOLDER = Path(__file__).parent
STUDY = "mpemba"
PER_CENT = 100.0


class Material(NamedTuple):
    """Disks of a pair of gases, and the end of the names of their experiments."""

    r: float
    beta: float
    suffix: str

    @property
    def at(self) -> str:
        """The state as in the rows of evidence."""
        return f"r = {self.r:g}, beta = {self.beta:g}"

    @property
    def cell(self) -> str:
        """The state in a table."""
        return with_minus_signs(f"{self.r:g}, {self.beta:g}")


MATERIALS = {
    "rough": Material(0.7, 0.0, ""),
    "smoother": Material(0.9, -0.7, "_smoother"),
    "smoother_inelastic": Material(0.7, -0.7, "_smoother_inelastic"),
    "less_inelastic": Material(0.9, 0.0, "_less_inelastic"),
}
PREFIXES = {"crossing": "", "overshoot": "overshoot_"}
"""Begins of the names of experiments, by protocol."""
CROSSINGS = {
    "crossing": "the temperatures cross at",
    "overshoot": "the distances from T_st cross at",
}
FINDINGS = {
    "crossing": "the hotter one cools first",
    "overshoot": "the colder one overshoots",
}
"""Protocols in words, in the tables."""
EARLY = 4.0
"""Time up to which curves of the rate equations are compared with published ones."""


def numbers(evidence: Evidence) -> dict[str, str]:
    """Return the numbers in sentences as texts by name."""
    return (
        dict(_crossings(evidence))
        | dict(_depths(evidence))
        | dict(_published())
        | dict(_curves(evidence))
        | dict(_memory(evidence))
        | dict(_shares())
    )


def tables(evidence: Evidence) -> dict[str, str]:
    """Return the tables of the page, Markdown by name."""
    return {"protocols": _protocols(), "crossings": _table_of_crossings(evidence)}


# ---------------------------------------------------------------------- settings


def _settings(experiment: str):
    """Return the settings of an experiment of this study at the paper's scale."""
    return settings_at_paper_scale(FOLDER, experiment)


def _experiment(protocol: str, sample: str, material: Material) -> str:
    return f"{PREFIXES[protocol]}{sample}{material.suffix}"


def _seeds(protocol: str, material: Material) -> str:
    return f"{_settings(_experiment(protocol, 'hot', material))['sweep']['seeds']}"


def _protocols() -> str:
    """Return the drives of all gases, and the published temperatures at time 0."""
    lines = []
    for protocol, finding in FINDINGS.items():
        for material in MATERIALS.values():
            lines.append([finding, material.cell, *_drives(protocol, material)])
            finding = ""
    share = _settings("memory")["effects"]["thermostat"]["spin_share"]
    first = f"{share:g}, {_mean_temperature(_settings('memory')):.0f}; no drive until T = T_st"
    memory = ["spins remember their drive", MATERIALS["rough"].cell, first, "", f"ε = {share:g}"]
    return markdown(
        ["", "r, β", "hot: ε, T/T_st", "cold: ε, T/T_st", "then, both"], [*lines, memory]
    )


def _drives(protocol: str, material: Material) -> list[str]:
    """Return the shares of the first drives with T at time 0, and of the last drive."""
    cells = []
    for sample in ("hot", "cold"):
        settings = _settings(_experiment(protocol, sample, material))
        share = settings["effects"]["thermostat"]["spin_share"]
        T = published(protocol, sample, material.r, material.beta).T[0]
        cells.append(f"{share:g}, {T:.2f}")
    last = settings["schedule"]["stages"][1]["effects"]["thermostat"]["spin_share"]
    return [*cells, f"ε = {last:g}"]


def _mean_temperature(settings) -> float:
    """Return the mean temperature of disks at the begin of the first stage."""
    stage = settings["schedule"]["stages"][0]
    return (2.0 * stage["temperature"] + stage["spin_temperature"]) / 3.0


# ---------------------------------------------------------------------- crossings


def _crossing_row(evidence: Evidence, protocol: str, material: Material, tier: str) -> Row:
    quantity = f"time nu_st t/2 at which {COMPARED[protocol]} cross"
    return rows_of(evidence, STUDY, quantity, tier)[material.at]


def _hump(evidence: Evidence) -> Row:
    quantity = "T/T_st in the hump of a gas that remembers its drive"
    return rows_of(evidence, STUDY, quantity)[MATERIALS["rough"].at]


def _table_of_crossings(evidence: Evidence) -> str:
    lines = []
    for protocol, finding in CROSSINGS.items():
        for material in MATERIALS.values():
            simulation, rates = (
                _crossing_row(evidence, protocol, material, tier)
                for tier in ("simulation", "theory")
            )
            times = with_error(simulation.ours), with_error(simulation.theirs)
            cells = [_seeds(protocol, material), *times, rounded(rates.theirs.value, 3)]
            lines.append([finding, material.cell, *cells])
            finding = ""
    hump, memory = _hump(evidence), _settings("memory")
    depths = [with_error(_minus_one(hump.ours)), "", rounded(hump.theirs.value - 1.0, 4)]
    finding = "largest hump of the gas that remembers, share of T_st"
    seeds = f"{memory['sweep']['seeds']}"
    lines.append([finding, MATERIALS["rough"].cell, seeds, *depths])
    head = [f"{memory['particles']} disks", "r, β", "seeds", "ours", "published", "rate equations"]
    return markdown(head, lines)


def _crossings(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield z of crossings against the published times, and what the page says of single pairs."""
    for name, material in MATERIALS.items():
        row = _crossing_row(evidence, "crossing", material, "simulation")
        yield f"{name}.crossing.z", rounded(row.z, 1)
    rough, smoother = MATERIALS["rough"], MATERIALS["smoother"]
    row = _crossing_row(evidence, "overshoot", rough, "simulation")
    yield "rough.overshoot", rounded(row.ours.value, 2)
    yield "rough.overshoot.z", rounded(row.z, 1)
    row = _crossing_row(evidence, "overshoot", smoother, "simulation")
    yield "smoother.overshoot", with_error(row.ours)
    yield "smoother.overshoot.later", rounded(PER_CENT * (relative(row).value - 1.0))
    yield "smoother.overshoot.z", rounded(row.z, 1)
    rates = _crossing_row(evidence, "overshoot", smoother, "theory")
    yield "smoother.overshoot.rates.z", rounded(rates.z, 1)
    yield "smoother.overshoot.seeds", _seeds("overshoot", smoother)
    yield "less_inelastic.seeds", _seeds("crossing", MATERIALS["less_inelastic"])


def _depth_row(evidence: Evidence, protocol: str, material: Material) -> Row:
    quantity = f"largest difference, in T_st, of {COMPARED[protocol]} that cross"
    return rows_of(evidence, STUDY, quantity)[material.at]


def _depths(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield depths beyond crossings with their errors, and the seeds that an error would need."""
    less = MATERIALS["less_inelastic"]
    yield "less_inelastic.ours.depth", with_error(_depth_row(evidence, "crossing", less).ours)
    for name in ("smoother_inelastic", "less_inelastic"):
        row = _depth_row(evidence, "overshoot", MATERIALS[name])
        yield f"{name}.overshoot.stderr", rounded(row.ours.stderr, 3)
        needed = (SIGNIFICANT_DEPTH * row.ours.stderr / row.theirs.value) ** 2
        seeds = needed * int(_seeds("overshoot", MATERIALS[name]))
        yield f"{name}.overshoot.needed", f"{10 * math.ceil(seeds / 10):d}"
    row = _depth_row(evidence, "overshoot", MATERIALS["smoother"])
    yield "smoother.overshoot.depth", with_error(row.ours)
    for name, material in MATERIALS.items():
        ours = rows_of(evidence, STUDY, LOWEST)[material.at].ours
        yield f"{name}.overshoot.below", rounded(PER_CENT * (1.0 - ours.value))


def _memory(evidence: Evidence) -> Iterator[tuple[str, str]]:
    row = _hump(evidence)
    yield "memory.depth", rounded(PER_CENT * (1.0 - row.ours.value))
    yield "memory.z", rounded(abs(row.z), 1)


# ---------------------------------------------------------------------- curves


def _pair(protocol: str, material: Material) -> tuple[Curve, Curve]:
    hot, cold = (published(protocol, s, material.r, material.beta) for s in ("hot", "cold"))
    return hot, cold


def _rates(protocol: str, sample: str, material: Material, times: np.ndarray) -> Curve:
    """Return the curve of the rate equations from the initial state that the settings give."""
    settings = _settings(_experiment(protocol, sample, material))
    attributes = {"experiment_json": json.dumps(settings), "packing": settings["packing"]}
    point = {"r": [material.r], "beta": [material.beta]}
    return expected(xr.Dataset(coords=point, attrs=attributes), times)


def _rates_crossing(protocol: str, material: Material) -> Crossing:
    hot, cold = (
        _rates(protocol, sample, material, np.arange(0.0, 10.0, 0.02)) for sample in ("hot", "cold")
    )
    return crossing_of_published(hot, cold, protocol == "overshoot")


def _published() -> Iterator[tuple[str, str]]:
    """Yield depths of published crossings, and of one by the rate equations, in T_st."""
    less = MATERIALS["less_inelastic"]
    hot, cold = _pair("crossing", less)
    yield "less_inelastic.begin", rounded(PER_CENT * (hot.T[0] / cold.T[0] - 1.0))
    yield "less_inelastic.rates.depth", rounded(_rates_crossing("crossing", less).depth, 3)
    yield "less_inelastic.depth", rounded(crossing_of_published(hot, cold).depth, 3)
    for name in ("smoother_inelastic", "less_inelastic"):
        pair = _pair("overshoot", MATERIALS[name])
        yield f"{name}.overshoot.depth", rounded(crossing_of_published(*pair, True).depth, 3)


DIFFERENT = {
    "smoother_inelastic": ("crossing", "last"),
    "smoother": ("overshoot", "third"),
}
"""Protocol and quarter of the published curves of cold gases that ours are not, by material."""


def _curves(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Yield what the page says of curves that are not the published ones."""
    count = len(MATERIALS) * len(FINDINGS) * 2
    yield "curves", f"{count}"
    yield "curves.limit", rounded(curve_limit(count), 5)
    for name, (protocol, quarter) in DIFFERENT.items():
        material = MATERIALS[name]
        at = f"{material.at}, {quarter} quarter of the curve"
        rows = rows_of(evidence, STUDY, f"mean of T/T_st, {protocol}, cold gas")
        yield f"{name}.quarter", with_error(rows[at].gap)
        theirs = published(protocol, "cold", material.r, material.beta)
        early = theirs.time <= EARLY
        rates = _rates(protocol, "cold", material, theirs.time)
        yield f"{name}.below_rates", rounded(float(np.max((rates.T - theirs.T)[early])), 3)


def _shares() -> Iterator[tuple[str, str]]:
    """Yield T_rot/T_tr by the Sonine approximation at two shares of rotation in the drive."""
    less = MATERIALS["less_inelastic"]
    for name, share in (("share", 0.6), ("tenth", 0.1)):
        R = float(theory.sonine_state(less.r, less.beta, spin_share=share).R)
        yield f"theta.{name}", rounded(R / (1.0 - R), 3)


def _minus_one(estimate: Estimate) -> Estimate:
    return estimate._replace(value=estimate.value - 1.0)
