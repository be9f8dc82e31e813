"""What a check of the installation has found."""

from typing import NamedTuple

OK, WARNING, PROBLEM = "ok", "warning", "problem"


class Finding(NamedTuple):
    """A verdict (OK, WARNING or PROBLEM), what was seen, and what to do about it."""

    verdict: str
    said: str
    remedy: str = ""
