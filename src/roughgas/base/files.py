"""Atomic writing and bounded reading of files; modules of studies; hashes of a result's code.

The workflow makes a result again when the hash of its code changes: of the modules it uses, and of
all that these import. The hash includes files of the same name, such as json_schema.yaml beside
json_schema.py, and the versions of roughgas and numba.
"""

import ast
import errno
import functools
import hashlib
import importlib
import os
import re
import stat
import sys
import tempfile
import types
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path
from typing import Any

from roughgas.base import InputError, __version__, as_input_errors
from roughgas.base.text import without_comments


@contextmanager
def atomic_write(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path to write to; rename it to `path` on success, delete it otherwise.

    Parent folders are created. The name, `path`.PID.tmp, is unique to this process: a job that
    outlives a killed workflow must not spoil the file of its successor. After SIGKILL the file
    remains until the next writer of `path` finds its process gone.
    Raises OSError, which names `path`, if the folder cannot be written or the disk is full.
    """
    path = Path(path)
    if path.exists() and not path.is_file():  # root could replace even /dev/null
        raise OSError(errno.EINVAL, "exists and is not a file", str(path))
    draft = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    path.parent.mkdir(parents=True, exist_ok=True)
    remove_dead_drafts(path)
    try:
        yield draft
        with open(draft, "rb") as file:
            os.fsync(file.fileno())  # or a power cut could leave the new name without the content
        os.replace(draft, path)
    except OSError as error:
        if error.filename in (None, str(draft)):
            error.filename = str(path)
        raise
    finally:
        draft.unlink(missing_ok=True)


def check_writable(path: str | Path) -> None:
    """Raise OSError if `path`, a file or a folder that need not exist yet, could not be written.

    To be called before long work, so that it is not in vain.
    """
    path = Path(path).absolute()
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OSError(errno.EINVAL, "exists and is not a file", str(path))
    folder = next(folder for folder in (path, *path.parents) if folder.is_dir())
    try:
        tempfile.TemporaryFile(dir=folder).close()  # for root all of /proc has permission
    except OSError as error:
        raise OSError(error.errno, "cannot be written", str(path)) from None


def remove_dead_drafts(path: Path) -> None:
    """Remove the temporary files of `atomic_write` for `path` whose processes have ended."""
    for draft in path.parent.glob(f"{path.name}.*.tmp"):
        if not _is_alive(draft.name.split(".")[-2]):
            draft.unlink(missing_ok=True)


def _is_alive(process: str) -> bool:
    """Return whether the process with this id exists and can still write, unlike a zombie."""
    try:
        os.kill(int(process), 0)
        state = Path(f"/proc/{process}/stat").read_bytes().rpartition(b")")[2].split()[0]
    except (ValueError, ProcessLookupError):
        return False
    except OSError:  # another user's process, or a system without /proc
        return True
    return state not in (b"Z", b"X")


def write_text(path: str | Path, text: str) -> None:
    """Write `text` (UTF-8, line ends as given) to `path`, whole or not at all."""
    with atomic_write(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="")


MAX_TEXT_BYTES = 1_000_000
"""Largest size of text written by hand: a README, YAML, Python."""
MAX_TABLE_BYTES = 100_000_000
"""Largest size of a table, or of a list of radii."""
LEGAL_FILE = "be a file to read"


def content_of(
    path: str | Path, name: str, largest: int = MAX_TEXT_BYTES, *, pipes: bool = False
) -> bytes:
    """Return the bytes of the file at `path`, which messages call `name`.

    Raises InputError for more than `largest` bytes and for anything except a regular file, such as
    an endless device, or a pipe unless `pipes` are allowed; OSError where it cannot be read.
    """
    kind = os.stat(path).st_mode
    if not stat.S_ISREG(kind) and not pipes:  # opening it could block or have side effects
        raise InputError(name, "(no regular file)", LEGAL_FILE)
    with open(path, "rb", opener=_open_nonblocking) as file:
        os.set_blocking(file.fileno(), True)
        content = file.read(largest + 1)
        size = max(len(content), os.fstat(file.fileno()).st_size)
    if len(content) > largest:
        raise InputError(name, f"{size} bytes", f"be of {largest} at most")
    return content


def _open_nonblocking(path: str, flags: int) -> int:
    """Return the descriptor of a file opened without blocking: a pipe without a writer is empty."""
    return os.open(path, flags | os.O_NONBLOCK)


VERSIONS = f"roughgas {__version__} numba {metadata.version('numba')}\n"
PACKAGE = Path(__file__).resolve().parent.parent
BLOCK_FIELDS = ("body", "handlers", "orelse", "finalbody", "cases")
"""Fields of a statement's syntax tree that hold nested statements, imports among them."""


def code_of(*modules: str, alone: Iterable[str] = ()) -> str:
    """Return a hash of the sources of modules and of all modules that these import.

    Names are relative to the package, such as "simulation.point". Imports of modules in `alone` do
    not count. The hash has 16 hexadecimal digits. Raises FileNotFoundError for an unknown module.
    """
    names = sorted(import_closure(*modules, alone=alone).union(alone))
    text = VERSIONS + "".join(f"{name} {digest_of(name)}\n" for name in names)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def code_in(
    folder: str | Path,
    name: str,
    extra_files: Iterable[str] = (),
    alone: Iterable[str] = (),
) -> str:
    """Return a hash of the code of a study's module: 16 hexadecimal digits.

    It includes the module `name` in the `folder` of the study, the modules that it imports from the
    folder and from the package, and `extra_files` of the folder. Imports of the package's modules
    in `alone` do not count. Raises InputError for a file that is missing or is no Python.
    """
    folder = Path(folder)
    trees = _trees(folder, name)
    package = {module for tree in trees.values() for module in _imports(tree, True)}
    text = code_of(*package, alone=alone) + _digests(folder, [*trees, *extra_files])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def sources_in(folder: str | Path, *names: str) -> str:
    """Return digests of the files of a study's modules and of those that these import from the
    folder; "" for modules that are not there.

    Raises InputError for a file that is no Python.
    """
    folder = Path(folder)
    return _digests(folder, _trees(folder, *(n for n in names if (folder / f"{n}.py").exists())))


def _digests(folder: Path, files: Iterable[str]) -> str:
    """Return the name and the SHA-256 digest of each of the `files` of a folder, sorted."""
    return "".join(
        str((file, hashlib.sha256((folder / file).read_bytes()).hexdigest()))
        for file in sorted({*files})
    )


def _trees(folder: Path, *names: str) -> dict[str, ast.Module]:
    """Return the syntax trees of modules of a study and of those that these import from its folder.

    They are by file. Raises InputError for a file that is missing or is no Python.
    """
    pending, trees = [*names], dict[str, ast.Module]()
    while pending:
        file = f"{pending.pop()}.py"
        if file not in trees:
            with _python(folder / file):
                trees[file] = ast.parse((folder / file).read_bytes())
            siblings = _siblings(trees[file])
            pending += [name for name in siblings if (folder / f"{name}.py").exists()]
    return trees


@contextmanager
def _python(path: Path) -> Iterator[None]:
    """Turn any error of the Python in a study's file at `path` into an InputError that names it.

    Raises InputError also for a missing file.
    """
    name = name_in_study(path)
    if not path.exists():
        raise InputError(name, "(nothing)", "be there for this")
    with as_input_errors(name, "be Python"):
        yield


def _siblings(tree: ast.Module) -> Iterator[str]:
    """Yield the names of the modules in its own folder that a module's syntax tree imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            names = [alias.name for alias in node.names]
            yield from [node.module.partition(".")[0]] if node.module else names


def digest_of(module: str) -> str:
    """Return the SHA-256 digest of a module, such as "simulation.point", and of its data files.

    These are the files of its name with another suffix, beside it.
    """
    return _digest_and_imports(module)[0]


def import_closure(*modules: str, alone: Iterable[str] = ()) -> set[str]:
    """Return the names of modules, of all that they import anywhere, and of their packages.

    Names are relative to the package, such as "simulation.point". Imports inside functions count,
    except in a package that is only the parent of a module. Imports for type checkers alone never
    count, nor do imports of modules in `alone`. The facade, `roughgas` itself, is left out.
    """
    alone = {*alone}
    pending = [(name, True) for name in modules]
    visited: dict[str, bool] = {}
    while pending:
        name, with_function_imports = pending.pop()
        if name and with_function_imports > visited.get(name, -1):
            visited[name] = with_function_imports
            _, imported = _digest_and_imports(name)
            followed = set() if name in alone else imported[with_function_imports]
            pending += [(name.rpartition(".")[0], False), *((module, True) for module in followed)]
    return set(visited)


@functools.cache
def _digest_and_imports(name: str) -> tuple[str, tuple[set[str], set[str]]]:
    """Return the SHA-256 digest of a module, and its imports: at top level, and all of them.

    The digest includes the data files of its name.
    """
    file = _source_path(name)
    tree, digest = ast.parse(file.read_bytes()), hashlib.sha256(file.read_bytes())
    for data_file in sorted(set(file.parent.glob(f"{file.stem}.*")) - {file}):
        digest.update(data_file.read_bytes())
    return digest.hexdigest(), (set(_imports(tree, False)), set(_imports(tree, True)))


def _source_path(name: str) -> Path:
    """Return the path of the source of a module or package, such as "simulation.point"."""
    path = PACKAGE.joinpath(*name.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def _imports(node: ast.AST, in_functions: bool) -> Iterator[str]:
    """Yield the modules of the package that a syntax tree imports, relative to the package.

    Imports inside functions count if `in_functions`; imports for type checkers alone do not.
    """
    if isinstance(node, ast.Import | ast.ImportFrom):
        package = f"{node.module}." if isinstance(node, ast.ImportFrom) else ""
        for alias in node.names:
            name = (package + alias.name).removeprefix("roughgas.")
            if (package + alias.name).startswith("roughgas."):
                yield name if _source_path(name).exists() else name.rpartition(".")[0]
    for_types = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
    blocks = ("orelse",) if for_types else BLOCK_FIELDS
    for child in (child for block in blocks for child in getattr(node, block, ())):
        if in_functions or not isinstance(child, ast.FunctionDef):
            yield from _imports(child, in_functions)


def study_module(folder: str | Path, name: str) -> types.ModuleType:
    """Return the module `name`, such as figure, of the study in `folder`.

    It may import other modules of the folder. Raises InputError for a missing file, or a file that
    is no Python.
    """
    folder, package = Path(folder).resolve(), study_package(folder)
    if not is_imported(folder):
        forget_study(folder)
        sys.modules[package] = types.ModuleType(package)
        sys.modules[package].__path__ = [str(folder)]
    with _python(folder / f"{name}.py"):
        return importlib.import_module(f"{package}.{name}")


STUDY_PACKAGE = "roughgas_study_"
"""Beginning of the names of packages whose modules are the files of a study."""


def study_package(folder: str | Path) -> str:
    """Return the name of the package whose modules are the files of the study in `folder`."""
    return STUDY_PACKAGE + re.sub(r"\W", "_", Path(folder).resolve().name)


def package_of_study(definition: Any) -> str:
    """Return the package of the study that defines a class or a function; "" if none does."""
    package = str(getattr(definition, "__module__", "")).partition(".")[0]
    return package if package.startswith(STUDY_PACKAGE) else ""


def is_imported(folder: str | Path) -> bool:
    """Return whether the package of a study is the study in this `folder`, not its namesake."""
    package = sys.modules.get(study_package(folder))
    return getattr(package, "__path__", None) == [str(Path(folder).resolve())]


def forget_study(folder: str | Path) -> None:
    """Forget the modules of the study in `folder`, so that they are imported anew."""
    package = study_package(folder)
    for name in [loaded for loaded in sys.modules if loaded.partition(".")[0] == package]:
        del sys.modules[name]
    importlib.invalidate_caches()


def readme(folder: str | Path) -> str:
    """Return the text of README.md of the study in `folder`; "" without.

    It has uniform line ends, and no comments. Raises InputError for text that is not UTF-8, exceeds
    MAX_TEXT_BYTES, or cannot be read.
    """
    file = Path(folder, "README.md")
    name = name_in_study(file)
    try:
        text = content_of(file, name).decode("utf-8") if file.exists() else ""
    except UnicodeDecodeError as error:
        raise InputError(name, "(not text)", "be text in UTF-8") from error
    except OSError as error:
        raise InputError(name, error.strerror, LEGAL_FILE) from error
    return without_comments(text.replace("\r\n", "\n").replace("\r", "\n"))


def name_in_study(path: Path) -> str:
    """Return the name of a study's file for messages: studies/STUDY/FILE, wherever it lies."""
    return f"studies/{path.parent.name}/{path.name}"
