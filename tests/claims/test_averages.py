"""Lun's formula for R averaged over collisions, on datasets of which the answer is known."""

import pytest
from synthetic import averaged, reduced

from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED


def bed(excess=0.04, experiment="vibrated", **contacts):
    """A bed whose mean of R(t) is `excess` above Lun's formula at r = 0.8 and beta = 0."""
    data = reduced(experiment, lambda r, beta: excess * (1 - r) / 0.2 * (1 - beta**2))
    return averaged(data, **contacts)


@pytest.mark.parametrize(
    ("left", "verdict"), [(0.0, HOLDS), (0.08, QUALIFIED), (1.0, FAILS), (-0.8, FAILS)]
)
def test_lun_over_collisions(judged, left, verdict):
    assert judged("lun_over_collisions", bed(left=left)).verdict == verdict


def test_an_excess_that_is_all_of_averaging(judged):
    found = judged("excess_is_of_averaging", bed())
    numbers = dict(found.numbers)
    assert found.verdict == HOLDS
    assert numbers["R - Lun's formula for the mean of R(t)"].value > 0.03
    assert abs(numbers["R - Lun's formula averaged over collisions"].value) < 3e-4  # 3 sigma


def test_data_without_contacts(judged):
    for name in ("lun_over_collisions", "excess_is_of_averaging"):
        assert judged(name, reduced("vibrated")).verdict == NOT_TESTED
