"""Checks of a whole configuration, and of one experiment in it.

The schema says what each part may hold; here is what it cannot say. All functions raise an
InputError for the first illegal thing, with the file and the key in it.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roughgas import config as settings_of
from roughgas.base import InputError, shown
from roughgas.config.axis import SPECIES, names_of, species_called
from roughgas.config.labels import level, numbers_of, restitution, roughness
from roughgas.config.reading import read_yaml
from roughgas.config.schema import check_schema
from roughgas.config.sizes import PACKING

PARTS = (settings_of.SHOWCASE, settings_of.STUDIES)
RESERVED = (
    *PARTS,
    *("accuracy", "accuracy_figure", "accuracy_limits", "accuracy_table", "catalogue"),
    *("claims", "clustering", "combined_tasks", "compile_kernel", "config", "coverage"),
    *("crate", "document", "effective_config", "everything", "explore", "explore_extensions"),
    *("extensions", "family", "fig1a", "fig1b", "fig2a", "fig2b", "figure", "figures", "film"),
    *("finite_size", "front", "gas_of_film", "hard_cases", "hard_cases_chaos"),
    *("hard_cases_collapse", "hard_cases_cooling", "living", "living_page", "movie", "movies"),
    *("open_questions", "page", "picture_for_talks", "pictures", "plot", "point", "profiles"),
    *("reduce", "report", "run_times", "run_times_extensions", "runaway", "showcase"),
    *("study_claims", "study_figure", "study_page", "study_table", "table", "task"),
)
"""Names that no experiment may have, those of rules and products of the workflow."""


def read(
    path: str | Path, overrides: Mapping[str, Any] | None = None
) -> tuple[dict[str, Any], str]:
    """Return the unchecked configuration at `path`, `overrides` merged into it, and what messages
    call it."""
    source = Path(path).name
    config = read_yaml(path)
    if not isinstance(config, dict):
        raise InputError(source, shown(config), "hold the key experiments")
    config = {"scale": settings_of.PAPER} | config
    config = {"scales": {str(config["scale"]): {}}} | config
    if not overrides:
        return config, source
    return settings_of.merged(config, overrides), f"{source} with the command line's changes"


def check(config: Mapping[str, Any], source: str = "config.yaml") -> None:
    """Check a configuration: its form, and every experiment, variant and study at every scale."""
    check_file(config, source)
    check_merged(config, source)


def check_merged(config: Mapping[str, Any], source: str) -> None:
    """Check what the form cannot say; experiments of studies have been checked as they joined."""
    for name in config["experiments"]:
        check_ancestors(name, config["experiments"], source)
    for scale in config["scales"]:
        for part, whole, of in (
            (settings_of.SHOWCASE, "filmed", settings_of.showcase),
            (settings_of.STUDIES, "studied", settings_of.studies),
        ):
            if part in config:
                check_schema(of(config, scale), f"{source}: {part} at scale {scale}", whole)
        for name in config["experiments"]:
            if "." not in name or config.get("complete"):
                check_one(config, name, scale, source)


def check_file(config: Mapping[str, Any], source: str) -> None:
    """Check the form of a configuration: what can be said without merging anything."""
    added = (settings_of.FOLDERS, settings_of.BROKEN)  # by studies that have joined
    check_schema({key: part for key, part in config.items() if key not in added}, source)
    known, scales = config["experiments"], config["scales"]
    settings_of.one_of(f"{source}: scale", config["scale"], scales)
    for name in known:
        if name in RESERVED:
            legal = "be another name: the workflow has a rule or a product of this one"
            raise InputError(f"{source}: key of experiments", name, legal)
    changeable = [*known, *(part for part in PARTS if part in config)]
    for scale, changes in scales.items():
        for name in changes:
            if "." not in name or config.get("complete"):
                settings_of.one_of(f"{source}: key of scales.{scale}", name, changeable)


def check_one(config: Mapping[str, Any], name: str, scale: str, source: str) -> None:
    """Check an experiment and its variants at one scale, all that they extend merged."""
    settings = settings_of.experiment(config, name, scale)
    at_scale = "" if scale == config["scale"] else f" at scale {scale}"
    where = f"{source}: experiments.{name}{at_scale}"
    _check_axis(settings, where)
    for one, chosen in settings_of.every_variant(name, settings).items():
        for part in ("experiment", "point") if one != name else ("point",):
            check_schema(chosen, f"{source}: experiments.{one}{at_scale}", part)
    check_schema(settings, where, "swept")
    for key, value_of in (("r", restitution), ("beta", roughness)):
        numbers_of(f"{where}.sweep.{key}", settings["sweep"][key], value_of)


def _check_axis(settings: Mapping[str, Any], where: str) -> None:
    """Refuse two third axes, one of an effect that the experiment does not list or of a length that
    its schedule does not have, and a value given twice. Whether a value is legal is left to the
    check of its variant."""
    keys = [key for key in settings.get("sweep", {}) if key not in settings_of.GRID]
    for key in keys[1:]:
        raise InputError(f"{where}.sweep: key", shown(key), f"not stand beside {keys[0]}")
    for key in keys:
        part, _, parameter = key.rpartition(".")
        listed, timed = settings.get("effects", {}), settings.get("schedule", {})
        if part == "schedule" and parameter not in timed:
            legal = f"name a length of this schedule: {', '.join(sorted(timed))}"
            raise InputError(f"{where}.sweep: key", shown(key), legal)
        if part.startswith(SPECIES):
            if species_called(settings, part) is None:
                legal = f"name one of species: {', '.join(names_of(settings)) or 'there are none'}"
                raise InputError(f"{where}.sweep: key", shown(key), legal)
        elif part not in ("", "schedule", *listed):
            legal = f"begin with an effect of this experiment: {', '.join(sorted(listed))}"
            raise InputError(f"{where}.sweep: key", shown(key), legal)
        if key == "box" and PACKING in settings:
            raise InputError(f"{where}.sweep: key", shown(key), "not be swept beside packing")
        if not part and key not in settings and (key, "box" in settings) != (PACKING, True):
            raise InputError(f"{where}.{key}", "(nothing)", "be given, as it is swept")
        numbers_of(f"{where}.sweep.{key}", settings["sweep"][key], level)


def check_ancestors(name: str, known: Mapping[str, Any], source: str) -> None:
    """Refuse a chain of `extends` that breaks or runs in a circle."""
    seen = [name]
    while parent := known[seen[-1]].get("extends"):
        key = f"{source}: experiments.{seen[-1]}.extends"
        settings_of.one_of(key, parent, known)
        if parent in seen:
            raise InputError(key, parent, "be an experiment that does not itself build on this one")
        seen.append(parent)
