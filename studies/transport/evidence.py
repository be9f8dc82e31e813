"""Transport coefficients beside Enskog's theory in first Sonine approximation."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row, place_of

from .coefficients import (
    REMEMBERED,
    between_walls,
    by_displacement,
    by_memory,
    expected,
    expected_of_spins,
    in_equilibrium,
    in_shear,
    point,
    rough_over_smooth,
)

SMOOTH = "Chapman & Cowling 1970, The Mathematical Theory of Non-uniform Gases"
ROUGH = "Pidduck 1922, Proc. R. Soc. A 101, 101"
NEW = f"derived here, by the steps of {ROUGH}"
DRIVEN = (
    "derived here, by the steps of Chapman & Cowling; cooling rough spheres: Bodrova & Brilliantov "
    "2012, Granular Matter 14, 85"
)
BOTH = "higher approximations: DSMC of the study `exact` finds 4 % and 3 % less, too"
HIGHER = "higher Sonine approximations raise D of smooth spheres by 1.9 %"
DISKS = "Gass 1971, J. Chem. Phys. 54, 1898"
SHEARED = "Kremer, Santos & Garzo 2014, Phys. Rev. E 90, 022205"
CARRIED = (
    "higher approximations raise viscosity and conductivity of smooth spheres by 1.6 and 2.5 %"
)
THICK = "density or the box, and the extrapolation, more than velocities that are not Maxwellian"
PAIRS = "first Sonine approximation; averages over random pairs that collide, in the tests, agree"
FORM = "first Sonine approximation; the tests have the published formula, and "
CHECKED = {
    SMOOTH: f"{FORM}averages over random pairs that collide",
    DISKS: f"{FORM}averages over random pairs that collide",
    ROUGH: f"{FORM}averages over random pairs that collide (Chapman & Cowling, 11.6)",
    SHEARED: f"{FORM}random pairs; theirs is of cooling spheres, whose rate nu_s is the same",
    DRIVEN: PAIRS,
    NEW: PAIRS,
}
"""How a source was checked."""


def rows(
    rough_disks: xr.Dataset,
    smooth_disks: xr.Dataset,
    rough_spheres: xr.Dataset,
    smooth_spheres: xr.Dataset,
    heated: xr.Dataset,
    strained: xr.Dataset,
    *elastic: xr.Dataset,
) -> Iterator[Row]:
    """Yield D* = D nu/T of elastic and of driven gases, by displacements and from memory; then
    viscosity and conductivity over those of theory."""
    gases = {"disks": (rough_disks, smooth_disks), "spheres": (rough_spheres, smooth_spheres)}
    for kind, (rough, smooth) in gases.items():
        yield from _of_point(f"elastic {kind}", point(smooth), SMOOTH, HIGHER)
        source = ROUGH if kind == "spheres" else NEW
        yield from _of_point(f"elastic {kind}", point(rough), source, HIGHER)
        found, theory = rough_over_smooth(rough, smooth)
        at = place_of({"q": rough.attrs["inertia"], "packing": round(rough.attrs["packing"], 4)})
        quantity = f"D of perfectly rough over smooth elastic {kind}, by events"
        theory = Estimate(theory, 0.0)
        yield Row(quantity, at, "theory", source, CHECKED[source], theory, found, "", BOTH)
    for r in heated.r.values:
        for beta in heated.beta.values:
            one = heated.sel(r=r, beta=beta)
            if np.isfinite(one.R):
                yield from _of_point("driven disks", one, DRIVEN, "velocities are not Maxwellian")
    for r in strained.r.values:
        for beta in strained.beta.values:
            one = strained.sel(r=r, beta=beta)
            if np.isfinite(one.R).all():
                at, found = place_of({"r": float(r), "beta": float(beta)}), in_shear(one)[-1]
                name = "viscosity of driven disks over theory, no shear extrapolated"
                yield _over_theory(name, at, SHEARED, found, THICK)
    for gas in elastic:
        yield from _of_elastic(point(gas))


def _of_elastic(gas: xr.Dataset) -> Iterator[Row]:
    disks, smooth = gas.attrs["dimension"] == 2, float(gas.beta) == -1.0
    source = (DISKS if smooth else NEW) if disks else SMOOTH if smooth else ROUGH
    kind = f"{'smooth' if smooth else 'rough'} elastic {'disks' if disks else 'spheres'}"
    about = gas.attrs
    packing = {"packing": round(about["packing"], 4)} if "packing" in about else {}
    at = place_of(packing | {"N": int(about["particles"])})
    if "heat_flux" in gas:
        name = f"conductivity of {kind} between walls over theory"
        yield _over_theory(name, at, source, between_walls(gas), CARRIED)
    else:
        for name in REMEMBERED:
            found = in_equilibrium(gas, name)[-1]
            yield _over_theory(f"{name} of {kind} over theory", at, source, found, CARRIED)


def _over_theory(name: str, at: str, source: str, ours: Estimate, reason: str) -> Row:
    checked = CHECKED[source]
    return Row(name, at, "theory", source, checked, Estimate(1.0, 0.0), ours, reason=reason)


def _of_point(kind: str, gas: xr.Dataset, source: str, reason: str) -> Iterator[Row]:
    at = place_of({"r": float(gas.r), "beta": float(gas.beta)})
    theory = Estimate(expected(gas), 0.0)
    ways = {
        "mean square displacement": (theory, by_displacement(gas)),
        "velocity autocorrelation": (theory, by_memory(gas, "velocity_autocorrelation")),
    }
    for way, (theirs, ours) in ways.items():
        quantity = f"D nu/T of {kind}, {way}"
        yield Row(quantity, at, "theory", source, CHECKED[source], theirs, ours, reason=reason)
    if "spin_autocorrelation" in gas:
        spins = Estimate(expected_of_spins(gas), 0.0)
        ours = by_memory(gas, "spin_autocorrelation")
        quantity = f"D nu/T of spins of {kind}, autocorrelation"
        yield Row(quantity, at, "theory", source, CHECKED[source], spins, ours, reason=reason)
