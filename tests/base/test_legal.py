import math

import numpy as np
import pytest

from roughgas.base import InputError, Interval


@pytest.mark.parametrize(
    "interval, inside, outside",
    [
        ("[0, 1]", (0, 0.5, 1), (-1e-9, 1.5, math.nan, math.inf)),
        ("(0, 1]", (1e-9, 1), (0, -0.0)),
        ("(0, inf)", (1e-9, 1e300), (0, math.inf)),
        ("[0, inf]", (0, math.inf), (-1, math.nan)),
    ],
)
def test_interval(interval, inside, outside):
    checked = Interval(interval)
    assert [checked.check("key", value) for value in inside] == list(inside)
    for value in outside:
        with pytest.raises(InputError) as refused:
            checked.check("key", value)
        assert str(refused.value).endswith(f"must lie in {interval}")
    assert checked.holds(np.array([*inside, *outside])).sum() == len(inside)
