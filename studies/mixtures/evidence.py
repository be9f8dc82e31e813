"""Two species of a cooling gas against the theory of Santos and Megias, as rows of evidence."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row, point_text, species_at

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
                point = dict(zip(states.names, state, strict=True))
                for species in (0, 1) if name == "R" else (1,):
                    yield _row(gas, point, name, species)


def _row(gas: xr.Dataset, point: dict[str, float], name: str, species: int) -> Row:
    theories = species_at(gas.attrs, point)
    values = gas.sel(point).isel(species=species)
    value, error = (float(values[f"{name}_species{end}"]) for end in ("", "_stderr"))
    shares = thermal_share(theories.T_tr, point.get("mass", 1.0), gas.attrs["particles"])
    if name == "R":
        theirs, corrected = (
            theories.R[species],
            value * shares[species] / (1 - value * (1 - shares[species])),
        )
    else:
        theirs, corrected = theories.T_tr[1] / theories.T_tr[0], value * shares[0] / shares[1]
    return Row(
        quantity=QUANTITIES[name],
        at=point_text(point) + (f", species {species + 1}" if name == "R" else ""),
        tier="theory",
        source=SOURCE,
        read=READ,
        theirs=Estimate(float(theirs), 0.0),
        ours=Estimate(corrected, error, float(values.n_seeds) - 1.0),
        corrections=f"the momentum is fixed: {corrected - value:+.4f}",
        reason=REASON,
    )


def thermal_share(T, mass: float, particles: int) -> np.ndarray:
    """Return the thermal share of T_tr of two species, equal in number, of masses 1 and `mass`,
    when the total momentum is fixed: m <(v - V)^2> over T, V being the velocity of the centre of
    mass."""
    m = np.array([1.0, mass])
    total = particles * m.mean()
    return 1.0 - 2.0 * m / total + m * particles * np.mean(m * T) / (T * total**2)
