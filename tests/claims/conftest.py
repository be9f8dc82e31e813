import pytest
from tests.study_modules import statements

from roughgas.claims import examine
from roughgas.claims.verdicts import beside_theory


@pytest.fixture(scope="session")
def judged():
    """Return a function that judges reduced datasets and returns the finding on a statement, by its
    name."""
    every = statements()

    def finding(name, *datasets):
        by_name = {data.attrs["experiment"]: beside_theory(data) for data in datasets}
        return examine(every[name], by_name)

    return finding
