"""Folders of compiled kernels, named by a hash of sources, and kernels loaded from them."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from brute_force import begin, run, settings

import roughgas
from roughgas.compiling import cache_folders

PACKAGE = Path(roughgas.__file__).parent


COPY = """from roughgas.compiling.jit import entry
@entry(cache=True)
def double(x):
    return 2.0 * x
print(double(1.0), sum(double.dispatcher.stats.cache_hits.values()))
"""


def test_copies_of_a_source_share_machine_code(tmp_path):
    """Numba alone would compile each copy, for its path and for its time."""
    environment = {"PYTHONPATH": str(PACKAGE.parent), "ROUGHGAS_CACHE_DIR": str(tmp_path / "cache")}
    outputs = []
    for folder in ("first", "second"):
        (tmp_path / folder).mkdir()
        copy = tmp_path / folder / "copied.py"
        copy.write_text(COPY)
        run = [sys.executable, str(copy)]
        os.utime(copy, (len(outputs), len(outputs)))
        outputs.append(subprocess.run(run, env=environment, capture_output=True, text=True).stdout)
    assert [output.split() for output in outputs] == [["2.0", "0"], ["2.0", "1"]]


def test_reading_settings_takes_no_compiler(tmp_path):
    """Neither numba nor a folder for kernels."""
    program = (
        "import sys\n"
        "from roughgas.config import load\n"
        "from roughgas.scene.initial import check\n"
        "from roughgas.scene.settings import scene_settings\n"
        "settings = {'particles': 16, 'box': [20, 20], 'effects': {'spin': {'inertia': 0.5}}}\n"
        "load('config.yaml'), check(scene_settings(settings))\n"
        "sys.exit('numba' in sys.modules)"
    )
    environment = {"PYTHONPATH": str(PACKAGE.parent), "HOME": str(tmp_path)}
    assert subprocess.run([sys.executable, "-c", program], env=environment).returncode == 0
    assert not list(tmp_path.iterdir())


TESTS = Path(__file__).parent.parent
PROGRAM = """
import json
from brute_force import begin, run, settings
from roughgas.compiling import cache_folders

scene, state = begin(settings("smooth", 20, [20, 20]), 0.9, -1.0, 11)
rows = run(state, scene, 10, collisions=100)
numbers = {name: [x.hex() for x in column] for name, column in rows.items()}
print(json.dumps({"hash": cache_folders.source_hash(), "rows": numbers}))
"""


def rows_in_process(package_parent, cache_folder):
    """The output of PROGRAM, run by another process with the package in a folder."""
    path = {"PYTHONPATH": os.pathsep.join([str(package_parent), str(TESTS)])}
    environment = os.environ | path | {"ROUGHGAS_CACHE_DIR": str(cache_folder)}
    command = [sys.executable, "-c", PROGRAM]
    return json.loads(
        subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True).stdout
    )


@pytest.mark.slow
def test_the_same_bits_without_a_cache_and_others_after_an_edit(tmp_path):
    """An edited collision rule is compiled anew, although that before is in the cache."""
    edited = tmp_path / "edited"
    shutil.copytree(PACKAGE, edited / "roughgas", ignore=shutil.ignore_patterns("__pycache__"))
    rule = edited / "roughgas" / "kernel" / "contact.py"
    text = rule.read_text(encoding="utf-8")
    assert "mass * (1.0 + r)" in text
    rule.write_text(text.replace("mass * (1.0 + r)", "mass * (1.01 + r)"), encoding="utf-8")

    scene, state = begin(settings("smooth", 20, [20, 20]), 0.9, -1.0, 11)
    rows = run(state, scene, 10, collisions=100)  # now the session's cache holds the kernel
    expected = {name: [x.hex() for x in column] for name, column in rows.items()}
    session = cache_folders.kernel_folder().parent
    fresh = rows_in_process(PACKAGE.parent, tmp_path / "fresh")
    after_edit = rows_in_process(edited, session)
    assert fresh == {"hash": cache_folders.source_hash(), "rows": expected}
    assert list((tmp_path / "fresh").glob(f"kernels-{cache_folders.source_hash()}/**/*.nbc"))
    assert after_edit["hash"] != cache_folders.source_hash()
    assert after_edit["rows"]["time"] != expected["time"]
    shutil.rmtree(Path(session) / f"kernels-{after_edit['hash']}")


def test_the_hash_covers_the_sources_of_the_kernel_and_no_others(tmp_path, monkeypatch):
    copy = tmp_path / "roughgas"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(cache_folders, "PACKAGE", copy)
    hashes = {cache_folders.source_hash()}
    (copy / "tasks" / "dsmc.py").write_text("")
    assert hashes == {cache_folders.source_hash()}
    sources = [
        source for room in cache_folders.ROOMS for source in sorted((copy / room).glob("*.py"))
    ]
    for source in sources:
        source.write_bytes(source.read_bytes() + b"\n")
        hashes.add(cache_folders.source_hash())
    (copy / "effects" / "another.py").write_text("")
    hashes.add(cache_folders.source_hash())
    assert len(hashes) == len(sources) + 2


def test_every_compiled_function_lies_in_a_hashed_room():
    """The kernel's rooms, or the room of its entry: no source escapes the hash."""
    marks = ["@jit\n", "@compiled\n", "@entry", "njit"]
    paths = [path for path in PACKAGE.rglob("*.py") if path.parent.name not in cache_folders.ROOMS]
    compiled = [path for path in paths if any(mark in path.read_text() for mark in marks)]
    assert {"tasks"} <= {path.parent.name for path in compiled}
    for path in compiled:
        texts = [neighbour.read_text() for neighbour in path.parent.glob("*.py")]
        assert any("@entry(cache=True)" in text for text in texts), path
