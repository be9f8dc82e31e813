import pytest

from roughgas.claims import OPEN_QUESTIONS, PAPER
from roughgas.claims.evidence import beside_theory
from roughgas.claims.statements import examine


@pytest.fixture(scope="session")
def judged():
    """A function that judges reduced datasets: the finding on the statement of a name."""
    statements = {one.name: one for one in PAPER.statements + OPEN_QUESTIONS.statements}

    def finding(name, *datasets):
        known = {data.attrs["experiment"]: beside_theory(data) for data in datasets}
        return examine(statements[name], known)

    return finding
