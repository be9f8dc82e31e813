"""A folder of studies/: its config.yaml, read and checked, with full names of experiments.

All functions raise InputError, with a text of one line, for illegal settings and missing files.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from roughgas.base import InputError, check_one_of, short_repr, without_markup
from roughgas.base.fields import OwnSettings, RawSettings
from roughgas.base.files import MAX_TABLE_BYTES, MAX_TEXT_BYTES, content_of, name_in_study, readme
from roughgas.base.reading import read_yaml
from roughgas.config import study_code
from roughgas.config.configuration import PAPER, Configuration
from roughgas.config.packaged import SHIPPED_STUDIES, STUDIES_FOLDER, STUDIES_OF_ACCURACY
from roughgas.config.study import BEYOND, LONG, PAPERS, Study, StudyTasks

TASKS = "tasks"
MAX_TITLE_LENGTH = 200
MAX_BYTES = {
    "README.md": MAX_TEXT_BYTES,
    ".yaml": MAX_TEXT_BYTES,
    ".py": MAX_TEXT_BYTES,
    ".csv": MAX_TABLE_BYTES,
}
"""Maximum size in bytes of the files of a study, by name or suffix."""
USUAL_SCALES = ("paper", "small", LONG)
"""Scales that a study may change even if the configuration lacks them."""


def config_name(name: str) -> str:
    """Return the name of config.yaml of the study `name` for messages."""
    return f"{STUDIES_FOLDER}/{name}/config.yaml"


def root_experiments(configuration: Configuration) -> list[str]:
    """Return the names of the experiments that belong to no study."""
    return [name for name in configuration.experiments if "." not in name]


class StudyFile(NamedTuple):
    """Content of config.yaml of a study, with full names of experiments, STUDY.EXPERIMENT."""

    study: Study
    experiments: Mapping[str, RawSettings]
    scales: Mapping[str, Mapping[str, RawSettings]]
    """Changes at each scale to experiments and to NAME.tasks."""
    tasks: OwnSettings | None = None
    """Settings of its tasks, before changes of a scale."""

    @property
    def shows_root_only(self) -> bool:
        """Whether the study only shows experiments of the root's config.yaml, in figures."""
        return self.tasks is None and not self.experiments

    @property
    def has_accuracy_settings(self) -> bool:
        """Whether the key `accuracy` of a configuration changes the settings of its tasks."""
        name = Path(self.study.folder).name
        return name in STUDIES_OF_ACCURACY and bool(self.study.modules)


class _Names:
    """Translates names of experiments in config.yaml of a study to full names, STUDY.EXPERIMENT."""

    def __init__(
        self,
        study: str,
        experiments: Iterable[str],
        root: Iterable[str] | None,
        data: Iterable[str],
    ) -> None:
        """Store the legal names in the `study`.

        `experiments` are names in the study, `root` legal names of the root's experiments (None:
        any), `data` names that stand for the data of tasks.
        """
        self.study, self.experiments, self.data = study, set(experiments), tuple(data)
        self.root = None if root is None else set(root)

    def full(self, name: str, key: str) -> str:
        """Return the full name of an experiment, or of a variant; names of the root stay.

        `key` is the key in config.yaml for messages. Raises InputError for an unknown experiment.
        """
        base, slash, variant = name.partition("/")
        if "." not in base and self.root is not None:
            check_one_of(f"{config_name(self.study)}: {key}", base, self.experiments | self.root)
        return f"{self.study}.{base}{slash}{variant}" if base in self.experiments else name

    def all_full(self, names: Sequence[str], key: str) -> list[str]:
        """Return the full names of experiments; names that stand for data of tasks stay."""
        return [name if name in self.data else self.full(name, key) for name in names]


class WrittenStudy:
    """config.yaml of a study as written in its folder."""

    def __init__(self, name: str, folder: Path, folders: Mapping[str, Path]) -> None:
        """Read config.yaml of the study `name` in `folder`, and check its form.

        `folders` has the folders of all studies by name. Raises InputError for illegal settings
        and illegal code, OSError as `content_of` does.
        """
        self.name, self.folder, self.source = name, folder, config_name(name)
        from roughgas.config.forms import Name, StudyForm, check_name

        check_name(Name, name, f"{STUDIES_FOLDER}: folder")
        _check_files(folder)
        raw = read_yaml(folder / "config.yaml", self.source, pipes=False)
        study_code.use([folder, *(folders[other] for other in _extended(raw) if other in folders)])
        StudyForm.check(raw, self.source)
        self.raw = {key: content for key, content in raw.items() if content is not None}
        self.experiments: dict[str, RawSettings] = self.raw.get("experiments", {})
        self.modules: list[str] = self.raw.get("modules", [])
        self.paper: str = self.raw.get("paper", "")
        self.heading: str = self.raw.get("heading", PAPERS if self.paper else BEYOND)

    @property
    def has_tasks(self) -> bool:
        """Whether config.yaml has settings of tasks."""
        return TASKS in self.raw

    @property
    def shows_root_only(self) -> bool:
        """Whether the study only shows experiments of the root's config.yaml, in figures."""
        return not self.has_tasks and "experiments" not in self.raw

    @property
    def data(self) -> list[str]:
        """Names that stand for the data of tasks in figures: TASKS, or the names of modules."""
        return self.modules or [TASKS] * self.has_tasks

    def check(self, root: Sequence[str]) -> None:
        """Raise InputError for names that are taken, and for missing files.

        `root` are the names of experiments that belong to no study.
        """
        from roughgas.config.forms import RESERVED
        from roughgas.config.json_schema import check_schema

        is_shipped = self.name in SHIPPED_STUDIES
        if (self.name in RESERVED and not is_shipped) or self.name in root:
            rule = "have another name: the workflow has a rule, a product or an experiment"
            raise InputError(f"{STUDIES_FOLDER}: folder", self.name, f"{rule} of this one")
        for form in ("claims", "findings"):
            path = self.folder / f"{form}.yaml"
            source = f"{STUDIES_FOLDER}/{self.name}/{form}.yaml"
            if path.exists():
                check_schema(read_yaml(path, source, pipes=False), source, form)
        self._check_completeness()
        for key in self.experiments.keys() & {*root, TASKS, *self.modules}:
            legal = "be no name of config.yaml's own"
            raise InputError(f"{self.source}: key of experiments", key, legal)
        for products in ("figures", "movies"):
            for key in self.raw.get(products, ()) if self.name != PAPER else ():
                if key != self.name and not key.startswith(f"{self.name}_"):
                    legal = f"be {self.name} or begin with {self.name}_"
                    raise InputError(f"{self.source}: key of {products}", key, legal)

    def _check_completeness(self) -> None:
        """Raise InputError for missing keys of config.yaml, and for missing files of its keys."""
        if self.shows_root_only and "figures" not in self.raw:
            legal = "be given, or tasks, or figures of experiments of the root's config.yaml"
            raise InputError(f"{self.source}: experiments", "(nothing)", legal)
        if (self.folder / "tasks.py").exists() and not self.has_tasks:
            raise InputError(f"{self.source}: tasks", "(nothing)", "be given beside tasks.py")
        files = [("evidence", "evidence"), *((module, "modules") for module in self.modules)]
        if not self.modules:
            files += [("tasks", TASKS), ("results", TASKS)]
        for file, key in files:
            if key in self.raw and not (self.folder / f"{file}.py").exists():
                legal = f"be there, as config.yaml has {key}"
                raise InputError(f"{STUDIES_FOLDER}/{self.name}/{file}.py", "(nothing)", legal)
        if self.modules:
            self._check_modules()

    def _check_modules(self) -> None:
        """Raise InputError unless each module, and nothing else, has settings of tasks."""
        settings = {key: content for key, content in self.raw.get(TASKS, {}).items()}
        settings.pop("experiments", None)
        for module in self.modules:
            if module not in settings:
                raise InputError(f"{self.source}: {TASKS}.{module}", "(nothing)", "be given")
        for key in settings:
            check_one_of(f"{self.source}: key of {TASKS}", key, self.modules)

    def file(self, configuration: Configuration) -> StudyFile:
        """Return the content of config.yaml, checked, with full names of its experiments.

        Its title is the heading of its README.md, or else its name. Raises InputError for
        contradictions among its files, or to `configuration`.
        """
        root = root_experiments(configuration)
        self.check(root)
        legal_root_names = None if self.shows_root_only else root
        names = _Names(self.name, self.experiments, legal_root_names, self.data)
        experiments: dict[str, RawSettings] = {}
        for key, settings in self.experiments.items():
            if settings.get("extends"):
                parent = names.full(settings["extends"], f"experiments.{key}.extends")
                settings = {**settings, "extends": parent}
            experiments[f"{self.name}.{key}"] = settings
        tasks = dict(self.raw[TASKS]) if self.has_tasks else None
        task_names = (tasks or {}).pop("experiments", None)
        of_tasks = {key: names.full(key, "tasks.experiments") for key in task_names or ()}
        swept = [key for key in experiments if key not in of_tasks.values()]
        figures = self.figures(names, swept)
        if self.shows_root_only:
            swept = [*dict.fromkeys(key for shows in figures.values() for key in shows)]
        study = Study(
            folder=str(self.folder),
            title=_title(self.name, self.folder),
            experiments=swept,
            tasks=None if tasks is None else StudyTasks({}, of_tasks if task_names else None),
            figures=figures,
            movies=self.movies(names),
            evidence=self.evidence(names, swept),
            long=self.long(names),
            heading=self.heading,
            paper=self.paper,
            documents=self.raw.get("documents", ()),
            modules=self.modules,
        )
        self._check_scales(configuration)
        scales = {
            scale: {f"{self.name}.{key}": changes[key] for key in changes}
            for scale, changes in self.raw.get("scales", {}).items()
        }
        return StudyFile(study, experiments, scales, tasks)

    def _check_scales(self, configuration: Configuration) -> None:
        """Raise InputError for unknown scales, and for unknown experiments in their changes."""
        changeable = [*self.experiments, *([TASKS] if self.has_tasks else [])]
        for scale, changes in self.raw.get("scales", {}).items():
            legal_scales = {*configuration.scales, *USUAL_SCALES}
            check_one_of(f"{self.source}: scale", scale, legal_scales)
            for key in changes:
                check_one_of(f"{self.source}: key of scales.{scale}", key, changeable)

    def figures(self, names: _Names, swept: Sequence[str]) -> dict[str, list[str]]:
        """Return the full names of the experiments in each figure, by the figure's name.

        `names` translates names of experiments to full names. By default one figure, named after
        the study, shows all of the `swept` experiments and the tasks, if the folder has figure.py.
        """
        all_experiments = self._all_shown(swept)
        default = {self.name: all_experiments} if (self.folder / "figure.py").exists() else {}
        return {
            figure: names.all_full(shows, f"figures.{figure}")
            for figure, shows in self.raw.get("figures", default).items()
        }

    def movies(self, names: _Names) -> dict[str, list[str]]:
        """Return, for each movie by name, the full name of its experiment and its options.

        `names` translates names of experiments to full names.
        """
        return {
            movie: [names.full((words.split() or [""])[0], f"movies.{movie}"), *words.split()[1:]]
            for movie, words in self.raw.get("movies", {}).items()
        }

    def evidence(self, names: _Names, swept: Sequence[str]) -> list[str]:
        """Return the full names of the experiments that are compared with published numbers.

        `names` translates names of experiments to full names. By default these are all of the
        `swept` experiments, if the folder has evidence.py.
        """
        default = self._all_shown(swept) if (self.folder / "evidence.py").exists() else []
        return names.all_full(self.raw.get("evidence", default), "evidence")

    def long(self, names: _Names) -> list[str]:
        """Return the full names of the experiments that the scale LONG changes; `tasks` stays.

        `names` translates names of experiments to full names. [] for a study without long.py.
        """
        changed = self.raw.get("scales", {}).get(LONG, ()) if self.has_long_table else ()
        return [key if key == TASKS else names.full(key, f"scales.{LONG}") for key in changed]

    @property
    def has_long_table(self) -> bool:
        """Whether the study has long.py, which makes its table long.csv."""
        return (self.folder / "long.py").exists()

    def _all_shown(self, swept: Sequence[str]) -> list[str]:
        """Return the names in the study of `swept` experiments, and the names for task data."""
        return [key.removeprefix(f"{self.name}.") for key in swept] + self.data


def _extended(raw: Any) -> list[str]:
    """Return the names of other studies whose experiments the study `raw`, unchecked, extends."""
    experiments = raw.get("experiments") if isinstance(raw, Mapping) else None
    if not isinstance(experiments, Mapping):
        return []
    parents = [
        str(settings.get("extends"))
        for settings in experiments.values()
        if isinstance(settings, Mapping)
    ]
    return sorted({parent.partition(".")[0] for parent in parents if "." in parent})


def _title(name: str, folder: Path) -> str:
    """Return the heading of README.md of the study `name` as plain text, or else its name in words.

    Raises InputError for a heading of more than MAX_TITLE_LENGTH characters.
    """
    heading = re.match(r"# (.+)", readme(folder))
    title = without_markup(heading[1]) if heading else ""
    if len(title) > MAX_TITLE_LENGTH:
        legal = f"be of {MAX_TITLE_LENGTH} characters at most"
        raise InputError(f"{STUDIES_FOLDER}/{name}/README.md: heading", short_repr(title), legal)
    return title or name.replace("_", " ").capitalize()


def _check_files(folder: Path) -> None:
    """Raise InputError for a file of a study that is not regular or too large.

    Raises OSError if it cannot be read. Later reads then cannot block on a pipe, or read an endless
    device.
    """
    for path in sorted(folder.iterdir()):
        largest = MAX_BYTES.get("README.md" if path.name == "README.md" else path.suffix)
        if largest and path.exists():
            content_of(path, name_in_study(path), largest)
