"""The tables of the documentation that are made from the code: `python -m tests.pages` writes them.

Each stands in its page between two marks. What `docs/command_line.md` shows is run by
tests/cli/page.py.
"""

import ast
import inspect
import json
import math
from itertools import pairwise
from operator import attrgetter
from pathlib import Path

from roughgas import accuracy, effects, observables
from roughgas.base import markdown
from roughgas.claims import PAPER, evidence, paper
from roughgas.claims.numbers import filled
from roughgas.config.schema import SAID, _legal, _schema
from roughgas.data.reduced import REDUCED
from roughgas.data.trajectory import TRAJECTORY
from roughgas.data.variables import COOLING, GRID, POINT, SPIN
from roughgas.effects.settings import Numbers, OfParticles, Word
from roughgas.statistics import errors
from roughgas.tasks import variables

DOCS = Path(__file__).parents[1] / "docs"
RESULTS = DOCS / "results.md"
BEGIN, END = "<!-- {}: made by tests/pages.py -->\n", "<!-- until here -->\n"
WRITTEN = "only roughgas writes it"  # what the schema says of keys that no configuration has
DECIDES = dict.fromkeys(("AGREE", "LIMIT", "TENDENCY", "FEW", "NEAR", "FAR"), evidence)
DECIDES |= {"SIGNIFICANT": errors, "INTERMEDIATE": paper, "CONSIDERABLY": paper, "MOST": paper}
"""Tolerances of verdicts, and the module of each."""


def tables():
    """Each table by its page and its name."""
    found = {("claims", "tolerances"): _tolerances()}
    whose = {False: "the paper", True: "ours"}
    rows = ((f"`{s.name}`", whose[s.ours], s.criterion, s.fixed) for s in PAPER.statements)
    found["claims", "paper"] = markdown(("statement", "of", "criterion", "fixed"), rows)
    parts = _schema()["$defs"]
    found["config", "file"] = _keys_of(_schema())
    for name in ("experiment", "sweep", "schedule", "stage"):
        found["config", name] = _keys_of(parts[name])
    found["config", "layer"] = _keys_of(parts["layer"], depth=2)
    found["config", "accuracy"] = _keys_of(parts["accuracy"], depth=4)
    found["effects", "effects"] = _effects()
    found["observables", "observables"] = _observables()
    found["data", "point"] = _variables("type units when", POINT, _units)
    found["data", "reduced"] = _variables("units how", REDUCED, _units)
    found["trajectories", "trajectory"] = _variables("units when", TRAJECTORY)
    known = {name: variables(accuracy.VARIABLES, name) for name in accuracy.STUDIES}
    return found | {("data", name): _variables("units", one) for name, one in known.items()}


def written(page, name):
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    return text.split(BEGIN.format(name))[1].split(END)[0]


def write():
    for (page, name), table in tables().items():
        path, begin = DOCS / f"{page}.md", BEGIN.format(name)
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace(begin + written(page, name) + END, begin + table + END))
    RESULTS.write_text(quoted(), encoding="utf-8")


def quoted():
    """The page of results with the numbers of the last results."""
    numbers = json.loads((DOCS.parent / "figures" / "numbers.json").read_text(encoding="utf-8"))
    return filled(RESULTS.read_text(encoding="utf-8"), numbers, marks=True)


# ---------------------------------------------------------------------- claims


def _tolerances():
    """Each tolerance with its value, and what its docstring says."""
    found = ((name, getattr(of, name), said(of)[name]) for name, of in DECIDES.items())
    rows = [(f"`{name}`", f"{value:.3g}", about) for name, value, about in found]
    return markdown(("tolerance", "value", "what it is, and why so large"), rows)


def said(module):
    """The docstring of each constant of a module, as one line."""
    body = ast.parse(inspect.getsource(module)).body
    return {
        ast.unparse(one.targets[0]): " ".join(text.value.value.split())
        for one, text in pairwise(body)
        if isinstance(one, ast.Assign)
        and isinstance(text, ast.Expr)
        and isinstance(text.value, ast.Constant)
    }


# ---------------------------------------------------------------------- configuration


def _keys_of(schema, depth=1):
    return markdown(("key", "it must", "meaning"), _rows(schema, "", depth))


def _is_written(about):
    return WRITTEN in about.get("description", "")


def _rows(schema, above, depth):
    """A row for each key of a mapping, and for those of the mappings in it, down to a depth."""
    keys = [(key, one) for key, one in schema["properties"].items() if not _is_written(one)]
    keys += [(one["title"], one) for one in schema.get("patternProperties", {}).values()]
    for key, about in keys:
        found = _resolved(about)
        legal = _legal(found) if any(keyword in found for keyword in SAID) else ""
        yield f"`{above}{key}`", legal, found.get("description", "").replace("|", r"\|")
        if depth > 1 and "properties" in found:
            yield from _rows(found, f"{above}{key}.", depth - 1)


def _resolved(schema):
    """A definition in place of a reference to it; what stands beside the reference comes first."""
    if "$ref" not in schema:
        return schema
    found = _schema()
    for step in schema["$ref"].removeprefix("#/").split("/"):
        found = found[step]
    return _resolved(found) | {key: one for key, one in schema.items() if key != "$ref"}


# ---------------------------------------------------------------------- effects and observables


def _effects():
    """What effects there are; those alike share a row."""
    alike = {}
    for name, kind in effects.KINDS.items():
        there = [f"`{hook}`" for hook, own in kind.hooks._asdict().items() if own]
        described = "<br>".join(_parameter(key, one) for key, one in kind.parameters.items())
        alike.setdefault((kind.__doc__, described, ", ".join(there)), []).append(f"`{name}`")
    head = ("effect", "what it does", "parameters", "part in the kernel")
    return markdown(head, ((", ".join(names), *about) for about, names in alike.items()))


def _parameter(key, one):
    about = one.number.description if isinstance(one, OfParticles) else one.description
    if isinstance(one, Word):
        legal = " or ".join(f"`{word}`" for word in one.words)
    elif isinstance(one, Numbers):
        legal = f"{one.fewest} to {one.most} numbers in {one.interval}"
    elif isinstance(one, OfParticles):
        legal = f"in {one.number.interval} or `particles`"
    else:
        legal = f"in {one.interval}"
    # a default that is no number of its own, as that of below_r, is described in words
    given = "" if one.default in (None, math.inf) else f", {one.default} if not given"
    return f"`{key}` {legal}{given}: {about.removesuffix('.')}"


def _observables():
    """What observables there are, and what lands in a dataset."""
    settings, rows = [], []
    for name, kind in observables.KINDS.items():
        told = "<br>".join(_setting(key, one) for key, one in kind.settings.items())
        settings.append((f"`{name}`", kind.__doc__, told, _window(kind)))
        for variable, v in kind.variables.items():
            dims, when = ", ".join(v.dims), ", ".join(v.when)
            rows.append((f"`{name}`", f"`{variable}`", dims, v.units, when, v.long_name))
    head = ("observable", "variables", "dimensions", "units", "when", "meaning")
    kinds = ("observable", "what it is", "settings", "window")
    return f"{markdown(kinds, settings)}\n{markdown(head, rows)}"


def _window(kind):
    """The e-folds that a kind of observable needs, of flows, too, and where they are not known."""
    if math.isinf(kind.relaxations):
        return "not known"
    unknown = ["in beds"] * (not kind.beds) + [f"of `{name}`" for name in kind.doubtful]
    text = f"{kind.relaxations:g}{' of flows, too' * kind.of_flow}"
    return f"{text}; not known {', '.join(unknown)}" if unknown else text


def _setting(key, one):
    legal = getattr(one, "interval", None) or f"[{one.low}, {one.high}]"
    given = "" if one.default is None else f", {one.default:g} if not given"
    return f"`{key}` in {legal}{given}: {one.description.removesuffix('.')}"


# ---------------------------------------------------------------------- variables of datasets


def documented(page, name):
    """The (dimensions, meaning) of each variable of a table that is on its page."""
    rows = [line[2:-2].split(" | ") for line in written(page, name).splitlines()[2:]]
    return {
        row[0].strip("`"): (tuple(row[1].split(", ")) if row[1] else (), row[-1]) for row in rows
    }


def check_study(name, data):
    """Whether the combined data of a study hold all that the page documents, and nothing else."""
    found = {key: (one.dims, one.attrs["long_name"]) for key, one in data.variables.items()}
    assert documented("data", name) == found


def _variables(columns, known, units=attrgetter("units")):
    """A row for each variable: its dimensions, these columns, and what it means."""
    columns = columns.split()
    cell = {"type": lambda v: v.dtype, "units": units, "how": _combination}
    cell["when"] = lambda v: ", ".join(v.when) or "always"
    rows = [
        (f"`{name}`", ", ".join(v.dims), *(cell[column](v) for column in columns), v.long_name)
        for name, v in known.items()
    ]
    return markdown(("variable", "dimensions", *columns, "meaning"), rows)


def _combination(v):
    if GRID not in v.dims:
        return "axis"
    return f"{v.over_seeds} over seeds" if v.over_seeds else "derived"


def _units(v):
    """Of a driven gas; after a semicolon of a cooling one, where it has others."""
    gases = (True,) if COOLING in v.when else (False,)
    gases = (False, True) if set(v.when) <= {SPIN} else gases
    return "; ".join(dict.fromkeys(v.units_of(cooling) for cooling in gases))


if __name__ == "__main__":
    write()
