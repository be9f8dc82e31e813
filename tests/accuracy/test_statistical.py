"""The statistical error: its fits on data of known law, and a tiny study from end to end."""

import math

import numpy as np
import pytest
from matplotlib.figure import Figure
from raw import typed
from tests.studies.small_runs import combined, task_results
from tests.studies.small_studies import STATISTICAL
from tests.study_modules import module_of_study

statistical = module_of_study("accuracy", "statistical")
Chain, SCENES, WAYS = statistical.Chain, statistical.SCENES, statistical.WAYS
noise, observed = statistical.noise, statistical.observed
time_from_blocks = statistical.time_from_blocks
draw = module_of_study("accuracy", "figure").draw_statistical
LENGTHS = 2.0 ** np.arange(8)


def estimates(rng, exponent=-0.5, groups=32):
    """Return normal estimates around 0.3 of error 0.02 LENGTHS^exponent."""
    return 0.3 + 0.02 * LENGTHS[:, None] ** exponent * rng.standard_normal((8, groups))


@pytest.mark.parametrize("exponent", [-0.5, -0.25])
def test_slopes_are_unbiased_and_their_errors_honest(exponent):
    """300 studies: the mean to 0.06 of an error, their scatter to 4 %; at 4 sigma."""
    rng = np.random.default_rng(1)
    seconds = np.broadcast_to(LENGTHS[:, None], (8, 32))
    lines = [observed(estimates(rng, exponent), seconds, 0.3)["slope"] for _ in range(300)]
    z = np.array([(line.value - exponent) / line.stderr for line in lines])
    assert abs(z.mean()) < 0.24
    assert z.std() == pytest.approx(1, abs=0.17)


def test_observed_errors_and_the_noise_behind_them():
    """256 estimates: 4.4 % for the errors; 3.1 % for the noise; at 4 sigma."""
    R = estimates(np.random.default_rng(2), groups=256)
    seconds = np.broadcast_to(LENGTHS[:, None], R.shape)
    levels = observed(R, seconds, 0.3)
    error, stderr, _ = levels["error"]
    np.testing.assert_allclose(error, 0.02 * LENGTHS**-0.5, rtol=0.18)
    np.testing.assert_allclose(stderr, error / math.sqrt(512))
    mean, stderr, _ = noise(error, levels["groups"], LENGTHS)
    assert abs(mean - 0.02**2) < 4 * stderr
    assert stderr == pytest.approx(mean * math.sqrt(2 / 2048))


def test_missing_groups_do_not_count():
    R = np.array([[0.1, 0.3, np.nan, np.nan], [0.1, 0.3, 0.1, 0.3]])
    seconds = np.where(np.isfinite(R), [[2.0], [4.0]], np.nan)
    levels = observed(R, seconds, 0.2)
    np.testing.assert_allclose(levels["error"].value, 0.1)
    np.testing.assert_array_equal(levels["groups"], [2, 4])
    np.testing.assert_array_equal(levels["seconds"], [2.0, 4.0])


def test_autocorrelation_time_from_blocks():
    """Moving averages over 5 samples have exactly 5, estimated to 2.2 % (10 000 blocks), less 2
    %."""
    white = np.random.default_rng(5).standard_normal(500_004)
    series = np.convolve(white, np.full(5, 0.2), mode="valid")
    assert time_from_blocks(series, 50) == pytest.approx(5 * 0.98, rel=0.06)
    assert math.isnan(time_from_blocks(series[:99], 50))


def test_a_study_from_end_to_end():
    data = combined("accuracy.statistical")
    np.testing.assert_array_equal(data.seeds.sel(way="seeds", scene="sheared"), [1, 2, 4])
    np.testing.assert_array_equal(data.length.sel(way="length", scene="sheared"), [40, 80, 160])
    assert np.all(data.groups >= STATISTICAL.settings["groups"])
    assert np.all((data.R > 0) & (data.R < 0.5))
    assert np.all(data.seconds > 0)
    assert np.all(data.seconds.isel(level=-1) > data.seconds.isel(level=0))  # four times the work
    assert np.all(data.cpu_seconds > data.seconds.sum(["way", "level"]))
    share = (data.seconds_needed - data.equilibration_seconds).values
    np.testing.assert_allclose(share[:, 2], 100 * share[:, 0])  # 0.1 % and 1 %
    axes = Figure().subplots()
    draw(axes, data)
    sheared = data.sel(scene="sheared", way="seeds")
    expected = np.column_stack([sheared.seconds, sheared.error / sheared.R])
    shown = [bar.lines[0].get_xydata() for bar in axes.containers]
    assert any(np.array_equal(points, expected) for points in shown)


def test_estimates_and_references_share_no_segment():
    results = task_results("accuracy.statistical")
    for scene in SCENES:
        R = np.concatenate([results[f"{scene}-{way}"].R.values.ravel() for way in WAYS])
        R = R[np.isfinite(R)]
        assert len(np.unique(R)) == len(R)
        assert not np.isin(results[f"{scene}-reference"].R, R).any()


@pytest.mark.parametrize("scene", SCENES)
def test_segments_continue_one_another(scene):
    """Two segments equal a single run of their joint length: in a cooling gas up to a new unit of
    velocity."""
    chains = [
        Chain(typed(STATISTICAL.experiments[scene]), 0.9, 0.0, 8, np.random.default_rng(7))
        for _ in range(2)
    ]
    halves = np.concatenate([chains[0].measure(8) for _ in range(2)])
    np.testing.assert_array_equal(chains[1].measure(16), halves)
