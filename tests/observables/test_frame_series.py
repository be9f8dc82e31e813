"""Observables give the same bits for several frames at once and for one frame after another."""

from functools import partial

import numpy as np
import pytest
from msgspec.structs import asdict
from recorded import NAMES, bits, recorded

from roughgas.base import InputError, NeedsError
from roughgas.effects.contacts import COUNTS, HEAT, STRESSES, columns_of_pairs
from roughgas.effects.wall_impulses import columns_of_walls
from roughgas.observables import OBSERVABLES, averages
from roughgas.observables.averages import averaged
from roughgas.observables.frames import FrameSeries
from roughgas.observables.plugin import Observable, SpeciesObservable

FRAMES = 30
CUTS = (1, 8, 9)  # first frames of later calls
SETTINGS = {
    "mean_square_displacement": {"lags": 4},
    "autocorrelation": {"delays": 6},
    "flux_autocorrelation": {"delays": 6},
    "histograms": {"reach": 1.0},  # some values are beyond it
    "profiles": {"bins": 7},
}


def with_rates(frames):
    """Return frames with random sums over contacts."""
    rng = np.random.default_rng(3)
    system = frames.system
    names = columns_of_pairs([*STRESSES, *HEAT, *COUNTS], max(1, len(system.species)))
    names += columns_of_walls(system.walls, system.dimension, system.inertia is not None)
    return frames._replace(rates={n: rng.standard_normal(frames.instants) for n in names})


def observable_constructors(frames):
    """Return constructors of the observables that suit a gas, also by species, by name."""
    constructors = {}
    for name, kind in OBSERVABLES.items():
        settings = asdict(kind.settings()) | SETTINGS.get(name, {})
        settings.pop("every")
        make = partial(kind, frames.system, **settings)
        try:
            make()
        except (InputError, NeedsError):
            continue
        constructors[name] = make
        if frames.species_of is not None and not kind.effects:
            constructors[f"{name} of species"] = partial(
                SpeciesObservable, kind, frames.system, settings
            )
    return constructors


def pieces(frames, cuts):
    """Yield the frames in several pieces."""
    for first, end in zip((0, *cuts), (*cuts, frames.instants), strict=True):
        yield FrameSeries.of([frames.frame(number) for number in range(first, end)])


def joined(looks):
    return {name: np.concatenate([values[name] for values in looks]) for name in looks[0]}


def assert_same_bits(make, frames):
    """Assert the same bits for frames all at once, in pieces, and one by one."""
    by_frame, at_once, in_pieces = make(), make(), make()
    singles = [by_frame.observe(frames.frame(number)) for number in range(frames.instants)]
    expected = {name: np.array([values[name] for values in singles]) for name in singles[0]}
    for results in (
        at_once.observe_series(frames),
        joined([in_pieces.observe_series(x) for x in pieces(frames, CUTS)]),
    ):
        assert results.keys() == expected.keys()
        for name, values in results.items():
            assert bits(values) == bits(expected[name]), name


@pytest.mark.parametrize("gas", NAMES)
def test_frames_have_the_same_bits_alone_and_in_a_series(gas):
    frames = with_rates(recorded(gas, FRAMES))
    if frames.unwrapped_position is None:
        frames = frames._replace(unwrapped_position=3.0 * frames.position)
    constructors = observable_constructors(frames)
    assert len(constructors) >= 9
    for make in constructors.values():
        assert_same_bits(make, frames)


def test_particles_at_rest_are_observed_too():
    """Some, which have no direction, and in one frame all, which have no thermal speed."""
    frames = with_rates(recorded("spheres", FRAMES))
    velocity, spin = frames.velocity.copy(), frames.spin.copy()
    velocity[:, :3] = spin[:, 2:5] = velocity[4] = spin[4] = 0.0
    frames = frames._replace(velocity=velocity, spin=spin)
    constructors = observable_constructors(frames)
    for name in ("spin_correlation", "histograms", "profiles"):
        assert_same_bits(constructors[name], frames)
    angles = constructors["spin_correlation"]().observe_series(frames)["angle"]
    assert np.isnan(angles[4]) and np.isfinite(np.delete(angles, 4)).all()


COLUMNWISE = {"profiles", "spin_correlation", "stress", "local_flow", "autocorrelation"}


@pytest.mark.parametrize("gas", ["sheared", "spheres", "cooling mixture"])
def test_means_have_the_same_errors_together_and_one_by_one(gas, monkeypatch):
    """Of all observables that combine many means at once, a few thousand numbers at a time."""
    monkeypatch.setattr(averages, "MAXIMUM_ENTRIES", 5000)
    frames = with_rates(recorded(gas, FRAMES))
    frames = frames._replace(unwrapped_position=3.0 * frames.position)
    observables = {name: make() for name, make in observable_constructors(frames).items()}
    observables = {
        n: candidate for n, candidate in observables.items() if candidate.combines_columns
    }
    assert observables.keys() >= COLUMNWISE
    assert "cumulants" not in observables and "contacts" not in observables
    for observable in observables.values():
        results = observable.observe_series(frames)
        stretches = [slice(9), slice(9, 20), slice(20, None)]
        several = [{name: x[stretch] for name, x in results.items()} for stretch in stretches]
        for runs in ([results], several):
            once = averaged(observable.combine, runs, columns=True)
            one_by_one = averaged(observable.combine, runs)
            for joint_values, single_values in zip(once[:3], one_by_one[:3], strict=True):
                assert joint_values.keys() == single_values.keys()
                assert {n: bits(x) for n, x in joint_values.items()} == {
                    n: bits(x) for n, x in single_values.items()
                }
            for name, evidence in once.sample_size.items():
                assert [*map(bits, evidence)] == [*map(bits, one_by_one.sample_size[name])]


class PerFrame(Observable):
    """An observable as users write them."""

    def observe(self, frame):
        """Return the fastest velocity."""
        return {"fastest": np.abs(frame.velocity).max(axis=0), "time": np.array(frame.time)}


class Incomplete(Observable):
    """An observable without methods for frames."""


def test_an_observable_needs_a_method_for_frames():
    frames = recorded("spheres", FRAMES)
    results = PerFrame(frames.system).observe_series(frames)
    assert bits(results["fastest"]) == bits(np.abs(frames.velocity).max(axis=1))
    assert bits(results["time"]) == bits(frames.time)
    for method in (
        lambda observable: observable.observe(frames.frame(0)),
        lambda observable: observable.observe_series(frames),
    ):
        with pytest.raises(NotImplementedError):
            method(Incomplete(frames.system))
