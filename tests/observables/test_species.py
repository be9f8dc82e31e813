"""Observables of mixtures: each species, and each pair of species, as if it were alone."""

import io
import itertools
import math
import pickle

import numpy as np
import pytest
from brute_force import settings
from tests.observables.frames import frame_of, system_of

from roughgas import simulate, theory
from roughgas.base import NeedsError
from roughgas.cli.show import observed
from roughgas.effects.contacts import HEAT, STRESSES, columns_of_pairs
from roughgas.observables import KINDS, wanted
from roughgas.observables.plugin import SUFFIX, Group
from roughgas.simulation.observing import Seen
from roughgas.statistics.errors import Estimate

TWO = Group(30, 1.0), Group(50, 1.5)
OF_EACH = ("position", "velocity", "spin", "radius", "mass", "inertia", "species_of")
SINGLE = [
    n for n, one in KINDS.items() if not (one.pairs or one.effects or n in ("layer", "pattern"))
]


def mixed_frames(box=(20, 20), number=6, **changes):
    """Frames of two species that fly about, and what a run knows of them."""
    rng = np.random.default_rng(3)
    system = system_of(box, particles=80, species=TWO, **changes)
    species = rng.permutation(np.repeat([0, 1], [30, 50]))
    own = {"radius": np.array([1.0, 1.5])[species], "mass": np.array([1.0, 4.0])[species]}
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
                **own,
            )
        )
    return frames


def by_hand(frame, species):
    """The particles of a species, as a gas of alike particles."""
    there = frame.species_of == species
    system = frame.system._replace(particles=int(there.sum()), species=())
    own = {name: getattr(frame, name)[there] for name in OF_EACH}
    return frame._replace(system=system, **own)


def averages(observable, frames):
    looks = [observable.look(frame) for frame in frames]
    return observable.combine({k: np.nanmean([one[k] for one in looks], axis=0) for k in looks[0]})


def usual(name):
    return {key: one.default for key, one in KINDS[name].settings.items()}


@pytest.mark.filterwarnings(
    "ignore:Mean of empty slice", "ignore:invalid value"
)  # as where no frame is
@pytest.mark.parametrize("shear_rate", [0.0, 0.1])
@pytest.mark.parametrize("name", SINGLE)
def test_a_species_is_seen_as_if_it_were_alone(name, shear_rate):
    """And all particles as before, where an observable is for particles that differ."""
    frames = mixed_frames(shear_rate=shear_rate)
    observable = wanted({name: {}})[0].make(frames[0].system)
    found = averages(observable, frames)
    for species in range(2):
        alone = [by_hand(frame, species) for frame in frames]
        expected = averages(KINDS[name](alone[0].system, **usual(name)), alone)
        for key, value in expected.items():
            assert np.array_equal(found[key + SUFFIX][species], value, equal_nan=True), key
    of_all = {key for key in found if not key.endswith(SUFFIX)}
    assert bool(of_all) == (not KINDS[name].alike)
    if of_all:
        together = averages(KINDS[name](frames[0].system, **usual(name)), frames)
        for key in of_all:
            assert np.array_equal(found[key], together[key], equal_nan=True), key
    described = set(observable.variables) - set(observable.coordinates)
    assert described >= set(found)


def test_g_of_two_species_is_that_of_a_loop():
    """Over all pairs of one with the other, and all images."""
    (frame,) = mixed_frames(number=1)
    observable = wanted({"pair_correlation": {"bins": 2, "reach": 8.0}})[0].make(frame.system)
    found = averages(observable, [frame])["pair_correlation_species"]
    edges = np.arange(found.shape[-1] + 1.0)
    counts = np.zeros((2, 2, len(edges) - 1))
    for i, j in itertools.permutations(range(80), 2):
        for images in itertools.product((-20.0, 0.0, 20.0), repeat=2):
            distance = math.dist(frame.position[i] + images, frame.position[j])
            if distance < edges[-1]:
                counts[frame.species_of[i], frame.species_of[j], int(distance)] += 1
    numbers = np.array([30, 50])
    pairs = np.multiply.outer(numbers, numbers) - np.diag(numbers)
    ideal = pairs[..., None] * np.pi * np.diff(edges**2) / 400.0
    assert found == pytest.approx(counts / ideal, rel=1e-12)
    assert found.shape[:2] == (2, 2) and counts.min() > 0


def test_what_is_seen_of_species_can_be_kept_in_a_journal():
    """As a run that is stopped keeps it."""
    frames = mixed_frames(number=3)
    for name in ("mean_square_displacement", "pair_correlation"):
        one = wanted({name: {}})[0].make(frames[0].system)
        one.look(frames[0])
        other = wanted({name: {}})[0].make(frames[0].system)
        vars(other).update(Seen(io.BytesIO(pickle.dumps(vars(one)))).load())
        found = other.look(frames[1])
        for key, value in one.look(frames[1]).items():
            assert np.array_equal(found[key], value, equal_nan=True)


def with_rates(frames):
    """Frames with made-up sums over contacts of each pair, and those of the same particles without
    a species."""
    rng, every, alike = np.random.default_rng(5), [], []
    names = [*STRESSES, *HEAT]
    for frame in frames:
        sums = rng.standard_normal((4, 12))
        rates = dict(zip(columns_of_pairs(STRESSES, 2), sums[:, :9].ravel(), strict=True))
        rates |= zip(columns_of_pairs(HEAT, 2), sums[:, 9:].ravel(), strict=True)
        every.append(frame._replace(rates=rates))
        system = frame.system._replace(species=())
        total = dict(zip(names, sums.sum(axis=0), strict=True))
        alike.append(frame._replace(system=system, species_of=None, rates=total))
    return every, alike


@pytest.mark.filterwarnings("ignore:Mean of empty slice")  # as where no frame is
@pytest.mark.parametrize("name", ["stress", "heat_flux", "flux_autocorrelation"])
def test_what_all_contacts_carry_is_the_sum_of_all_pairs(name):
    """And of all particles as of alike ones; but no conductivity of a mixture."""
    every, alike = with_rates(mixed_frames((20, 15, 10)))
    found, whole = (
        averages(wanted({name: {}})[0].make(frames[0].system), frames) for frames in (every, alike)
    )
    of_all = {key for key in found if not key.endswith(SUFFIX)}
    assert of_all == {key for key in whole if "heat_flux_" not in key and "conduct" not in key}
    for key in of_all:
        assert found[key] == pytest.approx(whole[key], rel=1e-12, nan_ok=True), key
    if name == "stress":
        own, pairs = found["stress_kinetic_species"], found["stress_collisional_species"]
        assert own.sum(axis=0) == pytest.approx(whole["stress_kinetic"], rel=1e-12)
        assert pairs.sum(axis=(0, 1)) == pytest.approx(whole["stress_collisional"], rel=1e-12)
        assert np.array_equal(pairs[0, 1], pairs[1, 0])
        assert found["pressure_species"].sum() == pytest.approx(whole["pressure"], rel=1e-12)
    elif name == "heat_flux":
        pairs = found["heat_flux_collisional_species"]
        assert found["heat_flux_species"].sum(axis=0) == pytest.approx(
            whole["heat_flux"], rel=1e-12
        )
        flown = [by_hand(frame, 1) for frame in every]
        flown = np.mean([one.energy @ one.velocity for one in flown], axis=0) / 3000
        assert found["heat_flux_species"][1] - pairs[1].sum(axis=0) == pytest.approx(flown)


def test_a_function_may_look_at_one_species():
    frame = mixed_frames(number=1)[0]
    assert frame.only(1).mass.tolist() == [4.0] * 50
    assert frame.only(1).system.species == TWO[1:] and frame.only(0, 1).system == frame.system
    with pytest.raises(NeedsError, match=r"^Frame\.only needs species"):
        frame_of(system_of((20, 20))).only(0)


MIXTURE = [
    {"name": "small", "fraction": 0.5},
    {"name": "large", "fraction": 0.5, "radius": 1.6, "mass": 3.0},
]
GAS = {"particles": 120, "box": (1, 1), "packing": 0.3, "effects": {"spin": {"inertia": 0.5}}}


def test_g_at_contact_of_each_pair_is_that_of_theory():
    """Elastic disks in equilibrium; J. T. Jenkins & F. Mancini (1987), within four errors of eight

    replicas (one number of three in 60 such tests beyond by chance), and 2 %, which it may be off.
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
    """A steady mixture that is watched at contacts for 400 T, in the kernel of other tests."""
    schedule = {"kind": "steady", "equilibrate": 0, "measure": 400, "sample_every": 1}
    effects = settings("heated", thermostat=drive)["effects"]
    own = {"schedule": schedule, "effects": effects, "species": MIXTURE}
    return simulate(r=r, beta=beta, observe=observe, progress=False, **own, **gas)


@pytest.mark.slow  # compiles a kernel
def test_how_often_species_meet_is_as_theory_says():
    """Elastic disks in equilibrium: Enskog's frequencies within four errors, and 2 %, as of g at

    contact; each contact of a pair is one of either species, and takes nothing. The pressure of
    each species and of each pair as well, and no heat flows.
    """
    no_drive = {"power": 1e-12, "interval": 1e6}
    observe = ["contacts", "stress", "heat_flux"]
    gas = contacts_of(1, -1, no_drive, observe, particles=120, box=(1, 1), packing=0.3)
    mixture = theory.mixture(MIXTURE, 1.0, -1.0, 2)
    T = 2.0 * float(gas.E_trans)
    expected = theory.mixture_frequency(mixture, T, gas.packing)
    found, error = gas.contact_frequency_species, gas.contact_frequency_species_stderr.values
    assert np.all(abs(found - expected) < 4.0 * error + 0.02 * expected)
    assert np.all(error < 0.03 * expected)
    numbers = gas.species_particles.values[:, None]
    assert found.values * numbers == pytest.approx((found.values * numbers).T, rel=1e-9)
    mean = (found.sum("other").values * numbers[:, 0]).sum() / numbers.sum()
    assert float(gas.contact_frequency) == pytest.approx(mean, rel=1e-9)
    assert abs(gas.contact_loss_species).max() < 1e-12
    radius = np.array([1.0, 1.6])
    density = numbers / (np.pi * (numbers[:, 0] @ radius**2) / gas.packing)
    chi = theory.mixture_contact_values(mixture, gas.packing)
    virial = np.pi / 2 * T * density * density.T * np.add.outer(radius, radius) ** 2 * chi
    stress = gas.stress_collisional_species
    errors = gas.stress_collisional_species_stderr
    pairs, errors = ((one * np.eye(2)).sum(("component", "along")) / 2 for one in (stress, errors))
    assert np.all(abs(pairs - virial) < 4.0 * errors + 0.02 * virial)
    error, pressure = gas.pressure_species_stderr, density[:, 0] * T + virial.sum(axis=1)
    assert np.all(abs(gas.pressure_species - pressure) < 4.0 * error + 0.02 * pressure)
    assert np.all(errors < 0.05 * virial) and np.all(error < 0.05 * pressure)
    assert np.all(abs(gas.heat_flux_species) < 4.5 * gas.heat_flux_species_stderr)


@pytest.mark.slow  # compiles a kernel
def test_contacts_take_what_the_books_say():
    """Losses per contact times the contacts of a run are what contacts have put in."""
    gas = contacts_of(0.8, 0.3, {}, "contacts", particles=40, box=(30, 30))
    per_time = gas.contact_frequency / 2.0 * gas.contact_loss
    booked = float(gas.energy_input.sel(source="contacts").sum()) / 400.0
    assert float(per_time) == pytest.approx(-booked, rel=1e-2)  # but for the first T, in which
    assert gas.contact_loss_species.min() > 0.0  # nobody looks


def test_a_dataset_says_what_each_species_does():
    schedule = {"kind": "cooling", "replicas": 2, "thermalise": 2, "relaxation_times": 1}
    schedule |= {"plateau": 8, "sample_every": 0.5}
    observe = ["cumulants", "profiles", "mean_square_displacement"]
    common = {"species": MIXTURE, "schedule": schedule, "observe": observe, "progress": False}
    gas = simulate(r=0.9, beta=[0, 0.5], seed=[1, 2], **common, **GAS)
    assert gas.a20_species.dims == ("r", "beta", "species")
    assert gas.packing_profile_species.dims[2:] == ("species", "height")
    total = gas.packing_profile_species.sum("species")
    assert total.values == pytest.approx(gas.packing_profile.values, rel=1e-9)
    one = simulate(r=0.9, beta=0, seed=1, **common, **GAS)
    lines = observed(one).splitlines()
    found = Estimate(float(one.a20_species[1]), float(one.a20_species_stderr[1]))
    assert any(line.startswith("a20_species [large] ") and f" {found}? " in line for line in lines)
    assert any("over species (2), height (50)" in line for line in lines)
    numbers = one.species_particles
    every = (one.mean_square_displacement_species * numbers).sum(
        "species", skipna=False
    ) / numbers.sum()
    assert every.values == pytest.approx(one.mean_square_displacement.values, rel=1e-9, nan_ok=True)
