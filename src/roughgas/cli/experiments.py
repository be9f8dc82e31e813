"""`roughgas experiments`: the list of the experiments of a configuration."""

from fnmatch import fnmatchcase
from math import prod
from pathlib import Path
from textwrap import fill

from roughgas import config
from roughgas.base import InputError, NamedValues, Record, as_json, on_one_line, short_repr
from roughgas.cli.parser import WIDTH


def print_experiments(pattern: str, scale: str, path: str | Path, json: bool) -> None:
    """Print the experiments of the configuration at `path` whose names match a shell pattern, with
    their sweeps at the scale called `scale`; with `json` as JSON.

    Raises InputError if no name matches, and OSError.
    """
    configuration = config.load(path)
    records = {}
    for name, raw in _matching(pattern, configuration.experiments).items():
        experiment = configuration.experiment(name, scale)
        axes = [experiment.third_axis, "r", "beta"]
        sweep = {axis: experiment.labels(axis) for axis in axes if axis}
        points = prod(map(len, sweep.values()))
        metadata = {"description": raw.get("description", ""), "extends": raw.get("extends")}
        records[name] = metadata | {"points": points, "sweep": sweep}
    if json:
        print(as_json(records))
    else:
        print("\n\n".join(_experiment_text(name, metadata) for name, metadata in records.items()))


def _matching(pattern: str, experiments: Record) -> NamedValues:
    """Return the experiments, settings by name, whose names match a shell pattern,
    case-sensitively.

    Raises InputError if there are none.
    """
    matches = {name: raw for name, raw in experiments.items() if fnmatchcase(name, pattern)}
    if not matches:
        wider_pattern = f"*{pattern.strip('*')}*"
        has_matches = any(fnmatchcase(name, wider_pattern) for name in experiments)
        hint = (
            f"as {wider_pattern!r} does"
            if has_matches
            else f"such as {', '.join(list(experiments)[:3])}"
        )
        raise InputError("pattern", short_repr(pattern), f"match the name of an experiment, {hint}")
    return matches


def _experiment_text(name: str, record: Record) -> str:
    """Return the entry of the experiment `name` in the list as text: name, description, size of the
    sweep.

    `record` has its `description`, the experiment that it `extends` (or None), its number of
    `points`, and the labels of each axis of its `sweep`.
    """
    counts = ", ".join(f"{len(labels)} {key}" for key, labels in record["sweep"].items())
    extends = f"; extends {record['extends']}" if record["extends"] else ""
    description = on_one_line(" ".join(record["description"].split()))
    lines = [name, fill(description, WIDTH, initial_indent="  ", subsequent_indent="  ")]
    return "\n".join([*lines, f"  {record['points']} points: {counts}{extends}"])
