"""Loads configurations: a file, merged over the active configuration, and its studies.

All functions raise InputError, with a text of one line, for unknown names and illegal values.
"""

from difflib import get_close_matches
from pathlib import Path

from roughgas.base import MIN_SIMILARITY, InputError, short_repr, unknown_name_error
from roughgas.base.fields import RawSettings
from roughgas.config.configuration import Configuration, WrittenConfiguration
from roughgas.config.packaged import SHIPPED
from roughgas.config.study_folders import folders, with_studies
from roughgas.config.written import WrittenExperiment


def active_config_path() -> Path:
    """Return the path of the configuration that commands use by default.

    It is config.yaml in the present folder, or else the packaged one.
    """
    local_path = Path("config.yaml")
    return local_path if local_path.exists() else SHIPPED


class ConfigurationFiles:
    """The written configuration at a path, and the files that it was merged from.

    A file that does not stand alone is merged over the active configuration; if this is
    config.yaml in the present folder and does not stand alone either, it is merged over the
    packaged one.
    """

    def __init__(self, path: str | Path, overrides: WrittenConfiguration | None = None) -> None:
        """Read the files; merge the changes `overrides` of a command line over them, unchecked.

        Raises OSError where a file cannot be read.
        """
        self.source, self.files = Path(path).name, [Path(path)]
        written = WrittenConfiguration.from_file(path)
        for base in (active_config_path(), SHIPPED):
            is_read = any(base.resolve() == file.resolve() for file in self.files)
            if not (written.stands_alone or is_read):
                written = written.over(WrittenConfiguration.from_file(base))
                self.files.insert(0, base)
        self.written = written.with_defaults()
        if overrides:
            overrides.check_values()
            self.written = overrides.over(self.written)
            self.source += " with the command line's changes"


def default_scale(path: str | Path) -> str:
    """Return the name of the default scale of the configuration at `path`.

    Raises OSError where the file cannot be read.
    """
    scale: str = ConfigurationFiles(path).written.raw["scale"]
    return scale


def load(path: str | Path, overrides: RawSettings | None = None) -> Configuration:
    """Return the configuration at `path`, with `overrides` merged in and all studies, checked.

    `overrides` is a mapping like the file's content. The file may hold just changes to the active
    configuration. Raises OSError where it cannot be read.
    """
    files = ConfigurationFiles(path, WrittenConfiguration(overrides) if overrides else None)
    files.written.check(files.source, folders(*files.files))
    configuration = files.written.configuration(files.source)
    return with_studies(configuration, files.files).checked()


def load_experiment(path: str | Path, name: str, scale: str) -> WrittenExperiment:
    """Return the experiment, or variant, `name` at `scale` from the configuration at `path`.

    Other experiments and scales are checked in form only. Raises OSError where the file cannot be
    read.
    """
    files = ConfigurationFiles(path)
    files.written.check(files.source, folders(*files.files))
    configuration = files.written.configuration(files.source)
    base = name.partition("/")[0]
    if "." not in base and base not in configuration.experiments:
        raise _unknown(base, configuration, with_studies(configuration, files.files))
    study = _study_of(base, configuration)
    configuration = with_studies(configuration, files.files, only=study)
    if base in configuration.experiments:
        configuration.check_ancestors(base)
    written = configuration.experiment(name, scale)
    configuration.check_experiment(base, scale)
    return written


def _unknown(
    name: str, configuration: Configuration, complete_configuration: Configuration
) -> InputError:
    """Return the InputError of an unknown experiment `name` in `configuration`, with suggestions.

    These include experiments of studies, by their full names, in `complete_configuration`.
    """
    error = unknown_name_error("experiment", short_repr(name), sorted(configuration.experiments))
    of_studies = {
        full: full.rpartition(".")[2] for full in complete_configuration.experiments if "." in full
    }
    suggestions = [full for full, key in of_studies.items() if name and name in key]
    similar_names = (
        () if suggestions else get_close_matches(name, of_studies.values(), cutoff=MIN_SIMILARITY)
    )
    suggestions += [full for full, key in of_studies.items() if key in similar_names]
    if suggestions:
        error.legal += f"; or of a study: {', '.join(suggestions)}"
    elif of_studies:
        error.legal += f"; or one of {len(of_studies)} of studies (`roughgas experiments`)"
    return error


def _study_of(name: str, configuration: Configuration) -> str:
    """Return the study of an experiment, or of its first ancestor in a study; "" if none is."""
    chain: set[str] = set()
    while "." not in name and name in configuration.experiments and name not in chain:
        chain.add(name)
        name = configuration.experiments[name].get("extends") or ""
    return name.rpartition(".")[0]
