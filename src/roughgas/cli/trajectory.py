"""`roughgas trajectory`: where the particles of a point are, as files for other programs."""

import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import Any

from roughgas.cli.options import number, whole_number
from roughgas.cli.run import initial_in, points_of
from roughgas.config.provenance import provenance
from roughgas.data.trajectory import as_trajectory, check_format, write_trajectory
from roughgas.scene import Scene, build
from roughgas.simulation.ends import Initial
from roughgas.simulation.progress import watched
from roughgas.simulation.snapshots import LEGAL, NUMBERS, Take, chosen, snapshots
from roughgas.simulation.trajectory import variables


def trajectory(options: Namespace) -> None:
    """Simulate a point, and write its trajectory."""
    name, ((place,), settings) = options.experiment, points_of(options)
    scene = build(settings, place.r, place.beta)
    for output in options.output:
        check_format(output)
    initial = initial_in(options)
    take = chosen_take(options, settings, scene, initial)
    simulated = snapshots(scene, settings, place.seed, take, initial)
    shots = list(watched(name, take.frames, "frames", simulated))
    told = take.options()
    if initial:
        told += ["--from", options.start_from]
    for output in options.output:
        about = provenance(name, settings, place.labels, options.scale, output, "trajectory", told)
        found = as_trajectory(variables(scene, settings, shots), about)
        write_trajectory(output, found)
        print(f"{output}: {len(shots)} frames", file=sys.stderr)


def chosen_take(
    options: Namespace, settings: dict[str, Any], scene: Scene, initial: Sequence[Initial] = ()
) -> Take:
    """Return what is shown: by default, what suits the experiment."""
    asked: dict[str, Any] = {}
    for name in ("start", "length"):
        if (text := getattr(options, name)) is not None:
            asked[name] = number(f"--{name}", text, LEGAL[name])
    if options.frames is not None:
        asked["frames"] = whole_number("--frames", options.frames, NUMBERS[0], NUMBERS[-1])
    if (texts := getattr(options, "times", None)) is not None:
        asked["times"] = [number("--times", text) for text in texts]
    return chosen(settings, scene, **asked, initial=initial)
