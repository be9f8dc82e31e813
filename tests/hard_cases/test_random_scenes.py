"""Random scenes."""

import hashlib
import itertools
import math
import multiprocessing
import os
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing, suppress

import numba
import pytest
from brute_force import KERNELS
from hypothesis import Phase, given, settings
from raw import build, check

from hard_cases.catalogue import errors_of_share
from hard_cases.compositions import (
    PARAMETERS,
    covering,
    is_legal,
    mixtures,
    parameters,
    scenes,
    sets_to_judge,
    with_needs,
)
from hard_cases.violations import Violations, violations_in
from roughgas.base import InputError
from roughgas.base.fields import fields_of
from roughgas.effects import EFFECTS

QUICK_KERNELS = ("friction", "sheared", "walled", "shaken", "heated", "spheres")
QUICK_COMPOSITIONS = [
    (
        set(KERNELS[name]["effects"]),
        len(KERNELS[name]["box"]),
        "sawtooth",
    )  # wave form of the floor, if any
    for name in QUICK_KERNELS
]
"""Compositions that other tests run as well: each compiles a kernel."""

QUICK_MIXTURES = [(set(KERNELS["gas"]["effects"]), 2, "sawtooth")]
"""The composition of which other tests run mixtures as well."""


INVALID_VALUES = (math.nan, math.inf, -7, "no word", None, True, [], {})
"""Values that no parameter may have, except None for parameters with a default."""


@pytest.mark.slow
def test_every_set_of_effects_is_accepted_or_refused_in_one_line(margins):
    """Sets of effects in two and three dimensions, closed and open above, and with invalid values.

    compositions.py states the legal sets and the sets to try.
    """
    assert set(PARAMETERS) == set(EFFECTS)
    tried = misjudged = junk = accepted = 0

    @settings(
        max_examples=margins.size(1, 30), phases=[Phase.generate], derandomize=True, database=None
    )
    @given(parameters([*EFFECTS]), parameters([name for name in EFFECTS if name != "spin"]))
    def judge_all_sets(spinning, smooth):
        nonlocal tried, misjudged, junk, accepted
        for effects in sets_to_judge():
            chosen = {name: (spinning if "spin" in effects else smooth)[name] for name in effects}
            for dimension, top in ((2, 30), (2, "open"), (3, 30), (3, "open")):
                is_open = "gravity" in effects and "lid" not in effects
                legal = is_legal(effects, dimension) and (top == "open") == is_open
                misjudged += accepts(chosen, dimension, top) != legal
                tried += 1
                minimal = legal and any(effects == with_needs({effect}) for effect in effects)
                for changed in spoiled(chosen) if minimal else ():
                    accepted += accepts(changed, dimension, top)
                    junk += 1

    judge_all_sets()
    margins.at_most("sets of effects misjudged", misjudged, 0, tried, "sets and boxes")
    margins.at_most("parameters that are none, and accepted", accepted, 0, junk, "of legal sets")


def spoiled(effect_settings):
    """Yield the settings with each parameter in turn at each invalid value."""
    for name in effect_settings:
        for field in fields_of(EFFECTS[name].settings):
            either_sign = any(f"in [-1{power}" in field.legal for power in ("e", "0"))
            for value in INVALID_VALUES:
                legal = value == -7 and either_sign  # as of a velocity
                if not legal and (value is not None or field.required):
                    yield effect_settings | {name: effect_settings[name] | {field.name: value}}


def accepts(effects, dimension, top):
    """Whether `build` and `check` accept a scene; fails on errors except one-line InputErrors."""
    experiment = {"particles": 5, "box": [30] * (dimension - 1) + [top], "effects": effects}
    verdicts = {
        verdict(build, experiment, 0.9, 0.3 if "spin" in effects else -1.0),
        verdict(check, experiment),
    }
    assert len(verdicts) == 1, experiment
    return verdicts.pop()


def verdict(judge, *arguments):
    """Whether a function accepts its arguments, or refuses them in one line."""
    try:
        judge(*arguments)
    except InputError as error:
        assert "\n" not in str(error) and (": must " in str(error) or " needs " in str(error))
        return False
    return True


@pytest.mark.slow
def test_invariants_of_random_scenes(margins):
    """Energy balance, momentum, bounds and friction, to rounding.

    A particle may be trapped for ever in the corner of a rising rough floor and a rough wall: then
    the simulation must stop with an error.
    """
    compositions = QUICK_COMPOSITIONS + covering(3) if margins.full else QUICK_COMPOSITIONS
    check_invariants(margins, map(scenes, compositions), margins.size(15, 25))


def test_invariants_of_random_mixtures(margins):
    """The same for up to three species of any material, with masses that differ by 1e6."""
    compositions = covering(2) if margins.full else QUICK_MIXTURES
    check_invariants(margins, map(mixtures, compositions), margins.size(12, 40))


def check_invariants(margins, strategies, number):
    """Simulate a number of scenes of each strategy, and measure violations of their invariants.

    In full, each kernel runs in a new process: numba never frees the memory of compiling, and
    dozens of kernels would take several GB.
    """
    groups = scenes_by_kernel(strategies, number)
    violations_by_kernel = [*violations_of_groups(groups, margins)]
    assert all(violations.tried for violations in violations_by_kernel), "a kernel without a scene"
    violations = sum(violations_by_kernel, Violations())
    tried = {"tried": violations.tried, "unit": f"scenes, {violations.collisions} contacts"}
    quantity = "error of the energy balance, in roundings per exchange"
    margins.at_most(quantity, violations.imbalance, 10.0, **tried)
    margins.at_most("energy that contacts give, over all", violations.gained, 1e-12, **tried)
    quantity = "momentum gained without boundaries, over the sum of speeds"
    margins.at_most(quantity, violations.momentum, 1e-12, **tried)
    margins.at_most("impulses beyond the cone of friction", violations.cone, 1e-10, **tried)
    margins.at_most("overlap, in a", violations.overlap, 1e-11, **tried)
    margins.at_most("depth in a wall or the floor, in a", violations.outside, 1e-11, **tried)
    margins.at_most("scenes with numbers that are none", violations.broken, 0, **tried)
    margins.at_most("samples earlier than the one before", violations.backwards, 0, **tried)
    given_up = violations.given_up / violations.tried
    # Hypothesis varies earlier examples: several of few scenes may be variants of a collapsing one
    limit = 0.05 + errors_of_share(0.05, violations.tried)
    margins.at_most("share of scenes that are stopped", given_up, limit, **tried)


def violations_of_groups(groups, margins):
    """Yield the Violations of each group, simulated or from an earlier run."""
    names = [hashlib.sha256(repr(group).encode()).hexdigest() for group in groups]
    unfinished = [
        group for group, name in zip(groups, names, strict=True) if name not in margins.finished
    ]
    simulated = (
        violations_in_processes(unfinished)
        if margins.full
        else (violations_in(group) for group in unfinished)
    )
    done, total = 0, sum(map(len, groups))
    with closing(simulated):
        for group, name in zip(groups, names, strict=True):
            margins.progress.reach(done, total, "scenes")
            if name not in margins.finished:
                margins.finished[name] = vars(next(simulated))
            done += len(group)
            yield Violations.from_numbers(margins.finished[name])
    margins.progress.reach(done, total, "scenes")


def scenes_by_kernel(strategies, number):
    """Return random scenes (experiment, r, beta, seed), grouped by their kernels.

    Each strategy yields the same number of scenes: FUZZ_TRIES, if set; the scenes then depend on
    --hypothesis-seed.
    """
    groups, seeds, tries = defaultdict(list), itertools.count(), os.environ.get("FUZZ_TRIES")
    options = {"phases": [Phase.generate], "database": None, "deadline": None}

    for strategy in strategies:

        @settings(max_examples=int(tries or number), derandomize=tries is None, **options)
        @given(strategy)
        def draw(scene):
            with suppress(InputError):  # a box may be too narrow
                groups[numba.typeof(build(*scene))].append((*scene, next(seeds)))

        draw()
    return list(groups.values())


def violations_in_processes(groups):
    """Yield the Violations of each group, simulated in a new process, one after the other."""
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn, max_tasks_per_child=1) as pool:
        try:
            yield from pool.map(violations_in, groups)
        except BaseException:  # Ctrl-C or SIGTERM: the pool would wait for its running task
            for process in multiprocessing.active_children():
                process.terminate()
            raise
