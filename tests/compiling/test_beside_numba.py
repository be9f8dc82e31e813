"""Numba compiles a user's functions beside the kernel, and none of its attributes is replaced."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import roughgas

TESTS, SOURCES = Path(__file__).parent.parent, Path(roughgas.__file__).parent.parent


@pytest.fixture(scope="module")
def cold(tmp_path_factory):
    """Environment variables of a process with empty caches; the tests of this file share them."""
    folder = str(tmp_path_factory.mktemp("compiled"))
    return {"NUMBA_CACHE_DIR": folder, "ROUGHGAS_CACHE_DIR": folder}


def output_of(program, *arguments, **variables):
    """Lines that a program of this folder prints."""
    paths = {"PYTHONPATH": os.pathsep.join([str(SOURCES), str(TESTS)])}
    environment = os.environ | paths | variables
    command = [sys.executable, "-W", "ignore", str(Path(__file__).with_name(program)), *arguments]
    run = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout.splitlines()


PATHS = pytest.mark.parametrize("switch", ["0", "1"], ids=["private", "public"])
QUICK = "vectorize_eager", "guvectorize", "cfunc", "jit_class", "parallel", "cached"


@pytest.mark.slow
@PATHS
def test_numba_compiles_a_users_functions_before_and_after_a_simulation(switch, tmp_path):
    variables = {"NUMBA_CACHE_DIR": str(tmp_path), "ROUGHGAS_PUBLIC_NUMBA": switch}
    assert output_of("user_code.py", *QUICK, **variables)[-1] == "all"


@pytest.mark.slow
@PATHS
def test_numba_compiles_by_every_public_means_before_and_after_a_simulation(switch, cold):
    """The second process loads the kernel and the cached functions."""
    for _ in range(2):
        assert output_of("user_code.py", ROUGHGAS_PUBLIC_NUMBA=switch, **cold)[-1] == "all"


@pytest.mark.slow
@PATHS
def test_a_simulation_leaves_every_attribute_of_numbas_as_it_was(switch, tmp_path):
    folder = str(tmp_path)
    variables = {"NUMBA_CACHE_DIR": folder, "ROUGHGAS_CACHE_DIR": folder}
    (counts,) = output_of("attributes.py", ROUGHGAS_PUBLIC_NUMBA=switch, **variables)
    assert int(counts.split()[0]) > 10_000
    assert counts.endswith(", 1 snapshots of a compilation")


CODE = "numba.core.registry.cpu_target.target_context.codegen()"
GUILTY = {
    f"{CODE}._library_class = {CODE}._library_class": "._codegen._library_class",
    f"{CODE}.set_env = {CODE}.set_env": "._codegen.set_env",
    "numba.core.event.start_event = lambda *_, **options: None": "numba.core.event.start_event",
    "numba.types.Array.guilty = True": "numba.core.types.npytypes.Array.guilty",
    "numba.float64.guilty = True": ".double.guilty",
    "numba.core.typing.templates.builtin_registry.functions.pop()": ".builtin_registry.functions",
}
"""Statements that change an attribute: the end of its name."""


@pytest.mark.slow
def test_a_changed_attribute_is_named(cold):
    _, *names = output_of("attributes.py", "; ".join(GUILTY), **cold)
    assert len(names) >= len(GUILTY)
    for attribute in GUILTY.values():
        assert any(name.endswith(attribute) for name in names), (attribute, names)
