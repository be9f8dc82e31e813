"""config.yaml: read, checked against its schema, and merged into one experiment at one scale.

An experiment whose sweep has a third axis (axis.py) consists of variants, named EXPERIMENT/VARIANT.
Everything illegal raises an InputError, whose text is one line naming key, value and what is legal.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from roughgas.base.errors import InputError, not_one_of
from roughgas.config.axis import (
    SWEPT,
    check_axis,
    check_one_variant,
    common,
    every_variant,
    third_axis,
    variant,
    variants,
)
from roughgas.config.labels import level, restitution, roughness, seed
from roughgas.config.schema import check_schema, first_repeated, shown

__all__ = [
    "SWEPT",
    "as_text",
    "blocks",
    "check",
    "check_one_variant",
    "common",
    "every_variant",
    "experiment",
    "from_text",
    "kernel_settings",
    "level",
    "load",
    "merged",
    "pilot_settings",
    "point_settings",
    "restitution",
    "roughness",
    "seed",
    "showcase",
    "study",
    "sweep",
    "variants",
]

SOURCE = "config.yaml"
SHOWCASE, ACCURACY = "showcase", "accuracy"
SEEDS_PER_JOB = 4
NOT_OF_A_POINT = ("description", "sweep")
"""Settings of an experiment that do not concern any single point of it."""
REPLACED = {
    "sweep": ("seeds",),
    "schedule": ("equilibrate", "measure", "replicas", "relaxation_times", "plateau"),
}
"""Settings that an experiment with a `target_stderr` does without."""


def load(path: str | Path, overrides: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The configuration at `path`, `overrides` (from a command line) merged into it, checked.

    Raises InputError for anything illegal, OSError where the file cannot be read.
    """
    from roughgas.config.reading import read_yaml

    source = Path(path).name
    config = read_yaml(path)
    if not isinstance(config, dict):
        raise InputError(source, shown(config), "hold the keys scale, experiments, scales")
    if overrides:
        source += " with the command line's changes"
        config = merged(config, overrides)
    check(config, source)
    return config


def check(config: Mapping[str, Any], source: str = SOURCE) -> None:
    """Raise an InputError for the first illegal thing in `config`, if there is any."""
    check_schema(config, source)
    known, scales = config["experiments"], config["scales"]
    _one_of(f"{source}: scale", config["scale"], scales)
    for name in (SHOWCASE, ACCURACY):
        if name in known:
            raise InputError(f"{source}: key of experiments", name, "be another name")
    for name in known:
        _check_ancestors(name, known, source)
    for name, settings in known.items():
        _check_target(settings, f"{source}: experiments.{name}")
    for scale, changes in scales.items():
        for name, settings in changes.items():
            if name in known:
                _check_target(settings, f"{source}: scales.{scale}.{name}")
            _one_of(f"{source}: key of scales.{scale}", name, [*known, SHOWCASE, ACCURACY])
        check_schema(showcase(config, scale), f"{source}: {SHOWCASE} at scale {scale}", "filmed")
        check_schema(_studies(config, scale), f"{source}: {ACCURACY} at scale {scale}", "studied")
        for name in known:
            at_scale = "" if scale == config["scale"] else f" at scale {scale}"
            _check_complete(name, experiment(config, name, scale), source, at_scale)


def experiment(config: Mapping[str, Any], name: str, scale: str) -> dict[str, Any]:
    """The experiment `name` at `scale`: what it extends, its own settings, the scale's changes.

    What it extends is taken as it is at this scale. `name` may be that of a variant, whether or not
    its value is in the sweep. Raises InputError for unknown names, and for illegal values of a
    variant.
    """
    base, slash, _ = name.partition("/")
    settings = _experiment(config, base, scale)
    if not slash:
        return settings
    chosen = variant(name, settings)
    check_schema(chosen, name, "experiment")
    return chosen


def _experiment(config: Mapping[str, Any], name: str, scale: str) -> dict[str, Any]:
    _one_of("experiment", name, config["experiments"])
    _one_of("scale", scale, config["scales"])
    own = dict(config["experiments"][name])
    parent = own.pop("extends", None)
    settings = _experiment(config, parent, scale) if parent else {}
    settings.pop("description", None)
    found = merged(merged(settings, own), config["scales"][scale].get(name, {}))
    return _without_lengths(found) if "target_stderr" in found else found


def _without_lengths(settings: Mapping[str, Any]) -> dict[str, Any]:
    replaced = {
        part: {key: value for key, value in settings[part].items() if key not in names}
        for part, names in REPLACED.items()
        if part in settings
    }
    return dict(settings) | replaced


def showcase(config: Mapping[str, Any], scale: str) -> dict[str, Any]:
    """The settings of the showcase at `scale`. Raises InputError for an unknown scale."""
    _one_of("scale", scale, config["scales"])
    settings = merged(config[SHOWCASE], config["scales"][scale].get(SHOWCASE, {}))
    return {key: value for key, value in settings.items() if key not in NOT_OF_A_POINT}


def study(config: Mapping[str, Any], name: str, scale: str) -> dict[str, Any]:
    """The settings of a study of accuracy at `scale`, as `study`, and those of the experiments that
    it may run, as `experiments`. Raises InputError for unknown names."""
    _one_of("scale", scale, config["scales"])
    settings = _studies(config, scale)
    _one_of("study", name, settings)
    experiments = {
        one: point_settings(experiment(config, one, scale)) for one in config["experiments"]
    }
    return {"study": settings[name], "experiments": experiments}


def _studies(config: Mapping[str, Any], scale: str) -> dict[str, Any]:
    return merged(config[ACCURACY], config["scales"][scale].get(ACCURACY, {}))


def merged(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`base` with `changes` merged in, key by key at every depth; a change to None takes away."""
    result = dict(base)
    for key, change in changes.items():
        if change is None:
            result.pop(key, None)
        elif isinstance(change, Mapping):
            inner = result.get(key)
            result[key] = merged(inner if isinstance(inner, Mapping) else {}, change)
        else:
            result[key] = change
    return result


def point_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of an experiment that shape its points, whichever of them are asked for."""
    return {key: value for key, value in settings.items() if key not in NOT_OF_A_POINT}


def pilot_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of an experiment that shape the pilots of its points, whatever the target."""
    return merged(_without_lengths(point_settings(settings)), {"target_stderr": None})


def kernel_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of an experiment that its kernels are compiled from: with its third axis."""
    key = third_axis(settings)
    swept = {} if key is None else {"sweep": {key: settings["sweep"][key]}}
    return pilot_settings(settings) | swept


def sweep(settings: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """The labels (r, beta, seed) of every point of an experiment, or of each of its variants."""
    axes = settings["sweep"]
    for r in axes["r"]:
        for beta in axes["beta"]:
            for number in range(1, axes["seeds"] + 1):
                yield str(r), str(beta), str(number)


def blocks(axes: Mapping[str, Any], config: Mapping[str, Any]) -> list[tuple[list[str], list[str]]]:
    """The labels (betas, seeds) of swept points that one job makes, each beta with each seed.

    Where a job has a single beta the label is `{beta}`, which stands for any. Each block has two
    points or more: one that is left over is a job of its own, and in no block.
    """
    labels = [str(number) for number in range(1, axes.get("seeds", 0) + 1)]
    by_seed = _chunks(labels, config.get("seeds_per_job", SEEDS_PER_JOB))
    size = config.get("betas_per_job", 1)
    by_beta = [["{beta}"]] if size == 1 else _chunks([str(beta) for beta in axes["beta"]], size)
    pairs = [(betas, seeds) for betas in by_beta for seeds in by_seed]
    return [(betas, seeds) for betas, seeds in pairs if len(betas) * len(seeds) > 1]


def _chunks(labels: list[str], size: int) -> list[list[str]]:
    return [labels[first : first + size] for first in range(0, len(labels), size)]


def as_text(settings: Mapping[str, Any]) -> str:
    """Settings as JSON on one line, the same for equal settings."""
    return json.dumps(settings, sort_keys=True, separators=(",", ":"))


def from_text(
    text: str, source: str, checked: bool = False, parts: Iterable[str] = ("experiment", "point")
) -> dict[str, Any]:
    """The settings of a point from their JSON; `checked` says that they are known to be legal.

    `parts` are the definitions of the schema that they must else fulfil.
    """
    try:
        settings = json.loads(text)
    except ValueError as error:
        raise InputError(source, shown(text), "be JSON") from error
    if not checked:
        for part in parts:
            check_schema(settings, source, part)
    return settings


def _check_complete(name: str, settings: Mapping[str, Any], source: str, at_scale: str) -> None:
    where = f"{source}: experiments.{name}{at_scale}"
    check_axis(settings, where)
    for one, chosen in every_variant(name, settings).items():
        for part in ("experiment", "point") if one != name else ("point",):
            check_schema(chosen, f"{source}: experiments.{one}{at_scale}", part)
    check_schema(settings, where, "swept")
    for key, value_of in (("r", restitution), ("beta", roughness)):
        repeated = first_repeated(settings["sweep"][key], value_of)
        if repeated is not None:
            raise InputError(f"{where}.sweep.{key}", shown(repeated), "be given once")


def _check_target(settings: Mapping[str, Any], where: str) -> None:
    """Raise an InputError where a target and what it replaces are given side by side."""
    if "target_stderr" not in settings:
        return
    for part, names in REPLACED.items():
        for name in names:
            if settings.get(part, {}).get(name) is not None:
                value = settings[part][name]
                raise InputError(f"{where}.{part}.{name}", value, "not stand beside target_stderr")


def _check_ancestors(name: str, known: Mapping[str, Any], source: str) -> None:
    """Raise an InputError where the chain of `extends` breaks or runs in a circle."""
    seen = [name]
    while parent := known[seen[-1]].get("extends"):
        key = f"{source}: experiments.{seen[-1]}.extends"
        _one_of(key, parent, known)
        if parent in seen:
            raise InputError(key, parent, "be an experiment that does not itself build on this one")
        seen.append(parent)


def _one_of(key: str, value: Any, known: Iterable[str]) -> None:
    if value not in known:
        raise not_one_of(key, shown(value), sorted(known))
