"""Figures of results of observables."""

import numpy as np
import pytest
import xarray as xr

from roughgas.base import InputError
from roughgas.show.figures.sweep import draw_observed as draw

ATTRIBUTES = {"experiment": "gas", "r": 0.9, "beta": 0.0, "particles": 9, "seed": 1}


def point():
    values = np.arange(12.0).reshape(2, 2, 3)
    dims = ("species", "other", "distance")
    variables = {
        "pair_correlation_species": (dims, values),
        "pair_correlation_species_stderr": (dims, values / 10.0),
        "a20_species": ("species", [0.1, 0.2]),
    }
    coordinates = {"distance": ("distance", [1.0, 2.0, 3.0], {"long_name": "far", "units": "a"})}
    return xr.Dataset(variables, coordinates | {"species": ["light", "heavy"]}, ATTRIBUTES)


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


def test_untrusted_errors_are_paler_and_explained():
    dataset = point()
    flags = np.ones(dataset.pair_correlation_species.shape, np.int8)
    dataset["pair_correlation_species_trusted"] = (dataset.pair_correlation_species.dims, flags)
    assert not draw(dataset, "pair_correlation_species").legends
    flags[1, 1, 2] = -1
    figure = draw(dataset, "pair_correlation_species")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["paler: the error is not trusted"]
    *_, untrusted_band, trusted_band = figure.axes[0].collections
    assert untrusted_band.get_alpha() < trusted_band.get_alpha()
    ends = [band.get_paths()[0].vertices[:, 0].max() for band in (untrusted_band, trusted_band)]
    assert ends == [3.0, 2.0]


def test_variables_without_a_numeric_coordinate_are_refused():
    with pytest.raises(InputError, match=r"^--of = a20_species: .* pair_correlation_species"):
        draw(point(), "a20_species")
