"""The study of exact results: closed forms in other ways, single contacts, and the rows."""

import math
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from tests.show.figures.legibility import faults
from tests.studies.small_runs import task_run
from tests.studies.small_studies import SMALL_STUDIES
from tests.study_modules import module_of_study

from roughgas import theory
from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED
from roughgas.results.comparison import TIERS
from roughgas.results.row_verdicts import DIFFERS, verdicts

runs, results, published = (
    module_of_study("exact", name) for name in ("tasks", "results", "published")
)
evidence, judges, contacts = (
    module_of_study("exact", name) for name in ("evidence", "judges", "contacts")
)
homogeneous = module_of_study("exact", "homogeneous")
events, draw = module_of_study("exact", "events"), module_of_study("exact", "figure").draw
SETTINGS = SMALL_STUDIES["exact"].settings
MATERIAL = SETTINGS["contacts"]
DIFFUSION_RATIO = {2: 1.02709, 3: 1.01895}
"""Self-diffusion of smooth particles with all polynomials, over its first approximation."""
both = pytest.mark.parametrize("dimension", [2, 3])


@both
def test_the_correction_for_a_fixed_number(dimension):
    """In a thin gas all N (N - 1)/2 pairs are independent: Z - 1 is too low by the share 1/N. In a
    denser gas the derivatives agree with differences."""
    thin = 1e-4
    expected = 2 ** (dimension - 1) * thin
    assert published.fixed_number_correction(thin, dimension) == pytest.approx(expected, rel=2e-3)
    x = 0.2 + 1e-3 * np.arange(-1, 2)
    low, middle, high = (y * (published.compressibility(y, dimension).value - 1) for y in x)
    slope, curvature = (high - low) / 2e-3, (high - 2 * middle + low) / 1e-6
    expected = 0.2 * curvature / (2 * (1 + slope))
    assert published.fixed_number_correction(0.2, dimension) == pytest.approx(expected, rel=1e-3)


def test_self_diffusion_of_smooth_particles_is_the_published_one():
    rows = [row for row in evidence.references(evidence.__file__) if row["quantity"] == "diffusion"]
    assert {int(row["dimension"]): float(row["value"]) for row in rows} == DIFFUSION_RATIO


def test_rates_of_mixtures_in_the_notation_of_others():
    """Compared with the package's own derivation, per contact of a particle."""
    for parameters in ([0.8, 0.0, 0.5, 4.0, 1.5], [0.7, 0.5, 0.0, 0.5, 1.0]):
        gas, T = theory.mixture(two_species(*parameters[3:]), *parameters[:2], 3), np.ones(2)
        chi = crowding(parameters)
        falls, rises = theory.mixture_changes(gas, T, parameters[2] * T, chi)
        nu = 2.5066282746310002 * chi * gas.distance**2 * np.sqrt(np.add.outer(*2 * [1 / gas.mass]))
        contacts_each = nu.sum(axis=1).mean()  # half of the others are of each species
        rates = published.mixture_rates(*parameters, chi)
        expected = np.concatenate([-falls, rises]) / contacts_each
        assert list(rates.values()) == pytest.approx(list(expected), rel=1e-12)


def test_the_tail_of_a_histogram():
    """With a factor c^-p, which `bend` reveals."""
    middle = (homogeneous.SPEEDS[1:] + homogeneous.SPEEDS[:-1]) / 2
    volume = np.diff(homogeneous.SPEEDS**3)
    for law, A, p in ((1.0, 3.7, 0.5), (1.5, 1.8, 0.2)):
        counts = 1e12 * volume * middle**-p * np.exp(-A * middle**law)
        slope, bend = homogeneous.tail_slope(counts, 3, law == 1.5, 3.0)
        assert slope - p * bend == pytest.approx(A, rel=1e-9) and 0 < p * bend < 0.1 * A


@both
def test_ratios_of_contacts_by_waltons_rule(dimension):
    """Contacts by Walton's rule, written anew, have the ratios of their settings."""
    rng, q = np.random.default_rng(7), theory.moment_of_inertia(dimension)
    observed = []
    for _ in range(50):
        v, w, n = rng.standard_normal((3, 3))
        if dimension == 2:
            v[2] = n[2] = w[0] = w[1] = 0
        n /= np.linalg.norm(n)
        n *= -math.copysign(1, v @ n)
        g = v - np.cross(w, n)
        g_n, g_t = (g @ n) * n, g - (g @ n) * n
        beta = min(0.2, -1 + 0.3 * 1.9 * (1 + 1 / q) * np.linalg.norm(g_n) / np.linalg.norm(g_t))
        J = -1.9 * g_n / 2 - q * (1 + beta) / (2 * (1 + q)) * g_t
        turn = -np.cross(n, J) / q
        after = g + 2 * J - 2 * np.cross(turn, n)
        observed.append(contacts.Contact(False, n, J, turn, g, after))
    ratios = contacts._closed_form_ratios(observed, MATERIAL, dimension)
    expected = {"restitution": 0.9, "roughness": 0.2, "friction": 0.3, "turn": 1, "misplaced": 0}
    for name, value in expected.items():
        assert ratios[name].size and ratios[name] == pytest.approx(value, abs=1e-11)
    assert ratios["threshold"] == pytest.approx((1 + 1 / q) * 0.3 * 1.9 / 1.2, rel=1e-11)


def test_pairs_agree_with_all_distances():
    rng, box = np.random.default_rng(8), np.array([9.0, 7.0, 8.0])
    position = rng.uniform(0, box, (60, 3))
    away = position[:, None] - position
    away -= box * np.rint(away / box)
    distance = np.sqrt((away**2).sum(axis=-1))[np.triu_indices(60, 1)]
    assert list(events._count_pairs(position, box)) == list(
        np.histogram(distance, events.SHELLS)[0]
    )
    touching = np.array([[1.0, 1.0, 1.0], [3.0, 1.0, 1.0], [1.0, 3.02, 1.0]])
    assert events._count_pairs(touching, box).sum() == 1


def two_species(mass, radius):
    return [{"fraction": 0.5}, {"fraction": 0.5, "mass": mass, "radius": radius}]


def crowding(parameters):
    gas = theory.mixture(two_species(*parameters[3:]), *parameters[:2], 3)
    return theory.mixture_contact_values(gas, 0.01)


def exact_numbers(task):
    """Return the quantities that a gas would show if all published values were right, without
    finite-size effects."""
    kind, *parameters = task.split("_")
    parameters = [float(text) for text in parameters]
    dimension = int(parameters[0])
    q = theory.moment_of_inertia(dimension) if dimension in (2, 3) else None
    if kind == "contacts":
        limit = (1 + 1 / q) * 0.3 * 1.9 / 1.2
        values = {"restitution": 0.9, "roughness": 0.2, "friction": 0.3, "threshold": limit}
        values |= {"turn": 1.0, "misplaced": 0.0}
        by_partner = {
            f"{name}_{partner}": x for name, x in values.items() for partner in ("pair", "wall")
        }
        return by_partner | {"rolling": 1 / (1 + q)}
    if kind == "fluids":
        Z = published.compressibility(parameters[1], dimension).value
        short = (
            published.fixed_number_correction(parameters[1], dimension)
            / SETTINGS["fluids"]["particles"]
        )
        contact = (Z - 1) / (2 ** (dimension - 1) * parameters[1])
        return {"Z_stress": Z - short, "Z_collisions": Z - short, "contact_value": contact}
    if kind == "rates":
        return dict(
            zip(("loss", "gain"), published.first_rates(dimension, *parameters[1:], q), strict=True)
        )
    if kind == "tracers":
        # to rounding, the theory of mixtures for one tracer of a hundred
        species = [
            {"fraction": 0.99, "name": "a"},
            {"fraction": 0.01, "mass": parameters[1], "name": "b"},
        ]
        pairs = [{"between": ["a", "b"], "restitution": parameters[0]}]
        T = theory.mixture_cooling(theory.mixture(species, 1, -1, 3, pairs=pairs)).T_tr
        return {"ratio": float(T[1] / T[0])}
    if kind == "haff":
        return {"exponent": 2.0, "decay": float(theory.decay_rate(*parameters[1:], dimension))}
    if kind == "diffusion":
        rough = published.rough_diffusion(dimension, q)
        return {"smooth": DIFFUSION_RATIO[dimension] * dimension / 2, "rough_over_smooth": rough}
    if kind == "tails":
        tail = published.tail(dimension, parameters[1], 0.1, bool(parameters[2]))
        return {"tail": tail, "bend": 0.3, "a2": 0.1}
    if kind == "rough":
        state = theory.sonine_state(*parameters[1:], dimension)
        return {name: float(getattr(state, name)) for name in ("R", "a20", "a11", "a02")}
    if kind == "clusters":
        return {"translation": 1.0, "rotation": 1.6}
    if kind == "mixtures":
        return published.mixture_rates(*parameters, crowding(parameters))
    formula = published.sonine_cooling if kind == "cooling" else published.sonine_driven
    return {"a2": formula(dimension, parameters[1])}


def measured(**shifts):
    """Return the combined dataset of such gases, each quantity with an error of 1e-4 (contacts:
    1e-14), and some off by `shifts`."""
    task_results = {}
    for task in runs.tasks(SETTINGS):
        is_contact = task.startswith("contacts")
        noise = (1e-14 if is_contact else 2e-4) * np.array([-1.0, -1.0, 1.0, 1.0]) * math.sqrt(0.75)
        task_results[task] = xr.Dataset({"seconds": 0.0})
        for name, value in exact_numbers(task).items():
            off = value + shifts.get(name, 0.0)
            spread = 0.0 if name.startswith("misplaced") else noise
            task_results[task][name] = (
                f"contact_{name}" if is_contact else "run",
                off + spread + 0.0 * noise,
            )
    return results.combine(task_results, SETTINGS)


def test_every_quantity_has_its_rows():
    data = measured()
    rows = evidence.rows(data)
    comparisons = [(row.quantity, row.tier, row.source) for row in rows]
    changes = sum(a != b for a, b in pairwise(comparisons))
    assert changes == len(set(comparisons)) - 1  # rows of a comparison are neighbours
    assert len(rows) == 59 and {row.tier for row in rows} <= set(TIERS)
    # D is 1.019 of the first approximation, and Z is from the virial series
    off = [row for row, verdict in zip(rows, verdicts(rows), strict=True) if verdict == DIFFERS]
    assert {row.tier for row in off} == {"theory"}
    assert {row.quantity.split()[0] for row in off} == {"compressibility", "self-diffusion"}


@pytest.mark.parametrize(
    ("shifts", "verdict"), [({}, HOLDS), ({"Z_stress": 0.001}, QUALIFIED), ({"ratio": 0.01}, FAILS)]
)
def test_deviations_from_exact_results_are_judged(shifts, verdict):
    data = measured(**shifts)
    finding = judges.meets_exact_results(data)
    assert finding.verdict == verdict
    rows = [row for row in evidence.rows(data) if row.tier == "exact"]
    assert sum(row.gap.is_significant for row in rows) == int(finding.reason.split()[0])


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.25, FAILS)])
def test_a_contact_on_the_wrong_side_fails(shift, verdict):
    finding = judges.slides_beyond_threshold(measured(misplaced_pair=shift))
    assert finding.verdict == verdict and finding.reason.startswith("Of 16 contacts")


def test_the_figure_is_legible():
    assert faults(lambda: draw(measured())) == []


HOMOGENEOUS = ("cooling", "haff", "diffusion", "rough")
WITHIN = {"a2": 0.02, "exponent": 0.02, "decay": 0.01, "smooth": 0.15, "rough_over_smooth": 0.1}
WITHIN |= {"R": 0.01, "a20": 0.02, "a11": 0.04, "a02": 0.1}
"""Some 5 standard errors of runs of the small scale."""


@pytest.mark.parametrize("kind", HOMOGENEOUS)
def test_gases_without_positions(kind):
    for task in runs.tasks(SETTINGS):
        if task.startswith(kind):
            result = task_run("exact", task).result
            for name, value in exact_numbers(task).items():
                assert float(result[name].mean()) == pytest.approx(value, abs=WITHIN[name])


@pytest.mark.slow
def test_tails_without_positions():
    """A deviation of the slope below 0.4, some 4 standard errors; Maxwellians are off by 1.6 and
    0.3."""
    for dimension, r, driven in SETTINGS["tails"]["gases"]:
        task = runs.name_of("tails", dimension, r, driven)
        averages = task_run("exact", task).result.mean()
        expected = published.tail(dimension, r, float(averages.a2), driven)
        assert float(averages["tail"]) == pytest.approx(expected, abs=0.4)


@pytest.mark.slow  # compiles a kernel
def test_clusters_cool_by_other_laws():
    """Haff's law would have the exponents 2 and 2, with a constant ratio of energies."""
    averages = task_run("exact", "clusters_0.8_0").result.mean()
    assert averages.translation < 1.8 and averages.rotation > averages.translation + 0.2


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["noise", "fluids", "tracers", "rates", "mixtures"])
def test_gases_by_events(kind):
    """Each within 6 standard errors, of three runs, or 3 %."""
    for task in runs.tasks(SETTINGS):
        if task.startswith(kind):
            result = task_run("exact", task).result
            for name, value in exact_numbers(task).items():
                average = results.average(result[name])
                tolerance = max(6 * average.stderr, 0.03)
                assert average.value == pytest.approx(value, abs=tolerance)


@pytest.mark.slow
@both
def test_single_contacts(dimension):
    result = task_run("exact", f"contacts_{dimension}").result
    for name, value in exact_numbers(f"contacts_{dimension}").items():
        assert result[name].values == pytest.approx(value, rel=1e-9)
