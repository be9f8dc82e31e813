"""Which equation a dataset obeys, by its attributes."""

import pytest

from roughgas.theory.prediction import Equation, equation_of

DISKS, SPHERES = {"dimension": 2}, {"dimension": 3}
FRICTION = "rate equations with Coulomb friction"


@pytest.mark.parametrize(
    ("attributes", "variables", "equation"),
    [
        (DISKS, ("R",), ("lun", "Lun's formula")),
        (SPHERES, ("R",), ("lun", "Lun's formula")),
        (DISKS, ("R", "plateau_end"), ("K", "theory of free cooling")),
        (SPHERES | {"theory": "K"}, (), ("K", "theory of free cooling")),
        (DISKS | {"theory": "lun"}, ("plateau_end",), ("lun", "Lun's formula")),
        (DISKS | {"theory": "K", "mu": 0.0}, (), ("K", FRICTION)),
        (DISKS | {"theory": "lun", "swept": "friction.mu"}, (), ("lun", FRICTION)),
        (DISKS | {"theory": "K", "swept": "spin.inertia"}, (), ("K", "theory of free cooling")),
        (DISKS | {"spin_share": 0.0}, (), ("lun", "Lun's formula")),
        (DISKS | {"spin_share": 0.4}, (), ("lun", "rate equations, spin share 0.4")),
        (DISKS | {"swept": "thermostat.spin_share"}, (), ("lun", "rate equations")),
        (
            DISKS | {"swept": "thermostat.spin_share", "spin_share": 1.0},
            (),
            ("lun", "rate equations, spin share 1"),
        ),
    ],
)
def test_the_equation_follows_from_what_a_dataset_says(attributes, variables, equation):
    assert equation_of(attributes, variables) == Equation(*equation)
