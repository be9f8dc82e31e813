"""Texts of people and of files travel through pages, reports, shells and tables as texts."""

import csv
import json
import re
import shlex
import subprocess
from html import unescape
from pathlib import Path

import pytest
from raw import provenance
from schedules import TINY
from show.page.conftest import write
from tests.entry import main
from tests.files import point

from roughgas.base import InputError, in_csv, markdown
from roughgas.config import WrittenConfiguration
from roughgas.data.point import write_point
from roughgas.results.reduce import reduce_points
from roughgas.show.pages import policy

SCRIPT = "<script>alert(1)</script>"
EVIL = [SCRIPT, "<!--<script>", "\"'`", "$(touch owned) `touch owned` ; touch owned", "a\nb"]
EVIL += ["{}|%s"]
FORMULAS = ["=1+1", "+cmd", "-2+3", "@SUM(A1)", "\t=1"]
RULES = sorted((Path(__file__).parents[1] / "rules").glob("*.smk"))


def point_with(**changes):
    settings = {"experiment_json": '{"particles": 5, "box": [8, 8], "effects": {}}', "command": ""}
    return point()._replace(attributes=point().attributes | settings | changes)


def page_of(folder, text):
    """The page of points whose command, scale and label are this text."""
    attributes = {"command": text, "scale": text, "r_label": text}
    paths = [write(folder, "sheared", "0.9", "0.5", seed, **attributes) for seed in (1, 2)]
    reduce_points(paths, folder / "sheared.nc")
    arguments = ["explore", str(folder / "sheared.nc"), "--points", str(folder)]
    assert main([*arguments, "-o", str(folder / "page.html")]) == 0
    return (folder / "page.html").read_text("utf-8")


@pytest.mark.parametrize("text", EVIL)
def test_texts_of_datasets_stay_texts_in_the_page(tmp_path, text):
    page = page_of(tmp_path, text)
    head, _, rest = page.partition('<script id="data" type="application/json">')
    data = rest.partition("</script>")[0]
    assert "<" not in data
    (series,) = json.loads(data)["experiments"][0]["variants"][0]["series"]
    assert series["points"][0]["command"] == series["r"] == text
    title = re.search("<title>(.*?)</title>", head, re.S).group(1)
    assert unescape(title).endswith(text) and "<" not in title


def test_the_page_runs_its_own_programs_alone(tmp_path):
    page = page_of(tmp_path, SCRIPT)
    (stated,) = re.findall('Content-Security-Policy" content="(.*?)"', page)
    assert stated == policy(*re.findall(r"<script>(.*?)</script>", page, re.S))
    assert "default-src 'none'" in stated and "unsafe-inline" not in stated.split("script-src")[1]


@pytest.mark.parametrize("text", [*EVIL, "[x](javascript:alert(1))", "![](https://example.org/x)"])
def test_documents_run_nothing_and_load_nothing(tmp_path, text):
    (tmp_path / "a.md").write_text(markdown(["name"], [[text]]), "utf-8")
    (tmp_path / "a.yaml").write_text(text, "utf-8")
    for name in ("a.md", "a.yaml"):
        assert main(["document", str(tmp_path / name), "-o", str(tmp_path / "a.html")]) == 0
        page = (tmp_path / "a.html").read_text("utf-8")
        assert f'content="{policy()}"' in page and "script-src" not in policy()
        assert "<script" not in page and 'href="javascript' not in page


@pytest.mark.parametrize("text", FORMULAS)
def test_no_text_in_a_table_is_a_formula(tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    write_point("point.nc", point_with(scale=text, command=text, experiment=text))
    reduce_points(["point.nc"], "all.nc")
    assert main(["table", "all.nc", "-o", "R.csv"]) == 0
    with open("R.csv", newline="", encoding="utf-8") as lines:
        cells = [cell for row in csv.reader(lines) for cell in row]
    assert f"'{text}" in cells and text not in cells
    assert in_csv(text) == f"'{text}"


@pytest.mark.parametrize("name", ["a b", "$(x)", "a;b", "a'b", "a\n", "a/b", "../x", "-x", ""])
def test_names_that_become_parts_of_commands_are_words(name):
    """Scales and experiments, which stand in rules' commands as they are."""
    settings = {"scale": "paper", "experiments": {name: {}}, "scales": {"paper": {}}}
    with pytest.raises(InputError, match="must consist of lower-case letters"):
        WrittenConfiguration(settings).check("config.yaml")


@pytest.mark.parametrize("text", EVIL)
def test_a_dataset_says_a_command_that_a_shell_reads_as_it_was_meant(tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    settings = TINY | {"note": text}
    attributes = provenance("gas", settings, ("0.9", "0", "1"), "paper", f"{text}.nc")
    completed = subprocess.run(
        ["sh", "-c", f"printf '%s\\0' {attributes['command']}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert completed.stdout.split("\0")[:-1] == shlex.split(attributes["command"])
    assert shlex.split(attributes["command"])[-1] == f"{text}.nc"
    assert list(tmp_path.iterdir()) == []


def test_everything_is_quoted_in_every_command_of_a_rule():
    """JSON may hold anything, and so may names of folders."""
    text = "".join(file.read_text("utf-8") for file in [*RULES, RULES[0].parents[1] / "Snakefile"])
    commands = re.findall(r"^ +shell:\n((?:\s+(?:#.*|\".*\")\n)+)", text, re.M)
    placeholders = [re.findall(r"\{.*?\}", command) for command in commands]
    assert len(commands) == len(re.findall("^ +shell:", text, re.M)) > 20 and all(placeholders)
    assert [
        placeholder
        for group in placeholders
        for placeholder in group
        if not placeholder.endswith(":q}")
    ] == []
