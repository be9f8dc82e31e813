"""What `roughgas show` says of a point: R beside theory, energies, species, altered contacts."""

import math

from xarray import DataArray, Dataset

from roughgas.base.layout import columns
from roughgas.data.netcdf import unit_of
from roughgas.statistics.errors import Estimate
from roughgas.theory.prediction import equation_of

FEW = 0.01
"""Share of contacts altered by the contact-time model, above which a result depends on it."""
OF_SPECIES = ("E_trans", "E_rot", "R")


def theory_beside(point: Dataset, R: float, expected: float) -> list[list[str]]:
    """Return what theory says of R, and how far off R is; or why it says nothing."""
    name = equation_of(point.attrs, point).name
    if math.isnan(expected):
        spins = "contacts change no spin, and spins that are 0 stay so"
        return [["theory", f"none ({name}): at beta = -1 {spins}"]]
    return [["theory", f"{expected:.4f}, {name}: R is {_off(R, expected)} it"]]


def collisional(point: Dataset) -> list[list[str]]:
    """Return R averaged over collisions, as the theory of a driven gas is."""
    if "R_collisional" not in point:
        return []
    found = Estimate(float(point.R_collisional), float(point.R_collisional_stderr))
    like = equation_of(point.attrs, point).name
    said = f"averaged over collisions, as {like}"
    if "R_unsubtracted" in point:
        said = f"averaged over collisions, mean flow and mean spin included, unlike {like}"
    return [["R_collisional", f"{found}, {said}"]]


def energies(point: Dataset) -> list[list[str]]:
    """Return the energies of a point, with their errors where they are known."""
    when = ", as the measurement begins" if "plateau_end" in point else ""
    return [
        [name, f"{_estimate(point, name)} {_unit(point[name])}, per degree of freedom{when}"]
        for name in ("E_trans", "E_rot")
        if name in point
    ]


def altered(point: Dataset) -> list[list[str]]:
    """Return how many contacts the contact-time model has altered, where it acts."""
    share = float(point.get("contact_time_fraction", 0.0))
    if not share > 0.0:
        return []
    said = f"{100.0 * share:.2g} % of contacts were altered by the contact-time model"
    return [["contact time", f"{said}: R depends on it" if share > FEW else said]]


def by_species(point: Dataset) -> str:
    """Return a row for each species of a mixture."""
    there = [name for name in OF_SPECIES if f"{name}_species" in point]
    rows = [["species", "particles", *there]]
    for k, name in enumerate(point.species.values):
        one = point.isel(species=k)
        found = [_estimate(one, f"{name}_species") for name in there]
        rows.append([str(name), str(int(one.species_particles)), *found])
    return columns(rows, numbers=True)


def _estimate(point: Dataset, name: str) -> str:
    return f"{Estimate(float(point[name]), float(point.get(f'{name}_stderr', math.nan)))}"


def _unit(array: DataArray) -> str:
    return unit_of(array.attrs)


def _off(value: float, expected: float) -> str:
    return f"{abs(value - expected):.4f} {'below' if value < expected else 'above'}"
