"""How the site is built from these pages, the tutorial, and the docstrings: `make docs`.

It can be read without a network: nothing in it is loaded from elsewhere.
"""

import logging
import os.path
import re
import shutil
from functools import cache
from pathlib import Path

from docutils.nodes import SkipNode
from jupyter_client.manager import KernelManager
from latex2mathml.converter import convert
from sphinx.errors import SphinxError
from tests import notebook

import roughgas
from roughgas import steps
from roughgas.claims.numbers import filled
from roughgas.claims.pages import numbers_of_pages
from roughgas.results.comparison import read_rows
from roughgas.results.evidence_page import as_markdown

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
EVIDENCE = "<!-- evidence: figures/evidence.csv -->"
MOVIES = "<!-- movies: figures/movies/*.gif -->"
PAGES = DOCS / "_build" / "pages"
EXPLORE = [
    ROOT / "results" / scale / "explore.html" for scale in ("paper", "lean", "quick", "small")
]
EXPLORE_LINK = re.compile(r'<a href="explore\.html">(.*?)</a>', re.DOTALL)
INDEX, README = DOCS / "index.md", ROOT / "README.md"
LINK = re.compile(r"\[([^\]]*)\]\(([^)#\s]+)(#[^)\s]*)?\)")
LOADED = re.compile(
    r"""<(?:script|img|iframe|source)\b[^>]*\bsrc=["']?(?:https?:)?//"""
    r"""|<link\b[^>]*\bhref=["']?(?:https?:)?//|url\(["']?(?:https?:)?//|@import"""
)

HIDDEN_COLON = "\N{RATIO}"

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
        r"(numpy|xarray|pathlib|collections|contextlib|msgspec|netCDF4|types)\..*",
    ),  # whose pages are not here
    (
        "py:class",
        r"roughgas\.(base\.fields|kernel|effects|scene|simulation|observables\.plugin\.Combine).*",
    ),  # no library, but its core
    (
        "py:class",
        "Experiment|Observe|Functions|Changes|FlowTracker|ObservableTracker",
    ),  # types of arguments, imported for the checker alone
]

html_theme = "furo"
PAGES.mkdir(parents=True, exist_ok=True)  # Sphinx checks that it exists
html_extra_path = ["_build/pages", *map(str, ROOT.glob("figures/*.html"))]
html_title = f"roughgas {version}"
html_show_sourcelink = html_show_sphinx = html_copy_source = False

myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]
html_math_renderer = "mathml"
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300  # s a cell: a kernel may have to be compiled
nb_output_stderr = "remove"
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
    app.connect("builder-inited", make_pages)
    app.connect("source-read", mend_links)
    app.connect("source-read", fill_numbers)
    app.add_html_math_renderer("mathml", (inline_formula, None), (formula, None))
    app.connect("env-get-outdated", lambda *_: ["tutorial"])  # it runs at each build
    app.connect("autodoc-process-docstring", hide_colons, priority=100)  # before Napoleon
    app.connect("autodoc-process-docstring", as_prose)
    app.connect("autodoc-skip-member", skip_fields)
    app.connect("build-finished", refuse_what_is_loaded)
    app.connect("build-finished", refuse_old_outputs)


def write_studies(app):
    """A page for each study that is there, made of its README.md."""
    pages = DOCS / "studies"
    shutil.rmtree(pages, ignore_errors=True)
    pages.mkdir()
    for readme in sorted(ROOT.glob("studies/*/README.md")):
        text = linked(readme.read_text(encoding="utf-8"), readme.parent, pages)
        (pages / f"{readme.parent.name}.md").write_text(text, encoding="utf-8")


def make_pages(app):
    """Make the living page, and take the page of every point from the largest scale that has it."""
    shutil.rmtree(PAGES, ignore_errors=True)
    PAGES.mkdir(parents=True)
    living = ["living", "--config", str(ROOT / "config.yaml"), "-o", str(PAGES / "living.html")]
    if steps.main(living):
        raise SphinxError("living.html: not made")
    explore_pages = [path for path in EXPLORE if path.exists()]
    if explore_pages:
        shutil.copy(explore_pages[0], PAGES)


def show_what_is_made(text):
    """Return a page with the movies of figures/movies, and without links to a page not made."""
    movies = sorted(ROOT.glob("figures/movies/*.gif"))
    images = [f"![{path.stem}](../figures/movies/{path.name})" for path in movies]
    text = text.replace(MOVIES, "\n\n".join(images))
    return text if (PAGES / "explore.html").exists() else EXPLORE_LINK.sub(r"\1", text)


def mend_links(app, docname, source):
    """Links in pages, which are right where the repository is read, become right here.

    The first page is README.md.
    """
    folder = (DOCS / docname).parent
    source[0] = show_what_is_made(source[0])
    source[0] = linked(source[0], folder, folder)
    if docname == "index":
        source[0] = f"{linked(README.read_text(encoding='utf-8'), ROOT, DOCS)}\n{source[0]}"


@cache
def numbers():
    """The numbers of all pages, by mark."""
    return numbers_of_pages(ROOT)


def fill_numbers(app, docname, source):
    """Fill the numbers and rows of the last results into a page."""
    source[0] = filled(source[0], numbers())
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
    """Return `text` with its links relative to `folder` instead of `base`.

    A link to README.md becomes a link to the first page, or to the page of its study, a link to
    HTML an address; a link to a folder, or to a file outside the site, becomes plain text.
    """

    def link_in_folder(link):
        label, path, anchor = link.groups("")
        target = Path(os.path.normpath(base / path))
        if not target.exists():  # an address, or a missing file, which Sphinx reports
            return link[0]
        if target.name == README.name and target.parent.parent == ROOT / "studies":
            target = DOCS / "studies" / f"{target.parent.name}.md"
        if target.is_dir() or (target.suffix == ".md" and not target.is_relative_to(DOCS)):
            return label if target != README else f"[{label}]({os.path.relpath(INDEX, folder)})"
        if target.suffix == ".html":
            return f'<a href="{os.path.relpath(DOCS / target.name, folder)}">{label}</a>'
        return f"[{label}]({os.path.relpath(target, folder)}{anchor})"

    return LINK.sub(link_in_folder, text)


def hide_colons(app, object_type, name, documented, options, lines):
    """Hide colons from Napoleon, which takes the text before one for an attribute's type."""
    if object_type in ("attribute", "data", "property"):
        lines[:] = [line.replace(":", HIDDEN_COLON) for line in lines]


def as_prose(app, object_type, name, documented, options, lines):
    """Treat docstrings as prose without markup: bars mean |v|, indented lines are formulae."""
    markup = ["", ""]
    for line in (line.replace(HIDDEN_COLON, ":") for line in lines):
        after_prose = markup[-2][:1].isalpha() and not markup[-1]
        if line.startswith("    ") and after_prose:
            markup += ["::", ""]
        markup.append("`".join(_escaped(line.split("`"))) if line[:1] != " " else line)
    lines[:] = markup[2:]


def _escaped(pieces):
    """Escape bars in the pieces of a line between backquotes, of which every other is code."""
    return [piece if i % 2 else piece.replace("|", r"\|") for i, piece in enumerate(pieces)]


def skip_fields(app, object_type, name, documented, skip, options):
    """Skip fields of a NamedTuple: they stand in its signature, and Python documents no more."""
    return skip or type(documented).__name__ == "_tuplegetter"


def refuse_what_is_loaded(app, exception):
    """End the build where a page would load anything from another place than the site itself."""
    for path in Path(app.outdir).rglob("*.*"):
        if path.suffix in (".html", ".css") and (reference := LOADED.search(path.read_text())):
            raise SphinxError(f"{path}: loads from elsewhere: {reference[0]}")


def refuse_old_outputs(app, exception):
    """End the build where the tutorial, as it ran, printed other texts than its file has."""
    executed = Path(app.outdir).parent / "jupyter_execute" / "tutorial.ipynb"
    if exception is None and notebook.texts(notebook.read(executed)) != notebook.texts(
        notebook.read()
    ):
        raise SphinxError("docs/tutorial.ipynb: its outputs are old: python -m tests.notebook")
