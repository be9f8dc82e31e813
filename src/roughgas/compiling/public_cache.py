"""Machine code on the disk, on the public path: numba's own cache, where it can be trusted.

Numba names the cache of a source file by its path and content, puts it into `__pycache__` beside
the file, and does not notice edits of other files. So each cached entry is written to a separate
file, in a folder named by the hash of all sources. Numba does not check machine code that it loads:
each of its files is sealed by a checksum in a file beside it, and unsealed files are deleted first.
"""

import functools
import hashlib
import sys

from roughgas.base.files import atomic_write
from roughgas.compiling.cache_folders import folder_of_file, is_safe, warn_not_kept

SUFFIX = "-public"
"""Suffix of the folder of kernels: both paths may be used in turn."""


def write_entry(compiled, source):
    """Write the file of an entry for numba to cache; return its path, None if none can be written.

    Raises OSError if no folder for compiled code can be written.
    """
    function = compiled.py_func
    folder = folder_of_file(function.__code__.co_filename, SUFFIX)
    path = folder / f"{function.__name__}-{function.__code__.co_firstlineno}" / "entry.py"
    try:
        if not (path.is_file() and is_safe(path) and path.read_text() == source):
            with atomic_write(path) as draft:
                draft.write_text(source)
                draft.chmod(0o600)
    except OSError as error:
        warn_not_kept(path.parent, error)
        return None
    return path


class CachedEntry:
    """An entry that takes numba's cached dispatcher, or the uncached one where pickle would not
    find a class of the arguments in another process; other attributes are the cached one's."""

    def __init__(self, cached, uncached, path, module):
        self.cached, self.uncached, self._module = cached, uncached, module
        self._folder = path.parent / "__pycache__"
        self._number_sealed = 0  # of signatures
        remove_unsealed(self._folder)

    def __getattr__(self, name):
        return getattr(self.cached, name)

    def __call__(self, *args):
        if not all(_is_importable(x, self._module) for x in _named_tuples(args)):
            return self.uncached(*args)
        try:
            result = self.cached(*args)
        except OSError as error:  # numba has compiled it, and could not save it
            warn_not_kept(self._folder, error)
            result = self.cached(*args)
        if len(self.cached.signatures) > self._number_sealed:
            self._number_sealed = len(self.cached.signatures)
            seal(self._folder)
        return result


def _named_tuples(values):
    """Generate the classes of named tuples among values, and within these."""
    for value in values:
        if isinstance(value, tuple):
            if type(value) is not tuple:
                yield type(value)
            yield from _named_tuples(value)


@functools.cache
def _is_importable(class_, module):
    """Return whether every process with the entry's module finds a class by its name."""
    home = class_.__module__
    is_at_hand = home == module != "__main__" or home.startswith("roughgas.")
    return is_at_hand and getattr(sys.modules.get(home), class_.__qualname__, None) is class_


def _checksum(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def seal(folder):
    """Write the checksum of each of numba's files in a folder beside it."""
    for path in folder.glob("*.nb[ci]"):
        checksum = path.with_name(path.name + ".sha256")
        try:
            if not checksum.exists() or checksum.read_text() != _checksum(path):
                path.chmod(0o600)  # numba leaves it to the umask, under which a group may write
                with atomic_write(checksum) as draft:
                    draft.write_text(_checksum(path))
        except FileNotFoundError:
            continue  # another process has just deleted it
        except OSError as error:
            warn_not_kept(folder, error)


def remove_unsealed(folder):
    """Delete numba's files in a folder that are damaged, or that others could have written."""
    for path in folder.glob("*.nb[ci]"):
        checksum = path.with_name(path.name + ".sha256")
        try:
            if not (is_safe(path) and checksum.read_text() == _checksum(path)):
                path.unlink()
        except FileNotFoundError:
            path.unlink(missing_ok=True)
