"""Numbers that README and docs quote: measured from datasets, kept in docs/numbers.json.

    .venv/bin/python -m tests.quoted results/paper

measures all numbers whose datasets are in that folder, and writes them into docs/numbers.json and
into the pages. A test holds the pages to docs/numbers.json.
"""

import json
import math
import re
from pathlib import Path

from tests.quoted.quotes import QUOTES

ROOT = Path(__file__).parents[2]
SUMMARY = ROOT / "docs" / "numbers.json"
NUMBER = r"([+−]?[\d.]*\d(?:\(\d+\))?|[a-z-]+)"
PLACE = re.compile(r"\{(\w+)(?::([^}]*))?\}")


class Quantity:
    """A number as a page writes it: with a minus sign, and its error in brackets if asked for."""

    def __init__(self, value, error=None):
        self.value, self.error = value, error

    def __format__(self, how):
        if isinstance(self.value, str):
            return self.value
        if how.endswith("()"):
            decimals = -math.floor(math.log10(float(f"{self.error:.0e}")))
            digits = round(self.error * 10**decimals)
            text = f"{self.value:{how[:-2]}.{decimals}f}({digits})"
        else:
            text = f"{self.value:{how}}"
        return text.replace("-", "−")


def summary():
    """Return the numbers of docs/numbers.json by name."""
    known = json.loads(SUMMARY.read_text(encoding="utf-8"))
    return {name: Quantity(**about) for name, about in known.items()}


def names(quote):
    """Return the names of the numbers in a quote."""
    return [name for name, _ in PLACE.findall(quote)]


def quoted():
    """Return the names of all numbers that pages quote."""
    return {name for quotes in QUOTES.values() for quote in quotes for name in names(quote)}


def pattern(quote):
    """Return the pattern of a quote in a page, whatever its numbers and its line breaks are."""
    parts = [re.sub(r"\\?\s+", r"\\s+", re.escape(text)) for text in PLACE.split(quote)[::3]]
    return re.compile(NUMBER.join(parts))


def rewritten(page, quote, numbers):
    """Return the text of a page with the numbers of a quote in it written anew."""
    (found,) = pattern(quote).finditer(page)
    text = page
    for place, (name, how) in reversed(list(enumerate(PLACE.findall(quote), start=1))):
        begin, end = found.span(place)
        text = text[:begin] + format(numbers[name], how) + text[end:]
    return text


def pages():
    """Return all pages with numbers, their quotes written anew, by path."""
    numbers, found = summary(), {}
    for name, quotes in QUOTES.items():
        text = (ROOT / name).read_text(encoding="utf-8")
        for quote in quotes:
            text = rewritten(text, quote, numbers)
        found[ROOT / name] = text
    return found
