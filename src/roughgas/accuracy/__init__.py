"""What accuracy costs, and whether error bars are true: studies of the methods themselves.

A file each: noise of a run (statistical), models of a cooling gas, springs and time steps in place
of events (discretisation), coverage of intervals. Each names its independent tasks (`tasks`, the
longest first), does one of them (`run`), combines what all have found (`combine`), and shows that
in Markdown (`table`); running.py calls these. variables.yaml describes the outcome, figures.py
draws it; config.yaml has the settings, schema.yaml says what they may be. soft_spheres.py is
another method to compare with.
"""

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import not_one_of

if TYPE_CHECKING:
    import xarray as xr

DATASETS = {"accuracy": ("statistical", "models", "discretisation"), "coverage": ("coverage",)}
"""The studies that each combined dataset holds, a group each."""
FIGURES = ("accuracy", "accuracy_limits", "coverage")
STUDIES = tuple(study for studies in DATASETS.values() for study in studies)
SCENES = ("vibrated", "sheared", "cooling")
VARIABLES = Path(__file__).with_name("variables.yaml")
"""What the combined datasets hold."""


def study(name: str) -> Any:
    """Return the module of a study. Raises InputError for an unknown one."""
    if name not in STUDIES:
        raise not_one_of("study", name, STUDIES)
    return import_module(f"roughgas.accuracy.{name}")


def in_order(data: "xr.Dataset") -> "xr.Dataset":
    """Return the corners by experiment, and there from weak to strong dissipation."""
    known = [*SCENES, *dict.fromkeys(data.experiment.values)]
    scene = [known.index(name) for name in data.experiment.values]
    r, beta = data.r.values.astype(float), data.beta.values.astype(float)
    return data.isel(corner=np.lexsort((-beta, -r, scene)))
