"""The public path: the choice of it, the names of numba that it uses, its bits, and its cache."""

import ast
import json
import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import NamedTuple

import numba
import pytest
from slow_cases import slow_but

import roughgas
from roughgas.base import InputError
from roughgas.compiling import compiler, public_cache, simd

PACKAGE = Path(roughgas.__file__).parent
NEEDS_PRIVATE = pytest.mark.skipif(
    compiler.why_public() is not None, reason="the private path is tested with older versions"
)
TESTS = Path(__file__).parent.parent
PAGE = TESTS.parent / "docs" / "compiling.md"


def python(folder, program, **variables):
    """(standard output, standard error) of a program, which is written to a folder."""
    path = folder / "program.py"
    path.write_text(program)
    paths = {"PYTHONPATH": os.pathsep.join([str(PACKAGE.parent), str(TESTS)])}
    environment = {key: value for key, value in os.environ.items() if key != compiler.SWITCH}
    environment |= paths | variables
    ran = subprocess.run([sys.executable, path], env=environment, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout, ran.stderr


# ------------------------------------------------------------------ the choice


@pytest.mark.parametrize("version", ["0.69.0", "0.69.0rc1", "0.70.0dev0+5.g1", "1.0.0"])
def test_a_newer_numba_means_the_public_path(version, monkeypatch):
    monkeypatch.setattr(numba, "__version__", version)
    assert compiler.why_public() == f"numba {version} is newer than 0.68"


@NEEDS_PRIVATE
@pytest.mark.parametrize("version", ["0.63.0", "0.68.0", "0.68.12"])
def test_a_tested_numba_means_the_private_path(version, monkeypatch):
    monkeypatch.setattr(numba, "__version__", version)
    assert compiler.why_public() is None


SUM = """
import sys
import numba, numba.core.codegen
{change}
from roughgas.compiling.jit import compiled, entry

@compiled
def double(x):
    return 2.0 * x

@entry
def total(x, k):
    return double(x) + max(k, 2) + int(x)

print(total(1.5, 3), total(1.5, 1.0), "roughgas.compiling.private_numba" in sys.modules)
"""
NEWER, MISSING = "numba.__version__ = '0.99.0'", "del numba.core.codegen.JITCodeLibrary"
CHOICES = [  # a change of numba, the switch, whether the path is private, the warning
    ("", "", True, None),
    ("", "1", False, None),
    (NEWER, "", False, "numba 0.99.0 is newer than 0.68"),
    (NEWER, "1", False, None),
    (NEWER, "0", True, None),
    (MISSING, "", False, "JITCodeLibrary"),
    (MISSING, "1", False, None),
]


@NEEDS_PRIVATE
@pytest.mark.parametrize(
    ("change", "switch", "is_private", "reason"),
    # each takes a process; two of them reach every branch of the choice and of the warning
    slow_but([CHOICES[0], CHOICES[5]], CHOICES),
)
def test_the_path_is_chosen_with_one_line_of_warning_at_most(
    change, switch, is_private, reason, tmp_path
):
    output, warnings = python(tmp_path, SUM.format(change=change), ROUGHGAS_PUBLIC_NUMBA=switch)
    assert output.split() == ["7.0", "6.0", str(is_private)]
    if reason is None:
        assert warnings == ""
    else:
        (warning,) = warnings.splitlines()
        assert warning.startswith("roughgas: warning: numba ")
        assert reason in warning and "ROUGHGAS_PUBLIC_NUMBA=1" in warning


def test_an_illegal_switch_is_refused(monkeypatch):
    monkeypatch.setenv(compiler.SWITCH, "yes")
    with pytest.raises(InputError, match="ROUGHGAS_PUBLIC_NUMBA = yes: must be 0 or 1"):
        compiler.path.__wrapped__()


# ------------------------------------------------------------------ names of numba

PRIVATE_FILES = {"kernel_cache.py", "private_numba.py", "struct_attributes.py"}
PUBLIC_MODULES = {"numba", "numba.extending", "numba.types", "llvmlite", "llvmlite.binding"}
CONTEXT_METHODS = {"cast", "data_model_manager", "get_dummy_value", "get_value_type"}
LLVMLITE_PARTS = {"_insert", "descr"}


def public_files():
    """{name: syntax tree} of the files that the public path imports."""
    paths = sorted((PACKAGE / "compiling").glob("*.py"))
    assert {path.name for path in paths} >= PRIVATE_FILES | {"public_numba.py", "simd.py"}
    texts = {path.name: path.read_text(encoding="utf-8") for path in paths}
    return {name: ast.parse(text) for name, text in texts.items() if name not in PRIVATE_FILES}


def modules_in(tree):
    """Modules of numba and llvmlite that a file imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module]
        else:
            continue
        yield from (name for name in names if name.split(".")[0] in ("numba", "llvmlite"))


def test_the_public_path_imports_no_private_module():
    imported = {name: {*modules_in(tree)} for name, tree in public_files().items()}
    assert imported["public_numba.py"] == {"numba", "numba.extending"}
    assert set().union(*imported.values()) <= PUBLIC_MODULES


def test_private_means_of_the_public_path_are_those_of_the_page():
    """Methods of the target context, for which numba.extending has no other name."""
    used, llvmlite_parts, page = set(), set(), PAGE.read_text(encoding="utf-8")
    for name in ("public_numba.py", "simd.py", "struct_pointer.py"):
        for node in ast.walk(public_files()[name]):
            if isinstance(node, ast.Attribute):
                owner = getattr(node.value, "id", getattr(node.value, "attr", ""))
                used |= {node.attr} if owner == "context" else set()
                llvmlite_parts |= {node.attr} & LLVMLITE_PARTS
    assert used == CONTEXT_METHODS and llvmlite_parts == LLVMLITE_PARTS
    for name in sorted(used | llvmlite_parts):
        assert f"`{name}`" in page, name


@pytest.mark.parametrize("method", sorted(CONTEXT_METHODS))
def test_the_target_context_has_a_method(method):
    """If numba renames it, both paths end, and this test says why."""
    from numba.core.registry import cpu_target

    assert hasattr(cpu_target.target_context, method)


@NEEDS_PRIVATE
def test_every_private_part_is_on_the_page():
    from roughgas.compiling import private_numba

    page = PAGE.read_text(encoding="utf-8")
    names = [name for names in private_numba.PRIVATE_PARTS.values() for name in names]
    names += [name for _, names in private_numba.samples().values() for name in names]
    for name in names:
        assert f"`{name}`" in page, name


@pytest.mark.parametrize(("features", "has_avx"), [(None, 1), (None, 0), ("+avx2", 1), ("", 1)])
def test_registers_are_those_that_numba_compiles_for(features, has_avx, monkeypatch):
    from numba.core.registry import cpu_target

    monkeypatch.setattr(numba.config, "CPU_FEATURES", features)
    monkeypatch.setattr(numba.config, "ENABLE_AVX", has_avx)
    chosen = cpu_target.target_context.codegen()._get_host_cpu_features()
    for feature in ("+avx512f", "+avx2"):
        assert (feature in simd.processor_features()) == (feature in chosen)


SHOW = """
import ast
{example}
for function in (energy, total_energy):
    print(*map(ast.unparse, function.specialised.values()))
"""


@NEEDS_PRIVATE
@pytest.mark.parametrize("switch", ["0", "1"])
def test_the_example_of_the_page_is_specialised_as_it_says(switch, tmp_path):
    blocks = re.findall(r"```py\n(.*?)\n *```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    example, private, public = map(textwrap.dedent, blocks)
    output, _ = python(tmp_path, SHOW.format(example=example), ROUGHGAS_PUBLIC_NUMBA=switch)
    assert output.startswith({"0": private, "1": public}[switch])


# ------------------------------------------------------------------ bits

RUN = """
import json
from brute_force import begin, run, settings
from roughgas.compiling import compiler

scene, state = begin(settings({kernel!r}, 20), 0.9, -0.5, 11)
columns = run(state, scene, 10, collisions=100)
rows = {{name: [x.hex() for x in column] for name, column in columns.items()}}
print(json.dumps([compiler.path().__name__, rows]))
"""


@pytest.mark.slow
@NEEDS_PRIVATE
@pytest.mark.parametrize("kernel", ["gas", "sheared", "bed"])
def test_both_paths_have_the_same_bits(kernel, tmp_path):
    rows = []
    for switch, name in (("0", "private_numba"), ("1", "public_numba")):
        output, _ = python(tmp_path, RUN.format(kernel=kernel), ROUGHGAS_PUBLIC_NUMBA=switch)
        path, columns = json.loads(output)
        assert path == f"roughgas.compiling.{name}"
        assert len(columns["time"]) == 10
        rows.append(columns)
    assert rows[0] == rows[1]


# ------------------------------------------------------------------ the cache

CACHED = """
from typing import NamedTuple

from roughgas.compiling.jit import entry


class Pair(NamedTuple):
    first: float
    second: float


@entry(cache=True)
def total(pair):
    return pair.first + pair.second
"""
CALL = """
import sys
sys.path.insert(0, {folder!r})
from cached import Pair, total
assert total(Pair(1.0, 2.0)) == 3.0
print("loaded" if sum(total.dispatcher.stats.cache_hits.values()) else "compiled")
"""


@pytest.mark.slow
@NEEDS_PRIVATE
def test_kernels_of_the_public_path_are_cached_and_sealed(tmp_path):
    """In a separate folder; a damaged kernel is compiled again."""
    (tmp_path / "cached.py").write_text(CACHED)
    program, cache = CALL.format(folder=str(tmp_path)), tmp_path / "kernels"

    def call(switch="1"):
        variables = {"ROUGHGAS_CACHE_DIR": str(cache), "ROUGHGAS_PUBLIC_NUMBA": switch}
        return python(tmp_path, program, **variables)

    old = os.umask(0o002)  # as many systems have it
    try:
        assert call() == ("compiled\n", "")
    finally:
        os.umask(old)
    assert call() == ("loaded\n", "")
    assert call(switch="0") == ("compiled\n", "")
    private, public = sorted(cache.iterdir())
    assert public.name == private.name + "-public"
    assert public.stat().st_mode & 0o777 == 0o700
    for pattern in ("*.nbc", "*.nbi"):
        (path,) = public.rglob(pattern)
        content = path.read_bytes()
        path.write_bytes(
            content[: len(content) // 2] + bytes(99) + content[len(content) // 2 + 99 :]
        )
        assert call() == ("compiled\n", ""), pattern
        assert call() == ("loaded\n", ""), pattern
    (path,) = public.rglob("*.nbc")
    path.chmod(0o666)
    assert call() == ("compiled\n", "")


class Local(NamedTuple):
    """A class that processes without this file do not find."""

    value: float


def test_code_for_classes_that_others_do_not_find_is_not_cached():
    module = "roughgas.kernel.record"
    from roughgas.kernel.record import Sampling

    assert public_cache._is_importable(Sampling, module)
    assert public_cache._is_importable(Local, __name__)
    assert not public_cache._is_importable(Local, module)
    nested = [*public_cache._named_tuples((Sampling(1.0, 1, 0), (1, (Local(1.0),))))]
    assert nested == [Sampling, Local]
