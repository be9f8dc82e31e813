"""Measured variables beside their theory, and statements of claims.yaml that compare them."""

import numpy as np
import pytest
import xarray as xr
from tests.study_modules import module_of_study
from tests.synthetic import mixed, reduced

from roughgas import theory
from roughgas.base import InputError
from roughgas.claims import examine, read_study
from roughgas.claims.variables import deviation_of, species_temperature_ratio, theory_over_grid
from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED, NotTestedError
from roughgas.theory import mixture_cooling
from roughgas.theory.prediction import mixture_at

POINTS = {"r": (0.8, 0.9), "beta": (-0.5, 0.0, 0.5)}
STATEMENT = """\
kurtosis:
  quote: "[the kurtosis is 0.1]"
  experiments: [cooling]
  variable: a20
  agrees_with: theory
  within: 0.02
  refuted_beyond: {refuted}
  relative: {relative}
  criterion: a20 is theory.
  fixed: {{when: before data}}
"""
THEORY = """\
import xarray as xr


def a20(gas):
    return xr.full_like(gas.n_seeds, 0.1, float)
"""


def gas(value, error=0.001, **options):
    """Return a cooling gas whose variable a20 has this value and standard error everywhere."""
    values = {"a20": value, "a20_stderr": error, "a20_dof": 50.0} | options
    return reduced("cooling", **POINTS, **values)


def test_a_deviation_has_the_variables_error_and_degrees_of_freedom():
    data = gas(0.3)
    expected = xr.DataArray([0.1, 0.2], {"r": data.r}, "r")
    absolute = deviation_of(data, "a20", expected)
    assert absolute.size == 6 and set(absolute.coordinates) == {"r", "beta"}
    at_low_r = absolute.coordinates["r"] == 0.8
    np.testing.assert_allclose(absolute.value[at_low_r], 0.2)
    np.testing.assert_allclose(absolute.value[~at_low_r], 0.1)
    np.testing.assert_allclose(absolute.stderr, 0.001)
    np.testing.assert_allclose(absolute.dof, 50.0)
    relative = deviation_of(data, "a20", expected, relative=True)
    np.testing.assert_allclose(relative.value[at_low_r], 2.0)
    np.testing.assert_allclose(relative.stderr[at_low_r], 0.01)


def test_errors_over_seeds_have_one_degree_of_freedom_less_than_seeds():
    data = gas(0.3).drop_vars("a20_dof")
    np.testing.assert_allclose(deviation_of(data, "a20", xr.DataArray(0.1)).dof, 3.0)


def test_points_that_are_not_steady_are_left_out():
    data = gas(0.3)
    steady = np.array([[1.0, 0.0, 1.0], [-1.0, 1.0, 1.0]])
    sample = deviation_of(data.assign(equilibrated=(("r", "beta"), steady)), "a20", data.r * 0.0)
    assert sample.size == 4
    with pytest.raises(NotTestedError, match="steady"):
        deviation_of(data.assign(equilibrated=0.0 * data.r), "a20", data.r)
    with pytest.raises(NotTestedError, match="no a02"):
        deviation_of(data, "a02", data.r)


def test_a_theory_is_evaluated_at_each_point_of_the_grid_and_along_dimensions():
    data = reduced("vibrated", **POINTS, third=("friction.mu", (0.1, 0.3)))
    data = data.assign_coords(lag=[1.0, 2.0, 4.0])
    result = theory_over_grid(
        data, lambda at: at["r"] + 10 * at["beta"] + 100 * at["mu"] * data.lag.values, ("lag",)
    )
    assert result.dims == ("mu", "r", "beta", "lag")
    at = {"mu": 0.3, "r": 0.9, "beta": -0.5, "lag": 4.0}
    assert float(result.sel(at)) == pytest.approx(0.9 - 5.0 + 120.0)


def test_the_ratio_of_temperatures_of_species_is_that_of_the_rate_equations():
    data = mixed("cooling", ("species.second.mass", (1.0, 4.0)), r=(0.9,), beta=(0.0, 0.5))
    ratio = species_temperature_ratio(data)
    point = {"r": 0.9, "beta": 0.5, "mass": 4.0}
    first, second = mixture_cooling(*mixture_at(data.attrs, point)).T_tr
    assert float(ratio.sel(point)[1]) == pytest.approx(second / first)
    assert np.isnan(ratio.isel(species=0)).all()
    sample = deviation_of(data, "T_ratio_species", ratio, relative=True)
    assert sample.size == 4 and set(sample.coordinates["species"]) == {"second"}
    np.testing.assert_allclose(sample.value, 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("value", "error", "refuted", "relative", "verdict"),
    [
        (0.115, 0.001, 0.06, False, HOLDS),
        (0.15, 0.001, 0.06, False, QUALIFIED),
        (0.17, 0.001, 0.06, False, FAILS),
        (0.115, 0.001, 0.3, True, QUALIFIED),  # 15 % of theory
        (0.115, 0.001, 0.06, True, FAILS),
        (0.1, 0.03, 0.06, False, NOT_TESTED),
    ],
)
def test_a_statement_compares_a_variable_with_theory_py(
    tmp_path, value, error, refuted, relative, verdict
):
    (tmp_path / "claims.yaml").write_text(
        STATEMENT.format(refuted=refuted, relative=str(relative).lower())
    )
    (tmp_path / "theory.py").write_text(THEORY)
    (statement,) = read_study(tmp_path, "title", ()).statements
    assert examine(statement, {"cooling": gas(value, error)}).verdict == verdict


@pytest.mark.parametrize("text", [THEORY.replace("a20", "a02"), None])
def test_a_variable_without_theory_is_refused(tmp_path, text):
    (tmp_path / "claims.yaml").write_text(STATEMENT.format(refuted=0.06, relative="false"))
    if text:
        (tmp_path / "theory.py").write_text(text)
    with pytest.raises(InputError, match=r"kurtosis: variable.*a20.*be a function of theory\.py"):
        read_study(tmp_path, "title", ())


def test_the_theory_of_an_angle_is_a_third_where_nothing_is_correlated():
    spheres = reduced("cooling_spheres", r=(1.0, 0.8), beta=(0.0, 1.0))
    angle = module_of_study("brilliantov_2007", "theory").cos2_angle(spheres)
    assert float(angle.sel(r=1.0, beta=1.0)) == pytest.approx(1 / 3, abs=1e-12)
    state = theory.sonine_state(0.8, 0.0, 3, 0.4)
    assert float(angle.sel(r=0.8, beta=0.0)) == pytest.approx(1 / 3 + 0.12 * float(state.alignment))


def test_the_angle_of_an_alignment_is_its_integral_over_a_distribution():
    """<cos^2> - 1/3 over the alignment of f = M(V) M(w) [1 + b V^2 w^2 P_2(cos)], by quadrature."""
    speed, weight = np.polynomial.hermite_e.hermegauss(40)
    radial = speed**2 * weight  # of one component: V^2 exp(-V^2/2) is even
    cos, of_cos = np.polynomial.legendre.leggauss(20)
    V2, w2, x = (speed**2)[:, None, None], (speed**2)[None, :, None], cos[None, None, :]
    density = radial[:, None, None] * radial[None, :, None] * of_cos[None, None, :]
    density = density * (1.0 + 0.01 * V2 * w2 * (1.5 * x**2 - 0.5))
    mean_cos2 = (density * x**2).sum() / density.sum()
    alignment = 3.0 * (density * V2 * w2 * x**2).sum() / (density * V2 * w2).sum() - 1.0
    factor = module_of_study("brilliantov_2007", "theory").ANGLE_OF_ALIGNMENT
    assert (mean_cos2 - 1 / 3) / alignment == pytest.approx(factor, rel=1e-9)
