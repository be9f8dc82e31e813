"""Studies: each folder studies/NAME with a config.yaml is a study, discovered automatically.

It has experiments, which may extend the paper's, and changes to them at each scale; elsewhere its
experiment KEY is called NAME.KEY. A broken study is left out, and its error recorded: the paper's
experiments and other studies do not depend on it.

A configuration that includes all studies and the changes of its scale is complete.
"""

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Any

from roughgas.base import InputError, check_one_of, merged, short_repr
from roughgas.base.fields import OwnSettings, RawSettings
from roughgas.base.files import LEGAL_FILE, write_text
from roughgas.base.reading import read_yaml
from roughgas.config import study_code
from roughgas.config.configuration import ACCURACY, Configuration
from roughgas.config.packaged import SHIPPED_STUDIES, STUDIES_FOLDER, shipped_path
from roughgas.config.study import TaskSettings
from roughgas.config.written_study import (
    TASKS,
    StudyFile,
    WrittenStudy,
    config_name,
    root_experiments,
)

HEAD = """\
# The complete configuration of the scale `{scale}`: what experiments inherit from each other, and
# what the scale and the command line change, is written out. Used in place of config.yaml, it gives
# the same results.
"""


def folders(*files: str | Path) -> dict[str, Path]:
    """Return the folders of studies by name, from studies/ beside the `files` of a configuration.

    Studies of the present folder are included, and the package's SHIPPED_STUDIES. Among folders
    with the same name the present folder's takes precedence, then the last file's.
    """
    search_folders = (
        *(Path(file).resolve().parent / STUDIES_FOLDER for file in files),
        Path(STUDIES_FOLDER),
    )
    candidates = [shipped_path(STUDIES_FOLDER) / name for name in SHIPPED_STUDIES]
    candidates += [
        folder for search_folder in search_folders for folder in sorted(search_folder.glob("*"))
    ]
    by_name = {
        folder.name: folder for folder in candidates if folder.is_dir() and _may_be_study(folder)
    }
    study_code.known.update(by_name)
    return by_name


def _may_be_study(folder: Path) -> bool:
    """Return whether a folder has a config.yaml, or cannot be read, which is then reported."""
    return not os.access(folder, os.R_OK | os.X_OK) or (folder / "config.yaml").exists()


def with_studies(
    configuration: Configuration, files: Iterable[str | Path], only: str | None = None
) -> Configuration:
    """Return a configuration, read from `files`, with all studies, each checked at every scale.

    Their experiments and scales are added to `configuration`, whose NAME.KEY changes an experiment
    of the study NAME. With `only`, the name of a study, this study is added with the studies that
    it needs. Raises InputError where `configuration` changes an experiment that no study has, or
    makes settings of accuracy illegal.

    A complete configuration includes the settings of accuracy; only the studies of accuracy, and
    those without experiments or tasks, are added to it.
    """
    folders_by_name = folders(*files)
    study_files, refused = _read_all(configuration, folders_by_name, only)
    folder_names = {name: str(folder) for name, folder in folders_by_name.items()}
    configuration = replace(configuration, folders=folder_names)
    if only is None:
        _check_accuracy(configuration, study_files.values())
    if configuration.complete:
        study_files = {
            name: file
            for name, file in study_files.items()
            if file.shows_root_only or file.has_accuracy_settings
        }
        refused = {name: refused[name] for name in SHIPPED_STUDIES if name in refused}
        return _with_all(configuration, configuration, study_files, refused)
    combined = replace(
        configuration,
        experiments={
            name: configuration.experiments[name] for name in root_experiments(configuration)
        },
        scales={
            scale: {key: settings for key, settings in changes.items() if "." not in key}
            for scale, changes in configuration.scales.items()
        },
    )
    combined = _with_all(combined, configuration, study_files, refused)
    if only is None:
        _check_changes(configuration, combined, combined.refused)
    return combined


def _with_all(
    combined: Configuration,
    configuration: Configuration,
    study_files: Mapping[str, StudyFile],
    refused: dict[str, tuple[Any, ...]],
) -> Configuration:
    """Return the configuration `combined` with all legal studies, and the errors of broken studies.

    `configuration` has the changes to experiments of studies. `refused` holds the arguments of the
    InputError of each broken study, and is extended in place.
    """
    for name in _in_order(study_files, refused):
        try:
            combined = _with_study(combined, configuration, name, study_files[name])
        except InputError as error:
            refused[name] = error.args
    return replace(combined, refused=refused)


def _check_changes(
    configuration: Configuration, combined: Configuration, refused: Mapping[str, tuple[Any, ...]]
) -> None:
    """Raise InputError for changes to an experiment, or to tasks, that no study has.

    `configuration` has the changes, `combined` the studies; changes to the studies in `refused`,
    which are broken, pass.
    """
    for changes in (configuration.experiments, *configuration.scales.values()):
        for key in changes:
            name, dot, experiment = key.partition(".")
            has_tasks = name in combined.studies and combined.studies[name].tasks is not None
            is_known = key in combined.experiments or name in refused
            if dot and not is_known and not (experiment == TASKS and has_tasks):
                legal = "be STUDY.EXPERIMENT of a folder of studies/"
                raise InputError(f"{configuration.source}: key", short_repr(key), legal)


def _read_all(
    configuration: Configuration, folders_by_name: Mapping[str, Path], only: str | None
) -> tuple[dict[str, StudyFile], dict[str, tuple[Any, ...]]]:
    """Return the studies as read from their folders, and errors of broken studies, by name.

    With `only`, the name of a study, it reads this study and the studies that it needs. An error is
    given by the arguments of its InputError.
    """
    study_files: dict[str, StudyFile] = {}
    refused: dict[str, tuple[Any, ...]] = {}
    pending = list(folders_by_name) if only is None else [only]
    for name in pending:
        if name in folders_by_name and name not in study_files and name not in refused:
            try:
                written = WrittenStudy(name, folders_by_name[name], folders_by_name)
                study_files[name] = written.file(configuration)
                pending += _needs(name, study_files[name])
            except InputError as error:
                refused[name] = error.args
            except OSError as error:
                refused[name] = str(error.filename or config_name(name)), error.strerror, LEGAL_FILE
    return study_files, refused


def _needs(name: str, file: StudyFile) -> set[str]:
    """Return the names of the other studies whose experiments the study `name` extends or shows."""
    study = file.study
    names = [settings.get("extends") or "" for settings in file.experiments.values()]
    names += [key for shows in (study.figures or {}).values() for key in shows]
    names += study.evidence
    names += [words[0] for words in (study.movies or {}).values()]
    return {key.partition(".")[0] for key in names if "." in key} - {name}


def _in_order(
    study_files: Mapping[str, StudyFile], refused: dict[str, tuple[Any, ...]]
) -> list[str]:
    """Return the names of studies in the order of their dependencies; cycles are refused.

    `refused` is extended in place by the arguments of their InputErrors.
    """
    remaining = dict(study_files)
    while True:
        needs = {name: _needs(name, file) & remaining.keys() for name, file in remaining.items()}
        try:
            return [*TopologicalSorter(needs).static_order()]
        except CycleError as error:
            for name in set(error.args[1]):
                legal = "not extend a study that itself extends this one"
                refused[name] = config_name(name), " -> ".join(error.args[1]), legal
                del remaining[name]


def _with_study(
    combined: Configuration, configuration: Configuration, name: str, file: StudyFile
) -> Configuration:
    """Return the configuration `combined` with the study `name`, read from `file`, added.

    `configuration` has the changes to its experiments. Raises InputError if the study is illegal.
    """
    merge_keeping_none = partial(merged, removing=False)
    changes = configuration.experiments
    experiments = {
        key: merge_keeping_none(settings, changes.get(key, {}))
        for key, settings in file.experiments.items()
    }
    scales = {}
    for scale, scale_changes in combined.scales.items():
        in_study, changes = file.scales.get(scale, {}), configuration.scales[scale]
        keys = [key for key in experiments if key in in_study or key in changes]
        of_study = {
            key: merge_keeping_none(in_study.get(key, {}), changes.get(key, {})) for key in keys
        }
        scales[scale] = {**scale_changes, **of_study}
    source, study = config_name(name), file.study
    combined = replace(
        combined,
        experiments={**combined.experiments, **experiments},
        scales=scales,
        studies={**combined.studies, name: study},
    )
    for key in experiments:
        combined.check_ancestors(key, source)
        for scale in scales:
            combined.check_experiment(key, scale, source)
    references = [("figures", key) for shows in (study.figures or {}).values() for key in shows]
    legal_references = {TASKS, *study.modules, *combined.experiments}
    for products, key in [*references, *(("evidence", key) for key in study.evidence)]:
        if not file.shows_root_only:
            check_one_of(f"{source}: {products}", key, legal_references)
    if study.tasks is not None:
        settings = _task_settings(configuration, name, file)
        study = replace(study, tasks=replace(study.tasks, settings=settings))
    return replace(combined, studies={**combined.studies, name: study})


def _task_settings(
    configuration: Configuration, name: str, file: StudyFile
) -> dict[str, OwnSettings]:
    """Return the checked settings of the tasks of the study `name`, by scale."""
    settings_at, checked = {}, {}
    for scale in configuration.scales:
        settings = _written_settings(configuration, name, file, scale)
        at_scale = "" if scale == configuration.scale else f" at scale {scale}"
        source = f"{config_name(name)}: tasks{at_scale}"
        for module in file.study.modules:
            if module not in settings:
                raise InputError(f"{source}.{module}", "(nothing)", "be given")
        settings_at[scale] = checked[source] = settings
    check_tasks(file.study.folder, checked)
    return settings_at


def _written_settings(
    configuration: Configuration, name: str, file: StudyFile, scale: str
) -> OwnSettings:
    """Return the settings of the tasks of the study `name` at a scale, unchecked.

    Settings for a scale take precedence over settings for all scales, and the configuration's over
    the study's. Settings of accuracy in a complete configuration inherit nothing from the study.
    """
    key, root, at_scale = f"{name}.{TASKS}", configuration.scales[scale], file.scales.get(scale, {})
    accuracy, accuracy_at_scale = (
        {module: changes[module] for module in file.study.modules if module in changes}
        if file.has_accuracy_settings
        else {}
        for changes in (configuration.accuracy or {}, root.get(ACCURACY) or {})
    )
    layers: list[OwnSettings] = [accuracy, accuracy_at_scale]
    if not (configuration.complete and configuration.accuracy is not None):
        study, scaled, changed = file.tasks or {}, at_scale.get(key, {}), root.get(key, {})
        layers = [study, accuracy, scaled, changed, accuracy_at_scale]
    settings: OwnSettings = {}
    for layer in layers:
        settings = merged(settings, layer)
    return settings


def _check_accuracy(configuration: Configuration, study_files: Iterable[StudyFile]) -> None:
    """Raise InputError if changes in `configuration` make the settings of accuracy illegal."""
    for file in study_files:
        for scale, root in configuration.scales.items():
            if file.has_accuracy_settings and (configuration.accuracy or root.get(ACCURACY)):
                folder = Path(file.study.folder)
                settings = _written_settings(configuration, folder.name, file, scale)
                source = f"{configuration.source}: accuracy at scale {scale}"
                check_tasks(folder, {source: settings})


def check_tasks(
    folder: str | Path, settings: Mapping[str, OwnSettings], module: str | None = None
) -> None:
    """Check settings of tasks against schema.yaml of the study in `folder`, if it exists.

    The keys of `settings` are names of settings in messages, such as those of several scales. With
    `module`, the settings of this module are checked against its property there. The schema may use
    definitions and formats of the schema of config.yaml. Raises InputError.
    """
    from roughgas.config.json_schema import check_by

    path = Path(folder, "schema.yaml")
    if path.exists():
        schema_name = f"{STUDIES_FOLDER}/{path.parent.name}/{path.name}"
        schema = read_yaml(path, schema_name, pipes=False)
        if module is not None:
            schema = {"$defs": schema.get("$defs", {}), **schema["properties"][module]}
        check_by(schema, settings, schema_name)


def task_settings(
    configuration: Configuration, name: str, scale: str, module: str | None = None
) -> TaskSettings:
    """Return the settings at `scale` of the tasks of the study `name`, and of experiments they run.

    With `module` they are the settings of this module's tasks. If tasks may run all experiments,
    these are called KEY instead of NAME.KEY, and those with effects or observables of a study are
    left out. Raises InputError for an unknown scale or module.
    """
    study = configuration.studies[name]
    tasks = study.tasks
    assert tasks is not None
    check_one_of("scale", scale, tasks.settings)
    settings = tasks.settings[scale]
    if module is not None:
        check_one_of("module", module, study.modules)
        settings = settings[module]
    full_names = tasks.experiments
    if full_names is None:
        full_names = {
            full_name.rpartition(".")[2]: full_name for full_name in configuration.experiments
        }
    experiments: dict[str, RawSettings] = {}
    for task_name, full_name in full_names.items():
        raw = configuration.experiment(full_name, scale).for_points().raw
        names = raw.get("effects") or (), raw.get("observables") or ()
        if tasks.experiments is not None or not study_code.used_files(*names):
            experiments[task_name] = raw
    return TaskSettings(settings, experiments)


def write_effective(configuration: Configuration, scale: str, output: str | Path) -> None:
    """Write a configuration at `scale` as YAML, complete, with this as its only, empty scale.

    What experiments inherit is written out. Raises InputError for an unknown scale.
    """
    import yaml

    names = configuration.experiments
    effective: dict[str, Any] = {
        "complete": True,
        "scale": scale,
        "seeds_per_job": configuration.seeds_per_job,
        "betas_per_job": configuration.betas_per_job,
        "experiments": {name: configuration.experiment(name, scale).raw for name in names},
    }
    if accuracy := configuration.accuracy_at(scale):
        effective[ACCURACY] = accuracy
    effective["scales"] = {scale: {}}
    plain = json.loads(json.dumps(effective))  # without anchors
    text = yaml.safe_dump(plain, sort_keys=False, width=100, default_flow_style=None)
    write_text(output, HEAD.format(scale=scale) + text)
