"""Stochastic drive.

Right after random kicks, a gas has more energy in the driven motion than on average. Here kicks
are as strong as is sensible (with the energy of the gas up to four times per interval), and samples
are taken once per interval, always at the same phase: a drive that kicks all particles at once
would be sampled at its hottest.
"""

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas.simulation.energies import energies, ratio
from roughgas.statistics.errors import blocking_stderr

INTERVALS = 0.125, 0.5, 2.0, 4.0  # in T; in the shortest a particle loses a tenth of its energy
NUMBER, POWER, R, BETA = 160, 1.0, 0.8, 0.0


def measured(interval, share, time):
    """(mean of R, its standard error) of a gas at packing 0.2, sampled once an interval."""
    drive = {"power": POWER, "spin_share": share, "interval": interval}
    scene, state = begin(settings("heated", NUMBER, [50, 50], thermostat=drive), R, BETA, 1)
    run(state, scene, 1, interval=100.0)
    R_series = ratio(
        energies(run(state, scene, int(time / interval), interval=interval), NUMBER, 0.5)
    )
    return R_series.mean(), blocking_stderr(R_series)


@pytest.mark.slow
def test_R_converges_as_kicks_shrink(margins):
    """R of stronger kicks minus R of the weakest, in standard errors of the difference.

    Six comparisons: by chance one exceeds 4 once in 3000 choices of seeds. Strong kicks may change
    R by their physics; so the difference itself is bounded, too.
    """
    time = margins.size(quick=1000, full=4000)
    sigmas, differences = [], []
    for share in (0.0, 0.5):
        values, errors = np.transpose([measured(dt, share, time) for dt in INTERVALS])
        differences += list(np.abs(values[1:] - values[0]))
        sigmas += list(np.abs(values[1:] - values[0]) / np.hypot(errors[1:], errors[0]))
    tried = {"tried": len(sigmas), "unit": f"gases of {NUMBER} disks, {time} T each"}
    quantity = "R of kicks 4 to 32 times as rare, off that of the finest"
    margins.at_most(f"{quantity}, in standard errors", max(sigmas), 4.0, **tried)
    margins.at_most(quantity, max(differences), 0.02, **tried)
