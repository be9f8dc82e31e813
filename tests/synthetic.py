"""Reduced datasets as simulations would give them, but with R known beforehand."""

import json
from collections.abc import Callable

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.data.variables import third_axis
from roughgas.theory.prediction import predicted_ratio, species_at

BETA = (-0.95, *(round(-0.9 + 0.1 * step, 1) for step in range(20)))


def reduced(
    experiment: str = "vibrated",
    shift: Callable[..., np.ndarray] = lambda r, beta, *third: 0 * r * beta,
    r: tuple[float, ...] = (0.8, 0.9, 0.99),
    beta: tuple[float, ...] = BETA,
    error: float = 0.001,
    seeds: int = 4,
    third: tuple[str, tuple] | None = None,
    about: dict[str, object] | None = None,
    **others: float | np.ndarray,
) -> xr.Dataset:
    """R = theory + shift(r, beta) + noise of standard error `error`; `variables` are set, too.

    `third`: a parameter that is swept besides, such as "friction.mu", with its values; `shift` then
    gets these, too. `about` are further attributes. With `input_spin_share` among the variables,
    theory takes the share of rotation from the energy balance.
    """
    spheres = experiment.endswith("spheres")
    attributes = {
        "experiment": experiment,
        "scale": "small",
        "dimension": 3 if spheres else 2,
        "inertia": 0.4 if spheres else 0.5,
        "particles": 160,
        "packing": 0.05,
        "theory": "K" if experiment.startswith("cooling") else "lun",
    } | (about or {})
    axes = {"r": list(r), "beta": list(beta)}
    if third is not None:
        attributes["swept"], values = third
        name = third_axis(attributes)
        attributes.pop(name, None)
        axes = {name: list(values)} | axes
    grids = np.meshgrid(*axes.values(), indexing="ij")
    places = dict(zip(axes, grids, strict=True))
    exact = shift(places["r"], places["beta"], *grids[:-2])
    if "input_spin_share" in others:
        places["spin_share"] = others["input_spin_share"]
    exact = exact + predicted_ratio(attributes | places, places["r"], places["beta"])
    rng = np.random.default_rng(len(experiment))
    noise = rng.normal(0, error * np.sqrt(seeds), (*exact.shape, seeds))
    ratio = exact[..., None] + noise
    spread = ratio.std(-1, ddof=1) / np.sqrt(seeds) if seeds > 1 else np.full(exact.shape, error)
    values = {
        "R": ratio.mean(-1).clip(0.0, 1.0),  # as a share of the energy is
        "R_stderr": error,
        "R_stderr_over_seeds": spread,
        "R_dof": 30.0 * seeds,
        "R_stderr_within": error,
        "E_trans": 1.0,
        "n_seeds": seeds,
        "equilibrated": 1.0,
        "measured_for": 2000.0,
        "collisions": 1000000,
        "contact_time_fraction": 0.0,
        "R_drift": noise[..., 0] / 10,
        "R_drift_stderr": error,
    } | others
    variables = {name: (tuple(axes), np.full(exact.shape, value)) for name, value in values.items()}
    variables["R_seed"] = ((*axes, "seed"), ratio)
    return xr.Dataset(variables, axes | {"seed": np.arange(1, seeds + 1)}, attributes)


HALF = [
    {"name": "first", "fraction": 0.5, "radius": 1, "mass": 1},
    {"name": "second", "fraction": 0.5, "radius": 2, "mass": 2},
]


def mixed(experiment, third, shift=0.0, hotter=1.0, species=HALF, **how) -> xr.Dataset:
    """A mixture: R of each species is theory + `shift`, and T_2/T_1 is `hotter` times theory,
    or `hotter` itself in a driven gas."""
    mixture = {"species": species, "species_pairs": [], "volume": 1e4}
    attributes = {"species_json": json.dumps(mixture)}
    data = reduced(experiment, third=third, about=attributes, **how)
    name, shape = third_axis(data.attrs), (*data.R.shape, len(species))
    T_tr, R = np.ones(shape), np.empty(shape)
    for index in np.ndindex(data.R.shape):
        point = data.isel(dict(zip(data.R.dims, index, strict=True)))
        coordinates = {key: point[key].item() for key in ("r", "beta", name)}
        measured = np.array([1.0, hotter])[: len(species)]
        state = species_at(data.attrs, coordinates, measured)
        T_tr[index], R[index] = state.T_tr, state.R + shift
    if data.attrs["theory"] == "K":
        T_tr[..., -1] *= hotter
    values = {"E_trans_species": T_tr / 2, "R_species": R, "E_rot_species": T_tr * R / (1 - R) / 2}
    values["T_ratio_species"] = T_tr / T_tr[..., :1]
    values |= {f"{key}_stderr": np.full(shape, 0.001) for key in values}
    dims = (*data.R.dims, "species")
    data = data.assign({key: (dims, value) for key, value in values.items()})
    return data.assign_coords(species=[key["name"] for key in species])


def averaged(
    data: xr.Dataset,
    left: float = 0.0,
    correlation: Callable[[np.ndarray], np.ndarray] = lambda beta: 0 * beta,
) -> xr.Dataset:
    """Data with R averaged in other ways: over collisions it is larger, by the share `left`, than
    Lun's formula at the correlation that contacts have; the ratio of means is half-way from R."""
    beta, _ = np.meshgrid(data.beta, data.r)
    c = correlation(beta)
    ratio = theory.correlated_ratio(beta, data.attrs["inertia"], c) * (1.0 + left)
    values = {
        "R_ratio_of_means": (data.R.values + ratio) / 2,
        "R_ratio_of_means_stderr": 0.001,
        "R_collisional": ratio + 3e-4 * np.random.default_rng(1).standard_normal(beta.shape),
        "R_collisional_stderr": 3e-4,
        "R_collisional_dof": 100.0,
        "contact_correlation": c,
        "contact_correlation_stderr": 0.002,
        "contact_correlation_dof": 100.0,
    }
    return data.assign({n: (("r", "beta"), np.full(beta.shape, v)) for n, v in values.items()})


def viscoelastic(shift: float = 0.0, exponent: float = 5 / 3) -> xr.Dataset:
    """A cooling gas of viscoelastic disks: R of the present restitution, + `shift`."""
    attributes = {"r_at_speed": 1.0, "packing": 0.0126}
    data = reduced(
        "cooling_viscoelastic", r=(0.9,), beta=(-1.0, 0.0, 1.0), about=attributes, error=1e-6
    )
    data["R"] = data.R.fillna(0.0)  # of smooth disks, whose spins nothing changes, theory has none
    time = np.geomspace(1.0, 1e6, 50)
    energy = np.broadcast_to((1.0 + time / 30.0) ** -exponent, (1, 3, 50))
    R = theory.viscoelastic_ratio(energy, 0.9, data.beta.values[:, None]) + shift
    collisions = np.broadcast_to(np.arange(1.0, 51.0), energy.shape)
    series = {"E_trans_series": energy, "R_series": R, "collisions_per_particle": collisions}
    series["time_series"] = np.broadcast_to(time, energy.shape)
    scalars = {"decay_exponent": exponent, "decay_exponent_stderr": 1e-4}
    scalars |= {"measured_from": 10.0, "plateau_end": 50.0}
    of_points = {name: (data.R.dims, np.full(data.R.shape, x)) for name, x in scalars.items()}
    over_time = {name: ((*data.R.dims, "sample"), x) for name, x in series.items()}
    return data.assign(of_points | over_time)


def couette(shift: float = 0.0) -> xr.Dataset:
    """A gas between sliding walls, whose R is theory's, + `shift`."""
    data = reduced("couette", lambda r, beta: shift + 0.0 * beta, r=(0.9,), error=1e-6)
    return data.assign(shear_rate=data.R.copy(data=np.full(data.R.shape, 0.04)))
