"""Points and kernels of experiments: their files, their settings, and the priorities of their jobs.

A kernel is the compiled code of a simulation, which a job of its own makes before the points that
need it. Jobs with a larger priority start first.

Parameters named after wildcards take their values: `scale`, such as "small", `experiment` (or a
variant of it), `r` (normal restitution), `beta` (roughness) and `seed`, as labels, the spellings of
numbers in paths. All methods raise InputError for unknown names and illegal settings.
"""

import functools
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from roughgas.base import InputError
from roughgas.base.files import code_in, code_of
from roughgas.base.labels import GridPoint, grid_points, restitution
from roughgas.config import Configuration, WrittenExperiment, study_code
from roughgas.simulation.experiment import Experiment
from roughgas.workflow import jobs
from roughgas.workflow.fingerprints import code_of_points, with_files
from roughgas.workflow.paths import KERNEL, POINT, REDUCED, labels_of_point
from roughgas.workflow.wildcards import located

URGENT = 10**12
"""Priority of a job that should start at once."""
PRIORITY_STEP = 10**10
"""Difference in priority between experiments: more than the collisions of any job."""


class Sweeps:
    """The sweeps of all experiments of a configuration, each read and checked once."""

    def __init__(self, configuration: Configuration, ordered: Sequence[str]) -> None:
        """Prepare caches of settings by scale and experiment.

        The experiments `ordered`, given by their names, run one after the other, in this order,
        before all others.
        """
        self.configuration, self.ordered = configuration, list(ordered)
        # caches of instances, which are freed with them, unlike caches of methods
        self.checked = functools.cache(self._checked)
        self.point_settings = functools.cache(self._point_settings)
        self.kernel_kinds = functools.cache(self._kernel_kinds)
        self.collisions = functools.cache(self._collisions)
        self.codes_of_studies = functools.cache(self._codes_of_studies)
        self.study_options = functools.cache(self._study_options)

    def _checked(
        self, scale: str, experiment: str
    ) -> tuple[WrittenExperiment, list[Experiment[Any]]]:
        """Return an experiment as files write it, and the settings of points of each variant."""
        from roughgas.simulation.protocols import check_experiment

        with located(f"results/{scale}/{experiment}"):
            written = self.configuration.experiment(experiment, scale)
        variants = []
        for name, variant in written.every_variant(experiment).items():
            with located(f"config.yaml: experiments.{name} at scale {scale}"):
                variants.append(variant.experiment(""))
                check_experiment(variants[-1])
        return written, variants

    def written(self, scale: str, experiment: str) -> WrittenExperiment:
        """Return an experiment, or a variant, as files write it, checked."""
        return self.checked(scale, experiment)[0]

    # ---------------------------------------------------------------- files

    def points(self, scale: str, experiment: str) -> list[str]:
        """Return the paths of all points in the sweep of an experiment."""
        written = self.written(scale, experiment)
        return [
            POINT.format(scale=scale, experiment=variant, r=r, beta=beta, seed=seed)
            for variant in written.variants(experiment)
            for r, beta, seed in written.points()
        ]

    def reduced(self, scale: str, experiments: Iterable[str]) -> list[str]:
        """Return the paths of the reduced datasets of experiments at a scale.

        Raises InputError for experiments that are unknown or illegal.
        """
        names = list(experiments)
        for experiment in names:
            self.written(scale, experiment)
        return [REDUCED.format(scale=scale, experiment=experiment) for experiment in names]

    def kernel(self, scale: str, experiment: str, r: str, beta: str = "0", seed: str = "1") -> str:
        """Return the path of the file that marks the kernel of a point as compiled.

        A kernel is compiled at the first r of the sweep that needs it. Raises InputError also for a
        point whose path spells a number in another way.
        """
        with located(f"results/{scale}/{experiment}"):
            point = _point(r, beta, seed)
            written = self.written(scale, experiment)
            written.check_has_points(experiment)
        labels = {"r": r, "beta": beta, "seed": seed}
        self._check_spelling(POINT, scale, experiment, labels, point)
        base, _, _ = experiment.partition("/")
        kinds = self.kernel_kinds(scale, base, r)
        swept = self.written(scale, base).labels("r")
        matching_labels = (
            label for label in swept if self.kernel_kinds(scale, base, label) == kinds
        )
        return KERNEL.format(scale=scale, experiment=base, r=next(matching_labels, r))

    def _check_spelling(
        self, path: str, scale: str, experiment: str, labels: dict[str, str], point: GridPoint
    ) -> None:
        """Raise InputError for a path with another spelling of a number than in results.

        It would be a second file of the same point. `path` is a pattern such as POINT, `labels` are
        the numbers as they stand in the path, `point` has their spellings.
        """
        spelled = dict(zip(("r", "beta", "seed"), point.labels, strict=True))
        name = self.written(scale, experiment).spelled_name(experiment)
        if name != experiment or any(spelled[key] != label for key, label in labels.items()):
            legal = path.format(scale=scale, experiment=name, **spelled)
            present = path.format(scale=scale, experiment=experiment, **{**spelled, **labels})
            rule = f"be {legal}: a number has one spelling in paths"
            raise InputError("path", present, rule)

    # ---------------------------------------------------------------- settings and code

    def _point_settings(self, scale: str, experiment: str) -> str:
        """Return all settings that determine the points of an experiment, or variant, as JSON."""
        return self.written(scale, experiment).text

    def point_code(self, scale: str, experiment: str) -> str:
        """Return the fingerprint of the code of points, of files of radii, and of studies' code."""
        code = with_files(code_of_points(), self.point_settings(scale, experiment))
        return " ".join([code, *self.codes_of_studies(scale, experiment)])

    def _codes_of_studies(self, scale: str, experiment: str) -> list[str]:
        """Return the fingerprint of each file of a study whose effects or observables it has."""
        return [
            code_in(folder, file)
            for folder, file in study_code.used_files(*self._names_in_use(scale, experiment))
        ]

    def _study_options(self, scale: str, experiment: str) -> list[str]:
        """Return the options of jobs for the effects and observables of studies; [] without any."""
        return study_code.options(*self._names_in_use(scale, experiment))

    def _names_in_use(self, scale: str, experiment: str) -> tuple[list[str], list[str]]:
        """Return the names of the effects and of the observables of an experiment, made legal."""
        raw = self.written(scale, experiment).raw
        self.configuration.use_names(experiment)
        return [*raw["effects"]], [*(raw.get("observables") or ())]

    @staticmethod
    def kernel_code() -> str:
        """Return the fingerprint of the code that is compiled to kernels."""
        return code_of("simulation.point")

    def kernel_settings(self, scale: str, experiment: str) -> str:
        """Return the settings that determine the compiled kernels of an experiment, as JSON."""
        return self.written(scale, experiment).kernel_text

    def _kernel_kinds(self, scale: str, experiment: str, r: str) -> list[str]:
        """Return the kernels that the variants of an experiment need at some r.

        Each is a text that describes its types; points with equal texts share a kernel.
        """
        from roughgas.simulation.point import kernels

        _, variants = self.checked(scale, experiment)
        self.configuration.use_names(experiment)
        with located(KERNEL.format(scale=scale, experiment=experiment, r=r)):
            number = restitution(r)
        return sorted(map(str, kernels(variants, number)))

    def kernel_kinds_of_path(self, scale: str, experiment: str, r: str) -> list[str]:
        """Return the kernels, as text, that the job of a file KERNEL compiles.

        Raises InputError for another spelling of r than in results.
        """
        kinds = self.kernel_kinds(scale, experiment, r)
        self._check_spelling(KERNEL, scale, experiment, {"r": r}, _point(r, "0", "1"))
        return kinds

    # ---------------------------------------------------------------- jobs

    def blocks(self) -> Iterator[jobs.Block]:
        """Yield the blocks of points that jobs make, at the default scale of the configuration."""
        last = self.ordered[-1] if self.ordered else ""
        scale = self.configuration.scale
        return jobs.blocks(
            self.configuration, scale, last, functools.partial(self._is_short, scale)
        )

    def _is_short(self, scale: str, experiment: str) -> bool:
        """Return whether the sweep of an experiment, or of each variant, takes a few seconds.

        All betas count as beta = 0. An illegal experiment is not short: its jobs refuse it.
        """
        try:
            written = self.written(scale, experiment)
            of_points = [self.collisions(scale, experiment, r, "0") for r in written.labels("r")]
        except InputError:
            return False
        collisions = sum(of_points) + jobs.COLLISIONS_OF_POINT * len(of_points)
        return collisions * len(written.labels("beta")) * written.seeds <= jobs.SHORT_SWEEP

    def _collisions(self, scale: str, experiment: str, r: str, beta: str) -> float:
        """Return an estimate of the number of collisions in a point, of the first variant."""
        from roughgas.simulation.point import expected_collisions

        point = _point(r, beta, "1")
        _, (settings, *_) = self.checked(scale, experiment)
        self.configuration.use_names(experiment)
        return expected_collisions(
            settings, point.r, point.beta if "spin" in settings.effects else -1.0
        )

    def _base_priority(self, experiment: str) -> int:
        """Return the priority of an experiment's jobs, without their length.

        It is 0 for experiments outside the fixed order.
        """
        base, _, _ = experiment.partition("/")
        rank_from_last = len(self.ordered) - self.ordered.index(base) if base in self.ordered else 0
        return rank_from_last * PRIORITY_STEP

    def kernel_priority(self, experiment: str) -> int:
        """Return the priority of the job that compiles a kernel of an experiment.

        It is above the priority of the experiment's points, and not above points of experiments
        that run earlier.
        """
        return self._base_priority(experiment) + PRIORITY_STEP

    def priority(self, points: int, scale: str, experiment: str, r: str, beta: str = "0") -> float:
        """Return the priority of a job of a number of `points`, which grows with its collisions.

        The longest jobs of an experiment start first, so that no long job remains at the end. A job
        of several betas counts as beta = 0, a job of several r as one of them.
        """
        length = points * self.collisions(scale, experiment, r, beta)
        return self._base_priority(experiment) + min(length, PRIORITY_STEP - 1)

    def minutes(
        self, points: int, attempt: int, scale: str, experiment: str, r: str, beta: str = "0"
    ) -> int:
        """Return the limit of the run time of a job of a number of `points`, in minutes.

        It grows with the attempt, which counts from 1. Jobs of several points count as in
        `priority`.
        """
        return jobs.minutes(points * self.collisions(scale, experiment, r, beta), attempt)

    def megabytes(self, attempt: int, scale: str, experiment: str) -> int:
        """Return the memory that a job of points requests, in MB; it grows with the attempt."""
        _, variants = self.checked(scale, experiment)
        return jobs.megabytes(max(settings.particles for settings in variants), attempt)


def _point(r: str, beta: str, seed: str) -> GridPoint:
    """Return the numbers and spellings of a point from its labels.

    Raises InputError for illegal labels.
    """
    (point,) = grid_points([r], [beta], [seed])
    return point


def points_of_job(outputs: Iterable[str]) -> list[str]:
    """Return the options of `roughgas run` for the points at the paths `outputs`.

    These are all combinations of some r, betas and seeds.
    """
    points = map(labels_of_point, outputs)
    r, betas, seeds = (dict.fromkeys(labels) for labels in zip(*points, strict=True))
    options = [f"--r={label}" for label in r] + [f"--beta={label}" for label in betas]
    return [*options, "--seed", *seeds]
