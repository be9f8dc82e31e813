"""docs/config.md has every key of the schema, with what is legal."""

import pytest
from tests.config import page

TABLES = page.tables()


@pytest.mark.parametrize("name", TABLES)
def test_the_page_is_made_from_the_schema(name):
    """If not: python -m tests.config.page."""
    assert page.written(name) == TABLES[name]
