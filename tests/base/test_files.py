"""Which code a result depends on."""

import subprocess
import sys

import pytest

from roughgas.base import files


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package of four modules, of which the first imports the second in a function."""
    monkeypatch.setattr(files, "PACKAGE", tmp_path)
    monkeypatch.setattr(files, "_read", files._read.__wrapped__)  # which is cached
    (tmp_path / "room").mkdir()
    modules = {
        "first": "def f():\n    import roughgas.room.second\n",
        "room/second": "import math\n",
        "room/__init__": "",
        "typed": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import roughgas.first\n"
        "else:\n    from roughgas.room import name\n",
    }
    for name, text in modules.items():
        (tmp_path / f"{name}.py").write_text(text)
    return tmp_path


def test_what_is_imported_anywhere_counts_with_the_packages_around(package):
    assert files.closure("first") == {"first", "room", "room.second"}
    assert files.closure("typed") == {"typed", "room"}
    (package / "room" / "__init__.py").write_text("def f():\n    import roughgas.first\n")
    assert files.closure("room.second") == {"room", "room.second"}
    assert files.closure("room") == {"room", "first", "room.second"}
    with pytest.raises(FileNotFoundError):
        files.closure("third")


def test_what_a_module_says_and_the_versions_count(package, monkeypatch):
    (package / "edited.py").write_text("def f():\n    return 1\n")
    hashes = [files.code_of("first", alone=["edited"])]
    (package / "edited.py").write_text("def f():\n    return 1  # a comment\n")
    hashes.append(files.code_of("first", alone=["edited"]))
    (package / "edited.yaml").write_text("a: 1")
    hashes.append(files.code_of("first", alone=["edited"]))
    monkeypatch.setattr(files, "VERSIONS", "numba of tomorrow")
    hashes.append(files.code_of("first", alone=["edited"]))
    assert len(set(hashes)) == 4 and hashes[-1] == files.code_of("first", alone=["edited"])


def test_every_module_that_a_point_imports_counts():
    """Found out by importing, where `closure` reads the sources."""
    modules = ("roughgas.simulation.point", "roughgas.data.point", "roughgas.simulation.clustering")
    script = f"import sys, {', '.join(modules)}; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    imported = {name for name in done.stdout.split() if name.startswith("roughgas.")}
    names = {name.removeprefix("roughgas.") for name in imported}
    assert len(names) > 10
    assert names <= files.closure("simulation.point", "data.point", "simulation.clustering")
