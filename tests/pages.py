"""The tables and numbers of pages that are made from code and from committed results.

`python -m tests.pages` writes them. A table stands in its page between two marks, a number in a
sentence has its mark after it. What `docs/command_line.md` shows is run by
tests/cli/page.py.
"""

import ast
import inspect
import math
from itertools import pairwise
from operator import attrgetter
from pathlib import Path

from roughgas import effects, observables
from roughgas.base import markdown
from roughgas.base.fields import fields_of
from roughgas.base.files import study_module
from roughgas.claims import read_study, verdicts
from roughgas.claims.numbers import filled
from roughgas.claims.pages import numbers_of_pages, tables_of_studies
from roughgas.config import json_schema
from roughgas.config.json_schema import DESCRIBERS, legal_values
from roughgas.data.reduced import REDUCED
from roughgas.data.trajectory import TRAJECTORY
from roughgas.data.variables import COOLING, GRID_PLACEHOLDER, POINT, SPIN
from roughgas.effects.species import PairSettings, RadiiSettings, SpeciesSettings
from roughgas.results import papers, row_verdicts
from roughgas.statistics import estimates
from roughgas.tasks import read_variables

ROOT = Path(__file__).parents[1]
STUDIES = ROOT / "studies"
PAPER = read_study(STUDIES / "paper", "The paper", ())
JUDGES = study_module(STUDIES / "paper", "judges")
DOCS = ROOT / "docs"
READMES = sorted(STUDIES.glob("*/README.md"))
QUOTING = (DOCS / "results.md", DOCS / "evidence.md", ROOT / "paper.md", *READMES)
"""Pages whose numbers have marks."""
EDITORS = Path(json_schema.__file__).with_name("config.schema.json")
BEGIN, END = "<!-- {}: made by tests/pages.py -->\n", "<!-- until here -->\n"
WRITTEN = "only roughgas writes it"  # the schema's description of keys that no configuration has
DECIDES = dict.fromkeys(
    ("AGREE", "DISAGREE", "TENDENCY", "EXCEPTIONS", "AGREE_RELATIVE", "DISAGREE_RELATIVE"), verdicts
)
DECIDES |= dict.fromkeys(("FALSE_DISCOVERIES", "TESTED_SHARE", "TESTED_SCALE"), row_verdicts)
DECIDES |= {
    "SIGNIFICANT": estimates,
    "POWER": estimates,
    "INTERMEDIATE": JUDGES,
    "CONSIDERABLY": JUDGES,
    "SHARE_FROM_AVERAGING": JUDGES,
}
"""Tolerances of verdicts, and the module of each."""


def tables():
    """Each table by its page and its name."""
    by_page_and_name = {("evidence", "tolerances"): _tolerances()}
    whose = {False: "the paper", True: "ours"}
    rows = ((f"`{s.name}`", whose[s.ours], s.criterion, s.fixed.text) for s in PAPER.statements)
    by_page_and_name["evidence", "paper"] = markdown(
        ("statement", "of", "criterion", "fixed"), rows
    )
    schema = json_schema.schema()
    definitions = schema["$defs"]
    by_page_and_name["config", "file"] = _keys_of(schema)
    for name in ("experiment", "sweep", "schedule", "stage"):
        by_page_and_name["config", name] = _keys_of(definitions[name])
    by_page_and_name["config", "layer"] = _keys_of(definitions["layer"], depth=2)
    by_page_and_name["config", "accuracy"] = _keys_of(definitions["accuracy"], depth=4)
    by_page_and_name["effects", "effects"] = _effects()
    for name, kind in OF_SPECIES.items():
        by_page_and_name["effects", name] = _fields(kind)
    by_page_and_name["observables", "observables"] = _observables()
    by_page_and_name["data", "point"] = _variables("type units when", POINT, _units)
    by_page_and_name["data", "reduced"] = _variables("units how", REDUCED, _units)
    by_page_and_name["trajectories", "trajectory"] = _variables("units when", TRAJECTORY)
    study_variables = {
        name: read_variables(STUDIES / "accuracy" / "variables.yaml", name)
        for name in ("statistical", "models", "discretisation")
    }
    study_variables["coverage"] = read_variables(STUDIES / "coverage" / "variables.yaml")
    by_page_and_name["papers", "papers"] = papers.table_of_studies(
        papers.read(ROOT / "figures" / "papers.csv"), "../studies/{study}/README.md"
    )
    for (study, name), table in tables_of_studies(ROOT).items():
        by_page_and_name[f"studies/{study}", name] = table
    return by_page_and_name | {
        ("data", name): _variables("units", described)
        for name, described in study_variables.items()
    }


def path_of(page):
    """The file of a page: of a study, or of the documentation."""
    return ROOT / page / "README.md" if page.startswith("studies/") else DOCS / f"{page}.md"


def written(page, name):
    text = path_of(page).read_text(encoding="utf-8")
    return text.split(BEGIN.format(name))[1].split(END)[0]


def write():
    for (page, name), table in tables().items():
        path, begin = path_of(page), BEGIN.format(name)
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace(begin + written(page, name) + END, begin + table + END))
    numbers = numbers_of_pages(ROOT)
    for page in QUOTING:
        page.write_text(with_numbers(page, numbers), encoding="utf-8")
    EDITORS.write_text(json_schema.text(), encoding="utf-8")


def with_numbers(page, numbers):
    """Return the text of a page with these numbers, by mark, before its marks."""
    return filled(page.read_text(encoding="utf-8"), numbers, marks=True)


# ---------------------------------------------------------------------- claims


def _tolerances():
    """Each tolerance with its value, and what its docstring says."""
    constants = (
        (name, getattr(of, name), constant_docstrings(of)[name]) for name, of in DECIDES.items()
    )
    rows = [(f"`{name}`", f"{value:.3g}", docstring) for name, value, docstring in constants]
    return markdown(("tolerance", "value", "what it is, and why so large"), rows)


def constant_docstrings(module):
    """The docstring of each constant of a module, as one line."""
    body = ast.parse(inspect.getsource(module)).body
    return {
        ast.unparse(assignment.targets[0]): " ".join(docstring.value.value.split())
        for assignment, docstring in pairwise(body)
        if isinstance(assignment, ast.Assign)
        and isinstance(docstring, ast.Expr)
        and isinstance(docstring.value, ast.Constant)
    }


# ---------------------------------------------------------------------- configuration


def _keys_of(schema, depth=1):
    return markdown(("key", "it must", "meaning"), _rows(schema, "", depth))


def _is_written(schema):
    return WRITTEN in schema.get("description", "")


def _rows(schema, above, depth):
    """Generate a row for each key of a mapping and of its inner mappings, down to a depth."""
    keys = [(key, entry) for key, entry in schema["properties"].items() if not _is_written(entry)]
    keys += [(entry["title"], entry) for entry in schema.get("patternProperties", {}).values()]
    for key, entry_schema in keys:
        resolved = _resolved(entry_schema)
        legal = legal_values(resolved) if any(keyword in resolved for keyword in DESCRIBERS) else ""
        yield f"`{above}{key}`", legal, resolved.get("description", "").replace("|", r"\|")
        if depth > 1 and "properties" in resolved:
            yield from _rows(resolved, f"{above}{key}.", depth - 1)


def _resolved(schema):
    """A definition in place of a reference to it; what stands beside the reference comes first."""
    if "$ref" not in schema:
        return schema
    definition = json_schema.schema()
    for step in schema["$ref"].removeprefix("#/").split("/"):
        definition = definition[step]
    return _resolved(definition) | {
        key: keyword_value for key, keyword_value in schema.items() if key != "$ref"
    }


# ---------------------------------------------------------------------- effects and observables


def _effects():
    """Return the table of effects; effects with equal descriptions share a row."""
    alike = {}
    for name, kind in effects.EFFECTS.items():
        hooks = [f"`{hook}`" for hook, function in kind.hooks._asdict().items() if function]
        described = "<br>".join(map(_field, fields_of(kind.settings)))
        alike.setdefault((kind.__doc__, described, ", ".join(hooks)), []).append(f"`{name}`")
    head = ("effect", "what it does", "parameters", "part in the kernel")
    return markdown(head, ((", ".join(names), *cells) for cells, names in alike.items()))


OF_SPECIES = {"species": SpeciesSettings, "radii": RadiiSettings, "pairs": PairSettings}


def _fields(kind):
    """A row for each field of a struct of settings."""
    head = ("key", "it must", "if not given", "meaning")
    return markdown(
        head, ((f"`{f.name}`", f.legal, _default(f), f.description) for f in fields_of(kind))
    )


def _default(field):
    if field.required:
        return "(must be given)"
    return "" if field.default is None else f"{field.default:g}"


def _field(field):
    """Return the legal values, the default and the meaning of a field of settings."""
    # a default that is no number, such as the default of below_r, is described in words
    default = "" if field.default in (None, math.inf) else f", {field.default} if not given"
    legal = field.legal.removeprefix("be ").replace(" or be particles", " or `particles`")
    return f"`{field.name}` {legal}{default}: {field.description.removesuffix('.')}"


def _observables():
    """Return the tables of observables and of their variables."""
    settings, rows = [], []
    for name, kind in observables.OBSERVABLES.items():
        fields = [field for field in fields_of(kind.settings) if field.name != "every"]
        described = "<br>".join(map(_field, fields))
        settings.append((f"`{name}`", kind.__doc__, described, _window(kind)))
        for variable, v in kind.variables.items():
            dims, when = ", ".join(v.dims), ", ".join(v.when)
            rows.append((f"`{name}`", f"`{variable}`", dims, v.units, when, v.long_name))
    head = ("observable", "variables", "dimensions", "units", "when", "meaning")
    kinds = ("observable", "what it is", "settings", "window")
    return f"{markdown(kinds, settings)}\n{markdown(head, rows)}"


def _window(kind):
    """Return the window that an observable needs, in e-folds, and the cases without a known
    window."""
    if math.isinf(kind.relaxations):
        return "not known"
    unknown = ["in beds"] * (not kind.valid_in_beds) + [f"of `{name}`" for name in kind.unvalidated]
    text = f"{kind.relaxations:g}{' of flows, too' * kind.depends_on_flow}"
    return f"{text}; not known {', '.join(unknown)}" if unknown else text


# ---------------------------------------------------------------------- variables of datasets


def _variables(columns, variables, units=attrgetter("units")):
    """Return a table of variables: dimensions, these columns, and meaning."""
    columns = columns.split()
    cell = {"type": lambda v: v.dtype, "units": units, "how": _combination}
    cell["when"] = lambda v: ", ".join(v.when) or "always"
    rows = [
        (f"`{name}`", ", ".join(v.dims), *(cell[column](v) for column in columns), v.long_name)
        for name, v in variables.items()
    ]
    return markdown(("variable", "dimensions", *columns, "meaning"), rows)


def _combination(v):
    if GRID_PLACEHOLDER not in v.dims:
        return "axis"
    return f"{v.over_seeds} over seeds" if v.over_seeds else "derived"


def _units(v):
    """Return the units in a driven gas; after a semicolon in a cooling gas, if they differ."""
    gases = (True,) if COOLING in v.when else (False,)
    gases = (False, True) if set(v.when) <= {SPIN} else gases
    return "; ".join(dict.fromkeys(v.units_of(cooling) for cooling in gases))


if __name__ == "__main__":
    write()
