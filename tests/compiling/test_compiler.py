"""The parts of numba that compiler.py replaces, and the same bits from what is compiled."""

import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numba
import numpy as np
import pytest
from brute_force import begin, run, settings

import roughgas
from roughgas.compiling import compiler
from roughgas.compiling.jit import compiled, entry

PACKAGE = Path(roughgas.__file__).parent


def test_the_kernel_has_no_reference_counts():
    """So it cannot allocate."""
    with pytest.raises(numba.TypingError, match="NRT required"):
        entry(lambda: np.zeros(3))()
    assert numba.njit(lambda: np.zeros(3))().size == 3


@compiled
def twice(x):
    return 2.0 * x


def test_only_what_is_called_from_python_is_finished():
    """If numba, too, left the rest unfinished, compiler.Library would no longer be needed."""

    @entry
    def four_times(x):
        return twice(twice(x))

    assert four_times(1.5) == 6.0
    engine = compiler.cpu_target.target_context.codegen()._engine
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


def test_what_numba_had_compiled_before_is_called(tmp_path):
    """It, and its `sum`, are finished by numba's own library."""
    program = tmp_path / "before.py"
    program.write_text(BEFORE)
    run = [sys.executable, str(program)]
    said = subprocess.run(run, env={"PYTHONPATH": str(PACKAGE.parent)}, capture_output=True)
    assert said.stdout.split() == [b"3", b"4"], said.stderr.decode()


def test_int_max_and_min_are_pythons():
    """Of integers, booleans, floats, NaN and tuples; and none of numba's own is linked."""

    @entry
    def values(x, k, widths):
        whole = int(x), int(k), int(x > k)
        return whole, max(x, k), min(x, k), max(k, x, 2.5), max(widths), min(widths)

    for x in (3.75, -0.5, 0.0, float("inf"), float("nan")):
        finite = x if np.isfinite(x) else 1.0
        arguments = (finite, 2, (x, 1.5, 0.0))
        np.testing.assert_equal(values(*arguments), values.py_func(*arguments))
    (overload,) = values.dispatcher.overloads.values()
    libraries = compiler._callers_first(overload.library)
    assert {one.name for one in libraries if not isinstance(one, compiler.Library)} <= {"nrt"}


def test_threads_compile_at_the_same_time():
    """Functions of a user and of ours, one of ours by all threads."""

    @entry
    def shared(x):
        return twice(x) + 1.0

    def compile_three(k):
        mine, users = entry(lambda x: twice(twice(x))), numba.njit(lambda x: twice(x) - x)
        return mine(float(k)), users(float(k)), shared(float(k))

    with ThreadPoolExecutor(4) as threads:
        values = [*threads.map(compile_three, range(8))]
    assert values == [(4.0 * k, 1.0 * k, 2.0 * k + 1.0) for k in range(8)]


def test_every_pass_that_is_left_out_is_one_of_numbas():
    """One that is renamed would be there again, and take its time."""
    passes = []
    for compile_it in (numba.njit, lambda function: entry(function).dispatcher):
        function = compile_it(lambda x: 2.0 * x)
        assert function(1.5) == 3.0
        (about,) = function.get_metadata().values()
        (times,) = about["pipeline_times"].values()
        passes.append({name.partition("_")[2] for name in times})
    assert passes[1] < passes[0]
    assert len(passes[0] - passes[1]) == len(compiler.IDLE)


COPY = """from roughgas.compiling.jit import entry
@entry(cache=True)
def double(x):
    return 2.0 * x
print(double(1.0), sum(double.dispatcher.stats.cache_hits.values()))
"""


def test_copies_of_a_source_share_what_is_compiled(tmp_path):
    """Numba alone would compile each copy, for its path and for its time."""
    environment = {"PYTHONPATH": str(PACKAGE.parent), "ROUGHGAS_CACHE_DIR": str(tmp_path / "cache")}
    said = []
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        copy = tmp_path / folder / "copied.py"
        copy.write_text(COPY)
        run = [sys.executable, str(copy)]
        os.utime(copy, (len(said), len(said)))
        said.append(subprocess.run(run, env=environment, capture_output=True, text=True).stdout)
    assert [one.split() for one in said] == [["2.0", "0"], ["2.0", "1"]]


def test_reading_settings_takes_no_compiler(tmp_path):
    """Neither numba nor a folder for kernels."""
    program = (
        "import sys\n"
        "from roughgas.config import load\n"
        "from roughgas.scene.initial import check\n"
        "settings = {'particles': 16, 'box': [20, 20], 'effects': {'spin': {'inertia': 0.5}}}\n"
        "load('config.yaml'), check(settings)\n"
        "sys.exit('numba' in sys.modules)"
    )
    environment = {"PYTHONPATH": str(PACKAGE.parent), "HOME": str(tmp_path)}
    assert subprocess.run([sys.executable, "-c", program], env=environment).returncode == 0
    assert not list(tmp_path.iterdir())


TESTS = Path(__file__).parent.parent
PROGRAM = """
import json
from brute_force import begin, run, settings
from roughgas.compiling import compiler

scene, state = begin(settings("smooth", 20, [20, 20]), 0.9, -1.0, 11)
rows = run(state, scene, 10, collisions=100)
numbers = {name: [x.hex() for x in column] for name, column in rows.items()}
print(json.dumps({"hash": compiler.source_hash(), "rows": numbers}))
"""


def elsewhere(package_parent, cache_folder):
    """What the program says in a process of its own, with the package in the given folder."""
    path = {"PYTHONPATH": os.pathsep.join([str(package_parent), str(TESTS)])}
    environment = os.environ | path | {"ROUGHGAS_CACHE_DIR": str(cache_folder)}
    command = [sys.executable, "-c", PROGRAM]
    return json.loads(
        subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True).stdout
    )


@pytest.mark.slow
def test_the_same_bits_without_a_cache_and_others_after_an_edit(tmp_path):
    """An edited collision rule is compiled anew, although the old one is in the cache."""
    edited = tmp_path / "edited"
    shutil.copytree(PACKAGE, edited / "roughgas", ignore=shutil.ignore_patterns("__pycache__"))
    rule = edited / "roughgas" / "kernel" / "contact.py"
    text = rule.read_text(encoding="utf-8")
    assert "mass * (1.0 + r)" in text
    rule.write_text(text.replace("mass * (1.0 + r)", "mass * (1.01 + r)"), encoding="utf-8")

    scene, state = begin(settings("smooth", 20, [20, 20]), 0.9, -1.0, 11)
    rows = run(state, scene, 10, collisions=100)  # now the session's cache holds it
    here = {name: [x.hex() for x in column] for name, column in rows.items()}
    session = compiler.kernel_folder().parent
    fresh = elsewhere(PACKAGE.parent, tmp_path / "fresh")
    other = elsewhere(edited, session)
    assert fresh == {"hash": compiler.source_hash(), "rows": here}
    assert list((tmp_path / "fresh").glob(f"kernels-{compiler.source_hash()}/**/*.nbc"))
    assert other["hash"] != compiler.source_hash()
    assert other["rows"]["time"] != here["time"]
    shutil.rmtree(Path(session) / f"kernels-{other['hash']}")


def test_the_hash_covers_the_sources_of_the_kernel_and_no_others(tmp_path, monkeypatch):
    copy = tmp_path / "roughgas"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(compiler, "PACKAGE", copy)
    hashes = {compiler.source_hash()}
    (copy / "tasks" / "dsmc.py").write_text("")
    assert hashes == {compiler.source_hash()}
    sources = [source for room in compiler.ROOMS for source in sorted((copy / room).glob("*.py"))]
    for source in sources:
        source.write_bytes(source.read_bytes() + b"\n")
        hashes.add(compiler.source_hash())
    (copy / "effects" / "another.py").write_text("")
    hashes.add(compiler.source_hash())
    assert len(hashes) == len(sources) + 2


def test_every_compiled_function_lies_in_a_hashed_room():
    """In the kernel's, or in that of the entry which calls it: no source escapes the hash."""
    marks = ["@jit\n", "@compiled\n", "@entry", "njit"]
    outside = [one for one in PACKAGE.rglob("*.py") if one.parent.name not in compiler.ROOMS]
    compiled = [one for one in outside if any(mark in one.read_text() for mark in marks)]
    assert {"tasks", "accuracy"} <= {source.parent.name for source in compiled}
    for source in compiled:
        beside = [other.read_text() for other in source.parent.glob("*.py")]
        assert any("@entry(cache=True)" in text for text in beside), source
