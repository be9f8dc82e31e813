"""The configuration of tests: the experiments of config.yaml, and some of studies by their short
names, in one file that stands alone; and configurations as mappings, changed before a check."""

import atexit
import copy
import json
import shutil
import tempfile
from pathlib import Path

from roughgas.base.reading import read_yaml
from roughgas.config import WrittenConfiguration
from roughgas.config.study_folders import with_studies

ROOT = Path(__file__).parents[1]
SCALES = ("paper", "small")
STUDIES = {
    "spheres": ["cooling_spheres", "sheared_spheres", "vibrated_spheres"],
    "friction": ["vibrated_friction", "cooling_friction"],
    "drives": ["heated", "shaken_walls", "floor_materials", "wall_materials"],
    "waves": ["waves"],
    "inertia": ["vibrated_inertia", "cooling_inertia"],
    "mixtures": [
        *("vibrated_masses", "vibrated_sizes", "vibrated_polydisperse"),
        *("cooling_masses", "cooling_sizes", "cooling_polydisperse"),
    ],
    "viscoelastic": ["cooling_viscoelastic"],
    "couette": ["couette"],
}
"""The experiments of each study that are in the configuration of tests."""


def configuration():
    """The configuration as a mapping; nothing joins it."""
    paper = read_yaml(ROOT / "config.yaml")
    scales = {scale: dict(paper["scales"].get(scale) or {}) for scale in SCALES}
    experiments = dict(paper["experiments"])
    for study, names in STUDIES.items():
        folder = read_yaml(ROOT / "studies" / study / "config.yaml")
        experiments |= {name: folder["experiments"][name] for name in names}
        for scale, changes in folder.get("scales", {}).items():
            scales[scale] |= {name: changes[name] for name in names if name in changes}
    return paper | {"complete": True, "experiments": experiments, "scales": scales}


def _file():
    """The configuration in a file that is there as long as the process."""
    folder = Path(tempfile.mkdtemp(prefix="roughgas-tests-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    (folder / "experiments.yaml").write_text(
        json.dumps(configuration(), indent=1), encoding="utf-8"
    )
    return folder / "experiments.yaml"


EXPERIMENTS = _file()


def raw_configuration(path=EXPERIMENTS):
    """The configuration of a file as a mapping."""
    return copy.deepcopy(dict(WrittenConfiguration.from_file(path).raw))


def unchecked(raw):
    """Return the configuration of a mapping without a check of its keys."""
    return WrittenConfiguration(raw).with_defaults().configuration("config.yaml")


def checked(raw):
    """The configuration of a mapping, all of it checked."""
    WrittenConfiguration(raw).check("config.yaml")
    return with_studies(unchecked(raw), []).checked()
