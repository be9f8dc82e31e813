"""What kernel/compiler.py takes of numba's private parts does what it is there for."""

import os
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest

import roughgas
from roughgas.kernel import compiler
from roughgas.kernel.jit import Compiled, compiled, entry

PACKAGE = Path(roughgas.__file__).parent


def double(x):
    return 2.0 * x


def test_the_kernel_has_no_reference_counts():
    """So it cannot allocate."""
    with pytest.raises(numba.TypingError, match="NRT required"):
        entry(lambda: np.zeros(3))()
    assert numba.njit(lambda: np.zeros(3))().size == 3


def test_numba_takes_compiled_functions_for_its_own():
    inner = compiled(double)
    assert numba.typeof(inner) == numba.typeof(inner.dispatcher)
    assert entry(lambda x: inner(x))(3.0) == 6.0


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


COPY = """from roughgas.kernel.jit import entry
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
        "from roughgas.scene import check\n"
        "settings = {'particles': 16, 'box': [20, 20], 'effects': {'spin': {'inertia': 0.5}}}\n"
        "load('config.yaml'), check(settings)\n"
        "sys.exit('numba' in sys.modules)"
    )
    environment = {"PYTHONPATH": str(PACKAGE.parent), "HOME": str(tmp_path)}
    assert subprocess.run([sys.executable, "-c", program], env=environment).returncode == 0
    assert not list(tmp_path.iterdir())


def test_called_from_python_all_but_entries_are_plain_python():
    calls = []
    noted = Compiled(lambda x: calls.append(x))
    noted([])
    assert calls == [[]]
