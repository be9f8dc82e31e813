"""docs/effects.md tells what the code does."""

import pytest
import yaml

from effects import page
from roughgas import config
from roughgas.base import InputError
from roughgas.effects import KINDS
from roughgas.scene import build

REFUSED = [[cell.strip("`") for cell in row] for row in page.rows(page.section("What is refused"))]


def test_the_table_of_effects_is_that_of_the_code():
    assert page.written() == page.table(), "write it anew: python tests/effects/page.py"


@pytest.mark.parametrize(("settings", "answer"), REFUSED)
def test_what_is_refused_and_how(settings, answer):
    experiment = yaml.safe_load(f"{{{settings}}}")
    beta = 0.0 if "spin" in experiment["effects"] else -1.0
    with pytest.raises(InputError) as caught:
        build(experiment, 0.9, beta)
    assert str(caught.value) == answer


def test_the_experiment_at_the_top_is_legal(tmp_path):
    text = page.PAGE.read_text(encoding="utf-8").split("\n## ")[0]
    file = page.config_with(page.block(text, "yaml"), tmp_path)
    settings = config.experiment(config.load(file), "tilted_bed", "paper")
    there = {name for name, own in settings["effects"].items() if own is not None}
    chosen = {"spin", "gravity", "floor", "walls", "friction"}
    assert there == chosen | {"contact_averages"} <= set(KINDS)
    assert len(config.every_variant("tilted_bed", settings)) == 3
