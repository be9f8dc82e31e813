"""Distributions of velocities, spins and distances, and how far particles get.

V is the velocity without the mean flow of a sheared gas, w the spin. Averages are over all
particles and looks.

Cumulants are how far distributions are from Gaussian ones, coefficients of the first Sonine
polynomials:

    a20 = D <V^4>/[(D + 2) <V^2>^2] - 1,    a02 = n <w^4>/[(n + 2) <w^2>^2] - 1,  n = 2 D - 3.

They vanish in equilibrium. A. Santos, G. M. Kremer & M. dos Santos, Phys. Fluids 23, 030604 (2011).
In a cooling gas, whose E_trans each look takes for 1, a20 is too small by 2/(D N).

Histograms are of single components, each divided by the root of its mean square over all particles
and components at the same look, so that a Gaussian is exp(-c^2/2)/sqrt(2 pi), whatever the energy.
Values are densities: summed over the bins, times their width, they give 1 less the share beyond the
last bin. In a sheared gas the mean spin is subtracted, too. Of stretched tails: T. P. C. van Noije
& M. H. Ernst, Granular Matter 1, 57 (1998).

Correlations are how velocities and spins depend on each other:

    a11 = <V^2 w^2>/(<V^2> <w^2>) - 1,    alignment = 3 <(V.w)^2>/<V^2 w^2> - 1  (spheres),

and the mean of cos^2 of the angle between V and w, which is 1/3 if spheres fly in no preferred
direction: N. V. Brilliantov, T. Pöschel, W. T. Kranz & A. Zippelius, Phys. Rev. Lett. 98, 128001
(2007). The spin of a disk is always across its velocity.

Pair correlation is how likely particles are at a distance from each other,

    g(r) = <pairs at a distance in [r, r + dr)> / (N (N - 1)/2 * V_shell/V),

1 where particles do not know of each other, and 0 below the diameter 2a. Of two species it is that
of the N_k N_l pairs of one with the other, 0 below a_k + a_l. A cooling gas is looked at
in the moment of a collision; the pair that collides does not count. Its value at contact, chi,
is that of a parabola through g just outside the diameter. In equilibrium chi is
theory.contact_value: D. Henderson, Mol. Phys. 30, 971 (1975); N. F. Carnahan & K. E. Starling,
J. Chem. Phys. 51, 635 (1969). M. P. Allen & D. J. Tildesley, Computer Simulation of Liquids (2017),
section 2.6.

Mean square displacement is how far particles get in a given time,

    MSD_k(t) = <(x_k(t0 + t) - x_k(t0))^2>, by component,

over all particles and all looks t0. It is <v_k^2> t^2 where t is short against the time between
contacts, and 2 D t in a fluid at long times: A. Einstein, Ann. Phys. 322, 549 (1905). In a sheared
gas the component along the flow is left out. The kernel counts the crossings of periodic boundaries
(effects/paths.py): displacements are exact, however far apart the observations are.
"""

from collections import deque
from collections.abc import Iterator, Mapping
from typing import ClassVar

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import LENGTH, SPIN, TIME, Variable
from roughgas.effects.settings import Number
from roughgas.observables.plugin import (
    IN_THIS_BOX,
    Frame,
    Group,
    Observable,
    Setting,
    System,
    Values,
    Whole,
)
from roughgas.theory.closed_forms import VOLUME


class Cumulants(Observable):
    """Fourth cumulants of velocities and of spins."""

    alike = True
    relaxations, beds = 96.0, False
    variables: Mapping[str, Variable] = {
        "a20": Variable("cumulant D <V^4>/[(D + 2) <V^2>^2] - 1 of velocities"),
        "a02": Variable("cumulant n <w^4>/[(n + 2) <w^2>^2] - 1 of spins", when=(SPIN,)),
    }

    def look(self, frame: Frame) -> Values:
        """Return second and fourth moments."""
        V2 = (frame.thermal_velocity**2).sum(axis=1)
        w2 = (frame.thermal_spin**2).sum(axis=1)
        moments = {"V2": V2, "V4": V2**2, "w2": w2, "w4": w2**2}
        return {name: values.mean() for name, values in moments.items()}

    def combine(self, means: Values) -> Values:
        """Return the cumulants."""
        D = self.system.dimension
        found = {"a20": _cumulant(means["V2"], means["V4"], D)}
        if self.system.inertia is not None:
            found["a02"] = _cumulant(means["w2"], means["w4"], 2 * D - 3)
        return found


def _cumulant(second, fourth, components):
    return components * fourth / ((components + 2) * second**2) - 1.0


ALONG = "reduced_velocity"


class Histograms(Observable):
    """Distributions of the components of velocities and of spins."""

    alike = True
    settings: ClassVar[Mapping[str, Setting]] = {
        "bins": Whole("Number of bins.", 2, 10_000, 60),
        "reach": Number("End of the last bin, in root mean squares.", "(0, 1000]", 6.0),
    }
    relaxations = 96.0
    variables: Mapping[str, Variable] = {
        ALONG: Variable("middle of a bin, in root mean squares", "1", (ALONG,)),
        "component": Variable("component of a vector", "", ("component",), "str"),
        "velocity_histogram": Variable("distribution of velocities", "1", (ALONG, "component")),
        "spin_histogram": Variable("distribution of spins", "1", (ALONG,), when=(SPIN,)),
    }

    def __init__(self, system: System, bins: int, reach: float) -> None:
        super().__init__(system)
        self._edges = np.linspace(-reach, reach, bins + 1)
        middle = (self._edges[1:] + self._edges[:-1]) / 2.0
        self.coordinates = {ALONG: middle, "component": system.axes}

    def look(self, frame: Frame) -> Values:
        """Return the histograms of a frame."""
        velocity = _reduced(frame.thermal_velocity)
        columns = [self._histogram(column) for column in velocity.T]
        found = {"velocity_histogram": np.array(columns).T}
        if self.system.inertia is not None:
            found["spin_histogram"] = self._histogram(_reduced(frame.thermal_spin))
        return found

    def _histogram(self, values: np.ndarray) -> np.ndarray:
        counts, edges = np.histogram(values, self._edges)
        return counts / (values.size * np.diff(edges))


def _reduced(values):
    """Return components in terms of their root mean square; 0 where all are 0."""
    scale = np.sqrt(np.mean(values**2))
    return values / scale if scale > 0.0 else values


SPHERES = "spheres"


class SpinCorrelation(Observable):
    """Correlation of velocities and spins, in magnitude and, for spheres, in direction."""

    spins = True
    alike = True
    relaxations = 96.0
    variables: Mapping[str, Variable] = {
        "a11": Variable("<V^2 w^2>/(<V^2> <w^2>) - 1 of velocities and spins"),
        "alignment": Variable("3 <(V.w)^2>/<V^2 w^2> - 1 of velocities and spins", when=(SPHERES,)),
        "cos2_angle": Variable("mean of cos^2 of the angle between V and w", when=(SPHERES,)),
    }

    def look(self, frame: Frame) -> Values:
        """Return mixed moments."""
        V, w = frame.thermal_velocity, frame.thermal_spin
        V2, w2 = (V**2).sum(axis=1), (w**2).sum(axis=1)
        found = {"V2": V2.mean(), "w2": w2.mean(), "V2w2": (V2 * w2).mean()}
        if self.system.dimension == 3:
            square, both = (V * w).sum(axis=1) ** 2, V2 * w2
            angle = square[both > 0.0] / both[both > 0.0]
            found |= {"Vw": square.mean(), "angle": angle.mean() if angle.size else np.nan}
        return found

    def combine(self, means: Values) -> Values:
        """Return the correlations."""
        found = {"a11": means["V2w2"] / (means["V2"] * means["w2"]) - 1.0}
        if self.system.dimension == 3:
            found["alignment"] = 3.0 * means["Vw"] / means["V2w2"] - 1.0
            found["cos2_angle"] = means["angle"]
        return found


DIAMETER = 2.0
GRAZE = 1e-9  # of a: contacts that roundings have pushed together count as contacts
REACH = 10.0  # a, or half of the box
FITTED = 0.6  # a: the distance from contact over which g is taken for a parabola
ROWS = 64  # particles that are compared with others at once


class PairCorrelation(Observable):
    """The pair correlation function g(r), and its value at contact."""

    alike = pairs = True
    settings: ClassVar[Mapping[str, Setting]] = {
        "bins": Whole("Number of bins in a diameter.", 1, 1000, 20),
        "reach": Number(f"Largest distance, in a; {REACH:g} if the box is wide enough."),
    }
    relaxations = 24.0
    variables: Mapping[str, Variable] = {
        "distance": Variable("distance of two centres, middle of a bin", LENGTH, ("distance",)),
        "pair_correlation": Variable("pair correlation function g(r)", "1", ("distance",)),
        "contact_value": Variable("pair correlation at contact, g(2a)"),
    }

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
        D, groups = system.dimension, system.species or (Group(system.particles, 1.0),)
        N, M = groups[0].particles, groups[-1].particles
        number = N * M if len(groups) == 2 else N * (N - 1) / 2.0
        self._ideal = number * VOLUME[D] * np.diff(self._edges**D) / system.volume
        self._contact = contact = groups[0].radius + groups[-1].radius
        outside = self._edges[:-1] > contact - GRAZE
        self._near = np.flatnonzero(outside & (middle < contact + FITTED))

    def look(self, frame: Frame) -> Values:
        """Return g of a frame."""
        counts = np.zeros(len(self._ideal))
        for square in squares(frame, self._edges[-1]):
            if self.system.cooling:
                square = square[~(np.abs(np.sqrt(square) - self._contact) <= GRAZE)]
            place = ((np.sqrt(square) + GRAZE) / self._width).astype(int)
            counts += np.bincount(place[place < len(counts)], minlength=len(counts))
        with np.errstate(invalid="ignore"):  # one particle has no pairs
            return {"pair_correlation": counts / self._ideal}

    def combine(self, means: Values) -> Values:
        """Return g, and its value at contact."""
        g, near = means["pair_correlation"], self._near
        order = min(2, len(near) - 1)
        away = self.coordinates["distance"][near] - self._contact
        if order < 0:
            return {**means, "contact_value": np.array(np.nan)}
        chi = np.polynomial.polynomial.polyfit(away, g[near], order)[0]
        return {**means, "contact_value": np.asarray(chi)}


def squares(frame: Frame, reach: float) -> Iterator[np.ndarray]:
    """Generate the squared distances of all pairs nearer than `reach`, at most half of the box; of
    two species those of one with the other.

    Particles are sorted along the second axis, along which the images above slide in a sheared gas,
    and each is compared with those that follow it within `reach`.
    """
    lengths = np.array(frame.system.box, float)
    order, species = np.argsort(frame.position[:, 1]), frame.species_of
    apart = species is not None and len(frame.system.species) == 2
    position, kind = frame.position[order], order if species is None else species[order]
    number, near = len(position), position[:, 1] < reach
    above, kind = position[near].copy(), np.concatenate([kind, kind[near]])
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
        there = (later[None] > rows[:, None]) & (square < reach**2)
        if apart:
            there &= kind[later] != kind[rows, None]
        yield square[there]


NAME = "mean_square_displacement"


class MeanSquareDisplacement(Observable):
    """Mean square displacement after 1, 2, 4, 8, ... observations."""

    effects = ("paths",)
    settings: ClassVar[Mapping[str, Setting]] = {
        "lags": Whole("Number of times, each twice the one before.", 1, 20, 8)
    }
    relaxations, of_flow = 96.0, True
    variables: Mapping[str, Variable] = {
        "lag": Variable("time between two observations", TIME, ("lag",)),
        "moving": Variable("component of the displacement", "", ("moving",), "str"),
        NAME: Variable(f"mean square displacement{IN_THIS_BOX}", f"{LENGTH}^2", ("lag", "moving")),
    }

    def __init__(self, system: System, lags: int) -> None:
        super().__init__(system)
        self._looks = 2 ** np.arange(lags)
        self._axes = slice(1 if system.shear_rate else 0, None)
        self._path: deque[np.ndarray] = deque(maxlen=2 ** (lags - 1) + 1)
        self.coordinates = {"lag": self._looks * system.interval, "moving": system.axes[self._axes]}

    def look(self, frame: Frame) -> Values:
        """Return the mean square displacement since earlier looks, NaN where there was none."""
        assert frame.unwrapped_position is not None  # the effect is in the scene
        self._path.append(frame.unwrapped_position[:, self._axes])
        squares = np.full((len(self._looks), self._path[-1].shape[1]), np.nan)
        for row, looks in zip(squares, self._looks, strict=True):
            if looks < len(self._path):
                row[:] = ((self._path[-1] - self._path[-1 - looks]) ** 2).mean(axis=0)
        return {NAME: squares}
