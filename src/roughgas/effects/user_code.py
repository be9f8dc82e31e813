"""Checks and source hashes of effects and observables that users define in their own files.

Machine code is cached by a hash of its sources (compiling/cache_folders.py). For a user's effect
these are its file, and the code and constants that it imports.
"""

import hashlib
import keyword
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from roughgas.base import InputError, short_repr
from roughgas.base.fields import Settings, has_numbers_and_words
from roughgas.compiling.jit import Compiled
from roughgas.kernel.hooks import OBSERVING_HOOKS, Hooks

NAME = re.compile("[a-z][a-z0-9_]*")
RESERVED = frozenset({"contacts", "schedule", "species", "stages"})
"""Names with another meaning in settings, sweeps or energy balances."""
PASSIVE_HOOKS = frozenset({*OBSERVING_HOOKS, "sums"})
"""Hooks of a passive effect."""
PACKAGE_HOOKS = frozenset(
    {"acceleration", "image_shift", "transfer", "observe_flight", "speed_gain"}
)
"""Hooks whose effects the package refers to by name: positions depend on gravity and shear, paths
are counted once, and contacts add the speed of a single effect."""


def check_name(category: str, name: object, taken: bool) -> None:
    """Raise InputError for an illegal or `taken` name of an effect or an observable.

    `category` is "effect" or "observable".
    """
    if not isinstance(name, str) or not NAME.fullmatch(name) or keyword.iskeyword(name):
        legal = "have a name of lower-case letters, digits and _, a letter first"
        raise InputError(category, short_repr(name), legal)
    if taken or name in RESERVED:
        raise InputError(category, name, f"have a name that is free: there is {name} already")


def is_same_definition(kind: Any, other_kind: Any) -> bool:
    """Return whether two classes are the same definition in a module that was re-imported."""
    return (kind.__module__, kind.__qualname__) == (other_kind.__module__, other_kind.__qualname__)


def check_class(name: str, kind: Any) -> None:
    """Raise InputError for a class that is no effect, or has hooks reserved for the package.

    `name` is the effect's, for the error.
    """
    key = f"effect {name}"
    hooks, settings = getattr(kind, "hooks", None), getattr(kind, "settings", None)
    if not (isinstance(kind, type) and issubclass(kind, tuple) and hasattr(kind, "_fields")):
        raise InputError(key, short_repr(kind), "be a class, a NamedTuple")
    if not (isinstance(hooks, Hooks) and isinstance(settings, type)):
        legal = "have a struct of settings and hooks, by roughgas.effects.settings.register"
        raise InputError(key, kind.__name__, legal)
    check_settings(key, settings)
    names = {hook for hook, value in hooks._asdict().items() if value}
    if not names:
        raise InputError(key, kind.__name__, "have a hook (roughgas.kernel.hooks)")
    if reserved := sorted(names & PACKAGE_HOOKS):
        raise InputError(
            key, f"with {reserved[0]}", f"leave {reserved[0]} to effects of the package"
        )
    if is_passive(kind) and (acting := sorted(names - PASSIVE_HOOKS)):
        observing = next(name for name in OBSERVING_HOOKS if name in names)
        legal = f"be without {acting[0]}: an effect with {observing} only looks"
        raise InputError(key, f"with {acting[0]}", legal)


def check_settings(key: str, settings: type[Any], base: type[Settings] = Settings) -> None:
    """Raise InputError for a class that is no struct of settings, or a field of an illegal type.

    `key` names the effect or observable in errors; `base` is the class to derive the struct from.
    """
    if not issubclass(settings, base):
        raise InputError(f"{key}: settings", settings.__name__, f"be derived from {base.__name__}")
    legal = "have fields of numbers, words and lists of these (roughgas.base.fields)"
    try:
        is_plain = has_numbers_and_words(settings)
    except (AttributeError, TypeError):
        is_plain = False
    if not is_plain:
        raise InputError(f"{key}: settings", settings.__name__, legal)


def is_passive(kind: Any) -> bool:
    """Return whether an effect's class only observes, and changes nothing."""
    return any(getattr(kind.hooks, name) for name in OBSERVING_HOOKS)


def source_hash(name: str, kind: Any) -> str:
    """Return a digest of the sources of an effect, 16 hexadecimal digits.

    `name` is the effect's, for errors; `kind` its class. Sources are the files of its hooks, the
    files in the same folder that they import, and numbers that they import from anywhere. Raises
    InputError for functions that are in no file, and for files that have changed since they were
    imported.
    """
    functions = [getattr(value, "py_func", value) for value in kind.hooks if callable(value)]
    namespaces: dict[str, Namespace] = {}
    for namespace in (
        *(function.__globals__ for function in functions),
        _namespace_of(kind.__module__),
    ):
        if namespace and not _is_of_package(namespace):
            _add_namespaces(namespace, namespaces)
    if not namespaces or not all(Path(file).is_file() for file in namespaces):
        raise InputError(f"effect {name}", kind.__name__, "be defined in a file that is imported")
    digest = hashlib.sha256(kind.__module__.encode())  # cached machine code imports its types
    for file, namespace in sorted(namespaces.items(), key=lambda pair: Path(pair[0]).name):
        text = Path(file).read_bytes()
        if not _matches_text(text, namespace):
            legal = "be imported anew (importlib.reload): it has changed since"
            raise InputError(f"effect {name}: file", Path(file).name, legal)
        digest.update(Path(file).name.encode() + b"\0" + text)
        digest.update(repr(sorted(_numeric_constants(namespace))).encode())
    return digest.hexdigest()[:16]


Namespace = Mapping[str, Any]
"""The attributes of a module by name."""


def _namespace_of(module: Any) -> Namespace:
    """Return the attributes of an imported module, from its name; {} if there is none."""
    return vars(sys.modules[module]) if isinstance(module, str) and module in sys.modules else {}


def _add_namespaces(namespace: Namespace, namespaces: dict[str, Namespace]) -> None:
    """Add a module's namespace to `namespaces`, by its file, and its imports' from the same folder.

    Functions that compiled code calls count wherever their files are.
    """
    file = namespace.get("__file__") or ""
    if file in namespaces:
        return
    namespaces[file] = namespace
    for value in [*namespace.values()]:
        if isinstance(value, Compiled):
            imported: Namespace = value.py_func.__globals__
        else:
            is_module = isinstance(value, ModuleType)
            imported = _namespace_of(
                value.__name__ if is_module else getattr(value, "__module__", None)
            )
            imported = (
                imported if _origin(imported) and _origin(imported) == _origin(namespace) else {}
            )
        if imported and not _is_of_package(imported):
            _add_namespaces(imported, namespaces)


def _matches_text(text: bytes, namespace: Namespace) -> bool:
    """Return whether the compiled functions of a module match the source text of its file.

    The functions then keep their texts. Machine code of an old text must not be cached by the hash
    of a new one.
    """
    compiled = [value for value in namespace.values() if isinstance(value, Compiled)]
    defined_here = [value for value in compiled if value.py_func.__globals__ is namespace]
    try:
        codes = {*_nested_codes(compile(text, "", "exec", dont_inherit=True))}
    except (SyntaxError, ValueError):
        return False
    for function in defined_here:
        function.read_source()
    return all(function.py_func.__code__ in codes for function in defined_here)


def _nested_codes(code: CodeType) -> Iterator[CodeType]:
    """Yield a code object and all code objects nested in it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _nested_codes(constant)


def _is_of_package(namespace: Namespace) -> bool:
    """Return whether a module is a part of roughgas; modules of its studies are none."""
    return str(namespace.get("__name__")).partition(".")[0] == "roughgas"


def _origin(namespace: Namespace) -> tuple[str, ...]:
    """Return the folder of a module or of its top-level package, and an installed package's name.

    () for a module without a Python file.
    """
    file = Path(namespace.get("__file__") or "").resolve()
    if file.suffix != ".py":
        return ()
    root, *inner = str(namespace.get("__name__")).split(".")
    folder = file.parents[min(len(inner) + (file.name == "__init__.py"), len(file.parents) - 1)]
    return (str(folder), root) if folder.name.endswith("-packages") else (str(folder),)


def _numeric_constants(namespace: Namespace) -> Iterator[tuple[str, str]]:
    """Yield (name, value as text) of numbers and tuples of numbers: constants of compiled code."""
    for name, value in namespace.items():
        entries = value if type(value) is tuple else (value,)
        if not name.startswith("__") and all(isinstance(x, int | float) for x in entries):
            yield name, repr(value)
