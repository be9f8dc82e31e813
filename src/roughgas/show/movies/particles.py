"""Particles and boundaries as a movie shows them, each drawn once and then moved."""

import math
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize, to_rgba
from matplotlib.patches import Rectangle

from roughgas.effects import Effects
from roughgas.show.circles import add_circles, move
from roughgas.show.movies.snapshots import Snapshot

SPIN = ScalarMappable(Normalize(-2.0, 2.0), "PuOr")
AMOUNT = ScalarMappable(Normalize(0.0, 2.0), "viridis")
PLAIN = np.array(to_rgba("#9ecae1"))  # of particles that do not spin
EDGE = np.array(to_rgba("#333333"))
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


class Copies(NamedTuple):
    """Particles and those of their images that are seen."""

    of: np.ndarray  # (M,) numbers of particles
    x: np.ndarray
    y: np.ndarray
    row: np.ndarray  # of images: 0 in the box, 1 above, -1 below


def copies(view: View, across: np.ndarray, up: np.ndarray, slide: float | None) -> Copies:
    """Which particles, and which of their periodic images, reach into the view.

    The images above are displaced by `slide` under shear, None where there is none.
    """
    parts = []
    width, tall = view.periods
    for row in (0,) if tall is None else (0, -1, 1):
        y = up + row * (tall or 0.0)
        start = across + row * (slide or 0.0)
        for column in (0,) if width is None else (0, -2, -1, 1, 2):
            x = start + column * (width or 0.0)
            seen = (x > view.left - 1.0) & (x < view.right + 1.0)
            seen &= (y > view.bottom - 1.0) & (y < view.top + 1.0)
            (of,) = np.nonzero(seen)
            parts.append(Copies(of, x[of], y[of], np.full(len(of), row)))
    return Copies(*map(np.concatenate, zip(*parts, strict=True)))


class Disks:
    """Disks, coloured by their spin, with a mark that turns."""

    quantity, coloured = "spin", SPIN

    def __init__(self, axes: Axes, view: View, scales: np.ndarray | None) -> None:
        self._view, self._scales = view, scales
        self._disks = add_circles(axes, edgecolor=EDGE, linewidth=0.4)
        self._marks = LineCollection([], color=EDGE, linewidth=0.9, capstyle="round")
        axes.add_collection(self._marks)

    def show(self, frame: int, shot: Snapshot) -> None:
        """Bring them to a snapshot, the one of this frame."""
        seen = copies(self._view, shot.position[:, 0], shot.position[:, 1], shot.slide)
        opacity = np.where((seen.row != 0) & (shot.slide is not None), IMAGE, 1.0)
        move(self._disks, seen.x, seen.y)
        if shot.spin is None:
            self._disks.set(facecolor=_with(PLAIN, opacity), edgecolor=_with(EDGE, opacity))
            return
        colours = SPIN.to_rgba(shot.spin[seen.of, 0] / self._scales[frame])
        self._disks.set(facecolor=_with(colours, opacity), edgecolor=_with(EDGE, opacity))
        tip = np.stack([np.cos(shot.angle[seen.of]), np.sin(shot.angle[seen.of])], axis=-1)
        middle = np.stack([seen.x, seen.y], axis=-1)
        self._marks.set_segments(np.stack([middle, middle + 0.9 * tip], axis=1))
        dark = colours[:, :3] @ LUMINANCE < DARK
        self._marks.set_color(_with(np.where(dark[:, None], 1.0, EDGE), opacity))


class Spheres:
    """Spheres seen from the side, the nearest last, coloured by the amount of their spin."""

    quantity, coloured = "|spin|", AMOUNT

    def __init__(self, axes: Axes, view: View, scales: np.ndarray | None) -> None:
        self._view, self._scales = view, scales
        self._depth = 3 - view.vertical  # the axis that is neither across nor up
        self._disks = add_circles(axes, linewidth=0.3)

    def show(self, frame: int, shot: Snapshot) -> None:
        """Bring them to a snapshot, the one of this frame."""
        up, depth = shot.position[:, self._view.vertical], shot.position[:, self._depth]
        if self._depth == 2:
            depth = -depth  # the third axis points to the viewer
        seen = copies(self._view, shot.position[:, 0], up, shot.slide)
        order = np.argsort(-depth[seen.of], kind="stable")
        seen = Copies(*(part[order] for part in seen))
        radius, shift, white = np.tile(np.array(SHADES), (len(order), 1)).T
        of, x, y, row = (np.repeat(part, len(SHADES)) for part in seen)
        near = (depth[of] - depth.min()) / max(np.ptp(depth), 1e-9)
        colours = self._colours(shot, frame)[of]
        colours[:, :3] = _towards_white(colours[:, :3], FAR * near)
        colours[:, :3] = _towards_white(colours[:, :3], white)
        opacity = np.where((row != 0) & (shot.slide is not None), IMAGE, 1.0)
        rim = np.where(white == 0.0, opacity, 0.0)
        move(self._disks, x - shift, y + shift, 2.0 * radius)
        self._disks.set(facecolor=_with(colours, opacity), edgecolor=_with(EDGE, rim))

    def _colours(self, shot, frame):
        if shot.spin is None:
            return np.tile(PLAIN, (len(shot.position), 1))
        return AMOUNT.to_rgba(np.linalg.norm(shot.spin, axis=1) / self._scales[frame])


class Boundaries:
    """The floor as a bar that moves, and side walls; those that are shaken carry scratches."""

    def __init__(self, axes: Axes, view: View, effects: Effects) -> None:
        self._view, tall = view, view.top - view.bottom
        self._floor = self._scratches = None
        wide = view.right - view.left
        if effects.walls is not None or effects.shaken_walls is not None:
            for x in (view.left, view.right + view.left):
                axes.add_patch(Rectangle((x, view.bottom), -view.left, tall, color=WALL))
        if effects.shaken_walls is not None:
            self._scratches = LineCollection([], color=SCRATCH, linewidth=1.2)
            axes.add_collection(self._scratches)
        if effects.floor is not None:
            self._floor = Rectangle((view.left, view.bottom), wide, 0.0, color=WALL)
            axes.add_patch(self._floor)

    def show(self, shot: Snapshot) -> None:
        """Bring them to a snapshot."""
        view = self._view
        if self._floor is not None:
            self._floor.set_height(shot.floor - view.bottom)
        if self._scratches is not None:
            spacing = (view.top - view.bottom) / 12.0
            y = view.bottom + spacing * np.arange(-1, 14) + math.fmod(shot.walls, spacing)
            left = [((view.left, one), (0.0, one + spacing / 3)) for one in y]
            inner = view.right + view.left
            right = [((inner, one + spacing / 3), (view.right, one)) for one in y]
            self._scratches.set_segments(left + right)


def _with(colours, opacity):
    """Colours (M, 4), or one for all, with opacities (M,)."""
    chosen = np.array(np.broadcast_to(colours, (len(opacity), 4)))
    chosen[:, 3] = opacity
    return chosen


def _towards_white(rgb, share):
    return rgb + (1.0 - rgb) * share[:, None]
