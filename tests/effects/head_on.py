"""Two disks meet head-on, in a scene with the page's example: run beside the changed package.

Prints, for each relative speed that is given, the one after the contact; v_y = 1, r = 1/2.
"""

import sys

import numpy as np
from brute_force import run

from roughgas.kernel.memory import new_state
from roughgas.scene import build

EFFECTS = {"spin": {"inertia": 0.5}, "plasticity": {"yield_speed": 1.0}}

for speed in map(float, sys.argv[1:]):
    scene = build({"box": [20, 20], "effects": EFFECTS}, 0.5, 0.0)
    velocity = np.array([[speed / 2.0, 0.0], [-speed / 2.0, 0.0]])
    state = new_state(scene, np.array([[6.0, 10.0], [14.0, 10.0]]), velocity, np.zeros((2, 1)))
    run(state, scene, 1, collisions=1)
    print(repr(float(state.trajectory[1, 2] - state.trajectory[0, 2])))
