"""Studies: folders that hold a question beyond the paper each, found by being there.

A folder studies/NAME with a config.yaml is one. It has experiments, which may extend the paper's,
and what scales change in them; from outside its experiment KEY is NAME.KEY. A study that is broken
is left out, with the error that says why: the paper's experiments and other studies stand without
it.

With all studies, and all that a scale changes, written out, a configuration is complete.
"""

import json
import re
from collections.abc import Callable, Mapping
from functools import partial
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Any

from roughgas import config as settings_of
from roughgas.base import InputError, shown
from roughgas.base.files import readme, write_text
from roughgas.config.reading import read_yaml
from roughgas.config.schema import RESERVED, check_ancestors, check_by, check_one, check_schema

FOLDER, TASKS = "studies", "tasks"
HEAD = """\
# The complete configuration of the scale `{scale}`: what experiments inherit from each other, and
# what the scale and the command line change, is written out. Used in place of config.yaml, it gives
# the same results.
"""
USUAL_SCALES = ("paper", "small")
"""Scales for which a study may have changes though the configuration does not have the scale."""


def folders(path: str | Path) -> dict[str, Path]:
    """Return the folders of studies by name, of the present folder and of that of the configuration
    at `path`; the former counts where both have one of a name."""
    places = Path(path).resolve().parent / FOLDER, Path(FOLDER)
    every = [file.parent for place in places for file in sorted(place.glob("*/config.yaml"))]
    return {folder.name: folder for folder in every}


def joined(
    config: Mapping[str, Any], path: str | Path, source: str, only: str | None = None
) -> dict[str, Any]:
    """Return a configuration with all studies, each checked at every scale.

    Their experiments and scales join those of `config`, where NAME.KEY changes an experiment of
    the study NAME. The key FOLDERS has what else there is to each study: `folder`, `title`,
    `experiments` that are swept, `figures` (the experiments that each shows), `movies`, `evidence`
    (the experiments that stand beside published numbers), and `tasks` (their `settings` by scale,
    and their `experiments`), where it has any; the key BROKEN has the arguments of the InputError
    of each that is broken. With `only` one study joins, and those that
    it extends. Raises InputError where `config` changes an experiment that no study has.
    """
    whole = {**config, settings_of.FOLDERS: {}, settings_of.BROKEN: {}}
    if config.get("complete"):
        return whole
    found, broken = _read_all(config, folders(path), only)
    whole |= {settings_of.BROKEN: broken, "experiments": _of_root(config["experiments"])}
    whole["scales"] = {scale: _of_root(one) for scale, one in config["scales"].items()}
    for name in _in_order(found, broken):
        try:
            whole = _with_study(whole, config, name, found[name])
        except InputError as error:
            broken[name] = error.args
    for part in (config["experiments"], *config["scales"].values()):
        for key in part:
            study, _, own = key.partition(".")
            lacks = key not in whole["experiments"] and study not in broken
            lacks = lacks and not (own == TASKS in whole[settings_of.FOLDERS].get(study, {}))
            if "." in key and lacks and only is None:
                legal = "be STUDY.EXPERIMENT of a folder of studies/"
                raise InputError(f"{source}: key", shown(key), legal)
    return whole


def _of_root(part: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in part.items() if "." not in key}


def _source(name: str) -> str:
    return f"{FOLDER}/{name}/config.yaml"


def _read_all(
    config: Mapping[str, Any], known: Mapping[str, Path], only: str | None
) -> tuple[dict[str, dict[str, Any]], dict[str, tuple]]:
    """Return studies as they stand in their folders, names qualified, and errors of the others."""
    found: dict[str, dict[str, Any]] = {}
    broken: dict[str, tuple] = {}
    asked = list(known) if only is None else [only]
    for name in asked:
        if name in known and name not in found and name not in broken:
            try:
                found[name] = _read(name, known[name], config)
                asked += _needs(name, found[name])
            except InputError as error:
                broken[name] = error.args
            except OSError as error:
                broken[name] = _source(name), error.strerror, "be a file to read"
    return found, broken


def _read(name: str, folder: Path, config: Mapping[str, Any]) -> dict[str, Any]:
    """Return the experiments of a study, names qualified, its changes by scale, and all else.

    Its title is the heading of its README.md, its name without one.
    """
    source, root = _source(name), _of_root(config["experiments"])
    study = _checked(name, folder, root)
    own = study.get("experiments", {})

    def qualified(key: str, where: str) -> str:
        base, slash, variant = key.partition("/")
        if "." not in base:
            settings_of.one_of(f"{source}: {where}", base, {**own, **root})
        return f"{name}.{base}{slash}{variant}" if base in own else key

    experiments, scales = {}, {}
    for key, one in own.items():
        if "extends" in one:
            one = one | {"extends": qualified(one["extends"], f"experiments.{key}.extends")}
        experiments[f"{name}.{key}"] = one
    changeable = [*own, *([TASKS] if TASKS in study else [])]
    for scale, changes in study.get("scales", {}).items():
        settings_of.one_of(f"{source}: scale", scale, {*config["scales"], *USUAL_SCALES})
        for key in changes:
            settings_of.one_of(f"{source}: key of scales.{scale}", key, changeable)
        scales[scale] = {f"{name}.{key}": one for key, one in changes.items()}
    heading = re.match(r"# (.+)", readme(folder))
    title = heading[1].strip() if heading else name.replace("_", " ").capitalize()
    about: dict[str, Any] = {"folder": str(folder), "title": title}
    if TASKS in study:
        settings = dict(study[TASKS])
        names = {one: qualified(one, "tasks.experiments") for one in settings.pop("experiments")}
        about[TASKS] = {"settings": settings, "experiments": names}
    of_tasks = about[TASKS]["experiments"].values() if TASKS in about else ()
    about["experiments"] = [key for key in experiments if key not in of_tasks]
    about |= _shown(name, study, about, qualified)
    return {"experiments": experiments, "scales": scales, "about": about}


def _shown(
    name: str,
    study: Mapping[str, Any],
    about: Mapping[str, Any],
    qualified: Callable[[str, str], str],
) -> dict[str, Any]:
    """Return which experiments the figures, movies and evidence of a study show."""

    def these(names: list[str], where: str) -> list[str]:
        return [one if one == TASKS and TASKS in about else qualified(one, where) for one in names]

    every = [key.partition(".")[2] for key in about["experiments"]] + [TASKS] * (TASKS in about)
    usual = {name: every} if Path(about["folder"], "figure.py").exists() else {}
    figures = {
        figure: these(shows, f"figures.{figure}")
        for figure, shows in study.get("figures", usual).items()
    }
    movies = {
        movie: [qualified((shows.split() or [""])[0], f"movies.{movie}"), *shows.split()[1:]]
        for movie, shows in study.get("movies", {}).items()
    }
    beside = every if Path(about["folder"], "evidence.py").exists() else []
    evidence = these(study.get("evidence", beside), "evidence")
    return {"figures": figures, "movies": movies} | ({"evidence": evidence} if evidence else {})


def _checked(name: str, folder: Path, root: Mapping[str, Any]) -> dict[str, Any]:
    """Return config.yaml of a study, checked by itself and for names that others have."""
    source = _source(name)
    check_schema(name, f"{FOLDER}: folder", "name")
    if name in RESERVED or name in root:
        legal = "have another name: the workflow has a rule, a product or an experiment of this one"
        raise InputError(f"{FOLDER}: folder", name, legal)
    study: dict[str, Any] = read_yaml(folder / "config.yaml", source)
    check_schema(study, source, "study_folder")
    if (folder / "claims.yaml").exists():
        claims = f"{FOLDER}/{name}/claims.yaml"
        check_schema(read_yaml(folder / "claims.yaml", claims), claims, "claims")
    if TASKS not in study and "experiments" not in study:
        raise InputError(f"{source}: experiments", "(nothing)", "be given")
    if (folder / "tasks.py").exists() and TASKS not in study:
        raise InputError(f"{source}: tasks", "(nothing)", "be given beside tasks.py")
    for file, key in (("evidence", "evidence"), ("tasks", TASKS), ("results", TASKS)):
        if key in study and not (folder / f"{file}.py").exists():
            legal = f"be there, as config.yaml has {key}"
            raise InputError(f"{FOLDER}/{name}/{file}.py", "(nothing)", legal)
    for key in study.get("experiments", {}).keys() & {*root, TASKS}:
        raise InputError(f"{source}: key of experiments", key, "be no name of config.yaml's own")
    for part in ("figures", "movies"):
        for key in study.get(part, ()):
            if key != name and not key.startswith(f"{name}_"):
                legal = f"be {name} or begin with {name}_"
                raise InputError(f"{source}: key of {part}", key, legal)
    return study


def _needs(name: str, study: Mapping[str, Any]) -> set[str]:
    """Return the other studies whose experiments this one extends or shows."""
    about = study["about"]
    named = [one.get("extends", "") for one in study["experiments"].values()]
    named += [key for shows in about["figures"].values() for key in shows]
    named += about.get("evidence", [])
    named += [shows[0] for shows in about["movies"].values()]
    return {key.partition(".")[0] for key in named if "." in key} - {name}


def _in_order(found: Mapping[str, dict[str, Any]], broken: dict[str, tuple]) -> list[str]:
    """Return names of studies, each after those that it needs; circles are broken."""
    left = dict(found)
    while True:
        needs = {name: _needs(name, study) & left.keys() for name, study in left.items()}
        try:
            return [*TopologicalSorter(needs).static_order()]
        except CycleError as error:
            for name in set(error.args[1]):
                legal = "not extend a study that itself extends this one"
                broken[name] = _source(name), " -> ".join(error.args[1]), legal
                del left[name]


def _with_study(
    whole: Mapping[str, Any], config: Mapping[str, Any], name: str, study: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the configuration with one more study; raise InputError where that is illegal."""
    changes = config["experiments"]
    together = partial(settings_of.merged, removing=False)
    own = study["experiments"].items()
    experiments = {key: together(one, changes.get(key, {})) for key, one in own}
    scales = {}
    for scale, known in whole["scales"].items():
        own, changes = study["scales"].get(scale, {}), config["scales"][scale]
        keys = [key for key in experiments if key in own or key in changes]
        of_study = {key: together(own.get(key, {}), changes.get(key, {})) for key in keys}
        scales[scale] = {**known, **of_study}
    joined = {**whole, "experiments": whole["experiments"] | experiments, "scales": scales}
    source, about = _source(name), study["about"]
    for key in experiments:
        check_ancestors(key, joined["experiments"], source)
        for scale in scales:
            check_one(joined, key, scale, source)
    used = [("figures", key) for shows in about["figures"].values() for key in shows]
    for part, key in [*used, *(("evidence", key) for key in about.get("evidence", []))]:
        settings_of.one_of(f"{source}: {part}", key, {TASKS, *joined["experiments"]})
    if TASKS in about:
        about = about | {TASKS: about[TASKS] | {"settings": _at_scales(config, name, study)}}
    return joined | {settings_of.FOLDERS: whole[settings_of.FOLDERS] | {name: about}}


def _at_scales(config: Mapping[str, Any], name: str, study: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of a study's tasks by scale, checked."""
    found, key, about = {}, f"{name}.{TASKS}", study["about"]
    for scale, root in config["scales"].items():
        settings = about[TASKS]["settings"]
        for changes in (study["scales"].get(scale, {}), root):
            settings = settings_of.merged(settings, changes.get(key, {}))
        at_scale = "" if scale == config["scale"] else f" at scale {scale}"
        check_tasks(about["folder"], settings, f"{_source(name)}: tasks{at_scale}")
        found[scale] = settings
    return found


def check_tasks(folder: str | Path, settings: Mapping[str, Any], source: str) -> None:
    """Check settings of tasks, which messages call `source`, by schema.yaml of the study in
    `folder`, where there is one.

    It may use the definitions and formats of the schema of config.yaml. Raises InputError.
    """
    path = Path(folder, "schema.yaml")
    if path.exists():
        called = f"{FOLDER}/{path.parent.name}/{path.name}"
        check_by(read_yaml(path, called), settings, source, called)


def tasks(config: Mapping[str, Any], name: str, scale: str) -> dict[str, Any]:
    """Return the settings of a study's tasks at `scale`, as `study`, and those of the experiments
    that they may run, as `experiments`."""
    about = config[settings_of.FOLDERS][name][TASKS]
    settings_of.one_of("scale", scale, about["settings"])
    experiments = {
        local: settings_of.point_settings(settings_of.experiment(config, one, scale))
        for local, one in about["experiments"].items()
    }
    return {"study": about["settings"][scale], "experiments": experiments}


def write_effective(whole: Mapping[str, Any], scale: str, output: str | Path) -> None:
    """Write a configuration whose only scale is `scale`, which changes nothing, as YAML.

    Raises InputError for an unknown scale.
    """
    import yaml

    names = whole["experiments"]
    effective = {
        "complete": True,
        "scale": scale,
        "seeds_per_job": whole.get("seeds_per_job", settings_of.SEEDS_PER_JOB),
        "betas_per_job": whole.get("betas_per_job", 1),
        "experiments": {name: settings_of.experiment(whole, name, scale) for name in names},
    }
    if settings_of.ACCURACY in whole:
        effective[settings_of.ACCURACY] = settings_of.accuracy(whole, scale)
    effective["scales"] = {scale: {}}
    plain = json.loads(json.dumps(effective))  # without anchors
    text = yaml.safe_dump(plain, sort_keys=False, width=100, default_flow_style=None)
    write_text(output, HEAD.format(scale=scale) + text)
