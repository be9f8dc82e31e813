"""Observables of mixtures: each species, and each pair of species, as if it were alone."""

import io
import itertools
import math
import pickle

import numpy as np
import pytest
from brute_force import settings
from msgspec.structs import asdict
from raw import observed_settings
from tests.observables.frames import frame_of, system_of

from roughgas import simulate, theory
from roughgas.base import NeedsError
from roughgas.cli.show import observed_table
from roughgas.effects.contacts import HEAT, STRESSES, columns_of_pairs
from roughgas.observables import OBSERVABLES
from roughgas.observables.frames import FrameSeries, SpeciesGroup
from roughgas.observables.plugin import SUFFIX
from roughgas.simulation.observable_tracker import ObservableUnpickler
from roughgas.statistics.estimates import Estimate

SPECIES = SpeciesGroup(30, 1.0), SpeciesGroup(50, 1.5)
PARTICLE_ARRAYS = ("position", "velocity", "spin", "radius", "mass", "inertia", "species_of")
SINGLE_PARTICLE = [
    n
    for n, kind in OBSERVABLES.items()
    if not (kind.pairwise or kind.effects or n in ("layer", "pattern"))
]


def mixed_frames(box=(20, 20), number=6, **changes):
    """Return frames of two species at random positions, with radii, masses and species."""
    rng = np.random.default_rng(3)
    system = system_of(box, particles=80, species=SPECIES, **changes)
    species = rng.permutation(np.repeat([0, 1], [30, 50]))
    properties = {"radius": np.array([1.0, 1.5])[species], "mass": np.array([1.0, 4.0])[species]}
    frames = []
    for k in range(number):
        shape = 80, len(box)
        frames.append(
            frame_of(
                system,
                rng.uniform(0, 1, shape) * box,
                rng.standard_normal(shape),
                rng.standard_normal((80, 2 * len(box) - 3)),
                time=float(k),
                species_of=species,
                **properties,
            )
        )
    return frames


def only_species(frame, species):
    """Return a frame of the particles of one species, as a gas of a single species."""
    members = frame.species_of == species
    system = frame.system._replace(particles=int(members.sum()), species=())
    arrays = {name: getattr(frame, name)[members] for name in PARTICLE_ARRAYS}
    return frame._replace(system=system, **arrays)


def averages(observable, frames):
    samples = [observable.observe(frame) for frame in frames]
    return observable.combine(
        {k: np.nanmean([sample[k] for sample in samples], axis=0) for k in samples[0]}
    )


def default_settings(name):
    settings = asdict(OBSERVABLES[name].settings())
    settings.pop("every")
    return settings


@pytest.mark.filterwarnings(
    "ignore:Mean of empty slice", "ignore:invalid value"
)  # as of elements without a frame
@pytest.mark.parametrize("shear_rate", [0.0, 0.1])
@pytest.mark.parametrize("name", SINGLE_PARTICLE)
def test_a_species_is_observed_as_if_it_were_alone(name, shear_rate):
    """All particles together as well, if an observable admits different particles."""
    frames = mixed_frames(shear_rate=shear_rate)
    observable = observed_settings({name: {}})[0].make(frames[0].system)
    results = averages(observable, frames)
    for species in range(2):
        alone = [only_species(frame, species) for frame in frames]
        expected = averages(OBSERVABLES[name](alone[0].system, **default_settings(name)), alone)
        for key, value in expected.items():
            assert np.array_equal(results[key + SUFFIX][species], value, equal_nan=True), key
    totals = {key for key in results if not key.endswith(SUFFIX)}
    assert bool(totals) == (not OBSERVABLES[name].single_species)
    if totals:
        together = averages(OBSERVABLES[name](frames[0].system, **default_settings(name)), frames)
        for key in totals:
            assert np.array_equal(results[key], together[key], equal_nan=True), key
    described = set(observable.variables) - set(observable.coordinates)
    assert described >= set(results)


def test_g_of_two_species_is_that_of_a_loop():
    """Over all pairs of particles of two species, and all images."""
    (frame,) = mixed_frames(number=1)
    observable = observed_settings({"pair_correlation": {"bins": 2, "reach": 8.0}})[0].make(
        frame.system
    )
    correlation = averages(observable, [frame])["pair_correlation_species"]
    edges = np.arange(correlation.shape[-1] + 1.0)
    counts = np.zeros((2, 2, len(edges) - 1))
    for i, j in itertools.permutations(range(80), 2):
        for images in itertools.product((-20.0, 0.0, 20.0), repeat=2):
            distance = math.dist(frame.position[i] + images, frame.position[j])
            if distance < edges[-1]:
                counts[frame.species_of[i], frame.species_of[j], int(distance)] += 1
    numbers = np.array([30, 50])
    pairs = np.multiply.outer(numbers, numbers) - np.diag(numbers)
    ideal = pairs[..., None] * np.pi * np.diff(edges**2) / 400.0
    assert correlation == pytest.approx(counts / ideal, rel=1e-12)
    assert correlation.shape[:2] == (2, 2) and counts.min() > 0


def test_observables_of_species_are_restored_from_a_checkpoint():
    """Pickled as in the checkpoint of a stopped run."""
    frames = mixed_frames(number=3)
    for name in ("mean_square_displacement", "pair_correlation"):
        original = observed_settings({name: {}})[0].make(frames[0].system)
        original.observe(frames[0])
        restored = observed_settings({name: {}})[0].make(frames[0].system)
        vars(restored).update(ObservableUnpickler(io.BytesIO(pickle.dumps(vars(original)))).load())
        results = restored.observe(frames[1])
        for key, value in original.observe(frames[1]).items():
            assert np.array_equal(results[key], value, equal_nan=True)


def with_rates(frames):
    """Return frames with random sums over contacts of each pair of species, and the same frames
    without species."""
    rng, by_species, single_species = np.random.default_rng(5), [], []
    names = [*STRESSES, *HEAT]
    for frame in frames:
        sums = rng.standard_normal((4, 12))
        rates = dict(zip(columns_of_pairs(STRESSES, 2), sums[:, :9].ravel(), strict=True))
        rates |= zip(columns_of_pairs(HEAT, 2), sums[:, 9:].ravel(), strict=True)
        by_species.append(frame._replace(rates=rates))
        system = frame.system._replace(species=())
        total = dict(zip(names, sums.sum(axis=0), strict=True))
        single_species.append(frame._replace(system=system, species_of=None, rates=total))
    return by_species, single_species


@pytest.mark.filterwarnings("ignore:Mean of empty slice")  # as of elements without a frame
@pytest.mark.parametrize("name", ["stress", "heat_flux", "flux_autocorrelation"])
def test_fluxes_of_all_contacts_are_the_sums_over_all_pairs(name):
    """The totals are those of a single species; a mixture has no conductivity."""
    by_species, single_species = with_rates(mixed_frames((20, 15, 10)))
    results, total = (
        averages(observed_settings({name: {}})[0].make(frames[0].system), frames)
        for frames in (by_species, single_species)
    )
    common_keys = {key for key in results if not key.endswith(SUFFIX)}
    assert common_keys == {key for key in total if "heat_flux_" not in key and "conduct" not in key}
    for key in common_keys:
        assert results[key] == pytest.approx(total[key], rel=1e-12, nan_ok=True), key
    if name == "stress":
        kinetic, pairs = results["stress_kinetic_species"], results["stress_collisional_species"]
        assert kinetic.sum(axis=0) == pytest.approx(total["stress_kinetic"], rel=1e-12)
        assert pairs.sum(axis=(0, 1)) == pytest.approx(total["stress_collisional"], rel=1e-12)
        assert np.array_equal(pairs[0, 1], pairs[1, 0])
        assert results["pressure_species"].sum() == pytest.approx(total["pressure"], rel=1e-12)
    elif name == "heat_flux":
        pairs = results["heat_flux_collisional_species"]
        assert results["heat_flux_species"].sum(axis=0) == pytest.approx(
            total["heat_flux"], rel=1e-12
        )
        flown = [only_species(frame, 1) for frame in by_species]
        flown = np.mean([motion.energy @ motion.velocity for motion in flown], axis=0) / 3000
        assert results["heat_flux_species"][1] - pairs[1].sum(axis=0) == pytest.approx(flown)


def test_a_function_may_observe_one_species():
    frame = mixed_frames(number=1)[0]
    assert frame.only(1).mass.tolist() == [4.0] * 50
    assert frame.only(1).system.species == SPECIES[1:] and frame.only(0, 1).system == frame.system
    with pytest.raises(NeedsError, match=r"^Frame\.only needs species"):
        frame_of(system_of((20, 20))).only(0)


MIXTURE = [
    {"name": "small", "fraction": 0.5},
    {"name": "large", "fraction": 0.5, "radius": 1.6, "mass": 3.0},
]
GAS = {"particles": 120, "box": (1, 1), "packing": 0.3, "effects": {"spin": {"inertia": 0.5}}}


def test_g_at_contact_of_each_pair_is_that_of_theory():
    """Elastic disks in equilibrium, against J. T. Jenkins & F. Mancini (1987).

    Within four errors of eight replicas (by chance one of three numbers is beyond in 60 such tests)
    and 2 %, the accuracy of the formula.
    """
    schedule = {"kind": "cooling", "replicas": 8, "thermalise": 30, "relaxation_times": 0}
    schedule |= {"plateau": 150, "sample_every": 0.25}
    observe = {"pair_correlation": {"bins": 40, "reach": 6}}
    gas = simulate(
        r=1, beta=-1, species=MIXTURE, schedule=schedule, observe=observe, progress=False, **GAS
    )
    expected = theory.mixture_contact_values(theory.mixture(MIXTURE, 1.0, -1.0, 2), gas.packing)
    error = gas.contact_value_species_stderr.values
    assert np.all(abs(gas.contact_value_species - expected) < 4.0 * error + 0.02 * expected)
    assert np.all(error < 0.08 * expected) and np.ptp(expected) > 0.1
    g = gas.pair_correlation_species
    assert not g.isel(species=0, other=1).where(g.distance < 2.55, drop=True).any()


def contacts_of(r, beta, drive, observe, **gas):
    """Return a steady mixture, observed at contacts for 400 T, by the kernel of other tests."""
    schedule = {"kind": "steady", "equilibrate": 0, "measure": 400, "sample_every": 1}
    effects = settings("heated", thermostat=drive)["effects"]
    scene = {"schedule": schedule, "effects": effects, "species": MIXTURE}
    return simulate(r=r, beta=beta, observe=observe, progress=False, **scene, **gas)


@pytest.mark.slow  # compiles a kernel
def test_contact_frequencies_of_species_are_those_of_enskog():
    """Elastic disks in equilibrium: Enskog's frequencies within four errors and 2 %, as for g.

    Each contact of a pair counts for both species, and dissipates nothing. The pressures of each
    species and each pair are Enskog's, too, and no heat flows.
    """
    no_drive = {"power": 1e-12, "interval": 1e6}
    observe = ["contacts", "stress", "heat_flux"]
    gas = contacts_of(1, -1, no_drive, observe, particles=120, box=(1, 1), packing=0.3)
    mixture = theory.mixture(MIXTURE, 1.0, -1.0, 2)
    T = 2.0 * float(gas.E_trans)
    expected = theory.mixture_frequency(mixture, T, gas.packing)
    frequency, error = gas.contact_frequency_species, gas.contact_frequency_species_stderr.values
    assert np.all(abs(frequency - expected) < 4.0 * error + 0.02 * expected)
    assert np.all(error < 0.03 * expected)
    numbers = gas.species_particles.values[:, None]
    assert frequency.values * numbers == pytest.approx((frequency.values * numbers).T, rel=1e-9)
    mean = (frequency.sum("other").values * numbers[:, 0]).sum() / numbers.sum()
    assert float(gas.contact_frequency) == pytest.approx(mean, rel=1e-9)
    assert abs(gas.contact_loss_species).max() < 1e-12
    radius = np.array([1.0, 1.6])
    density = numbers / (np.pi * (numbers[:, 0] @ radius**2) / gas.packing)
    chi = theory.mixture_contact_values(mixture, gas.packing)
    virial = np.pi / 2 * T * density * density.T * np.add.outer(radius, radius) ** 2 * chi
    stress = gas.stress_collisional_species
    errors = gas.stress_collisional_species_stderr
    pairs, errors = (
        (tensor * np.eye(2)).sum(("component", "along")) / 2 for tensor in (stress, errors)
    )
    assert np.all(abs(pairs - virial) < 4.0 * errors + 0.02 * virial)
    error, pressure = gas.pressure_species_stderr, density[:, 0] * T + virial.sum(axis=1)
    assert np.all(abs(gas.pressure_species - pressure) < 4.0 * error + 0.02 * pressure)
    assert np.all(errors < 0.05 * virial) and np.all(error < 0.05 * pressure)
    assert np.all(abs(gas.heat_flux_species) < 4.5 * gas.heat_flux_species_stderr)


@pytest.mark.slow  # compiles a kernel
def test_losses_of_contacts_are_those_of_the_ledger():
    """Losses per contact times the contacts of a run are the energy input of contacts."""
    gas = contacts_of(0.8, 0.3, {}, "contacts", particles=40, box=(30, 30))
    per_time = gas.contact_frequency / 2.0 * gas.contact_loss
    booked = float(gas.energy_input.sel(source="contacts").sum()) / 400.0
    assert float(per_time) == pytest.approx(-booked, rel=1e-2)  # the first T is not observed
    assert gas.contact_loss_species.min() > 0.0


@pytest.mark.slow
def test_a_dataset_has_the_observables_of_each_species():
    schedule = {"kind": "cooling", "replicas": 2, "thermalise": 2, "relaxation_times": 1}
    schedule |= {"plateau": 8, "sample_every": 0.5}
    observe = ["cumulants", "profiles", "mean_square_displacement"]
    common = {"species": MIXTURE, "schedule": schedule, "observe": observe, "progress": False}
    gas = simulate(r=0.9, beta=[0, 0.5], seed=[1, 2], **common, **GAS)
    assert gas.a20_species.dims == ("r", "beta", "species")
    assert gas.packing_profile_species.dims[2:] == ("species", "height")
    total = gas.packing_profile_species.sum("species")
    assert total.values == pytest.approx(gas.packing_profile.values, rel=1e-9)
    point = simulate(r=0.9, beta=0, seed=1, **common, **GAS)
    lines = observed_table(point).splitlines()
    estimate = Estimate(float(point.a20_species[1]), float(point.a20_species_stderr[1]))
    assert any(
        line.startswith("a20_species [large] ") and f" {estimate}? " in line for line in lines
    )
    assert any("over species (2), height (50)" in line for line in lines)
    numbers = point.species_particles
    weighted = (point.mean_square_displacement_species * numbers).sum(
        "species", skipna=False
    ) / numbers.sum()
    assert weighted.values == pytest.approx(
        point.mean_square_displacement.values, rel=1e-9, nan_ok=True
    )


def test_spins_are_relative_to_the_mean_of_each_species_where_a_medium_rotates():
    """The mean is of angular velocities, weighted with the moments of inertia."""
    groups = SpeciesGroup(10, 1.0), SpeciesGroup(20, 2.0)
    species_of = np.repeat([0, 1], [10, 20])
    system = system_of((20, 20), species=groups, rotates=True)
    radius = 1.0 + species_of
    spin = radius[:, None] * np.where(species_of, 3.0, -2.0)[:, None]
    frame = frame_of(system, spin=spin, radius=radius, mass=radius**2, species_of=species_of)
    for frames in (frame, FrameSeries.of([frame, frame])):
        assert frames.thermal_spin == pytest.approx(0.0, abs=1e-14)
        assert np.array_equal(frames.only(1).thermal_spin, frames.thermal_spin[..., 10:, :])
    still = frame._replace(system=system._replace(rotates=False))
    assert np.array_equal(still.thermal_spin, spin)
    uniform = frame_of(system_of((20, 20), rotates=True))
    assert uniform.thermal_spin.mean() == pytest.approx(0.0, abs=1e-15)
