"""Two species of a cooling gas beside the theory of Santos and Megias, row by row."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row, place_of, species_at

SOURCE = "Santos 2018, doi:10.1103/PhysRevE.98.012904; Megias & Santos 2019, arXiv:1809.02327"
READ = "state in which all temperatures fall at one rate; energy production rates derived anew"
REASON = "velocities and spins are not Maxwellian"
QUANTITIES = {
    "R": "R of a species of cooling disks",
    "T_ratio": "T_2/T_1 of two species of cooling disks",
}


def rows(*gases: xr.Dataset) -> Iterator[Row]:
    """Yield R of both species, and the ratio of their temperatures, at each point."""
    for name in QUANTITIES:
        for gas in gases:
            states = gas.R.to_series().dropna().index
            for state in states:
                place = dict(zip(states.names, state, strict=True))
                for species in (0, 1) if name == "R" else (1,):
                    yield _row(gas, place, name, species)


def _row(gas: xr.Dataset, place: dict[str, float], name: str, species: int) -> Row:
    T = species_at(gas.attrs, place)
    one = gas.sel(place).isel(species=species)
    value, error = (float(one[f"{name}_species{end}"]) for end in ("", "_stderr"))
    kept = share_kept(T.T_tr, place.get("mass", 1.0), gas.attrs["particles"])
    if name == "R":
        theirs, corrected = T.R[species], value * kept[species] / (1 - value * (1 - kept[species]))
    else:
        theirs, corrected = T.T_tr[1] / T.T_tr[0], value * kept[0] / kept[1]
    return Row(
        quantity=QUANTITIES[name],
        at=place_of(place) + (f", species {species + 1}" if name == "R" else ""),
        tier="theory",
        source=SOURCE,
        read=READ,
        theirs=Estimate(float(theirs), 0.0),
        ours=Estimate(corrected, error, float(one.n_seeds) - 1.0),
        corrections=f"the momentum is fixed: {corrected - value:+.4f}",
        reason=REASON,
    )


def share_kept(T, mass: float, particles: int) -> np.ndarray:
    """Return the share of T_tr that each of two species has without the momentum of the whole, of
    masses 1 and `mass`, as many of each: m <(v - V)^2>, V being that of the centre of mass."""
    m = np.array([1.0, mass])
    total = particles * m.mean()
    return 1.0 - 2.0 * m / total + m * particles * np.mean(m * T) / (T * total**2)
