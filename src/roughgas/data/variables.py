"""The registry of all variables: what each is, over which dimensions, and in which units.

Writers, the tables of docs/data.md, and `roughgas show` read it. Points and reduced
datasets are registered here, others by the module that makes them.

Units: particle radius a = particle mass m = time unit T = 1. A freely cooling gas has no lasting
time scale: there, times are counted in collisions per particle, energies in the initial E_trans.
"""

from collections.abc import Collection, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

LENGTH = "a"
TIME = "T"
SPEED = "a/T"
ENERGY = "m a^2 T^-2"
RATE = "1/T"
START = "initial E_trans"
COOLING_UNITS = {TIME: "collisions per particle", ENERGY: START}
CLOCKS = ("time", "collisions_per_particle")
"""Coordinates that series run along, though their dimension has another name."""
GRID = "grid"
"""Stands for the dimensions of a reduced dataset, which are r, beta and whatever else is swept."""

SPIN, COOLING, DRIVEN = "where particles spin", "cooling gas", "driven gas"
SHEARED, TARGET = "sheared gas", "with `target_stderr`"
CONTACT = "where the contact-time model acts"
KEPT = "with `keep_state`"
OF_SPEED = "whose r depends on the speed"
MIXTURE = "with `species`"
AT_CONTACTS = "driven gas with `contact_averages`"
STAGES = "gas through stages"
LOGGED = "with `contact_log`"


class Variable(NamedTuple):
    """What a variable is."""

    long_name: str
    units: str = "1"  # "" for words
    dims: tuple[str, ...] = ()
    dtype: str = "f8"  # or "str"
    when: tuple[str, ...] = ()  # which datasets have it; all by default
    over_seeds: str = "mean"  # how a reduced dataset combines a scalar: mean, sum, or "" for not
    flags: str = ""  # the meanings of 0, 1, ..., a word each; `unknown`, if it is there, is -1
    of_settings: bool = False  # in units of the settings even in a cooling gas
    observable: str = ""  # which has watched it
    comment: str = ""  # on its values

    def units_of(self, cooling: bool) -> str:
        """Return its units in a cooling gas, or in a driven one."""
        counted = cooling and not self.of_settings
        return COOLING_UNITS.get(self.units, self.units) if counted else self.units


class Array(NamedTuple):
    """A variable with its values; the fields are those of an xarray.Variable."""

    dims: tuple[str, ...]
    values: np.ndarray
    attrs: dict[str, Any]


def _series(long_name: str, units: str = "1", *when: str) -> Variable:
    return Variable(long_name, units, ("sample",), when=when)


PARTNER, MOMENT = ("partner",), ("instant", "partner")


def _of_spin(long_name: str, units: str = "1", *more: str) -> Variable:
    return Variable(long_name, units, when=(*more, SPIN))


WITHIN, SCATTER = "within this file", "scatter over seeds"
POOLED = f"{SCATTER} and error within them, pooled"
"""Where a standard error comes from."""


def error_of(name: str, origin: str, about: Variable) -> Variable:
    """Return the standard error of a variable, from an origin such as WITHIN."""
    said = f"standard error of {name}{'' if origin == WITHIN else ':'} {origin}"
    return about._replace(long_name=said, dtype="f8", over_seeds="", flags="")


def errors_of(name: str, origin: str, about: Variable) -> dict[str, Variable]:
    """Return what says how sure a variable is: its error, and how well that is known."""
    texts = {
        "dof": f"degrees of freedom that {name}_stderr is known with",
        "ci95": f"half width of the 95 % interval of {name}, by Student's t",
    }
    error = error_of(name, origin, about)
    return {f"{name}_stderr": error} | {
        f"{name}_{end}": error._replace(long_name=text) for end, text in texts.items()
    }


TRUSTED = "_trusted"
"""Ends the name of the flags that say whether the error of a variable is right."""
TRUST = "unknown untrusted trusted"
"""The meanings of flags that say whether an error is right."""


def trust_of(name: str, about: Variable) -> Variable:
    """Return the flags that say whether the error of a variable is right."""
    said = f"whether {name}_stderr is large enough; -1 where there is too little to tell"
    return about._replace(long_name=said, units="1", dtype="i1", over_seeds="", flags=TRUST)


def share_of_trust(name: str) -> str:
    """Return the description of the share of seeds whose error of a variable is right."""
    error = f"{name}_stderr"
    return f"share of seeds whose {error} is large enough; -1 where most have too little to tell"


def _at_contacts(name: str, long_name: str) -> dict[str, Variable]:
    """Return an average over the collisions of pairs, with its error."""
    about = Variable(long_name, when=(AT_CONTACTS,))
    errors = errors_of(name, WITHIN, about)
    return {name: about, **errors, f"{name}_trusted": trust_of(name, about)}


NAMES = {  # in all kinds of datasets
    "species": Variable("name of the species", "", ("species",), "str", (MIXTURE,), over_seeds=""),
    "species_particles": Variable("particles of a species", "1", ("species",), "i8", (MIXTURE,)),
}


def _of_each(
    axis: str, having: str, name: str, units: str, dims: tuple, *when: str, dtype: str = "f8"
) -> Variable:
    return Variable(name, units, (axis, *dims), dtype, (having, *when), of_settings=True)


_kept, _logged = partial(_of_each, "replica", KEPT), partial(_of_each, "contact", LOGGED)


def _of_species(name: str, long_name: str, units: str = "1", *when: str) -> dict[str, Variable]:
    """Return a mean of each species, with its error and, but for R, its series."""
    about = Variable(f"{long_name} of a species", units, ("species",), when=(MIXTURE, *when))
    found = {name: about, f"{name}_stderr": error_of(name, WITHIN, about)}
    found[f"{name}_trusted"] = trust_of(name, about)
    if units == ENERGY:
        found[f"{name}_series"] = about._replace(dims=("species", "sample"))
    return found


_IN_ROTATION = _of_spin("share of rotation in the energy, mean of E_rot / (E_rot + E_trans)")
_TRANSLATION = Variable("translational energy per degree of freedom", ENERGY)
_ROTATION = _of_spin("rotational energy per degree of freedom", ENERGY)
_INPUT = "energy per particle that a source has put in since the start (negative: taken out)"
_GAIN = "change of the energy per particle, kinetic and potential, since the start"


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
    **_at_contacts("R_collisional", "share of rotation in the energy, averaged over collisions"),
    **_at_contacts(
        "contact_correlation", "<v_t.v_r>/sqrt(<v_t^2> <v_r^2>), averaged over collisions"
    ),
    "E_trans": _TRANSLATION,
    "E_trans_stderr": error_of("E_trans", WITHIN, _TRANSLATION),
    "E_trans_trusted": trust_of("E_trans", _TRANSLATION),
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
    "R_unsubtracted": _of_spin("R with the mean flow and the mean spin left in", "1", SHEARED),
    "E_trans_unsubtracted": Variable("E_trans with the mean flow left in", ENERGY, when=(SHEARED,)),
    "E_rot_unsubtracted": _of_spin("E_rot with the mean spin left in", ENERGY, SHEARED),
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
    **NAMES,
    **_of_species("E_trans_species", "translational energy per degree of freedom", ENERGY),
    **_of_species("E_rot_species", "rotational energy per degree of freedom", ENERGY, SPIN),
    **_of_species("R_species", "share of rotation in the energy", "1", SPIN),
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
    "last_time": _kept("time since the start at which it ends", TIME, ()),
    "last_position": _kept("position of a particle then", LENGTH, ("particle", "axis")),
    "last_velocity": _kept("velocity then of the image in the box", SPEED, ("particle", "axis")),
    "last_spin": _kept("spin a w of a particle then", SPEED, ("particle", "spin_axis"), SPIN),
    "last_radius": _kept("radius of a particle", LENGTH, ("particle",), MIXTURE),
    "last_species_of": _kept("number of its species, from 0", "1", ("particle",), MIXTURE),
    "last_memory": _kept(
        "the kernel's arrays then, as they lie in memory", "1", ("byte",), dtype="u1"
    ),
    "contacts_lost": Variable(
        "contacts before the first one that is logged", dtype="i8", when=(LOGGED,), over_seeds=""
    ),
    "instant": Variable("before or after a contact", "", ("instant",), "str", (LOGGED,)),
    "logged_time": _logged("time of a contact since the start", TIME, ()),
    "logged_partner": _logged(
        "number of a partner from 0, as it is at the start; -1 is a floor or a wall",
        "1",
        PARTNER,
        dtype="i4",
    ),
    "logged_normal": _logged("unit vector from the second partner to the first", "1", ("axis",)),
    "logged_position": _logged("position of the first partner", LENGTH, ("axis",)),
    "logged_velocity": _logged(
        "velocity of a partner, of the second as the image that the first touches",
        SPEED,
        (*MOMENT, "axis"),
    ),
    "logged_spin": _logged("spin a w of a partner", SPEED, (*MOMENT, "spin_axis"), SPIN),
    "logged_species": _logged(
        "number of a partner's species, from 0; -1 is a wall", "1", PARTNER, MIXTURE, dtype="i4"
    ),
    "logged_radius": _logged("radius of a partner", LENGTH, PARTNER, MIXTURE),
    "logged_mass": _logged("mass of a partner", "m", PARTNER, MIXTURE),
    "logged_inertia": _logged(
        "moment of inertia of a partner over its m a^2", "1", PARTNER, MIXTURE
    ),
}

REGISTRY: dict[str, Mapping[str, Variable]] = {"point": POINT}
"""All variables by name, for each kind of dataset."""


def register(kind: str, variables: Mapping[str, Variable]) -> Mapping[str, Variable]:
    """Make the variables of a kind of dataset known, and return them."""
    REGISTRY[kind] = variables
    return variables


def described(
    kind: str | Mapping[str, Variable],
    values: Mapping[str, Any],
    cooling: bool = False,
    grid: tuple[str, ...] = (GRID,),
    observed: Mapping[str, Variable] | None = None,
) -> dict[str, Array]:
    """Return `values` with dimensions and attributes, in the order in which they are registered as
    those of a `kind` of dataset, or given.

    Attributes are `long_name`, `units`, and those of flags. `grid` are the dimensions that GRID
    stands for; `observed` describes variables of observables, which come last. Raises ValueError
    for unregistered variables, and for shapes that disagree.
    """
    registered = REGISTRY[kind] if isinstance(kind, str) else kind
    known = {**registered, **(observed or {})}
    what = kind if isinstance(kind, str) else "dataset"
    refuse(f"unknown variables of a {what}", set(values) - set(known))
    found = {
        name: _array(about, values[name], cooling, grid)
        for name, about in known.items()
        if name in values
    }
    lengths: dict[str, int] = {}
    for name, (dims, array, _) in found.items():
        if array.ndim != len(dims):
            raise ValueError(f"{name} has shape {array.shape}, but dimensions {dims}")
        for dim, length in zip(dims, array.shape, strict=True):
            if lengths.setdefault(dim, length) != length:
                raise ValueError(f"{name} has {length} values along {dim}, others {lengths[dim]}")
    return found


def refuse(what: str, names: Collection[str]) -> None:
    """Raise ValueError if there are any `names`."""
    if names:
        raise ValueError(f"{what}: {', '.join(sorted(names))}")


def _array(about: Variable, values: Any, cooling: bool, grid: tuple[str, ...]) -> Array:
    attributes: dict[str, Any] = {"long_name": about.long_name}
    if about.units:
        attributes["units"] = about.units_of(cooling)
    if about.observable:
        attributes["observable"] = about.observable
    if about.comment:
        attributes["comment"] = about.comment
    if about.flags:
        words = about.flags.split()
        meanings = np.arange(len(words), dtype=about.dtype) - words.count("unknown")
        attributes |= {"flag_values": meanings.astype(about.dtype), "flag_meanings": about.flags}
    dims = tuple(one for dim in about.dims for one in (grid if dim == GRID else (dim,)))
    dtype = object if about.dtype == "str" else about.dtype
    return Array(dims, np.asarray(values, dtype), attributes)
