"""Record outputs of the program in a folder, or compare them with an earlier record."""

import argparse
import difflib
import json
import sys
import tempfile
import time
from pathlib import Path

from tests.net.recorders import RECORDERS

PLACEHOLDER = "FOLDER"
"""Replaces the path of the temporary folder in texts."""


def main(arguments=None):
    """Run the command line; return 1 if there are differences."""
    parser = argparse.ArgumentParser(prog="python -m tests.net", description=__doc__)
    parser.add_argument("action", choices=("record", "compare"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", choices=RECORDERS, action="append", help="this part, or these")
    options = parser.parse_args(arguments)
    names = options.only or list(RECORDERS)
    if options.action == "record":
        record(options.folder, names)
        return 0
    if missing := [name for name in names if not file_of(options.folder, name).exists()]:
        parser.error(f"{options.folder} has no record of {', '.join(missing)}")
    with tempfile.TemporaryDirectory() as new_folder:
        record(Path(new_folder), names)
        counts = [compare(name, options.folder, Path(new_folder)) for name in names]
    return int(any(counts))


def record(folder, names):
    """Write the texts of each recorder in `names` into a folder, as a JSON file."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        start = time.perf_counter()
        with tempfile.TemporaryDirectory() as work_folder:
            new_texts = RECORDERS[name](Path(work_folder).resolve())
            texts = {
                item: text.replace(work_folder, PLACEHOLDER)
                for item, text in sorted(new_texts.items())
            }
        file_of(folder, name).write_text(json.dumps(texts, indent=0) + "\n", encoding="utf-8")
        seconds = time.perf_counter() - start
        print(f"{name}: {len(texts)} items in {seconds:.0f} s", file=sys.stderr, flush=True)


def file_of(folder, name):
    """Return the file of a recorder in a folder of records."""
    return folder / f"{name}.json"


def compare(name, before, after):
    """Print the differences of a recorder's texts in two folders; return the number of items that
    differ.

    A difference common to several items is printed once.
    """
    old, new = (json.loads(file_of(f, name).read_text("utf-8")) for f in (before, after))
    differences = {}
    for item in sorted(old.keys() | new.keys()):
        if lines := difference_lines(old.get(item), new.get(item)):
            differences.setdefault(changed_lines(lines), []).append((item, lines))
    for (first, lines), *further_items in differences.values():
        print(f"{name}: {first}", *lines, sep="\n")
        if further_items:
            print(
                f"the same in {len(further_items)} more:",
                *(f"  {item}" for item, _ in further_items),
                sep="\n",
            )
    count = sum(map(len, differences.values()))
    print(f"{name}: {count} of {len(old.keys() | new.keys())} items differ")
    return count


def changed_lines(lines):
    """Return the lines of a difference that begin with + or -, below its head."""
    return tuple(line for line in lines[2:] if line[0] in "+-")


def difference_lines(old, new):
    """Return the lines of a unified difference of two texts; None is an absent text."""
    if old == new:
        return []
    texts = [readable(text) for text in (old, new)]
    if texts[0] == texts[1]:  # they differ in how the JSON is written
        texts = [old, new]
    lines = [[] if text is None else text.splitlines() for text in texts]
    names = [
        "(absent)" if text is None else side for text, side in zip(texts, SIDE_NAMES, strict=True)
    ]
    unified = list(difflib.unified_diff(*lines, *names, lineterm=""))
    return unified or [f"--- {names[0]}", f"+++ {names[1]}", f"-{old!r}", f"+{new!r}"]


SIDE_NAMES = ("before", "now")


def readable(text):
    """Return JSON, and JSON in its strings, spread over lines; other texts unchanged."""
    try:
        return json.dumps(with_opened_json(json.loads(text)), indent=1)
    except (TypeError, ValueError):
        return text


def with_opened_json(value):
    """Return a JSON value with strings that are JSON mappings replaced by their values."""
    if isinstance(value, dict):
        return {key: with_opened_json(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [with_opened_json(inner) for inner in value]
    if isinstance(value, str) and value.startswith("{"):
        try:
            return {"JSON": with_opened_json(json.loads(value))}
        except ValueError:
            return value
    return value
