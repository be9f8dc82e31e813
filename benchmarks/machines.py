"""Pages and summaries of measurements by processor, and the table of all processors."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.kernel import Timing
from benchmarks.tables import short, table
from benchmarks.yardstick import REFERENCE, Rate
from roughgas.base.files import write_text

PAGE_TEMPLATE = """
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
    return next((rate.median for rate in yardstick if rate.number == REFERENCE), float("nan"))


def summary(
    machine: Mapping[str, str], timings: Sequence[Timing], yardstick: Sequence[Rate]
) -> dict[str, Any]:
    """Return the summary of a machine: its description, the rate of the plain loop, and multiples
    of it by the kernel, by scene and number of particles."""
    plain, multiples = plain_rate(yardstick), {}
    for timing in timings:
        multiples.setdefault(timing.case.title, {})[str(timing.number)] = round(
            timing.rate / plain, 1
        )
    return {"machine": dict(machine), "plain": round(plain), "multiples": multiples}


def write(folder: Path, name: str, page: str, machine_summary: Mapping[str, Any]) -> None:
    """Write the page and the summary of a machine, and the table of all machines."""
    pages_folder = folder / "benchmarks"
    write_text(pages_folder / f"{name}.json", json.dumps(machine_summary, indent=2) + "\n")
    write_text(pages_folder / f"{name}.md", page)
    summaries = {
        path.stem: json.loads(path.read_text()) for path in sorted(pages_folder.glob("*.json"))
    }
    write_text(folder / "benchmarks.md", overview(summaries))


def overview(summaries: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the page with the table of all machines, from their summaries by name."""
    head = ["scene", "N", *(_title(record["machine"]) for record in summaries.values())]
    rows: dict[tuple[str, str], dict[str, str]] = {}
    for name, record in summaries.items():
        for scene, by_number in record["multiples"].items():
            for number, multiple in by_number.items():
                rows.setdefault((scene, number), {})[name] = f"{multiple:.1f}"
    cells = [
        [scene, f"{int(number):,}", *(by_machine.get(name, "") for name in summaries)]
        for (scene, number), by_machine in rows.items()
    ]
    pages = [
        f"- [{_title(record['machine'])}](benchmarks/{name}.md): {short(record['plain'])}"
        f" collisions/s by the plain loop; "
        f"commit {record['machine']['commit']}, {record['machine']['date']}"
        for name, record in summaries.items()
    ]
    multiples = table(head, cells)
    return PAGE_TEMPLATE.format(reference=REFERENCE, multiples=multiples, pages="\n".join(pages))


def _title(machine):
    return f"{machine.get('processor', 'unknown')} ({machine['instruction set']})"
