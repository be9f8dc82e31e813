"""Texts of people and of files travel through pages, reports, shells and tables as texts."""

import csv
import json
import re
import shlex
import subprocess
from html import unescape
from pathlib import Path

import pytest
from docutils.core import publish_parts
from markdown_it import MarkdownIt
from show.page.conftest import write
from tests.entry import main
from tests.files import point

from roughgas.base import InputError
from roughgas.base.formatting import in_csv, in_rst, markdown
from roughgas.config import schema
from roughgas.config.provenance import provenance
from roughgas.data.point import write_point
from roughgas.results.reduce import reduce_points
from roughgas.show.pages import policy

SCRIPT = "<script>alert(1)</script>"
EVIL = [
    SCRIPT,
    "<!--<script>",
    "\"'`",
    "$(touch owned) `touch owned` ; touch owned",
    "a\nb",
    "{}|%s",
]
FORMULAS = ["=1+1", "+cmd", "-2+3", "@SUM(A1)", "\t=1"]
RULES = sorted((Path(__file__).parents[1] / "rules").glob("*.smk"))


def made(**about):
    """A point with such attributes."""
    settings = {"experiment_json": '{"particles": 5, "box": [8, 8], "effects": {}}', "command": ""}
    return point()._replace(attributes=point().attributes | settings | about)


def page_of(folder, text):
    """The page of points whose command, scale and label are this text."""
    about = {"command": text, "scale": text, "r_label": text}
    paths = [write(folder, "sheared", "0.9", "0.5", seed, **about) for seed in (1, 2)]
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


@pytest.mark.parametrize("text", [*EVIL, "a | b"])
def test_a_cell_of_a_markdown_table_is_one_cell(text):
    shown = (
        MarkdownIt("commonmark", {"html": False})
        .enable("table")
        .render(markdown(["name", "next"], [[text, "1"]]))
    )
    assert shown.count("<td>") == 2 and "<td>1</td>" in shown


@pytest.mark.parametrize(
    "text", [*EVIL, "x\n\n.. raw:: html\n\n   <b>", "`a <javascript:x>`_", "*"]
)
def test_a_description_stays_a_text_in_the_report(text):
    """Captions are reStructuredText, which could include files and raw HTML."""
    settings = {"halt_level": 2, "report_level": 5}
    caption = f"- ``gas``: {in_rst(text)} 160 particles."
    shown = publish_parts(caption, writer="html", settings_overrides=settings)["body"]
    found = " ".join(unescape(re.sub("<.*?>", "", shown)).split())
    assert found == f"gas: {' '.join(text.split())} 160 particles."
    assert "href" not in shown and "<script" not in shown


@pytest.mark.parametrize("text", FORMULAS)
def test_no_text_in_a_table_is_a_formula(tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    write_point("point.nc", made(scale=text, command=text, experiment=text))
    reduce_points(["point.nc"], "all.nc")
    assert main(["table", "all.nc", "-o", "R.csv"]) == 0
    with open("R.csv", newline="", encoding="utf-8") as lines:
        cells = [cell for row in csv.reader(lines) for cell in row]
    assert f"'{text}" in cells and text not in cells
    assert in_csv(text) == f"'{text}"


@pytest.mark.parametrize("text", [*EVIL, "a\rb", "a,b", "a\r\nb"])
def test_a_text_in_a_table_is_one_cell(tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    write_point("point.nc", made(scale=text))
    reduce_points(["point.nc"], "all.nc")
    assert main(["table", "all.nc", "-o", "R.csv"]) == 0
    with open("R.csv", newline="", encoding="utf-8") as lines:
        head, row = csv.reader(lines)
    assert dict(zip(head, row, strict=True))["scale"] == text.replace("\r", " ")


@pytest.mark.parametrize("value", ["-0.5", "+1e-3", "0.9", "sine", -0.5, "", "a=b"])
def test_numbers_and_words_in_a_table_are_as_they_were(value):
    assert in_csv(value) == value


@pytest.mark.parametrize("name", ["a b", "$(x)", "a;b", "a'b", "a\n", "a/b", "../x", "-x", ""])
def test_names_that_become_parts_of_commands_are_words(name):
    """Scales and experiments, which stand in rules' commands as they are."""
    settings = {"scale": "paper", "experiments": {name: {}}, "scales": {"paper": {}}}
    settings |= {"showcase": {}, "studies": {}}
    with pytest.raises(InputError, match="must consist of lower-case letters"):
        schema.check(settings)


def test_wildcards_hold_nothing_that_means_something_to_a_shell():
    common = (RULES[0].parent / "common.smk").read_text("utf-8")
    allowed = re.compile(re.search('^NAME = r"(.*?)"', common, re.M).group(1))
    for text in (*EVIL, "a b", "*", "a&b", "a>b", "~", "#", "!", "\\", "%"):
        assert not allowed.fullmatch(text)
    for text in ("small", "r0.90", "-1e-3", "+1", "cooling-reference", "seed1"):
        assert allowed.fullmatch(text)
    constraints = Path(RULES[0].parents[1], "Snakefile").read_text("utf-8")
    assert "[^/]" not in constraints


@pytest.mark.parametrize("text", EVIL)
def test_a_dataset_says_a_command_that_a_shell_reads_as_it_was_meant(tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    settings = {"particles": 5, "effects": {}, "note": text}
    about = provenance("gas", settings, ("0.9", "0", "1"), "paper", f"{text}.nc")
    said = subprocess.run(
        ["sh", "-c", f"printf '%s\\0' {about['command']}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.split("\0")[:-1] == shlex.split(about["command"])
    assert shlex.split(about["command"])[-1] == f"{text}.nc"
    assert list(tmp_path.iterdir()) == []


def test_everything_is_quoted_in_every_command_of_a_rule():
    """JSON may hold anything, and so may names of folders."""
    text = "".join(file.read_text("utf-8") for file in [*RULES, RULES[0].parents[1] / "Snakefile"])
    commands = re.findall(r"^ +shell:\n((?:\s+(?:#.*|\".*\")\n)+)", text, re.M)
    placeholders = [re.findall(r"\{.*?\}", command) for command in commands]
    assert len(commands) == len(re.findall("^ +shell:", text, re.M)) > 20 and all(placeholders)
    assert [one for some in placeholders for one in some if not one.endswith(":q}")] == []


@pytest.mark.parametrize("name", ["a b.nc", "$(touch owned).nc", "a'b\".nc", "<b>.nc", "=1+1.nc"])
def test_names_of_files_are_names(tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    write_point(name, made())
    assert main(["reduce", name, "-o", "all.nc"]) == 0
    assert main(["show", name, "none"]) == 1
    assert capsys.readouterr().out.startswith(f"{name}: point\n")
    assert not Path("owned").exists()
