"""The page docs/config.md: all keys of config.yaml, with what is legal, made from the schema.

    .venv/bin/python -m tests.config.page

writes it anew.
"""

from pathlib import Path

from roughgas.base.formatting import markdown
from roughgas.config.schema import SAID, _legal, _schema

PAGE = Path(__file__).parents[2] / "docs" / "config.md"
HEAD = ("key", "it must", "meaning")
BEGIN = "<!-- {}: made by tests/config/page.py -->\n"
END = "<!-- until here -->\n"
REMOVED = ("swept",)  # only roughgas writes it


def tables():
    """The tables by name: of the whole file, and of each part of it."""
    parts = _schema()["$defs"]
    found = {"file": _table(_schema())}
    for name in ("experiment", "sweep", "schedule", "showcase"):
        found[name] = _table(parts[name])
    found["studies"] = _table(parts["studies"], depth=4)
    return found


def written(name):
    """A table that is on the page."""
    return PAGE.read_text(encoding="utf-8").split(BEGIN.format(name))[1].split(END)[0]


def _table(schema, depth=1):
    return markdown(HEAD, _rows(schema, "", depth))


def _rows(schema, above, depth):
    """A row for each key of a mapping, and for those of the mappings in it, down to a depth."""
    for key, about in _keys(schema):
        found = _resolved(about)
        yield f"`{above}{key}`", _said(found), found.get("description", "").replace("|", r"\|")
        if depth > 1 and "properties" in found:
            yield from _rows(found, f"{above}{key}.", depth - 1)


def _keys(schema):
    yield from ((key, one) for key, one in schema["properties"].items() if key not in REMOVED)
    yield from ((one["title"], one) for one in schema.get("patternProperties", {}).values())


def _resolved(schema):
    """A definition in place of a reference to it; what stands beside the reference comes first."""
    if "$ref" not in schema:
        return schema
    found = _schema()
    for step in schema["$ref"].removeprefix("#/").split("/"):
        found = found[step]
    return _resolved(found) | {key: one for key, one in schema.items() if key != "$ref"}


def _said(schema):
    return _legal(schema) if any(keyword in schema for keyword in SAID) else ""


def main():
    text = PAGE.read_text(encoding="utf-8")
    for name, table in tables().items():
        text = text.replace(written(name), table)
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
