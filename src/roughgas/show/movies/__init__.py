"""Movies of scenes: particles that move and spin, boundaries, and R(t) beneath.

R = E_rot/(E_rot + E_trans), from energies per degree of freedom. Units: particle radius a = mass m
= time unit T = 1; spins are surface velocities in a/T. `shots` are the snapshots of a point, one
per frame.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from roughgas.base.labels import names_of, parameter_of
from roughgas.scene import Scene
from roughgas.show import style
from roughgas.show.movies.particles import (
    SPECIES_COLOURS,
    Boundaries,
    Disks,
    Heights,
    Spheres,
    View,
    heights,
)
from roughgas.show.style import write_movie
from roughgas.simulation import protocols
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.steady import drive_periods
from roughgas.simulation.trajectory import Snapshot

WIDTH = 4.8  # inches
DPI = {".gif": 70, ".mp4": 200}
DPI_OF_SEVERAL = {".gif": 60, ".mp4": 120}  # of several points side by side
MAX_HEIGHT = 1.5  # of the view, in widths of the box
WHITE_PERCENTILE = 99.0  # of height, above which spheres seen from above are white
SLIDING_IMAGES = 0.15  # visible strip of the images above and below, in heights of the box
LABEL_HEIGHT, GRAPH_HEIGHT = 0.85, 1.25  # inches: of title and label, and of the graph beneath
PER_PARTICLE, SHAKES = "collisions per particle", "shakes"


class MovieSubject(NamedTuple):
    """The point that a movie shows, as settings (`experiment`) and as the kernel's scene, and the
    meaning of colour."""

    name: str  # of the experiment
    experiment: Experiment[Any]
    scene: Scene
    seed: int
    colour: str = "spin"  # spin or species of particles, or height, seen from above


FilmedPoint = tuple[MovieSubject, Sequence[Snapshot]]
"""A point, and its snapshots."""


def write(
    path: str | Path,
    panels: Sequence[FilmedPoint],
    per_second: float,
    watch: Callable[[Iterable[int]], Iterable[int]] = iter,
) -> None:
    """Write the movie of points, side by side, to `path` (.mp4 or .gif), atomically.

    All points have the same number of snapshots, one per frame; `per_second` frames are shown a
    second. `watch` takes the numbers of the frames and yields them one by one, to report progress.
    Raises InputError for another type of file, OSError.
    """
    dpi = (DPI if len(panels) == 1 else DPI_OF_SEVERAL).get(Path(path).suffix)
    frames = watch(range(len(panels[0][1])))
    write_movie(path, lambda: picture(panels, dpi), frames, per_second)


def picture(
    panels: Sequence[FilmedPoint], dpi: float | None = None
) -> tuple[Figure, Callable[[int], None]]:
    """Return a figure of points side by side at their first frame, and a function that draws the
    frame of a number (from 0).

    `dpi` is the resolution in dots per inch, by default matplotlib's.
    """
    views = [view_of(*panel) for panel in panels]  # boxes are equal: the highest view shows all
    cropped = any(view.cropped for view in views)
    view = views[0]._replace(top=max(view.top for view in views), cropped=cropped)
    height = min(3.9, 3.4 * (view.top - view.bottom) / (view.right - view.left))
    inches = math.ceil(10 * (height + LABEL_HEIGHT + GRAPH_HEIGHT)) / 10  # even numbers of pixels
    figure = Figure(figsize=(WIDTH * len(panels), inches), dpi=dpi, layout="constrained")
    subfigures: Any = [figure] if len(panels) == 1 else figure.subfigures(1, len(panels))
    updaters = [
        _panel_updater(subfigure, *filmed, view, height)
        for subfigure, filmed in zip(subfigures, panels, strict=True)
    ]
    highest = max(subfigure.axes[1].get_ylim()[1] for subfigure in subfigures)
    for subfigure, (subject, _) in zip(subfigures, panels, strict=True):
        if subject.scene.effects.spin is not None:
            subfigure.axes[1].set_ylim(top=highest)

    def show(frame: int) -> None:
        """Draw the frame of a number in all panels."""
        for update in updaters:
            update(frame)

    show(0)
    return figure, show


def _panel_updater(figure, subject, shots, view, height):
    """Draw a point into `figure`; return the function that draws the frame of a number.

    `height` is the height of the picture of the box, in inches.
    """
    above, below = figure.subplots(2, 1, height_ratios=(height + LABEL_HEIGHT, GRAPH_HEIGHT))
    figure.suptitle(_title(subject, view), fontsize=9, linespacing=1.4)
    _set_axes(above, subject.scene, view)
    particles, name = _particles_artist(above, subject, shots, view)
    scales = spin_scales(subject, shots)
    boundaries = Boundaries(above, view, subject.scene.effects)
    if particles.colour_map is None:
        _add_species_legend(above, subject)
    elif name:
        bar = figure.colorbar(particles.colour_map, ax=above, shrink=0.9, pad=0.02)
        bar.set_label(name)
        bar.minorticks_off()
    update_graph = _graph_updater(below, subject, shots)

    def show(frame: int) -> None:
        """Draw the frame of a number."""
        scale = np.broadcast_to(scales[frame], len(shots[frame].position))
        particles.show(shots[frame], scale)
        boundaries.show(shots[frame])
        update_graph(frame)

    return show


def _particles_artist(axes, subject, shots, view):
    """Return the artist that draws the particles of a point into `axes`, and the label of its
    colour bar, "" without spin."""
    if subject.colour == "height":
        tallest = max(np.percentile(heights(shot), WHITE_PERCENTILE) for shot in shots)
        return Heights(axes, view, tallest), "height above the floor / a"
    wants_species = subject.colour == "species" or shots[0].spin is None
    by_species = wants_species and shots[0].bodies is not None
    artist = Disks if len(subject.scene.box) == 2 else Spheres
    name = "" if shots[0].spin is None else f"{artist.quantity} / thermal spin"
    return artist(axes, view, by_species), name


def _add_species_legend(axes, subject):
    """Add a legend of the colours of the species of a mixture beside the box."""
    names = names_of(subject.experiment.raw.get("species") or [])
    dots = [
        axes.plot([], [], "o", color=colour, label=name)[0]
        for name, colour in zip(names, itertools.cycle(SPECIES_COLOURS), strict=False)
    ]
    axes.legend(handles=dots, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)


def view_of(subject: MovieSubject, shots: Sequence[Snapshot]) -> View:
    """Return the visible region of the box of a point: all of it, but at most MAX_HEIGHT widths
    high.

    If the box is open upwards, it ends at the highest particle of all snapshots. Spheres are seen
    from the side, with gravity or the gradient of shear along the vertical axis; coloured by
    height, they are seen from above.
    """
    scene, lengths = subject.scene, subject.experiment.lengths
    shows_gravity = scene.effects.gravity is not None and subject.colour != "height"
    vertical = len(lengths) - 1 if shows_gravity else 1
    width, height, bottom = lengths[0] or 0.0, lengths[vertical], 0.0
    full_height = height or 0.0
    if height is None:
        full_height = max((shot.position[:, vertical] + shot.radius()).max() for shot in shots)
        bottom = -0.05 * width
    visible_height = min(full_height, MAX_HEIGHT * width)
    margin = 0.04 * width if scene.box[0] is None else 0.0  # for side walls
    image_height = SLIDING_IMAGES * full_height if scene.effects.shear is not None else 0.0
    if scene.box[vertical] is None and height is not None:  # walls at bottom and top
        bottom, image_height = -0.04 * width, 0.04 * width
        sides = -margin, width + margin, bottom, visible_height + image_height
        return View(*sides, vertical, (scene.box[0], None), False, shows_gravity)
    return View(
        left=-margin,
        right=width + margin,
        bottom=bottom - image_height,
        top=visible_height + image_height,
        vertical=vertical,
        periods=(scene.box[0], scene.box[vertical]),
        cropped=visible_height < full_height,
        shows_gravity=shows_gravity,
    )


def spin_scales(subject: MovieSubject, shots: Sequence[Snapshot]) -> np.ndarray:
    """Return the thermal spin of each frame, (frames,) in a/T, or of each particle, (frames, N), if
    particles differ; NaN without spin.

    It is the r.m.s. spin (surface velocity) at equipartition of the energy of the frame, or, in a
    driven gas, of the mean energy of all frames.
    """
    effects = subject.scene.effects
    if effects.spin is None:
        return np.full(len(shots), np.nan)
    energies = np.array([[shot.E_trans, shot.E_rot] for shot in shots])
    dimension = len(subject.scene.box)
    rotations = 2 * dimension - 3
    energy = np.average(energies, axis=1, weights=(dimension, rotations))
    if not _is_cooling(subject):
        energy = np.full(len(shots), energy.mean())
    bodies = shots[0].bodies
    if bodies is not None:
        return np.sqrt(2.0 * rotations * energy[:, None] / (bodies.mass * bodies.inertia))
    return np.sqrt(2.0 * rotations * energy / effects.spin.inertia)


def _set_axes(axes: Axes, scene: Scene, view: View) -> None:
    """Set the limits and labels of the axes of the box, and mark the edges of a sheared box by
    dashed lines."""
    axes.set(xlim=(view.left, view.right), ylim=(view.bottom, view.top), aspect="equal")
    axes.set(xlabel=r"$x/a$", ylabel=f"${'xyz'[view.vertical]}/a$")
    axes.minorticks_off()
    axes.tick_params(top=False, right=False, direction="out")
    if scene.effects.shear is not None:
        for edge in (0.0, 2.0 * scene.middle):
            axes.axhline(edge, color=style.GREY, linewidth=0.6, linestyle="--")


def _title(subject: MovieSubject, view: View) -> str:
    """Return the title of a point: name of the experiment, r, beta, number of particles, seed, and
    the height seen if the box is higher."""
    scene = subject.scene
    parameters = [rf"$r = {scene.restitution:g}$"]
    if scene.effects.spin is not None:
        parameters.append(rf"$\beta = {scene.roughness:g}$")
    parameters += [rf"$N = {subject.experiment.particles}$", f"seed {subject.seed}"]
    if view.cropped:
        parameters.append(rf"seen up to ${'xyz'[view.vertical]} = {view.top:g}\,a$")
    name, _, variant = subject.name.partition("/")
    name = name.replace("_", " ")
    if variant:  # `bed, wave = sine`
        parameter = parameter_of(subject.experiment.swept or "")
        name += f", {parameter.replace('_', ' ')} = {variant.removeprefix(parameter)}"
    return f"{name}\n{', '.join(parameters)}"


def _graph_updater(
    axes: Axes, subject: MovieSubject, shots: Sequence[Snapshot]
) -> Callable[[int], None]:
    """Draw into `axes` R over time, or the energy if particles do not spin; return the function
    that shows the curve up to a frame."""
    cooling = _is_cooling(subject)
    times = np.array([shot.collisions if cooling else shot.time for shot in shots])
    if shots[0].R is None:
        values = np.array([shot.E_trans for shot in shots])
        axes.set(ylabel=r"$E_\mathrm{trans}$ / ($m a^2/T^2$)")
        axes.set_yscale("log" if cooling else "linear")
    else:
        values = np.array([shot.R for shot in shots])
        axes.set(ylabel=r"$R$", ylim=(0.0, 1.05 * max(0.6, values.max())))
        axes.axhline(0.5, color=style.FAINT, linewidth=0.6, linestyle=":")
    periods = list(drive_periods(subject.scene).values())
    times = times / periods[0] if periods else times
    start = 0 if cooling else math.floor(times[0])
    times = times - start
    unit = PER_PARTICLE if cooling else SHAKES if periods else "time in $T$"
    offset_text = f", after the first {start}" if start else ""
    margin = 0.0 if times[0] < times[-1] else 0.5
    axes.set(xlabel=f"{unit}{offset_text}", xlim=(times[0] - margin, times[-1] + margin))
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    axes.plot(times, values, color="#cccccc", linewidth=0.9)
    (line,) = axes.plot([], [], color=style.LINE_STYLES[0].colour)
    (point,) = axes.plot([], [], "o", color=style.THEORY)

    def show(frame: int) -> None:
        """Show the curve up to the frame of a number, and a dot there."""
        line.set_data(times[: frame + 1], values[: frame + 1])
        point.set_data(times[frame : frame + 1], values[frame : frame + 1])

    return show


def _is_cooling(subject):
    """Return whether the schedule of a point's experiment has no drive."""
    return not protocols.protocol_of(subject.experiment).DRIVEN
