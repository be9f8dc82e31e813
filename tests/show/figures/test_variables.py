"""Figures of any variables of a sweep, a row for each."""

import re

import numpy as np
import pytest
import xarray as xr
from observed_sweep import observed_sweep
from tests.show.figures.legibility import faults_of_letters

from roughgas.base import InputError
from roughgas.base.fields import fields_of
from roughgas.effects import EFFECTS
from roughgas.effects.species import SpeciesSettings
from roughgas.show.figures import sweep, variables

SPEEDS = ("kicks.speed", (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1))


def labels(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


@pytest.mark.parametrize("third", [None, SPEEDS])
def test_a_figure_shows_r_beside_theory_and_all_that_is_observed(third):
    data = observed_sweep(third)
    names = variables.drawn_by_default(data)
    assert names == ["R", "fast", "squares", "profile"]
    assert faults_of_letters(lambda: variables.draw(data, names)) == []
    figure = variables.draw(data, names)
    columns = 1 if third is None else 2
    assert len(figure.axes) == len(names) * columns
    over = r"$\beta$" if third is None else "speed"
    title = f"$R$, fast, squares and profile over {over}, $R$ beside Lun's formula"
    assert figure.get_suptitle() == title
    assert [axes.get_ylabel() for axes in figure.axes[::columns]] == [
        *("$R$", "fast", "squares\n / (a$^{2}$ T$^{-2}$)", "profile\n / (a/T)")
    ]


def test_values_and_their_errors_are_drawn():
    data = observed_sweep()
    _, fast, squares, profile = variables.draw(data, variables.drawn_by_default(data)).axes
    for axes, expected in (
        (fast, [[0.05, 0.1, 0.15]] * 2),
        (squares, [[0.05, 0.1, 0.15], [0.1, 0.2, 0.3]] * 2),
    ):
        drawn = [bars[0].get_ydata() for bars in axes.containers]
        np.testing.assert_allclose(drawn, expected)
        segments = axes.containers[0][2][0].get_segments()
        np.testing.assert_allclose(np.diff(segments, axis=1)[:, 0, 1], 0.02)
    assert labels(squares) == ["$r = 0.8$", "$r = 0.9$", "x", "y"]
    lines = [line.get_ydata() for line in profile.get_lines()]
    np.testing.assert_allclose(lines, np.outer([0.05, 0.1, 0.15], [0.0, 1.0, 4.0, 9.0]))
    assert labels(profile) == [rf"$\beta = {beta}$" for beta in ("-0.5", "0", "0.5")]
    assert profile.get_xlabel() == "height / a"


def test_nine_components_have_nine_markers_and_lines():
    """Over the sweep, of a stress, and along a height, of a profile of it."""
    data = observed_sweep().drop_vars(["squares", "squares_stderr", "squares_trusted"])
    axes = {"component": ["x", "y", "z"], "along": ["x", "y", "z"]}
    stress = xr.DataArray(np.arange(9.0).reshape(3, 3), axes)
    data = data.assign(stress=data.fast + stress, layers=data.profile + stress)
    over, height = variables.draw(data, ["stress", "layers"]).axes
    markers = [bars[0].get_marker() for bars in over.containers[:9]]
    styles = [str(line._dash_pattern) for line in height.get_lines()[:9]]
    assert len(set(markers)) == len(set(styles)) == 9
    assert variables.BENEATH_LINES["linestyle"] not in {
        line.get_linestyle() for line in height.get_lines()
    }


def test_untrusted_errors_are_paler_and_explained():
    (axes,) = variables.draw(observed_sweep(), ["fast"]).axes
    assert len(axes.containers) == 2 and not axes.figure.legends
    (axes,) = variables.draw(observed_sweep(trusted=-1.0), ["fast"]).axes
    assert len(axes.containers) == 4
    (legend,) = axes.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["paler bars or bands: not trusted"]


def test_the_legend_says_what_each_theory_is():
    """Dashes at the points of a sweep, dots along a profile, and the line of R."""
    data = observed_sweep()
    names = "R", "fast", "squares", "profile"
    theories = {name: data[name] for name in names[1:]}
    figure = variables.draw(data, names, None, theories)
    (legend,) = figure.legends
    texts = [text.get_text() for text in legend.get_texts()]
    keys = dict(zip(texts, legend.get_lines(), strict=True))
    dashes, dots = "dashes: theory of fast and squares", "dots: theory of profile"
    line = "lines: $R$ of Lun's formula"
    assert list(keys) == [dashes, dots, line]
    assert keys[dashes].get_marker() == "_" and keys[dots].get_linestyle() == ":"
    assert keys[line].get_linestyle() == "-"
    _, fast, _, profile = figure.axes
    drawn = next(line for line in fast.get_lines() if line.get_marker() == "_")
    np.testing.assert_allclose(drawn.get_ydata(), [0.05, 0.1, 0.15])
    assert ":" in {line.get_linestyle() for line in profile.get_lines()}


def test_a_line_says_what_is_left_out():
    data = observed_sweep(SPEEDS)
    assert variables.not_shown(data, ["fast"], None, {}) == [
        "not shown: squares, profile (--of names what to draw)"
    ]
    assert variables.not_shown(data, ["fast", "squares", "profile"], None, {}) == [
        "profile: 5 of 6 values of speed are shown: 1e-06, 1e-05, 0.0001, 0.01, 0.1",
        "profile: beta = 0 alone is shown",
    ]
    wide = data.assign({f"more{k}": data.fast for k in range(9)})
    wide = wide.assign({f"more{k}_stderr": data.fast_stderr for k in range(9)})
    names = variables.drawn_by_default(wide)
    assert names == ["R", "fast", "squares", "more0", "more1"]
    (line,) = variables.not_shown(wide, names, None, {})
    assert line.startswith("not shown: profile, more2, more3, ")


def test_words_stand_below_the_axis():
    data = observed_sweep(("floor.wave", ("sine", "triangle")))
    figure = variables.draw(data, ["fast", "profile"])
    *fast, profile, _ = figure.axes
    for axes in fast:
        assert [text.get_text() for text in axes.get_xticklabels()] == ["sine", "triangle"]
    assert labels(figure.axes[-1]) == ["sine", "triangle"]
    assert profile.get_xlabel() == "height / a"


def test_other_variables_of_the_sweep_are_drawn_and_unknown_ones_refused():
    data = observed_sweep()
    (axes,) = variables.draw(data, ["E_trans"]).axes
    np.testing.assert_allclose(axes.containers[0][0].get_ydata(), 1.0)
    for name in ("fest", "side", "n_seeds_of_all"):
        with pytest.raises(InputError, match=f"--of = {name}: must be one of R, fast, squares, "):
            variables.draw(data, [name])


def test_units_of_axes_are_those_of_the_settings():
    """Descriptions of settings end in their unit, such as ", in a/T."."""
    unit = re.compile(
        r"(?:, in|^Radius in|^Mass in) (m a\^2/T\^[23]|a/T\^2|a/T|1/T|[aTm])(?![\w/^])"
    )
    kinds = [*(kind.settings for kind in EFFECTS.values()), SpeciesSettings]
    described = {}
    for field in (field for kind in kinds for field in fields_of(kind)):
        if found := unit.search(field.description):
            described.setdefault(field.name, set()).add(found[1])
    described["spin_power"] = {"m a^2/T^3"}  # whose description has none
    assert described == {name: {unit} for name, unit in sweep.UNITS_OF_SETTINGS.items()}
