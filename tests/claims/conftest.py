import pytest

from roughgas.claims import judge


@pytest.fixture
def verdicts(tmp_path):
    """A function that judges reduced datasets: the findings by the names of the statements."""

    def judged(*datasets):
        paths = []
        for data in datasets:
            paths.append(tmp_path / f"{data.attrs['experiment']}.nc")
            data.to_netcdf(paths[-1])
        rows = judge(paths, tmp_path / "claims.json", tmp_path / "claims.md")
        return {row.statement.name: row.finding for row in rows}

    return judged
