"""Sizes of random campaigns: `CAMPAIGN=10 python -m pytest ...` makes ten times as many tries."""

import os


def tries(number):
    """Return the number of tries of a campaign, which makes `number` of them by default."""
    return round(number * float(os.environ.get("CAMPAIGN", 1)))
