"""What accuracy costs in time, and whether error bars are true: studies of the methods themselves.

A study is a file here. Its `tasks` are independent jobs, `run` does one of them, and `combine`
joins what they found and fits what is to be fitted; tables.py shows that in Markdown. Its settings
are in config.yaml, under `accuracy`.
"""

from importlib import import_module
from types import ModuleType

from roughgas.base.errors import not_one_of

PANELS = ("statistical", "models", "discretisation")
"""The studies that the work-precision figure shows, one a panel."""
STUDIES = (*PANELS, "coverage")


def study(name: str) -> ModuleType:
    """The module of a study. Raises InputError for an unknown one."""
    if name not in STUDIES:
        raise not_one_of("study", name, STUDIES)
    return import_module(f"roughgas.studies.accuracy.{name}")
