"""Hashes of sources, suggestions, formats and intervals of roughgas.base."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest

from roughgas.base import InputError, Interval, as_json, files, markdown, unknown_name_error


@pytest.mark.parametrize(
    ("name", "guess"),
    [("'coolng'", "cooling"), ("'schedul'", "schedule"), ("fig9", None), (7, None)],
)
def test_the_closest_name_is_suggested(name, guess):
    text = str(unknown_name_error("key", name, ["cooling", "schedule", "fig8"]))
    assert text.startswith(f"key = {name}: must be one of cooling, schedule, fig8")
    assert text.endswith(f"; did you mean {guess}?" if guess else "fig8")


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package of four modules, the first with an import of the second inside a function."""
    monkeypatch.setattr(files, "PACKAGE", tmp_path)
    monkeypatch.setattr(
        files, "_digest_and_imports", files._digest_and_imports.__wrapped__
    )  # without the cache
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


def test_the_closure_has_all_imports_and_their_packages(package):
    assert files.import_closure("first") == {"first", "room", "room.second"}
    assert files.import_closure("typed") == {"typed", "room"}
    (package / "room" / "__init__.py").write_text("def f():\n    import roughgas.first\n")
    assert files.import_closure("room.second") == {"room", "room.second"}
    assert files.import_closure("room") == {"room", "first", "room.second"}
    with pytest.raises(FileNotFoundError):
        files.import_closure("third")


def test_code_hashes_depend_on_source_and_versions(package, monkeypatch):
    (package / "edited.py").write_text("def f():\n    return 1\n")
    hashes = [files.code_of("first", alone=["edited"])]
    (package / "edited.py").write_text("def f():\n    return 1  # a comment\n")
    hashes.append(files.code_of("first", alone=["edited"]))
    (package / "edited.yaml").write_text("a: 1")
    hashes.append(files.code_of("first", alone=["edited"]))
    monkeypatch.setattr(files, "VERSIONS", "numba of tomorrow")
    hashes.append(files.code_of("first", alone=["edited"]))
    assert len(set(hashes)) == 4 and hashes[-1] == files.code_of("first", alone=["edited"])


def test_the_closure_has_every_module_that_a_point_imports():
    """The modules in sys.modules after the import, while `import_closure` parses the sources."""
    modules = ("roughgas.simulation.point", "roughgas.data.point")
    script = f"import sys, {', '.join(modules)}; print(*sys.modules)"
    process = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    imported = {name for name in process.stdout.split() if name.startswith("roughgas.")}
    names = {name.removeprefix("roughgas.") for name in imported}
    assert len(names) > 10
    assert names <= files.import_closure("simulation.point", "data.point")


def test_markdown_has_a_rule_below_its_head():
    head, rows = ["scene", "N"], [["bed", 160], ["shear", 10240]]
    plain = "| scene | N |\n| --- | ---: |\n| bed | 160 |\n| shear | 10240 |\n"
    assert markdown(head, rows, "<>") == plain
    padded = "| scene |     N |\n| ----- | ----: |\n| bed   |   160 |\n| shear | 10240 |\n"
    assert markdown(head, rows, "<>", padded=True) == padded


def test_json_is_strict():
    answer = {
        "a": np.float64(math.inf),
        "b": [math.nan, np.int8(1)],
        3: np.array([[True]]),
        "c": "β",
    }
    assert json.loads(as_json(answer)) == {"a": None, "b": [None, 1], "3": [[True]], "c": "β"}


@pytest.mark.parametrize(
    "interval, inside, outside",
    [
        ("[0, 1]", (0, 0.5, 1), (-1e-9, 1.5, math.nan, math.inf)),
        ("(0, 1]", (1e-9, 1), (0, -0.0)),
        ("(0, inf)", (1e-9, 1e300), (0, math.inf)),
        ("[0, inf]", (0, math.inf), (-1, math.nan)),
    ],
)
def test_intervals_check_their_bounds(interval, inside, outside):
    legal_interval = Interval(interval)
    assert [legal_interval.check("key", value) for value in inside] == list(inside)
    for value in outside:
        with pytest.raises(InputError) as refusal:
            legal_interval.check("key", value)
        assert str(refusal.value).endswith(f"must lie in {interval}")
    assert legal_interval.holds(np.array([*inside, *outside])).sum() == len(inside)
