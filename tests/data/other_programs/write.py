"""Writes disks.xyz by ASE and spheres.gsd by gsd, from the last frames of LAMMPS beside this file:

python ase_and_gsd.py       (ase 3.29.0, gsd 5.0.1)
"""

import gsd.hoomd
import numpy as np
from ase import Atoms
from ase.io import write


def last_frame(path):
    """(columns by name, box (3, 2)) of the last frame of a dump, in the order of `id`."""
    lines = open(path).read().splitlines()
    start = max(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    box = np.array([line.split() for line in lines[start - 3 : start]], float)
    rows = np.array([line.split() for line in lines[start + 1 :]], float)
    columns = dict(zip(lines[start].split()[2:], rows.T, strict=True))
    order = np.argsort(columns["id"])
    return {name: values[order] for name, values in columns.items()}, box


def vectors(columns, *names):
    return np.stack([columns[name] for name in names], axis=1)


columns, box = last_frame("disks.dump")
sides = box[:, 1] - box[:, 0]
atoms = Atoms("X16", positions=vectors(columns, "x", "y", "z") - box[:, 0], cell=sides, pbc=True)
atoms.set_masses(columns["mass"])
atoms.set_velocities(vectors(columns, "vx", "vy", "vz"))
atoms.set_array("radius", columns["radius"])
atoms.set_array("omega", vectors(columns, "omegax", "omegay", "omegaz"))
first = atoms.copy()
first.set_velocities(-first.get_velocities())
write(
    "disks.xyz",
    [first, atoms],
    columns=["symbols", "positions", "momenta", "masses", "radius", "omega"],
)

columns, box = last_frame("spheres.dump")
sides = box[:, 1] - box[:, 0]
frame = gsd.hoomd.Frame()
frame.configuration.box = [*sides, 0, 0, 0]
frame.configuration.dimensions = 3
frame.particles.N = 12
frame.particles.types = ["small", "large"]
frame.particles.typeid = columns["type"].astype(int) - 1
frame.particles.position = (vectors(columns, "xs", "ys", "zs") - 0.5) * sides
frame.particles.velocity = vectors(columns, "vx", "vy", "vz")
frame.particles.diameter = columns["diameter"]
frame.particles.mass = columns["mass"]
inertia = 0.1 * columns["mass"] * columns["diameter"] ** 2
frame.particles.moment_inertia = np.repeat(inertia[:, None], 3, axis=1)
momentum = inertia[:, None] * vectors(columns, "omegax", "omegay", "omegaz")
# a turn by 90 degrees around z leads from the frame of the body to space
half = np.sqrt(0.5)
frame.particles.orientation = np.tile([half, 0, 0, half], (12, 1))
body = np.stack([momentum[:, 1], -momentum[:, 0], momentum[:, 2]], axis=1)
zero = np.zeros((12, 1))
imaginary = np.array([0.0, 0.0, half])
vector = half * body + np.cross(imaginary, body)
scalar = -(body @ imaginary)[:, None]
frame.particles.angmom = 2 * np.hstack([scalar, vector])
with gsd.hoomd.open("spheres.gsd", "w", precision="double") as file:
    file.append(frame)
