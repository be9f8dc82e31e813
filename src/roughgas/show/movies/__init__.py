"""The movie of a scene: particles that move and spin, boundaries, and R(t) running beneath."""

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from roughgas.config.labels import names_of
from roughgas.data.reduced import third_axis
from roughgas.scene import Scene
from roughgas.show import style
from roughgas.show.movies.particles import (
    OF_SPECIES,
    Boundaries,
    Disks,
    Heights,
    Spheres,
    View,
    heights,
)
from roughgas.show.style import write_movie
from roughgas.simulation import schedule
from roughgas.simulation.steady import drive_periods
from roughgas.simulation.trajectory import Snapshot

WIDTH = 4.8  # inches
DPI = {".gif": 70, ".mp4": 200}
DPI_BESIDE = {".gif": 60, ".mp4": 120}  # where several are side by side
TALLEST = 1.5  # of what is shown, in widths of the box
TALL = 99.0  # percentile of height from which on spheres seen from above are white
SLIDING_IMAGES = 0.15  # of the images above and below that is shown, in heights of the box
FRAME_SPACE, GRAPH = 0.85, 1.25  # inches: title and label, and the graph beneath
PER_PARTICLE, SHAKES = "collisions per particle", "shakes"


class MovieSubject(NamedTuple):
    """What a movie is of."""

    name: str  # of the experiment
    settings: Mapping[str, Any]
    scene: Scene
    seed: int
    colour: str = "spin"  # what particles are coloured by: spin, species, or height, from above


Panel = tuple[MovieSubject, Sequence[Snapshot]]
"""What is seen of one point."""


def write(
    path: str | Path,
    panels: Sequence[Panel],
    per_second: float,
    watch: Callable[[Iterable[int]], Iterable[int]] = iter,
) -> None:
    """Write the movie of points, side by side, to `path` (.mp4 or .gif), whole or not at all.

    All have equally many shots. `watch` gets the numbers of the frames, and yields each as it is
    to be drawn. Raises InputError for another kind of file, OSError.
    """
    dpi = (DPI if len(panels) == 1 else DPI_BESIDE).get(Path(path).suffix)
    frames = watch(range(len(panels[0][1])))
    write_movie(path, lambda: picture(panels, dpi), frames, per_second)


def picture(
    panels: Sequence[Panel], dpi: float | None = None
) -> tuple[Figure, Callable[[int], None]]:
    """Return the figure at its first frame, and a function that brings it to another one."""
    views = [view_of(*panel) for panel in panels]  # of equal boxes: as much as shows all
    cropped = any(view.cropped for view in views)
    view = views[0]._replace(top=max(view.top for view in views), cropped=cropped)
    room = min(3.9, 3.4 * (view.top - view.bottom) / (view.right - view.left))
    inches = math.ceil(10 * (room + FRAME_SPACE + GRAPH)) / 10  # even numbers of pixels
    figure = Figure(figsize=(WIDTH * len(panels), inches), dpi=dpi, layout="constrained")
    parts: Any = [figure] if len(panels) == 1 else figure.subfigures(1, len(panels))
    shows = [_panel(part, *one, view, room) for part, one in zip(parts, panels, strict=True)]
    highest = max(part.axes[1].get_ylim()[1] for part in parts)
    for part, (subject, _) in zip(parts, panels, strict=True):
        if subject.scene.effects.spin is not None:
            part.axes[1].set_ylim(top=highest)

    def show(frame: int) -> None:
        for one in shows:
            one(frame)

    show(0)
    return figure, show


def _panel(figure, subject, shots, view, room):
    """Draw one point; return what brings it to a frame."""
    above, below = figure.subplots(2, 1, height_ratios=(room + FRAME_SPACE, GRAPH))
    figure.suptitle(_title(subject, view), fontsize=9, linespacing=1.4)
    _set_up(above, subject.scene, view)
    particles, name = _particles(above, subject, shots, view)
    scales = spin_scales(subject, shots)
    boundaries = Boundaries(above, view, subject.scene.effects)
    if particles.coloured is None:
        _name_species(above, subject)
    elif name:
        bar = figure.colorbar(particles.coloured, ax=above, shrink=0.9, pad=0.02)
        bar.set_label(name)
        bar.minorticks_off()
    present = _graph(below, subject, shots)

    def show(frame: int) -> None:
        scale = np.broadcast_to(scales[frame], len(shots[frame].position))
        particles.show(shots[frame], scale)
        boundaries.show(shots[frame])
        present(frame)

    return show


def _particles(axes, subject, shots, view):
    """Return what draws the particles, and what their colour means, if anything."""
    if subject.colour == "height":
        tallest = max(np.percentile(heights(shot), TALL) for shot in shots)
        return Heights(axes, view, tallest), "height above the floor / a"
    asked = subject.colour == "species" or shots[0].spin is None
    by_species = asked and shots[0].bodies is not None
    kind = Disks if len(subject.scene.box) == 2 else Spheres
    name = "" if shots[0].spin is None else f"{kind.quantity} / thermal spin"
    return kind(axes, view, by_species), name


def _name_species(axes, subject):
    """Say which colour is which species, beside the box."""
    names = names_of(subject.settings)
    dots = [
        axes.plot([], [], "o", color=colour, label=name)[0]
        for name, colour in zip(names, itertools.cycle(OF_SPECIES), strict=False)
    ]
    axes.legend(handles=dots, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)


def view_of(subject: MovieSubject, shots: Sequence[Snapshot]) -> View:
    """Return what is seen of the box: all of it, but no more than TALLEST widths high.

    In space it is seen from the side: the vertical axis is that of gravity, or of the gradient of
    shear; coloured by height, it is seen from above.
    """
    scene, lengths = subject.scene, subject.settings["box"]
    falls = scene.effects.gravity is not None and subject.colour != "height"
    vertical = len(lengths) - 1 if falls else 1
    width, tall = float(lengths[0]), lengths[vertical]
    bottom = 0.0
    if lengths[vertical] == "open":
        tall = max((shot.position[:, vertical] + shot.radius()).max() for shot in shots)
        bottom = -0.05 * width
    shown = min(tall, TALLEST * width)
    margin = 0.04 * width if scene.box[0] is None else 0.0  # where walls are drawn
    images = SLIDING_IMAGES * tall if scene.effects.shear is not None else 0.0
    if scene.box[vertical] is None and lengths[vertical] != "open":  # two walls across
        bottom, images = -0.04 * width, 0.04 * width
        sides = -margin, width + margin, bottom, shown + images
        return View(*sides, vertical, (scene.box[0], None), False, falls)
    return View(
        left=-margin,
        right=width + margin,
        bottom=bottom - images,
        top=shown + images,
        vertical=vertical,
        periods=(scene.box[0], scene.box[vertical]),
        cropped=shown < tall,
        falls=falls,
    )


def spin_scales(subject: MovieSubject, shots: Sequence[Snapshot]) -> np.ndarray:
    """Return the thermal spin of each frame, in a/T; NaN without spin.

    It is the r.m.s. that spins would have if the energy of the frame were shared equally; in a
    driven gas, that of all frames. Where particles differ, each has its own, (frames, N).
    """
    effects = subject.scene.effects
    if effects.spin is None:
        return np.full(len(shots), np.nan)
    parts = np.array([[shot.E_trans, shot.E_rot] for shot in shots])
    dimension = len(subject.scene.box)
    rotations = 2 * dimension - 3
    energy = np.average(parts, axis=1, weights=(dimension, rotations))
    if not _cools(subject):
        energy = np.full(len(shots), energy.mean())
    bodies = shots[0].bodies
    if bodies is not None:
        return np.sqrt(2.0 * rotations * energy[:, None] / (bodies.mass * bodies.inertia))
    return np.sqrt(2.0 * rotations * energy / effects.spin.inertia)


def _set_up(axes: Axes, scene: Scene, view: View) -> None:
    axes.set(xlim=(view.left, view.right), ylim=(view.bottom, view.top), aspect="equal")
    axes.set(xlabel=r"$x/a$", ylabel=f"${'xyz'[view.vertical]}/a$")
    axes.minorticks_off()
    axes.tick_params(top=False, right=False, direction="out")
    if scene.effects.shear is not None:
        for edge in (0.0, 2.0 * scene.middle):
            axes.axhline(edge, color=style.GREY, linewidth=0.6, linestyle="--")


def _title(subject: MovieSubject, view: View) -> str:
    scene = subject.scene
    about = [rf"$r = {scene.restitution:g}$"]
    if scene.effects.spin is not None:
        about.append(rf"$\beta = {scene.roughness:g}$")
    about += [rf"$N = {subject.settings['particles']}$", f"seed {subject.seed}"]
    if view.cropped:
        about.append(rf"seen up to ${'xyz'[view.vertical]} = {view.top:g}\,a$")
    name, _, variant = subject.name.partition("/")
    name = name.replace("_", " ")
    if variant:  # `bed, wave = sine`
        parameter = third_axis(subject.settings) or ""
        name += f", {parameter.replace('_', ' ')} = {variant.removeprefix(parameter)}"
    return f"{name}\n{', '.join(about)}"


def _graph(axes: Axes, subject: MovieSubject, shots: Sequence[Snapshot]) -> Callable[[int], None]:
    """Draw R over time, or the energy if nothing spins; return what shows it up to a frame."""
    cooling = _cools(subject)
    at = np.array([shot.collisions if cooling else shot.time for shot in shots])
    if shots[0].R is None:
        values = np.array([shot.E_trans for shot in shots])
        axes.set(ylabel=r"$E_\mathrm{trans}$ / ($m a^2/T^2$)")
        axes.set_yscale("log" if cooling else "linear")
    else:
        values = np.array([shot.R for shot in shots])
        axes.set(ylabel=r"$R$", ylim=(0.0, 1.05 * max(0.6, values.max())))
        axes.axhline(0.5, color=style.FAINT, linewidth=0.6, linestyle=":")
    shaken = list(drive_periods(subject.scene).values())
    at = at / shaken[0] if shaken else at
    begun = 0 if cooling else math.floor(at[0])
    at = at - begun
    unit = PER_PARTICLE if cooling else SHAKES if shaken else "time in $T$"
    since = f", after the first {begun}" if begun else ""
    room = 0.0 if at[0] < at[-1] else 0.5
    axes.set(xlabel=f"{unit}{since}", xlim=(at[0] - room, at[-1] + room))
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    axes.plot(at, values, color="#cccccc", linewidth=0.9)
    (line,) = axes.plot([], [], color=style.LOOKS[0].colour)
    (point,) = axes.plot([], [], "o", color=style.THEORY)

    def show(frame: int) -> None:
        line.set_data(at[: frame + 1], values[: frame + 1])
        point.set_data(at[frame : frame + 1], values[frame : frame + 1])

    return show


def _cools(subject):
    return not schedule.of(subject.settings).DRIVEN
