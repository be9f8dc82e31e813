"""The numbers that pages quote: each computed from reduced datasets and verdicts, as text by name.

A page has the mark `<!--NAME-->` right behind a number. When the documentation is built, what
stands before a mark comes from the file that `write` has written (`filled`).
"""

import json
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from roughgas.base import as_json
from roughgas.base.files import write_text
from roughgas.claims.evidence import FAILS, HOLDS, QUALIFIED, theory_of
from roughgas.data.reduced import EQUILIBRATED, read_reduced
from roughgas.statistics.errors import Estimate

WALLS = "vibrated_rough_walls", "vibrated_particle_walls", "vibrated_smooth_walls"
ROWS = {"r9_b95": (0.9, -0.95), "r8_b80": (0.8, -0.8), "r8_b95": (0.8, -0.95), "r9_b50": (0.9, 0.5)}
"""Points of the sheared gas that are compared one by one: (r, beta)."""
MISSING = "–"
"""In place of a number that a small scale does not simulate."""
IN_WORDS = "none one two three four five six seven eight nine ten eleven twelve thirteen fourteen "
IN_WORDS += "fifteen sixteen seventeen eighteen nineteen twenty"
MARKED = re.compile(r"[\w.−]+(?:\(\d+\))?(<!--([\w.]+)-->)")
COUNTED = {"holds": HOLDS, "qualified": QUALIFIED, "fails": FAILS}


def write(inputs: list[str], *, claims: str, output: str) -> None:
    """Write the numbers of reduced datasets and of the verdicts on the paper, JSON."""
    gases = {one.attrs["experiment"]: _beside_theory(one) for one in map(read_reduced, inputs)}
    verdicts = json.loads(Path(claims).read_text(encoding="utf-8"))
    write_text(output, as_json(numbers(gases, verdicts)))


def numbers(gases: Mapping[str, xr.Dataset], verdicts: Mapping[str, list]) -> dict[str, str]:
    """Return the numbers of experiments beside theory, and the counts of verdicts, by name.

    Of experiments of studies: gases that random kicks drive, where these turn no particle.
    """
    bed, sheared, cooling = (gases[name] for name in ("vibrated", "sheared", "cooling"))
    rough, *other = (abs(gases[name].R - bed.R) for name in WALLS)
    found = {f"bed.collisions.{key}": one for key, one in _most(bed, "R_collisional").items()}
    found |= {f"bed.time.{key}": one for key, one in _most(bed, "R").items()}
    found |= {f"sheared.time.{key}": one for key, one in _most(sheared, "R").items()}
    for name in (one for one in gases if "." in one):
        kicked = gases[name].sel(spin_share=0.0)
        found[f"{name}.collisions"] = _up(abs(kicked.R_collisional - kicked.theory))
        found[f"{name}.time"] = _at(kicked, "R", 0.9, 0.0)
    found["walls.rough"] = _text(float(rough.max()), 1)
    found["walls.other"] = _up(xr.merge([one.rename(f"R{k}") for k, one in enumerate(other)]))
    off = 100.0 * (cooling.R / cooling.theory - 1.0)
    found["cooling.percent"] = _text(float(abs(off.where(off.r >= 0.8)).max()), 1)
    found["cooling.dissipative.percent"] = _text(-float(off.where(off.r < 0.8).min()), 0)
    for name, r in (("r99", 0.99), ("r8", 0.8)):
        at = cooling.R.where((cooling.r == r) & (cooling.beta == -0.8))
        found[f"cooling.{name}_b80"] = _text(float(at.max()), 2)
    return found | _of_rows(sheared) | _counts(verdicts["claims"])


def filled(page: str, numbers: Mapping[str, str], marks: bool = False) -> str:
    """Return a page with these numbers before its marks; the `marks` stay or go.

    Raises KeyError for a mark that names none.
    """
    return MARKED.sub(lambda one: numbers[one[2]] + one[1] * marks, page)


def quoted(page: str) -> set[str]:
    """Return the names of all marks in a page."""
    return {one[2] for one in MARKED.finditer(page)}


def _beside_theory(gas: xr.Dataset) -> xr.Dataset:
    """Return a reduced dataset with `theory`, and its averages NaN where there is no steady state.

    Other than `evidence.beside_theory` it keeps what was simulated with the contact-time model.
    """
    averages = [name for name in ("R", "R_collisional") if name in gas]
    steady = gas[averages].where(gas.equilibrated > EQUILIBRATED)
    return gas.assign(steady).assign(theory=gas.R.copy(data=theory_of(gas)))


def _most(gas: xr.Dataset, name: str) -> dict[str, str]:
    """Return the largest deviation from theory, and where it is; and that beyond the paper."""
    off = gas[name] - gas.theory
    inside = abs(off.where(off.r >= 0.8))
    at = dict.fromkeys(("r", "beta"), MISSING)
    if inside.notnull().any():
        r, beta = (float(one) for one in inside.stack(at=("r", "beta")).idxmax("at").item())
        at = {"r": f"{r:g}", "beta": f"{beta:g}".replace("-", "−")}
    beyond = off.where(off.r < 0.8)
    return {"most": _up(inside), "dissipative": _text(float(beyond.max()), 3)} | at


def _up(values) -> str:
    """Return the largest of values with three decimals."""
    largest = values.max()
    one = largest.to_array().max() if isinstance(largest, xr.Dataset) else largest
    return _text(float(one), 3)


def _text(value: float, digits: int) -> str:
    return MISSING if math.isnan(value) else f"{value:.{digits}f}"


def _at(gas: xr.Dataset, name: str, r: float, beta: float) -> str:
    """Return a value with its error; MISSING at a point that a small scale leaves out."""
    if r not in gas.r or beta not in gas.beta:
        return MISSING
    one = gas.sel(r=r, beta=beta)
    if f"{name}_stderr" not in one:
        return f"{float(one[name]):.4f}"
    return f"{Estimate(float(one[name]), float(one[f'{name}_stderr']))}"


def _of_rows(gas: xr.Dataset) -> dict[str, str]:
    """Return R over time, over collisions, and of theory at the points of ROWS."""
    found = {}
    for name, place in ROWS.items():
        found[f"sheared.{name}.time"] = _at(gas, "R", *place)
        found[f"sheared.{name}.collisions"] = _at(gas, "R_collisional", *place)
        found[f"sheared.{name}.theory"] = _at(gas, "theory", *place)
    return found


def _counts(claims: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """Return the numbers of statements of each verdict in words, the paper's and ours apart."""
    words = IN_WORDS.split()
    counts: dict[str, str] = {}
    for name, ours in (("claims", False), ("claims.ours", True)):
        verdicts = Counter(one["verdict"] for one in claims if one["ours"] == ours)
        counts |= {f"{name}.{key}": words[verdicts[one]] for key, one in COUNTED.items()}
        counts[f"{name}.all"] = words[verdicts.total()]
    return counts
