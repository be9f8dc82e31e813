"""How the site is built from these pages, the tutorial, and the docstrings: `make docs`.

It can be read without a network: nothing in it is loaded from elsewhere.
"""

import json
import logging
import os.path
import re
import shutil
from pathlib import Path

from docutils.nodes import SkipNode
from jupyter_client.manager import KernelManager
from latex2mathml.converter import convert
from sphinx.errors import SphinxError

import roughgas
from roughgas.claims.numbers import filled
from roughgas.results.evidence import as_markdown, read_rows

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
EVIDENCE = "<!-- evidence: figures/evidence.csv -->"
INDEX, README = DOCS / "index.md", ROOT / "README.md"
LINK = re.compile(r"\[([^\]]*)\]\(([^)#\s]+)(#[^)\s]*)?\)")
LOADED = re.compile(
    r"""<(?:script|img|iframe|source)\b[^>]*\bsrc=["']?(?:https?:)?//"""
    r"""|<link\b[^>]*\bhref=["']?(?:https?:)?//|url\(["']?(?:https?:)?//|@import"""
)

project = "roughgas"
author = "The roughgas developers"
copyright = author
version = release = roughgas.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.napoleon"]
exclude_patterns = ["_build", "**.ipynb_checkpoints"]
nitpicky = True
nitpick_ignore_regex = [
    (
        "py:.*",
        r"(numpy|xarray|pathlib|collections|contextlib|netCDF4|types)\..*",
    ),  # whose pages are not here
    ("py:class", r"roughgas\.(kernel|effects|simulation)\..*"),  # no library, but what is compiled
    ("py:class", "Observe|Functions"),  # types of arguments, imported for the checker alone
]

html_theme = "furo"
html_extra_path = ["explore.html", "living.html", *map(str, ROOT.glob("figures/*.html"))]
html_title = f"roughgas {version}"
html_show_sourcelink = html_show_sphinx = html_copy_source = False

myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]
html_math_renderer = "mathml"
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300  # s a cell: a kernel may have to be compiled
nb_output_stderr = "remove"  # progress bars
KernelManager.transport_encryption.default_value = "auto"  # others use this machine, too
logging.getLogger("traitlets").setLevel(logging.WARNING)

default_role = "code"
autodoc_member_order = "bysource"
add_module_names = False
python_maximum_signature_line_length = 160
autodoc_preserve_defaults = True
autodoc_default_options = {"no-value": True}
napoleon_google_docstring = False


def setup(app):
    app.connect("builder-inited", write_studies)
    app.connect("source-read", mend_links)
    app.connect("source-read", fill_numbers)
    app.add_html_math_renderer("mathml", (inline_formula, None), (formula, None))
    app.connect("env-get-outdated", lambda *_: ["tutorial"])  # it runs at each build
    app.connect("autodoc-process-docstring", as_prose)
    app.connect("autodoc-skip-member", skip_fields)
    app.connect("build-finished", refuse_what_is_loaded)


def write_studies(app):
    """A page for each study that is there, made of its README.md."""
    pages = DOCS / "studies"
    shutil.rmtree(pages, ignore_errors=True)
    pages.mkdir()
    for readme in sorted(ROOT.glob("studies/*/README.md")):
        text = linked(readme.read_text(encoding="utf-8"), readme.parent, pages)
        (pages / f"{readme.parent.name}.md").write_text(text, encoding="utf-8")


def mend_links(app, docname, source):
    """Links in pages, which are right where the repository is read, become right here.

    The first page is README.md.
    """
    folder = (DOCS / docname).parent
    source[0] = linked(source[0], folder, folder)
    if docname == "index":
        source[0] = f"{linked(README.read_text(encoding='utf-8'), ROOT, DOCS)}\n{source[0]}"


def fill_numbers(app, docname, source):
    """Numbers and rows that pages take from results become those of the last results."""
    numbers = json.loads((ROOT / "figures" / "numbers.json").read_text(encoding="utf-8"))
    source[0] = filled(source[0], numbers)
    if docname == "evidence":
        rows = read_rows(ROOT / "figures" / "evidence.csv")
        source[0] = source[0].replace(EVIDENCE, as_markdown(rows))


def inline_formula(translator, node):
    translator.body.append(mathml(node, "inline"))
    raise SkipNode


def formula(translator, node):
    translator.body.append(f'<div class="formula">{mathml(node, "block")}</div>')
    raise SkipNode


def mathml(node, display):
    """A formula as every present browser shows it by itself, without a script or a font."""
    return convert(" ".join(node.astext().split()), display=display)


def linked(text, base, folder):
    """Links in `text` that are relative to `base`, made relative to `folder`.

    Those to README.md become links to the first page, or to that of a study, those to HTML
    addresses; those to folders, and to pages that are not part of the site, mere text.
    """

    def here(link):
        label, path, anchor = link.groups("")
        target = Path(os.path.normpath(base / path))
        if not target.exists():  # an address, or nothing: Sphinx will say so
            return link[0]
        if target.name == README.name and target.parent.parent == ROOT / "studies":
            target = DOCS / "studies" / f"{target.parent.name}.md"
        if target.is_dir() or (target.suffix == ".md" and not target.is_relative_to(DOCS)):
            return label if target != README else f"[{label}]({os.path.relpath(INDEX, folder)})"
        if target.suffix == ".html":
            return f'<a href="{os.path.relpath(DOCS / target.name, folder)}">{label}</a>'
        return f"[{label}]({os.path.relpath(target, folder)}{anchor})"

    return LINK.sub(here, text)


def as_prose(app, what, name, thing, options, lines):
    """Docstrings are prose, no markup: bars are those of |v|, what is indented is a formula."""
    found = ["", ""]
    for line in lines:
        after_prose = found[-2][:1].isalpha() and not found[-1]
        if line.startswith("    ") and after_prose:
            found += ["::", ""]
        found.append("`".join(_escaped(line.split("`"))) if line[:1] != " " else line)
    lines[:] = found[2:]


def _escaped(parts):
    """Parts of a line between backquotes: every other one is code."""
    return [part if i % 2 else part.replace("|", r"\|") for i, part in enumerate(parts)]


def skip_fields(app, what, name, thing, skip, options):
    """Fields of a NamedTuple stand in its signature; about them Python says `Alias for ...`."""
    return skip or type(thing).__name__ == "_tuplegetter"


def refuse_what_is_loaded(app, exception):
    """End the build where a page would load anything from another place than the site itself."""
    for path in Path(app.outdir).rglob("*.*"):
        if path.suffix in (".html", ".css") and (found := LOADED.search(path.read_text())):
            raise SphinxError(f"{path}: loads from elsewhere: {found[0]}")
