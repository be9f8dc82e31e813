"""What makes it a project that others can join, cite and install: forms, metadata, the paper."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PAGES = ("CONTRIBUTING.md", "CODE_OF_CONDUCT.md", "docs/compared.md", "docs/development.md")
PAGES += ("config/README.md",)
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    path = ROOT / page
    links = [link for link in LINK.findall(path.read_text()) if "://" not in link]
    assert [link for link in links if link != r"RAW/\1" and not (path.parent / link).exists()] == []
