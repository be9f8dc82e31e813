"""Tables, configurations and movies as HTML, run times, and the configuration of a scale."""

import base64
import json
from pathlib import Path

import pytest
from tests.entry import main

from roughgas import config
from roughgas.data.reduced import read_reduced
from roughgas.results.table import write_times

CONFIG = Path(__file__).parents[3] / "config.yaml"


def html(source, tmp_path):
    assert main(["document", str(source), "--output", str(tmp_path / "shown.html")]) == 0
    return (tmp_path / "shown.html").read_text("utf-8")


def test_markdown_becomes_tables_and_stays_text(tmp_path):
    source = tmp_path / "claims.md"
    source.write_text("# Verdict\n\n| R | β |\n| --- | --- |\n| a < b | **holds** |\n\n<b>$x</b>\n")
    text = html(source, tmp_path)
    assert "<h1>Verdict</h1>" in text and "<th>R</th>" in text
    assert "<td>a &lt; b</td>" in text and "<td><strong>holds</strong></td>" in text
    assert "&lt;b&gt;$x&lt;/b&gt;" in text


def test_pictures_beside_a_text_are_part_of_its_page(tmp_path):
    for name in ("secret.png", "a/pictures/fig 1.png", "a/key.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    named = ["pictures/fig%201.png", "../secret.png", "key.txt", "none.png", "http://x.org/a.png"]
    table = "| ![t](pictures/fig%201.png) |\n| --- |\n"
    (tmp_path / "a/page.md").write_text("\n\n".join([f"![p]({one})" for one in named] + [table]))
    text = html(tmp_path / "a/page.md", tmp_path)
    data = base64.b64encode(b"a/pictures/fig 1.png").decode()
    assert text.count(f'src="data:image/png;base64,{data}"') == 2 and text.count("base64,") == 2
    assert "img-src data:" in text


def test_an_unknown_kind_is_refused(tmp_path, capsys):
    (tmp_path / "a.txt").write_text("text")
    assert main(["document", str(tmp_path / "a.txt"), "-o", str(tmp_path / "a.html")]) == 2
    assert "must end in one of .md, .yaml, .mp4, .gif" in capsys.readouterr().err
    assert not (tmp_path / "a.html").exists()


def test_run_times_are_sums_over_points_and_seeds(points, tmp_path):
    write_times([points / "sheared.nc", points / "cooling.nc"], output=tmp_path / "times.md")
    rows = [line for line in (tmp_path / "times.md").read_text().splitlines() if line[:1] == "|"]
    assert rows[2:] == [
        "| sheared | 40 | 2 | 4 | 4,936 | 1.0 | 4,936 |",
        "| cooling | 40 | 4 | 4 | 4,936 | 1.0 | 4,936 |",
        "| together |  | 6 | 8 | 9,872 | 2.0 | 4,936 |",
    ]
    assert read_reduced(points / "sheared.nc").kernel_seconds.sum().item() == 1.0


@pytest.mark.parametrize("scale", ["paper", "small"])
def test_the_complete_configuration_says_the_same_and_can_be_run(scale, tmp_path):
    path = tmp_path / "config.yaml"
    changes = {"experiments": {"cooling": {"particles": 99}}, "seeds_per_job": 2}
    arguments = [str(CONFIG), f"--scale={scale}", f"--changes={json.dumps(changes)}"]
    assert main(["effective_config", *arguments, "--output", str(path)]) == 0
    given, found = config.load(CONFIG, changes), config.load(path)
    assert found["scale"] == scale and list(found["scales"]) == [scale]
    assert found["seeds_per_job"] == 2
    for name in given["experiments"]:
        assert config.experiment(found, name, scale) == config.experiment(given, name, scale)
    assert config.showcase(found, scale) == config.showcase(given, scale)
    for study in found["studies"]:
        assert config.study(found, study, scale) == config.study(given, study, scale)


def test_the_configuration_of_no_scale_is_refused(tmp_path, capsys):
    path = tmp_path / "config.yaml"
    assert main(["effective_config", str(CONFIG), "--scale=large", f"-o={path}"]) == 2
    assert "scale = 'large': must be one of" in capsys.readouterr().err
    assert not path.exists()
