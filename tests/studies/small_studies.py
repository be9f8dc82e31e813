"""Small tasks of every study, for the contract of all studies and for the tests of a study."""

import copy
from collections.abc import Mapping
from typing import Any, NamedTuple

from brute_force import KERNELS
from brute_force import settings as scene
from schedules import COOLING, STEADY
from tests.study_modules import ROOT, module_of_study

from roughgas import config

CONFIG = config.load(ROOT / "config.yaml")


class SmallStudy(NamedTuple):
    """Settings of the tasks of a study, or of a module with tasks, and their consequences."""

    settings: Mapping[str, Any]
    cells: Mapping[str, int]
    """Cells of the table that name the points, or neighbouring cells joined by " | ", with the
    number of times that the table has them."""
    cheap_task: str
    experiments: Mapping[str, Any] = {}
    shared_keys: frozenset[tuple[int, ...]] = frozenset()
    """Keys of random numbers that several runs draw: runs whose results are dropped, or a gas in
    single and in double precision."""


def small_scale(study):
    """A copy of the settings of the tasks of a study at the scale `small`."""
    return copy.deepcopy(CONFIG.studies[study].tasks.settings["small"])


def of_paper(*names):
    return {name: CONFIG.experiment(name, "paper").raw for name in names}


# ---------------------------------------------------------------- studies with tasks.py

LENGTHS = {"equilibrate": 20, "measure": 30}
BED = {"experiment": "bed", "r": "0.9", "beta": "0.3", "slice": 1.5, "period": 1} | LENGTHS
SHEARED = {"experiment": "gas", "r": "0.8", "beta": "1", "slice": 3, "period": 10} | LENGTHS
PROFILES = SmallStudy(
    {"seed": 1, "runs": 2, "phases": 8, "slices": 10, "points": [BED, SHEARED]},
    {"disks, r = 0.9, β = 0.3": 1, "disks, r = 0.8, β = 1": 1},
    "gas_r0.8_beta1-1",
    {
        "bed": scene("bed", 16, [10, "open"]) | {"schedule": STEADY},
        "gas": scene("sheared", 16, [12, 12]) | {"schedule": STEADY},
    },
)

# other tests compile the kernel of these spheres
SPHERES = CONFIG.experiment("finite_size.cooling_spheres", "paper").raw | {
    "effects": KERNELS["spheres"]["effects"]
}
FINITE_SIZE = SmallStudy(
    {
        "seed": 1,
        "particles": [20, 40],
        "packings": [0.05, 0.001],
        "precision": 0.2,
        "points": {"cooling": [["0.9", "0"], ["0.8", "-0.3"]], "cooling_spheres": [["0.8", "0"]]},
    },
    {
        "cooling, r = 0.9, β = 0": 6,
        "cooling, r = 0.8, β = −0.3": 6,
        "cooling_spheres, r = 0.8, β = 0": 6,
        "N = 20": 6,
        "N = 40": 6,
    },
    "cooling_r0.9_beta0-n20",
    of_paper("cooling") | {"cooling_spheres": SPHERES},
    frozenset({(0,)}),
)

RUNAWAY = SmallStudy(
    {
        "seed": 3,
        "r": "0.9",
        "beta": "0",
        "mu": [0.05, 0.1, 0.5],
        "packing": 0.001,
        "dsmc": [
            {"particles": 40, "runs": 5, "limit": 600},
            {"particles": 400, "runs": 4, "limit": 400},
        ],
        "events": [{"particles": 40, "runs": 3, "limit": 100}],
        "example": {"particles": 400, "mu": [0.1], "limit": 40},
    },
    {"0.05": 3, "0.1": 3, "0.5": 3, "N = 40": 2, "N = 400": 1},
    "dsmc-n40-mu0.05",
    of_paper("cooling"),
    frozenset({(0,)}),
)

CLUSTERING = SmallStudy(
    {
        "r": "0.9",
        "beta": "0.2",
        "seed": 3,
        "thermalise": 5,
        "collisions": 60,
        "frames": 12,
        "cell": 5,
        "window": 30,
    },
    {"0 | 1": 1} | {f"{collisions}": 1 for collisions in range(5, 61, 5)},
    "film",
    {
        "gas": CONFIG.experiment("clustering.gas", "small").raw
        | {"particles": 100, "box": [40.0, 50.0], "effects": {"spin": {"inertia": 0.5}}}
    },
)


def settings_of_exact():
    settings = small_scale("exact")
    material = {"restitution": 0.9, "roughness": 0.2, "mu": 0.3}
    settings |= {"seed": 5, "contacts": material | {"dimensions": [2, 3], "contacts": 40}}
    settings["tracers"] |= {"particles": 100, "tracers": 1, "packing": 0.01, "thermalise": 20}
    settings["noise"]["packing"] = settings["rates"]["packing"] = 0.01
    settings["mixtures"]["packing"], settings["rough"]["settle"] = 0.01, 100
    settings["clusters"] |= {"packing": 0.2, "gases": [[0.8, 0]]}
    settings["fluids"]["every"] = 10
    settings["diffusion"]["dimensions"] = [2, 3]
    return settings


def exact():
    """Each row of its table is a quantity of a task."""
    small, quantities = settings_of_exact(), {"noise": 1, "fluids": 3, "tracers": 1}
    quantities |= {"cooling": 1, "haff": 2, "rates": 2, "diffusion": 2, "tails": 3, "rough": 4}
    quantities |= {"mixtures": 4, "clusters": 2, "contacts": 13}
    tasks = module_of_study("exact", "tasks").tasks(small)
    cells = {task: quantities[task.partition("_")[0]] for task in tasks}
    return SmallStudy(small, cells, "cooling_2_0.9")


def megias_santos():
    settings = small_scale("megias_santos")
    rows = [*settings["states"], *settings["events"]["gases"]]
    cells = {" | ".join(f"{number:g}" for number in row): 1 for row in rows}
    return SmallStudy(settings, cells, "homogeneous-r0.7-beta0-share0.25")


def transport():
    """A driven gas has a coefficient of diffusion; all others have viscosity and conductivity."""
    settings = small_scale("transport")
    cells = {
        f"{gas.kind} | {gas.r} | {gas.beta} | {gas.inertia:.4g} | {gas.method} | {gas.particles} |"
        f" {gas.force:g}": 1 if gas.method == "driven" else 2
        for gas in module_of_study("transport", "tasks").gases_of(settings).values()
    }
    return SmallStudy(settings, cells, "driven-disks-r0.9-beta1-q0.5-n200")


# ---------------------------------------------------------------- studies of accuracy

STATISTICAL = SmallStudy(
    {
        "seed": 1,
        "r": "0.9",
        "beta": "0",
        "levels": 3,
        "groups": 4,
        "chains": 2,
        "reference": 10,
        "scenes": {
            "vibrated": {"equilibrate": 10, "shortest": 5},
            "sheared": {"equilibrate": 20, "shortest": 40},
            "cooling": {"equilibrate": 10, "shortest": 8},
        },
    },
    {"vibrated": 2, "sheared": 2, "cooling": 2},
    "sheared-length",
    {
        "vibrated": scene("bed", 20, [10, "open"]) | {"schedule": STEADY},
        "sheared": scene("sheared", 20, [18, 18]) | {"schedule": STEADY | {"period": 0.25}},
        "cooling": scene("gas", 20, [25, 25]) | {"schedule": COOLING},
    },
)

GAS_OF_MODELS = {
    "particles": 40,
    "box": [50, 50],
    "effects": {"spin": {"inertia": 0.5}, "contact_time": {"duration": 1e-4, "below_r": 0.75}},
    "schedule": COOLING | {"thermalise": 5},
}
MODELS = SmallStudy(
    {
        "seed": 1,
        "r": "0.8",
        "beta": "0",
        "groups": 3,
        "segment": 20,
        "event_driven": [10, 20, 40],
        "dsmc": [10, 40],
        "rate_equations": [1, 10, 60],
        "reference": {"jobs": 2, "length": 400},
        "map": {"r": ["0.9", "0.6"], "beta": ["-0.5", "1"], "particles": 200, "precision": 3e-2},
        "density": {
            "points": [["0.8", "-0.3"]],
            "packings": [0.01, 0.05],
            "length": 100,
            "precision": 3e-2,
        },
    },
    {"r = 0.9": 1, "r = 0.6": 1, "-0.5": 1, "1": 1, "DSMC": 1, "event-driven": 1},
    "map-r0.9",
    {"cooling": GAS_OF_MODELS},
    frozenset({(0, 0)}),
)

DISCRETISATION = SmallStudy(
    {
        "seed": 3,
        "r": 0.9,
        "beta": 0.0,
        "packing": 0.1,
        "contact_times": [0.2, 0.05],
        "steps": [5, 10],
        "soft_collisions": 600,
        "model_contact_times": [0.01, 1.0],
        "model_collisions": 300,
        "event_collisions": 4000,
        "reference_runs": 2,
        "reference_collisions": 6000,
    },
    {
        "soft spheres, 5 steps": 1,
        "soft spheres, 10 steps": 1,
        "0.2": 1,
        "0.05": 1,
        "0.01": 1,
        "1": 1,
    },
    "event",
    {"cooling": {"particles": 40, "box": [50, 50], "effects": {"spin": {"inertia": 0.5}}}},
    frozenset({(6,)}),
)

WAITING = SmallStudy(
    {
        "seed": 1,
        "waits": [1, 2, 4, 8],
        "measure": 8,
        "points": [
            {"r": "0.99", "beta": "-0.9", "runs": 3, "settled": 20, "length": 40},
            {"r": "0.9", "beta": "0", "runs": 3, "settled": 10, "length": 20},
        ],
    },
    {"r = 0.99, β = −0.9": 2, "r = 0.9, β = 0": 2},
    "waiting-r0.9-beta0",
    {"vibrated": scene("bed", 20, [10, "open"]) | {"schedule": STEADY | {"period": 1}}},
)

COVERAGE = SmallStudy(
    {
        "seed": 1,
        "repetitions": 8,
        "pooled": 4,
        "reference": {"seeds": 2, "length": 20},
        "corners": [
            {"experiment": "bed", "r": "0.9", "beta": "-0.5", "schedule": {"measure": 30}},
            {"experiment": "gas", "r": "0.9", "beta": "0", "schedule": {"plateau": 30}},
        ],
    },
    {"bed, r = 0.9, β = −0.5 | 8": 1, "gas, r = 0.9, β = 0 | 8": 1},
    "bed_r0.9_beta-0.5",
    {
        "bed": scene("bed", 10, [10, "open"]) | {"schedule": STEADY},
        "gas": scene("gas", 10, [20, 20]) | {"schedule": COOLING},
    },
)

SMALL_STUDIES = {
    "clustering": CLUSTERING,
    "exact": exact(),
    "finite_size": FINITE_SIZE,
    "megias_santos": megias_santos(),
    "profiles": PROFILES,
    "runaway": RUNAWAY,
    "transport": transport(),
    "accuracy.statistical": STATISTICAL,
    "accuracy.models": MODELS,
    "accuracy.discretisation": DISCRETISATION,
    "accuracy.waiting": WAITING,
    "coverage.coverage": COVERAGE,
}
"""By the name of the study, or STUDY.MODULE."""
