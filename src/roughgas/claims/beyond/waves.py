"""The wave form in which the floor of a bed moves."""

import xarray as xr

from roughgas.claims.evidence import NotTestedError, difference
from roughgas.claims.finding import Finding, Statement, agreement, worse

REFERENCE = "sawtooth"


def wave_form_changes_nothing(waves: xr.Dataset) -> Finding:
    """R over a floor that moves in any other wave - R over the sawtooth is as good as zero.

    Waves are compared one by one, since the errors of the sawtooth are common to them.
    """
    others = [str(wave) for wave in waves.wave.values if wave != REFERENCE]
    if not others or REFERENCE not in waves.wave:
        raise NotTestedError(f"the sweep does not hold the wave {REFERENCE} and another")
    sawtooth = waves.sel(wave=REFERENCE)
    found = [
        (wave, agreement(difference(waves.sel(wave=wave), sawtooth), "R over the sawtooth"))
        for wave in others
    ]
    found.sort(key=lambda pair: -abs(pair[1].numbers[0][1].value))
    numbers = [(f"{wave}: {label}", x) for wave, one in found for label, x in one.numbers]
    reason = " ".join(f"{wave}: {one.reason}" for wave, one in found)
    return Finding(worse(*(one.verdict for _, one in found)), reason, tuple(numbers))


STATEMENTS = (
    Statement(
        "wave_form_changes_nothing",
        "changing the wave form does not significantly change R",
        ("waves",),
        wave_form_changes_nothing,
    ),
)
