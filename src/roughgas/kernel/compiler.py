"""Compiling with numba, and the cache of kernels: imported when compiled code is first called.

Numba's disk cache notices an edit only in the file of the function that is looked up, not in the
files of the functions that it calls: a kernel could outlive an edit and give yesterday's numbers.
The folder is therefore named by a hash of every source that machine code is made from.

The cache only saves time: kernels that are damaged are compiled again, and where nothing can be
written each process compiles its own. What is loaded is run: folders are made for their owner
alone, and a folder or a file that somebody else could have written is left alone.

What is private to numba, and what it is needed for; checked with numba 0.68, and by
tests/kernel/test_compiler.py:

- `_nrt`: without it reference counting takes more than half of the time;
- `no_cpython_wrapper`, `no_cfunc_wrapper`, `forceinline`: documented for `overload` only. Unpacking
  a state for a call from Python takes more code, and time to compile it, than most functions do;
- `_numba_type_`: how a value tells its type;
- `_compiler._get_implementation`: a function is written for types before it is compiled;
- `Passes`: passes of numba that find nothing to do in a function that is written for types;
- `Library`, `set_env`: machine code is made of a kernel, and not of each function in it besides;
- the types and values of a Reference (kernel/reference.py): a state and a scene in memory;
- `event.start_event`, `end_event`: a tenth of the time went into telling of locks and passes;
- `_cache`, the classes of numba.core.caching, `rtsys`: to load a kernel without setting up the
  compiler, to share it among copies of the project, to seal files with a checksum, to have one
  writer at a time.
"""

import fcntl
import functools
import gc
import hashlib
import os
import pickle
import sys
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path

import numba
from numba.core import event
from numba.core.caching import (
    CompileResultCacheImpl,
    FunctionCache,
    IndexDataCacheFile,
    _CacheLocator,
)
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.core.registry import cpu_target
from numba.core.runtime import rtsys

from roughgas.base import InputError
from roughgas.kernel import reference, simd

PACKAGE = Path(__file__).resolve().parent.parent
ROOMS = ("kernel", "effects")


def source_hash(*rooms):
    """Return a hex digest of the sources in these rooms, by default the kernel's, and of the
    versions of the compilers."""
    import llvmlite
    import numba

    digest = hashlib.sha256(f"numba {numba.__version__} llvmlite {llvmlite.__version__}".encode())
    for room in rooms or ROOMS:
        for path in sorted((PACKAGE / room).glob("*.py")):
            digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def kernel_folder():
    """Return the folder of these sources' kernels; make it where it does not exist.

    It is in ROUGHGAS_CACHE_DIR, or XDG_CACHE_HOME, or ~/.cache; where that cannot be written (a
    read-only home), or others can write there, in the system's temporary directory. Raises OSError
    where that holds there as well.
    """
    folder = cache_root() / f"kernels-{source_hash()}"
    try:
        _try_to_write(folder)
    except OSError:
        private = Path(tempfile.gettempdir()) / f"roughgas-{os.getuid()}"
        private.mkdir(mode=0o700, exist_ok=True)
        if not is_own(private):
            raise PermissionError(None, "belongs to somebody else", str(private)) from None
        folder = private / folder.name
        _try_to_write(folder)
    return folder


def folder_of(file):
    """Return the folder for the compiled functions of `file`, as `kernel_folder` does.

    Other rooms, and files outside the package, call the kernel's functions, and those of files
    beside them: they have folders in the kernel's, named by a hash of all sources beside them.
    """
    file = Path(file).resolve()
    if PACKAGE in file.parents and file.parent.name in ROOMS:
        return kernel_folder() / file.stem
    return kernel_folder() / f"{file.stem}-{source_hash(file.parent)}"


def cache_root():
    """Return where the folders of kernels should be, one for each state of the sources."""
    chosen = os.environ.get("ROUGHGAS_CACHE_DIR")
    if chosen:
        return Path(chosen)
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return Path(home) / "roughgas"


def is_own(path):
    """Return whether only the user, and root, can have written a file or folder."""
    about = os.stat(path)
    return about.st_uid in (os.getuid(), 0) and not about.st_mode & 0o022


def _try_to_write(folder):
    folder.parent.mkdir(parents=True, exist_ok=True)
    folder.mkdir(mode=0o700, exist_ok=True)
    if not is_own(folder):
        raise PermissionError(None, "can be written by others", str(folder))
    tempfile.TemporaryFile(dir=folder).close()


# For closures, `with`, branches that types decide, functions that numba inlines, literals,
# expressions of whole arrays: kernel/jit.py has done it, or the kernel has none
IDLE = {
    "WithLifting",
    "InlineClosureLikes",
    "RewriteSemanticConstants",
    "DeadBranchPrune",
    "MakeFunctionToJitFunction",
    "InlineInlinables",
    "FindLiterallyCalls",
    "LiteralUnroll",
    "LiteralPropagationSubPipelinePass",
    "InlineOverloads",
    "NopythonRewrites",
    "NoPythonSupportedFeatureValidation",
    "DumpParforDiagnostics",
}


class Passes(CompilerBase):
    """What numba does to a function, without the passes that would find nothing to do."""

    def define_pipelines(self):
        whole = DefaultPassBuilder.define_nopython_pipeline(self.state)
        needed = PassManager("kernel")
        for one, purpose in whole.passes:
            if one.__name__ not in IDLE:
                needed.add_pass(one, purpose)
        needed.finalize()
        return [needed]


INNER = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def dispatcher(function, cache=False, inner=False, inline=False):
    """Return numba's object for a function (see the decorators in kernel/jit.py).

    Raises InputError where numba is told not to compile, OSError where no folder for compiled code
    can be written.
    """
    if numba.config.DISABLE_JIT:
        raise InputError("NUMBA_DISABLE_JIT", 1, "be unset: the kernels run compiled only")
    options = INNER if inner else {}
    if inline:
        options = options | {"forceinline": True}
    made = numba.njit(error_model="numpy", _nrt=False, pipeline_class=Passes, **options)(function)
    if cache:
        made._cache = Kept(function)
    if not inner:
        made.compile = _undisturbed(made.compile)
    return made


def _tell_nobody(*about, **more):
    pass


def _undisturbed(compile_it):
    """Have memory collected once, after compiling: nothing that is compiled can be thrown away.

    And let numba tell nobody of each lock that it takes and each pass that it runs: all functions
    that are being compiled listen, each within the one that calls it.
    """

    @functools.wraps(compile_it)
    def compiling(*args):
        enabled, told = gc.isenabled(), (event.start_event, event.end_event)
        gc.disable()
        event.start_event = event.end_event = _tell_nobody
        try:
            return compile_it(*args)
        finally:
            event.start_event, event.end_event = told
            if enabled:
                gc.enable()

    return compiling


class Library(JITCodeLibrary):
    """The machine code of one function and of those that it calls.

    Numba makes machine code of each function that a kernel is put together from, and optimises it
    with all that it calls, though only the kernel's own is ever run. Here only what Python or C
    calls is optimised and finished, with each function that it calls, directly or not, linked once.
    """

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout  # all else once, when all is linked

    def finalize(self):
        if any(_is_entry(function.name) for function in self._final_module.functions):
            self._linking_libraries = _all_below(self, [])
            super().finalize()
            return
        for library in self._linking_libraries:
            self._reload_init.update(library._reload_init)
        self._finalize_dynamic_globals()
        self._finalized = True


def _all_below(library, found):
    """Return the list with all libraries added that one calls, directly or not, each once."""
    for one in library._linking_libraries:
        if one not in found:
            found.append(one)
            _all_below(one, found)
    return found


def _is_entry(name):
    return name.startswith(("_ZN7cpython", "_ZN5cfunc"))


def _set_environment(code, set_it, name, environment):
    """Tell a function where its Python objects are; one without machine code has none."""
    if code._engine.is_symbol_defined(name):
        set_it(name, environment)


def _finish_entries_only():
    code = cpu_target.target_context.codegen()
    code._library_class = Library
    code.set_env = functools.partial(_set_environment, code, code.set_env)


_finish_entries_only()


def type_of(name):
    """Return the type that numba gives to an operation on lanes.

    These are known before anything is compiled: a function that learns of lanes while its types are
    inferred has had other types of the same operators before.
    """
    context = cpu_target.typing_context
    context.refresh()
    room = simd if hasattr(simd, name) else reference
    return context.resolve_value_type(getattr(room, name))


class Folder(_CacheLocator):
    """Where the compiled code of a function is kept, wherever its source is.

    Numba takes the path and the content of the source for its content, of which our folders have
    the hash: every copy of the project would compile anew.
    """

    def __init__(self, function):
        self._py_file = function.__code__.co_filename  # which numba names in warnings
        self.line, self.path = function.__code__.co_firstlineno, str(folder_of(self._py_file))

    @classmethod
    def from_function(cls, function, file):
        return cls(function)

    def get_cache_path(self):
        return self.path

    def get_source_stamp(self):
        return None

    def get_disambiguator(self):
        return str(self.line)


class InFolder(CompileResultCacheImpl):
    _locator_classes = (Folder,)  # type: ignore[assignment]  # of numba, which has a list


class Sealed(IndexDataCacheFile):
    """Numba's files with a checksum at their end; those without a right one count as missing.

    Machine code with a hole in it, as a power cut leaves it, would crash every process to come.
    Those that somebody else can have written count as missing, too: a pickle runs what it says.
    """

    def _load_index(self):
        there = Path(self._index_path).exists()
        return super()._load_index() if there and is_own(self._index_path) else {}

    @contextmanager
    def _open_for_write(self, filepath):
        with super()._open_for_write(filepath) as file:
            os.fchmod(file.fileno(), 0o600)
            yield file

    def _dump(self, content):
        text = super()._dump(content)  # a pickle, which does not mind what comes after it
        return text + hashlib.sha256(text).digest()

    def _load_data(self, name):
        if not is_own(self._data_path(name)):
            raise OSError("written by others")
        content = Path(self._data_path(name)).read_bytes()
        text, seal = content[:-32], content[-32:]
        if hashlib.sha256(text).digest() != seal:
            raise OSError("damaged")
        return pickle.loads(text)


class Kept(FunctionCache):
    """The compiled code of a function on the disk."""

    _impl_class = InFolder

    def __init__(self, function):
        super().__init__(function)
        self._cache_file = Sealed(self.cache_path, self._impl.filename_base, source_stamp=None)

    def load_overload(self, signature, target):
        """Load compiled code without setting up the compiler before.

        Numba first imports and registers all that it can compile, which takes three times as long
        as loading. Where nothing is found, or nothing whole, compiling begins with that anyway.
        """
        rtsys.initialize(target)  # which the loaded code takes its arguments apart with
        try:
            return self._load_overload(signature, target)
        except Exception:  # a damaged pickle may raise whatever it likes
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, signature, compiled):
        """Save compiled code while no other process does.

        Numba reads its index, picks a free file number and writes both: two writers could pick the
        same number, and one of them would later load the other's code. Where nothing can be written
        (a full disk) the process goes on with what it has compiled, and says so.
        """
        folder = Path(self.cache_path)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with (folder / "lock").open("w") as lock:
                with suppress(OSError):  # some network disks have no locks
                    fcntl.flock(lock, fcntl.LOCK_EX)
                super().save_overload(signature, compiled)
        except OSError as error:
            said = f"roughgas: warning: {folder}: {error.strerror}: the kernel is not kept"
            print(said, file=sys.stderr)
