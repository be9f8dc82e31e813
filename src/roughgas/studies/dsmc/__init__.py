"""Direct simulation Monte Carlo: a homogeneous gas of rough particles, without their positions."""

from roughgas.studies.dsmc.gas import Gas, Material, Samples, material, new_gas, run

__all__ = ["Gas", "Material", "Samples", "material", "new_gas", "run"]
