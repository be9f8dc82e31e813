"""Trajectories: positions, velocities and spins of all particles at chosen times, as a dataset.

roughgas.data.particle_files writes them for other programs.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from roughgas.data.netcdf import Content, in_memory
from roughgas.data.variables import (
    ENERGY,
    LENGTH,
    MIXTURE,
    NAMES,
    SHEARED,
    SPEED,
    SPIN,
    TIME,
    Variable,
    described,
    register,
)

if TYPE_CHECKING:
    import xarray

PLACES = ("frame", "particle", "axis")
TRAJECTORY = register(
    "trajectory",
    {
        "axis": Variable("axis of the box, the last one vertical", "", ("axis",), "str"),
        "time": Variable("time since the start", TIME, ("frame",), of_settings=True),
        "collisions_per_particle": Variable(
            "collisions per particle since the start, of a cooling gas since it began to cool",
            dims=("frame",),
        ),
        "position": Variable("position of a particle, folded into the box", LENGTH, PLACES),
        "velocity": Variable("velocity of the image in the box", SPEED, PLACES),
        "spin": Variable(
            "spin as the velocity a w of the surface: of disks anticlockwise, of spheres a vector",
            SPEED,
            ("frame", "particle", "spin_axis"),
            when=(SPIN,),
        ),
        "angle": Variable(
            "angle by which a disk has turned since the first time",
            "rad",
            ("frame", "particle"),
            when=("disks that spin",),
        ),
        "radius": Variable("radius of a particle", LENGTH, ("particle",)),
        "mass": Variable("mass of a particle", "m", ("particle",), when=(MIXTURE,)),
        "inertia": Variable(
            "moment of inertia of a particle over its m a^2", "1", ("particle",), when=(MIXTURE,)
        ),
        "species_of": Variable(
            "number of a particle's species, from 0", "1", ("particle",), "i4", when=(MIXTURE,)
        ),
        **NAMES,
        "box": Variable("length of the box, NaN where it is open above", LENGTH, ("axis",)),
        "periodic": Variable(
            "whether the box repeats along the axis", "1", ("axis",), "i1", flags="bounded periodic"
        ),
        "image_shift": Variable(
            "displacement along the first axis of the image above along the second",
            LENGTH,
            ("frame",),
            when=(SHEARED,),
        ),
        "floor_height": Variable("height of the floor", LENGTH, ("frame",), when=("floor",)),
        "wall_displacement": Variable(
            "displacement of shaken walls from their middle",
            LENGTH,
            ("frame",),
            when=("shaken walls",),
        ),
        "E_trans": Variable(
            "translational energy per degree of freedom, of a sheared gas without the mean flow",
            ENERGY,
            ("frame",),
            of_settings=True,
        ),
        "E_rot": Variable(
            "rotational energy per degree of freedom, of a sheared gas without the mean spin",
            ENERGY,
            ("frame",),
            when=(SPIN,),
            of_settings=True,
        ),
        "R": Variable("share of rotation in the energy", "1", ("frame",), when=(SPIN,)),
    },
)


def as_trajectory(
    variables: Mapping[str, Any], attributes: Mapping[str, str | int | float]
) -> "xarray.Dataset":
    """Return the dataset of a trajectory from its variables (TRAJECTORY) and attributes."""
    return in_memory(Content(described("trajectory", variables), attributes))
