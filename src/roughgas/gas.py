"""Simulation of a gas step by step, for tasks of studies and for your own scripts.

`build` makes the scene of an experiment, `Gas.start` a gas in it, which is advanced by
`thermalise`, `cool`, `in_time`, `in_collisions` and `step`. Samples are columns of sums over the
particles; `Gas.energies` converts them to energies, and `ratio` these to R.
`positions_and_velocities` and `spins` are copies. `save` and `restore` keep a gas in a file, from
which a run continues to the last bit.

    scene = {"particles": 40, "box": [30, 30], "effects": {"spin": {"inertia": 0.5}}}
    settings = scene_settings(scene)
    gas = Gas.start(build(settings, r=0.9, beta=0.5), settings, np.random.default_rng(1))
    gas.thermalise(20)
    gas.cool(refresh_every=gas.count(4))
    R = ratio(gas.energies(gas.in_collisions(gas.count(1), samples=100)))
"""

from roughgas.base import CollapseError, InputError
from roughgas.effects import inertia
from roughgas.scene import DIAMETER, Scene, build, shear_rate
from roughgas.scene.settings import SceneSettings, scene_settings
from roughgas.simulation.energies import Columns, Energies, ratio, restored
from roughgas.simulation.gas import Batch, Gas
from roughgas.simulation.leg import Leg
from roughgas.simulation.state_encoding import UnusableCheckpoint
from roughgas.simulation.tracker import Tracker
