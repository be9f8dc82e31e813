"""Free cooling, far down."""

import math

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from compiled import from_python
from raw import build, run_point

from roughgas.config import load
from roughgas.kernel import record
from roughgas.kernel.state import LAST_FIRST, LAST_SECOND
from roughgas.simulation.cooling import SAMPLES_PER_REFRESH
from roughgas.simulation.energies import ratio
from roughgas.simulation.gas import Gas

GAS = settings("gas")  # 160 disks on (100 a)^2, as in Fig. 2b
BLOCKS = 20
LEG_SAMPLES = 100  # samples
rescale, restart = from_python(record.rescale), from_python(record.restart)


def test_a_gas_cools_for_ever(margins):
    """R in two halves of the run, in standard errors from means of twenty blocks.

    With ten blocks per half, one of five runs exceeds 5.5 by chance once in 6000 times.
    """
    restitutions = (0.4, 0.6, 0.8, 0.9, 0.99) if margins.full else (0.4, 0.9)
    samples = margins.size(quick=1500, full=10_000)
    runs = [cooled(r, samples) for r in restitutions]
    tried = {"tried": samples * len(runs), "unit": "collisions per particle"}
    common_share = max(gas_run["lump"] for gas_run in runs)
    margins.at_most("share of the common motion in the energy", common_share, 1e-28, **tried)
    decades_lost = min(gas_run["log10_energy"][0] - gas_run["log10_energy"][-1] for gas_run in runs)
    margins.at_least("orders of magnitude lost by the energy", decades_lost, samples / 50, **tried)
    broken = sum(not np.all(np.isfinite(gas_run["R"])) for gas_run in runs)
    margins.at_most("runs with numbers that are none", broken, 0, len(runs), "runs")
    drift = max(drift_in_errors(gas_run["R"][samples // 10 :]) for gas_run in runs)
    margins.at_most("drift of R, in standard errors", drift, 5.5, **tried)
    margins.keep("cooling_far", **curves(restitutions, runs, samples))


def cooled(r, samples):
    """R, log10 of the energy and the share of common motion of a gas, per collision per particle.

    The run ends once the gas moves as a lump, inside which time hardly goes on.
    """
    gas = Gas(*begin(GAS, r, 0.0, 1))
    gas.cool(SAMPLES_PER_REFRESH * 80)
    legs, common = [], np.zeros(1)
    while LEG_SAMPLES * len(legs) < samples and common.max() < 0.5:
        leg = gas.in_collisions(80, LEG_SAMPLES)
        common = (leg["p_x"] ** 2 + leg["p_y"] ** 2) / 160 / (leg["vv_x"] + leg["vv_y"])
        legs.append(leg | {"common": common})
    rows = {name: np.concatenate([leg[name] for leg in legs]) for name in legs[0]}
    present = gas.energies(rows)
    power = 2.0 * rows["exponent"] * math.log10(2.0)
    return {
        "R": ratio(present),
        "log10_energy": np.log10(present.translational) + power,
        "lump": rows["common"].max(),
    }


def drift_in_errors(R):
    """Difference between the means of R in the two halves, over its standard error."""
    blocks = R[: len(R) // BLOCKS * BLOCKS].reshape(BLOCKS, -1).mean(axis=1)
    first, second = np.split(blocks, 2)
    error = math.hypot(*(half.std(ddof=1) / math.sqrt(half.size) for half in (first, second)))
    return abs(first.mean() - second.mean()) / error


def curves(restitutions, runs, samples):
    """Means over each hundredth of the run, for the picture."""
    count = max(1, samples // 100)
    columns = {"collisions": np.arange(count, samples + 1, count)}
    for r, gas_run in zip(restitutions, runs, strict=True):
        for name in ("R", "log10_energy"):
            columns[f"{name} {r:g}"] = gas_run[name].reshape(-1, count).mean(axis=1)
    return columns


@pytest.mark.slow
def test_rescaling_changes_no_digit(margins):
    """Velocities multiplied by powers of two: the same pairs, at the same positions."""
    powers = (-40, -1, 30) if not margins.full else range(-50, 51, 5)
    collisions = margins.size(quick=200, full=2000)
    plain = rescaled(0, collisions)
    different = sum(rescaled(power, collisions) != plain for power in powers)
    tried = {"tried": len(powers), "unit": f"powers of two, {collisions} collisions each"}
    margins.at_most("runs that differ in any bit", different, 0, **tried)


def rescaled(power, collisions):
    """All pairs that collide, and the final bits in the initial units."""
    scene, state = begin(GAS, 0.8, 0.3, 2)
    run(state, scene, 0)
    rescale(state, scene, power)
    restart(state, scene)
    pairs = []
    for _ in range(collisions):
        run(state, scene, 1, collisions=1)
        pairs.append((state.counts[LAST_FIRST], state.counts[LAST_SECOND]))
    shot = snapshot(state, scene)
    restored = (np.ldexp(values, power) for values in (shot.velocity, shot.spin))
    return pairs, shot.position.tobytes(), *(values.tobytes() for values in restored)


@pytest.mark.slow  # compiles a kernel
def test_a_point_may_cool_below_the_smallest_number(margins):
    """1000 collisions per particle at r = 0.4 take e^380 off the energy; doubles reach e^-745."""
    point = load("config.yaml").experiment("cooling", "small").raw
    point["schedule"] |= {"replicas": 4, "plateau": margins.size(quick=2500, full=10_000)}
    variables = run_point(build(point, 0.4, 0.0), point, 1).variables
    series = variables["R_series"]
    tried = {"tried": 4 * len(series), "unit": "samples"}
    margins.at_most("samples without an R", np.sum(~np.isfinite(series)), 0, **tried)
    margins.at_most("E_trans at the end", variables["E_trans_series"][-1], 0.0, **tried)
    margins.at_most(
        "error of the energy balance, relative", variables["energy_imbalance"], 1e-13, **tried
    )
