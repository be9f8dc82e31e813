"""Artists of particles and boundaries in movies: created once, then moved from frame to frame.

Lengths are in particle radii a; `axes` has coordinates in a. Spins are surface velocities in a/T; a
thermal spin is the r.m.s. spin at equipartition. `shot` is the snapshot of a frame.
"""

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
from roughgas.show.style import add_circles, move_circles
from roughgas.simulation.trajectory import Snapshot

SPINLESS_COLOUR = to_rgba_array("#9ecae1")  # of particles that do not spin
SPECIES_COLOURS = to_rgba_array([line_style.colour for line_style in style.LINE_STYLES])
EDGE_COLOUR = to_rgba_array("#333333")
LUMINANCE, DARK_LUMINANCE = np.array([0.299, 0.587, 0.114]), 0.4  # below which a mark is white
IMAGE_OPACITY = 0.35  # of sliding images
WALL_COLOUR, SCRATCH_COLOUR = "#777777", "#dddddd"
# disks that draw a sphere lit from the upper left: radii, displacements and shares of white
SPHERE_DISKS = ((1.0, 0.0, 0.0), (0.72, 0.16, 0.18), (0.40, 0.32, 0.42))
FAR_WHITENESS = 0.45  # share of white in the furthest sphere's colour


class View(NamedTuple):
    """The visible region of the box, in particle radii a."""

    left: float
    right: float
    bottom: float
    top: float
    vertical: int  # axis of the box that is drawn upwards
    periods: tuple[float | None, float | None]  # of the horizontal and the vertical axis
    cropped: bool  # whether the box reaches beyond `top`
    shows_gravity: bool = True  # whether gravity points downwards, not into the picture


def visible_copies(view: View, shot: Snapshot) -> tuple[np.ndarray, ...]:
    """Return the M particles and periodic images that overlap the view: indices of particles, x, y
    in a, and opacities from 0 to 1, all (M,).

    Under shear, the images above and below are displaced, and faint.
    """
    copies, radius = [], shot.radius()
    width, height = view.periods
    for row in (0,) if height is None else (0, -1, 1):
        y = shot.position[:, view.vertical] + row * (height or 0.0)
        offset_x = shot.position[:, 0] + row * (shot.slide or 0.0)
        opacity = 1.0 if row == 0 or shot.slide is None else IMAGE_OPACITY
        for column in (0,) if width is None else (0, -2, -1, 1, 2):
            x = offset_x + column * (width or 0.0)
            visible = (x > view.left - radius) & (x < view.right + radius)
            visible &= (y > view.bottom - radius) & (y < view.top + radius)
            (indices,) = np.nonzero(visible)
            copies.append((indices, x[indices], y[indices], np.full(len(indices), opacity)))
    return tuple(map(np.concatenate, zip(*copies, strict=True)))


def colours_of(
    shot: Snapshot, indices: np.ndarray, spin: np.ndarray | None, colour_map: ScalarMappable | None
) -> np.ndarray:
    """Return the colours, RGBA (M, 4), of the particles at `indices` (M,), by `spin` (M,) in units
    of the thermal spin, or by species without `colour_map`."""
    if colour_map is None and shot.bodies is not None:
        return SPECIES_COLOURS[shot.bodies.species[indices] % len(SPECIES_COLOURS)]
    if spin is None or colour_map is None:
        return np.tile(SPINLESS_COLOUR, (len(indices), 1))
    return colour_map.to_rgba(spin)


class Disks:
    """Disks, coloured by spin, or by species if `by_species`, each with a line from its centre that
    shows its angle."""

    quantity, by_spin = "spin", ScalarMappable(Normalize(-2.0, 2.0), "PuOr")

    def __init__(self, axes: Axes, view: View, by_species: bool = False) -> None:
        """Add an empty collection of disks, and of lines that show their angles, to `axes`."""
        self._view, self.colour_map = view, None if by_species else self.by_spin
        self._disks = add_circles(axes, edgecolor=EDGE_COLOUR, linewidth=0.4)
        self._marks = LineCollection([], color=EDGE_COLOUR, linewidth=0.9, capstyle="round")
        axes.add_collection(self._marks)

    def show(self, shot: Snapshot, scale: np.ndarray) -> None:
        """Move the disks to a snapshot; `scale` has the thermal spins of the particles, (N,)."""
        indices, x, y, opacity = visible_copies(self._view, shot)
        spin = None if shot.spin is None else shot.spin[indices, 0] / scale[indices]
        colours, radius = colours_of(shot, indices, spin, self.colour_map), shot.radius()[indices]
        move_circles(self._disks, x, y, 2.0 * radius)
        self._disks.set_facecolor(list(to_rgba_array(colours, opacity)))
        self._disks.set_edgecolor(list(to_rgba_array(EDGE_COLOUR, opacity)))
        if shot.spin is not None and shot.angle is not None:
            tip = np.stack([np.cos(shot.angle[indices]), np.sin(shot.angle[indices])], axis=-1)
            middle = np.stack([x, y], axis=-1)
            end = middle + 0.9 * radius[:, None] * tip
            self._marks.set_segments(list(np.stack([middle, end], axis=1)))
            dark = colours[:, :3] @ LUMINANCE < DARK_LUMINANCE
            self._marks.set_color(
                list(to_rgba_array(np.where(dark[:, None], 1.0, EDGE_COLOUR), opacity))
            )


class Spheres:
    """Spheres seen from the side, the nearest drawn last, coloured by |spin|, or by species if
    `by_species`."""

    quantity, by_spin = "|spin|", ScalarMappable(Normalize(0.0, 2.0), "viridis")

    def __init__(self, axes: Axes, view: View, by_species: bool = False) -> None:
        """Add an empty collection of spheres to `axes`."""
        self._view, self.colour_map = view, None if by_species else self.by_spin
        self._disks = add_circles(axes, linewidth=0.3)

    def show(self, shot: Snapshot, scale: np.ndarray) -> None:
        """Move the spheres to a snapshot; `scale` has the thermal spins of the particles, (N,)."""
        axis = 3 - self._view.vertical  # along the line of sight
        depth = shot.position[:, axis] * (-1.0 if axis == 2 else 1.0)  # z points to the viewer
        copies = visible_copies(self._view, shot)
        order = np.argsort(-depth[copies[0]], kind="stable")
        indices, x, y, opacity = (np.repeat(column[order], len(SPHERE_DISKS)) for column in copies)
        radius, shift, white = np.tile(np.array(SPHERE_DISKS), (len(order), 1)).T
        distance = (depth[indices] - depth.min()) / max(np.ptp(depth), 1e-9)
        spin = (
            None
            if shot.spin is None
            else np.linalg.norm(shot.spin[indices], axis=1) / scale[indices]
        )
        colours, particle_radius = (
            colours_of(shot, indices, spin, self.colour_map),
            shot.radius()[indices],
        )
        for whiteness in (FAR_WHITENESS * distance, white):
            colours[:, :3] += (1.0 - colours[:, :3]) * whiteness[:, None]
        rim = np.where(white == 0.0, opacity, 0.0)
        move_circles(
            self._disks,
            x - shift * particle_radius,
            y + shift * particle_radius,
            2.0 * radius * particle_radius,
        )
        self._disks.set_facecolor(list(to_rgba_array(colours, opacity)))
        self._disks.set_edgecolor(list(to_rgba_array(EDGE_COLOUR, rim)))


class Heights:
    """Spheres seen from above, the highest drawn last and lightest: white from the height
    `tallest`, in a."""

    def __init__(self, axes: Axes, view: View, tallest: float) -> None:
        """Add an empty collection of spheres to `axes`."""
        self._view, self.colour_map = view, ScalarMappable(Normalize(0.0, tallest), "gray")
        self._disks = add_circles(axes, linewidth=0.0)

    def show(self, shot: Snapshot, scale: np.ndarray) -> None:
        """Move the spheres to a snapshot; `scale`, as of other artists, is ignored."""
        height = heights(shot)
        indices, x, y, _ = visible_copies(self._view, shot)
        order = np.argsort(height[indices], kind="stable")
        indices = indices[order]
        move_circles(self._disks, x[order], y[order], 2.0 * shot.radius()[indices])
        self._disks.set_facecolor(list(self.colour_map.to_rgba(height[indices])))


def heights(shot: Snapshot) -> np.ndarray:
    """Return the heights of the particles above the floor, (N,) in a; without a floor, their
    coordinates on the last axis."""
    return shot.position[:, -1] - (shot.floor or 0.0)


class Boundaries:
    """The floor as a moving bar, and side walls; scratches show the motion of shaken walls."""

    def __init__(self, axes: Axes, view: View, effects: Effects) -> None:
        """Add to `axes` the floor and the side walls in `effects`; walls of single sides follow at
        the first frame."""
        self._view, height = view, view.top - view.bottom
        self._floor = self._scratches = None
        if effects.walls is not None or effects.shaken_walls is not None:
            for x in (view.left, view.right + view.left):
                axes.add_patch(Rectangle((x, view.bottom), -view.left, height, color=WALL_COLOUR))
        if effects.shaken_walls is not None:
            self._scratches = LineCollection([], color=SCRATCH_COLOUR, linewidth=1.2)
            axes.add_collection(self._scratches)
        if effects.floor is not None and view.shows_gravity:
            width = view.right - view.left
            self._floor = Rectangle((view.left, view.bottom), width, 0.0, color=WALL_COLOUR)
            axes.add_patch(self._floor)

        self._axes = axes
        self._sides: list[Rectangle] = []

    def _show_sides(self, planes: Sequence[tuple[float, float]]) -> None:
        """Draw walls of single sides, from the edge of the picture to their surfaces; `planes` has
        (low, high) of each axis in a, infinite without a wall."""
        view = self._view
        while len(self._sides) < 4:
            self._sides.append(Rectangle((0.0, 0.0), 0.0, 0.0, color=WALL_COLOUR))
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
        """Move the boundaries to their positions in a snapshot."""
        view = self._view
        if shot.planes:
            self._show_sides(shot.planes)
        if self._floor is not None and shot.floor is not None:
            self._floor.set_height(shot.floor - view.bottom)
        if self._scratches is not None and shot.walls is not None:
            spacing = (view.top - view.bottom) / 12.0
            y = view.bottom + spacing * np.arange(-1, 14) + math.fmod(shot.walls, spacing)
            left = [((view.left, edge), (0.0, edge + spacing / 3)) for edge in y]
            inner = view.right + view.left
            right = [((inner, edge + spacing / 3), (view.right, edge)) for edge in y]
            self._scratches.set_segments(left + right)
