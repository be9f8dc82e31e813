"""Machine code on the disk, as the private path (compiling/private_numba.py) saves and loads it.

The cache only saves time: damaged kernels are compiled again, and where nothing can be written each
process compiles its own.
"""

import hashlib
import io
import pickle
import sys
from pathlib import Path

from numba import types
from numba.core.compiler import CompileResult
from numba.core.runtime import rtsys
from numba.core.serialize import NumbaPickler

from roughgas.base.files import atomic_write
from roughgas.compiling.cache_folders import folder_of_file, is_safe, warn_not_kept


class KernelPickler(NumbaPickler):
    """Writes compiled code; types of the arguments are written as their positions.

    A named tuple's type has its class, and pickle finds classes by the names of their modules: that
    of a user's effect may have another name, or none, in another process.
    """

    def __init__(self, file, signature):
        super().__init__(file, protocol=4)
        self._positions = {numba_type: str(k) for k, numba_type in enumerate(signature)}

    def persistent_id(self, value):
        return self._positions.get(value) if isinstance(value, types.Type) else None


class KernelUnpickler(pickle.Unpickler):
    """Reads the output of a KernelPickler for arguments of the same types."""

    def __init__(self, file, signature):
        super().__init__(file)
        self._signature = signature

    def persistent_load(self, position):
        return self._signature[int(position)]


class KernelCache:
    """The compiled code of a function on the disk, a file for each signature and processor.

    Numba's own cache identifies code by the path and the time, or the content, of its source alone:
    every copy of the project would compile anew, and edits elsewhere would go unnoticed. A file has
    a checksum at its end: machine code with a hole in it, as a power cut leaves it, would crash
    every later process.
    """

    def __init__(self, function):
        self.cache_path = str(folder_of_file(function.__code__.co_filename))  # numba reads it
        self._name = f"{function.__name__}-{function.__code__.co_firstlineno}"

    def _path(self, signature, codegen):
        key = repr((signature, codegen.magic_tuple(), sys.version_info[:2]))
        return Path(self.cache_path, f"{self._name}-{_digest(key.encode()).hex()[:16]}.nbc")

    def read(self, signature, codegen):
        """Return the cached code for a signature, or None if it is missing, damaged or writable by
        others: a pickle can run any code."""
        path = self._path(signature, codegen)
        try:
            content = path.read_bytes() if is_safe(path) else b""
            pickled, checksum = content[:-32], content[-32:]
            if _digest(pickled) != checksum:
                return None
            cached_signature, reduced = KernelUnpickler(io.BytesIO(pickled), signature).load()
        except Exception:  # a pickle of other versions may raise anything
            return None
        return reduced if cached_signature == repr(signature) else None

    def load_overload(self, signature, target):
        """Return cached code without setting up the compiler before; None if there is none.

        Numba first imports and registers all that it can compile, which takes three times as long
        as loading. Without cached code, compiling begins with that anyway.
        """
        rtsys.initialize(target)  # the loaded code unpacks its arguments with it
        reduced = self.read(signature, target.codegen())
        return None if reduced is None else CompileResult._rebuild(target, *reduced)

    def save_overload(self, signature, compiled):
        """Save compiled code, atomically.

        If it cannot be written (a full disk), there is a warning, and the process goes on.
        """
        if compiled.library.has_dynamic_globals:  # addresses of this process
            return
        file = io.BytesIO()
        KernelPickler(file, signature).dump((repr(signature), compiled._reduce()))
        pickled = file.getvalue()
        path = self._path(signature, compiled.library.codegen)
        try:
            with atomic_write(path) as draft:
                draft.touch(0o600)
                draft.write_bytes(pickled + _digest(pickled))
        except OSError as error:
            warn_not_kept(path.parent, error)


def _digest(content):
    return hashlib.sha256(content).digest()
