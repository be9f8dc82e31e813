"""Reduced datasets of the experiments behind the claims: theory plus a shift."""

import numpy as np
from tests.synthetic import BETA, reduced

from roughgas import theory

ROUGH = tuple(round(0.1 * step, 1) for step in range(-5, 11))


def bump(size):
    """Return a difference that grows with dissipation: `size` at r = 0.8, beta = 0."""
    return lambda r, beta: size * (1 - r) / 0.2 * (1 - beta**2)


def constant(size):
    return lambda r, beta, *third: size + 0 * r * beta


def walls(rough=0.2, particle=0.0, smooth=0.0, beta=(-1.0, *BETA)):
    """Return the bed without walls, and with walls that shift R by the given amounts at beta <
    1."""

    def shift(size):
        return lambda r, beta: size * (1 - beta) + 0 * r

    return (
        reduced("vibrated"),
        reduced("vibrated_rough_walls", shift(rough), r=(0.9,), beta=beta),
        reduced("vibrated_particle_walls", shift(particle), r=(0.9,)),
        reduced("vibrated_smooth_walls", shift(smooth), r=(0.9,)),
    )


def smooth_disks_between_rough_walls(anisotropy=0.2, gap=0.0, error=0.001, **options):
    """Return a bed at beta = -1 with E_vertical and E_horizontal = 1 + and - `anisotropy`.

    E_rot lies above E_vertical by `gap` times their difference; `error` is the error of R and of
    the share of vertical motion.
    """
    share = (1.0 + anisotropy) / 2.0
    spin = 1.0 + (1.0 + 2.0 * gap) * anisotropy
    values = {"vertical_share": share, "vertical_share_stderr": error, "vertical_share_dof": 40.0}
    values |= {"E_rot": spin} | options
    data = reduced("vibrated_rough_walls", r=(0.9,), beta=(-1.0,), error=error, **values)
    return data.assign(R=0 * data.R + spin / (1.0 + spin))


def sheared(direct=0.1, error=0.004, **options):
    """Return a sheared gas on Lun's formula, whose un-subtracted R lies `direct` too low."""
    data = reduced("sheared", error=error, measured_for=5000.0, **options)
    data["R_unsubtracted"] = data.R - direct
    data["R_unsubtracted_stderr"] = data.R_stderr
    return data


def cooling(shift=0.0, **options):
    return reduced("cooling", constant(shift), beta=ROUGH, **options)


def cooling_as(ratio):
    """Return a cooling gas with R = ratio(r, beta), independent of the theory of free cooling."""

    def shift(r, beta):
        return ratio(r, beta) - theory.cooling_ratio(r, beta, 2, 0.5)

    return reduced("cooling", shift, beta=ROUGH)


def lun(r, beta):
    return theory.lun_ratio(beta, 0.5) + 0 * r


# ---------------------------------------------------------------- sweeps of a third parameter

FEW_BETA = (-0.5, 0.0, 0.5)
WAVES = ("reversed_sawtooth", "sawtooth", "sine", "triangle")
ROUGHNESS = (-1.0, -0.5, 0.0, 1.0)
SHARES = np.array([0.0, 0.002, 0.1, 0.3])[:, None, None]
INERTIA = ("spin.inertia", (0.4, 0.5, 1.0))
KICKS = ("thermostat.spin_share", (0.0, 0.3, 1.0))
MU = (0.0, 0.05, 0.07, 0.2, 0.5, 1.0, 10.0)
FRICTION = ("friction.mu", MU)
NONE = constant(0.0)


def swept(experiment, third, shift=NONE, **options):
    """Return a sweep of a third parameter, on theory plus a shift."""
    settings = {"r": (0.9,), "beta": FEW_BETA} | options
    return reduced(experiment, shift, third=third, **settings)


def boundaries(experiment, shift=NONE, shares=SHARES, **options):
    """Return boundaries of several roughnesses; R follows the share of rotation that they put
    in."""
    options = {"input_spin_share": shares, "input_spin_share_stderr": 0.0005} | options
    key = f"{'floor' if experiment == 'floor_materials' else 'walls'}.roughness"
    return swept(experiment, (key, ROUGHNESS), shift, **options)
