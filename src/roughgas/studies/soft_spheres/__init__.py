"""The classical way: rough disks or spheres that deform, stepped through time.

Molecular dynamics with contact forces (Cundall & Strack, Geotechnique 29, 47 (1979)): a contact is
a spring and a dashpot along the normal and a spring along the tangent, set so that it takes the
time t_c and gives the restitution r and the roughness beta; as t_c goes to 0 it becomes the contact
of the event-driven kernel. Units: particle radius a = mass m = time unit T = 1.
"""

from roughgas.studies.soft_spheres.gas import SoftGas, SoftScene, Springs, new_gas, springs

__all__ = ["SoftGas", "SoftScene", "Springs", "new_gas", "springs"]
