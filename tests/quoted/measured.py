"""Measures the numbers that pages quote, from reduced datasets."""

import json

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.claims import evidence
from roughgas.claims.averages import averaged
from roughgas.data.reduced import EQUILIBRATED, read_reduced
from roughgas.statistics.estimate import Estimate

WORDS = "none one two three four five six seven eight nine ten eleven twelve thirteen fourteen "
WORDS = (WORDS + "fifteen sixteen seventeen eighteen nineteen twenty").split()
WORDS += [f"twenty-{one}" for one in WORDS[1:10]]


def measured(folder):
    """Return the numbers that the datasets in a folder give, by name."""
    found = theoretical()
    for experiments, measure in MEASURES.items():
        paths = [folder / f"{name}.nc" for name in experiments]
        if all(path.exists() for path in paths):
            found |= measure(*paths)
    for name in ("claims", "open_questions"):
        if (folder / f"{name}.json").exists():
            found |= verdicts(folder / f"{name}.json", name)
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


def theoretical():
    """Numbers of theory alone."""
    mu = np.linspace(0.05, 0.1, 501)
    ratio = theory.friction_ratio(0.9, 0.0, mu, 2, 0.5, None)
    last = np.flatnonzero(ratio > 1 - 1e-6)[-1]
    return {
        "theory_friction_of_spin_alone": mu[last],
        "theory_ratio_beyond_spin_alone": ratio[last + 1],
    }


def beyond(path, below=0.7):
    """Return R - theory at the r that are simulated with the contact-time model."""
    data = read_reduced(path)
    data = data.sel(r=data.r < below)
    gap = data.R - evidence.theory_of(data)
    steady = data.equilibrated > EQUILIBRATED
    return gap.where(steady), (gap / evidence.theory_of(data)).where(steady)


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


def vibrated(path):
    data = evidence.load(path)
    gap = evidence.deviation(data)
    top = int(np.argmax(gap.value))
    places = {name: f"{column[top]:g}" for name, column in gap.places.items()}
    middle = data.sel(beta=np.abs(data.beta) <= 0.5)
    means = {
        f"vibrated_mean_at_r{r:g}".replace(".", ""): evidence.deviation(middle.sel(r=[r])).mean()
        for r in data.r.values
    }
    most = {"vibrated_most_above": gap.at(top), "vibrated_most_at_r": places["r"]}
    most |= {"vibrated_most_at_beta": places["beta"].replace("-", "−")}
    most |= {"vibrated_collisional_off": off_over_collisions(path)}
    return most | means | {"vibrated_most_above_at_r06": beyond(path)[0].max()}


def sheared(path):
    gap = evidence.deviation(evidence.load(path))
    return {
        "sheared_most_above": gap.at(int(np.argmax(gap.value))),
        "sheared_collisional_off": off_over_collisions(path),
        "sheared_most_above_at_r06": beyond(path)[0].max(),
    }


def walls(bed, rough, particle, smooth):
    bed, rough, particle, smooth = map(evidence.load, (bed, rough, particle, smooth))
    return {
        "rough_walls_off": size(evidence.deviation(rough.sel(beta=rough.beta > -1.0))),
        "particle_walls_shift": size(evidence.difference(particle, bed)),
        "smooth_walls_shift": size(evidence.difference(smooth, bed)),
    }


def cooling(path):
    data = evidence.load(path)
    near = data.sel(beta=-0.8)
    return {
        "cooling_off_percent": 100 * size(evidence.deviation_in_proportion(data)),
        "cooling_at_r099": near.R.sel(r=0.99),
        "cooling_at_r08": near.R.sel(r=0.8),
        "cooling_below_percent_at_r06": -100 * beyond(path)[1].min(),
    }


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
        "boundaries_least_share_percent": 100 * min(least),
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


def verdicts(path, name):
    """How many statements hold, in words."""
    found = [claim["verdict"] for claim in json.loads(path.read_text(encoding="utf-8"))["claims"]]
    kinds = {"hold": "holds", "qualified": "holds with a qualification", "fail": "fails"}
    counts = {f"{name}_{kind}": WORDS[found.count(kinds[kind])] for kind in kinds}
    return counts | {f"{name}_statements": WORDS[len(found)]}


MEASURES = {
    ("vibrated",): vibrated,
    ("sheared",): sheared,
    tuple(f"vibrated{kind}" for kind in ("", "_rough_walls", "_particle_walls", "_smooth_walls")): (
        walls
    ),
    ("cooling",): cooling,
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
