"""The study of viscoelastic gases: published exponents stand beside those of the right gases."""

import pytest
from tests.houses import part
from tests.synthetic import viscoelastic

from roughgas.results.evidence import AGREES, DIFFERS

rows = part("viscoelastic", "evidence").rows


@pytest.mark.parametrize("exponent", [5 / 3, 2.0])
def test_roughness_decides_which_exponent_is_expected(exponent):
    found = list(rows(viscoelastic(exponent=exponent)))
    lossless = [abs(float(row.at.split("beta = ")[1])) == 1.0 for row in found]
    assert 0 < sum(lossless) < len(found)
    for row, alone in zip(found, lossless, strict=True):
        assert row.theirs.value == (5 / 3 if alone else 2.0)
        assert row.verdict == (AGREES if row.theirs.value == exponent else DIFFERS)
        assert ("Schwager" in row.source) == alone
