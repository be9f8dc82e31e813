"""A copy of the project, where Snakemake itself runs at a tiny scale."""

import copy
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import snakemakes

from roughgas.base.reading import read_yaml
from roughgas.results.crate import PROJECT_FILES

ROOT = Path(__file__).parent.parent
COPIED = (*PROJECT_FILES, "rules", "profiles", "src", "studies", "workflow")
COPIED += tuple(f"tests/{name}" for name in ("hard_cases", "brute_force", "exact"))
COPIED += tuple(f"tests/{name}.py" for name in ("conftest", "compiled", "yaml_cache", "schedules"))
SWEEP = {"r": ["0.9"], "beta": ["0"], "seeds": 2}
STEADY = {"equilibrate": 20, "measure": 20}
TINY = {
    "vibrated": {"particles": 10, "box": [10, "open"], "sweep": SWEEP, "schedule": STEADY},
    "vibrated_rough_walls": {"sweep": {"beta": ["-1"]}},
    "vibrated_particle_walls": {"sweep": {"beta": ["0"]}},
    "vibrated_smooth_walls": {"sweep": {"beta": ["0"]}},
    "sheared": {"particles": 10, "box": [20, 20], "sweep": SWEEP, "schedule": STEADY},
    "cooling": {
        "particles": 10,
        "box": [20, 20],
        "sweep": SWEEP,
        "schedule": {"replicas": 3, "plateau": 20},
    },
    "clustering.gas": {"particles": 40, "box": [40, 40]},
    "clustering.tasks": {"collisions": 20, "frames": 10, "window": 30},
    "transport.tasks": {
        "spheres": [0, 0.4],
        "disks": [0],
        "equilibrium": {"length": 200, "blocks": 4},
        "forced": {"particles": 50, "length": 20, "q": [0.4]},
        "driven": {"particles": 50, "windows": 20, "r": ["0.9"], "beta": ["1"]},
    },
}
POINTS = 6 * SWEEP["seeds"]
JOBS = 6  # one makes both seeds of a point
FINISHED = ("everything",)
OF_FLUXES = ("", "_fluxes", "_between_walls")
ELASTIC = [f"{kind}{of}" for kind in ("disks", "spheres") for of in OF_FLUXES]
ELASTIC += ["spheres_far_walls"]
MPEMBA = ["hot", "cold", "overshoot_hot", "overshoot_cold"]
MATERIALS = ["", "_smoother", "_smoother_inelastic", "_less_inelastic"]
BEYOND = {  # the experiments beyond the paper, and the third axis of their sweeps
    "spheres.cooling_spheres": {},
    "spheres.sheared_spheres": {},
    "spheres.vibrated_spheres": {},
    "friction.vibrated_friction": {"friction.mu": ["0.5"]},
    "friction.cooling_friction": {"friction.mu": ["0.5"]},
    "drives.heated": {"thermostat.spin_share": ["0.5"]},
    "drives.shaken_walls": {"shaken_walls.roughness": ["1"]},
    "waves.waves": {"floor.wave": ["sine"]},
    "inertia.vibrated_inertia": {"spin.inertia": ["0.1"]},
    "inertia.cooling_inertia": {"spin.inertia": ["0.1"]},
    "drives.floor_materials": {"floor.roughness": ["1"]},
    "drives.wall_materials": {"walls.roughness": ["1"]},
    "mixtures.vibrated_masses": {"species.heavy.mass": ["4"]},
    "mixtures.vibrated_sizes": {"species.large.radius": ["2"]},
    "mixtures.cooling_masses": {"species.heavy.mass": ["4"]},
    "mixtures.cooling_sizes": {"species.large.radius": ["2"]},
    "mixtures.vibrated_polydisperse": {"species.disks.deviation": ["0.2"]},
    "mixtures.cooling_polydisperse": {"species.disks.deviation": ["0.2"]},
    "viscoelastic.cooling_viscoelastic": {},
    "couette.couette": {},
    "megias_santos.dilute": {"thermostat.spin_share": ["0.5"]},
    **{
        f"mpemba.{name}": {}
        for name in (*(pair + suffix for suffix in MATERIALS for pair in MPEMBA), "memory")
    },
    **{f"transport.smooth_{kind}": {"r": ["1"], "beta": ["-1"]} for kind in ELASTIC},
    **{f"transport.rough_{kind}": {"r": ["1"], "beta": ["1"]} for kind in ELASTIC},
    **{
        f"transport.rough_spheres_fluxes_{kind}": {"r": ["1"], "beta": ["1"]}
        for kind in ("many", "dense")
    },
    "transport.heated": {},
    **{key: {} for key in ("luding_1998.disks", "luding_1998.spheres", "brilliantov_2007.spheres")},
    **{
        key: {}
        for key in ("bodrova_2012.spheres", "vega_reyes_2015.spheres", "santos_2010.mixture")
    },
    **{key: {} for key in ("torrente_2019.hot", "torrente_2019.cold", "brito_2013.rough")},
    **{f"vijayakumar_2007.{walls}_walls": {} for walls in ("smooth", "rough")},
    "vega_reyes_2017.intruders": {"species.intruders.mass": ["1"]},
    "herbst_2005.disks": {"friction.mu": ["0.5"]},
    "scholz_2017.spinners": {"langevin.spin_drag": ["1"]},
    "brito_2013.smooth": {"beta": ["-1"]},
    "gomez_gonzalez_2020.suspension": {"shear.velocity": ["1.2"]},
    "multiplicative.disks": {"speed_kicks.exponent": ["1"], "beta": ["-1"]},
    "impact_roughness.disks": {"roughness_law.exponent": ["1"]},
    "thermal_floor.bed": {"thermal_floor.temperature": ["5"], "r": ["1"]},
    "patterns.layers": {"seeds": 1},  # of seven cases
    "patterns.large": {"seeds": 1},  # of two
    "transport.strained": {"shear.velocity": ["0.4"]},
}
TINY |= {name: {"sweep": SWEEP | axis} for name, axis in BEYOND.items()}
for name, box in (
    ("spheres.cooling_spheres", [10, 10, 10]),
    ("spheres.sheared_spheres", [10, 10, 10]),
    ("spheres.vibrated_spheres", [10, 10, "open"]),
    ("drives.heated", [20, 20]),
    ("mixtures.cooling_sizes", [20, 20]),
    ("drives.shaken_walls", [20, 20]),
    ("couette.couette", [20, 20]),
    ("megias_santos.dilute", [100, 100]),
    *(
        (name, [20] * 3 if "spheres" in name else [60, 60])
        for name in BEYOND
        if "transport" in name
    ),
):
    TINY[name] |= {"particles": 10, "box": box, "packing": None}
for name in (name for name in BEYOND if name.startswith("mpemba.")):
    TINY[name] |= {"particles": 20, "schedule": {"sample_every": 40}}
for name in ("patterns.layers", "patterns.large"):
    TINY[name] |= {
        "particles": 40,
        "layer": {"width": 4, "cycles": {"equilibrate": 0, "measure": 4}},
        "observables": {"pattern": {"cells": 4}},
    }
for name in BEYOND:
    if "fluxes" in name or name.endswith(("strained", "between_walls", "far_walls")):
        TINY[name]["schedule"] = {"equilibrate": 100, "measure": 1000, "sample_every": 10}
TINY["megias_santos.dilute"]["schedule"] = {"equilibrate": 80, "measure": 800, "target_stderr": 0.1}


class Project:
    """A copy of the project in `folder`, with a scale `tiny`."""

    def __init__(self, folder):
        self.folder = folder
        (folder / "tests").mkdir()
        for name in COPIED:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, folder / name)
            else:
                shutil.copy2(ROOT / name, folder / name)
        self.configure(lambda config: config["scales"].update(tiny=copy.deepcopy(TINY)))

    def copy_to(self, folder):
        """Another such project, as far run as this one."""
        shutil.copytree(self.folder, folder)
        project = copy.copy(self)
        project.folder = folder
        return project

    def configure(self, change):
        """Let `change` edit config.yaml, given as a dictionary."""
        path = self.folder / "config.yaml"
        config = read_yaml(path)
        change(config)
        path.write_text(json.dumps(config))  # which is YAML, too, and has no aliases

    def append(self, path, text="\nADDED = 1\n"):
        with open(self.folder / path, "a") as file:
            file.write(text)

    def start(self, *arguments):
        """Snakemake, running."""
        return subprocess.Popen(
            [sys.executable, "-m", "snakemake", *arguments],
            cwd=self.folder,
            env=self.environment(),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def snakemake(self, *arguments):
        return snakemakes.run(self.folder, self.environment(), arguments)

    def environment(self):
        """Return this process's environment with the copied package on Python's path."""
        return os.environ | {"PYTHONPATH": str(self.folder / "src")}

    def succeed(self, *arguments):
        status, output = self.snakemake(*arguments)
        assert status == 0, output
        assert "shows its run itself" not in output  # the display is broken
        return output

    def planned(self, *targets):
        """Number of jobs of each rule that a run would start (see `jobs_by_rule`)."""
        output = self.succeed("-n", "--config", "scale=tiny", "--", *targets)
        if "Nothing to be done" in output:
            return {}
        return jobs_by_rule(output)

    def files(self):
        return {
            str(path.relative_to(self.folder))
            for path in self.folder.rglob("*")
            if path.is_file() and ".snakemake" not in path.parts and path.suffix != ".pyc"
        }


def jobs_by_rule(output):
    """Return the number of jobs of each rule in a dry run; all blocks of points count as
    `seeds`."""
    table = output.rsplit("Job stats:", 1)[1].split("total")[0]
    numbers = {}
    for rule, count in re.findall(r"^([\w.]+) +(\d+)$", table, re.M):
        name = re.sub(r"[\w.]+_block\d+", "seeds", rule)
        numbers[name] = numbers.get(name, 0) + int(count)
    return numbers
