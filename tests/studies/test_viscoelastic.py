"""The study of viscoelastic gases: each gas is compared with its published exponent."""

import pytest
from tests.study_modules import module_of_study
from tests.synthetic import viscoelastic

from roughgas.results.row_verdicts import AGREES, DIFFERS, verdicts

rows = module_of_study("viscoelastic", "evidence").rows


@pytest.mark.parametrize("exponent", [5 / 3, 2.0])
def test_roughness_decides_which_exponent_is_expected(exponent):
    evidence_rows = list(rows(viscoelastic(exponent=exponent)))
    lossless = [abs(float(row.at.split("beta = ")[1])) == 1.0 for row in evidence_rows]
    assert 0 < sum(lossless) < len(evidence_rows)
    judged = zip(evidence_rows, verdicts(evidence_rows), lossless, strict=True)
    for row, verdict, alone in judged:
        assert row.theirs.value == (5 / 3 if alone else 2.0)
        assert verdict == (AGREES if row.theirs.value == exponent else DIFFERS)
        assert ("Schwager" in row.source) == alone
