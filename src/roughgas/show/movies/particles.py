"""Particles and boundaries as a movie shows them, each drawn once and then moved."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize, to_rgba_array
from matplotlib.patches import Rectangle

from roughgas.effects import Effects
from roughgas.show import style
from roughgas.show.style import add_circles, move
from roughgas.simulation.trajectory import Snapshot

PLAIN = to_rgba_array("#9ecae1")  # of particles that do not spin
OF_SPECIES = to_rgba_array([look.colour for look in style.LOOKS])
EDGE = to_rgba_array("#333333")
LUMINANCE, DARK = np.array([0.299, 0.587, 0.114]), 0.4  # below which a mark is white
IMAGE = 0.35  # opacity of the sliding images
WALL, SCRATCH = "#777777", "#dddddd"
# A sphere in light from the upper left: radii, displacements and shares of white of its disks
SHADES = ((1.0, 0.0, 0.0), (0.72, 0.16, 0.18), (0.40, 0.32, 0.42))
FAR = 0.45  # share of white in the furthest sphere's colour


class View(NamedTuple):
    """What is seen of the box, in a."""

    left: float
    right: float
    bottom: float
    top: float
    vertical: int  # axis of the box
    periods: tuple[float | None, float | None]  # along what is drawn across and up
    cropped: bool  # whether there is more of it above
    falls: bool = True  # whether what is up is up; not seen from above


def copies(view: View, shot: Snapshot) -> tuple[np.ndarray, ...]:
    """Return the particles, and those of their periodic images, that reach into the view.

    Under shear, the images above and below have slid, and are faint. Returns numbers of particles,
    x, y and opacities, all (M,).
    """
    parts, radius = [], shot.radius()
    width, tall = view.periods
    for row in (0,) if tall is None else (0, -1, 1):
        y = shot.position[:, view.vertical] + row * (tall or 0.0)
        start = shot.position[:, 0] + row * (shot.slide or 0.0)
        opacity = 1.0 if row == 0 or shot.slide is None else IMAGE
        for column in (0,) if width is None else (0, -2, -1, 1, 2):
            x = start + column * (width or 0.0)
            seen = (x > view.left - radius) & (x < view.right + radius)
            seen &= (y > view.bottom - radius) & (y < view.top + radius)
            (of,) = np.nonzero(seen)
            parts.append((of, x[of], y[of], np.full(len(of), opacity)))
    return tuple(map(np.concatenate, zip(*parts, strict=True)))


def colours_of(
    shot: Snapshot, of: np.ndarray, spin: np.ndarray | None, coloured: ScalarMappable | None
) -> np.ndarray:
    """Return the colours (M, 4) of particles with these numbers, by their `spin` (M,) in units of
    the thermal one; without `coloured` by their species."""
    if coloured is None and shot.bodies is not None:
        return OF_SPECIES[shot.bodies.species[of] % len(OF_SPECIES)]
    if spin is None or coloured is None:
        return np.tile(PLAIN, (len(of), 1))
    return coloured.to_rgba(spin)


class Disks:
    """Disks, coloured by their spin or their species, with a mark that turns."""

    quantity, by_spin = "spin", ScalarMappable(Normalize(-2.0, 2.0), "PuOr")

    def __init__(self, axes: Axes, view: View, by_species: bool = False) -> None:
        self._view, self.coloured = view, None if by_species else self.by_spin
        self._disks = add_circles(axes, edgecolor=EDGE, linewidth=0.4)
        self._marks = LineCollection([], color=EDGE, linewidth=0.9, capstyle="round")
        axes.add_collection(self._marks)

    def show(self, shot: Snapshot, scale: np.ndarray) -> None:
        """Bring them to a snapshot; `scale` are the particles' thermal spins, (N,)."""
        of, x, y, opacity = copies(self._view, shot)
        spin = None if shot.spin is None else shot.spin[of, 0] / scale[of]
        colours, radius = colours_of(shot, of, spin, self.coloured), shot.radius()[of]
        move(self._disks, x, y, 2.0 * radius)
        self._disks.set_facecolor(list(to_rgba_array(colours, opacity)))
        self._disks.set_edgecolor(list(to_rgba_array(EDGE, opacity)))
        if shot.spin is not None and shot.angle is not None:
            tip = np.stack([np.cos(shot.angle[of]), np.sin(shot.angle[of])], axis=-1)
            middle = np.stack([x, y], axis=-1)
            end = middle + 0.9 * radius[:, None] * tip
            self._marks.set_segments(list(np.stack([middle, end], axis=1)))
            dark = colours[:, :3] @ LUMINANCE < DARK
            self._marks.set_color(list(to_rgba_array(np.where(dark[:, None], 1.0, EDGE), opacity)))


class Spheres:
    """Spheres seen from the side, the nearest last, coloured by the amount of their spin or by
    their species."""

    quantity, by_spin = "|spin|", ScalarMappable(Normalize(0.0, 2.0), "viridis")

    def __init__(self, axes: Axes, view: View, by_species: bool = False) -> None:
        self._view, self.coloured = view, None if by_species else self.by_spin
        self._disks = add_circles(axes, linewidth=0.3)

    def show(self, shot: Snapshot, scale: np.ndarray) -> None:
        """Bring them to a snapshot; `scale` are the particles' thermal spins, (N,)."""
        axis = 3 - self._view.vertical  # neither across nor up
        depth = shot.position[:, axis] * (-1.0 if axis == 2 else 1.0)  # z points to the viewer
        seen = copies(self._view, shot)
        order = np.argsort(-depth[seen[0]], kind="stable")
        of, x, y, opacity = (np.repeat(part[order], len(SHADES)) for part in seen)
        radius, shift, white = np.tile(np.array(SHADES), (len(order), 1)).T
        near = (depth[of] - depth.min()) / max(np.ptp(depth), 1e-9)
        spin = None if shot.spin is None else np.linalg.norm(shot.spin[of], axis=1) / scale[of]
        colours, size = colours_of(shot, of, spin, self.coloured), shot.radius()[of]
        for share in (FAR * near, white):
            colours[:, :3] += (1.0 - colours[:, :3]) * share[:, None]
        rim = np.where(white == 0.0, opacity, 0.0)
        move(self._disks, x - shift * size, y + shift * size, 2.0 * radius * size)
        self._disks.set_facecolor(list(to_rgba_array(colours, opacity)))
        self._disks.set_edgecolor(list(to_rgba_array(EDGE, rim)))


class Heights:
    """Spheres seen from above, the highest last, the lighter the higher above the floor."""

    def __init__(self, axes: Axes, view: View, tallest: float) -> None:
        self._view, self.coloured = view, ScalarMappable(Normalize(0.0, tallest), "gray")
        self._disks = add_circles(axes, linewidth=0.0)

    def show(self, shot: Snapshot, scale: np.ndarray) -> None:
        """Bring them to a snapshot; thermal spins do not matter."""
        height = heights(shot)
        of, x, y, _ = copies(self._view, shot)
        order = np.argsort(height[of], kind="stable")
        of = of[order]
        move(self._disks, x[order], y[order], 2.0 * shot.radius()[of])
        self._disks.set_facecolor(list(self.coloured.to_rgba(height[of])))


def heights(shot: Snapshot) -> np.ndarray:
    """Return the heights of the particles above the floor, (N,) in a."""
    return shot.position[:, -1] - (shot.floor or 0.0)


class Boundaries:
    """The floor as a bar that moves, and side walls; those that are shaken carry scratches."""

    def __init__(self, axes: Axes, view: View, effects: Effects) -> None:
        self._view, tall = view, view.top - view.bottom
        self._floor = self._scratches = None
        if effects.walls is not None or effects.shaken_walls is not None:
            for x in (view.left, view.right + view.left):
                axes.add_patch(Rectangle((x, view.bottom), -view.left, tall, color=WALL))
        if effects.shaken_walls is not None:
            self._scratches = LineCollection([], color=SCRATCH, linewidth=1.2)
            axes.add_collection(self._scratches)
        if effects.floor is not None and view.falls:
            wide = view.right - view.left
            self._floor = Rectangle((view.left, view.bottom), wide, 0.0, color=WALL)
            axes.add_patch(self._floor)

        self._axes = axes
        self._sides: list[Rectangle] = []

    def _show_sides(self, planes: Sequence[tuple[float, float]]) -> None:
        """Draw walls on single sides from the edge of the picture to their surfaces."""
        view = self._view
        while len(self._sides) < 4:
            self._sides.append(Rectangle((0.0, 0.0), 0.0, 0.0, color=WALL))
            self._axes.add_patch(self._sides[-1])
        (left, right), (low, high) = planes[0], planes[view.vertical]
        ends = (view.left, left), (right, view.right)
        for side, (begin, end) in zip(self._sides[:2], ends, strict=True):
            if math.isfinite(end - begin):
                side.set_bounds(begin, view.bottom, end - begin, view.top - view.bottom)
        ends = (view.bottom, low), (high, view.top)
        for side, (begin, end) in zip(self._sides[2:], ends, strict=True):
            if math.isfinite(end - begin):
                side.set_bounds(view.left, begin, view.right - view.left, end - begin)

    def show(self, shot: Snapshot) -> None:
        """Bring them to a snapshot."""
        view = self._view
        if shot.planes:
            self._show_sides(shot.planes)
        if self._floor is not None and shot.floor is not None:
            self._floor.set_height(shot.floor - view.bottom)
        if self._scratches is not None and shot.walls is not None:
            spacing = (view.top - view.bottom) / 12.0
            y = view.bottom + spacing * np.arange(-1, 14) + math.fmod(shot.walls, spacing)
            left = [((view.left, one), (0.0, one + spacing / 3)) for one in y]
            inner = view.right + view.left
            right = [((inner, one + spacing / 3), (view.right, one)) for one in y]
            self._scratches.set_segments(left + right)
