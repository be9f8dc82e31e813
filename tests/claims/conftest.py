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
        found = judge(paths, tmp_path / "claims.json", tmp_path / "claims.md", subject)
        return dict(zip((one.name for one in subject.statements), found, strict=True))

    return judged
