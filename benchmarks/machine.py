"""The machine that was measured, and what was measured on it."""

import datetime
import subprocess
from pathlib import Path

from roughgas.base import machine


def description() -> dict[str, str]:
    """What to know about the machine, by name, with the commit and the date."""
    return machine.description() | {
        "commit": _commit(),
        "date": datetime.date.today().isoformat(),
    }


def _commit():
    """The commit that is checked out, and whether more has changed since."""
    command = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty"]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout.strip()
