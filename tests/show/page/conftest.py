"""Points and reduced datasets in the layout of the pipeline, with known numbers."""

import numpy as np
import pytest

from roughgas.data.point import Point, write_point
from roughgas.results.reduce import reduce_points

SAMPLES = 450


def write(folder, experiment, r, beta, seed=1, cooling=False, **attribute_changes):
    """Write a point below `folder`, at the path that the pipeline would use; return the path."""
    clock = np.arange(float(SAMPLES))
    ratio = 0.3 + 0.1 * float(beta) + 0.001 * seed
    variables = {
        "R": ratio,
        "R_stderr": 0.004,
        "R_dof": 12.0,
        "R_ci95": 0.009,
        "R_ratio_of_means": ratio,
        "E_trans": 2.0,
        "E_rot": 1.0,
        "collisions": 1234,
        "kernel_seconds": 0.25,
        "equilibrated": 1,
        "measured_from": 100.0,
        "collisions_per_particle" if cooling else "time": clock,
        "R_series": ratio + 0.01 * np.sin(clock),
        "E_trans_series": np.exp(-0.01 * clock),
        "E_rot_series": 0.5 * np.exp(-0.01 * clock),
    }
    if cooling:
        variables["plateau_end"] = 400.0
    else:
        variables |= {"R_collisional": ratio + 0.02, "R_collisional_stderr": 0.003}
        variables |= {"R_collisional_dof": 12.0, "R_collisional_ci95": 0.007}
    path = (
        folder
        / experiment
        / attribute_changes.get("variant", "")
        / f"r{r}"
        / f"beta{beta}"
        / f"seed{seed}.nc"
    )
    attributes = {
        "experiment": experiment,
        "scale": "small",
        "dimension": 2,
        "inertia": 0.5,
        "particles": 40,
        "r": float(r),
        "beta": float(beta),
        "seed": seed,
        "r_label": r,
        "beta_label": beta,
        "command": f"roughgas run {experiment} --r={r} --beta={beta} --seed={seed} </script>",
    }
    write_point(path, Point(variables, attributes | attribute_changes))
    return path


def points_in(folder):
    """Write points of a sheared gas, a cooling gas, and a sweep of friction, and their reduced
    datasets, into `folder`; return it."""
    paths = {"sheared": [], "cooling": [], "cooling_friction": []}
    for beta in ("-0.5", "0.50"):
        paths["sheared"] += [write(folder, "sheared", "0.9", beta, seed) for seed in (1, 2)]
        paths["cooling"] += [write(folder, "cooling", r, beta, cooling=True) for r in ("0.8", "1")]
        for mu in (0.1, 1.0):
            swept = {"swept": "friction.mu", "swept_value": mu, "variant": f"mu{mu:g}", "mu": mu}
            path = write(folder, "cooling_friction", "0.9", beta, cooling=True, **swept)
            paths["cooling_friction"].append(path)
    for name, files in paths.items():
        reduce_points(files, folder / f"{name}.nc")
    return folder


@pytest.fixture
def points(tmp_path):
    return points_in(tmp_path / "small")
