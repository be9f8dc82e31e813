"""`roughgas run`: simulation of points of an experiment.

A point is a combination of normal restitution r, roughness beta and a seed. R is E_rot/(E_rot +
E_trans), the share of rotation in the energy per degree of freedom.
"""

import re
import sys
from collections.abc import Iterable, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from roughgas import config
from roughgas.base import InputError, NeedsError, as_json
from roughgas.base.fields import RawSettings
from roughgas.base.labels import (
    SPECIES_PREFIX,
    SWEPT,
    GridPoint,
    grid_points,
    names_of,
    species_settings,
)
from roughgas.cli.values import check_outputs, labels, number
from roughgas.config import study_code
from roughgas.data.point import Point, read_point, write_point
from roughgas.simulation import protocols
from roughgas.simulation.checkpoint import checkpoint_path
from roughgas.simulation.experiment import KEYS_OF_NO_POINT, Experiment
from roughgas.simulation.finished_points import FinishedPoints
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.run_points import simulate_points, variant_attributes
from roughgas.simulation.saved_states import initial_states_of, with_noise_source
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.sample_sizes import NO, UNKNOWN, YES
from roughgas.theory.prediction import describe_collisional_average

IDENTITY = ("experiment", "variant", "scale", "r", "beta", "seed")
"""The attributes that identify a point."""
NO_POINT_SETTINGS = (*KEYS_OF_NO_POINT, SWEPT, config.CASE, "extends")
"""Keys of experiments that are no settings of a single point, and illegal in --set."""
TARGET_NOTES = {YES: "met", NO: "NOT met", UNKNOWN: "not known to be met"}


class Selection(NamedTuple):
    """Points selected on a command line, and changes to the settings of their experiment: texts, as
    they are written.

    `experiment` is the name of an experiment or of a variant, `scale` a scale of the configuration,
    `config` the path of the configuration. `changes` are KEY=VALUE, `observe` the names of
    observables; with `keep_state` the last state of the particles is kept in the dataset.
    """

    experiment: str
    scale: str
    config: str | Path
    settings: str | None  # JSON, in place of `config`
    r: str | list[str]
    beta: str | list[str]
    seed: str | list[str] | None
    changes: Sequence[str] = ()
    observe: Sequence[str] = ()
    keep_state: bool = False
    studies: Sequence[str] = ()  # folders of studies whose code `settings` need


class Start(NamedTuple):
    """The file that a run begins from, and options of files of other programs: texts, as they are
    written, None if omitted."""

    file: str | None
    frame: str | None = None
    unit_length: str | None = None
    unit_mass: str | None = None
    unit_time: str | None = None

    def options(self) -> list[str]:
        """Return the words of a command line that repeat these options."""
        words = [] if self.file is None else ["--from", self.file]
        return words + [f"{name}={text}" for name, text in self._named_options().items()]

    def dataset(self) -> Any:
        """Return the dataset of the state to begin with; there is a file.

        Raises InputError for a file without one, and for illegal options.
        """
        from roughgas.data import other_programs
        from roughgas.data.other_programs.particles import UNIT

        options = self._named_options()
        if self.file and other_programs.is_of_other_program(self.file):
            units = {
                key: number(name, options[name], UNIT)
                for key in other_programs.Units._fields
                if (name := f"--unit-{key}") in options
            }
            frame = other_programs.LAST_FRAME
            if "--frame" in options:
                frame = _frame_number(options["--frame"])
            return other_programs.read_frame(self.file, frame, other_programs.Units(**units))
        if options:
            name, text = next(iter(options.items()))
            raise InputError(name, text, "come with a file of another program: --from FILE")
        point = read_point(self.file or "")
        if "last_position" not in point:
            legal = "be a point that has kept its last state, by --keep-state"
            raise InputError("--from", self.file, legal)
        return point

    def _named_options(self) -> dict[str, str]:
        """Return the options beside the file that are not omitted, by name."""
        texts = zip(self._fields[1:], self[1:], strict=True)
        return {f"--{key.replace('_', '-')}": text for key, text in texts if text is not None}


def _frame_number(text: str) -> int:
    """Return the number of a frame; raise InputError for another text."""
    if not re.fullmatch(r"-?\d{1,9}", text):
        raise InputError("--frame", text, "be a whole number: 0, 1, ..., or -1 for the last")
    return int(text)


def write_points(
    selection: Selection,
    start: Start,
    reseed: list[str] | None,
    output: list[str] | None,
    json: bool,
) -> None:
    """Simulate points, and write the dataset of each as soon as it is finished.

    The simulations begin from the file of `start`, if it has one, with noise of the seeds `reseed`,
    texts, if there are any. `output` has a path for each point; if it is None,
    datasets go into the present folder, and their summaries are printed. With `json` the results of
    each point are printed as a line of JSON. If several points are interrupted, the same command
    reuses those already finished. Raises InputError, OSError, and CollapseError for an inelastic
    collapse.
    """
    initial, seed = initial_in(start, selection.seed, reseed)
    name, selected, experiment = points_of(selection, seed)
    paths = output or [_default_path(name, selection, coordinates) for coordinates in selected]
    if len(paths) != len(selected):
        raise InputError("--output", " ".join(paths), f"name {len(selected)}, one per point")
    if output is None:
        inputs = [selection.config, *([start.file] if start.file else [])]
        check_outputs(paths, inputs, "POINT")
    extra_options = study_code.options(experiment.effects, experiment.observables)
    extra_options += start.options()
    arguments = name, experiment, selected, selection.scale, paths, initial
    checkpoints = [*map(checkpoint_path, paths)]
    finished = FinishedPoints(paths) if len(paths) > 1 else None
    simulated = simulate_points(
        *arguments, extra_arguments=extra_options, checkpoints=checkpoints, finished=finished
    )
    write = write_point if finished is None else finished.write
    with nullcontext() if finished is None else finished.advising():
        for path, point in zip(paths, simulated, strict=True):
            write(path, point)
            if json:
                print(_json_line(path, point), flush=True)
            elif output is None:
                from roughgas.cli.show import summary

                print(summary(path), flush=True)
            else:
                _print_result(path, point)


def initial_in(
    start: Start, seed: str | list[str] | None, reseed: str | list[str] | None
) -> tuple[list[InitialState], Any]:
    """Return the states in the file of `start`, one per replica, and the seed or seeds of the
    noise.

    There are no states without a file. `reseed`, texts, are seeds of fresh noise for saved
    states, in place of `seed`; without either, the run continues the noise of the saved state.
    Raises InputError for a file without a state, for both `seed` and `reseed`, and for `reseed`
    without a file.
    """
    states: list[InitialState] = []
    if start != Start(None):
        states = initial_states_of(start.dataset())
    return with_noise_source(states, seed, reseed)


def points_of(
    selection: Selection, seed: Any = None
) -> tuple[str, list[GridPoint], Experiment[Any]]:
    """Return the name of the experiment as spelled in paths, the selected (r, beta, seed), and the
    settings of the experiment.

    `seed`, a number or a list, replaces the seeds of the selection, whose default is 1. Raises
    InputError for illegal values, and for a name that disagrees with --settings.
    """
    experiment = _experiment(selection)
    seed_labels = selection.seed if seed is None else seed
    seeds = (
        seed_labels
        if isinstance(seed_labels, list)
        else [str(1 if seed_labels is None else seed_labels)]
    )
    r, beta, seeds = (
        labels(f"--{name}", values)
        for name, values in (("r", selection.r), ("beta", selection.beta), ("seed", seeds))
    )
    selected = grid_points(r, beta, seeds, prefix="--")
    name = config.WrittenExperiment(experiment.raw).spelled_name(selection.experiment)
    variant_attributes(name, experiment)
    return name, selected, experiment


def _experiment(selection: Selection) -> Experiment[Any]:
    """Return the settings of the selected experiment, with the changes of --set, --observe and
    --keep-state. Raises InputError if they are illegal."""
    if selection.settings is None:
        if selection.studies:
            raise NeedsError("--studies", "--settings")
        written = config.load_experiment(selection.config, selection.experiment, selection.scale)
        key = selection.experiment
    else:
        key = "--settings"
        study_code.use(selection.studies)
        written = config.WrittenExperiment.from_text(selection.settings, key)
    written.check_has_points(selection.experiment)
    observables: dict[str, RawSettings] = {name: {} for name in selection.observe or ()}
    if observables:
        written = written.changed({"observables": observables})
    if observables or selection.changes:
        written, key = with_assignments(written, selection.changes), selection.experiment
    if selection.keep_state:
        written = written.changed({"keep_state": True})
    experiment = written.experiment(key)
    protocols.check_experiment(experiment)
    return experiment


def _default_path(name: str, selection: Selection, coordinates: GridPoint) -> str:
    """Return the default path of the dataset of the point at `coordinates`, in the present folder.

    `name` is the name of the experiment. The changes of --set are in the file's name: mu0.3 for
    effects.friction.mu=0.3.
    """
    r, beta, seed = coordinates.labels
    assignments = (change.partition("=") for change in selection.changes)
    changes = [
        re.sub(r"[^\w.+-]", "", f"{key.rpartition('.')[2]}{text}") for key, _, text in assignments
    ]
    scale = [] if selection.scale == config.PAPER else [selection.scale]
    point = [f"r{r}", f"beta{beta}", f"seed{seed}.nc"]
    return "_".join([name.replace("/", "_"), *changes, *scale, *point])


def _json_line(output: str, point: Point) -> str:
    """Return a line of JSON: the path `output` of a point's dataset, the identity of the point, and
    its scalar variables."""
    identity = {name: point.attributes[name] for name in IDENTITY if name in point.attributes}
    scalars = {
        name: variable for name, variable in point.variables.items() if np.ndim(variable) == 0
    }
    return as_json({"file": output} | identity | scalars, indent=None)


def _print_result(output: str, point: Point) -> None:
    """Print on stderr the path `output` of a point's dataset, R with its error (E_trans without
    spin), and the cost of the simulation."""
    variables = point.variables
    name = "R" if "R" in variables else "E_trans"
    value = f"{Estimate(float(variables[name]), float(variables[f'{name}_stderr']))}"
    if "R_collisional" in variables:
        collisional = float(variables["R_collisional"]), float(variables["R_collisional_stderr"])
        meaning = describe_collisional_average(point.attributes, variables)
        value += f" over time, {Estimate(*collisional)} over collisions ({meaning})"
    if "R_corrected" in variables:
        value += f", {float(variables['R_corrected']):.4f} corrected for the number of particles"
    if "target_met" in variables:
        value += f", target {TARGET_NOTES[int(variables['target_met'])]}"
    took = (
        f"{int(variables['collisions']):,} collisions in {float(variables['kernel_seconds']):.1f} s"
    )
    print(f"{output}: {name} = {value}, {took}", file=sys.stderr)


def with_assignments(
    written: config.WrittenExperiment, assignments: Iterable[str]
) -> config.WrittenExperiment:
    """Return an experiment with the changes `assignments`, each KEY=VALUE, VALUE in YAML; null
    removes a key.

    A KEY is dotted, as schedule.measure. As in a sweep, `effects.` may be omitted, a species may be
    named, and `box` may be a width alone. Raises InputError for another form, and for a key given
    twice; whether keys and values are legal is decided where settings are checked.
    """
    from roughgas.base.reading import parse_yaml

    keys: set[str] = set()
    for assignment in assignments:
        key, _, text = assignment.partition("=")
        if not key or not text:
            raise InputError("--set", assignment, "be KEY=VALUE, such as particles=80")
        if key in keys:
            raise InputError("--set", key, "be given once")
        if key.partition(".")[0] in NO_POINT_SETTINGS:
            raise InputError("--set", key, "be a setting of one point")
        keys.add(key)
        written = _with_value(written, key, parse_yaml(text, f"--set {key}"))
    return written


def _with_value(
    written: config.WrittenExperiment, key: str, value: Any
) -> config.WrittenExperiment:
    """Return an experiment with the setting at a dotted `key` replaced by `value`, as in
    `with_assignments`. Raises InputError for an unknown species."""
    from roughgas import effects

    name = key.rpartition(".")[0]
    if name.startswith(SPECIES_PREFIX):
        species = written.raw.get("species") or []
        if species_settings(species, name) is None:
            legal_names = ", ".join(names_of(species)) or "there are none"
            raise InputError("--set", key, f"name one of species: {legal_names}")
        return written.at_level(key, value)
    if key == "box" and isinstance(value, int | float):
        return written.at_level(key, value)
    names = key.split(".")
    if names[0] in effects.EFFECTS:
        names.insert(0, "effects")
    for inner in reversed(names):
        value = {inner: value}
    return written.changed(value)
