"""A gas of your own, driven step by step: what tasks of studies simulate with.

`build` makes the scene of an experiment, `Gas.start` a gas in it, which goes on as far as it is
told: `thermalise`, `cool`, `in_time`, `in_collisions`, `step`. Samples are columns of sums over the
particles; `Gas.energies` makes energies of them, `ratio` their R. `positions_and_velocities` and
`spins` are copies. `save` and `restore` keep a gas in a file, from which a run goes on with the
same bits.

    experiment = {"particles": 40, "box": [30, 30], "effects": {"spin": {"inertia": 0.5}}}
    gas = Gas.start(build(experiment, r=0.9, beta=0.5), experiment, np.random.default_rng(1))
    gas.thermalise(20)
    gas.cool(refresh_every=gas.count(4))
    R = ratio(gas.energies(gas.in_collisions(gas.count(1), samples=100)))
"""

from roughgas.base import CollapseError, InputError
from roughgas.effects import inertia
from roughgas.scene import DIAMETER, Scene, build, shear_rate
from roughgas.simulation.energies import Columns, Energies, ratio, restored
from roughgas.simulation.gas import Gas
from roughgas.simulation.restart import UnusableCheckpoint
