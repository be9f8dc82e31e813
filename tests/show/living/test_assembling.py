"""The assembled living page; tests/browser/test_living.py tests its behaviour."""

import re
from pathlib import Path

from tests.entry import main

ROOT = Path(__file__).parents[3]
MAX_SIZE = 64_000  # bytes


def test_the_page_is_one_small_file(tmp_path):
    page = tmp_path / "living.html"
    assert main(["living", "--config", str(ROOT / "config.yaml"), "-o", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "src=" not in text and re.findall("<link.*>", text) == [
        '<link rel="icon" href="data:,">'
    ]
    assert page.stat().st_size < MAX_SIZE
