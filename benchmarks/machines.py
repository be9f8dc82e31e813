"""One page and one summary for each processor that was measured, and the table of all of them."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.kernel import Timing
from benchmarks.tables import short, table
from benchmarks.yardstick import REFERENCE, Rate
from roughgas.base.files import write_text

ALL = """
# Benchmarks

How many times as many collisions a second the kernel makes as the plain loop
(`benchmarks/yardstick.py`: all pairs, compiled, {reference} particles) beside which it was timed
on the same processor. Such multiples survive a change of machine better than rates do. `make bench`
measures both, and writes the page of the processor that it runs on, and this one.

{multiples}

{pages}

```{{toctree}}
:hidden:
:glob:

benchmarks/*
```
""".lstrip()


def name_of(machine: Mapping[str, str]) -> str:
    """Return the name of a machine's page: its processor and its instruction set."""
    words = f"{machine.get('processor', 'unknown')} {machine['instruction set']}".lower()
    return re.sub(r"[^a-z0-9]+", "-", words).strip("-")


def plain_rate(yardstick: Sequence[Rate]) -> float:
    """Return the plain loop's collisions per second with REFERENCE particles; NaN if unknown."""
    return next((one.median for one in yardstick if one.number == REFERENCE), float("nan"))


def summary(
    machine: Mapping[str, str], timings: Sequence[Timing], yardstick: Sequence[Rate]
) -> dict[str, Any]:
    """Return what the table of all machines needs of one: multiples by scene and number."""
    plain, multiples = plain_rate(yardstick), {}
    for one in timings:
        multiples.setdefault(one.case.title, {})[str(one.number)] = round(one.rate / plain, 1)
    return {"machine": dict(machine), "plain": round(plain), "multiples": multiples}


def write(folder: Path, name: str, page: str, found: Mapping[str, Any]) -> None:
    """Write the page and the summary of one machine, and the table of all of them."""
    here = folder / "benchmarks"
    write_text(here / f"{name}.json", json.dumps(found, indent=2) + "\n")
    write_text(here / f"{name}.md", page)
    all_found = {path.stem: json.loads(path.read_text()) for path in sorted(here.glob("*.json"))}
    write_text(folder / "benchmarks.md", overview(all_found))


def overview(found: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the table of all machines, which are given as summaries by their names."""
    heads = ["scene", "N", *(_title(one["machine"]) for one in found.values())]
    rows: dict[tuple[str, str], dict[str, str]] = {}
    for name, one in found.items():
        for scene, by_number in one["multiples"].items():
            for number, multiple in by_number.items():
                rows.setdefault((scene, number), {})[name] = f"{multiple:.1f}"
    cells = [
        [scene, f"{int(number):,}", *(known.get(name, "") for name in found)]
        for (scene, number), known in rows.items()
    ]
    pages = [
        f"- [{_title(one['machine'])}](benchmarks/{name}.md): {short(one['plain'])} collisions/s "
        f"by the plain loop; commit {one['machine']['commit']}, {one['machine']['date']}"
        for name, one in found.items()
    ]
    multiples = table(heads, cells)
    return ALL.format(reference=REFERENCE, multiples=multiples, pages="\n".join(pages))


def _title(machine):
    return f"{machine.get('processor', 'unknown')} ({machine['instruction set']})"
