"""Measures the numbers that pages quote, from reduced datasets."""

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.claims import evidence
from roughgas.claims.averages import averaged
from roughgas.statistics.errors import Estimate


def measured(folder):
    """Return the numbers that the datasets in a folder give, by name."""
    found = {}
    for experiments, measure in MEASURES.items():
        paths = [folder / f"{name}.nc" for name in experiments]
        if all(path.exists() for path in paths):
            found |= measure(*paths)
    return {name: about(value) for name, value in found.items() if known(value)}


def known(number):
    return isinstance(number, str | Estimate) or np.isfinite(float(number))


def about(number):
    """Return a number as docs/numbers.json has it."""
    if isinstance(number, Estimate):
        return {"value": short(number.value), "error": short(number.stderr)}
    return {"value": number if isinstance(number, str) else short(number)}


def short(number):
    return float(f"{float(number):.5g}")


def over_collisions(path):
    """Return a dataset beside theory, its R averaged over collisions; NaN if it has none."""
    data = evidence.load(path)
    if "R_collisional" in data:
        return averaged(data, "R_collisional")
    return data.assign(R=np.nan * data.R)


def off_over_collisions(*paths):
    """Return how far R averaged over collisions is off theory at most; NaN if nothing is known."""
    gaps = (data.R - data.theory for data in map(over_collisions, paths))
    return max(float(np.abs(gap).max()) for gap in gaps)


def size(sample):
    """Return the largest size in a sample."""
    return np.abs(sample.value).max()


def spheres(cooled, sheared):
    cooled, sheared = (evidence.deviation(evidence.load(path)) for path in (cooled, sheared))
    return {
        "cooling_spheres_off": size(cooled),
        "cooling_spheres_points": cooled.size,
        "sheared_spheres_off": size(sheared),
    }


def bed_of_spheres(path):
    gap = evidence.deviation(evidence.load(path))
    return {
        "vibrated_spheres_most_above": gap.at(int(np.argmax(gap.value))),
        "vibrated_spheres_collisional_off": off_over_collisions(path),
    }


def friction(bed, cooled):
    bed, cooled = evidence.load(bed), evidence.load(cooled)
    bed = bed.sel(mu=bed.mu > 0)
    strong = cooled.sel(mu=cooled.mu > float(theory.critical_friction(cooled.r.values.min())))
    return {
        "vibrated_friction_off": size(evidence.deviation(bed)),
        "vibrated_friction_least": bed.R.min(),
        "vibrated_friction_least_mu": bed.mu.min(),
        "cooling_friction_off": size(evidence.deviation(strong)),
        "cooling_friction_strong_mu": strong.mu.min(),
    }


def runaway(path):
    """Escape times of homogeneous gases, to two digits, as few runs give them."""
    at = xr.load_dataset(path, group="runaway").sel(mu=0.2, method="nearest")
    times = {n: float(at.dsmc_time.sel(dsmc_particles=n)) for n in (100, 10000)}
    found = {f"runaway_time_{n}": float(f"{time:.2g}") for n, time in times.items()}
    share = float(at.dsmc_largest_share.sel(dsmc_particles=100))
    return found | {"runaway_share_percent": 100 * share}


def drives(heated, *boundaries):
    names = ("rough_floor_off", "rough_side_walls_off", "shaken_walls_off")
    at_shares = [evidence.deviation_at_shares(evidence.load(path)) for path in boundaries]
    found = {"heated_off": size(evidence.deviation(evidence.load(heated)))}
    found |= {name: size(gap) for name, gap in zip(names, at_shares, strict=True)}
    collisional = [over_collisions(path) for path in boundaries]
    if all(np.isfinite(data.R).any() for data in collisional):
        off = [size(evidence.deviation_at_shares(data)) for data in collisional]
        found["drives_collisional_off"] = max(off_over_collisions(heated), *off)
    return found


def materials(floor, walls):
    shifts, most, least = [], [], []
    for path in (floor, walls):
        data = evidence.load(path)
        shares = evidence.spin_shares(data)
        still = data.where((data.roughness > -1) & (np.abs(shares) < 0.003))
        smooth = data.sel(roughness=-1.0, drop=True)
        shifts.append(size(evidence.difference(still, smooth)))
        most.append(float(shares.max()))
        least.append(float(shares.min()))
    return {
        "boundaries_shift_without_rotation": max(shifts),
        "boundaries_most_share_percent": 100 * max(most),
        "boundaries_most_taken_percent": -100 * min(least),
    }


def waves(path):
    data, collisional = evidence.load(path), over_collisions(path)
    found, forms = {}, ("triangle", "sine", "reversed_sawtooth")
    for r in data.r.values:
        at = data.sel(r=[r])
        shifts = {
            wave: evidence.difference(at.sel(wave=wave), at.sel(wave="sawtooth")) for wave in forms
        }
        where = f"_at_r{r:g}".replace(".", "")
        found |= {f"wave_{wave}{where}": shift.largest()[0] for wave, shift in shifts.items()}
    between = collisional.R - collisional.R.sel(wave="sawtooth")
    return found | {"waves_collisional_off": np.abs(between).max()}


def inertia(bed, cooled):
    bed, cooled = evidence.load(bed), evidence.load(cooled)
    between = bed.sel(inertia=(bed.inertia >= 0.05) & (bed.inertia <= 0.3))
    rings = evidence.deviation(bed.sel(inertia=[1.0]))
    light = bed.sel(inertia=bed.inertia <= 0.02, beta=1.0)
    return {
        "cooling_inertia_off": size(evidence.deviation(cooled)),
        "vibrated_inertia_off": size(evidence.deviation(between)),
        "vibrated_rings_above": rings.at(int(np.argmax(rings.value))),
        "vibrated_light_rough": light.R.max(),
    }


MEASURES = {
    ("cooling_spheres", "sheared_spheres"): spheres,
    ("vibrated_spheres",): bed_of_spheres,
    ("vibrated_friction", "cooling_friction"): friction,
    ("heated", "floor_materials", "wall_materials", "shaken_walls"): drives,
    ("floor_materials", "wall_materials"): materials,
    ("waves",): waves,
    ("runaway",): runaway,
    ("vibrated_inertia", "cooling_inertia"): inertia,
}
"""What measures the numbers of which experiments."""
