"""Drives that put energy into rotation, and R at the share of it."""

import xarray as xr

from roughgas.claims.evidence import NotTestedError, deviation, deviation_at_shares, spin_shares
from roughgas.claims.finding import Finding, Statement, agreement, points

QUOTE = "Possible future work includes boundary conditions with non-zero rotational energy input"


def follows_lun_without_rotation(heated: xr.Dataset) -> Finding:
    """Where a stochastic drive puts in translation alone, R - Eq. (lun) is as good as zero."""
    if 0.0 not in heated.spin_share:
        raise NotTestedError("the sweep does not hold a drive of translation alone")
    return agreement(deviation(heated.sel(spin_share=0.0, drop=True)), "Eq. (lun)")


def follows_rates(heated: xr.Dataset) -> Finding:
    """R - the rate equations at the drive's share of rotation is as good as zero."""
    return agreement(deviation(heated), "the rate equations")


def follows_its_share(driven: xr.Dataset) -> Finding:
    """R - the rate equations, at the share that the energy books say, is as good as zero."""
    found = agreement(deviation_at_shares(driven), "the rate equations at the measured share")
    shares, _ = spin_shares(driven)
    reason = f"{found.reason} The share is from {float(shares.min()):.3f} to "
    reason += f"{float(shares.max()):.3f}."
    taken = int((shares < 0).sum())
    if taken:
        reason += f" At {taken} {points(taken)} rotation is taken out."
    return found._replace(reason=reason)


STATEMENTS = (
    Statement(
        "heated_without_rotation_follows_lun",
        "Eq. (lun) will apply whenever the forcing adds only translational energy",
        ("heated",),
        follows_lun_without_rotation,
    ),
    Statement(
        "heated_follows_rates",
        "where P_rot is the rotational energy added by the forcing [of any share in its power]",
        ("heated",),
        follows_rates,
    ),
    Statement(
        "rough_floor_follows_rates",
        f"{QUOTE} [a rough floor]",
        ("floor_materials",),
        follows_its_share,
    ),
    Statement(
        "rough_walls_follow_rates",
        f"{QUOTE} [rough side walls of a vibrated bed]",
        ("wall_materials",),
        follows_its_share,
    ),
    Statement(
        "shaken_walls_follow_rates",
        f"{QUOTE} [rough walls, shaken along themselves, that alone drive a gas]",
        ("shaken_walls",),
        follows_its_share,
    ),
)
