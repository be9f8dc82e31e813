"""Registry of all variables of datasets: descriptions, dimensions and units.

Writers, the tables of docs/data.md, and `roughgas show` use it. Points and reduced datasets are
registered in this package, other datasets by the module that makes them.

Units: particle radius a = particle mass m = time unit T = 1. A freely cooling gas has no lasting
time scale: there, times are counted in collisions per particle, energies in the initial E_trans.
E_trans and E_rot are the energies per degree of freedom, R = E_rot/(E_rot + E_trans).

Flags are integers: 1 is yes, 0 no, -1 not known.
"""

from collections.abc import Collection, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import Attributes, Record

LENGTH = "a"
TIME = "T"
SPEED = "a/T"
ENERGY = "m a^2 T^-2"
RATE = "1/T"
START = "initial E_trans"
COOLING_UNITS = {TIME: "collisions per particle", ENERGY: START}
CLOCKS = ("time", "collisions_per_particle")
"""Coordinates of series, whose dimension has another name."""
GRID_PLACEHOLDER = "grid"
"""Placeholder for the dimensions of a reduced dataset: r, beta and any third axis."""

SPIN, COOLING, DRIVEN = "where particles spin", "cooling gas", "driven gas"
SHEARED, TARGET = "sheared gas", "with `target_stderr`"
WAIT = "driven gas with `relaxation_times`"
FLOWING = "sheared gas, or in a bath whose medium rotates"
CONTACT = "where the contact-time model acts"
STATE_KEPT = "with `keep_state`"
OF_SPEED = "whose r depends on the speed"
MIXTURE = "with `species`"
AT_CONTACTS = "driven gas with `contact_averages`"
STAGES = "gas through stages"
CONTACTS_LOGGED = "with `contact_log`"
BED = "driven gas under gravity"
SPINNERS = "driven gas in a bath whose medium rotates"


class Variable(NamedTuple):
    """Description of a variable of datasets: its long name, units, dimensions and conditions."""

    long_name: str
    units: str = "1"  # "" for words
    dims: tuple[str, ...] = ()
    dtype: str = "f8"  # or "str"
    when: tuple[str, ...] = ()  # conditions for datasets to have it; by default all have it
    over_seeds: str = "mean"  # how a reduced dataset combines a scalar: mean, sum, or "" for not
    flags: str = ""  # meanings of 0, 1, ..., in words; `unknown`, if present, is -1
    of_settings: bool = False  # in units of the settings even in a cooling gas
    observable: str = ""  # name of the observable that measured it
    comment: str = ""  # on its values

    def units_of(self, cooling: bool) -> str:
        """Return the units of the variable in a cooling gas, or else in a driven gas."""
        counted = cooling and not self.of_settings
        return COOLING_UNITS.get(self.units, self.units) if counted else self.units


class Array(NamedTuple):
    """A variable with its values; its fields are named as in xarray.Variable."""

    dims: tuple[str, ...]
    values: np.ndarray
    attrs: dict[str, Any]


def _series(long_name: str, units: str = "1", *when: str) -> Variable:
    """Return the description of a variable along `sample`: a value for each sampled instant."""
    return Variable(long_name, units, ("sample",), when=when)


PARTNER, INSTANT_AND_PARTNER = ("partner",), ("instant", "partner")


def _of_spin(long_name: str, units: str = "1", *conditions: str) -> Variable:
    """Return the description of a scalar variable that only gases with spinning particles have.

    `conditions` are further conditions on the gas.
    """
    return Variable(long_name, units, when=(*conditions, SPIN))


WITHIN, SCATTER = "within this file", "scatter over seeds"
POOLED = f"{SCATTER} and error within them, pooled"
"""Origins of standard errors, as descriptions."""


def error_of(name: str, origin: str, variable: Variable) -> Variable:
    """Return the description of the standard error of the variable `name`, described by `variable`.

    `origin` is the origin of the error in words, such as WITHIN.
    """
    long_name = f"standard error of {name}{'' if origin == WITHIN else ':'} {origin}"
    return variable._replace(long_name=long_name, dtype="f8", over_seeds="", flags="")


def errors_of(name: str, origin: str, variable: Variable) -> dict[str, Variable]:
    """Return descriptions of the standard error of `name`, its degrees of freedom and interval.

    They are by name: <name>_stderr, <name>_dof and <name>_ci95, the half width of the 95 %
    interval. `origin` is the origin of the error in words, such as WITHIN; `variable` describes
    `name` itself.
    """
    texts = {
        "dof": f"degrees of freedom that {name}_stderr is known with",
        "ci95": f"half width of the 95 % interval of {name}, by Student's t",
    }
    error = error_of(name, origin, variable)
    units = {"dof": "1", "ci95": error.units}
    return {f"{name}_stderr": error} | {
        f"{name}_{end}": error._replace(long_name=text, units=units[end])
        for end, text in texts.items()
    }


TRUSTED_SUFFIX = "_trusted"
"""Suffix of the flags for the verdict on a variable's error."""
TRUST = "unknown untrusted trusted"
"""Meanings of these flags."""


def trust_of(name: str, variable: Variable) -> Variable:
    """Return the description of the flags <name>_trusted: whether <name>_stderr is large enough.

    `variable` describes <name>, whose dimensions they have.
    """
    long_name = f"whether {name}_stderr is large enough; -1 where there is too little to tell"
    return variable._replace(long_name=long_name, units="1", dtype="i1", over_seeds="", flags=TRUST)


def share_of_trust(name: str) -> str:
    """Return the long name of the share of seeds whose error of the variable `name` is trusted."""
    error = f"{name}_stderr"
    return f"share of seeds whose {error} is large enough; -1 where most have too little to tell"


def _with_errors(name: str, long_name: str, when: str, units: str = "1") -> dict[str, Variable]:
    """Return descriptions of an average and of its errors, for gases of a condition.

    They are by name: <name>, its errors (`errors_of`) and <name>_trusted; `when` is the condition.
    """
    variable = Variable(long_name, units, when=(when,))
    errors = errors_of(name, WITHIN, variable)
    return {name: variable, **errors, f"{name}_trusted": trust_of(name, variable)}


SPECIES_VARIABLES = {  # in all kinds of datasets
    "species": Variable("name of the species", "", ("species",), "str", (MIXTURE,), over_seeds=""),
    "species_particles": Variable("particles of a species", "1", ("species",), "i8", (MIXTURE,)),
}


def _per_element(
    axis: str, condition: str, name: str, units: str, dims: tuple, *when: str, dtype: str = "f8"
) -> Variable:
    """Return the description of a variable along the dimension `axis`, for gases of a `condition`.

    `name` is its long name, `dims` its further dimensions, `when` further conditions.
    """
    return Variable(name, units, (axis, *dims), dtype, (condition, *when), of_settings=True)


_final_state, _contact_log_entry = (
    partial(_per_element, "replica", STATE_KEPT),
    partial(_per_element, "contact", CONTACTS_LOGGED),
)


def _of_species(name: str, long_name: str, units: str = "1", *when: str) -> dict[str, Variable]:
    """Return descriptions of a mean of each species, its error and, for energies, its series.

    They are by name: <name>, <name>_stderr, <name>_trusted and <name>_series.
    """
    variable = Variable(f"{long_name} of a species", units, ("species",), when=(MIXTURE, *when))
    variables = {name: variable, f"{name}_stderr": error_of(name, WITHIN, variable)}
    variables[f"{name}_trusted"] = trust_of(name, variable)
    if units == ENERGY:
        variables[f"{name}_series"] = variable._replace(dims=("species", "sample"))
    return variables


_IN_ROTATION = _of_spin("share of rotation in the energy, mean of E_rot / (E_rot + E_trans)")
_TRANSLATION = Variable("translational energy per degree of freedom", ENERGY)
_ROTATION = _of_spin("rotational energy per degree of freedom", ENERGY)
_MEAN_SPIN = "mean angular velocity times a, about the axis of the medium"
_INPUT = "energy per particle that a source has put in since the start (negative: taken out)"
_GAIN = "change of the energy per particle, kinetic and potential, since the start"


POINT_COORDINATES = {
    "r": Variable("normal restitution", over_seeds=""),
    "beta": Variable("tangential restitution", over_seeds=""),
    "seed": Variable("seed of the random generator", dtype="i8", over_seeds=""),
}
"""Coordinates of a point, which are the dimensions of a reduced dataset."""

POINT = {
    "R": _IN_ROTATION,
    **errors_of("R", WITHIN, _IN_ROTATION),
    "R_ci95_trusted": Variable(
        "whether R_ci95 holds the truth as often as it says; -1 where there is too little to tell",
        dtype="i1",
        when=(SPIN,),
        flags=TRUST,
    ),
    "R_ratio_of_means": _of_spin("share of rotation in the energy, from the mean energies"),
    "R_corrected": _of_spin(
        "R_ratio_of_means with D (N - 1) translational degrees of freedom in place of D N",
        "1",
        "momentum conserved",
    ),
    **_with_errors(
        "R_collisional", "share of rotation in the energy, averaged over collisions", AT_CONTACTS
    ),
    **_with_errors(
        "contact_correlation",
        "<v_t.v_r>/sqrt(<v_t^2> <v_r^2>), averaged over collisions",
        AT_CONTACTS,
    ),
    "E_trans": _TRANSLATION,
    "E_trans_stderr": error_of("E_trans", WITHIN, _TRANSLATION),
    "E_trans_trusted": trust_of("E_trans", _TRANSLATION),
    **_with_errors("vertical_share", "share of vertical motion in the translational energy", BED),
    "E_rot": _ROTATION,
    "E_rot_stderr": error_of("E_rot", WITHIN, _ROTATION),
    "E_rot_trusted": trust_of("E_rot", _ROTATION),
    "collisions": Variable("collisions simulated", dtype="i8", over_seeds="sum"),
    "kernel_seconds": Variable("CPU time spent in the kernel", "s", over_seeds="sum"),
    "equilibrated": Variable(
        "whether a steady state was found; -1 where there is too little to tell",
        dtype="i1",
        flags="unknown drifting equilibrated",
    ),
    "measured_from": Variable("begin of the measured window", TIME),
    "measured_collisions": Variable("collisions of each particle in the measured window"),
    "autocorrelation_time": _of_spin("integrated autocorrelation time of R", TIME),
    "memory_of_R": _of_spin("integrated autocorrelation time of R, by theory", TIME, DRIVEN),
    "slowest_relaxation": Variable(
        "e-fold of the slowest combination of the temperatures, by theory", TIME, when=(DRIVEN,)
    ),
    "flow_relaxation": Variable(
        "e-fold of the longest flow, or of the momentum in a bath, by theory", TIME, when=(DRIVEN,)
    ),
    "wait": Variable("wait that theory requires before the measurement", TIME, when=(WAIT,)),
    "wait_relaxations": Variable(
        "this wait in e-folds of the slowest transient, by theory as it ends", when=(WAIT,)
    ),
    "target_met": Variable(
        "whether R_stderr reached the target_stderr; -1 where there is too little to tell",
        dtype="i1",
        when=(TARGET,),
        flags="unknown missed met",
    ),
    "target_blocks": Variable(
        "how many times the measurement, or the replicas, that the schedule gives were run",
        when=(TARGET,),
    ),
    "contact_time": Variable(
        "contact time t_c of the contact-time model", TIME, when=(CONTACT,), of_settings=True
    ),
    "contact_time_fraction": Variable(
        "share of contacts changed by the contact-time model", when=(CONTACT,)
    ),
    "R_unsubtracted": _of_spin("R with the mean flow and the mean spin left in", "1", FLOWING),
    "E_trans_unsubtracted": Variable("E_trans with the mean flow left in", ENERGY, when=(FLOWING,)),
    "E_rot_unsubtracted": _of_spin("E_rot with the mean spin left in", ENERGY, FLOWING),
    **_with_errors("mean_spin", _MEAN_SPIN, SPINNERS, SPEED),
    "R_flow_shift": _of_spin("R over the local flow, less R over the mean flow", "1", SHEARED),
    "R_flow_sigma": _of_spin("sigmas by which R_flow_shift differs from 0", "1", SHEARED),
    "shear_rate": Variable(
        "gradient of the mean flow, by a straight line fitted to the velocities",
        RATE,
        when=("gas between walls that move along themselves",),
    ),
    "plateau_end": Variable("end of the plateau of R", TIME, when=(COOLING,)),
    "R_replica": Variable(
        "plateau mean of R of each replica", dims=("replica",), when=(COOLING, SPIN)
    ),
    "energy_imbalance": Variable("error of the energy balance, over all energy exchanged"),
    "source": Variable("what exchanged energy with the gas", "", ("source",), "str"),
    "motion": Variable("motion that holds the energy", "", ("motion",), "str"),
    "energy_input": Variable(_INPUT, ENERGY, ("source", "motion")),
    "input_spin_share": _of_spin(
        "share of rotation in the energy that all drives have put in", "1", DRIVEN
    ),
    "energy_gain": Variable(_GAIN, ENERGY, ("motion",)),
    **SPECIES_VARIABLES,
    **_of_species("E_trans_species", "translational energy per degree of freedom", ENERGY),
    **_of_species("E_rot_species", "rotational energy per degree of freedom", ENERGY, SPIN),
    **_of_species("R_species", "share of rotation in the energy", "1", SPIN),
    **_of_species("mean_spin_species", "mean spin", SPEED, SPINNERS),
    "time": _series("time since the start", TIME, DRIVEN, STAGES),
    "collisions_per_particle": _series("collisions per particle since the start", TIME, COOLING),
    "decay_exponent": Variable(
        "-d ln E_trans/d ln t over the second half of the samples", when=(COOLING, OF_SPEED)
    ),
    "time_series": Variable(
        "time since dissipation was switched on, mean over replicas",
        TIME,
        ("sample",),
        when=(COOLING, OF_SPEED),
        of_settings=True,
    ),
    "R_series": _series("share of rotation in the energy", "1", SPIN),
    "R_series_stderr": _series("standard error of R_series over replicas", "1", COOLING, SPIN),
    "E_trans_series": _TRANSLATION._replace(dims=("sample",)),
    "E_rot_series": _ROTATION._replace(dims=("sample",)),
    "mean_spin_series": _series(_MEAN_SPIN, SPEED, STAGES, SPINNERS),
    "collisions_series": _series("collisions per particle since the start", "1", STAGES),
    "energy_input_series": Variable(_INPUT, ENERGY, ("sample", "source", "motion"), when=(STAGES,)),
    "energy_gain_series": Variable(_GAIN, ENERGY, ("sample", "motion"), when=(STAGES,)),
    "stage_begin": Variable("time at which a stage begins", TIME, ("stage",), when=(STAGES,)),
    "stage_input": Variable(
        "energy per particle that the beginning of a stage puts in",
        ENERGY,
        ("stage", "motion"),
        when=(STAGES,),
    ),
    "last_time": _final_state("time since the start at which it ends", TIME, ()),
    "last_position": _final_state("position of a particle then", LENGTH, ("particle", "axis")),
    "last_velocity": _final_state(
        "velocity then of the image in the box", SPEED, ("particle", "axis")
    ),
    "last_spin": _final_state(
        "spin a w of a particle then", SPEED, ("particle", "spin_axis"), SPIN
    ),
    "last_radius": _final_state("radius of a particle", LENGTH, ("particle",), MIXTURE),
    "last_species_of": _final_state("number of its species, from 0", "1", ("particle",), MIXTURE),
    "last_memory": _final_state(
        "the kernel's arrays then, as they lie in memory", "1", ("byte",), dtype="u1"
    ),
    "contacts_lost": Variable(
        "contacts before the first one that is logged",
        dtype="i8",
        when=(CONTACTS_LOGGED,),
        over_seeds="",
    ),
    "instant": Variable("before or after a contact", "", ("instant",), "str", (CONTACTS_LOGGED,)),
    "logged_time": _contact_log_entry("time of a contact since the start", TIME, ()),
    "logged_partner": _contact_log_entry(
        "number of a partner from 0, as it is at the start; -1 is a floor or a wall",
        "1",
        PARTNER,
        dtype="i4",
    ),
    "logged_normal": _contact_log_entry(
        "unit vector from the second partner to the first", "1", ("axis",)
    ),
    "logged_position": _contact_log_entry("position of the first partner", LENGTH, ("axis",)),
    "logged_velocity": _contact_log_entry(
        "velocity of a partner, of the second as the image that the first touches",
        SPEED,
        (*INSTANT_AND_PARTNER, "axis"),
    ),
    "logged_spin": _contact_log_entry(
        "spin a w of a partner", SPEED, (*INSTANT_AND_PARTNER, "spin_axis"), SPIN
    ),
    "logged_species": _contact_log_entry(
        "number of a partner's species, from 0; -1 is a wall", "1", PARTNER, MIXTURE, dtype="i4"
    ),
    "logged_radius": _contact_log_entry("radius of a partner", LENGTH, PARTNER, MIXTURE),
    "logged_mass": _contact_log_entry("mass of a partner", "m", PARTNER, MIXTURE),
    "logged_inertia": _contact_log_entry(
        "moment of inertia of a partner over its m a^2", "1", PARTNER, MIXTURE
    ),
    **POINT_COORDINATES,
}

REGISTRY: dict[str, Mapping[str, Variable]] = {"point": POINT}
"""All variables by name, for each kind of dataset: point, reduced, trajectory, ..."""


def register(kind: str, variables: Mapping[str, Variable]) -> Mapping[str, Variable]:
    """Register the variables of a `kind` of dataset, such as "trajectory", and return them."""
    REGISTRY[kind] = variables
    return variables


def third_axis(attributes: Attributes) -> str | None:
    """Return the name of the third axis of a dataset, from its attributes; None without it.

    It is the swept setting beside r, beta and seed, without its effect: `inertia` for spin.inertia.
    """
    return attributes["swept"].rpartition(".")[2] if "swept" in attributes else None


def swept_axis(attributes: Attributes) -> dict[str, Variable]:
    """Return the description of the third axis of a dataset, by its name; {} without it.

    The third axis is the swept setting beside r, beta and seed. `attributes` are the dataset's,
    with `swept` and `swept_value`.
    """
    name = third_axis(attributes)
    if name is None or "swept_value" not in attributes:
        return {}
    units, dtype = ("", "str") if isinstance(attributes["swept_value"], str) else ("1", "f8")
    return {name: Variable(f"swept setting: {attributes['swept']}", units, dtype=dtype)}


def described(
    kind: str | Mapping[str, Variable],
    values: Record,
    cooling: bool = False,
    grid: tuple[str, ...] = (GRID_PLACEHOLDER,),
    observed: Mapping[str, Variable] | None = None,
) -> dict[str, Array]:
    """Return `values` with dimensions and attributes, in the order of the registered variables.

    `kind` is a kind of dataset in the registry, or a mapping of descriptions by name. Attributes
    are `long_name`, `units` (of a `cooling` gas or not), and the meanings of flags. `grid` replaces
    GRID_PLACEHOLDER; `observed` describes variables of observables, which come last. Raises
    ValueError for unregistered variables and for inconsistent shapes.
    """
    registered = REGISTRY[kind] if isinstance(kind, str) else kind
    descriptions = {**registered, **(observed or {})}
    kind_name = kind if isinstance(kind, str) else "dataset"
    raise_if_any(f"unknown variables of a {kind_name}", set(values) - set(descriptions))
    arrays = {
        name: _array(variable, values[name], cooling, grid)
        for name, variable in descriptions.items()
        if name in values
    }
    lengths: dict[str, int] = {}
    for name, (dims, array, _) in arrays.items():
        if array.ndim != len(dims):
            raise ValueError(f"{name} has shape {array.shape}, but dimensions {dims}")
        for dim, length in zip(dims, array.shape, strict=True):
            if lengths.setdefault(dim, length) != length:
                raise ValueError(f"{name} has {length} values along {dim}, others {lengths[dim]}")
    return arrays


def raise_if_any(problem: str, names: Collection[str]) -> None:
    """Raise ValueError, with `problem` and `names` in its text, unless `names` is empty."""
    if names:
        raise ValueError(f"{problem}: {', '.join(sorted(names))}")


def _array(variable: Variable, values: Any, cooling: bool, grid: tuple[str, ...]) -> Array:
    """Return values as an array of their type, with the dimensions and attributes of `variable`.

    `grid` replaces GRID_PLACEHOLDER in the dimensions; units are of a `cooling` gas or not.
    """
    attributes: dict[str, Any] = {"long_name": variable.long_name}
    if variable.units:
        attributes["units"] = variable.units_of(cooling)
    if variable.observable:
        attributes["observable"] = variable.observable
    if variable.comment:
        attributes["comment"] = variable.comment
    if variable.flags:
        words = variable.flags.split()
        meanings = np.arange(len(words), dtype=variable.dtype) - words.count("unknown")
        attributes |= {
            "flag_values": meanings.astype(variable.dtype),
            "flag_meanings": variable.flags,
        }
    dims = tuple(
        name for dim in variable.dims for name in (grid if dim == GRID_PLACEHOLDER else (dim,))
    )
    dtype = object if variable.dtype == "str" else variable.dtype
    return Array(dims, np.asarray(values, dtype), attributes)
