"""Transport coefficients against Enskog's theory in first Sonine approximation, as rows of
evidence."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row, point_text

from . import dilute
from .coefficients import (
    MEMORY_LENGTHS,
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

CHAPMAN_COWLING = "Chapman & Cowling 1970, The Mathematical Theory of Non-uniform Gases"
PIDDUCK = "Pidduck 1922, Proc. R. Soc. A 101, 101"
DERIVED_HERE = f"derived here, by the steps of {PIDDUCK}"
DERIVED_FOR_DRIVEN = (
    "derived here, by the steps of Chapman & Cowling; cooling rough spheres: Bodrova & Brilliantov "
    "2012, Granular Matter 14, 85"
)
REASON_RATIO = "higher approximations: DSMC of the study `exact` finds 4 % and 3 % less, too"
REASON_DIFFUSION = "higher Sonine approximations raise D of smooth spheres by 1.9 %"
GASS = "Gass 1971, J. Chem. Phys. 54, 1898"
KREMER = "Kremer, Santos & Garzo 2014, Phys. Rev. E 90, 022205"
REASON_FLUXES = (
    "higher approximations raise viscosity and conductivity of smooth spheres by 1.6 and 2.5 %"
)
REASON_VISCOSITY = (
    "density or the box, and the extrapolation, more than velocities that are not Maxwellian"
)
BY_RANDOM_PAIRS = (
    "first Sonine approximation; averages over random pairs that collide, in the tests, agree"
)
CORRELATED = "derived here: all terms up to the third degree in velocity and spin"
BY_HAND = "value of the converged series, over the first term"
REASON_SPINS = "this approximation leaves out correlations of spins with velocities"
BY_FORMULA = "first Sonine approximation; the tests have the published formula, and "
CHECK_OF_SOURCE = {
    CHAPMAN_COWLING: f"{BY_FORMULA}averages over random pairs that collide",
    GASS: f"{BY_FORMULA}averages over random pairs that collide",
    PIDDUCK: f"{BY_FORMULA}averages over random pairs that collide (Chapman & Cowling, 11.6)",
    KREMER: f"{BY_FORMULA}random pairs; theirs is of cooling spheres, whose rate nu_s is the same",
    DERIVED_FOR_DRIVEN: BY_RANDOM_PAIRS,
    DERIVED_HERE: BY_RANDOM_PAIRS,
}
"""Checks of the formula of each source."""


def rows(
    rough_disks: xr.Dataset,
    smooth_disks: xr.Dataset,
    rough_spheres: xr.Dataset,
    smooth_spheres: xr.Dataset,
    heated: xr.Dataset,
    strained: xr.Dataset,
    *elastic_and_tasks: xr.Dataset,
) -> Iterator[Row]:
    """Yield D* = D nu/T of elastic and of driven gases, by displacements and from memory; then
    viscosity and conductivity over theory, by events and without positions."""
    *elastic, tasks = elastic_and_tasks
    gases = {"disks": (rough_disks, smooth_disks), "spheres": (rough_spheres, smooth_spheres)}
    for kind, (rough, smooth) in gases.items():
        yield from _diffusion_rows(
            f"elastic {kind}", point(smooth), CHAPMAN_COWLING, REASON_DIFFUSION
        )
        source = PIDDUCK if kind == "spheres" else DERIVED_HERE
        yield from _diffusion_rows(f"elastic {kind}", point(rough), source, REASON_DIFFUSION)
        ratio, theory = rough_over_smooth(rough, smooth)
        state = point_text(
            {"q": rough.attrs["inertia"], "packing": round(rough.attrs["packing"], 4)}
        )
        quantity = f"D of perfectly rough over smooth elastic {kind}, by events"
        theory = Estimate(theory, 0.0)
        yield Row(
            quantity,
            state,
            "theory",
            source,
            CHECK_OF_SOURCE[source],
            theory,
            ratio,
            "",
            REASON_RATIO,
        )
    for r in heated.r.values:
        for beta in heated.beta.values:
            gas_at_point = heated.sel(r=r, beta=beta)
            if np.isfinite(gas_at_point.R):
                yield from _diffusion_rows(
                    "driven disks",
                    gas_at_point,
                    DERIVED_FOR_DRIVEN,
                    "velocities are not Maxwellian",
                )
    for r in strained.r.values:
        for beta in strained.beta.values:
            gas_at_point = strained.sel(r=r, beta=beta)
            if np.isfinite(gas_at_point.R).all():
                state, ratio = (
                    point_text({"r": float(r), "beta": float(beta)}),
                    in_shear(gas_at_point)[-1],
                )
                name = "viscosity of driven disks over theory, no shear extrapolated"
                yield _over_theory(name, state, KREMER, ratio, REASON_VISCOSITY)
    for gas in elastic:
        yield from _elastic_rows(point(gas))
    yield from _dilute_rows(dilute.rows_of(tasks))


def _elastic_rows(gas: xr.Dataset) -> Iterator[Row]:
    disks, smooth = gas.attrs["dimension"] == 2, float(gas.beta) == -1.0
    source = (GASS if smooth else DERIVED_HERE) if disks else CHAPMAN_COWLING if smooth else PIDDUCK
    kind = f"{'smooth' if smooth else 'rough'} elastic {'disks' if disks else 'spheres'}"
    attributes = gas.attrs
    packing = {"packing": round(attributes["packing"], 4)} if "packing" in attributes else {}
    state = point_text(packing | {"N": int(attributes["particles"])})
    if "heat_flux" in gas:
        name = f"conductivity of {kind} between walls over theory"
        yield _over_theory(name, state, source, between_walls(gas), REASON_FLUXES)
    else:
        for name in MEMORY_LENGTHS:
            estimate = in_equilibrium(gas, name)[-1]
            yield _over_theory(
                f"{name} of {kind} over theory", state, source, estimate, REASON_FLUXES
            )


def _over_theory(name: str, state: str, source: str, ours: Estimate, reason: str) -> Row:
    checked = CHECK_OF_SOURCE[source]
    return Row(name, state, "theory", source, checked, Estimate(1.0, 0.0), ours, reason=reason)


def _diffusion_rows(kind: str, gas: xr.Dataset, source: str, reason: str) -> Iterator[Row]:
    state = point_text({"r": float(gas.r), "beta": float(gas.beta)})
    theory = Estimate(expected(gas), 0.0)
    methods = {
        "mean square displacement": (theory, by_displacement(gas)),
        "velocity autocorrelation": (theory, by_memory(gas, "velocity_autocorrelation")),
    }
    for way, (theirs, ours) in methods.items():
        quantity = f"D nu/T of {kind}, {way}"
        yield Row(
            quantity, state, "theory", source, CHECK_OF_SOURCE[source], theirs, ours, reason=reason
        )
    if "spin_autocorrelation" in gas:
        spins = Estimate(expected_of_spins(gas), 0.0)
        ours = by_memory(gas, "spin_autocorrelation")
        quantity = f"D nu/T of spins of {kind}, autocorrelation"
        yield Row(
            quantity, state, "theory", source, CHECK_OF_SOURCE[source], spins, ours, reason=reason
        )


def _dilute_rows(rows: list[dilute.LongRow]) -> Iterator[Row]:
    """Yield coefficients without positions over their first Sonine approximation."""
    for (quantity, kind), published in dilute.PUBLISHED.items():
        for q, ours in dilute.limits(rows, quantity, kind, "equilibrium").items():
            name = f"{quantity} of {dilute.name_of(kind, q).partition(',')[0]} over theory, DSMC"
            state = point_text({"q": q, "N": "inf"} if q else {"N": "inf"})
            if q == 0.0:
                source = dilute.SOURCES[kind]
                yield Row(name, state, "theory", source, BY_HAND, Estimate(published, 0.0), ours)
                continue
            yield _over_theory(
                name, state, PIDDUCK if kind == "spheres" else DERIVED_HERE, ours, REASON_SPINS
            )
            theory = Estimate(dilute.corrected(quantity, kind, q), 0.0)
            name, source = f"{name}, spins correlated", CORRELATED
            yield Row(
                name, state, "theory", source, BY_RANDOM_PAIRS, theory, ours, reason=REASON_FLUXES
            )
    for (r, beta), ours in dilute.driven(rows).items():
        state = point_text({"r": r, "beta": beta})
        name = "D of driven disks over theory, DSMC"
        yield _over_theory(name, state, DERIVED_FOR_DRIVEN, ours, "velocities are not Maxwellian")
