"""Compiled kernels on disks that are damaged, full or read-only. The kernel here is small, and
compiles in no time; its files have the format of all kernels."""

import hashlib
import os
import pickle
import runpy
import shutil
import tempfile
from pathlib import Path

import pytest

from robustness.conftest import python

pytestmark = pytest.mark.slow

PROGRAM = """
from roughgas.compiling.jit import entry

@entry(cache=True)
def triple(x):
    return 3.0 * x

assert triple(2.0) == 6.0
print("loaded" if sum(triple.dispatcher.stats.cache_hits.values()) else "compiled")
"""


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "program.py"
    path.write_text(PROGRAM)
    return path


def run(program, **options):
    """Return the output of the program, "compiled" or "loaded", and its warnings."""
    done = python(program, cwd=program.parent, **options)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip(), done.stderr


def run_in_process(program, capsys):
    """Return the same of a run in this process, which has loaded the compiler."""
    runpy.run_path(str(program), run_name="__main__")
    return tuple(text.strip() for text in capsys.readouterr())


def with_checksum(text):
    return text + hashlib.sha256(text).digest()


DAMAGES = {
    "cut": lambda content: content[:-100],
    "empty": lambda content: b"",
    "a hole": lambda content: content[:900] + bytes(999) + content[1899:],
    "a pickle of another version": lambda content: with_checksum(b"\x80\x63"),
    "code for other types": lambda content: with_checksum(pickle.dumps(((), ()))),
    "removed": None,
}


def test_damaged_kernels_are_compiled_again(program, monkeypatch, capsys):
    folder = program.parent / "kernels"
    monkeypatch.setenv("ROUGHGAS_CACHE_DIR", str(folder))
    assert run_in_process(program, capsys) == ("compiled", "")
    assert not [path for path in folder.rglob("*") if path.is_dir() and not any(path.iterdir())]
    intact = program.parent / "whole"
    shutil.copytree(folder, intact)
    for name, damage in DAMAGES.items():
        shutil.rmtree(folder)
        shutil.copytree(intact, folder)
        (file,) = folder.rglob("*.nbc")
        if damage is None:
            file.unlink()
        else:
            file.write_bytes(damage(file.read_bytes()))
        assert run_in_process(program, capsys) == ("compiled", ""), name
        assert run_in_process(program, capsys) == ("loaded", ""), name
    assert run(program, ROUGHGAS_CACHE_DIR=str(folder)) == ("loaded", "")


def test_a_full_disk_only_costs_time(program, mounts):
    (program.parent / "kernels").mkdir()
    keep = {"ROUGHGAS_CACHE_DIR": str(program.parent / "kernels")}
    output, warning = run(program, mount=("size=4k", program.parent / "kernels"), **keep)
    assert output == "compiled" and warning.count("\n") == 1
    assert "No space left on device: the kernel is not kept" in warning


@pytest.mark.parametrize("home", [{"HOME": None}, {"HOME": "/proc/nobody"}])
def test_without_a_home_or_a_compiler_kernels_go_to_temporary_files(program, tmp_path, home):
    """Numba needs no C compiler: there is none on an empty PATH."""
    bare = {"ROUGHGAS_CACHE_DIR": None, "XDG_CACHE_HOME": "/proc/none", "PATH": "/nonexistent"}
    bare |= home | {"TMPDIR": str(tmp_path)}
    assert run(program, **bare) == ("compiled", "")
    assert run(program, **bare) == ("loaded", "")
    assert list(tmp_path.glob(f"roughgas-{os.getuid()}/kernels-*/*/*.nbc"))


def test_a_folder_of_somebody_else_is_not_trusted(program):
    if os.getuid():
        pytest.skip("only root can give files away")
    with tempfile.TemporaryDirectory() as folder:
        private = Path(folder, "roughgas-0")
        private.mkdir()
        os.chown(private, 65534, 65534)
        variables = {"ROUGHGAS_CACHE_DIR": "/proc/none", "TMPDIR": folder}
        done = python(program, cwd=program.parent, **variables)
    assert done.returncode != 0 and "belongs to somebody else" in done.stderr


def test_files_that_others_can_write_are_never_unpickled(program, tmp_path, monkeypatch, capsys):
    folder, trap = tmp_path / "kernels", tmp_path / "sprung"
    monkeypatch.setenv("ROUGHGAS_CACHE_DIR", str(folder))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    old = os.umask(0o002)  # as many systems have it
    try:
        assert run_in_process(program, capsys) == ("compiled", "")
    finally:
        os.umask(old)
    (kernels,) = folder.iterdir()
    assert kernels.stat().st_mode & 0o777 == 0o700
    (path,) = (file for file in kernels.rglob("*") if file.is_file())
    assert not path.stat().st_mode & 0o077
    path.write_bytes(with_checksum(pickle.dumps(Trap(str(trap)))))
    path.chmod(0o666)
    assert run_in_process(program, capsys) == ("compiled", "") and not trap.exists()
    assert run_in_process(program, capsys) == ("loaded", "")
    kernels.chmod(0o777)
    assert run_in_process(program, capsys) == ("compiled", "")
    assert list(tmp_path.glob(f"roughgas-{os.getuid()}/kernels-*/*/*.nbc"))


class Trap:
    """An object whose unpickling makes a folder."""

    def __init__(self, folder):
        self.folder = folder

    def __reduce__(self):
        return os.mkdir, (self.folder,)
