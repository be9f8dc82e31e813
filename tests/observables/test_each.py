"""Each observable, and averages over frames."""

import itertools
import math
import tracemalloc

import numpy as np
import pytest
from msgspec.structs import asdict
from raw import observed_settings
from tests.observables.frames import frame_of, system_of

from roughgas.effects.contacts import HEAT, STRESSES
from roughgas.observables import OBSERVABLES
from roughgas.observables.averages import averaged
from roughgas.observables.distributions import squared_pair_distances
from roughgas.observables.frames import FrameSeries
from roughgas.statistics.errors import blocking

NUMBER = 40_000


def observable_and_results(name, frames, **settings):
    """Return an observable, and its results from frames."""
    kind = OBSERVABLES[name]
    usual = asdict(kind.settings())
    usual.pop("every")
    observable = kind(frames[0].system, **(usual | settings))
    samples = [observable.observe(frame) for frame in frames]
    means = {key: np.nanmean([sample[key] for sample in samples], axis=0) for key in samples[0]}
    return observable, observable.combine(means)


def distances(frame, reach):
    """Return the distances below `reach`, of each pair over all images, in plain Python."""
    box, separations = frame.system.box, []
    for first, second in itertools.combinations(frame.position, 2):
        for numbers in itertools.product((-1, 0, 1), repeat=len(box)):
            shift = [n * length for n, length in zip(numbers, box, strict=True)]
            shift[0] += numbers[1] * frame.image_shift
            for shear_image in (-box[0], 0.0, box[0]) if frame.image_shift else (0.0,):
                shifted = [x - y - s for x, y, s in zip(first, second, shift, strict=True)]
                shifted[0] -= shear_image
                separations.append(math.hypot(*shifted))
    return sorted({round(distance, 9) for distance in separations if distance < reach})


@pytest.mark.parametrize(
    ("box", "shift", "reach"), [((20, 15), 0.0, 7.0), ((20, 15), 13.0, 7.5), ((9, 8, 10), 0.0, 4.0)]
)
def test_pairs_are_those_of_a_loop_over_all_images(box, shift, reach):
    system = system_of(box, shear_rate=0.1 if shift else 0.0, particles=90)
    frame = frame_of(system, image_shift=shift)
    separations = np.concatenate(
        [np.sqrt(squared) for _, squared in squared_pair_distances(FrameSeries.of([frame]), reach)]
    )
    assert np.sort(separations) == pytest.approx(distances(frame, reach), abs=1e-8)
    assert len(separations) > 100


@pytest.mark.parametrize("box", [(30, 30), (14, 14, 14)])
def test_g_of_independent_particles_is_1(box):
    rng = np.random.default_rng(1)
    system = system_of(box, particles=400)
    frames = [frame_of(system, rng.uniform(0, 1, (400, len(box))) * box) for _ in range(20)]
    observable, correlation = observable_and_results("pair_correlation", frames, bins=2)
    counted = correlation["pair_correlation"] * observable._ideal * len(frames)
    expected = observable._ideal * len(frames)
    assert np.all(abs(counted - expected) < 5 * np.sqrt(expected))


@pytest.mark.parametrize("box", [(30, 30), (14, 14, 14)])
def test_gaussian_velocities_and_spins_have_no_cumulants(box):
    frame = frame_of(system_of(box, particles=NUMBER))
    _, cumulants = observable_and_results("cumulants", [frame])
    _, correlation = observable_and_results("spin_correlation", [frame])
    moments = {
        **cumulants,
        **correlation,
        "cos2_angle": correlation.get("cos2_angle", 1 / 3) - 1 / 3,
    }
    for name, value in moments.items():
        assert abs(value) < 0.03, name


def test_cumulants_of_a_circle_of_velocities_are_exact():
    """Velocities on a circle, and spins +-1: <V^4> = <V^2>^2, <w^4> = <w^2>^2."""
    angle = np.linspace(0, 2 * np.pi, NUMBER, endpoint=False)
    velocity = 3.0 * np.array([np.cos(angle), np.sin(angle)]).T
    spin = np.where(np.arange(NUMBER) % 2, 1.0, -1.0)[:, None]
    frame = frame_of(system_of((30, 30), particles=NUMBER), velocity=velocity, spin=spin)
    _, cumulants = observable_and_results("cumulants", [frame])
    assert cumulants["a20"] == pytest.approx(-0.5) and cumulants["a02"] == pytest.approx(-2 / 3)


def test_profiles_resolve_a_hotter_and_denser_lower_layer():
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
    observable, profiles = observable_and_results("profiles", [frame], bins=2, height=10.0)
    assert observable.coordinates["height"].tolist() == [2.5, 7.5]
    packing = math.pi * NUMBER * np.array([2, 1]) / 3 / 50
    assert profiles["packing_profile"] == pytest.approx(packing, rel=1e-3)
    assert profiles["flow_profile"] == pytest.approx(np.array([[3, 0], [0, 0]]), abs=0.06)
    assert profiles["temperature_profile"] == pytest.approx(np.array([[4, 4], [1, 1]]), rel=0.05)
    assert profiles["T_rot_profile"] == pytest.approx([0.5, 0.5], rel=0.05)
    assert profiles["R_profile"] == pytest.approx([0.5 / 4.5, 0.5 / 1.5], rel=0.05)
    assert profiles["share_above"] == 0.0
    _, lower = observable_and_results("profiles", [frame], bins=2, height=5.0)
    assert lower["share_above"] == pytest.approx(1 / 3, rel=1e-3)


def test_profiles_of_a_sheared_gas_are_across_the_shear_and_show_the_flow():
    system = system_of((20, 20), particles=NUMBER, shear_rate=0.1)
    frame = frame_of(system)
    moving = frame.velocity + np.array([0.1, 0.0]) * (frame.position[:, 1:] - 10.0)
    observable, profiles = observable_and_results(
        "profiles", [frame._replace(velocity=moving)], bins=4
    )
    linear = 0.1 * (observable.coordinates["height"] - 10.0)
    assert profiles["flow_profile"][:, 0] == pytest.approx(linear, abs=0.06)
    _, cumulants = observable_and_results("cumulants", [frame._replace(velocity=moving)])
    _, plain = observable_and_results(
        "cumulants", [frame._replace(system=system_of((20, 20), particles=NUMBER))]
    )
    assert cumulants["a20"] == pytest.approx(plain["a20"], abs=1e-9)


def flight(system, velocity, times, acceleration=0.0):
    """Yield frames of free flight through a periodic box."""
    start = frame_of(system, velocity=velocity).position
    fall = np.zeros(system.dimension)
    fall[-1] = acceleration
    for time in times:
        now = velocity - fall * time
        position = start + velocity * time - 0.5 * fall * time**2
        unwrapped = position.copy()
        for axis, periodic in enumerate(system.periodic):
            if periodic:
                position[:, axis] %= system.box[axis]
        yield frame_of(system, position, now, time=time, unwrapped_position=unwrapped)


@pytest.mark.parametrize("speed", [0.1, 40.0])
def test_free_particles_get_as_far_as_they_fly(speed):
    """<v^2> t^2, also through several boxes between two frames."""
    system = system_of((20, 15), particles=50, interval=0.5)
    velocity = speed * frame_of(system).velocity
    frames = list(flight(system, velocity, 0.5 * np.arange(20)))
    observable, displacements = observable_and_results("mean_square_displacement", frames, lags=4)
    lag = observable.coordinates["lag"]
    assert lag.tolist() == [0.5, 1.0, 2.0, 4.0]
    expected = np.outer(lag**2, (velocity**2).mean(axis=0))
    assert displacements["mean_square_displacement"] == pytest.approx(expected, rel=1e-9)
    fresh = observed_settings({"mean_square_displacement": {"lags": 4}})[0].make(system)
    squares = [fresh.observe(frame)["mean_square_displacement"] for frame in frames]
    first = np.isfinite(np.array(squares)).all(axis=-1).argmax(axis=0)
    assert first.tolist() == [1, 2, 4, 8]  # the first frame with an earlier frame at that lag


def test_autocorrelations_decay_as_in_an_ornstein_uhlenbeck_process():
    """In an Ornstein-Uhlenbeck process of decay 0.8 a frame, C(k) = 0.8^k, within 4 sigma.

    The sum over pairs of frames equals a loop in plain Python.
    """
    rng, decay, particles, instants = np.random.default_rng(5), 0.8, 500, 60
    system = system_of((20, 15), particles=particles, interval=0.5)
    state, series = rng.standard_normal((particles, 3)), []
    for _ in range(instants):
        series.append(state)
        state = decay * state + math.sqrt(1.0 - decay**2) * rng.standard_normal(state.shape)
    frames = [frame_of(system, velocity=x[:, :2], spin=2.0 * x[:, 2:]) for x in series]
    observable, correlations = observable_and_results("autocorrelation", frames, delays=5)
    assert observable.coordinates["delay"].tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    for k in range(5):
        pairs = [(a, b) for a, b in zip(series[: instants - k], series[k:], strict=True)]
        products = [np.mean(a[:, :2] * b[:, :2]) for a, b in pairs]
        assert correlations["velocity_autocorrelation"][k] == pytest.approx(
            np.mean(products), rel=1e-12
        )
    # memory of (1 + 0.64)/(1 - 0.64) = 4.6 frames, products of variance 2 at most
    error = math.sqrt(2.0 * 4.6 / (instants * particles))
    expected = decay ** np.arange(5)
    assert np.abs(
        correlations["velocity_autocorrelation"] - expected
    ).max() < 4.0 * error / math.sqrt(2)
    assert np.abs(correlations["spin_autocorrelation"] - 4.0 * expected).max() < 16.0 * error


def test_an_autocorrelation_copies_no_earlier_observations():
    """The memory of an observation does not grow with the delays: nor does its time per delay."""
    particles, delays = 2000, 200
    system = system_of((20, 15), particles=particles, interval=0.5)
    frame = frame_of(system, velocity=np.ones((particles, 2)), spin=np.ones((particles, 1)))
    observable = OBSERVABLES["autocorrelation"](system, delays=delays)
    for _ in range(delays):
        observable.observe(frame)
    tracemalloc.start()
    try:
        observable.observe(frame)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 0.1 * delays * particles * 3 * 8  # bytes of the earlier observations


def test_fluxes_are_averaged_over_all_directions():
    """Stress over its five shears, heat over three axes; delay by delay, from means over each
    interval, of random gases."""
    rng, instants, names = np.random.default_rng(6), 7, (*STRESSES, *HEAT)
    system = system_of((20, 15, 10), particles=9, interval=0.5)
    velocities, spins = rng.standard_normal((2, instants, 9, 3))
    rates = rng.standard_normal((instants, len(names)))
    frames = [
        frame_of(system, velocity=v, spin=w, rates=dict(zip(names, row, strict=True)))
        for v, w, row in zip(velocities, spins, rates, strict=True)
    ]
    observable, correlations = observable_and_results("flux_autocorrelation", frames, delays=4)
    assert observable.coordinates["delay"].tolist() == [0.0, 0.5, 1.0, 1.5]
    series = []
    for k in range(1, instants):
        P, q = rates[k, :9].reshape(3, 3).copy(), rates[k, 9:].copy()
        ends = velocities[k - 1 : k + 1], spins[k - 1 : k + 1]
        for v, w in zip(*(vectors.reshape(-1, 3) for vectors in ends), strict=True):
            P += np.outer(v, v) / 2
            q += (v @ v + 0.4 * w @ w) / 2 * v / 2
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = P
        shears = (xy + yx) / 2, (xz + zx) / 2, (yz + zy) / 2, (xx - yy) / 2
        series.append([*shears, (xx + yy - 2 * zz) / math.sqrt(12), *q])
    T, free = np.mean(velocities**2) * 9 / 8, 8 / 9
    for k in range(4):
        products = [
            np.multiply(a, b) / 3000
            for a, b in zip(series[: instants - 1 - k], series[k:], strict=True)
        ]
        means = np.mean(products, axis=0)
        assert correlations["stress_autocorrelation"][k] == pytest.approx(means[:5].mean() / free)
        assert correlations["heat_flux_autocorrelation"][k] == pytest.approx(
            means[5:].mean() / free
        )
    for name, memory, power in (("viscosity", "stress", 1), ("conductivity", "heat_flux", 2)):
        C = correlations[f"{memory}_autocorrelation"]
        area = 0.5 * (C[0] / 2 + C[1] + C[2] + C[3] / 2)
        assert correlations[f"{name}_until"][-1] == pytest.approx(area / T**power)


RNG = np.random.default_rng(3)
FRAMES = 400


def series_of(**series):
    """Return arrays (frames, ...) by name."""
    return {name: np.array(values) for name, values in series.items()}


def ratio(means):
    return {"ratio": means["a"] / means["b"]}


def test_a_mean_has_the_error_by_blocking():
    values = RNG.standard_normal((FRAMES, 3)).cumsum(axis=0)
    mean = averaged(dict, [series_of(x=values)])
    assert mean.value["x"] == pytest.approx(values.mean(axis=0), rel=1e-12)
    for k in range(3):
        error = blocking(values[:, k])
        assert mean.stderr["x"][k] == pytest.approx(error.stderr, rel=1e-6)
        assert mean.dof["x"][k] == pytest.approx(error.blocks - 1.0)


def test_the_error_of_a_quotient_is_that_of_its_linear_part():
    """Gauss's law of the propagation of errors, with the covariance."""
    a, noise = RNG.normal(5.0, 1.0, FRAMES), RNG.normal(0.0, 0.5, FRAMES)
    b = 0.5 * a + noise + 3.0
    mean = averaged(ratio, [series_of(a=a, b=b)])
    R = a.mean() / b.mean()
    linear = R * (a / a.mean() - b / b.mean())
    assert mean.value["ratio"] == pytest.approx(R, rel=1e-14)
    assert mean.stderr["ratio"] == pytest.approx(blocking(linear).stderr, rel=1e-5)


def test_the_error_over_several_runs_is_their_scatter():
    means = np.array([1.0, 2.0, 4.0])
    runs = [series_of(a=np.full(9, mean), b=np.full(9, 2.0)) for mean in means]
    average = averaged(ratio, runs)
    assert average.value["ratio"] == pytest.approx(means.mean() / 2.0)
    expected = means.std(ddof=1) / math.sqrt(3) / 2.0
    assert average.stderr["ratio"] == pytest.approx(expected, rel=1e-6)
    assert average.dof["ratio"] == 2.0


def test_averages_omit_nan():
    values = RNG.standard_normal((FRAMES, 2))
    values[:30, 0] = math.nan
    values[:, 1] = math.nan
    mean = averaged(dict, [series_of(x=values)])
    assert mean.value["x"][0] == pytest.approx(values[30:, 0].mean(), rel=1e-12)
    assert mean.stderr["x"][0] == pytest.approx(blocking(values[30:, 0]).stderr, rel=1e-6)
    assert math.isnan(mean.value["x"][1]) and math.isnan(mean.stderr["x"][1])


def test_means_are_over_whole_periods():
    """A variation within the period is no scatter."""
    phases = np.tile([0.0, 1.0, 5.0, 2.0], FRAMES // 4)
    mean = averaged(dict, [series_of(x=phases)], per_period=4)
    assert mean.value["x"] == 2.0 and mean.stderr["x"] == 0.0
