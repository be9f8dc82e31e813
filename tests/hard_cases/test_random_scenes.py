"""Random scenes."""

import itertools
import math
import multiprocessing
import os
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress

import numba
from brute_force import KERNELS
from hypothesis import Phase, given, settings

from hard_cases.compositions import (
    PARAMETERS,
    covering,
    every_set,
    is_legal,
    mixtures,
    parameters,
    scenes,
    with_needs,
)
from hard_cases.watched import Worst, worst_of
from roughgas.base import InputError
from roughgas.effects import KINDS
from roughgas.scene import build
from roughgas.scene.initial import check

QUICK = ("friction", "sheared", "walled", "shaken", "heated", "spheres")
FEW = [
    (set(KERNELS[name]["effects"]), len(KERNELS[name]["box"]), "sawtooth")  # the floor's, if any
    for name in QUICK
]
"""Compositions that other tests run, too: each is a kernel of its own."""

UNLIKE = [(set(KERNELS["gas"]["effects"]), 2, "sawtooth")]
"""That of which other tests run mixtures, too."""


JUNK = (math.nan, math.inf, -7, "x", None, True, [], {})
"""What no parameter may be, but None where there is a default."""


def test_every_set_of_effects_is_accepted_or_refused_in_one_line(margins):
    """Sets of effects, in two and three dimensions, closed and open above, and with parameters that

    are none. What is legal, and which sets are tried, is said in compositions.py.
    """
    assert set(PARAMETERS) == set(KINDS)
    tried = wrong = junk = accepted = 0

    @settings(
        max_examples=margins.size(1, 30), phases=[Phase.generate], derandomize=True, database=None
    )
    @given(parameters([*KINDS]), parameters([name for name in KINDS if name != "spin"]))
    def see(spinning, smooth):
        nonlocal tried, wrong, junk, accepted
        for effects in every_set():
            chosen = {name: (spinning if "spin" in effects else smooth)[name] for name in effects}
            for dimension, top in ((2, 30), (2, "open"), (3, 30), (3, "open")):
                is_open = "gravity" in effects and "lid" not in effects
                legal = is_legal(effects, dimension) and (top == "open") == is_open
                wrong += accepts(chosen, dimension, top) != legal
                tried += 1
                minimal = legal and any(effects == with_needs({one}) for one in effects)
                for changed in spoiled(chosen) if minimal else ():
                    accepted += accepts(changed, dimension, top)
                    junk += 1

    see()
    margins.at_most("sets of effects misjudged", wrong, 0, tried, "sets and boxes")
    margins.at_most("parameters that are none, and accepted", accepted, 0, junk, "of legal sets")


def spoiled(chosen):
    """These settings of effects with each parameter in turn being each thing that it may not be."""
    for name in chosen:
        for key, about in KINDS[name].parameters.items():
            either_sign = getattr(about, "interval", "").startswith("[-1e")
            for value in JUNK:
                legal = value == -7 and either_sign  # as a velocity may be
                if not legal and (value is not None or about.default is None):
                    yield chosen | {name: chosen[name] | {key: value}}


def accepts(effects, dimension, top):
    """Whether a scene is built and checked; errors but an InputError of one line get through."""
    experiment = {"particles": 5, "box": [30] * (dimension - 1) + [top], "effects": effects}
    verdicts = {
        verdict(build, experiment, 0.9, 0.3 if "spin" in effects else -1.0),
        verdict(check, experiment),
    }
    assert len(verdicts) == 1, experiment
    return verdicts.pop()


def verdict(judge, *arguments):
    """Whether a function takes what it is given, or else refuses it in one line."""
    try:
        judge(*arguments)
    except InputError as error:
        assert "\n" not in str(error) and (": must " in str(error) or " needs " in str(error))
        return False
    return True


def test_invariants_of_random_scenes(margins):
    """Change of the energy = what its sources and the contacts have booked, to rounding.

    A particle may be held for ever in the corner of a rough floor that rises and a rough wall:
    then the simulation stops with an error, as it must.
    """
    keep_invariants(margins, scenes(FEW + covering(3) if margins.full else FEW), 90, 1500)


def test_invariants_of_random_mixtures(margins):
    """As above, of up to three species of any material, with masses that differ by 1e6."""
    keep_invariants(margins, mixtures(covering(2) if margins.full else UNLIKE), 12, 600)


def keep_invariants(margins, kinds, few, many):
    """Simulate scenes of these kinds, and measure what must hold in all of them.

    In full, each kernel has a process of its own: numba never frees the memory of compiling, and
    dozens of kernels would take several GB.
    """
    groups = drawn(kinds, margins.size(few, many))
    worst = sum(in_processes(groups) if margins.full else map(worst_of, groups), Worst())
    tried = {"tried": worst.tried, "unit": f"scenes, {worst.collisions} contacts"}
    what = "error of the energy balance, in roundings per exchange"
    margins.at_most(what, worst.imbalance, 10.0, **tried)
    margins.at_most("energy that contacts give, over all", worst.gained, 1e-12, **tried)
    what = "momentum gained without boundaries, over the sum of speeds"
    margins.at_most(what, worst.momentum, 1e-12, **tried)
    margins.at_most("impulses beyond the cone of friction", worst.cone, 1e-10, **tried)
    margins.at_most("overlap, in a", worst.overlap, 1e-11, **tried)
    margins.at_most("depth in a wall or the floor, in a", worst.outside, 1e-11, **tried)
    margins.at_most("scenes with numbers that are none", worst.broken, 0, **tried)
    margins.at_most("samples earlier than the one before", worst.backwards, 0, **tried)
    given_up = worst.given_up / worst.tried
    # Hypothesis varies what it has drawn: of few scenes, several may stem from one that collapses
    # in full the limit carries three standard errors of the number that a busy machine has tried
    most = 0.05 + 3.0 * math.sqrt(0.05 * 0.95 / worst.tried) if margins.full else 0.1
    margins.at_most("share of scenes that are stopped", given_up, most, **tried)


def drawn(kinds, number):
    """Return lists of scenes (experiment, r, beta, seed) that one kernel simulates: as many as
    FUZZ_TRIES says if it is set, and then others for each --hypothesis-seed."""
    groups, seeds, tries = defaultdict(list), itertools.count(), os.environ.get("FUZZ_TRIES")
    how = {"phases": [Phase.generate], "database": None, "deadline": None}

    @settings(max_examples=int(tries or number), derandomize=tries is None, **how)
    @given(kinds)
    def draw(scene):
        with suppress(InputError):  # a box may be too narrow
            groups[numba.typeof(build(*scene))].append((*scene, next(seeds)))

    draw()
    return list(groups.values())


def in_processes(groups):
    """Yield the Worst of each group, simulated in a process of its own, one after the other."""
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn, max_tasks_per_child=1) as one:
        yield from one.map(worst_of, groups)
