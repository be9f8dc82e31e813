"""Rates of vague names and of phrases that hide the noun: `python -m tests.words [--show]`.

A vague name says nothing of its value (`one`, `found`, `about`): bindings of such names are counted
per 1000 lines of Python. A phrase that hides the noun makes a reader guess it ("return what", "that
of", "the one that"): such phrases are counted per 1000 words of docstrings, comments, pages and
descriptions in YAML. Code in backticks, in blocks and after four spaces does not count.
"""

import argparse
import ast
import io
import json
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
AREAS = {
    "src": ("src",),
    "studies": ("studies",),
    "rules": ("rules", "Snakefile", "workflow"),
    "tests": ("tests",),
    "benchmarks": ("benchmarks",),
    "docs": ("docs",),
    "README.md": ("README.md", "CHANGELOG.md", "CONTRIBUTING.md"),
}
VAGUE_NAMES_PER_1000_LINES = 2.0
HIDDEN_NOUNS_PER_1000_WORDS = 3.0
VAGUE = set(
    "one ones found about own told place part parts those these many given more known made there "
    "here them what whole such each others other around beside wanted asked needed said seen kept "
    "least most right wrong same thing things stuff elem obj".split()
)
HIDDEN_NOUN = re.compile(
    r"\b(?:returns? (?:what|how|whether what)"
    r"|what (?:is|are|has|have|a|an|the|it|they|no|all|takes|differs|was|else|runs|others|people)"
    r"|(?:that|those) (?:of|in|at|with|which|that|who)"
    r"|(?:the )?ones? (?:that|which|of|with|whose)"
    r"|so (?:many|much|often|long|few|far)"
    r"|as (?:many|often|good|much|little|few) as"
    r"|(?:of|in|at|by|from|to|after|with) (?:which|whom)"
    r"|than (?:that|those|what)"
    r"|where (?:it|they|that|there) (?:is|are|has|have)"
    r"|told|(?:is|are) said"
    r"|nothing but|but for|save for|else's|(?:its own|of its own|of their own) of)\b",
    re.IGNORECASE,
)
CODE = re.compile(r"`[^`]*`|\(http[^)]*\)|<!--.*?-->")
DESCRIPTION = re.compile(
    r"#\s(.*)|^\s*(?:description|title|about|reason|caption):\s*(.*)", re.MULTILINE
)
DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
BINDING_IN_RULES = re.compile(r"^\s*(?:def |for )?(\w+)(?=\s*=[^=]|\(| in )", re.MULTILINE)
SUFFIXES = {".py", ".smk", ".md", ".rst", ".ipynb", ".yaml", ".yml"}


class Hit(NamedTuple):
    """A vague name or a phrase, and its location."""

    path: Path
    line: int
    text: str


def main() -> None:
    """Print both rates of every area; exit with status 1 if a rate is above its limit."""
    parser = argparse.ArgumentParser(description="rates of vague names and hidden nouns")
    parser.add_argument("--show", action="store_true", help="print every name and phrase")
    show, failed = parser.parse_args().show, False
    for area, roots in AREAS.items():
        files = [file for root in roots for file in _files(ROOT / root)]
        names, lines = vague_names(files)
        phrases, words = hidden_nouns(files)
        rates = (1000 * len(names) / max(lines, 1), 1000 * len(phrases) / max(words, 1))
        print(f"{area:10} {rates[0]:5.1f} names/1000 lines {rates[1]:5.1f} phrases/1000 words")
        above = rates[0] > VAGUE_NAMES_PER_1000_LINES, rates[1] > HIDDEN_NOUNS_PER_1000_WORDS
        failed |= any(above)
        for hits, is_above in zip((names, phrases), above, strict=True):
            for hit in hits if show else hits[: 10 * is_above]:
                print(f"  {hit.path.relative_to(ROOT)}:{hit.line}: {hit.text}")
    if failed:
        limits = f"{VAGUE_NAMES_PER_1000_LINES:g} names, {HIDDEN_NOUNS_PER_1000_WORDS:g} phrases"
        raise SystemExit(f"above the limits of {limits}; all of them: python -m tests.words --show")


def _files(root: Path) -> Iterator[Path]:
    candidates = [root] if root.is_file() else sorted(root.rglob("*"))
    for path in candidates:
        if path.suffix in SUFFIXES or path.name == "Snakefile":
            if "_build" not in path.parts and path.is_file():
                yield path


def vague_names(files: list[Path]) -> tuple[list[Hit], int]:
    """Return the bindings of vague names in Python and Snakemake files, and the lines of these."""
    hits, lines = [], 0
    for path in files:
        if path.suffix not in (".py", ".smk", ""):
            continue
        source = path.read_text(encoding="utf-8")
        lines += source.count("\n")
        bindings = _bindings(source) if path.suffix == ".py" else _bindings_in_rules(source)
        hits += [Hit(path, n, name) for n, name in bindings if name.strip("_").lower() in VAGUE]
    return hits, lines


def _bindings(source: str) -> Iterator[tuple[int, str]]:
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.attr
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.lineno, node.name


def _bindings_in_rules(source: str) -> Iterator[tuple[int, str]]:
    for match in BINDING_IN_RULES.finditer(source):
        yield source.count("\n", 0, match.start(1)) + 1, match[1]


def hidden_nouns(files: list[Path]) -> tuple[list[Hit], int]:
    """Return the phrases that hide the noun in the texts of files, and the words of these."""
    hits, words = [], 0
    for path in files:
        for line, text in _texts(path):
            prose = CODE.sub("", text)
            words += len(prose.split())
            hits += [
                Hit(path, line, prose[max(0, phrase.start() - 30) : phrase.end() + 30])
                for phrase in HIDDEN_NOUN.finditer(prose)
            ]
    return hits, words


def _texts(path: Path) -> Iterator[tuple[int, str]]:
    """Yield (line, text) for the texts in a file."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".ipynb":
        cells = json.loads(source)["cells"]
        return ((1, "".join(c["source"])) for c in cells if c["cell_type"] == "markdown")
    if path.suffix in (".yaml", ".yml"):
        return _matches(DESCRIPTION, source)
    if path.suffix in (".md", ".rst"):
        return _lines_of_prose(source)
    if path.suffix != ".py":
        return _matches(re.compile(r'"""(.*?)"""|#\s(.*)', re.DOTALL), source)
    return _texts_of_python(source)


def _matches(pattern: re.Pattern, source: str) -> Iterator[tuple[int, str]]:
    for match in pattern.finditer(source):
        yield source.count("\n", 0, match.start()) + 1, match[1] or match[2] or ""


def _lines_of_prose(source: str) -> Iterator[tuple[int, str]]:
    in_code = False
    for number, line in enumerate(source.splitlines(), 1):
        in_code ^= line.lstrip().startswith("```")
        if not in_code and not line.startswith("    "):
            yield number, line


def _texts_of_python(source: str) -> Iterator[tuple[int, str]]:
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, DOCUMENTED) and (docstring := ast.get_docstring(node)):
            yield node.body[0].lineno, docstring
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string


if __name__ == "__main__":
    main()
