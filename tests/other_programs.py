"""Files of other programs, and their particles in the units of a gas, computed by hand."""

from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parent / "data" / "other_programs"


def columns_of(name, frame):
    """(columns by name, bounds (3, 2) of the box) of a frame of a dump, in the order of `id`."""
    frames = (FOLDER / name).read_text().split("ITEM: BOX BOUNDS pp pp pp\n")[1:]
    lines = frames[frame].splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    names = lines[start].split()[2:]
    end = start + 1
    while end < len(lines) and not lines[end].startswith("ITEM"):
        end += 1
    table = np.array([line.split() for line in lines[start + 1 : end]], float)
    table = table[np.argsort(table[:, names.index("id")])]
    return dict(zip(names, table.T, strict=True)), np.array(
        [line.split() for line in lines[:3]], float
    )


def disks_in_gas_units(frame):
    """Variables of a frame of disks.dump, by hand: a is 0.5 and m is pi/4 in its units."""
    columns, bounds = columns_of("disks.dump", frame)
    vector = {name: np.stack([columns[f"{name}{axis}"] for axis in "xy"], 1) for name in ("", "v")}
    return {
        "position": (vector[""] - bounds[:2, 0]) * 2,
        "velocity": vector["v"] * 2,
        "spin": columns["omegaz"][:, None],  # (a w)/a
        "radius": np.ones(16),
        "mass": columns["mass"] / columns["mass"][0],
        "box": np.array([20.0, 16.0]),
    }


def spheres_in_gas_units():
    """Variables of the last frame of spheres.dump, by hand: a is 1 mm, T is 5 ms."""
    columns, _ = columns_of("spheres.dump", -1)
    x, v, w = (
        np.stack([columns[stem.replace("*", axis)] for axis in "xyz"], 1)
        for stem in ("*s", "v*", "omega*")
    )
    radius = columns["diameter"] / 0.002
    return {
        "position": x * 12,
        "velocity": v * 5,
        "spin": w * 0.005 * radius[:, None],
        "radius": radius,
        "mass": columns["mass"] / columns["mass"].min(),
        "species_of": columns["type"] - 1,
        "box": np.full(3, 12.0),
    }
