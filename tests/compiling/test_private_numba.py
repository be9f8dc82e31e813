"""The private path: each private part of numba that it uses, and the libraries of kernels."""

import ast
import importlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import numba
import numpy as np
import pytest

import roughgas
from roughgas.compiling import compiler
from roughgas.compiling.jit import compiled, entry

if compiler.path().__name__.endswith("public_numba"):
    pytest.skip("the public path is taken", allow_module_level=True)
from roughgas.compiling import private_numba

PACKAGE = Path(roughgas.__file__).parent


def test_the_kernel_has_no_reference_counts():
    """So it cannot allocate."""
    with pytest.raises(numba.TypingError, match="NRT required"):
        entry(lambda: np.zeros(3))()
    assert numba.njit(lambda: np.zeros(3))().size == 3


@compiled
def twice(x):
    return 2.0 * x


def test_inner_functions_have_no_machine_code():
    """If numba did not finish them either, private_numba.KernelLibrary could be removed."""

    @entry
    def four_times(x):
        return twice(twice(x))

    assert four_times(1.5) == 6.0
    engine = private_numba.cpu_target.target_context.codegen()._engine
    (inner,) = twice.dispatcher.overloads.values()
    (outer,) = four_times.dispatcher.overloads.values()
    assert not engine.is_symbol_defined(inner.fndesc.llvm_func_name)
    assert engine.is_symbol_defined(outer.fndesc.llvm_cpython_wrapper_name)


BEFORE = """import numba
import numpy as np

@numba.njit
def longest(x):
    return max(x.shape) + sum(x.shape) - 5

print(longest(np.ones((2, 3))))

from roughgas.compiling.jit import entry

@entry
def longer(x):
    return longest(x) + sum(x.shape) - 4

print(longer(np.ones((2, 3))))
"""


def test_a_kernel_calls_functions_that_numba_had_compiled_before(tmp_path):
    """The user's function, and its `sum`, are finished by numba's own library."""
    program = tmp_path / "before.py"
    program.write_text(BEFORE)
    run = [sys.executable, str(program)]
    ran = subprocess.run(run, env={"PYTHONPATH": str(PACKAGE.parent)}, capture_output=True)
    assert ran.stdout.split() == [b"3", b"4"], ran.stderr.decode()


def test_int_max_and_min_are_pythons():
    """Of integers, booleans, floats, NaN and tuples; and none of numba's own is linked."""

    @entry
    def values(x, k, widths):
        integers = int(x), int(k), int(x > k)
        return integers, max(x, k), min(x, k), max(k, x, 2.5), max(widths), min(widths)

    for x in (3.75, -0.5, 0.0, float("inf"), float("nan")):
        finite = x if np.isfinite(x) else 1.0
        arguments = (finite, 2, (x, 1.5, 0.0))
        np.testing.assert_equal(values(*arguments), values.py_func(*arguments))
    (overload,) = values.dispatcher.overloads.values()
    libraries = private_numba._callers_first(overload.library)
    assert {x.name for x in libraries if not isinstance(x, private_numba.KernelLibrary)} <= {"nrt"}


def test_threads_compile_at_the_same_time():
    """Functions of a user and of roughgas, and a function that all threads call."""

    @entry
    def shared(x):
        return twice(x) + 1.0

    def compile_three(k):
        kernel, user = entry(lambda x: twice(twice(x))), numba.njit(lambda x: twice(x) - x)
        return kernel(float(k)), user(float(k)), shared(float(k))

    with ThreadPoolExecutor(4) as threads:
        values = [*threads.map(compile_three, range(8))]
    assert values == [(4.0 * k, 1.0 * k, 2.0 * k + 1.0) for k in range(8)]


def test_every_skipped_pass_is_one_of_numbas():
    """A pass that numba renames would no longer be skipped, and take its time."""
    passes = []
    for decorate in (numba.njit, lambda function: entry(function).dispatcher):
        function = decorate(lambda x: 2.0 * x)
        assert function(1.5) == 3.0
        (metadata,) = function.get_metadata().values()
        (times,) = metadata["pipeline_times"].values()
        passes.append({name.partition("_")[2] for name in times})
    assert passes[1] < passes[0]
    assert len(passes[0] - passes[1]) == len(private_numba.SKIPPED_PASSES)


PRIVATE_FILES = {"kernel_cache.py", "private_numba.py", "struct_attributes.py"}
LISTED = [(module, name) for module, names in private_numba.PRIVATE_PARTS.items() for name in names]


@pytest.mark.parametrize(("module", "name"), LISTED)
def test_a_missing_private_part_is_named(module, name, monkeypatch):
    """So that the public path is taken in its place."""
    assert private_numba.missing_part() is None
    *path, last = name.split(".")
    owner = importlib.import_module(module)
    for step in path:
        owner = getattr(owner, step)
    classes = owner.__mro__ if isinstance(owner, type) else (owner, *type(owner).__mro__)
    owners = [owner for owner in classes if last in vars(owner)]
    for definition in owners:
        monkeypatch.delattr(definition, last)
    assert compiler.why_public() == f"numba {numba.__version__} has no {module}.{name}"


@pytest.mark.parametrize(
    ("owner", "name"),
    [(owner, name) for owner, (_, names) in private_numba.samples().items() for name in names],
)
def test_a_missing_attribute_of_an_object_is_named(owner, name, monkeypatch):
    sample, names = private_numba.samples()[owner]
    first, *rest = name.split(".")
    attributes = {key: getattr(sample, key) for key in (name.split(".")[0] for name in names)}
    assert not private_numba.lacks(SimpleNamespace(**attributes), name)
    attributes[first] = None
    if not rest:
        del attributes[first]
    poorer = {owner: (SimpleNamespace(**attributes), names)}
    monkeypatch.setattr(private_numba, "samples", lambda: poorer)
    assert compiler.why_public() == f"numba {numba.__version__} has no {owner}.{name}"


def test_private_parts_are_imported_by_three_files_alone():
    """PRIVATE_PARTS lists all their imports from numba."""
    listed = {f"{module}.{name.split('.')[0]}" for module, name in LISTED}
    imported = {}
    for path in sorted((PACKAGE / "compiling").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module.startswith("numba.core"):
                names = {f"{node.module}.{alias.name}" for alias in node.names}
                imported.setdefault(path.name, set()).update(names)
    assert set(imported) == PRIVATE_FILES
    assert set().union(*imported.values()) <= listed


def test_attributes_with_an_underscore_are_in_the_lists():
    """Private attributes of numba's objects that the private path reads or sets."""
    listed = {name.rpartition(".")[2] for _, name in LISTED}
    for _, names in private_numba.samples().values():
        listed |= {step for name in names for step in name.split(".")}
    attributes, defined = set(), set()
    for name in PRIVATE_FILES:
        tree = ast.parse((PACKAGE / "compiling" / name).read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                defined.add(node.name)
            if isinstance(node, ast.Attribute) and node.attr.startswith("_"):
                is_own = isinstance(node.ctx, ast.Store) and getattr(node.value, "id", "") == "self"
                (defined if is_own else attributes).add(node.attr)
    unlisted = {name for name in attributes - defined if not name.startswith("__")}
    assert unlisted <= listed
    assert unlisted >= {"_codegen", "_cache", "_get_implementation", "_rebuild", "_reload_init"}
