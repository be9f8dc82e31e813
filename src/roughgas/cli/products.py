"""What `roughgas` makes beside points: movies, trajectories, reduced datasets, plots, crates."""

import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from math import prod
from textwrap import fill
from typing import TYPE_CHECKING, Any

from roughgas import config
from roughgas.base import InputError, Interval, as_json, from_json, on_one_line
from roughgas.cli.parser import WIDTH, number, whole_number
from roughgas.cli.run import initial_in, points_of
from roughgas.data.trajectory import check_format, growing_trajectory
from roughgas.scene import Scene, build
from roughgas.simulation.points import provenance
from roughgas.simulation.progress import watched
from roughgas.simulation.restart import Initial
from roughgas.simulation.trajectory import LEGAL, NUMBERS, Frames, chosen, snapshots, variables

if TYPE_CHECKING:
    from roughgas.show.movies import Panel

RATES = Interval("[1, 50]")  # frames a second


def trajectory(options: Namespace) -> None:
    """Simulate a point, and write its trajectory, frame by frame."""
    for output in options.output:
        check_format(output)
    initial, seed = initial_in(options)
    name, ((place,), settings) = options.experiment, points_of(options, seed)
    scene = build(settings, place.r, place.beta)
    take = chosen_take(options, settings, scene, initial)
    about = provenance(name, settings, place.labels, options.scale, options.output[0])
    simulated = snapshots(scene, settings, place.seed, take, initial)
    done = 0
    try:
        with ExitStack() as files:
            writers: list[Callable[..., None]] = []
            for shot in watched(name, take.frames, "frames", simulated):
                if not writers:  # nothing is replaced before there is a frame
                    opened = (growing_trajectory(one, about["title"]) for one in options.output)
                    writers = [files.enter_context(one) for one in opened]
                for write in writers:
                    write(variables(scene, settings, [shot]))
                done += 1
    except KeyboardInterrupt:
        if done:
            kept = f"{', '.join(options.output)}: {done} of {take.frames} frames"
            raise KeyboardInterrupt(kept) from None
        raise
    for output in options.output:
        print(f"{output}: {done} frames", file=sys.stderr)


def chosen_take(
    options: Namespace, settings: dict[str, Any], scene: Scene, initial: Sequence[Initial] = ()
) -> Frames:
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


def movie(options: Namespace) -> None:
    """Simulate a point, or several, and write their movie, side by side."""
    from roughgas.show.movies import write
    from roughgas.show.style import check_kind

    fps = number("--fps", options.fps, RATES)
    for output in options.output:
        check_kind(output)
    at, settings = points_of(options)
    panels = [_panel(options, place, settings) for place in at]
    for output in options.output:
        shown = partial(watched, f"{output}: drawn", len(panels[0][1]), "frames")
        write(output, panels, fps, shown)
        print(f"{output}: {len(panels[0][1])} frames", file=sys.stderr)


def _panel(options: Namespace, place: config.Place, settings: dict[str, Any]) -> "Panel":
    """Simulate a point; return it with what is to be seen of it."""
    from roughgas.show.movies import MovieSubject

    name, scene = options.experiment, build(settings, place.r, place.beta)
    if options.colour == "height" and len(scene.box) == 2:
        raise InputError("--colour", "height", "be spin or species of disks")
    take = chosen_take(options, settings, scene)
    simulated = snapshots(scene, settings, place.seed, take)
    shots = list(watched(f"{name}: simulated", take.frames, "frames", simulated))
    return MovieSubject(name, settings, scene, place.seed, options.colour), shots


def reduce(options: Namespace) -> None:
    """Combine points into a reduced dataset."""
    from roughgas.results.reduce import reduce_points

    piped = options.inputs == ["-"]
    inputs = sys.stdin.read().splitlines() if piped else options.inputs
    reduce_points(inputs, options.output, options.put_aside)


def plot(options: Namespace) -> None:
    """Draw any reduced dataset."""
    from roughgas.show import gallery

    given = {"r": options.r or (), "beta": options.beta or ()}
    chosen = {name: [number(f"--{name}", one) for one in many] for name, many in given.items()}
    for line in gallery.plot(options.input, options.output, options.over, options.of, **chosen):
        print(line, file=sys.stderr)


def crate(options: Namespace) -> None:
    """Write a crate."""
    from roughgas.results.products import write_crate

    if not options.output.endswith(".zip"):
        raise InputError("--output", options.output, "end in .zip")
    text = options.configuration
    settings = config.load(options.config) if text is None else from_json(text, "--configuration")
    write_crate(options.files, options.output, settings)


def experiments(options: Namespace) -> None:
    """Print each experiment with its sweep at a scale."""
    loaded = config.load(options.config)
    found = {}
    for name, written in loaded["experiments"].items():
        settings = config.experiment(loaded, name, options.scale)
        axes = [config.third_axis(settings), "r", "beta"]
        sweep = {key: settings["sweep"][key] for key in axes if key}
        points = prod(map(len, sweep.values()))
        about = {"description": written.get("description", ""), "extends": written.get("extends")}
        found[name] = about | {"points": points, "sweep": sweep}
    if options.json:
        print(as_json(found))
    else:
        print("\n\n".join(_text(name, about) for name, about in found.items()))


def _text(name, about):
    counts = ", ".join(f"{len(labels)} {key}" for key, labels in about["sweep"].items())
    extends = f"; extends {about['extends']}" if about["extends"] else ""
    description = on_one_line(" ".join(about["description"].split()))
    lines = [name, fill(description, WIDTH, initial_indent="  ", subsequent_indent="  ")]
    return "\n".join([*lines, f"  {about['points']} points: {counts}{extends}"])
