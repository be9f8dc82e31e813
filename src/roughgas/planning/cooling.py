"""The pilot and the plan of a cooling gas; lengths in collisions per particle."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from roughgas.effects import inertia_of_spin
from roughgas.planning.lengths import BIAS, FEWEST_SEEDS, relaxation, to_measure, whole
from roughgas.planning.pilot import SEED, Pilot
from roughgas.scene import Scene
from roughgas.simulation import cooling
from roughgas.simulation.recorder import Recorder
from roughgas.statistics.evidence import YES
from roughgas.theory import cooling_ratio

TRIED = {"replicas": 40, "relaxation_times": 16}
E_FOLDS = 10.0  # of R on the plateau
PLATEAU = 50.0, 1000.0  # collisions per particle that it is kept between
REPLICAS = 5  # to a seed
MEMORIES = 3.0  # autocorrelation times in a run, at least


def explore(scene: Scene, experiment: Mapping[str, Any]) -> Pilot:
    """Run one point, long enough to be sure of the plateau and of how R varies on it.

    R remembers as long as it relaxes, twice the e-fold of theory (Ornstein and Uhlenbeck).
    """
    recorder, replicas = Recorder(), TRIED["replicas"]
    e_fold = 1.0 / max(cooling.rate_of(scene, experiment), 1.0 / PLATEAU[1])
    plateau = min(max(E_FOLDS * e_fold, PLATEAU[0]), PLATEAU[1])
    tried = {**experiment, "schedule": experiment["schedule"] | TRIED | {"plateau": plateau}}
    found = cooling.run(scene, tried, SEED, recorder)
    simulated = 2.0 * recorder.collisions / experiment["particles"]
    length = max(found["plateau_end"] - found["measured_from"], 1.0)
    return Pilot(
        transient=0.0,
        autocorrelation_time=np.fmax(found["autocorrelation_time"], 2.0 * e_fold),
        variance=found["R_stderr"] ** 2 * replicas * length,
        dof=replicas - 1.0,
        pace=1.0,
        seconds_per_length=recorder.seconds / simulated,
        settled=found["equilibrated"] == YES,
        length=simulated,
        seconds=recorder.seconds,
    )


def effort(scene: Scene, experiment: Mapping[str, Any]) -> float:
    """Return how long a pilot is at least, in collisions per particle."""
    tried = experiment["schedule"] | TRIED | {"plateau": PLATEAU[0]}
    return cooling.length(scene, {**experiment, "schedule": tried})


def choose(
    scene: Scene, experiment: Mapping[str, Any], pilot: Pilot, target: float
) -> dict[str, Any]:
    """Return the complete schedule of a run that belongs to a target."""
    given = experiment["schedule"]
    r, beta, inertia = scene.restitution, scene.roughness, inertia_of_spin(scene.effects)
    final = float(cooling_ratio(r, beta, len(scene.box), inertia))
    e_folds = relaxation(scene, BIAS * target, final, None) * cooling.rate_of(scene, experiment)
    e_folds = float(f"{max(e_folds, 1.0):.3g}")
    spent = given["thermalise"] + cooling.transient_length(scene, e_folds, experiment)
    plateau = to_measure(spent, FEWEST_SEEDS * REPLICAS, target, MEMORIES, pilot)
    chosen = {
        "replicas": REPLICAS,
        "relaxation_times": e_folds,
        "plateau": whole(plateau, given["sample_every"]),
    }
    return {**given, **chosen}
