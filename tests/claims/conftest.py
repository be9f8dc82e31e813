import pytest

from roughgas.claims import OPEN_QUESTIONS, PAPER, judge


@pytest.fixture
def verdicts(tmp_path):
    """A function that judges reduced datasets: the findings by the names of the statements."""
    return _judging(tmp_path, PAPER)


@pytest.fixture
def answers(tmp_path):
    """The same for what the paper leaves open."""
    return _judging(tmp_path, OPEN_QUESTIONS)


def _judging(tmp_path, subject):
    def judged(*datasets):
        paths = []
        for data in datasets:
            paths.append(tmp_path / f"{data.attrs['experiment']}.nc")
            data.to_netcdf(paths[-1])
        rows = judge(paths, tmp_path / "claims.json", tmp_path / "claims.md", subject)
        return {row.statement.name: row.finding for row in rows}

    return judged
