"""Compiling by private parts of numba, which takes half of the time (docs/compiling.md).

PRIVATE_PARTS lists them, checked with numba 0.63 to 0.68 and by tests/compiling. A factor is that
of a kernel's compiling without the part, in CPU time, or of its collisions a second, at 160
particles (cooling gas, bed, shear):

- `JITCodeLibrary`, the base of KernelLibrary, and `set_env`: only kernels become machine code;
  compiling x 1.6;
- SKIPPED_PASSES, names of passes that find no work in a specialised function; compiling x 1.13 to
  1.16;
- `no_cpython_wrapper`, `no_cfunc_wrapper`: inner functions take no arguments from Python or C;
  compiling x 2.4 and x 1.15;
- `forceinline`: a call takes longer than many functions; collisions x 0.94 to 0.96, 9 to 12 % more
  instructions;
- `_nrt`: no counts of references to arrays, which are 4 % more instructions; collisions x 1.0;
- the templates of a StructPointer's fields (compiling/struct_attributes.py): state and scene stay
  in memory; compiling x 1.2, a seventh more machine code;
- `_cache`, `CompileResult`, `NumbaPickler`, `rtsys` (compiling/kernel_cache.py): a kernel is loaded
  in 0.09 s instead of 0.36, before numba registers all functions that it can compile; copies of the
  project share it, a checksum seals it, and arguments may be of classes that only this process can
  find;
- `_numba_type_`, `_compiler._get_implementation`: the type of a decorated function, and its
  specialised form for the types of its arguments.

No attribute of numba's modules, classes or objects is replaced: numba compiles a user's functions
as it does without this package.
"""

import functools
import importlib
from types import SimpleNamespace

import numba
from llvmlite.binding import parse_assembly
from numba.core.cgutils import normalize_ir_text
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.core.registry import cpu_target

from roughgas.compiling import simd, struct_attributes, struct_pointer  # noqa: F401
from roughgas.compiling.kernel_cache import KernelCache

PRIVATE_PARTS = {
    "numba.core.cgutils": ("normalize_ir_text",),
    "numba.core.codegen": (
        "JITCodeLibrary.add_ir_module",
        "JITCodeLibrary.finalize",
        "JITCodeLibrary._get_module_for_linking",
    ),
    "numba.core.compiler": (
        "CompileResult._rebuild",
        "CompileResult._reduce",
        "CompilerBase.define_pipelines",
        "DefaultPassBuilder.define_nopython_pipeline",
    ),
    "numba.core.compiler_machinery": ("PassManager.add_pass", "PassManager.finalize"),
    "numba.core.options": (
        "DefaultOptions._nrt",
        "DefaultOptions.forceinline",
        "DefaultOptions.no_cfunc_wrapper",
        "DefaultOptions.no_cpython_wrapper",
    ),
    "numba.core.registry": ("cpu_target.target_context", "cpu_target.typing_context"),
    "numba.core.runtime": ("rtsys.initialize",),
    "numba.core.serialize": ("NumbaPickler",),
    "numba.core.typing.templates": ("AbstractTemplate", "AttributeTemplate", "signature"),
}
"""Attributes of numba's modules and classes."""

LIBRARY_PARTS = (
    "_codegen",
    "_final_module",
    "_finalized",
    "_linking_libraries",
    "_reload_init",
    "_shared_module",
)
"""Attributes of each JITCodeLibrary."""

DISPATCHER_PARTS = ("_cache", "_compiler._get_implementation", "_numba_type_")
"""Attributes of each dispatcher, which numba.njit returns."""


def missing_part():
    """Return the dotted name of a private part that this numba lacks; None if it has all."""
    for module, names in PRIVATE_PARTS.items():
        for name in names:
            if lacks(importlib.import_module(module), name):
                return f"{module}.{name}"
    for owner, (sample, names) in samples().items():
        for name in names:
            if lacks(sample, name):
                return f"{owner}.{name}"
    return None


def lacks(owner, name):
    """Return whether an object is without an attribute, which may be dotted."""
    try:
        functools.reduce(getattr, name.split("."), owner)
    except AttributeError:
        return True
    return False


def samples():
    """Return {class: (an object, private attributes of each such object)}."""
    library = JITCodeLibrary(cpu_target.target_context.codegen(), "sample")
    return {
        "JITCodeLibrary": (library, LIBRARY_PARTS),
        "Dispatcher": (numba.njit(lambda: None), DISPATCHER_PARTS),
    }


SKIPPED_PASSES = {
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
"""Passes for closures, `with`, branches that types decide, functions that numba inlines, literals,
expressions of whole arrays, and references to release: the Specialiser has decided these, or the
kernel has none."""


class KernelCompiler(CompilerBase):
    """Numba's passes over a function, without SKIPPED_PASSES; the code goes to a KernelLibrary."""

    def define_pipelines(self):
        name, target = self.state.func_id.func_qualname, self.state.targetctx
        self.state.library = KernelLibrary(target.codegen(), name)
        self.state.library.enable_object_caching()
        pipeline = PassManager("kernel")
        for compiler_pass, purpose in DefaultPassBuilder.define_nopython_pipeline(
            self.state
        ).passes:
            if compiler_pass.__name__ not in SKIPPED_PASSES:
                pipeline.add_pass(compiler_pass, purpose)
        pipeline.finalize()
        return [pipeline]


class KernelLibrary(JITCodeLibrary):
    """The machine code of a function and of its callees.

    Numba makes machine code of each function that a kernel consists of, and optimises it with all
    its callees, though only the kernel's own is ever run. Here only functions that Python or C
    calls are optimised and finished, with each callee, direct or not, linked once; LLVM knows
    nothing of the others until then, or until a function of the user's calls them.
    """

    def __init__(self, codegen, name):
        super().__init__(codegen, name)
        self._modules = []  # of llvmlite's
        self._exported = []  # functions in them that other modules can call

    @property
    def codegen(self):
        """Numba's code generator, which tells a function the address of its Python objects; a
        function without machine code gets none."""
        return self._codegen if self._is_entry() else CODEGEN_WITHOUT_ADDRESSES

    def _is_entry(self):
        names = [function.name for module in self._modules for function in module.functions]
        return any(name.startswith(("_ZN7cpython", "_ZN5cfunc")) for name in names)

    def add_ir_module(self, ir_module):
        self._modules.append(ir_module)
        for function in ir_module.functions:
            if not (function.is_declaration or function.linkage):
                self._exported.append(function)

    def finalize(self):
        if self._is_entry():
            self._link()
            callees, self._linking_libraries = self._linking_libraries, []
            super().finalize()
            self._linking_libraries = callees  # for the callers of this function
        self._finalized = True

    def _get_module_for_linking(self):
        """Return the module that numba links into a user's function that calls this one."""
        if not (self._shared_module or self._is_entry()):
            self._link()
        return super()._get_module_for_linking()

    def _link(self):
        """Link this function and all its callees into numba's module."""
        _, *callees = _callers_first(self)
        inner = [library for library in callees if isinstance(library, KernelLibrary)]
        for library in callees:
            self._reload_init.update(library._reload_init)
        for function in (function for library in inner for function in library._exported):
            function.linkage = "linkonce_odr"
        for function in self._exported:
            function.linkage = ""
        for module in (module for library in (self, *inner) for module in library._modules):
            self._final_module.link_in(parse_assembly(normalize_ir_text(str(module))))
        for library in callees:
            if library not in inner:  # numba's own, which it has finished
                self._final_module.link_in(library._get_module_for_linking(), preserve=True)


CODEGEN_WITHOUT_ADDRESSES = SimpleNamespace(set_env=lambda name, environment: None)


def _callers_first(library):
    """Return a library and all its callees, direct or not, each once and before its own callees:
    LLVM drops a function that nothing has called when it is linked."""
    done = {}

    def visit(caller):
        for callee in caller._linking_libraries:
            if callee not in done:
                visit(callee)
        done[caller] = None

    visit(library)
    return [*done][::-1]


NO_WRAPPERS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def dispatcher(compiled):
    """Return numba's dispatcher of a Compiled function.

    Raises OSError if the function is cached and no folder for compiled code can be written.
    """
    options = {"error_model": "numpy", "_nrt": False, "pipeline_class": KernelCompiler}
    if compiled.is_inner:
        options |= NO_WRAPPERS
    if compiled.is_inlined:
        options |= {"forceinline": True}
    numba_dispatcher = numba.njit(**options)(compiled.py_func)
    numba_dispatcher._compiler._get_implementation = lambda types, _: compiled.specialise(types)
    if compiled.is_cached:
        numba_dispatcher._cache = KernelCache(compiled.py_func)
    return numba_dispatcher


def compiled_type(compiled):
    """Return the type that numba gives to a Compiled function."""
    return compiled.dispatcher._numba_type_


def primitive_type(primitive):
    """Return the type that numba gives to a Primitive.

    The operators of lanes have to be defined before anything is compiled: numba looks up the types
    of an operator once for each function, and would not see a later definition.
    """
    context = cpu_target.typing_context
    context.refresh()
    module = simd if hasattr(simd, primitive.__name__) else struct_pointer
    return context.resolve_value_type(getattr(module, primitive.__name__))
