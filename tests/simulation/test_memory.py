"""Memories of driven gases: theory against measured ones, and verdicts that depend on them."""

import math

import numpy as np
import pytest
from brute_force import KERNELS, begin
from raw import build, protocols, steady, theory_mixture

import roughgas
from roughgas.base import InputError
from roughgas.simulation.gas_memory import (
    ThermalState,
    _with_total_momentum,
    drag_rates,
    gas_memory,
    spin_share,
)
from roughgas.simulation.simulation import Simulation
from roughgas.statistics.errors import autocorrelation_time
from roughgas.statistics.sample_sizes import (
    MINIMUM_SAMPLE_SIZE,
    NO,
    UNKNOWN,
    YES,
    SampleSize,
    describe_shortfall,
    verdict,
)

SPIN = {"spin": {"inertia": 0.5}}
SHEAR, BATH = {"velocity": 2}, {"interval": 0.5, "drag": 0.05, "temperature": 1.0}
BED = {
    "gravity": {"acceleration": 1},
    "floor": {"amplitude": 5, "period": 1, "restitution": 1, "roughness": -1},
}
MONOLAYER = {"delta": {"speed": 0.1}}
THERMAL = {"left_wall": {"temperature": 1.0}, "right_wall": {"temperature": 1.0}}


def kicks(power=0.1, share=0.0):
    """Settings of a thermostat."""
    return {"thermostat": {"power": power, "interval": 0.5, "spin_share": share}}


# Scene, r, beta, particles, side; measured over 20 000 T or more: T_tr, R, contacts of a particle
# per T, and the autocorrelation time of R in T.
MEASURED = {
    "sheared": ({"shear": SHEAR}, 0.9, 0.0, 40, 25, 0.1044, 0.225, 0.21, 16.9),
    "sheared, smoother": ({"shear": SHEAR}, 0.9, -0.8, 40, 25, 0.177, 0.039, 0.27, 42.6),
    "sheared, dissipative": ({"shear": SHEAR}, 0.6, 0.3, 40, 25, 0.0284, 0.327, 0.12, 27.0),
    "ten sheared": ({"shear": SHEAR}, 0.9, 0.5, 10, 15, 0.489, 0.372, 0.27, 10.4),
    "ten heated": (kicks(1.0, 0.5), 0.9, -0.9, 10, 15, 4.79, 0.786, 0.84, 29.9),
    "heated": (kicks(), 0.9, 0.0, 40, 25, 0.791, 0.204, 0.57, 6.6),
    "heated, rough": (kicks(0.1, 0.2), 0.9, 0.8, 20, 18, 0.902, 0.484, 0.58, 5.0),
    "nearly elastic": (kicks(0.1, 0.3), 0.99, -0.5, 40, 25, 1.206, 0.273, 0.71, 14.1),
    "bath": ({"langevin": BATH}, 0.9, -0.5, 20, 20, 0.637, 0.093, 0.36, 16.2),
    "bed": (BED, 0.9, 0.0, 40, 12.5, 4.42, 0.233, 3.9, 1.9),
    "bed, smoother": (BED, 0.9, -0.8, 40, 12.5, 12.0, 0.040, 2.74, 5.2),
    "friction": (kicks() | {"friction": {"mu": 0.1}}, 0.9, 0.5, 40, 25, 0.970, 0.137, 0.63, 10.0),
    "more friction": (kicks() | {"friction": {"mu": 0.3}}, 0.9, 0.5, 40, 25, 0.818, 0.248, 0.59, 6),
    "monolayer": (MONOLAYER, 0.9, 0.0, 40, 25, 0.176, 0.201, 0.27, 14.9),
    "monolayer, smoother": (MONOLAYER, 0.9, -0.8, 40, 25, 0.472, 0.0356, 0.443, 34.3),
    "thermal walls": (THERMAL, 0.95, 0.0, 40, 25, 0.380, 0.341, 0.41, 9.9),
    "smooth between thermal walls": (THERMAL, 0.95, -1.0, 40, 25, 0.717, 0.577, 0.56, 60.3),
}


def scene_of(effects, r, beta, particles=40, side=25.0, **changes):
    """(scene, settings) of disks with these effects."""
    box = [side, "open"] if "gravity" in effects else [side, side]
    settings = {"particles": particles, "box": box, "effects": SPIN | effects, **changes}
    return build(settings, r, beta), settings


def state_of(T_tr, R, frequency, particles, side, effects=()):
    """The thermal state of a gas with these temperatures and frequency of contacts."""
    top = math.inf if "gravity" in effects else side
    T_rot = None if R == 0 else np.array([T_tr * R / (1.0 - R)])
    return ThermalState(np.array([T_tr]), T_rot, frequency, particles, (side, top))


@pytest.mark.parametrize("name", MEASURED)
def test_the_predicted_memory_of_R_is_right_within_a_factor(name):
    """Within 2.1 of the memory in long runs, with drag, friction or walls as well."""
    effects, r, beta, particles, side, T_tr, R, frequency, measured = MEASURED[name]
    scene, _ = scene_of(effects, r, beta, particles, side)
    state = state_of(T_tr, R, frequency, particles, side, effects)
    assert 1.0 / 2.1 < gas_memory(scene, state).of_R / measured < 2.1


@pytest.mark.parametrize(("name", "measured"), [("monolayer", 30.3), ("monolayer, smoother", 29.1)])
def test_the_energy_of_a_monolayer_relaxes_as_its_contacts_gain_and_lose(name, measured):
    """To 20 % of half the autocorrelation time of E_trans over 60 000 T. Without the gain, which
    grows with the temperature, the energy would relax nearly twice as fast."""
    effects, r, beta, particles, side, T_tr, R, frequency, _ = MEASURED[name]
    scene, _ = scene_of(effects, r, beta, particles, side)
    state = state_of(T_tr, R, frequency, particles, side)
    assert gas_memory(scene, state).energies == pytest.approx(measured, rel=0.2)


def test_a_mixture_remembers_as_long_as_its_slowest_exchange():
    species = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 2.0}]
    scene, settings = scene_of(kicks(), 0.9, 0.0, 40, 40.0, species=species)
    state = ThermalState(np.array([1.44, 1.40]), np.array([0.36, 0.35]), 0.32, 40, (40.0, 40.0))
    assert 0.5 < gas_memory(scene, state, theory_mixture(scene, settings), 0.2).of_R / 12.8 < 2.0


@pytest.mark.parametrize("packing", [0.0, 0.5])
def test_a_species_that_nothing_distinguishes_changes_no_memory(packing):
    """At any packing, for the measured frequency of contacts."""
    alike = [{"fraction": 0.3}, {"fraction": 0.7}]
    scene, settings = scene_of(kicks(0.1, 0.3), 0.9, -0.5, species=alike)
    single, _ = scene_of(kicks(0.1, 0.3), 0.9, -0.5)
    mixed = ThermalState(np.full(2, 0.8), np.full(2, 0.2), 0.5, 40, (25.0, 25.0))
    point = gas_memory(scene, mixed, theory_mixture(scene, settings), packing)
    expected = gas_memory(single, state_of(0.8, 0.2, 0.5, 40, 25.0))
    assert point.of_R == pytest.approx(expected.of_R, rel=1e-3)
    assert point.energies == pytest.approx(expected.energies, rel=1e-3)


@pytest.mark.parametrize("mu", [0.1, 0.3, 1.0])
def test_the_memory_with_friction_is_that_of_a_numerical_integration(mu):
    """The memory is twice the relaxation time of R at constant energy, to 3 %."""
    scene, _ = scene_of(kicks() | {"friction": {"mu": mu}}, 0.9, 0.5)
    R = float(roughgas.theory.friction_ratio(0.9, 0.5, mu, 2, 0.5, 0.0))
    state, nu = np.array([1.0 - R, R]), 0.5
    of_R = gas_memory(scene, state_of(state[0], R, nu, 40, 25.0)).of_R
    disturbed, steps = state + 1e-3 * np.array([-0.5, 1.0]), 2000
    for _ in range(steps):  # for the time of_R: two e-folds
        T_tr, T_rot = roughgas.theory.friction_changes(*disturbed, 0.9, 0.5, mu, 2, 0.5)
        loss = 2.0 * T_tr + T_rot  # the drive replaces it by translation
        disturbed = disturbed + nu * of_R / steps * np.array([T_tr - loss / 2.0, T_rot])
    assert disturbed[1] - R == pytest.approx(1e-3 * math.exp(-2.0), rel=0.03)


def test_a_heated_gas_settles_as_in_a_numerical_integration():
    """The relaxation time of the energies, by Runge-Kutta with Enskog's frequency, to 3 %."""
    scene, _ = scene_of(kicks(), 0.9, 0.0)
    r, beta, phi, power = 0.9, 0.0, 0.05, 0.1
    T_tr, T_rot = (x[-1] for x in theory_run(np.array([2000.0]), 1.0, 0.2))
    nu = float(roughgas.theory.collision_frequency(T_tr, phi, 2))
    state = ThermalState(np.array([T_tr]), np.array([T_rot]), nu, 40, (25.0, 25.0))
    settling = gas_memory(scene, state).energies
    times = settling * np.array([6.0, 8.0])
    disturbed, _ = theory_run(times, 1.02 * T_tr, 1.02 * T_rot)
    decayed = math.log((disturbed[0] - T_tr) / (disturbed[1] - T_tr))
    assert decayed == pytest.approx(2.0, rel=0.03)
    assert (r, beta, power) == (scene.restitution, scene.roughness, 0.1)


def theory_run(times, T_tr, T_rot):
    """Temperatures of the heated gas by numerical integration."""
    return roughgas.theory.driven_temperatures(times, T_tr, T_rot, 0.9, 0.0, 0.05, power=0.1)


def test_the_memory_is_infinite_only_without_relaxation():
    scene, _ = scene_of(kicks(), 0.9, -1.0)
    never = gas_memory(scene, state_of(1.0, 0.3, 0.5, 40, 25.0))
    assert never.of_R == never.energies == math.inf
    smooth = gas_memory(scene, state_of(1.0, 0, 0.5, 40, 25.0))
    assert smooth.of_R == 0.0 and smooth.energies < 100.0
    alone = gas_memory(scene, state_of(1.0, 0.3, 0.0, 40, 25.0))
    assert alone.of_R == alone.flow == math.inf


def test_the_momentum_of_a_bath_is_remembered_as_long_as_the_drag_lasts():
    """Weak drag on a few particles that are far colder than their bath."""
    weak = {"langevin": {"interval": 0.5, "drag": 1e-4, "temperature": 1e4}}
    scene, _ = scene_of(weak, 0.9, 0.0)
    point = gas_memory(scene, state_of(1.0, 0.2, 0.5, 40, 25.0))
    assert drag_rates(scene) == (pytest.approx(1e-4), 0.0)
    assert point.flow == pytest.approx(1e4) and point.of_R == pytest.approx(1e4, rel=0.01)
    near = {"langevin": BATH}
    elastic = gas_memory(scene_of(near, 1.0, 0.0)[0], state_of(1.0, 0.2, 0.5, 40, 25.0))
    assert elastic.of_R < 12.0


@pytest.mark.slow
def test_the_momentum_has_its_share_of_the_memory():
    """The memory of a sum of energies: of particles at T_tr = 1 and of the momentum, at 12.

    Against series of random numbers, to 8 % (2.5 standard errors): energies of 2 N = 80 components
    with a memory of 10 T, and of a momentum of two components with a memory of 100 T.
    """
    number, drag, steps = 40, 0.01, 400_000
    scene, _ = scene_of(
        {"langevin": {"interval": 0.5, "drag": drag, "temperature": 12.0}}, 0.9, -1.0
    )
    state = state_of(1.0, 0, 0.5, number, 25.0)
    rng, momentum = np.random.default_rng(3), np.zeros((2, steps))
    kick = rng.standard_normal((2, steps)) * math.sqrt(12.0 * -math.expm1(-2.0 * drag))
    gas, noise = np.zeros(steps), rng.standard_normal(steps) * math.sqrt(0.0975 * 4.0 * number)
    for k in range(1, steps):
        momentum[:, k] = math.exp(-drag) * momentum[:, k - 1] + kick[:, k]
        gas[k] = 0.95 * gas[k - 1] + noise[k]
    energy = gas + (momentum**2).sum(axis=0)
    memory_of_gas = (1.0 + 0.95) / (1.0 - 0.95)  # T, of the gas alone
    point = _with_total_momentum(memory_of_gas, scene, state)
    assert point == pytest.approx(autocorrelation_time(energy), rel=0.08)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_share_of_spins_is_that_of_the_settings(share):
    assert spin_share(scene_of(kicks(0.7, share), 0.9, 0.0)[0]) == pytest.approx(share)
    noise = {"langevin": {"interval": 0.5, "drag": 0.1, "power": 1.0 - share, "spin_power": share}}
    assert spin_share(scene_of(noise, 0.9, 0.0)[0]) == pytest.approx(share, abs=0.05)


# ------------------------------------------------------------------------ verdicts


def test_data_may_refute_a_steady_state_but_not_prove_it():
    enough, little = SampleSize(20, 20), SampleSize(20, 20, memories=11.9)
    short = enough._replace(times=5.9)
    assert enough.verdict(True) == YES and enough.verdict(False) == NO
    assert little.verdict(True) == little.verdict(False) == UNKNOWN
    assert [verdict(steady, enough) for steady in (YES, NO, UNKNOWN)] == [YES, NO, UNKNOWN]
    for lacking in (little, short):
        assert [verdict(steady, lacking) for steady in (YES, NO)] == [UNKNOWN, NO]


@pytest.mark.parametrize("numbers", MINIMUM_SAMPLE_SIZE._asdict())
def test_each_number_that_is_too_small_is_too_little_evidence(numbers):
    assert not MINIMUM_SAMPLE_SIZE._replace(
        **{numbers: 0.99 * getattr(MINIMUM_SAMPLE_SIZE, numbers)}
    ).suffices()
    assert not MINIMUM_SAMPLE_SIZE._replace(**{numbers: math.nan}).suffices()
    assert MINIMUM_SAMPLE_SIZE.suffices()


def test_lacking_evidence_is_stated_in_words():
    evidence = SampleSize(collisions=9.7, samples=12, memories=3.2, phases=4)
    assert describe_shortfall(evidence, MINIMUM_SAMPLE_SIZE) == (
        "9 collisions per particle, 10 needed; window of 3 memories, 12 needed; "
        "4 phases of the drive, 16 needed"
    )
    assert describe_shortfall(MINIMUM_SAMPLE_SIZE, MINIMUM_SAMPLE_SIZE) == ""


PASSIVE_EFFECTS = {"contact_averages": {}}
"""Effects that change no run; with them, gases have the kernels of other tests."""
LONG = {"kind": "steady", "equilibrate": 500.0, "measure": 1500.0, "sample_every": 1.0}


def measured(effects, r, beta, schedule_changes=None, particles=40, side=25.0, seed=1, **changes):
    """The variables of a point."""
    passive = KERNELS["heated"]["effects"] if "thermostat" in effects else PASSIVE_EFFECTS
    _, settings = scene_of(passive | effects, r, beta, particles, side, **changes)
    settings |= {"schedule": LONG | (schedule_changes or {})}
    protocols.check_experiment(settings)
    scene, _ = begin(settings, r, beta)
    return steady.run(scene, settings, seed, Simulation())


@pytest.mark.parametrize(("beta", "q"), [(-0.999999, 0.5), (-0.99999, 0.5), (1.0, 1e-6)])
def test_spins_that_hardly_relax_are_no_steady_state(beta, q):
    """Their energy drifts by less than the noise; by theory they relax within 1e5 T or more."""
    effects = {"spin": {"inertia": q}} | kicks(1.0)
    point = measured(effects, 0.9, beta, spin_temperature=1.0)
    assert point["memory_of_R"] > 1e5 and point["R"] > 0.1
    assert point["equilibrated"] == point["R_ci95_trusted"] == UNKNOWN
    assert point["E_trans_trusted"] == point["E_rot_trusted"] == UNKNOWN


def test_spins_that_no_contact_changes_leave_R_unknown():
    """R depends on the initial spins; the translational energy is steady."""
    point = measured(kicks(1.0), 0.9, -1.0, spin_temperature=1.0)
    assert point["equilibrated"] == point["E_trans_trusted"] == YES
    assert point["R_ci95_trusted"] == UNKNOWN and point["memory_of_R"] == math.inf


def test_a_smooth_gas_has_an_R_of_zero_that_is_trusted():
    point = measured(kicks(1.0), 0.9, -1.0)
    assert (point["R"], point["R_ci95_trusted"], point["memory_of_R"]) == (0.0, YES, 0.0)


@pytest.mark.parametrize(("memories", "expected"), [(6.0, UNKNOWN), (25.0, YES)])
def test_the_length_in_predicted_memories_decides(memories, expected):
    """At any scatter of the run: 20 seeds of a sheared gas have the same verdict if too short."""
    length = {"measure": round(19.0 * memories)}
    runs = [measured({"shear": SHEAR}, 0.9, 0.0, length, seed=seed) for seed in range(20)]
    flags = [run["R_ci95_trusted"] for run in runs]
    assert (flags.count(YES) >= 17) if expected == YES else set(flags) == {UNKNOWN}
    assert [run["memory_of_R"] for run in runs] == pytest.approx([19.0] * 20, rel=0.35)


def test_a_bed_needs_twice_as_many_memories():
    timing = {"measure": 18.0, "sample_every": 0.05, "period": 1.0, "equilibrate": 50.0}
    point = measured(BED, 0.9, 0.0, timing, side=12.5)
    assert 12.0 < 18.0 / point["memory_of_R"] < 24.0
    assert point["R_ci95_trusted"] == point["equilibrated"] == UNKNOWN


def test_means_of_energies_need_a_window_of_their_own_length():
    """R is trusted after 12 of its memories, energies after 96 of their relaxation times."""
    for measure, expected in ((1000.0, UNKNOWN), (4000.0, YES)):
        point = measured({"shear": SHEAR}, 0.9, 0.0, {"measure": measure})
        assert point["R_ci95_trusted"] == YES
        assert point["E_trans_trusted"] == point["E_rot_trusted"] == expected


def test_a_continued_run_counts_the_equilibration_of_its_first_part(tmp_path):
    """The 1000 T of the previous run count as equilibration of an exact continuation."""
    arguments = dict(particles=40, box=[25, 25], progress=False)
    arguments["effects"] = SPIN | {"shear": SHEAR} | PASSIVE_EFFECTS
    first = roughgas.simulate(
        r=0.9, beta=0.0, seed=1, keep_state=True, schedule=LONG | {"measure": 500.0}, **arguments
    )
    again = {"equilibrate": 0.0, "measure": 400.0}
    exact = roughgas.simulate(r=0.9, beta=0.0, initial=first, schedule=LONG | again, **arguments)
    fresh = roughgas.simulate(r=0.9, beta=0.0, seed=1, schedule=LONG | again, **arguments)
    assert exact.attrs["initial_exact"] == 1
    assert int(exact.equilibrated) == YES and int(fresh.equilibrated) == UNKNOWN


NOISE = {"langevin": {"power": 1, "interval": 0.5}}


@pytest.mark.parametrize(
    ("walls", "legal"),
    [
        ({}, False),
        ({"left_wall": {}, "right_wall": {}}, False),
        ({"left_wall": {"roughness": 0.5}, "right_wall": {}}, True),
        ({"left_wall": {"temperature": 1.0}, "right_wall": {}}, True),
        ({"left_wall": {}, "right_wall": {}, "bottom_wall": {}, "lid": {}}, True),
    ],
)
def test_noise_without_drag_needs_walls_that_damp_the_momentum(walls, legal):
    settings = {"particles": 10, "box": [25, 25], "effects": SPIN | NOISE | walls, "schedule": LONG}
    if legal:
        protocols.check_experiment(settings)
        return
    with pytest.raises(InputError, match=r"langevin\.power = 1.0: must be 0 without a drag"):
        protocols.check_experiment(settings)
