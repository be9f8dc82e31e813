"""Files that are whole or not there; code in folders of studies; the hash of what a result needs.

The workflow makes a result again when the hash of its code changes: of the modules it uses, and of
all that these import. A file of the same name, such as schema.yaml beside schema.py, counts, and so
do the versions of roughgas and numba.
"""

import ast
import errno
import functools
import hashlib
import importlib
import os
import re
import sys
import tempfile
import types
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path

from roughgas.base import InputError, __version__


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path to write to; rename it to `path` on success, delete it otherwise.

    Parent folders are created. The name, `path`.PID.tmp, is this process's own: a job that outlives
    a killed workflow must not spoil what its successor writes. After SIGKILL the file remains until
    the next writer of `path` finds that its process is gone.
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


def check_place(path: str | Path) -> None:
    """Raise OSError if `path`, a file or a folder, could not be written.

    Called before work that takes long, rather than after it.
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
    """Remove what killed writers of `path` have left."""
    for left in path.parent.glob(f"{path.name}.*.tmp"):
        if not _is_alive(left.name.split(".")[-2]):
            left.unlink(missing_ok=True)


def _is_alive(process: str) -> bool:
    """Return whether a process is there that can still write: one that is over, and whose end its
    parent has not yet taken note of, cannot."""
    try:
        os.kill(int(process), 0)
        state = Path(f"/proc/{process}/stat").read_bytes().rpartition(b")")[2].split()[0]
    except (ValueError, ProcessLookupError):
        return False
    except OSError:  # somebody else's, or a system without /proc
        return True
    return state not in (b"Z", b"X")


def write_text(path: str | Path, text: str) -> None:
    """Write `text` (UTF-8, line ends as given) to `path`, whole or not at all."""
    with whole_file(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="")


VERSIONS = f"roughgas {__version__} numba {metadata.version('numba')}\n"
PACKAGE = Path(__file__).resolve().parent.parent
BLOCKS = ("body", "handlers", "orelse", "finalbody", "cases")
"""What holds the statements within a statement, imports among them."""


def code_of(*modules: str, alone: Iterable[str] = ()) -> str:
    """Return a hash of modules as they are, such as "simulation.point", and of all they import.

    Of modules in `alone` the imports do not count. Raises FileNotFoundError for an unknown one.
    """
    names = sorted(closure(*modules, alone=alone).union(alone))
    text = VERSIONS + "".join(f"{name} {_read(name)[0]}\n" for name in names)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def code_in(
    folder: str | Path, name: str, beside: Iterable[str] = (), alone: Iterable[str] = ()
) -> str:
    """Return a hash of the module `name` in the folder of a study, of those there that it imports,
    and of all that these import of the package; and of other files `beside` it.

    Of the package's modules in `alone` the imports do not count. Raises InputError for a file that
    is not there or is no Python.
    """
    folder, todo, package, digests = Path(folder), [name], set[str](), {}
    while todo:
        file = f"{todo.pop()}.py"
        if file not in digests:
            with _python(folder / file):
                tree = ast.parse((folder / file).read_bytes())
            digests[file] = hashlib.sha256((folder / file).read_bytes()).hexdigest()
            package |= set(_imports(tree, True))
            todo += [one for one in _siblings(tree) if (folder / f"{one}.py").exists()]
    for file in beside:
        digests[file] = hashlib.sha256((folder / file).read_bytes()).hexdigest()
    text = code_of(*package, alone=alone) + "".join(map(str, sorted(digests.items())))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@contextmanager
def _python(path: Path) -> Iterator[None]:
    """Raise InputError where the file of a study is not there, and for what its Python raises."""
    called = f"studies/{path.parent.name}/{path.name}"
    if not path.exists():
        raise InputError(called, "(nothing)", "be there for this")
    try:
        yield
    except Exception as error:
        raise InputError(called, f"{type(error).__name__}: {error}", "be Python") from error


def _siblings(tree: ast.Module) -> Iterator[str]:
    """Generate the modules beside it that a module imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            names = [one.name for one in node.names]
            yield from [node.module.partition(".")[0]] if node.module else names


def closure(*modules: str, alone: Iterable[str] = ()) -> set[str]:
    """Return the names of modules, of all that they import anywhere, and of their packages.

    Of a package that is only around a module, imports inside functions do not count; nowhere those
    that only type checkers see, nor any of modules in `alone`. The facade, `roughgas` itself, is
    not among them.
    """
    alone = {*alone}
    todo = [(name, True) for name in modules]
    found: dict[str, bool] = {}
    while todo:
        name, whole = todo.pop()
        if name and whole > found.get(name, -1):
            found[name] = whole
            _, imported = _read(name)
            followed = set() if name in alone else imported[whole]
            todo += [(name.rpartition(".")[0], False), *((one, True) for one in followed)]
    return set(found)


@functools.cache
def _read(name: str) -> tuple[str, tuple[set[str], set[str]]]:
    """Return a hash of a module, and what it imports: at once, and in all."""
    file = _file(name)
    tree, digest = ast.parse(file.read_bytes()), hashlib.sha256(file.read_bytes())
    for beside in sorted(set(file.parent.glob(f"{file.stem}.*")) - {file}):
        digest.update(beside.read_bytes())
    return digest.hexdigest(), (set(_imports(tree, False)), set(_imports(tree, True)))


def _file(name: str) -> Path:
    path = PACKAGE.joinpath(*name.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def _imports(node: ast.AST, in_functions: bool) -> Iterator[str]:
    """Generate the modules of the package that a syntax tree imports."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        package = f"{node.module}." if isinstance(node, ast.ImportFrom) else ""
        for alias in node.names:
            name = (package + alias.name).removeprefix("roughgas.")
            if (package + alias.name).startswith("roughgas."):
                yield name if _file(name).exists() else name.rpartition(".")[0]
    for_types = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
    blocks = ("orelse",) if for_types else BLOCKS
    for child in (child for block in blocks for child in getattr(node, block, ())):
        if in_functions or not isinstance(child, ast.FunctionDef):
            yield from _imports(child, in_functions)


def module_of(folder: str | Path, name: str) -> types.ModuleType:
    """Return the module `name`, such as figure, of the study in `folder`; it may import those
    beside it. Raises InputError where there is none, or where it is no Python."""
    folder = Path(folder).resolve()
    package = "roughgas_study_" + re.sub(r"\W", "_", folder.name)
    if getattr(sys.modules.get(package), "__path__", None) != [str(folder)]:
        for known in [one for one in sys.modules if one.partition(".")[0] == package]:
            del sys.modules[known]
        sys.modules[package] = types.ModuleType(package)
        sys.modules[package].__path__ = [str(folder)]
    with _python(folder / f"{name}.py"):
        return importlib.import_module(f"{package}.{name}")


def readme(folder: str | Path) -> str:
    """Return README.md of the study in `folder`; nothing without one."""
    file = Path(folder, "README.md")
    return file.read_text(encoding="utf-8") if file.exists() else ""
