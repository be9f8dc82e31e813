"""Stochastic drive.

A gas whose particles are kicked at random holds, right after the kicks, more energy in what they
drive than it does on average. Here kicks are as strong as they may sensibly be (the energy of one
interval is up to four times that of the gas), and samples are taken once an interval, always at the
same phase of it: a drive that kicks all particles at once is then seen at its hottest.
"""

import numpy as np
from brute_force import begin, run, settings

from roughgas.simulation.energies import energies, ratio
from roughgas.statistics.errors import blocking_stderr

INTERVALS = 0.125, 0.5, 2.0, 4.0  # in T; in the finest a particle loses a tenth of its energy
NUMBER, POWER, R, BETA = 160, 1.0, 0.8, 0.0


def measured(interval, share, time):
    """(mean of R, its standard error) of a gas at packing 0.2, sampled once an interval."""
    drive = {"power": POWER, "spin_share": share, "interval": interval}
    scene, state = begin(settings("heated", NUMBER, [50, 50], thermostat=drive), R, BETA, 1)
    run(state, scene, 1, interval=100.0)
    found = ratio(energies(run(state, scene, int(time / interval), interval=interval), NUMBER, 0.5))
    return found.mean(), blocking_stderr(found)


def test_R_converges_as_kicks_shrink(margins):
    """R of coarser kicks minus that of the finest, in standard errors of the difference.

    Six comparisons: one of them beyond 4 by chance once in 3000 choices of seeds. What is large is
    large by the physics of strong kicks; so the difference itself is bounded, too.
    """
    time = margins.size(quick=1000, full=4000)
    sigmas, differences = [], []
    for share in (0.0, 0.5):
        values, errors = np.transpose([measured(dt, share, time) for dt in INTERVALS])
        differences += list(np.abs(values[1:] - values[0]))
        sigmas += list(np.abs(values[1:] - values[0]) / np.hypot(errors[1:], errors[0]))
    tried = {"tried": len(sigmas), "unit": f"gases of {NUMBER} disks, {time} T each"}
    what = "R of kicks 4 to 32 times as rare, off that of the finest"
    margins.at_most(f"{what}, in standard errors", max(sigmas), 4.0, **tried)
    margins.at_most(what, max(differences), 0.02, **tried)
