"""An experiment as files write it, merged with the experiments that it extends, with its sweep.

A sweep gives the values of r, beta and seeds, and may have a third axis, with its labels: a
parameter of an effect, as EFFECT.PARAMETER, such as `spin.inertia: ["1", "0.1"]`; a quantity of a
species, as species.NAME.KEY, where KEY may also be a key of its distribution of radii; a length of
the schedule, as schedule.KEY; the number of `particles`; the width of the `box`, whose other sides
keep their proportion to it; the `packing`; or a `case`, the name of settings that vary together.
Each label makes a variant of the experiment, named EXPERIMENT/PARAMETERLABEL, such as
mine/inertia0.1: an experiment whose settings have that value.

Labels are numbers or words as a user wrote them, such as 0.90; their spelling in paths is unique,
such as 0.9 (roughgas.base.labels).
"""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from roughgas.base import InputError, check_one_of, from_json, merged, short_repr, sorted_json
from roughgas.base.fields import RawSettings, read
from roughgas.base.labels import (
    SPECIES_PREFIX,
    SWEPT,
    level,
    level_in,
    names_of,
    numbers_of,
    parameter_of,
    parser_of,
    restitution,
    roughness,
    species_settings,
    spelling,
)
from roughgas.config import shaken_layer

if TYPE_CHECKING:
    from roughgas.simulation.experiment import Experiment

# effects and schedules are imported inside functions: listing experiments needs neither

CASE = "case"
"""Third axis whose labels are names of settings that vary together."""
SEEDS = "seeds"
GRID_AXES = ("r", "beta", SEEDS)
"""Axes of every sweep; any other key of a sweep is its third axis."""
PACKING = "packing"
"""Key of the volume fraction; `box` then gives proportions only."""
ATTRIBUTES = ("experiment", "scale", "dimension", "swept", "variant", "command", "title", "theory")
"""Attributes of datasets that no swept parameter may be called like."""
SEEDS_PER_JOB = 4
PACKING_TOLERANCE = 1e-9  # relative deviation of the packing of a given box
MAX_SIDE = 1e9  # a


class PointBlock(NamedTuple):
    """Points of a sweep: all combinations of labels; a wildcard stands for any r or beta."""

    r: list[str]
    betas: list[str]
    seeds: list[str]

    @property
    def points(self) -> list[tuple[str, str, str]]:
        """The labels (r, beta, seed) of all points; the seed varies fastest."""
        return [*itertools.product(*self)]


@dataclass(frozen=True)
class WrittenExperiment:
    """An experiment as files write it, merged; `raw` may lack settings, or have illegal ones."""

    raw: RawSettings

    @classmethod
    def from_text(cls, text: str, source: str) -> "WrittenExperiment":
        """Return the experiment from JSON `text`, after a check of its form.

        Raises InputError, whose key begins with `source`.
        """
        from roughgas.config.forms import PointForm

        raw = from_json(text, source)
        PointForm.check(raw, source)
        return cls(raw)

    # ------------------------------------------------------------------ settings

    def changed(self, changes: RawSettings) -> "WrittenExperiment":
        """Return the experiment with changes merged in; to be `fitted` after the last changes.

        A `packing` turns an inherited box into mere proportions. A `box` merged later gives the
        proportions for an inherited packing, or contradicts it, and `fitted` then refuses it:
        `packing: null` removes the packing. Changing the `kind` of the schedule discards inherited
        schedule keys.
        """
        raw = self.raw
        schedules = [settings.get("schedule") for settings in (raw, changes)]
        kinds = [
            schedule.get("kind") if isinstance(schedule, Mapping) else None
            for schedule in schedules
        ]
        if None not in kinds and kinds[0] != kinds[1]:
            raw = {**raw, "schedule": {}}
        result = merged(WrittenExperiment(raw)._without_implied().raw, changes)
        is_shape = "box" not in changes and "open" not in raw.get("box", ["open"])
        if PACKING in result and is_shape:
            result["box"] = [side / min(raw["box"]) for side in raw["box"]]
        return WrittenExperiment(result)

    def fitted(self, key: str) -> "WrittenExperiment":
        """Return the experiment with the settings that its layer implies, and its box fitted.

        A box is scaled to the packing, if one is given; its sides are in particle radii a. Illegal
        values are left to the check of settings. Raises InputError, whose key begins with `key`,
        for a packing of an open box, for a box of another packing, and for a box that would be too
        large.
        """
        raw = dict(self._with_implied(key).raw)
        target, particles = raw.get(PACKING), raw.get("particles")
        if not isinstance(target, int | float) or not target > 0 or not isinstance(particles, int):
            return WrittenExperiment(raw)
        from roughgas.effects.species import packing  # needs numpy
        from roughgas.scene.settings import scene_settings

        box = raw.setdefault("box", [1, 1])
        if "open" in box:
            raise InputError(
                f"{key}.{PACKING}", target, "not be given for a box that is open above"
            )
        current = packing(scene_settings(raw, key))
        if abs(current - target) <= PACKING_TOLERANCE * target:
            return WrittenExperiment(raw)
        if min(box) != 1:
            legal = f"not stand beside packing = {target}; or be proportions, the least 1: [1, 2]; "
            legal += "`packing: null` takes an inherited packing away"
            raise InputError(f"{key}.box", box, legal)
        length = (current / target) ** (1.0 / len(box))
        if not math.isfinite(length) or length * max(box) > MAX_SIDE:
            legal = f"be so large that no side of the box is longer than {MAX_SIDE:g} a"
            raise InputError(f"{key}.{PACKING}", target, legal)
        return WrittenExperiment(raw | {"box": [length * side for side in box]})

    def _implied(self) -> dict[shaken_layer.SettingPath, Any]:
        """Return the settings implied by its shaken layer, by their paths.

        There are none without a layer, or if it or gravity is illegal, which the check of settings
        reports.
        """
        gravity = (self.raw.get("effects", {}).get("gravity") or {}).get("acceleration")
        if (
            not self.raw.get(shaken_layer.LAYER)
            or not isinstance(gravity, int | float)
            or gravity <= 0
        ):
            return {}
        try:
            layer = read(
                shaken_layer.LayerSettings, self.raw[shaken_layer.LAYER], shaken_layer.LAYER
            )
        except InputError:
            return {}
        return shaken_layer.implied(layer, gravity)

    def _with_implied(self, key: str) -> "WrittenExperiment":
        """Return the experiment with the settings implied by its shaken layer.

        Raises InputError, whose key begins with `key`, for a setting that has another value.
        """
        raw = dict(self.raw)
        for path, value in self._implied().items():
            parent = _mapping_at(raw, path[:-1])
            current = parent.get(path[-1])
            if current is not None and not shaken_layer.agree(current, value):
                legal = f"not be given beside layer, which makes it {value}"
                raise InputError(".".join([key, *path]), current, legal)
            parent[path[-1]] = value
        return WrittenExperiment(raw)

    def _without_implied(self) -> "WrittenExperiment":
        """Return the experiment with its shaken layer, but without the settings implied by it."""
        raw = dict(self.raw)
        for path in self._implied():
            _mapping_at(raw, path[:-1]).pop(path[-1], None)
        return WrittenExperiment(raw)

    def experiment(self, key: str) -> "Experiment[Any]":
        """Return the settings that all its points share, read and checked: one Experiment.

        Raises InputError, whose key begins with `key`, for missing and illegal settings.
        """
        from roughgas.config.forms import PointForm
        from roughgas.simulation.experiment_reader import read_experiment

        PointForm.check(self.raw, key)
        if layer := self.raw.get(shaken_layer.LAYER):
            read(shaken_layer.LayerSettings, layer, f"{key}.{shaken_layer.LAYER}")
        return read_experiment(self.fitted(key).raw, key)

    def for_points(self) -> "WrittenExperiment":
        """Return the experiment with only those settings which affect its points."""
        from roughgas.simulation.experiment import KEYS_OF_NO_POINT

        return WrittenExperiment({k: v for k, v in self.raw.items() if k not in KEYS_OF_NO_POINT})

    @property
    def text(self) -> str:
        """The settings of its points as JSON with sorted keys; equal settings have equal texts."""
        return sorted_json(self.for_points().raw)

    @property
    def kernel_text(self) -> str:
        """The settings that determine its compiled kernels, including the third axis, as JSON."""
        key = self.third_axis
        sweep = {} if key is None else {"sweep": {key: self.raw["sweep"][key]}}
        return sorted_json({**self.for_points().raw, **sweep})

    # ------------------------------------------------------------------ sweep

    @property
    def axes(self) -> list[str]:
        """The keys of its sweep: r, beta, `seeds` and any third axis."""
        return list(self.raw.get("sweep", {}))

    def labels(self, axis: str) -> list[Any]:
        """Return the labels along an axis of its sweep other than `seeds`; of `case`, the names."""
        return list(self.raw["sweep"][axis])

    @property
    def seeds(self) -> int:
        """The number of independent runs, with the seeds 1, 2, ..., of each (r, beta)."""
        return int(self.raw["sweep"][SEEDS])

    @property
    def third_axis(self) -> str | None:
        """The key of the third axis of its sweep, a setting such as "spin.inertia", or None."""
        return next((axis for axis in self.axes if axis not in GRID_AXES), None)

    def points(self) -> Iterator[tuple[str, str, str]]:
        """Yield the labels (r, beta, seed) of all points of the experiment, or of each variant."""
        seeds = map(str, range(1, self.seeds + 1))
        yield from itertools.product(self.labels("r"), self.labels("beta"), seeds)

    def blocks(
        self,
        betas_per_job: int = 1,
        seeds_per_job: int = SEEDS_PER_JOB,
        last: bool = False,
        is_short: bool = False,
    ) -> list[PointBlock]:
        """Return the blocks of points that jobs run, such as (["{r}"], ["0", "0.5"], ["1", "2"]).

        A job runs at most `betas_per_job` betas, unless the experiment has its own number, and
        `seeds_per_job` seeds, at one r, or at all r of an experiment that `is_short`. The label of
        a single r or beta is a wildcard. Blocks have two points or more: a single remaining point
        is in no block, and has a separate job. For the experiment that runs `last`, a block has at
        most half of the remaining betas, so that all cores finish at about the same time.
        """
        labels = [str(number) for number in range(1, self.seeds + 1)]
        by_seed, every_r = _chunks(labels, seeds_per_job), self.labels("r")
        betas, size = self.labels("beta"), self.raw.get("betas_per_job", betas_per_job)
        by_beta = [["{beta}"]] if size == 1 else _chunks(betas, size, 2 if last else 1)
        r = every_r if is_short and len(every_r) > 1 else ["{r}"]
        blocks = [PointBlock(r, betas, seeds) for betas in by_beta for seeds in by_seed]
        return [block for block in blocks if len(block.points) > 1]

    def spelled(self) -> "WrittenExperiment":
        """Return the experiment with the labels of its sweep spelled as in paths: 0.9 for 0.90.

        An axis with a repeated number stays unchanged, so that the error of `check_grid` quotes the
        label as the user wrote it.
        """
        axes = {
            axis: [spelling(parser_of(axis)(label)) for label in self.labels(axis)]
            for axis in self.axes
            if axis not in (SEEDS, CASE)
        }
        axes = {axis: labels for axis, labels in axes.items() if len(set(labels)) == len(labels)}
        if not axes:
            return self
        return WrittenExperiment({**self.raw, "sweep": {**self.raw["sweep"], **axes}})

    # ------------------------------------------------------------------ variants

    def variants(self, name: str) -> list[str]:
        """Return the names of all variants in the sweep of the experiment `name`.

        Without a third axis they are [name].
        """
        key = self.third_axis
        if key is None:
            return [name]
        return [f"{name}/{parameter_of(key)}{label}" for label in self.labels(key)]

    def every_variant(self, name: str) -> dict[str, "WrittenExperiment"]:
        """Return the variants in the sweep by name; without a third axis the experiment itself."""
        if self.third_axis is None:
            return {name: self}
        return {variant: self.variant(variant) for variant in self.variants(name)}

    def variant(self, name: str) -> "WrittenExperiment":
        """Return the variant `name`, EXPERIMENT/PARAMETERLABEL; its label need not be in the sweep.

        Raises InputError for other names.
        """
        base, _, folder = name.partition("/")
        key = self.third_axis
        if key is None:
            raise InputError(
                "experiment", short_repr(name), f"be {base} alone, which has no third axis"
            )
        parameter = parameter_of(key)
        if not folder.startswith(parameter):
            legal = f"name a value of {parameter}, such as {self.variants(base)[0]}"
            raise InputError("experiment", short_repr(name), legal)
        if folder == parameter:
            legal = f"have a value after {parameter}, such as {self.variants(base)[0]}"
            raise InputError("experiment", short_repr(name), legal)
        value = level(folder.removeprefix(parameter), f"{base}: {key}")
        return self.at_level(key, value, as_variant=True).fitted(f"experiments.{name}")

    def at_level(self, key: str, value: Any, as_variant: bool = False) -> "WrittenExperiment":
        """Return the experiment with a value of the parameter `key` of a third axis.

        It is to be `fitted`. `as_variant` removes the third axis from the sweep, and records the
        swept parameter. Raises InputError for a case that the sweep does not have.
        """
        name, _, parameter = key.rpartition(".")
        changes: dict[str, Any]
        if key == CASE:
            cases = self.raw["sweep"][CASE]
            check_one_of("case", str(value), cases)
            changes = {**cases[str(value)], CASE: value}
        elif name.startswith(SPECIES_PREFIX):
            changes = {"species": deepcopy(self.raw["species"])}
            if (settings := species_settings(changes["species"], name, parameter)) is not None:
                settings[parameter] = value
        elif name and name != "schedule":
            changes = {"effects": {name: {parameter: value}}}
        else:
            if isinstance(value, float) and value.is_integer():
                value = int(value)  # as in config.yaml
            if key == "box" and not isinstance(value, str):  # keep the proportions
                width, *sides = self.raw[key]
                value = [
                    value,
                    *(side if side == "open" else side * value / width for side in sides),
                ]
            changes = {name: {parameter: value}} if name else {key: value}
        return self.changed(changes | ({"sweep": {key: None}, SWEPT: key} if as_variant else {}))

    def spelled_name(self, name: str) -> str:
        """Return the `name` of this experiment or variant, with its label spelled as in paths.

        Raises InputError for a value that is neither a number nor a word.
        """
        base, slash, label = name.partition("/")
        parameter = parameter_of(self.raw.get(SWEPT, ""))
        if not slash or not parameter:
            return name
        value = level(label.removeprefix(parameter), f"{base}: {self.raw[SWEPT]}")
        return f"{base}/{parameter}{spelling(value)}"

    def check_has_points(self, name: str) -> None:
        """Raise InputError if its points belong to variants: then `name` must select a variant."""
        if self.third_axis is not None:
            legal = f"be followed by a variant, such as {self.variants(name)[0]}"
            raise InputError("experiment", short_repr(name), legal)

    def lacks_level(self, changed: "WrittenExperiment") -> bool:
        """Return whether the experiment `changed` lacks the parameter swept by this one."""
        key = self.third_axis
        return key is not None and level_in(changed.raw, key) is None

    # ------------------------------------------------------------------ checks

    def check_grid(self, key: str) -> None:
        """Raise InputError, whose key begins with `key`, for illegal axes r, beta and seeds."""
        from roughgas.config.forms import GridSettings

        axes = {axis: self.raw["sweep"][axis] for axis in GRID_AXES if axis in self.axes}
        read(GridSettings, axes, f"{key}.sweep")
        for axis, parse in (("r", restitution), ("beta", roughness)):
            numbers_of(f"{key}.sweep.{axis}", self.labels(axis), parse)

    def check_third_axis(self, key: str) -> None:
        """Raise InputError, whose key begins with `key`, for an illegal third axis.

        Illegal are two third axes, an absent parameter, and equal levels. A parameter is absent if
        the experiment does not list its effect, or its schedule does not have that length. The
        settings of the variants are not checked.
        """
        key_of_axis = f"{key}.sweep: key"
        axes = [axis for axis in self.axes if axis not in GRID_AXES]
        for axis in axes[1:]:
            raise InputError(key_of_axis, short_repr(axis), f"not stand beside {axes[0]}")
        for axis in axes:
            if legal := self._legal_in_place_of(axis):
                raise InputError(key_of_axis, short_repr(axis), legal)
            if axis == CASE:
                continue
            if "." not in axis and axis not in self.raw and not self._is_packing_of_box(axis):
                raise InputError(f"{key}.{axis}", "(nothing)", "be given, as it is swept")
            numbers_of(f"{key}.sweep.{axis}", self.labels(axis), level)

    def _is_packing_of_box(self, axis: str) -> bool:
        """Return whether the axis is `packing`, and a box is given whose sides it can scale."""
        return axis == PACKING and "box" in self.raw

    def _legal_in_place_of(self, axis: str) -> str:
        """Return the legal alternatives to the key `axis` of a third axis; "" if it is legal."""
        name, _, parameter = axis.rpartition(".")
        listed, schedule = self.raw.get("effects", {}), self.raw.get("schedule", {})
        species = self.raw.get("species") or []
        if name == "schedule" and parameter not in schedule:
            return f"name a length of this schedule: {', '.join(sorted(schedule))}"
        if name.startswith(SPECIES_PREFIX):
            names = ", ".join(names_of(species)) or "there are none"
            return (
                f"name one of species: {names}" if species_settings(species, name) is None else ""
            )
        if name not in ("", "schedule", *listed):
            return f"begin with an effect of this experiment: {', '.join(sorted(listed))}"
        if name and parameter in self._names_in_datasets():
            return f"be a parameter of another name: datasets have a {parameter} already"
        return "not be swept beside packing" if axis == "box" and PACKING in self.raw else ""

    def _names_in_datasets(self) -> set[str]:
        """Return the names that no swept parameter may have, as it names a dimension of datasets.

        Parameters that theory needs take the place of the attribute.
        """
        from roughgas.data.variables import POINT

        observables = self.raw.get("observables") or {}
        return {*POINT, *observables, *ATTRIBUTES} - {"inertia", "mu", "spin_share"}


def _mapping_at(tree: Any, path: shaken_layer.SettingPath) -> Any:
    """Return the mapping at a path in nested mappings, after a copy of each on the path.

    Thus changes to the result do not alter the mappings that `tree` was copied from.
    """
    for key in path:
        tree[key] = dict(tree.get(key) or {})
        tree = tree[key]
    return tree


def _chunks(labels: Sequence[str], size: int, shares: int = 1) -> list[list[str]]:
    """Return labels in chunks of at most `size`, and of at most 1/`shares` of those remaining."""
    chunks, remaining = [], list(labels)
    while remaining:
        length = min(size, math.ceil(len(remaining) / shares))
        chunks.append(remaining[:length])
        remaining = remaining[length:]
    return chunks
