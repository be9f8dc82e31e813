import numpy as np
import pytest

from roughgas.statistics.errors import block_means, period_means


def test_means_of_whole_periods_leave_out_the_incomplete_one():
    np.testing.assert_allclose(period_means(np.arange(11.0), 4), [1.5, 5.5])


def test_leading_axes_are_kept():
    series = np.arange(24.0).reshape(2, 12)
    np.testing.assert_allclose(period_means(series, 3), [[1, 4, 7, 10], [13, 16, 19, 22]])


def test_the_phases_of_a_drive_disappear():
    phases = np.tile([0.18, 0.24, 0.26, 0.21], 50)
    np.testing.assert_allclose(period_means(phases, 4), np.full(50, 0.2225))


def test_means_over_blocks_keep_the_shorter_last_one():
    np.testing.assert_array_equal(block_means(np.arange(5.0), 2), [0.5, 2.5, 4.0])


@pytest.mark.parametrize("samples_per_period", [0, -1, 6])
def test_no_whole_period_is_an_error(samples_per_period):
    with pytest.raises(ValueError, match="no whole period"):
        period_means(np.zeros(5), samples_per_period)
