import pytest
from tests.houses import statements

from roughgas.claims import examine
from roughgas.claims.evidence import beside_theory


@pytest.fixture(scope="session")
def judged():
    """A function that judges reduced datasets: the finding on the statement of a name."""
    every = statements()

    def finding(name, *datasets):
        known = {data.attrs["experiment"]: beside_theory(data) for data in datasets}
        return examine(every[name], known)

    return finding
