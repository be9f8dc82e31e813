"""The living page as it is put together; tests/browser/test_living.py looks at what it does."""

from pathlib import Path

from tests.entry import main

ROOT = Path(__file__).parents[3]
MOST = 60_000  # bytes


def test_the_committed_page_is_what_the_command_writes_and_small(tmp_path):
    page = tmp_path / "living.html"
    assert main(["living", "--config", str(ROOT / "config.yaml"), "-o", str(page)]) == 0
    again = (
        "write it anew: python -m roughgas.steps living --config=config.yaml -o=docs/living.html"
    )
    assert (ROOT / "docs/living.html").read_bytes() == page.read_bytes(), again
    assert page.stat().st_size < MOST
