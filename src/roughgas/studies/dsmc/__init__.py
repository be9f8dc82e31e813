"""Direct simulation Monte Carlo: a homogeneous gas of rough particles, without their positions."""

from roughgas.studies.dsmc.gas import Colliding, HomogeneousGas, Samples, material, new_gas, run

__all__ = ["Colliding", "HomogeneousGas", "Samples", "material", "new_gas", "run"]
