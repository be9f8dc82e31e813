"""`python -m tests.same A B`: whether two folders of results hold the same numbers, bit by bit.

Every variable of every dataset that both have is compared; attributes, files that only one has, and
seconds of CPU are listed or left out.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr

TIMES = ("seconds",)
"""Endings of variables that no two runs share."""


def differences(first: Path, second: Path) -> list[str]:
    """Return a line for each variable that differs between datasets of one name."""
    found = []
    for path in sorted(first.rglob("*.nc")):
        other = second / path.relative_to(first)
        if other.exists():
            found += [f"{path.relative_to(first)}: {one}" for one in _unlike(path, other)]
    return found


def _unlike(one: Path, other: Path) -> list[str]:
    with xr.open_datatree(one) as first, xr.open_datatree(other) as second:
        pairs = [(name, first[name].dataset, second[name].dataset) for name in first.groups]
        return [
            f"{group}{name}"
            for group, a, b in pairs
            for name in sorted({*map(str, a.variables), *map(str, b.variables)})
            if not name.endswith(TIMES) and not _same(a, b, name)
        ]


def _same(a: xr.Dataset, b: xr.Dataset, name: str) -> bool:
    if name not in a.variables or name not in b.variables:
        return False
    x, y = a.variables[name].values, b.variables[name].values
    return x.dtype == y.dtype and x.shape == y.shape and np.array_equal(_bits(x), _bits(y))


def _bits(values: np.ndarray) -> np.ndarray:
    """Return what is compared: bytes of numbers, text as it is."""
    return values if values.dtype.kind in "OUS" else np.ascontiguousarray(values).view(np.uint8)


def main(first: str, second: str) -> int:
    lines = differences(Path(first), Path(second))
    count = sum((Path(second) / p.relative_to(first)).exists() for p in Path(first).rglob("*.nc"))
    print(*lines, f"{count} datasets in both, {len(lines)} variables differ", sep="\n")
    return 1 if lines or not count else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
