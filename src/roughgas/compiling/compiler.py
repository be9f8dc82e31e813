"""Compiling with numba, and the cache of kernels: imported when compiled code is first called.

Numba's disk cache notices an edit only in the file of the function that is looked up, not in the
files of the functions that it calls: a kernel could outlive an edit and give yesterday's numbers.
The folder is therefore named by a hash of every source that machine code is made from.

The cache only saves time: kernels that are damaged are compiled again, and where nothing can be
written each process compiles its own. What is loaded is run: folders are made for their owner
alone, and a folder or a file that somebody else could have written is left alone.

Private or undocumented names of numba, checked with numba 0.68 and by tests/compiling. A figure is
the factor of a kernel's compiling without the name, in CPU time, or of its collisions a second, at
160 particles (cooling gas, bed, shear):

- `JITCodeLibrary`, from which Library inherits, and `set_env`: only kernels become machine code;
  compiling x 1.6;
- `IDLE`, names of passes: they find no work in a function that is written for types; compiling
  x 1.13 to 1.16;
- `no_cpython_wrapper`, `no_cfunc_wrapper`: inner functions take no arguments from Python or C;
  compiling x 2.4 and x 1.15;
- `forceinline`: a call takes longer than many functions; collisions x 0.94 to 0.96, 9 to 12 % more
  instructions;
- `_nrt`: no counts of references to arrays, which are 4 % more instructions; collisions x 1.0;
- the types of a Reference (compiling/reference.py): state and scene stay in memory; compiling
  x 1.2, a seventh more machine code;
- `_cache`, `CompileResult`, `rtsys`: a kernel is loaded in 0.09 s instead of 0.36, before numba
  registers all functions that it can compile; copies of the project share it, a checksum seals it;
- `_numba_type_`, `_compiler._get_implementation`: the type of a decorated function, and its text
  for the types of its arguments. Nothing can be compiled without these two.

No attribute of numba's modules, classes or objects is replaced: numba compiles a user's functions
as it does without this package.
"""

import hashlib
import os
import pickle
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numba
from llvmlite.binding import parse_assembly
from numba.core.cgutils import normalize_ir_text
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, CompileResult, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.core.registry import cpu_target
from numba.core.runtime import rtsys
from numba.core.serialize import dumps

from roughgas.base import InputError
from roughgas.base.files import whole_file
from roughgas.compiling import reference, simd

PACKAGE = Path(__file__).resolve().parent.parent
ROOMS = ("compiling", "kernel", "effects")


def source_hash(*rooms):
    """Return a hex digest of the sources in these rooms, by default the kernel's, and of the
    versions of the compilers."""
    import llvmlite

    digest = hashlib.sha256(f"numba {numba.__version__} llvmlite {llvmlite.__version__}".encode())
    for room in rooms or ROOMS:
        for path in sorted((PACKAGE / room).glob("*.py")):
            digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


IMPORTED = source_hash()
"""Digest of the sources of this process: those on disk may have been edited since."""


def kernel_folder():
    """Return the folder of these sources' kernels; make it where it does not exist.

    It is in ROUGHGAS_CACHE_DIR, or XDG_CACHE_HOME, or ~/.cache; where that cannot be written (a
    read-only home), or others can write there, in the system's temporary directory. Raises OSError
    where that holds there as well.
    """
    folder = cache_root() / f"kernels-{IMPORTED}"
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


# They treat closures, `with`, branches that types decide, functions that numba inlines, literals,
# expressions of whole arrays, references to release: compiling/jit.py has decided these, or the
# kernel has none
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
    "IRLegalization",
}


class Passes(CompilerBase):
    """Numba's passes over a function, without the idle ones; machine code goes to a Library."""

    def define_pipelines(self):
        name, target = self.state.func_id.func_qualname, self.state.targetctx
        self.state.library = Library(target.codegen(), name)
        self.state.library.enable_object_caching()
        whole = DefaultPassBuilder.define_nopython_pipeline(self.state)
        needed = PassManager("kernel")
        for compiler_pass, purpose in whole.passes:
            if compiler_pass.__name__ not in IDLE:
                needed.add_pass(compiler_pass, purpose)
        needed.finalize()
        return [needed]


INNER = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def dispatcher(function, cache=False, inner=False, inline=False):
    """Return numba's object for a function (see the decorators in compiling/jit.py).

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
    return made


class Library(JITCodeLibrary):
    """The machine code of one function and of those that it calls.

    Numba makes machine code of each function that a kernel is put together from, and optimises it
    with all that it calls, though only the kernel's own is ever run. Here only what Python or C
    calls is optimised and finished, with each function that it calls, directly or not, linked once;
    of the others LLVM knows nothing until then, or until a function of the user's calls them.
    """

    def __init__(self, codegen, name):
        super().__init__(codegen, name)
        self._written = []  # llvmlite's modules
        self._exported = []  # functions in them that are known elsewhere

    @property
    def codegen(self):
        """Numba's code generator, which tells a function where its Python objects are; a function
        without machine code has none."""
        return self._codegen if self._is_entry() else OBJECTLESS

    def _is_entry(self):
        names = [function.name for module in self._written for function in module.functions]
        return any(name.startswith(("_ZN7cpython", "_ZN5cfunc")) for name in names)

    def add_ir_module(self, ir_module):
        self._written.append(ir_module)
        for function in ir_module.functions:
            if not (function.is_declaration or function.linkage):
                self._exported.append(function)

    def finalize(self):
        if self._is_entry():
            self._link()
            calls, self._linking_libraries = self._linking_libraries, []
            super().finalize()
            self._linking_libraries = calls  # for what calls this function in its turn
        self._finalized = True

    def _get_module_for_linking(self):
        """Return what numba links where a function of the user's calls this one."""
        if not (self._shared_module or self._is_entry()):
            self._link()
        return super()._get_module_for_linking()

    def _link(self):
        """Put this function and all that it calls into numba's module."""
        _, *called = _callers_first(self)
        inner = [library for library in called if isinstance(library, Library)]
        for library in called:
            self._reload_init.update(library._reload_init)
        for function in (function for library in inner for function in library._exported):
            function.linkage = "linkonce_odr"
        for function in self._exported:
            function.linkage = ""
        for module in (module for library in (self, *inner) for module in library._written):
            self._final_module.link_in(parse_assembly(normalize_ir_text(str(module))))
        for library in called:
            if library not in inner:  # numba's own, which it has finished
                self._final_module.link_in(library._get_module_for_linking(), preserve=True)


OBJECTLESS = SimpleNamespace(set_env=lambda name, environment: None)


def _callers_first(library):
    """Return a library and all that it calls, directly or not, each once and before what it calls:
    LLVM drops a function that nothing has called when it is linked."""
    done = {}

    def visit(caller):
        for called in caller._linking_libraries:
            if called not in done:
                visit(called)
        done[caller] = None

    visit(library)
    return [*done][::-1]


def type_of(name):
    """Return the type that numba gives to an operation on lanes.

    These are known before anything is compiled: a function that learns of lanes while its types are
    inferred has had other types of the same operators before.
    """
    context = cpu_target.typing_context
    context.refresh()
    room = simd if hasattr(simd, name) else reference
    return context.resolve_value_type(getattr(room, name))


class Kept:
    """The compiled code of a function on the disk, a file for each signature and processor.

    Numba's own cache tells code by the path and the time of its source, of whose content our
    folders have the hash: every copy of the project would compile anew. A file has a checksum at
    its end: machine code with a hole in it, as a power cut leaves it, would crash every process to
    come.
    """

    def __init__(self, function):
        self.cache_path = str(folder_of(function.__code__.co_filename))  # numba asks for it
        self._name = f"{function.__name__}-{function.__code__.co_firstlineno}"

    def _path(self, signature, codegen):
        about = repr((signature, codegen.magic_tuple(), sys.version_info[:2]))
        return Path(self.cache_path, f"{self._name}-{_digest(about.encode()).hex()[:16]}.nbc")

    def read(self, signature, codegen):
        """Return what is kept of the code for this signature, None where that is nothing whole.

        Code that somebody else can have written counts as missing, too: a pickle runs what it says.
        """
        path = self._path(signature, codegen)
        try:
            content = path.read_bytes() if is_own(path) else b""
            text, seal = content[:-32], content[-32:]
            of, reduced = pickle.loads(text) if _digest(text) == seal else (None, None)
        except Exception:  # a pickle of other versions may raise whatever it likes
            return None
        return reduced if of == signature else None

    def load_overload(self, signature, target):
        """Load compiled code without setting up the compiler before.

        Numba first imports and registers all that it can compile, which takes three times as long
        as loading. Where nothing is found compiling begins with that anyway.
        """
        rtsys.initialize(target)  # which the loaded code takes its arguments apart with
        reduced = self.read(signature, target.codegen())
        return None if reduced is None else CompileResult._rebuild(target, *reduced)

    def save_overload(self, signature, compiled):
        """Save compiled code, at once and whole.

        Where nothing can be written (a full disk) the process goes on with what it has compiled,
        and says so.
        """
        if compiled.library.has_dynamic_globals:  # addresses of this process
            return
        text = dumps((signature, compiled._reduce()))
        path = self._path(signature, compiled.library.codegen)
        try:
            with whole_file(path) as draft:
                draft.touch(0o600)
                draft.write_bytes(text + _digest(text))
        except OSError as error:
            said = f"roughgas: warning: {path.parent}: {error.strerror}: the kernel is not kept"
            print(said, file=sys.stderr)


def _digest(text):
    return hashlib.sha256(text).digest()
