"""Distributions of velocities, spins and distances, and mean square displacements.

V is the velocity without the mean flow of a sheared gas, w the spin. Averages are over all
particles and observations.

Cumulants measure the deviation of distributions from Gaussians; they are the coefficients of the
first Sonine polynomials:

    a20 = D <V^4>/[(D + 2) <V^2>^2] - 1,    a02 = n <w^4>/[(n + 2) <w^2>^2] - 1,  n = 2 D - 3.

They vanish in equilibrium. A. Santos, G. M. Kremer & M. dos Santos, Phys. Fluids 23, 030604 (2011).
In a cooling gas a20 is too small by 2/(D N), as E_trans is 1 in each observation.

Histograms are of single components, divided by the root mean square over all particles and
components of the same observation, so that a Gaussian is exp(-c^2/2)/sqrt(2 pi) at any energy.
Values are densities: summed over the bins, times their width, they give 1 less the share beyond the
last bin. In a sheared gas the mean spin is subtracted, too. On stretched tails: T. P. C. van Noije
& M. H. Ernst, Granular Matter 1, 57 (1998).

Correlations of velocities and spins:

    a11 = <V^2 w^2>/(<V^2> <w^2>) - 1,    alignment = 3 <(V.w)^2>/<V^2 w^2> - 1  (spheres),

and the mean of cos^2 of the angle between V and w, which is 1/3 if spheres have no preferred
direction of flight: N. V. Brilliantov, T. Pöschel, W. T. Kranz & A. Zippelius, Phys. Rev. Lett. 98,
128001 (2007). The spin of a disk is always perpendicular to its velocity.

Pair correlation is the probability of pairs at a distance, relative to independent particles,

    g(r) = <pairs at a distance in [r, r + dr)> / (N (N - 1)/2 * V_shell/V),

1 for independent particles, and 0 below the diameter 2a. For two species it counts the N_k N_l
pairs of unlike particles, and is 0 below a_k + a_l. A cooling gas is observed at the instant of a
collision; the colliding pair does not count. The value at contact, chi, is extrapolated by a
parabola through g just outside the diameter. In equilibrium chi is theory.contact_value: D.
Henderson, Mol. Phys. 30, 971 (1975); N. F. Carnahan & K. E. Starling, J. Chem. Phys. 51, 635
(1969). M. P. Allen & D. J. Tildesley, Computer Simulation of Liquids (2017), section 2.6.

Mean square displacement in a given time,

    MSD_k(t) = <(x_k(t0 + t) - x_k(t0))^2>, by component,

over all particles and all observations t0. It is <v_k^2> t^2 if t is short against the time between
contacts, and 2 D t in a fluid at long times: A. Einstein, Ann. Phys. 322, 549 (1905). In a sheared
gas the component along the flow is omitted. The kernel counts the crossings of periodic boundaries
(effects/paths.py): displacements are exact for any interval between observations.

Arrays (k, ...) are of the k instants of a FrameSeries.
"""

from collections import deque
from collections.abc import Iterator, Mapping
from typing import Annotated

import numpy as np

from roughgas.base import InputError
from roughgas.base.fields import number, whole
from roughgas.data.variables import LENGTH, SPIN, TIME, Variable
from roughgas.observables.averages import NamedArrays
from roughgas.observables.frames import FrameSeries, SpeciesGroup, System
from roughgas.observables.plugin import IN_THIS_BOX, Observable, ObservableSettings, columnwise
from roughgas.theory.closed_forms import VOLUME


class Cumulants(Observable):
    """Fourth cumulants of velocities and of spins."""

    single_species = True
    relaxations, valid_in_beds = 96.0, False
    variables: Mapping[str, Variable] = {
        "a20": Variable("cumulant D <V^4>/[(D + 2) <V^2>^2] - 1 of velocities"),
        "a02": Variable("cumulant n <w^4>/[(n + 2) <w^2>^2] - 1 of spins", when=(SPIN,)),
    }

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return second and fourth moments of velocities and of spins, (k,) each."""
        V2 = (frames.thermal_velocity**2).sum(axis=-1)
        w2 = (frames.thermal_spin**2).sum(axis=-1)
        moments = {"V2": V2, "V4": V2**2, "w2": w2, "w4": w2**2}
        return {name: values.mean(axis=-1) for name, values in moments.items()}

    # not columnwise: the square of a number alone and in an array may differ in its last bit
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the cumulants a20 and, where particles spin, a02, of the `means` of moments."""
        D = self.system.dimension
        results = {"a20": _cumulant(means["V2"], means["V4"], D)}
        if self.system.inertia is not None:
            results["a02"] = _cumulant(means["w2"], means["w4"], 2 * D - 3)
        return results


def _cumulant(second, fourth, components):
    """Return the fourth cumulant of vectors with a number of components, from their moments.

    `second` and `fourth` are the means of the square and of the fourth power of the length.
    """
    return components * fourth / ((components + 2) * second**2) - 1.0


REDUCED_VELOCITY = "reduced_velocity"


class HistogramsSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `histograms`."""

    bins: Annotated[int, whole(2, 10_000, "Number of bins.")] = 60
    reach: Annotated[float, number("(0, 1000]", "End of the last bin, in root mean squares.")] = 6.0


class Histograms(Observable):
    """Distributions of the components of velocities and of spins."""

    single_species = True
    settings = HistogramsSettings
    relaxations = 96.0
    variables: Mapping[str, Variable] = {
        REDUCED_VELOCITY: Variable(
            "middle of a bin, in root mean squares", "1", (REDUCED_VELOCITY,)
        ),
        "component": Variable("component of a vector", "", ("component",), "str"),
        "velocity_histogram": Variable(
            "distribution of velocities", "1", (REDUCED_VELOCITY, "component")
        ),
        "spin_histogram": Variable("distribution of spins", "1", (REDUCED_VELOCITY,), when=(SPIN,)),
    }

    def __init__(self, system: System, bins: int, reach: float) -> None:
        """Divide [-reach, reach], in root mean squares, into `bins` bins."""
        super().__init__(system)
        self._edges = np.linspace(-reach, reach, bins + 1)
        middle = (self._edges[1:] + self._edges[:-1]) / 2.0
        self.coordinates = {REDUCED_VELOCITY: middle, "component": system.axes}

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return the densities of the components of velocities and spins in each frame.

        (k, bins, D) of velocities, (k, bins) of all components of spins.
        """
        velocity = _reduced(frames.thermal_velocity)
        columns = [self._histograms(velocity[..., axis]) for axis in range(self.system.dimension)]
        results = {"velocity_histogram": np.stack(columns, axis=-1)}
        if self.system.inertia is not None:
            spin = _reduced(frames.thermal_spin)
            results["spin_histogram"] = self._histograms(spin.reshape(len(spin), -1))
        return results

    def _histograms(self, values: np.ndarray) -> np.ndarray:
        """Return the densities (k, bins) of values (k, n); the last bin includes its upper edge."""
        edges, (instants, number) = self._edges, values.shape
        bins = len(edges) - 1
        bin_index = np.searchsorted(edges, values, side="right") - (values == edges[-1])
        bin_index += (bins + 2) * np.arange(instants)[
            :, None
        ]  # outer bins for values beyond the edges
        counts = np.bincount(bin_index.ravel(), minlength=instants * (bins + 2))
        inside = counts.reshape(instants, -1)[:, 1:-1]
        return inside / (number * np.diff(edges))


def _reduced(values):
    """Return components (k, N, ...) over their root mean square at each instant; 0 if all are 0."""
    scale = np.sqrt(np.mean((values**2).reshape(len(values), -1), axis=1))
    return values / np.where(scale > 0.0, scale, 1.0)[:, None, None]


SPHERES = "spheres"


class SpinCorrelation(Observable):
    """Correlation of velocities and spins, in magnitude and, for spheres, in direction."""

    needs_spin = True
    single_species = True
    relaxations = 96.0
    variables: Mapping[str, Variable] = {
        "a11": Variable("<V^2 w^2>/(<V^2> <w^2>) - 1 of velocities and spins"),
        "alignment": Variable("3 <(V.w)^2>/<V^2 w^2> - 1 of velocities and spins", when=(SPHERES,)),
        "cos2_angle": Variable("mean of cos^2 of the angle between V and w", when=(SPHERES,)),
    }

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return moments of velocities and spins, and the mean cos^2 of their angle, (k,)."""
        V, w = frames.thermal_velocity, frames.thermal_spin
        V2, w2 = (V**2).sum(axis=-1), (w**2).sum(axis=-1)
        moments = {"V2": V2, "w2": w2, "V2w2": V2 * w2}
        if self.system.dimension == 3:
            moments["Vw"] = (V * w).sum(axis=-1) ** 2
        averages = {name: values.mean(axis=-1) for name, values in moments.items()}
        if self.system.dimension == 3:
            averages["angle"] = _mean_ratios(moments["Vw"], moments["V2w2"])
        return averages

    @columnwise
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return a11 and, for spheres, alignment and mean cos^2, of the `means` of moments."""
        results = {"a11": means["V2w2"] / (means["V2"] * means["w2"]) - 1.0}
        if self.system.dimension == 3:
            results["alignment"] = 3.0 * means["Vw"] / means["V2w2"] - 1.0
            results["cos2_angle"] = means["angle"]
        return results


def _mean_ratios(numerators: np.ndarray, denominators: np.ndarray) -> np.ndarray:
    """Return the means (k,) of ratios of numbers (k, N), over denominators that are not 0."""
    positive = denominators > 0.0
    if positive.all():
        means: np.ndarray = (numerators / denominators).mean(axis=-1)
        return means
    ratios = [
        numerator[valid] / denominator[valid]
        for numerator, denominator, valid in zip(numerators, denominators, positive, strict=True)
    ]
    return np.array([values.mean() if values.size else np.nan for values in ratios])


DIAMETER = 2.0
CONTACT_TOLERANCE = 1e-9  # in a; rounding may let particles in contact overlap
DEFAULT_REACH = 10.0  # in a; half of the box if that is smaller
FIT_RANGE = 0.6  # in a: range of distances from contact in the fit of a parabola to g


Reach = Annotated[
    float,
    number("(0, inf)", f"Largest distance, in a; {DEFAULT_REACH:g} if the box is wide enough."),
]


class PairCorrelationSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `pair_correlation`."""

    bins: Annotated[int, whole(1, 1000, "Number of bins in a diameter.")] = 20
    reach: Reach | None = None


class PairCorrelation(Observable):
    """The pair correlation function g(r), and its value at contact."""

    single_species = pairwise = True
    settings = PairCorrelationSettings
    relaxations = 24.0
    variables: Mapping[str, Variable] = {
        "distance": Variable("distance of two centres, middle of a bin", LENGTH, ("distance",)),
        "pair_correlation": Variable("pair correlation function g(r)", "1", ("distance",)),
        "contact_value": Variable("pair correlation at contact, g(2a)"),
    }

    def __init__(self, system: System, bins: int, reach: float | None) -> None:
        """Divide distances up to `reach` (particle radii a) into bins, `bins` of them a diameter.

        Raises InputError unless the box is periodic, and `reach` at most half of it.
        """
        super().__init__(system)
        lengths = [length for length in system.box if length is not None]
        if not all(system.periodic):
            legal = "not be given: the box must be periodic along all axes"
            raise InputError("observables.pair_correlation", "in this box", legal)
        longest = min(lengths) / 2.0
        if reach is not None and not DIAMETER < reach <= longest:
            legal = f"be in (2, {longest:g}], from the diameter to half of the box"
            raise InputError("observables.pair_correlation.reach", reach, legal)
        self._width = DIAMETER / bins
        self._edges = self._width * np.arange(
            int((reach or min(DEFAULT_REACH, longest)) / self._width) + 1
        )
        middle = (self._edges[1:] + self._edges[:-1]) / 2.0
        self.coordinates = {"distance": middle}
        D, groups = system.dimension, system.species or (SpeciesGroup(system.particles, 1.0),)
        N, M = groups[0].particles, groups[-1].particles
        pairs = N * M if len(groups) == 2 else N * (N - 1) / 2.0
        self._ideal = pairs * VOLUME[D] * np.diff(self._edges**D) / system.volume
        self._contact = contact = groups[0].radius + groups[-1].radius
        beyond_contact = self._edges[:-1] > contact - CONTACT_TOLERANCE
        self._near = np.flatnonzero(beyond_contact & (middle < contact + FIT_RANGE))

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return the pair correlation g(r) in each frame, (k, bins)."""
        bins, instants = len(self._ideal), frames.instants
        counts = np.zeros(instants * bins)
        for instant, square in squared_pair_distances(frames, self._edges[-1]):
            distance = np.sqrt(square)
            bin_index = ((distance + CONTACT_TOLERANCE) / self._width).astype(int)
            counted = bin_index < bins
            if self.system.cooling:
                counted &= ~(np.abs(distance - self._contact) <= CONTACT_TOLERANCE)
            bin_index += bins * instant
            counts += np.bincount(bin_index[counted], minlength=len(counts))
        with np.errstate(invalid="ignore"):  # a single particle has no pairs
            return {"pair_correlation": counts.reshape(instants, bins) / self._ideal}

    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return g (bins,), and its value at contact by a fit of a parabola."""
        g, near = means["pair_correlation"], self._near
        order = min(2, len(near) - 1)
        away = self.coordinates["distance"][near] - self._contact
        if order < 0:
            return {**means, "contact_value": np.array(np.nan)}
        chi = np.polynomial.polynomial.polyfit(away, g[near], order)[0]
        return {**means, "contact_value": np.asarray(chi)}


def squared_pair_distances(
    frames: FrameSeries, reach: float
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Generate the instants and squared distances of all pairs nearer than `reach`, (pairs,) each.

    Squared distances are in a^2. `reach` (in particle radii a) is at most half of the box; instants
    are counted from 0. With two species, only pairs of unlike particles. Particles are sorted along
    the second axis, whose periodic images are shifted in a sheared gas, and compared with the next
    particle, the second next, and so on, within `reach`.
    """
    lengths, number = frames.system.box, frames.position.shape[1]
    axes, species = _sorted_with_images(frames, reach)
    for later in range(1, axes[1].shape[1]):
        rows = min(number, axes[1].shape[1] - later)
        separations = [
            coordinate[:, later : later + rows] - coordinate[:, :rows] for coordinate in axes
        ]
        if not (separations[1] < reach).any():
            return
        square = np.zeros(separations[0].shape)
        for axis, (separation, length) in enumerate(zip(separations, lengths, strict=True)):
            if axis != 1:
                assert length is not None  # the box is periodic
                separation -= length * np.rint(separation / length)
            square += separation**2
        near = square < reach**2
        if species is not None:
            near &= species[:, later : later + rows] != species[:, :rows]
        yield np.nonzero(near)[0], square[near]


def _sorted_with_images(frames, reach):
    """Return positions along each axis, (k, N + images), and species, sorted along the second axis.

    Species are None unless there are two. Images are copies of the lowest particles above the box;
    an image that is beyond `reach` (in particle radii a) is at inf.
    """
    order = np.argsort(frames.position[..., 1], axis=-1)
    axes = [
        np.take_along_axis(coordinate, order, axis=-1)
        for coordinate in np.moveaxis(frames.position, -1, 0)
    ]
    low = axes[1] < reach
    images = np.count_nonzero(low, axis=-1).max()
    images_above = [coordinate[:, :images].copy() for coordinate in axes]
    images_above[0] += frames.image_shift[:, None]
    images_above[1] = np.where(low[:, :images], images_above[1] + frames.system.box[1], np.inf)
    axes = [np.concatenate(pair, axis=-1) for pair in zip(axes, images_above, strict=True)]
    if frames.species_of is None or len(frames.system.species) != 2:
        return axes, None
    species = frames.species_of[order]
    return axes, np.concatenate([species, species[:, :images]], axis=-1)


MSD_NAME = "mean_square_displacement"


class MeanSquareDisplacementSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `mean_square_displacement`."""

    lags: Annotated[int, whole(1, 20, "Number of times, each twice the one before.")] = 8


class MeanSquareDisplacement(Observable):
    """Mean square displacement after 1, 2, 4, 8, ... observations."""

    effects = ("paths",)
    settings = MeanSquareDisplacementSettings
    relaxations, depends_on_flow = 96.0, True
    variables: Mapping[str, Variable] = {
        "lag": Variable("time between two observations", TIME, ("lag",)),
        "moving": Variable("component of the displacement", "", ("moving",), "str"),
        MSD_NAME: Variable(
            f"mean square displacement{IN_THIS_BOX}", f"{LENGTH}^2", ("lag", "moving")
        ),
    }

    def __init__(self, system: System, lags: int) -> None:
        """Keep the positions of earlier observations; `lags` is the number of times."""
        super().__init__(system)
        self._lags = 2 ** np.arange(lags)
        self._axes = slice(1 if system.shear_rate else 0, None)
        self._path: deque[np.ndarray] = deque(maxlen=2 ** (lags - 1) + 1)
        self.coordinates = {"lag": self._lags * system.interval, "moving": system.axes[self._axes]}

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return the mean square displacement since earlier observations, NaN without one.

        It is averaged over the particles, in a^2, and has shape (k, lags, components).
        """
        assert frames.unwrapped_position is not None  # the effect is in the scene
        positions = frames.unwrapped_position[..., self._axes]
        path, known_instants = np.array([*self._path, *positions]), len(self._path)
        self._path.extend(positions.copy())
        squared_displacements = np.full(
            (len(positions), len(self._lags), positions.shape[-1]), np.nan
        )
        for lag_index, lag in enumerate(self._lags.tolist()):
            first = max(known_instants, lag)
            if first < len(path):
                steps = path[first:] - path[first - lag : len(path) - lag]
                squared_displacements[first - known_instants :, lag_index] = (steps**2).mean(axis=1)
        return {MSD_NAME: squared_displacements}
