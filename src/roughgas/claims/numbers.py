"""Numbers quoted in pages: computed from reduced datasets and verdicts, as text by name.

A page has the mark `<!--NAME-->` right after a number. When the documentation is built, `filled`
replaces the text before each mark by the number in the file that `write` has written. Numbers of
evidence, and of studies, are in pages.py.
"""

import json
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.base import Record, as_json
from roughgas.base.files import write_text
from roughgas.base.text import with_minus_signs
from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED, theory_of
from roughgas.data.reduced import STEADY_SHARE, read_reduced
from roughgas.statistics.estimates import Estimate

WALLS = "vibrated_rough_walls", "vibrated_particle_walls", "vibrated_smooth_walls"
SHEARED_POINTS = {
    "r9_b95": (0.9, -0.95),
    "r8_b80": (0.8, -0.8),
    "r8_b90": (0.8, -0.9),
    "r9_b50": (0.9, 0.5),
}
"""Points (r, beta) of the sheared gas that are quoted individually; all are known to be steady."""
MISSING = "–"
"""Replaces a number that a small scale does not simulate, or of a gas not known to be steady."""
IN_WORDS = "none one two three four five six seven eight nine ten eleven twelve thirteen fourteen "
IN_WORDS += "fifteen sixteen seventeen eighteen nineteen twenty"
MARKED_NUMBER = re.compile(r"[\w.+−]+(?:\([\d.]+\))?(<!--([\w.]+)-->)")
VERDICT_KEYS = {"holds": HOLDS, "qualified": QUALIFIED, "fails": FAILS}


def write(inputs: list[str], *, claims: str, output: str) -> None:
    """Write the quoted numbers of reduced datasets and of the verdicts on the paper, JSON."""
    gases = {gas.attrs["experiment"]: _beside_theory(gas) for gas in map(read_reduced, inputs)}
    verdicts = json.loads(Path(claims).read_text(encoding="utf-8"))
    write_text(output, as_json(numbers(gases, verdicts)))


def numbers(gases: Mapping[str, xr.Dataset], verdicts: Mapping[str, list]) -> dict[str, str]:
    """Return the numbers that pages quote, as texts by the names of their marks.

    `gases` are reduced datasets with theory, by experiment, `verdicts` is the content of
    claims.json on the paper. Experiments of studies are gases driven by random kicks; only kicks
    without spin are quoted.
    """
    bed, sheared, cooling = (gases[name] for name in ("vibrated", "sheared", "cooling"))
    rough_walls, *other_walls = (abs(gases[name].R - bed.R) for name in WALLS)
    texts = {
        f"bed.collisions.{key}": x for key, x in _largest_deviation(bed, "R_collisional").items()
    }
    texts |= {f"bed.time.{key}": x for key, x in _largest_deviation(bed, "R").items()}
    texts |= {f"sheared.time.{key}": x for key, x in _largest_deviation(sheared, "R").items()}
    for name in (experiment for experiment in gases if "." in experiment):
        kicked = gases[name].sel(spin_share=0.0)
        texts[f"{name}.collisions"] = _largest_text(abs(kicked.R_collisional - kicked.theory))
        texts[f"{name}.time"] = _estimate_text(kicked, "R", 0.9, 0.0)
    texts["walls.rough"] = _text(float(rough_walls.max()), 1)
    shifts = xr.merge([shift.rename(f"R{k}") for k, shift in enumerate(other_walls)])
    texts["walls.other"] = _largest_text(shifts)
    percent = 100.0 * (cooling.R / cooling.theory - 1.0)
    texts["cooling.percent"] = _text(float(abs(percent.where(percent.r >= 0.8)).max()), 1)
    texts["cooling.dissipative.percent"] = _text(-float(percent.where(percent.r < 0.8).min()), 0)
    for name, r in (("r99", 0.99), ("r8", 0.8)):
        ratio = cooling.R.where((cooling.r == r) & (cooling.beta == -0.8))
        texts[f"cooling.{name}_b80"] = _text(float(ratio.max()), 2)
    texts |= _smooth_disks(gases[WALLS[0]])
    return texts | _sheared_points(sheared) | _counts(verdicts["claims"])


def filled(page: str, numbers: Mapping[str, str], marks: bool = False) -> str:
    """Return a page with the texts `numbers` filled in before its marks `<!--NAME-->`.

    The marks are kept if `marks` is true. Raises KeyError for an unknown mark.
    """
    return MARKED_NUMBER.sub(lambda match: numbers[match[2]] + match[1] * marks, page)


def quoted(page: str) -> set[str]:
    """Return the names of all marks `<!--NAME-->` in a page."""
    return {match[2] for match in MARKED_NUMBER.finditer(page)}


def _beside_theory(gas: xr.Dataset) -> xr.Dataset:
    """Return a reduced dataset with `theory`, R by theory, and with averages of steady states only.

    Elsewhere R and R_collisional are NaN. Unlike `verdicts.beside_theory` this keeps points
    simulated with the contact-time model.
    """
    averages = [name for name in ("R", "R_collisional") if name in gas]
    steady = gas[averages].where(gas.equilibrated > STEADY_SHARE)
    return gas.assign(steady).assign(theory=gas.R.copy(data=theory_of(gas)))


def _largest_deviation(gas: xr.Dataset, name: str) -> dict[str, str]:
    """Return the largest deviation of the average `name` of R from theory, and its r and beta.

    They are texts: `most`, its magnitude for r >= 0.8, as in the paper, with `r` and `beta`, and
    `dissipative`, the largest for smaller r.
    """
    deviation = gas[name] - gas.theory
    inside = abs(deviation.where(deviation.r >= 0.8))
    location = dict.fromkeys(("r", "beta"), MISSING)
    if inside.notnull().any():
        r, beta = (
            float(coordinate) for coordinate in inside.stack(at=("r", "beta")).idxmax("at").item()
        )
        location = {"r": f"{r:g}", "beta": with_minus_signs(f"{beta:g}")}
    beyond = deviation.where(deviation.r < 0.8)
    return {"most": _largest_text(inside), "dissipative": _text(float(beyond.max()), 3)} | location


def _largest_text(values) -> str:
    """Return the largest of `values`, an array or a dataset of arrays, with three decimals."""
    largest = values.max()
    scalar = largest.to_array().max() if isinstance(largest, xr.Dataset) else largest
    return _text(float(scalar), 3)


def _text(value: float, digits: int) -> str:
    """Return a number as text with `digits` decimals; MISSING for NaN."""
    return MISSING if math.isnan(value) else f"{value:.{digits}f}"


def _estimate_text(gas: xr.Dataset, name: str, r: float, beta: float) -> str:
    """Return the variable `name` of a reduced dataset at a point, with its error, as text.

    It is MISSING at a point that was not simulated, or is not known to be steady.
    """
    if r not in gas.r or beta not in gas.beta or np.isnan(gas[name].sel(r=r, beta=beta)):
        return MISSING
    point = gas.sel(r=r, beta=beta)
    if f"{name}_stderr" not in point:
        return f"{float(point[name]):.4f}"
    return f"{Estimate(float(point[name]), float(point[f'{name}_stderr']))}"


def _sheared_points(gas: xr.Dataset) -> dict[str, str]:
    """Return R averaged over time, over collisions, and by theory at SHEARED_POINTS, as texts."""
    texts = {}
    for name, point in SHEARED_POINTS.items():
        texts[f"sheared.{name}.time"] = _estimate_text(gas, "R", *point)
        texts[f"sheared.{name}.collisions"] = _estimate_text(gas, "R_collisional", *point)
        texts[f"sheared.{name}.theory"] = _estimate_text(gas, "theory", *point)
    return texts


def _smooth_disks(rough: xr.Dataset) -> dict[str, str]:
    """Return numbers of smooth disks (beta = -1) between rough walls at r = 0.9, as texts.

    They are R, R if spins had the vertical energy, and the ratios of the vertical energy to the
    horizontal one (`anisotropy`) and of E_rot to the vertical one (`spin`).
    """
    names = [f"walls.smooth.{name}" for name in ("R", "R_vertical", "anisotropy", "spin")]
    if 0.9 not in rough.r or -1.0 not in rough.beta:
        return dict.fromkeys(names, MISSING)
    point = rough.sel(r=0.9, beta=-1.0)
    vertical = 2.0 * float(point.vertical_share)  # over E_trans
    spin = float(point.E_rot / point.E_trans)
    values = vertical / (1.0 + vertical), vertical / (2.0 - vertical), spin / vertical
    texts = map(_text, values, (3, 2, 2))
    return dict(zip(names, [_estimate_text(rough, "R", 0.9, -1.0), *texts], strict=True))


def in_words(count: int) -> str:
    """Return a count as a word, or in digits if it is large."""
    words = IN_WORDS.split()
    return words[count] if count < len(words) else f"{count}"


def _counts(claims: Sequence[Record]) -> dict[str, str]:
    """Return the numbers of statements of each verdict in words, separately for ours.

    `claims` are the entries of claims.json.
    """
    counts: dict[str, str] = {}
    for name, ours in (("claims", False), ("claims.ours", True)):
        verdicts = Counter(claim["verdict"] for claim in claims if claim["ours"] == ours)
        counts |= {
            f"{name}.{key}": in_words(verdicts[verdict]) for key, verdict in VERDICT_KEYS.items()
        }
        counts[f"{name}.all"] = in_words(verdicts.total())
    return counts
