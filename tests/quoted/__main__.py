"""Writes docs/numbers.json from datasets, then the numbers in the pages."""

import json
import sys
from pathlib import Path

from tests.quoted import SUMMARY, pages, quoted
from tests.quoted.measured import measured


def main(folder):
    known = json.loads(SUMMARY.read_text(encoding="utf-8")) if SUMMARY.exists() else {}
    found = {name: about for name, about in measured(Path(folder)).items() if name in quoted()}
    found = known | found
    SUMMARY.write_text(
        json.dumps(dict(sorted(found.items())), indent=1, ensure_ascii=False) + "\n",
        encoding="utf-8",
    )
    for path, text in pages().items():
        path.write_text(text, encoding="utf-8")


main(*sys.argv[1:])
