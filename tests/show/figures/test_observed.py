"""What observables have found, as a figure."""

import numpy as np
import pytest
import xarray as xr

from roughgas.base import InputError
from roughgas.show.figures.sweep import draw_observed as draw

ABOUT = {"experiment": "gas", "r": 0.9, "beta": 0.0, "particles": 9, "seed": 1}


def point():
    values = np.arange(12.0).reshape(2, 2, 3)
    dims = ("species", "other", "distance")
    variables = {
        "pair_correlation_species": (dims, values),
        "pair_correlation_species_stderr": (dims, values / 10.0),
        "a20_species": ("species", [0.1, 0.2]),
    }
    at = {"distance": ("distance", [1.0, 2.0, 3.0], {"long_name": "far", "units": "a"})}
    return xr.Dataset(variables, at | {"species": ["light", "heavy"]}, ABOUT)


def test_there_is_a_line_for_each_pair_of_species_with_its_error():
    (axes,) = draw(point(), "pair_correlation_species").axes
    lines = {line.get_label(): line.get_ydata().tolist() for line in axes.lines}
    assert lines == {
        "light, light": [0.0, 1.0, 2.0],
        "light, heavy": [3.0, 4.0, 5.0],
        "heavy, heavy": [9.0, 10.0, 11.0],
    }
    top = axes.collections[2].get_paths()[0].vertices[:, 1].max()
    assert top == pytest.approx(11.0 * 1.1)
    assert axes.get_xlabel() == "distance / a" and axes.get_ylabel() == "pair correlation"


def test_errors_that_are_not_trusted_are_paler_and_a_line_says_so():
    one = point()
    flags = np.ones(one.pair_correlation_species.shape, np.int8)
    one["pair_correlation_species_trusted"] = (one.pair_correlation_species.dims, flags)
    assert not draw(one, "pair_correlation_species").legends
    flags[1, 1, 2] = -1
    figure = draw(one, "pair_correlation_species")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["paler: the error is not trusted"]
    *_, paler, rest = figure.axes[0].collections
    assert paler.get_alpha() < rest.get_alpha()
    ends = [band.get_paths()[0].vertices[:, 0].max() for band in (paler, rest)]
    assert ends == [3.0, 2.0]


def test_what_is_over_no_numbers_is_not_drawn():
    with pytest.raises(InputError, match=r"^--of = a20_species: .* pair_correlation_species"):
        draw(point(), "a20_species")
