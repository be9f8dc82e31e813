"""`roughgas trajectory` and `roughgas movie`: excerpts of the motion in a point."""

import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from roughgas.base import InputError, Interval
from roughgas.base.labels import GridPoint
from roughgas.cli.run import Selection, Start, initial_in, points_of
from roughgas.cli.values import number, whole_number
from roughgas.config import study_code
from roughgas.data.trajectory import check_format, growing_trajectory
from roughgas.scene import Scene, build
from roughgas.simulation.checkpoint import checkpoint_path
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.films import film, snapshots
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.progress import print_line, with_progress_bar
from roughgas.simulation.run_points import provenance
from roughgas.simulation.trajectory import (
    FRAME_COUNTS,
    TAKE_TIMES,
    Take,
    requested_take,
    trajectory_variables,
)

if TYPE_CHECKING:
    from roughgas.show.movies import FilmedPoint

RATES = Interval("[1, 50]")  # frames a second


class Excerpt(NamedTuple):
    """The options that select the frames of a point: texts, as they are written, None if omitted.

    `start` is the time of the first frame, `length` the time from there to the last frame, `frames`
    the number of frames. Times are in T, in a cooling gas in collisions per particle.
    """

    start: str | None
    length: str | None
    frames: str | None
    times: list[str] | None = None  # of all frames, in place of the other options


def write_trajectory(
    selection: Selection,
    excerpt: Excerpt,
    start: Start,
    reseed: str | None,
    double: bool,
    outputs: Sequence[str],
) -> None:
    """Simulate a point, and write its trajectory, frame by frame, to each path in `outputs` (.xyz,
    .nc or .gsd).

    The simulation begins from the file of `start`, if it has one, with noise of the seed `reseed`
    if there is one. Numbers in .gsd files are in double precision if `double`. Raises
    InputError, OSError, and CollapseError for an inelastic collapse.
    """
    for output in outputs:
        check_format(output, double)
    initial, seed = initial_in(start, selection.seed, reseed)
    name, (coordinates,), experiment = points_of(selection, seed)
    scene = build(experiment, coordinates.r, coordinates.beta)
    take = chosen_take(excerpt, experiment, scene, initial)
    extra_options = study_code.options(experiment.effects, experiment.observables)
    attributes = provenance(
        name,
        experiment,
        coordinates.labels,
        selection.scale,
        outputs[0],
        extra_arguments=extra_options,
    )
    checkpoint, written = checkpoint_path(outputs[0]), 0
    try:
        with ExitStack() as files:
            writers: list[Callable[..., None]] = []
            frame_source = film(
                scene, experiment, coordinates, take, initial, checkpoint, print_line
            )
            frames = files.enter_context(frame_source)
            for frame in with_progress_bar(name, take.frames, "frames", frames):
                if not writers:  # replaces no earlier file before the first frame
                    opened = (
                        growing_trajectory(file, attributes["title"], double) for file in outputs
                    )
                    writers = [files.enter_context(file) for file in opened]
                for write in writers:
                    write(trajectory_variables(scene, experiment, [frame]))
                written += 1
    except KeyboardInterrupt as stop:
        if written:
            message = f"{', '.join(outputs)}: {written} of {take.frames} frames"
            raise KeyboardInterrupt("; ".join([message, *stop.args])) from None
        raise
    for output in outputs:
        print(f"{output}: {written} frames", file=sys.stderr)


def chosen_take(
    excerpt: Excerpt,
    experiment: Experiment[Any],
    scene: Scene,
    initial: Sequence[InitialState] = (),
) -> Take:
    """Return the start, length and frames that the options `excerpt` select; for omitted options,
    values that suit the experiment.

    Without --start the frames of a driven gas begin at the time of the `initial` states, if there
    are any. Raises InputError for illegal options.
    """
    options: dict[str, Any] = {}
    for name in ("start", "length"):
        if (text := getattr(excerpt, name)) is not None:
            options[name] = number(f"--{name}", text, TAKE_TIMES[name])
    if excerpt.frames is not None:
        options["frames"] = whole_number(
            "--frames", excerpt.frames, FRAME_COUNTS[0], FRAME_COUNTS[-1]
        )
    if excerpt.times is not None:
        options["times"] = [number("--times", text) for text in excerpt.times]
    return requested_take(experiment, scene, **options, initial=initial)


def write_movies(
    selection: Selection, excerpt: Excerpt, fps: str, colour: str, outputs: Sequence[str]
) -> None:
    """Simulate points, and write a movie that shows them side by side to each path in `outputs`
    (.mp4 or .gif).

    `fps` is the number of frames a second, as text. `colour`, the meaning of colour, is spin,
    species or height. Raises InputError, OSError, and CollapseError for an inelastic collapse.
    """
    from roughgas.show.movies import write
    from roughgas.show.style import check_movie_suffix

    per_second = number("--fps", fps, RATES)
    for output in outputs:
        check_movie_suffix(output)
    name, selected, experiment = points_of(selection)
    panels = [
        _simulated_panel(name, excerpt, colour, coordinates, experiment) for coordinates in selected
    ]
    for output in outputs:
        progress = partial(with_progress_bar, f"{output}: drawn", len(panels[0][1]), "frames")
        write(output, panels, per_second, progress)
        print(f"{output}: {len(panels[0][1])} frames", file=sys.stderr)


def _simulated_panel(
    name: str, excerpt: Excerpt, colour: str, coordinates: GridPoint, experiment: Experiment[Any]
) -> "FilmedPoint":
    """Simulate the point at `coordinates` of the experiment called `name`; return the subject of
    its panel in a movie, and its snapshots.

    `colour` is spin, species or height. Raises InputError for the height of disks.
    """
    from roughgas.show.movies import MovieSubject

    scene = build(experiment, coordinates.r, coordinates.beta)
    if colour == "height" and len(scene.box) == 2:
        raise InputError("--colour", "height", "be spin or species of disks")
    take = chosen_take(excerpt, experiment, scene)
    simulated = snapshots(scene, experiment, coordinates.seed, take)
    shots = list(with_progress_bar(f"{name}: simulated", take.frames, "frames", simulated))
    return MovieSubject(name, experiment, scene, coordinates.seed, colour), shots
