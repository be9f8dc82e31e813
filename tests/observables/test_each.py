"""Each observable, and averages over frames."""

import itertools
import math

import numpy as np
import pytest
from tests.observables.frames import frame_of, system_of

from roughgas.effects.contacts import HEAT, STRESSES
from roughgas.observables import KINDS
from roughgas.observables.distributions import squares
from roughgas.observables.plugin import averaged
from roughgas.statistics.errors import blocking

NUMBER = 40_000


def results(name, frames, **settings):
    """What an observable makes of frames."""
    kind = KINDS[name]
    usual = {key: one.default for key, one in kind.settings.items()}
    observable = kind(frames[0].system, **(usual | settings))
    looks = [observable.look(frame) for frame in frames]
    means = {key: np.nanmean([look[key] for look in looks], axis=0) for key in looks[0]}
    return observable, observable.combine(means)


def distances(frame, reach):
    """Distances below `reach`, of each pair over all images, in plain Python."""
    box, found = frame.system.box, []
    for one, other in itertools.combinations(frame.position, 2):
        for numbers in itertools.product((-1, 0, 1), repeat=len(box)):
            shift = [n * length for n, length in zip(numbers, box, strict=True)]
            shift[0] += numbers[1] * frame.image_shift
            for more in (-box[0], 0.0, box[0]) if frame.image_shift else (0.0,):
                shifted = [x - y - s for x, y, s in zip(one, other, shift, strict=True)]
                shifted[0] -= more
                found.append(math.hypot(*shifted))
    return sorted({round(one, 9) for one in found if one < reach})


@pytest.mark.parametrize(
    ("box", "shift", "reach"), [((20, 15), 0.0, 7.0), ((20, 15), 13.0, 7.5), ((9, 8, 10), 0.0, 4.0)]
)
def test_pairs_are_those_of_a_loop_over_all_images(box, shift, reach):
    system = system_of(box, shear_rate=0.1 if shift else 0.0, particles=90)
    frame = frame_of(system, image_shift=shift)
    found = np.concatenate([np.sqrt(part) for part in squares(frame, reach)])
    assert np.sort(found) == pytest.approx(distances(frame, reach), abs=1e-8)
    assert len(found) > 100


@pytest.mark.parametrize("box", [(30, 30), (14, 14, 14)])
def test_g_is_1_where_particles_do_not_know_of_each_other(box):
    rng = np.random.default_rng(1)
    system = system_of(box, particles=400)
    frames = [frame_of(system, rng.uniform(0, 1, (400, len(box))) * box) for _ in range(20)]
    observable, found = results("pair_correlation", frames, bins=2)
    counted = found["pair_correlation"] * observable._ideal * len(frames)
    expected = observable._ideal * len(frames)
    assert np.all(abs(counted - expected) < 5 * np.sqrt(expected))


@pytest.mark.parametrize("box", [(30, 30), (14, 14, 14)])
def test_gaussian_velocities_and_spins_have_no_cumulants(box):
    frame = frame_of(system_of(box, particles=NUMBER))
    _, cumulants = results("cumulants", [frame])
    _, correlation = results("spin_correlation", [frame])
    every = {**cumulants, **correlation, "cos2_angle": correlation.get("cos2_angle", 1 / 3) - 1 / 3}
    for name, value in every.items():
        assert abs(value) < 0.03, name


def test_cumulants_of_a_distribution_that_is_known():
    """Velocities on a circle, and spins +-1: <V^4> = <V^2>^2, <w^4> = <w^2>^2."""
    angle = np.linspace(0, 2 * np.pi, NUMBER, endpoint=False)
    velocity = 3.0 * np.array([np.cos(angle), np.sin(angle)]).T
    spin = np.where(np.arange(NUMBER) % 2, 1.0, -1.0)[:, None]
    frame = frame_of(system_of((30, 30), particles=NUMBER), velocity=velocity, spin=spin)
    _, found = results("cumulants", [frame])
    assert found["a20"] == pytest.approx(-0.5) and found["a02"] == pytest.approx(-2 / 3)


def test_profiles_of_a_gas_that_is_hotter_and_denser_below():
    """Two layers: the lower one has two thirds of the particles, moves, and is hotter."""
    rng = np.random.default_rng(2)
    system = system_of((10, 20), particles=NUMBER, periodic=(True, False))
    low = np.arange(NUMBER) % 3 < 2
    height = np.where(low, rng.uniform(0, 5, NUMBER), rng.uniform(5, 10, NUMBER))
    position = np.array([rng.uniform(0, 10, NUMBER), height]).T
    velocity = rng.standard_normal((NUMBER, 2)) * np.where(low, 2.0, 1.0)[:, None]
    velocity[:, 0] += np.where(low, 3.0, 0.0)
    spin = rng.standard_normal((NUMBER, 1)) + 10.0
    frame = frame_of(system, position, velocity, spin)
    observable, found = results("profiles", [frame], bins=2, height=10.0)
    assert observable.coordinates["height"].tolist() == [2.5, 7.5]
    packing = math.pi * NUMBER * np.array([2, 1]) / 3 / 50
    assert found["packing_profile"] == pytest.approx(packing, rel=1e-3)
    assert found["flow_profile"] == pytest.approx(np.array([[3, 0], [0, 0]]), abs=0.06)
    assert found["temperature_profile"] == pytest.approx(np.array([[4, 4], [1, 1]]), rel=0.05)
    assert found["T_rot_profile"] == pytest.approx([0.5, 0.5], rel=0.05)
    assert found["R_profile"] == pytest.approx([0.5 / 4.5, 0.5 / 1.5], rel=0.05)
    assert found["share_above"] == 0.0
    _, lower = results("profiles", [frame], bins=2, height=5.0)
    assert lower["share_above"] == pytest.approx(1 / 3, rel=1e-3)


def test_in_a_sheared_gas_layers_are_across_the_shear_and_the_flow_is_seen():
    system = system_of((20, 20), particles=NUMBER, shear_rate=0.1)
    frame = frame_of(system)
    moving = frame.velocity + np.array([0.1, 0.0]) * (frame.position[:, 1:] - 10.0)
    observable, found = results("profiles", [frame._replace(velocity=moving)], bins=4)
    linear = 0.1 * (observable.coordinates["height"] - 10.0)
    assert found["flow_profile"][:, 0] == pytest.approx(linear, abs=0.06)
    _, cumulants = results("cumulants", [frame._replace(velocity=moving)])
    _, plain = results("cumulants", [frame._replace(system=system_of((20, 20), particles=NUMBER))])
    assert cumulants["a20"] == pytest.approx(plain["a20"], abs=1e-9)


def flight(system, velocity, times, acceleration=0.0):
    """Frames of free flight through a periodic box."""
    start = frame_of(system, velocity=velocity).position
    fall = np.zeros(system.dimension)
    fall[-1] = acceleration
    for time in times:
        now = velocity - fall * time
        place = start + velocity * time - 0.5 * fall * time**2
        unwrapped = place.copy()
        for axis, periodic in enumerate(system.periodic):
            if periodic:
                place[:, axis] %= system.box[axis]
        yield frame_of(system, place, now, time=time, unwrapped_position=unwrapped)


@pytest.mark.parametrize("speed", [0.1, 40.0])
def test_free_particles_get_as_far_as_they_fly(speed):
    """<v^2> t^2, also through several boxes between two looks."""
    system = system_of((20, 15), particles=50, interval=0.5)
    velocity = speed * frame_of(system).velocity
    frames = list(flight(system, velocity, 0.5 * np.arange(20)))
    observable, found = results("mean_square_displacement", frames, lags=4)
    lag = observable.coordinates["lag"]
    assert lag.tolist() == [0.5, 1.0, 2.0, 4.0]
    expected = np.outer(lag**2, (velocity**2).mean(axis=0))
    assert found["mean_square_displacement"] == pytest.approx(expected, rel=1e-9)


def test_velocities_are_remembered_for_as_long_as_they_last():
    """Of an Ornstein-Uhlenbeck process with decay 0.8 a look, C(k) = 0.8^k, within 4 sigma; the

    sum over pairs of looks is that of a loop in plain Python.
    """
    rng, keep, number, looks = np.random.default_rng(5), 0.8, 500, 60
    system = system_of((20, 15), particles=number, interval=0.5)
    state, series = rng.standard_normal((number, 3)), []
    for _ in range(looks):
        series.append(state)
        state = keep * state + math.sqrt(1.0 - keep**2) * rng.standard_normal(state.shape)
    frames = [frame_of(system, velocity=x[:, :2], spin=2.0 * x[:, 2:]) for x in series]
    observable, found = results("autocorrelation", frames, delays=5)
    assert observable.coordinates["delay"].tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    for k in range(5):
        pairs = [(a, b) for a, b in zip(series[: looks - k], series[k:], strict=True)]
        whole = [np.mean(a[:, :2] * b[:, :2]) for a, b in pairs]
        assert found["velocity_autocorrelation"][k] == pytest.approx(np.mean(whole), rel=1e-12)
    # memory of (1 + 0.64)/(1 - 0.64) = 4.6 looks, products of variance 2 at most
    error = math.sqrt(2.0 * 4.6 / (looks * number))
    expected = keep ** np.arange(5)
    assert np.abs(found["velocity_autocorrelation"] - expected).max() < 4.0 * error / math.sqrt(2)
    assert np.abs(found["spin_autocorrelation"] - 4.0 * expected).max() < 16.0 * error


def test_fluxes_are_averaged_over_all_directions():
    """Stress over its five shears, heat over three axes; delay by delay, from means over each
    interval, of made-up gases."""
    rng, looks, names = np.random.default_rng(6), 7, (*STRESSES, *HEAT)
    system = system_of((20, 15, 10), particles=9, interval=0.5)
    velocities, spins = rng.standard_normal((2, looks, 9, 3))
    rates = rng.standard_normal((looks, len(names)))
    frames = [
        frame_of(system, velocity=v, spin=w, rates=dict(zip(names, one, strict=True)))
        for v, w, one in zip(velocities, spins, rates, strict=True)
    ]
    observable, found = results("flux_autocorrelation", frames, delays=4)
    assert observable.coordinates["delay"].tolist() == [0.0, 0.5, 1.0, 1.5]
    series = []
    for k in range(1, looks):
        P, q = rates[k, :9].reshape(3, 3).copy(), rates[k, 9:].copy()
        ends = velocities[k - 1 : k + 1], spins[k - 1 : k + 1]
        for v, w in zip(*(one.reshape(-1, 3) for one in ends), strict=True):
            P += np.outer(v, v) / 2
            q += (v @ v + 0.4 * w @ w) / 2 * v / 2
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = P
        shears = (xy + yx) / 2, (xz + zx) / 2, (yz + zy) / 2, (xx - yy) / 2
        series.append([*shears, (xx + yy - 2 * zz) / math.sqrt(12), *q])
    T, free = np.mean(velocities**2) * 9 / 8, 8 / 9
    for k in range(4):
        products = [
            np.multiply(a, b) / 3000
            for a, b in zip(series[: looks - 1 - k], series[k:], strict=True)
        ]
        means = np.mean(products, axis=0)
        assert found["stress_autocorrelation"][k] == pytest.approx(means[:5].mean() / free)
        assert found["heat_flux_autocorrelation"][k] == pytest.approx(means[5:].mean() / free)
    for name, memory, power in (("viscosity", "stress", 1), ("conductivity", "heat_flux", 2)):
        C = found[f"{memory}_autocorrelation"]
        area = 0.5 * (C[0] / 2 + C[1] + C[2] + C[3] / 2)
        assert found[f"{name}_until"][-1] == pytest.approx(area / T**power)


RNG = np.random.default_rng(3)
LOOKS = 400


def looks(**series):
    """A look for each place of the series."""
    return [dict(zip(series, row, strict=True)) for row in zip(*series.values(), strict=True)]


def ratio(means):
    return {"ratio": means["a"] / means["b"]}


def test_a_mean_has_the_error_by_blocking():
    values = RNG.standard_normal((LOOKS, 3)).cumsum(axis=0)
    found = averaged(dict, [looks(x=values)])
    assert found.value["x"] == pytest.approx(values.mean(axis=0), rel=1e-12)
    for k in range(3):
        error = blocking(values[:, k])
        assert found.stderr["x"][k] == pytest.approx(error.stderr, rel=1e-6)
        assert found.dof["x"][k] == pytest.approx(error.blocks - 1.0)


def test_the_error_of_a_quotient_is_that_of_its_linear_part():
    """Gauss's law of the propagation of errors, with the covariance."""
    a, noise = RNG.normal(5.0, 1.0, LOOKS), RNG.normal(0.0, 0.5, LOOKS)
    b = 0.5 * a + noise + 3.0
    found = averaged(ratio, [looks(a=a, b=b)])
    R = a.mean() / b.mean()
    linear = R * (a / a.mean() - b / b.mean())
    assert found.value["ratio"] == pytest.approx(R, rel=1e-14)
    assert found.stderr["ratio"] == pytest.approx(blocking(linear).stderr, rel=1e-5)


def test_of_several_runs_the_scatter_counts():
    means = np.array([1.0, 2.0, 4.0])
    runs = [looks(a=np.full(9, mean), b=np.full(9, 2.0)) for mean in means]
    found = averaged(ratio, runs)
    assert found.value["ratio"] == pytest.approx(means.mean() / 2.0)
    expected = means.std(ddof=1) / math.sqrt(3) / 2.0
    assert found.stderr["ratio"] == pytest.approx(expected, rel=1e-6)
    assert found.dof["ratio"] == 2.0


def test_what_is_nan_does_not_count():
    values = RNG.standard_normal((LOOKS, 2))
    values[:30, 0] = math.nan
    values[:, 1] = math.nan
    found = averaged(dict, [looks(x=values)])
    assert found.value["x"][0] == pytest.approx(values[30:, 0].mean(), rel=1e-12)
    assert found.stderr["x"][0] == pytest.approx(blocking(values[30:, 0]).stderr, rel=1e-6)
    assert math.isnan(found.value["x"][1]) and math.isnan(found.stderr["x"][1])


def test_means_are_over_whole_periods():
    """A swing within the period is no scatter."""
    phases = np.tile([0.0, 1.0, 5.0, 2.0], LOOKS // 4)
    found = averaged(dict, [looks(x=phases)], per_period=4)
    assert found.value["x"] == 2.0 and found.stderr["x"] == 0.0
