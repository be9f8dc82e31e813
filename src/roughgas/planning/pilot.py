"""A pilot run: what must be known of a point before its cost and its error can be foreseen."""

import json
from pathlib import Path
from typing import NamedTuple

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.config.labels import LARGEST_SEED

SEED = LARGEST_SEED  # of pilots: none that a point would take


class Pilot(NamedTuple):
    """What a pilot has measured, per run; lengths are in the unit of the schedule's kind."""

    transient: float  # length until the energies are steady (cooling gas: R, by theory alone)
    autocorrelation_time: float  # of R, as a length
    variance: float  # of the mean of R over a length of one: error^2 is this over the length
    dof: float  # degrees of freedom of `variance`
    pace: float  # collisions per particle in a length of one
    seconds_per_length: float  # CPU time of the kernel
    settled: bool  # whether a steady state was found
    length: float  # that was simulated, in all chains
    seconds: float  # CPU time of the kernel that the pilot took


def write_pilot(path: str | Path, pilot: Pilot) -> None:
    """Write a pilot as JSON, whole or not at all."""
    write_text(path, json.dumps(pilot._asdict(), indent=1) + "\n")


def read_pilot(path: str | Path) -> Pilot:
    """Return the pilot at `path`. Raises InputError if it is none."""
    content = Path(path).read_bytes()
    try:
        return Pilot(**json.loads(content))
    except (TypeError, ValueError) as error:
        raise InputError("pilot", str(path), "be a file of `roughgas pilot`") from error
