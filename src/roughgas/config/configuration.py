"""A configuration: experiments and scales from files, read, merged and checked.

A scale is a named set of changes to experiments, such as "paper" or "small": sizes, lengths, seeds.
All functions raise InputError, with a text of one line, for unknown names and illegal values. In
it, `source` is the name of the configuration.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from roughgas.base import InputError, Record, check_one_of, merged, short_repr, sorted_json
from roughgas.base.fields import OwnSettings, RawSettings
from roughgas.base.reading import read_yaml
from roughgas.config import study_code
from roughgas.config.packaged import STUDIES_OF_ACCURACY
from roughgas.config.shaken_layer import LAYER
from roughgas.config.study import Study
from roughgas.config.written import PACKING, SEEDS_PER_JOB, WrittenExperiment

# effects and schedules are imported inside functions: listing experiments needs neither

ACCURACY = "accuracy"
"""Key of a configuration that changes the settings of accuracy."""
PAPER = "paper"
"""Scale of a configuration that names none."""
REQUIRED_KEYS = {"particles", "effects", "schedule", "sweep"}
"""Keys required in a complete experiment."""
SIZE_KEYS = {"box", PACKING, LAYER}
"""Keys for the size of the box; a complete experiment has at least one."""


@dataclass(frozen=True)
class Configuration:
    """Experiments by name, their scales, and studies, all checked in form.

    A complete configuration (`complete`) inherits nothing, and has the experiments of all studies.
    """

    source: str
    """Name of the configuration in messages."""
    scale: str
    experiments: Mapping[str, RawSettings]
    """Experiments as files write them; an experiment of a study is called STUDY.EXPERIMENT."""
    scales: Mapping[str, Mapping[str, RawSettings]]
    """Changes to experiments at each scale."""
    accuracy: RawSettings | None = None
    """Changes to the settings of accuracy and coverage, by module; in a complete configuration all
    of these settings."""
    seeds_per_job: int = SEEDS_PER_JOB
    betas_per_job: int = 1
    complete: bool = False
    studies: Mapping[str, Study] = field(default_factory=dict)
    refused: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)
    """Arguments of the InputError of each broken study."""
    folders: Mapping[str, str] = field(default_factory=dict)
    """Folders of studies by name, where experiments find their effects and observables."""

    @property
    def text(self) -> str:
        """The complete configuration, with its studies but without its source, as JSON."""
        files = {"source", "folders"}
        return sorted_json({key: value for key, value in asdict(self).items() if key not in files})

    def experiment(self, name: str, scale: str) -> WrittenExperiment:
        """Return the experiment `name` at a scale, merged with the experiments that it extends.

        `name` may also name a variant, EXPERIMENT/PARAMETERLABEL, even of a value outside the
        sweep. The extended experiments are at the same scale. Numbers in its sweep are spelled as
        in paths. The effects and observables of its studies are then legal, and no other study's.
        """
        base, slash, _ = name.partition("/")
        self.use_names(base)
        written = self._merged(base, scale).spelled()
        if not slash:
            return written
        from roughgas.config.forms import PointForm

        variant = written.variant(name)
        PointForm.check(variant.raw, name)
        return variant

    def use_names(self, name: str) -> None:
        """Make the effects and observables of the studies of an experiment legal, and no others."""
        study_code.use(self.code_folders(name))

    def code_folders(self, name: str) -> list[str]:
        """Return the folders of the studies whose effects and observables an experiment may name.

        These are its study, and the studies of experiments that it extends.
        """
        studies = studies_of(name.partition("/")[0], self.experiments)
        return [self.folders[study] for study in studies if study in self.folders]

    def _merged(self, name: str, scale: str) -> WrittenExperiment:
        """Return an experiment at a scale, merged with those it extends, labels as in files."""
        study = name.partition(".")[0]
        if "." in name and study in self.refused:
            raise InputError(*self.refused[study])
        check_one_of("experiment", name, self.experiments)
        check_one_of("scale", scale, self.scales)
        raw = dict(self.experiments[name])
        parent = raw.pop("extends", None)
        inherited = dict(self._merged(parent, scale).raw) if parent else {}
        inherited.pop("description", None)
        written = WrittenExperiment(inherited)
        for changes in (raw, self.scales[scale].get(name, {})):
            written = written.changed(changes).fitted(f"experiments.{name}")
        return written

    def accuracy_at(self, scale: str) -> dict[str, OwnSettings]:
        """Return the settings of the studies of accuracy and coverage at a scale, by module."""
        check_one_of("scale", scale, self.scales)
        studies = [self.studies[name] for name in STUDIES_OF_ACCURACY if name in self.studies]
        return {
            module: study.tasks.settings[scale][module]
            for study in studies
            for module in study.modules
            if study.tasks is not None
        }

    def check_ancestors(self, name: str, source: str = "") -> None:
        """Raise InputError if the experiment `name` extends unknown experiments, or itself.

        Messages name `source`, by default the configuration's.
        """
        chain = [name]
        while parent := self.experiments[chain[-1]].get("extends"):
            key = f"{source or self.source}: experiments.{chain[-1]}.extends"
            check_one_of(key, parent, self.experiments)
            if parent in chain:
                legal = "be an experiment that does not itself build on this one"
                raise InputError(key, parent, legal)
            chain.append(parent)

    def check_experiment(self, name: str, scale: str, source: str = "") -> None:
        """Check an experiment and its variants at a scale, merged with the experiments it extends.

        Raises InputError; messages name `source`, by default the configuration's.
        """
        written = self.experiment(name, scale)
        at_scale = "" if scale == self.scale else f" at scale {scale}"
        key = f"{source or self.source}: experiments"
        written.check_third_axis(f"{key}.{name}{at_scale}")
        for variant, settings in written.every_variant(name).items():
            settings.experiment(f"{key}.{variant}{at_scale}")
        written.check_grid(f"{key}.{name}{at_scale}")

    def checked(self) -> "Configuration":
        """Check all experiments at all scales, and return the configuration itself.

        Experiments of studies were checked when the studies were added, unless it is complete.
        """
        for name in self.experiments:
            self.check_ancestors(name)
        for scale in self.scales:
            for name in self.experiments:
                if "." not in name or self.complete:
                    self.check_experiment(name, scale)
        return self


def studies_of(name: str, experiments: Record) -> list[str]:
    """Return the studies of an experiment `name` and of the experiments that it extends.

    `experiments` has experiments by name, as written, unchecked; none need be there.
    """
    chain: list[str] = []
    parent: Any = name
    while isinstance(parent, str) and parent not in chain:
        chain.append(parent)
        settings = experiments.get(parent)
        parent = settings.get("extends") if isinstance(settings, Mapping) else None
    return list(dict.fromkeys(name.partition(".")[0] for name in chain if "." in name))


@dataclass(frozen=True)
class WrittenConfiguration:
    """A configuration as files write it; the mapping `raw` may lack keys or have illegal ones."""

    raw: RawSettings

    @classmethod
    def from_file(cls, path: str | Path) -> "WrittenConfiguration":
        """Return the configuration in the file at `path`, unchecked.

        The scale that it names is added to `scales` where it lacks these. Raises InputError for a
        file that is no mapping, OSError where it cannot be read.
        """
        raw = read_yaml(path)
        if not isinstance(raw, dict):
            raise InputError(Path(path).name, short_repr(raw), "hold the key experiments")
        written = cls(raw)
        return written.with_defaults() if "scale" in raw else written

    def with_defaults(self) -> "WrittenConfiguration":
        """Return the configuration with a default `scale`, and default `scales` with that scale."""
        keys = {key: value for key, value in self.raw.items() if value is not None}
        scale = keys.get("scale", PAPER)
        return WrittenConfiguration({"scale": scale, "scales": {str(scale): {}}, **keys})

    @property
    def stands_alone(self) -> bool:
        """Whether each of its experiments is complete or extends another of its experiments.

        Then the file needs no other configuration beneath it. Illegal settings are left to `check`.
        """
        experiments = self.raw.get("experiments", {})
        if self.raw.get("complete") or not isinstance(experiments, Mapping):
            return True
        settings = [
            experiment for experiment in experiments.values() if isinstance(experiment, Mapping)
        ]
        parents = {str(experiment["extends"]) for experiment in settings if "extends" in experiment}
        own_names = {name for name in experiments if "." not in name}  # others change studies
        is_closed = parents | experiments.keys() <= own_names
        return bool(own_names) and is_closed and all(map(_replaces_experiment, settings))

    def over(self, base: "WrittenConfiguration") -> "WrittenConfiguration":
        """Return the configuration merged over the configuration `base`, both unchecked.

        An experiment that is complete, or extends another one, replaces the experiment of its name
        in `base` and the changes of its scales; any other experiment is merged. A complete
        configuration inherits nothing.
        """
        raw = self.raw
        if raw.get("complete") and "experiments" in raw:
            return self.with_defaults()
        experiments, inherited = raw.get("experiments"), dict(base.raw)
        if isinstance(experiments, Mapping) and isinstance(inherited.get("experiments"), Mapping):
            replaced = {
                name
                for name, settings in experiments.items()
                if "." not in name and _replaces_experiment(settings)
            }
            inherited["experiments"] = _without(inherited["experiments"], replaced)
            if isinstance(inherited.get("scales"), Mapping):
                inherited["scales"] = {
                    scale: _without(changes, replaced)
                    for scale, changes in inherited["scales"].items()
                }
        return WrittenConfiguration(inherited)._changed(self)

    def _changed(self, overrides: "WrittenConfiguration") -> "WrittenConfiguration":
        """Return the configuration with the configuration `overrides` merged in.

        A setting of an experiment that they remove is kept as None, since the experiment may be a
        study's, or inherit the setting.
        """
        changes, merged_mappings = dict(overrides.raw), {}
        for key, depth in {"experiments": 1, "scales": 2}.items():
            if isinstance(changes.get(key), Mapping):
                merged_mappings[key] = _merged_keeping_none(
                    self.raw.get(key), changes.pop(key), depth
                )
        return WrittenConfiguration({**merged(self.raw, changes), **merged_mappings})

    def check_values(self) -> None:
        """Raise InputError where changes leave a required key without a value."""
        for key in ("scale", "scales", "experiments"):
            if key in self.raw and self.raw[key] in (None, ""):
                raise InputError(key, "(nothing)", "have a value on the command line")

    def check(self, source: str, folders: Mapping[str, Path] | None = None) -> None:
        """Check the form of the configuration, which messages call `source`.

        Nothing is merged, so that missing and contradictory settings are not noticed. `folders` are
        the folders of studies by name, whose effects and observables experiments may name. Raises
        InputError.
        """
        from roughgas.config.forms import ConfigurationForm
        from roughgas.config.json_schema import check_schema

        def use_names(name: str) -> None:
            """Make the names of the studies of an experiment legal."""
            studies = studies_of(name, self.raw["experiments"])
            study_code.use(folders[study] for study in studies if folders and study in folders)

        ConfigurationForm.check(self.raw, source, use_names)
        for changes in (self.raw, *self.raw["scales"].values()):
            if changes.get(ACCURACY) is not None:
                check_schema(changes[ACCURACY], f"{source}: accuracy", ACCURACY)
        scales, experiments = self.raw["scales"], self.raw["experiments"]
        check_one_of(f"{source}: scale", self.raw.get("scale", ""), scales)
        for scale, changes in scales.items():
            for name in changes:
                if "." not in name or self.raw.get("complete"):
                    check_one_of(f"{source}: key of scales.{scale}", name, [*experiments, ACCURACY])

    def configuration(self, source: str) -> Configuration:
        """Return the Configuration, called `source`; its form must have been checked."""
        keys = {key: value for key, value in self.raw.items() if value is not None}
        return Configuration(source=source, **keys)


def _replaces_experiment(experiment: Any) -> bool:
    """Return whether an experiment is complete or extends another one, and so is no change.

    `experiment` is the value in a file, of any type.
    """
    if not isinstance(experiment, Mapping) or "extends" in experiment:
        return isinstance(experiment, Mapping)
    return REQUIRED_KEYS <= experiment.keys() and bool(SIZE_KEYS & experiment.keys())


def _without(settings: Any, names: set[str]) -> Any:
    """Return a mapping without the keys `names`; another value unchanged, for the check."""
    if not isinstance(settings, Mapping):
        return settings  # the check refuses it
    return {name: content for name, content in settings.items() if name not in names}


def _merged_keeping_none(base: Any, changes: RawSettings, depth: int) -> dict[str, Any]:
    """Return `base` with `changes` merged in, keeping None below the outer `depth` mappings.

    In these mappings, None removes a key.
    """
    base = base if isinstance(base, Mapping) else {}
    if not depth:
        return merged(base, changes, removing=False)
    inner = {
        key: _merged_keeping_none(base.get(key), content, depth - 1)
        for key, content in changes.items()
        if isinstance(content, Mapping)
    }
    outer = {key: content for key, content in changes.items() if key not in inner}
    return merged(base, outer) | inner
