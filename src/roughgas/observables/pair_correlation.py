"""Pair correlation: how likely particles are at a distance from each other.

    g(r) = <pairs at a distance in [r, r + dr)> / (N (N - 1)/2 * V_shell/V),

1 where particles do not know of each other, and 0 below the diameter 2a. A cooling gas is looked at
in the moment of a collision; the pair that collides does not count. Its value at contact, chi,
is that of a parabola through g just outside the diameter. In equilibrium chi is
theory.contact_value: D. Henderson, Mol. Phys. 30, 971 (1975); N. F. Carnahan & K. E. Starling,
J. Chem. Phys. 51, 635 (1969). M. P. Allen & D. J. Tildesley, Computer Simulation of Liquids (2017),
section 2.6.
"""

from collections.abc import Iterator

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import LENGTH, Variable
from roughgas.effects.settings import Number
from roughgas.observables.frame import Frame, System
from roughgas.observables.plugin import Observable, Setting, Values, Whole
from roughgas.theory.transport import VOLUME

DIAMETER = 2.0
GRAZE = 1e-9  # of a: contacts that roundings have pushed together count as contacts
REACH = 10.0  # a, or half of the box
FITTED = 0.6  # a: the distance from contact over which g is taken for a parabola
ROWS = 64  # particles that are compared with others at once

SETTINGS: dict[str, Setting] = {
    "bins": Whole("Number of bins in a diameter.", 1, 1000, 20),
    "reach": Number(f"Largest distance, in a; {REACH:g} if the box is wide enough."),
}
VARIABLES = {
    "distance": Variable("distance of two centres, middle of a bin", LENGTH, ("distance",)),
    "pair_correlation": Variable("pair correlation function g(r)", "1", ("distance",)),
    "contact_value": Variable("pair correlation at contact, g(2a)"),
}


class PairCorrelation(Observable):
    """The pair correlation function g(r), and its value at contact."""

    alike = True
    settings = SETTINGS
    variables = VARIABLES

    def __init__(self, system: System, bins: int, reach: float | None) -> None:
        super().__init__(system)
        lengths = [length for length in system.box if length is not None]
        if not all(system.periodic):
            legal = "not be given: the box must be periodic along all axes"
            raise InputError("observables.pair_correlation", "in this box", legal)
        most = min(lengths) / 2.0
        if reach is not None and not DIAMETER < reach <= most:
            legal = f"be in (2, {most:g}], from the diameter to half of the box"
            raise InputError("observables.pair_correlation.reach", reach, legal)
        self._width = DIAMETER / bins
        self._edges = self._width * np.arange(int((reach or min(REACH, most)) / self._width) + 1)
        middle = (self._edges[1:] + self._edges[:-1]) / 2.0
        self.coordinates = {"distance": middle}
        D, N = system.dimension, system.particles
        shells = VOLUME[D] * np.diff(self._edges**D)
        self._ideal = N * (N - 1) / 2.0 * shells / system.volume
        self._near = np.flatnonzero((middle > DIAMETER) & (middle < DIAMETER + FITTED))

    def look(self, frame: Frame) -> Values:
        """Return g of a frame."""
        counts = np.zeros(len(self._ideal))
        for square in squares(frame, self._edges[-1]):
            if self.system.cooling:
                square = square[np.abs(np.sqrt(square) - DIAMETER) > GRAZE]
            place = ((np.sqrt(square) + GRAZE) / self._width).astype(int)
            counts += np.bincount(place[place < len(counts)], minlength=len(counts))
        return {"pair_correlation": counts / self._ideal}

    def combine(self, means: Values) -> Values:
        """Return g, and its value at contact."""
        g, near = means["pair_correlation"], self._near
        order = min(2, len(near) - 1)
        away = self.coordinates["distance"][near] - DIAMETER
        if order < 0:
            return {**means, "contact_value": np.array(np.nan)}
        chi = np.polynomial.polynomial.polyfit(away, g[near], order)[0]
        return {**means, "contact_value": np.asarray(chi)}


def squares(frame: Frame, reach: float) -> Iterator[np.ndarray]:
    """Generate the squared distances of all pairs nearer than `reach`, at most half of the box.

    Particles are sorted along the second axis, along which the images above slide in a sheared gas,
    and each is compared with those that follow it within `reach`.
    """
    lengths = np.array(frame.system.box, float)
    position = frame.position[np.argsort(frame.position[:, 1])]
    number = len(position)
    above = position[position[:, 1] < reach].copy()
    above[:, 1] += lengths[1]
    above[:, 0] += frame.image_shift
    position = np.concatenate([position, above])
    last = np.searchsorted(position[:, 1], position[:, 1] + reach, side="right")
    others = [axis for axis in range(len(lengths)) if axis != 1]
    for first in range(0, number, ROWS):
        rows = np.arange(first, min(first + ROWS, number))
        later = np.arange(first + 1, last[rows[-1]])
        between = position[None, later] - position[rows, None]
        for axis in others:
            between[..., axis] -= lengths[axis] * np.rint(between[..., axis] / lengths[axis])
        square = (between**2).sum(axis=-1)
        yield square[(later[None] > rows[:, None]) & (square < reach**2)]
