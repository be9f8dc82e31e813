"""config.yaml: read, checked, and merged into the settings of one experiment at one scale.

A sweep may have a third axis, with its labels: one parameter of one effect, as EFFECT.PARAMETER,
such as `spin.inertia: ["1", "0.1"]`; one quantity of one species, as species.NAME.KEY, a KEY of its
`radius` too where radii are spread; one length of the schedule, as schedule.KEY; the number of
`particles`; the width of the `box`, whose other sides keep their proportion to it; the `packing`;
or a `case`, the name of settings that vary together. Each label
makes a variant of the experiment, named EXPERIMENT/PARAMETERLABEL, such as
mine/inertia0.1: an experiment like any other, whose settings have that value.

All functions raise InputError, with a text of one line, for unknown names and illegal values.
"""

import copy
import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from roughgas.base import InputError, as_text, from_json, merged, not_one_of, shown  # noqa: F401
from roughgas.config.labels import (  # noqa: F401
    PARSE,
    SPECIES,
    SWEPT,
    Place,
    holder,
    level,
    parameter_of,
    places,
    restitution,
    roughness,
    seed,
)
from roughgas.config.layers import LAYER, with_layer, without_layer

# the schema and YAML are imported where they are used: a job of checked settings needs neither

SHIPPED = Path(__file__).parents[1] / "config.yaml"
"""The experiments that come with the package; in a clone of the repository, its config.yaml."""
ACCURACY = "accuracy"
"""The part of a configuration that changes the settings of accuracy."""
OF_ACCURACY = SHIPPED.parent / ACCURACY
"""The folder of what accuracy costs, with settings of its own, which a configuration may change."""
FOLDERS, BROKEN = "folders", "broken"
"""Keys of a configuration that studies have joined (`config.study_folders.joined`)."""
PAPER = "paper"
"""The scale of a configuration that names none."""
SEEDS_PER_JOB = 4
CASE = "case"
"""A third axis whose labels are names of settings that vary together."""
GRID = ("r", "beta", "seeds")
"""The axes of every sweep; any other key of a sweep is its third axis."""
NOT_OF_A_POINT = ("description", "sweep", "betas_per_job")
"""Settings of an experiment that do not concern any single point of it."""
PACKING = "packing"
"""In place of lengths; `box` then has its proportions."""
ROUNDING = 1e-9  # relative difference of a box from its packing
LONGEST = 1e9  # a


def in_use() -> Path:
    """Return the configuration that commands use unless they are told otherwise: config.yaml in the
    present folder, or where there is none the one that comes with the package."""
    here = Path("config.yaml")
    return here if here.exists() else SHIPPED


def usual_scale(path: str | Path) -> str:
    """Return the scale that the configuration at `path` is run at unless another is asked for.

    Raises OSError where the file cannot be read.
    """
    from roughgas.config.schema import read

    return read(path)[0]["scale"]


def load(path: str | Path, overrides: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the configuration at `path`, with `overrides` merged into it and all studies, checked.

    Raises OSError where the file cannot be read.
    """
    from roughgas.config.schema import check_file, check_merged, read
    from roughgas.config.study_folders import joined

    config, source = read(path, overrides)
    check_file(config, source)
    config = joined(with_accuracy(config), path, source)
    check_merged(config, source)
    return config


def with_accuracy(config: Mapping[str, Any]) -> dict[str, Any]:
    """Return a configuration with the settings of accuracy, and what it changes in them."""
    from roughgas.config.reading import read_yaml

    if config.get("complete") and ACCURACY in config:
        return dict(config)
    own = read_yaml(OF_ACCURACY / "config.yaml")
    changes = own.pop("scales")
    scales = {
        scale: part | {ACCURACY: merged(changes.get(scale, {}), part.get(ACCURACY, {}), False)}
        for scale, part in config["scales"].items()
    }
    return {**config, ACCURACY: merged(own, config.get(ACCURACY, {})), "scales": scales}


def load_experiment(path: str | Path, name: str, scale: str) -> dict[str, Any]:
    """Return one experiment, or variant, at `scale` from the configuration at `path`.

    Other experiments and scales are checked against the schema only. Raises OSError where the file
    cannot be read.
    """
    from roughgas.config.schema import check_ancestors, check_file, check_one, read
    from roughgas.config.study_folders import joined

    config, source = read(path)
    check_file(config, source)
    base = name.partition("/")[0]
    config = joined(config, path, source, only=base.rpartition(".")[0])
    if base in config["experiments"]:
        check_ancestors(base, config["experiments"], source)
    found = experiment(config, name, scale)
    check_one(config, base, scale, source)
    return found


def experiment(config: Mapping[str, Any], name: str, scale: str) -> dict[str, Any]:
    """Return the experiment `name` at `scale`: what it extends, its own settings, and the scale's
    changes.

    What it extends is taken as it is at this scale. `name` may be that of a variant, whether or not
    its value is in the sweep.
    """
    base, slash, _ = name.partition("/")
    settings = _experiment(config, base, scale)
    if not slash:
        return settings
    from roughgas.config.schema import check_schema

    chosen = variant(name, settings)
    check_schema(chosen, name, "experiment")
    return chosen


def _experiment(config: Mapping[str, Any], name: str, scale: str) -> dict[str, Any]:
    if "." in name and name.partition(".")[0] in config.get(BROKEN, {}):
        raise InputError(*config[BROKEN][name.partition(".")[0]])
    one_of("experiment", name, config["experiments"])
    one_of("scale", scale, config["scales"])
    own = dict(config["experiments"][name])
    parent = own.pop("extends", None)
    settings = _experiment(config, parent, scale) if parent else {}
    settings.pop("description", None)
    for changes in (own, config["scales"][scale].get(name, {})):
        settings = fitted(changed_by(settings, changes), f"experiments.{name}")
    return settings


def accuracy(config: Mapping[str, Any], scale: str) -> dict[str, Any]:
    """Return the settings of the studies of accuracy at `scale`, by name."""
    one_of("scale", scale, config["scales"])
    if ACCURACY not in config:
        raise InputError(f"{ACCURACY} in the configuration", "(nothing)", "be given for this")
    return merged(config[ACCURACY], config["scales"][scale].get(ACCURACY, {}))


def study(config: Mapping[str, Any], name: str, scale: str) -> dict[str, Any]:
    """Return the settings of a study of accuracy at `scale`, as `study`, and those of the
    experiments that it may run, as `experiments`, those of folders by their own names."""
    settings = accuracy(config, scale)
    one_of("study", name, settings)
    every = {one: experiment(config, one, scale) for one in config["experiments"]}
    experiments = {one.rpartition(".")[2]: point_settings(own) for one, own in every.items()}
    return {"study": settings[name], "experiments": experiments}


def changed_by(settings: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return an experiment's settings with `changes` merged in, to be `fitted` once all are.

    Of a box and a packing the later one counts; beside a packing an earlier box is a shape. A
    schedule of another kind takes nothing from the one before.
    """
    schedules = [one.get("schedule") for one in (settings, changes)]
    kinds = [one.get("kind") if isinstance(one, Mapping) else None for one in schedules]
    if None not in kinds and kinds[0] != kinds[1]:
        settings = {**settings, "schedule": {}}
    found = merged(without_layer(settings), changes)
    if "box" in changes and PACKING not in changes:
        found.pop(PACKING, None)
    elif PACKING in found and "box" not in changes and "open" not in settings.get("box", ["open"]):
        found["box"] = [side / min(settings["box"]) for side in settings["box"]]
    return found


def fitted(settings: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Return settings with what their `layer` says, whose box has the `packing` asked for, if any:
    lengths in a.

    Values that the schema refuses are left to it. Raises InputError, whose key begins with `where`,
    for an open box, for a box of another packing, and for one that would be too large.
    """
    found, asked = with_layer(settings, where), settings.get(PACKING)
    number = settings.get("particles")
    if not isinstance(asked, int | float) or not asked > 0 or not isinstance(number, int):
        return found
    from roughgas.effects.species import packing  # needs numpy

    box = found.setdefault("box", [1, 1])
    if "open" in box:
        raise InputError(f"{where}.{PACKING}", asked, "not be given for a box that is open above")
    there = packing({"effects": {}} | found)
    if abs(there - asked) <= ROUNDING * asked:
        return found
    if min(box) != 1:
        legal = f"not stand beside packing = {asked}; or be proportions, the least 1: [1, 2]"
        raise InputError(f"{where}.box", box, legal)
    length = (there / asked) ** (1.0 / len(box))
    if not math.isfinite(length) or length * max(box) > LONGEST:
        legal = f"be so large that no side of the box is longer than {LONGEST:g} a"
        raise InputError(f"{where}.{PACKING}", asked, legal)
    return found | {"box": [length * side for side in box]}


def point_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of an experiment that shape its points, whichever are asked for."""
    return {key: value for key, value in settings.items() if key not in NOT_OF_A_POINT}


def kernel_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of an experiment that its kernels are compiled from, third axis
    included."""
    key = third_axis(settings)
    swept = {} if key is None else {"sweep": {key: settings["sweep"][key]}}
    return point_settings(settings) | swept


def sweep(settings: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Yield the labels (r, beta, seed) of every point of an experiment, or of each variant."""
    r, beta, seeds = (settings["sweep"][key] for key in GRID)
    yield from itertools.product(map(str, r), map(str, beta), map(str, range(1, seeds + 1)))


def blocks(
    settings: Mapping[str, Any], config: Mapping[str, Any], last: bool = False
) -> list[tuple[list[str], list[str]]]:
    """Return the labels (betas, seeds) of an experiment's points that one job makes, each beta with
    each seed.

    Where a job has a single beta the label is `{beta}`, which stands for any. Each block has two
    points or more: a point that is left over has a job of its own, and is in no block. Of what is
    run `last` a block has at most half of the betas that are left, so that cores end together.
    """
    axes, usual = settings["sweep"], config.get("betas_per_job", 1)
    labels = [str(number) for number in range(1, axes["seeds"] + 1)]
    by_seed = _chunks(labels, config.get("seeds_per_job", SEEDS_PER_JOB))
    betas, size = [str(beta) for beta in axes["beta"]], settings.get("betas_per_job", usual)
    by_beta = [["{beta}"]] if size == 1 else _chunks(betas, size, 2 if last else 1)
    pairs = [(betas, seeds) for betas in by_beta for seeds in by_seed]
    return [(betas, seeds) for betas, seeds in pairs if len(betas) * len(seeds) > 1]


def _chunks(labels: list[str], size: int, parts: int = 1) -> list[list[str]]:
    """Return labels in chunks of at most `size`, each at most one of `parts` of what is left."""
    chunks = []
    while labels:
        length = min(size, math.ceil(len(labels) / parts))
        chunks.append(labels[:length])
        labels = labels[length:]
    return chunks


def from_text(text: str, source: str, checked: bool = False) -> dict[str, Any]:
    """Return the settings of a point from their JSON; `checked`: they are known to be legal."""
    settings = from_json(text, source)
    return settings if checked else validated(settings, source)


def validated(settings: Mapping[str, Any], source: str) -> dict[str, Any]:
    """Return the settings of a point, `fitted`; raise InputError where they are not legal."""
    from roughgas.config.schema import check_schema

    check_schema(settings, source, "experiment")
    if settings.get(LAYER):
        check_schema(settings[LAYER], f"{source}.{LAYER}", "point/properties/layer")
    settings = fitted(settings, source)
    check_schema(settings, source, "point")
    return settings


def task_from_text(text: str, check: Callable[[Any, str], None]) -> dict[str, Any]:
    """Return the settings of a task from their JSON: of its `study`, which `check` refuses where
    they are illegal, and called so, and of the `experiments` that it may run."""
    from roughgas.config.schema import check_schema

    settings, source = from_json(text, "--settings"), "--settings"
    check_schema(settings, source, "study_task")
    check(settings["study"], f"{source}: study")
    for one, experiment in settings["experiments"].items():
        check_schema(experiment, f"{source}: experiments.{one}", "experiment")
    return settings


def third_axis(settings: Mapping[str, Any]) -> str | None:
    """Return the key of the third axis in the sweep of an experiment, or None."""
    return next((key for key in settings.get("sweep", {}) if key not in GRID), None)


def variants(name: str, settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all variants in a sweep; [name] where it has no third axis."""
    key = third_axis(settings)
    if key is None:
        return [name]
    parameter = parameter_of(key)
    return [f"{name}/{parameter}{label}" for label in settings["sweep"][key]]


def every_variant(name: str, settings: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the settings of these variants by name; those given where there is no third axis."""
    if third_axis(settings) is None:
        return {name: dict(settings)}
    return {one: variant(one, settings) for one in variants(name, settings)}


def variant(name: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of the variant `name`, in the sweep or not, from its experiment's."""
    base, _, folder = name.partition("/")
    key = third_axis(settings)
    if key is None:
        raise InputError("experiment", shown(name), f"be {base} alone, which has no third axis")
    parameter = parameter_of(key)
    if not folder.startswith(parameter):
        legal = f"name a value of {parameter}, such as {variants(base, settings)[0]}"
        raise InputError("experiment", shown(name), legal)
    value = level(folder.removeprefix(parameter), f"{base}: {key}")
    changes = swept_to(settings, key, value) | {"sweep": {key: None}, SWEPT: key}
    return fitted(changed_by(settings, changes), f"experiments.{name}")


def swept_to(settings: Mapping[str, Any], key: str, value: Any) -> dict[str, Any]:
    """Return the change to an experiment's settings that gives its third axis `key` this value."""
    if key == CASE:
        one_of("case", str(value), settings["sweep"][CASE])
        return settings["sweep"][CASE][value] | {CASE: value}
    part, _, parameter = key.rpartition(".")
    if part.startswith(SPECIES):
        species = copy.deepcopy(settings["species"])
        if (changed := holder({"species": species}, part, parameter)) is not None:
            changed[parameter] = value
        return {"species": species}
    if part and part != "schedule":
        return {"effects": {part: {parameter: value}}}
    if isinstance(value, float) and value.is_integer():
        value = int(value)  # as config.yaml would have it
    if part:
        return {part: {parameter: value}}
    if key == "box" and not isinstance(value, str):  # of the same proportions
        width, *others = settings[key]
        value = [value, *(x if x == "open" else x * value / width for x in others)]
    return {key: value}


def swept_value(settings: Mapping[str, Any], key: str) -> Any:
    """Return the value that the settings of a variant have on its third axis; None without it."""
    part, _, parameter = key.rpartition(".")
    if part.startswith(SPECIES):
        return (holder(settings, part, parameter) or {}).get(parameter)
    if part:
        chosen = settings if part == "schedule" else settings["effects"]
        return chosen.get(part, {}).get(parameter)
    return settings["box"][0] if key == "box" else settings.get(key)


def check_one_variant(name: str, settings: Mapping[str, Any]) -> None:
    """Raise an InputError where a point of `name` must say which variant it belongs to."""
    if third_axis(settings) is not None:
        legal = f"be followed by a variant, such as {variants(name, settings)[0]}"
        raise InputError("experiment", shown(name), legal)


def one_of(key: str, value: Any, known: Iterable[str]) -> None:
    """Raise an InputError where `value` is none of the `known` ones."""
    if value not in known:
        raise not_one_of(key, shown(value), sorted(known))
