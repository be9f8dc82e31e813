"""Effects and observables of studies: the files effects.py and observables.py of their folders.

effects.py registers effects (`roughgas.register_effect`); each public function in observables.py is
an observable. Experiments of the study, and experiments that extend these, may name them: `use`
makes the names of some studies legal in this process, and the names of all others illegal.
"""

import hashlib
import inspect
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

from roughgas.base import InputError, as_input_errors
from roughgas.base.files import (
    forget_study,
    is_imported,
    name_in_study,
    study_module,
    study_package,
)

# effects and observables are imported inside functions: few studies have these files

if TYPE_CHECKING:
    from roughgas.observables import Observable

EFFECTS, OBSERVABLES = "effects", "observables"
"""The two files, without their suffix, and the keys of experiments that name their content."""


class StudyCode(NamedTuple):
    """The effects and the observables of a study, by name."""

    source_hash: str
    effects: Mapping[str, tuple[type, str | None]]
    """The class of each, and the name of the effect that it acts before."""
    observables: "Mapping[str, type[Observable]]"


known: dict[str, Path] = {}
"""Folders of all studies that this process has seen, by name, for advice in messages."""
_loaded: dict[Path, StudyCode] = {}
_in_use: dict[Path, StudyCode] = {}


def use(folders: Iterable[str | Path]) -> None:
    """Make the names of the studies in `folders` legal in settings, and no other study's.

    Files that have changed since are read again. Raises InputError, which names the file, for code
    that cannot be imported, is no legal effect or observable, or has a name that is taken.
    """
    paths = [Path(folder).resolve() for folder in folders if _has_code(Path(folder))]
    codes = {path: code for path in paths if (code := _current(path)) is not None}
    if list(codes) == paths and codes == _in_use:
        return
    _forget()
    try:
        for path in paths:
            _in_use[path] = _current(path) or _load(path)
            _add(path, _in_use[path])
    except InputError:
        _forget()
        raise


def used_files(effects: Iterable[str], observables: Iterable[str]) -> list[tuple[Path, str]]:
    """Return the folder and the name of each file in use that defines some of these names."""
    names = {EFFECTS: {*effects}, OBSERVABLES: {*observables}}
    return [
        (folder, file)
        for folder, code in _in_use.items()
        for file in names
        if names[file] & getattr(code, file).keys()
    ]


def options(effects: Iterable[str], observables: Iterable[str]) -> list[str]:
    """Return the options of `roughgas run` that make these names legal beside --settings."""
    return options_of(folder for folder, _ in used_files(effects, observables))


def options_of(folders: Iterable[str | Path]) -> list[str]:
    """Return the options --studies FOLDER ... for studies that have code; [] without any.

    Folders within the present one are relative to it.
    """
    paths = dict.fromkeys(Path(folder).resolve() for folder in folders if _has_code(Path(folder)))
    here = Path.cwd().resolve()
    relative = [path.relative_to(here) if path.is_relative_to(here) else path for path in paths]
    return ["--studies", *map(str, relative)] if relative else []


def advice(name: str) -> str:
    """Return advice on an illegal name of an effect or an observable that a study defines, or "".

    The files are not imported.
    """
    definition = rf"(?m)^def {re.escape(name)}\(|register_effect\(\s*['\"]{re.escape(name)}['\"]"
    for study, folder in known.items():
        for file in (EFFECTS, OBSERVABLES):
            path = folder / f"{file}.py"
            if path.is_file() and re.search(definition, path.read_text("utf-8", "replace")):
                return f"; {name_in_study(path)} has one for experiments of {study} alone"
    return ""


def _has_code(folder: Path) -> bool:
    """Return whether a study has a file of effects or of observables."""
    return any((folder / f"{file}.py").exists() for file in (EFFECTS, OBSERVABLES))


def _current(folder: Path) -> StudyCode | None:
    """Return the code of a study if it is loaded, and its files are unchanged since."""
    code = _loaded.get(folder)
    is_current = code and is_imported(folder) and code.source_hash == _source_hash(folder)
    return code if is_current else None


def _source_hash(folder: Path) -> str:
    """Return a hash of all Python files of a study, which these two may import."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob("*.py")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def _load(folder: Path) -> StudyCode:
    """Import the code of a study anew, and return it, unchecked."""
    forget_study(folder)
    source_hash, package = _source_hash(folder), study_package(folder)
    effects: dict[str, Any] = {}
    if (folder / f"{EFFECTS}.py").exists():
        from roughgas.effects import OF_STUDIES

        OF_STUDIES.pop(package, None)
        study_module(folder, EFFECTS)
        effects = OF_STUDIES.get(package, {})
    observables: dict[str, Any] = {}
    if (folder / f"{OBSERVABLES}.py").exists():
        from roughgas.observables import OF_STUDIES as REGISTERED
        from roughgas.observables.plugin import study_observable

        REGISTERED.pop(package, None)
        module, file = study_module(folder, OBSERVABLES), _name(folder, OBSERVABLES)
        observables = {
            name: study_observable(name, function, file, source_hash)
            for name, function in _public_functions(module)
        }
        observables |= REGISTERED.get(package, {})
    _loaded[folder] = StudyCode(source_hash, effects, observables)
    return _loaded[folder]


def _public_functions(module: ModuleType) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield the name and the function of each public function that a module defines."""
    for name, function in vars(module).items():
        is_of_module = getattr(function, "__module__", None) == module.__name__
        if is_of_module and inspect.isfunction(function) and not name.startswith("_"):
            yield name, function


def _add(folder: Path, code: StudyCode) -> None:
    """Add the effects and the observables of a study; raise InputError for an illegal one."""
    if code.effects:
        from roughgas.effects import add_effect

        with as_input_errors(_name(folder, EFFECTS), "be legal"):
            for name, (kind, before) in code.effects.items():
                add_effect(name, kind, before)
    if code.observables:
        from roughgas.observables import add_observable

        with as_input_errors(_name(folder, OBSERVABLES), "be legal"):
            for name, kind in code.observables.items():
                add_observable(name, kind)


def _forget() -> None:
    """Forget the effects and the observables of all studies in use."""
    for code in _in_use.values():
        if code.effects:
            from roughgas.effects import EFFECTS as LEGAL
            from roughgas.effects import forget_effect

            for name, (kind, _) in code.effects.items():
                if LEGAL.get(name) is kind:
                    forget_effect(name)
        if code.observables:
            from roughgas.observables import OBSERVABLES as LEGAL_OBSERVABLES
            from roughgas.observables import forget_observable

            for name, kind in code.observables.items():
                if LEGAL_OBSERVABLES.get(name) is kind:
                    forget_observable(name)
    _in_use.clear()


def _name(folder: Path, file: str) -> str:
    """Return the name of a file of a study for messages."""
    return name_in_study(folder / f"{file}.py")
