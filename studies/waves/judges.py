"""Judge of the statement on wave forms."""

import xarray as xr

from roughgas.judging import Finding, NotTestedError, agreement, combined_finding, difference

REFERENCE = "sawtooth"


def wave_form_changes_nothing(waves: xr.Dataset) -> Finding:
    """R over a floor that moves in any other wave - R over the sawtooth is compatible with zero.

    Waves are compared one by one, since the errors of the sawtooth are common to them.
    """
    other_waves = [str(wave) for wave in waves.wave.values if wave != REFERENCE]
    if not other_waves or REFERENCE not in waves.wave:
        raise NotTestedError(f"the sweep does not hold the wave {REFERENCE} and another")
    sawtooth = waves.sel(wave=REFERENCE)
    return combined_finding(
        (wave, agreement(difference(waves.sel(wave=wave), sawtooth), "R over the sawtooth"))
        for wave in other_waves
    )
