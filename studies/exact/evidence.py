"""Exact results and theories next to our measurements, as rows of evidence."""

import math
from collections.abc import Callable, Iterator
from functools import partial

import xarray as xr

from roughgas import theory
from roughgas.judging import Estimate, Row, references

from . import published

NAMES = {2: "disks", 3: "spheres"}
DSMC = "direct simulation Monte Carlo of this package"
CLISBY = "Clisby & McCoy 2006, doi:10.1007/s10955-005-8080-0"
HENDERSON = "Henderson 1975, doi:10.1080/00268977500102511"
CARNAHAN = "Carnahan & Starling 1969, doi:10.1063/1.1672048"
WALTON = "Walton 1993, in Particulate Two-Phase Flow, p. 884"
CORIOLIS = "Coriolis 1835, Theorie mathematique des effets du jeu de billard"
HUTHMANN = "Huthmann & Zippelius 1997, doi:10.1103/PhysRevE.56.R6275"
HAFF = "Haff 1983, doi:10.1017/S0022112083003419"
MARTIN = "Martin & Piasecki 1999, Europhys. Lett. 46, 613"
VAN_NOIJE = "van Noije & Ernst 1998, doi:10.1007/s100350050009"
MONTANERO = "Montanero & Santos 2000, Granular Matter 2, 53; Coppex et al. 2003, Physica A 329, 114"
CHAPMAN = "Chapman & Cowling 1970, The Mathematical Theory of Non-uniform Gases"
MEGIAS = "Megias & Santos 2023, doi:10.1103/PhysRevE.108.014902"
SANTOS = "Santos, Kremer & Garzo 2010, Prog. Theor. Phys. Suppl. 184, 31"
PATHAK = "Pathak, Das & Rajesh 2014, arXiv:1407.0855"
TRITTEL = "Trittel et al. 2024, doi:10.1038/s41526-024-00420-5"
PIDDUCK = "Pidduck 1922, Proc. R. Soc. A 101, 101"
ROUNDING = "ours is the worst of hundreds; its error is that of rounding, taken as 1e-11 of it"
CLOSED_FORM = "closed form"
FIXED_NUMBER = "as the number is fixed (Lebowitz & Percus 1961)"
SONINE = "linear in a2, and a3 is left out"


class Gas:
    """The measured quantities of one gas."""

    def __init__(self, data: xr.Dataset, task: str) -> None:
        self._data, self.task = data, task
        self.kind, *parameters = task.split("_")
        self.parameters = [float(text) for text in parameters]

    def number(self, quantity: str) -> Estimate:
        """Return the mean of a quantity over runs, with its error."""
        of_task = self._data.isel(number=(self._data.task == self.task).values)
        row = of_task.isel(number=(of_task.quantity == quantity).values).squeeze("number")
        return Estimate(float(row.value), float(row.value_stderr), float(row.runs) - 1.0)


def rows(data: xr.Dataset) -> list[Row]:
    """Return a row for every quantity with a closed form or a theory: exact ones first, and rows of
    one comparison next to each other."""
    gases = [Gas(data, str(task)) for task in data.task_name.values]
    all_rows = [row for gas in gases for row in ROWS_OF_KIND[gas.kind](gas, data)] + _experiment(
        gases
    )
    order = list(dict.fromkeys(map(_comparison, all_rows)))
    return sorted(all_rows, key=lambda row: (row.tier != "exact", order.index(_comparison(row))))


def _comparison(row: Row) -> tuple[str, str, str]:
    return row.quantity, row.tier, row.source


def _parameters_text(dimension: float, **parameters: float) -> str:
    """Return the text of a state, such as "spheres, r = 0.9"."""
    return ", ".join(
        [NAMES[int(dimension)], *(f"{name} = {x:g}" for name, x in parameters.items())]
    )


def _exact_value(value: float) -> Estimate:
    """Return the value of a closed form as an Estimate without error."""
    return Estimate(value, 0.0)


def _fluid(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    dimension, packing = int(gas.parameters[0]), gas.parameters[1]
    state = _parameters_text(dimension, packing=packing)
    exact = published.compressibility(packing, dimension)
    missing = published.fixed_number_correction(packing, dimension) / data.attrs["particles"]
    series = {"tier": "exact", "source": CLISBY, "theirs": exact}
    series |= {"read": "virial series to B_10 (Table 1), its tail taken as geometric"}
    closed = {"tier": "theory", "source": HENDERSON if dimension == 2 else CARNAHAN}
    approximate = _exact_value(published.approximate_compressibility(packing, dimension))
    closed |= {"read": CLOSED_FORM, "theirs": approximate}
    methods = {"stress": "momentum transfer", "collisions": "the collision rate"}
    for name, comparison in (("stress", series), ("collisions", series), ("stress", closed)):
        measured = gas.number(f"Z_{name}")
        yield Row(
            quantity=f"compressibility factor Z from {methods[name]}",
            at=state,
            ours=measured._replace(value=measured.value + missing),
            corrections=f"D (N - 1) translational degrees of freedom, and {FIXED_NUMBER}: "
            f"{missing:+.5f}",
            **comparison,
        )
    volumes = 2.0 ** (dimension - 1) * packing
    yield Row(
        quantity="pair correlation at contact",
        at=state,
        tier="exact",
        source=CLISBY,
        read="(Z - 1)/(2^(D - 1) packing), of the virial series",
        theirs=exact._replace(value=exact.value - 1.0).scaled(1.0 / volumes),
        ours=gas.number("contact_value"),
        corrections="N (N - 1)/2 pairs; extrapolated by a parabola from [2a, 2.5a]",
    )


def _contacts(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    dimension = int(gas.parameters[0])
    q = theory.moment_of_inertia(dimension)
    settings = {name: data.attrs[name] for name in ("restitution", "roughness", "mu")}
    r, beta, mu = settings.values()
    limit = (1.0 + 1.0 / q) * mu * (1.0 + r) / (1.0 + beta)
    closed_forms = {
        "restitution": ("normal restitution of a contact", r, "-g_n'/g_n = r"),
        "roughness": ("tangential restitution of a sticking contact", beta, "-g_t'/g_t = beta_0"),
        "friction": ("tangential over normal impulse of a sliding contact", mu, "J_t/J_n = mu"),
        "threshold": (
            "g_t/g_n from which contacts slide",
            limit,
            "(1 + 1/q) mu (1 + r)/(1 + beta_0); ours is mu (g_t/g_n)/(J_t/J_n) of those that stick",
        ),
        "turn": ("change of spin over the impulse's torque", 1.0, "q m a^2 (w' - w) = -a n x J"),
    }
    state = _parameters_text(dimension, r=r, beta_0=beta, mu=mu)
    for partner, partners in {"pair": "pairs", "wall": "walls that move"}.items():
        for name, (quantity, value, read) in closed_forms.items():
            yield Row(
                quantity=quantity,
                at=f"{state}, {partners}",
                tier="exact",
                source=WALTON,
                read=read,
                theirs=_exact_value(value),
                ours=gas.number(f"{name}_{partner}"),
                corrections=ROUNDING,
            )
    yield Row(
        quantity="speed at which a sliding particle begins to roll, over its first speed",
        at=_parameters_text(dimension, q=q),
        tier="exact",
        source=CORIOLIS,
        read="1/(1 + q): angular momentum about the point of contact is conserved",
        theirs=_exact_value(1.0 / (1.0 + q)),
        ours=gas.number("rolling"),
        corrections=ROUNDING,
    )


def _rates(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    dimension, r, beta, theta = gas.parameters
    q = theory.moment_of_inertia(int(dimension))
    exact = published.first_rates(int(dimension), r, beta, theta, q)
    quantities = {
        "loss": "first loss of T_tr from equilibrium, -dT_tr/dn over T_tr",
        "gain": "first gain of T_rot from equilibrium, dT_rot/dn over T_tr",
    }
    for (name, quantity), value in zip(quantities.items(), exact, strict=True):
        if name == "gain" and beta == -1.0:
            continue  # smooth particles keep their spins
        yield Row(
            quantity=quantity,
            at=_parameters_text(dimension, r=r, beta=beta, theta=theta),
            tier="exact",
            source=HUTHMANN,
            read="rate equations, n in collisions per particle; exact for Maxwellians",
            theirs=_exact_value(value),
            ours=gas.number(name),
            corrections="D (N - 1) translational degrees of freedom",
        )


def _tracer(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    r, mass = gas.parameters
    share = data.attrs["tracers"]
    species = [
        {"fraction": 1.0 - share, "name": "elastic"},
        {"fraction": share, "mass": mass, "name": "tracer"},
    ]
    pairs = [{"between": ["elastic", "tracer"], "restitution": r}]
    finite = theory.mixture_cooling(theory.mixture(species, 1.0, -1.0, 3, pairs=pairs)).T_tr
    exact, measured = published.tracer_ratio(r, mass), gas.number("ratio")
    shift = exact - float(finite[1] / finite[0])
    yield Row(
        quantity="T_0/T of a smooth tracer among elastic spheres",
        at=f"r = {r:g}, mass {mass:g}",
        tier="exact",
        source=MARTIN,
        read="(1 + r)/(2 + (1 - r) m/M)",
        theirs=_exact_value(exact),
        ours=measured._replace(value=measured.value + shift),
        corrections=(
            f"{shift:+.4f} as {100 * share:g} % are tracers and the gas cools, by the theory of "
            "mixtures; no total momentum"
        ),
    )


def _haff(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    dimension, r, beta = gas.parameters
    state = _parameters_text(dimension, r=r, beta=beta)
    yield Row(
        quantity="exponent p of T ~ t^-p of a homogeneous cooling gas",
        at=state,
        tier="exact",
        source=HAFF,
        read="2, as nothing but T sets the time",
        theirs=_exact_value(2.0),
        ours=gas.number("exponent"),
        corrections=f"none; {DSMC}",
    )
    yield Row(
        quantity="decay rate -d ln T/dn of a homogeneous cooling gas",
        at=state,
        tier="theory",
        source=HUTHMANN,
        read="rate equations of Maxwellian velocities, stationary T_rot/T_tr",
        theirs=_exact_value(float(theory.decay_rate(r, beta, int(dimension)))),
        ours=gas.number("decay"),
        corrections=f"none, N - 1 would be 0.05 %; {DSMC}",
        reason="velocities and spins are not Maxwellian",
    )


Formula = Callable[[int, float], float]


def _sonine(gas: Gas, theories: dict[str, Formula], drive: str, note: str) -> Iterator[Row]:
    dimension, r = int(gas.parameters[0]), gas.parameters[1]
    for source, formula in theories.items():
        yield Row(
            quantity=f"a2 of a smooth {drive} gas",
            at=_parameters_text(dimension, r=r),
            tier="theory",
            source=source,
            read=CLOSED_FORM,
            theirs=_exact_value(formula(dimension, r)),
            ours=gas.number("a2"),
            corrections=note,
            reason=SONINE,
        )


def _cooling(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    theories = {VAN_NOIJE: published.sonine_cooling, MONTANERO: published.sonine_cooling_closer}
    return _sonine(gas, theories, "cooling", f"2/(D N) of the sample's own energy; {DSMC}")


def _noise(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    theories = {VAN_NOIJE: published.sonine_driven}
    return _sonine(gas, theories, "white-noise driven", "2/(D N) of the sample's own energy")


def _tail(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    dimension, r, driven = int(gas.parameters[0]), gas.parameters[1], bool(gas.parameters[2])
    slope, bend = gas.number("tail"), gas.number("bend").value
    finite, a2 = (
        published.grazing_correction(dimension, r, driven) * bend,
        round(gas.number("a2").value, 4),
    )
    law, drive = (
        ("exp(-A c^(3/2))", "driven by white noise") if driven else ("exp(-A c)", "cooling")
    )
    yield Row(
        quantity=f"A of the tail {law} of a smooth gas {drive}, c = v/sqrt(2 T/m)",
        at=_parameters_text(dimension, r=r, a2=a2),
        tier="exact",
        source=VAN_NOIJE,
        read="what is lost of fast particles over the cooling, with the measured a2; c to infinity",
        theirs=_exact_value(published.tail(dimension, r, a2, driven)),
        ours=Estimate(slope.value, math.hypot(slope.stderr, finite)),
        corrections=f"none; our error has the first term in 1/c, {finite:.2f}, beside chance, "
        f"{slope.stderr:.2f}; from where a Maxwellian is {'1.2' if driven else '1.6'} times as "
        f"steep as A; {DSMC}",
    )


def _rough(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    dimension, r, beta = gas.parameters
    state = theory.sonine_state(r, beta, int(dimension))
    for name in ("R", "a20", "a11", "a02"):
        yield Row(
            quantity=f"{name} of a rough cooling gas",
            at=_parameters_text(dimension, r=r, beta=beta),
            tier="theory",
            source=MEGIAS,
            read="Sonine approximation, first order in cumulants; collision integrals derived anew",
            theirs=_exact_value(float(getattr(state, name))),
            ours=gas.number(name),
            corrections=f"none; {DSMC}",
            reason="higher cumulants, and squares of these",
        )


def _experiment(gases: list[Gas]) -> list[Row]:
    """Return the row of an experiment whose r and beta are unknown, against the range of all rough
    spheres that cool."""
    spheres = [gas for gas in gases if gas.kind == "rough" and gas.parameters[0] == 3]
    theta = [R / (1.0 - R) for R in (gas.number("R").value for gas in spheres)]
    if not theta:
        return []
    low, high = min(theta), max(theta)
    row = Row(
        quantity="T_rot/T_tr of spheres that cool in microgravity",
        at="r and beta not known to us",
        tier="experiment",
        source=TRITTEL,
        read='abstract: rotation is excited "only to roughly 2/3" of translation',
        theirs=Estimate(2.0 / 3.0, math.nan),
        ours=Estimate(0.5 * (low + high), math.nan),
        corrections=f"none; ours is the middle of {low:.2f} to {high:.2f} of those above",
        reason="a shaken box sets the ratio; what r, beta and friction were is not in the abstract",
    )
    return [row]


def _clusters(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    r, beta = gas.parameters
    for name, exponent in (("translation", 1.0), ("rotation", 1.6)):
        yield Row(
            quantity=f"exponent of time in the cooling of {name} while clusters grow",
            at=_parameters_text(2, r=r, beta=beta),
            tier="simulation",
            source=PATHAK,
            read="abstract: close to this at all r and beta, error not given there",
            theirs=Estimate(exponent, math.nan),
            ours=gas.number(name),
            corrections="none",
            reason="ours is between 40 and 150 collisions per particle: they may mean later times",
        )


def _mixture(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    r, beta, theta, mass, radius = gas.parameters
    species = [{"fraction": 0.5}, {"fraction": 0.5, "mass": mass, "radius": radius}]
    crowding = theory.mixture_contact_values(
        theory.mixture(species, r, beta, 3), data.attrs["mixed"]
    )
    exact = published.mixture_rates(r, beta, theta, mass, radius, crowding)
    both = f"of masses 1, {mass:g} and radii 1, {radius:g}"
    for name, value in exact.items():
        change = "loss of T_tr" if name.startswith("loss") else "gain of T_rot"
        yield Row(
            quantity=f"first {change} of a species in a mixture, over T_tr",
            at=f"{_parameters_text(3, r=r, beta=beta, theta=theta)}, species {name[-1]} {both}",
            tier="exact",
            source=SANTOS,
            read="energy production rates, n in collisions per particle; exact for Maxwellians",
            theirs=_exact_value(float(value)),
            ours=gas.number(name),
            corrections="D (N - 1) translational degrees of freedom",
        )


def _diffusion(gas: Gas, data: xr.Dataset) -> Iterator[Row]:
    dimension = int(gas.parameters[0])
    smooth = gas.number("smooth").scaled(1.0 / published.diffusion(dimension))
    q = theory.moment_of_inertia(dimension)
    row_of_gas = partial(
        Row, at=NAMES[dimension], corrections=f"1/N of the others' velocities; {DSMC}"
    )
    of_smooth = partial(
        row_of_gas,
        "self-diffusion of smooth elastic particles, D nu/T over D/2",
        source=CHAPMAN,
        ours=smooth,
    )
    yield of_smooth(tier="theory", read="first approximation", theirs=_exact_value(1.0))
    for row in references(__file__):
        if row["quantity"] == "diffusion" and int(row["dimension"]) == dimension:
            theirs = Estimate(float(row["value"]), float(row["stderr"]))
            yield of_smooth(tier="exact", read=row["read"], theirs=theirs)
    yield row_of_gas(
        "self-diffusion of perfectly rough over smooth elastic particles",
        tier="theory",
        source=PIDDUCK,
        read="first approximation: spheres (1 + q)/(1 + 2 q); disks by the same steps",
        theirs=_exact_value(published.rough_diffusion(dimension, q)),
        ours=gas.number("rough_over_smooth"),
        reason="higher polynomials, and velocities with which contacts have correlated spins",
    )


ROWS_OF_KIND: dict[str, Callable[[Gas, xr.Dataset], Iterator[Row]]] = {
    "fluids": _fluid,
    "contacts": _contacts,
    "rates": _rates,
    "tracers": _tracer,
    "haff": _haff,
    "cooling": _cooling,
    "noise": _noise,
    "diffusion": _diffusion,
    "tails": _tail,
    "rough": _rough,
    "mixtures": _mixture,
    "clusters": _clusters,
}
