"""Forms of settings files: structs of all their keys, and checks of files before any merging.

Every key may be absent in a file. All functions raise InputError, with the file and the key, for
the first illegal value.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, Literal

from msgspec import Meta

from roughgas.base import InputError, NamedValues, Record, short_repr
from roughgas.base.fields import (
    NAME,
    Settings,
    SettingsClasses,
    UnknownKeyError,
    changes_of,
    converted,
    described,
    nested_key,
    number,
    numbers,
    read,
    reference,
    whole,
)
from roughgas.base.labels import parser_of
from roughgas.config import study_code
from roughgas.config.shaken_layer import LayerSettings
from roughgas.effects import EFFECTS
from roughgas.effects.species import PairSettings, SpeciesSettings
from roughgas.scene.settings import Box, Neighbours, Particles, SpinTemperature

RESERVED = frozenset(
    """
    accuracy accuracy_limits accuracy_waiting article article_pdf by_default catalogue claims
    codemeta combine compile_kernel config coverage crate deposit document effective_config
    everything evidence evidence_long explore explore_extensions extensions family fig1a fig1b fig2a
    fig2b figure figure_of_evidence figures front hard_cases hard_cases_chaos hard_cases_collapse
    hard_cases_cooling living living_page long_table movie movies numbers page page_of_evidence
    page_of_verdicts paper papers picture_for_talks pictures plot point quoted_by_documentation
    quoted_numbers reduce report rows_of_evidence run_times run_times_extensions study_evidence
    study_movie study_page study_slides table table_of_extensions table_of_papers task verdicts
    """.split()
)
"""Names forbidden for experiments: the workflow has rules and products called so."""
AXIS = re.compile(r"[a-z][a-z0-9_]*([.][a-z0-9_]+)?[.][a-z][a-z0-9_]*")
"""Key of a third axis with a dot: a parameter of an effect, of a species or of the schedule."""
TITLES_OF_AXES = ("species.NAME.KEY", "EFFECT.PARAMETER, schedule.KEY")
TASKS_AT_SCALE = re.compile(r"[a-z][a-z0-9_]*[.]tasks")

Name = Annotated[str, NAME]
Reference = Annotated[
    str,
    Meta(
        pattern="^[a-z][a-z0-9_]*([.][a-z][a-z0-9_]*)?$(?!\n)",
        description="The name of an experiment; STUDY.EXPERIMENT of one of a study.",
    ),
]
Label = Annotated[
    Any,
    Meta(
        description="A value; the effect, or the swept key, defines the legal values.",
        extra_json_schema={"format": "level"},
    ),
]


Restitutions = Annotated[
    tuple[
        Annotated[
            Any,
            Meta(
                description="A normal restitution.",
                extra_json_schema={"format": "restitution"},
            ),
        ],
        ...,
    ],
    numbers(
        1,
        None,
        "Normal restitutions. Paths of results have the shortest decimal form of each, such as 0.9 "
        'for ".90".',
    ),
]
Roughnesses = Annotated[
    tuple[
        Annotated[Any, Meta(description="A roughness.", extra_json_schema={"format": "roughness"})],
        ...,
    ],
    numbers(1, None, "Roughnesses (tangential restitutions), in paths of the same form."),
]


# ---------------------------------------------------------------------- one experiment


class GridSettings(Settings, frozen=True, kw_only=True):
    """Every r is combined with every beta and seed."""

    r: Restitutions
    beta: Roughnesses
    seeds: Annotated[
        int, whole(1, None, "Number of independent runs of each point; their seeds are 1, 2, ...")
    ]


class SweepForm(GridSettings, frozen=True, kw_only=True):
    """Every r is combined with every beta, seed, and value of the third axis."""

    particles: Annotated[
        tuple[Label, ...],
        numbers(
            1,
            None,
            "A third axis. Numbers of particles: in the same box, or at the same `packing` "
            "if that is given.",
        ),
    ]
    box: Annotated[
        tuple[Label, ...],
        numbers(
            1,
            None,
            "A third axis. Widths of the box in a; its other sides keep their proportion.",
        ),
    ]
    packing: Annotated[
        tuple[Label, ...],
        numbers(1, None, "A third axis. Packing fractions; the box keeps its shape."),
    ]
    case: Annotated[
        dict[str, Any],
        described(
            "A third axis. Cases by name, each with the settings that it changes "
            "together, such as the amplitude and the period of a floor with the lengths of the "
            "schedule; null removes an inherited one.",
        ),
    ]


class CaseForm(Settings, frozen=True, kw_only=True):
    """Settings of an experiment that one case of a sweep changes."""

    description: Annotated[
        str, Meta(min_length=1, description="A description of the simulation, in a sentence.")
    ]
    particles: Particles
    box: Box
    packing: Annotated[
        float,
        number(
            "(0, 0.95]",
            "Volume fraction of the particles, in place of lengths in `box`: the box then has "
            "this packing, and the shape of an inherited `box`, or proportions such as "
            "[1, 1, 1] of a cube; by default it is a square.",
        ),
    ]
    layer: Annotated[dict[str, Any], reference("layer")]
    neighbours: Neighbours
    effects: Annotated[dict[str, Any], reference("effects")]
    species: Annotated[
        tuple[SpeciesSettings, ...],
        numbers(
            1,
            None,
            "Species of particles, if they are not all alike; null removes inherited species. "
            "A list replaces an inherited list.",
        ),
    ]
    species_pairs: Annotated[
        tuple[PairSettings, ...],
        numbers(1, None, "Materials of contacts of two species, in place of their means."),
    ]
    observables: Annotated[dict[str, Any], reference("observables")]
    spin_temperature: SpinTemperature
    keep_state: Annotated[
        bool,
        described(
            "Whether points keep their last state, from which `roughgas run --from` continues."
        ),
    ]
    betas_per_job: Annotated[
        int,
        whole(
            1,
            None,
            "Number of values of beta that one job runs, in place of the number for all "
            "experiments.",
        ),
    ]
    schedule: Annotated[dict[str, Any], reference("schedule")]

    @classmethod
    def check(cls, raw: Any, key: str) -> None:
        """Raise InputError, whose key begins with `key`, for illegal settings in the mapping `raw`.

        Effects, observables, schedule, layer and sweep are checked, too, as far as they are given.
        """
        _read_changes(changes_of(cls), raw, key)
        check_kinds(EFFECTS, raw.get("effects"), nested_key(key, "effects"))
        if raw.get("observables"):
            from roughgas.observables import OBSERVABLES  # not needed without observables

            check_kinds(OBSERVABLES, raw["observables"], nested_key(key, "observables"))
        if raw.get("schedule"):
            _check_schedule(raw["schedule"], nested_key(key, "schedule"))
        if raw.get("layer"):
            read(changes_of(LayerSettings), raw["layer"], nested_key(key, "layer"))
        if raw.get("sweep"):
            _check_sweep(raw["sweep"], nested_key(key, "sweep"))


class ChangeForm(CaseForm, frozen=True, kw_only=True):
    """Settings of an experiment that a scale changes."""

    sweep: Annotated[dict[str, Any], reference("sweep")]


class ExperimentForm(ChangeForm, frozen=True, kw_only=True):
    """One experiment; in a scale or beside `extends`, only its changes."""

    extends: Annotated[
        Reference,
        described("An experiment whose settings this one inherits; null removes a setting."),
    ]


class PointForm(ChangeForm, frozen=True, kw_only=True):
    """Settings of an experiment or of a variant, as rules and datasets store them."""

    swept: str
    """Swept parameter, in settings of a variant."""
    case: Name
    """Case of a sweep, in settings of a variant."""


def check_kinds(kinds: SettingsClasses, raw: Any, key: str) -> None:
    """Raise InputError for unknown effects, or observables, and for their illegal settings.

    `kinds` has the classes by name, `raw` the changed settings by name, or None; `key` is the name
    of `raw` in messages.
    """
    for name, changes in mapping(raw or {}, key).items():
        if name not in kinds:
            error = _with_location(UnknownKeyError(key, name, changes, sorted(kinds)))
            raise _advising(error, study_code.advice(name))
        if changes is not None:
            _read_changes(changes_of(kinds[name].settings), changes, nested_key(key, name))


def _read_changes(kind: type[Settings], raw: Any, key: str) -> Any:
    """Return the mapping `raw` as a struct of class `kind`; raise InputError as `read` does.

    The error of an unknown key suggests a mapping that may hold it.
    """
    try:
        return read(kind, raw, key)
    except UnknownKeyError as error:
        raise _with_location(error) from None


def mapping(raw: Any, key: str) -> NamedValues:
    """Return `raw` as a dictionary; raise InputError, with this `key`, unless it is a mapping."""
    if raw is None:
        raise InputError(key, "(nothing)", "be a mapping of keys to values")
    converted(dict[str, Any], raw, key)
    return dict(raw)


def _check_schedule(raw: Any, key: str) -> None:
    """Raise InputError for illegal keys or values in a schedule `raw`, which messages call `key`.

    The effects of its stages are checked, too.
    """
    from roughgas.simulation.protocols import PROTOCOLS

    settings = _read_changes(changes_of(*(kind.SETTINGS for kind in PROTOCOLS.values())), raw, key)
    for index, stage in enumerate(settings.stages or ()):
        check_kinds(EFFECTS, stage.effects, f"{key}.stages[{index}].effects")


def _check_sweep(raw: Any, key: str) -> None:
    """Raise InputError for illegal axes or labels of a sweep `raw`, which messages call `key`."""
    sweep = mapping(raw, key)
    try:
        undotted_axes = {axis: labels for axis, labels in sweep.items() if not AXIS.fullmatch(axis)}
        read(changes_of(SweepForm), undotted_axes, key)
    except UnknownKeyError as error:
        legal_keys = [*error.legal_keys, *TITLES_OF_AXES]
        raise _with_location(UnknownKeyError(key, error.name, error.content, legal_keys)) from None
    for axis, labels in sweep.items():
        if axis == "case":
            if labels is not None:
                _check_cases(labels, nested_key(key, axis))
        elif axis != "seeds" and labels is not None:
            converted(Annotated[tuple[Any, ...], Meta(min_length=1)], labels, nested_key(key, axis))
            for index, label in enumerate(labels):
                _check_label(axis, label, f"{key}.{axis}[{index}]")


def _check_label(axis: str, label: Any, key: str) -> None:
    """Raise InputError, with this `key`, if the label does not stand for a value along the axis."""
    try:
        parser_of(axis)(label)
    except InputError as error:
        raise InputError(key, short_repr(label), error.legal) from None


def _check_cases(cases: Record, key: str) -> None:
    """Raise InputError for illegal names or settings of the cases of a sweep, at the key `key`."""
    if not cases:
        raise InputError(key, "{}", "be a mapping of names to settings")
    for name, changes in cases.items():
        check_name(Name, name, key)
        if changes is not None:
            CaseForm.check(changes, nested_key(key, name))


def _with_location(error: UnknownKeyError) -> UnknownKeyError:
    """Return the same error, extended by the mapping where the unknown key is legal, if any."""
    if location := _location_of(error.name, error.content, error.legal_keys):
        _advising(error, f"; did you mean it under `{location}`?")
    return error


def _advising(error: UnknownKeyError, advice: str) -> UnknownKeyError:
    """Return the same error, whose text ends in `advice`."""
    error.legal += advice
    error.args = error.key, error.value, error.legal  # of a broken study these are kept
    return error


def _location_of(name: str, content: Any, legal_keys: Iterable[str]) -> str:
    """Return the location of the mapping where the key `name` is legal; "" if there is none.

    `legal_keys` are the legal keys of the mapping that wrongly holds it, with the value `content`.
    """
    from roughgas.simulation.protocols import PROTOCOLS

    of_experiment = ExperimentForm.__struct_fields__
    if "experiments" in legal_keys:
        is_experiment = isinstance(content, Mapping) and set(content) & set(of_experiment)
        return "experiments:" if is_experiment else ""
    schedule = [key for kind in PROTOCOLS.values() for key in kind.SETTINGS.__struct_fields__]
    keys_at = {
        "experiments: NAME:": [*of_experiment],
        "sweep:": [*SweepForm.__struct_fields__],
        "schedule:": schedule,
        "effects:": [*EFFECTS],
    }
    for effect, kind in EFFECTS.items():
        keys_at[f"effects: {effect}:"] = [*kind.settings.__struct_fields__]
    return next((location for location, keys in keys_at.items() if name in keys), "")


# ---------------------------------------------------------------------- files


class ConfigurationForm(Settings, frozen=True, kw_only=True):
    """Every experiment as data, and the scales to run them at."""

    scale: Annotated[
        Name,
        described("The default scale to run; `paper` if not given."),
    ]
    seeds_per_job: Annotated[
        int,
        whole(
            1,
            None,
            "Number of seeds of a point that one job runs, one after the other; 4 by default.",
        ),
    ]
    betas_per_job: Annotated[
        int,
        whole(
            1,
            None,
            "Number of values of beta at which one job runs these seeds; 1 by default.",
        ),
    ]
    complete: Annotated[
        bool,
        described(
            "Whether this configuration is complete, so that no experiments of studies are added; "
            "false by default."
        ),
    ]
    experiments: Annotated[dict[str, Any], reference("experiments")]
    accuracy: Annotated[dict[str, Any], reference("accuracy")]
    scales: Annotated[dict[str, Any], reference("scales")]

    @classmethod
    def check(cls, raw: Any, source: str, use_names: Callable[[str], None]) -> None:
        """Raise InputError if the form of a configuration `raw`, called `source`, is illegal.

        `use_names` makes the effects and observables of the studies of an experiment legal. Changes
        to an experiment of a study whose code is broken are not checked: it is left out.
        """
        try:
            read(changes_of(cls), raw, f"{source}: ")
        except UnknownKeyError as error:
            # without the colon that precedes nested keys
            unknown = UnknownKeyError(f"{source}", error.name, error.content, error.legal_keys)
            raise _with_location(unknown) from None
        for name, settings in mapping(raw.get("experiments"), f"{source}: experiments").items():
            check_name(Reference, name, f"{source}: experiments")
            if _is_usable(name, use_names):
                ExperimentForm.check(settings, f"{source}: experiments.{name}")
            if name in RESERVED:
                legal = "be another name: the workflow has a rule or a product of this one"
                raise InputError(f"{source}: key of experiments", name, legal)
        for scale, changes in (raw.get("scales") or {}).items():
            check_name(Name, scale, f"{source}: scales")
            _check_scale(changes, f"{source}: scales.{scale}", use_names)


def _is_usable(name: str, use_names: Callable[[str], None]) -> bool:
    """Return whether the code of the studies of an experiment can be used: see `use_names`."""
    try:
        use_names(name)
    except InputError:
        return False
    return True


def _check_scale(raw: Any, key: str, use_names: Callable[[str], None]) -> None:
    """Raise InputError for illegal changes `raw` at one scale, which messages call `key`."""
    for name, changes in mapping(raw, key).items():
        if TASKS_AT_SCALE.fullmatch(name) or name == "accuracy":
            mapping(changes, f"{key}.{name}")
        else:
            check_name(Reference, name, key)
            if _is_usable(name, use_names):
                ChangeForm.check(changes, f"{key}.{name}")


class StudyForm(Settings, frozen=True, kw_only=True):
    """The keys of studies/NAME/config.yaml."""

    heading: Annotated[
        Literal["paper", "beyond", "papers", "accuracy"],
        described(
            "The heading of the report that lists the study; `papers` for the study of a `paper`, "
            "else `beyond` by default."
        ),
    ]
    paper: Annotated[
        str,
        Meta(
            min_length=1,
            description="The paper of another group that the study reproduces: authors, journal.",
        ),
    ]
    documents: Annotated[
        tuple[Name, ...],
        numbers(
            1,
            None,
            "Tables that the report shows as separate pages, in place of one page of the study.",
        ),
    ]
    modules: Annotated[
        tuple[Name, ...],
        numbers(
            1,
            None,
            "Python modules in this folder that define tasks, each with `tasks`, `run`, `combine` "
            "and `table`, in place of tasks.py and results.py.",
        ),
    ]
    tasks: Annotated[
        dict[str, Any],
        described(
            "Settings of its tasks, which tasks.py runs, and schema.yaml in this folder may check. "
            "`experiments` names the experiments that tasks may run, of the study or of "
            "config.yaml; tasks' experiments of the study are not swept. With `modules`, a mapping "
            "of settings for each module; without `experiments` their tasks may run all."
        ),
    ]
    experiments: Annotated[
        dict[str, Any],
        Meta(
            min_length=1,
            description="Its experiments by name; elsewhere they are called NAME.EXPERIMENT.",
        ),
    ]
    scales: Annotated[
        dict[str, Any],
        described("Changes to its experiments at each scale."),
    ]
    figures: Annotated[
        dict[str, Any],
        described(
            "The experiments in each figure that figure.py draws: of the study, of config.yaml, or "
            "STUDY.EXPERIMENT of another study; `tasks`, or the name of a module, stands for the "
            "data of its tasks; by default one figure shows all. A study with neither "
            "`experiments` nor `tasks` shows experiments of config.yaml."
        ),
    ]
    evidence: Annotated[
        tuple[Reference, ...],
        numbers(
            1,
            None,
            "The experiments that evidence.py compares with published numbers, named as in "
            "figures; by default all of the study.",
        ),
    ]
    movies: Annotated[
        dict[str, Any],
        described("An experiment or variant for each movie, and options of `roughgas movie`."),
    ]

    @classmethod
    def check(cls, raw: Any, source: str) -> None:
        """Raise InputError if `raw`, the content of a study's config.yaml, has an illegal form.

        Messages call the file `source`.
        """
        try:
            read(changes_of(cls), raw, f"{source}: ")
        except UnknownKeyError as error:
            raise UnknownKeyError(source, error.name, error.content, error.legal_keys) from None
        for name, settings in (raw.get("experiments") or {}).items():
            check_name(Name, name, f"{source}: experiments")
            ExperimentForm.check(settings, f"{source}: experiments.{name}")
        for scale, changes in (raw.get("scales") or {}).items():
            for name, settings in mapping(changes, f"{source}: scales.{scale}").items():
                key = f"{source}: scales.{scale}.{name}"
                mapping(settings, key) if name == "tasks" else ChangeForm.check(settings, key)
        if (tasks := raw.get("tasks")) is not None:
            names = tasks.get("experiments")
            if names is not None or not raw.get("modules"):
                converted(NAMES, names, f"{source}: tasks.experiments")
        for product, kind in (("figures", REFERENCES), ("movies", TEXT)):
            for name, content in (raw.get(product) or {}).items():
                check_name(Name, name, f"{source}: {product}")
                converted(kind, content, f"{source}: {product}.{name}")


NAMES = Annotated[tuple[Name, ...], Meta(min_length=1)]
REFERENCES = Annotated[tuple[Reference, ...], Meta(min_length=1)]
TEXT = Annotated[str, Meta(min_length=1)]


def check_name(kind: Any, name: str, key: str) -> None:
    """Raise InputError if `name`, a key of the mapping `key`, does not match the type `kind`.

    `kind` is an annotated str with the legal pattern, such as `Name`.
    """
    converted(kind, name, f"{key}: key")
