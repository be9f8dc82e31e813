"""The living page as it is put together; tests/browser/test_living.py looks at what it does."""

from pathlib import Path

import pytest
from tests.entry import main

from roughgas import config
from roughgas.base import InputError
from roughgas.show.living import scene_of, settings

ROOT = Path(__file__).parents[3]
CONFIGURATION = config.load(ROOT / "config.yaml")
MOST = 60_000  # bytes


def test_the_committed_page_is_what_the_command_writes_and_small(tmp_path):
    page = tmp_path / "living.html"
    assert main(["living", "--config", str(ROOT / "config.yaml"), "-o", str(page)]) == 0
    again = (
        "write it anew: python -m roughgas.steps living --config=config.yaml -o=docs/living.html"
    )
    assert (ROOT / "docs/living.html").read_bytes() == page.read_bytes(), again
    assert page.stat().st_size < MOST


@pytest.mark.parametrize(
    ("effect", "said"),
    [
        (
            {"walls": {"restitution": 1, "roughness": 1}},
            "effects of vibrated = walls: must be among",
        ),
        ({"floor": {"wave": "sine"}}, "floor of vibrated ="),
        ({"floor": {"roughness": "particles"}}, "floor of vibrated ="),
    ],
)
def test_what_the_page_cannot_simulate_is_refused(effect, said):
    experiment = settings(CONFIGURATION, "vibrated")
    ((name, change),) = effect.items()
    given = experiment["effects"].get(name, {}) | change
    changed = experiment | {"effects": experiment["effects"] | {name: given}}
    with pytest.raises(InputError, match=said):
        scene_of("vibrated", changed)
