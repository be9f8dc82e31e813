"""Write the table of all margins and their pictures.

    python -m hard_cases.report FAMILY.json... --table TABLE.md --pictures FILE.pdf FILE.png...

The name of a file selects its picture: hard_cases shows all margins, hard_cases_x is the picture x
(pictures.py).
"""

import argparse
import itertools
import json
from pathlib import Path

from hard_cases import pictures
from hard_cases.catalogue import Margin, Remedy
from roughgas.base import markdown
from roughgas.base.files import write_text
from roughgas.show.style import save

HEAD = """# Hard cases

Where a simulation could go wrong, and how far this one stays from that. Written by
`snakemake hard_cases`{scale}; docs/trust.md explains the cases.

{cases} cases, {margins} margins, all within their limits. {remedies} of the cases fail
without the safeguard of the source that the table names. Room: how many times worse a number
could be.
"""


def main() -> None:
    arguments = _arguments()
    families = [json.loads(path.read_text(encoding="utf-8")) for path in arguments.families]
    margins = [Margin(**row) for family in families for row in family["margins"]]
    remedies = [Remedy(**row) for family in families for row in family["remedies"]]
    series = {name: columns for family in families for name, columns in family["series"].items()}
    write_text(arguments.table, table(margins, remedies, arguments.full))
    for name, files in itertools.groupby(sorted(arguments.pictures), key=lambda path: path.stem):
        picture = name.removeprefix("hard_cases").removeprefix("_")
        figure = pictures.PICTURES[picture](series) if picture else pictures.overview(margins)
        save(figure, files)


def table(margins: list[Margin], remedies: list[Remedy], full: bool) -> str:
    """Return the table as Markdown, with a section per family and a paragraph per case."""
    cases = {(row.family, row.case) for row in margins}
    sections = [
        HEAD.format(
            scale="" if full else " at a smaller scale, with few tries",
            cases=len(cases),
            margins=len(margins),
            remedies=len({(remedy.family, remedy.case) for remedy in remedies}),
        )
    ]
    for family, of_family in itertools.groupby(margins, key=lambda row: row.family):
        sections.append(f"\n## {family}\n")
        for (case, danger), rows in itertools.groupby(of_family, key=lambda r: (r.case, r.danger)):
            taken = [
                remedy.remedy
                for remedy in remedies
                if (remedy.family, remedy.case) == (family, case)
            ]
            sections.append(_case(case, danger, list(rows), taken))
    return "".join(sections)


def _case(case, danger, rows, taken):
    cells = [
        (
            row.what,
            f"{row.measured:.3g}",
            f"{row.sense} {row.limit:g}",
            f"{pictures.room(row):.3g}".replace("inf", "no error"),
            f"{number(row.tried)} {row.unit}",
        )
        for row in rows
    ]
    lines = markdown(("measured", "value", "limit", "room", "tried"), cells, "<>>>>")
    remedies = "".join(f"\nFails without: {remedy}.\n" for remedy in taken)
    return f"\n**{case}.** What could go wrong: {danger}.\n\n{lines}{remedies}"


def number(tried: int) -> str:
    """Return a count with separated thousands, or with a power of ten from a million on."""
    if tried >= 10**6:
        mantissa, _, power = f"{tried:.1e}".partition("e")
        return f"{mantissa.removesuffix('.0')}e{int(power)}"
    return f"{tried:,}".replace(",", " ")


def _arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("families", nargs="+", type=Path)
    parser.add_argument("--table", type=Path, required=True)
    parser.add_argument("--pictures", nargs="+", type=Path, default=[])
    parser.add_argument("--full", action="store_true", help="cases were tried as often as it takes")
    return parser.parse_args()


if __name__ == "__main__":
    main()
