"""Numbers as JSON has them."""

import math
from typing import Any

import numpy as np

DIGITS = 5


def exact(value: Any) -> float | int | None:
    """A number as it is, to the last bit; None where it is not finite."""
    number = np.asarray(value).item()
    return number if math.isfinite(number) else None


def rounded(values: Any) -> list[float | None]:
    """Numbers to DIGITS digits, for what is only looked at; None where one is not finite."""
    return [float(f"{x:.{DIGITS}g}") if math.isfinite(x) else None for x in np.asarray(values)]
