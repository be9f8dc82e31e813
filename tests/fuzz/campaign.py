"""Long campaigns of random examples: `python -m tests.fuzz.campaign --configurations 10000`.

Each of --configurations, --commands, --files and --scenes tries so many examples, other ones for
each --seed, and goes on after a fault; --edges takes so many cases of the tables in edges.py.
Without any, all edges are tried and some examples of each. It prints its seed, how many were taken
and how many refused, and what else came out; the exit status is 1 if anything else did, or if
hardly any were taken. Random legal scenes are simulated for some hundreds of collisions each.
"""

import argparse
import os
import random
import resource
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter, defaultdict
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from tests.fuzz.spoiling import ENOUGH

HANGS = 60  # seconds of processor time: what else a machine does is not a command's fault
SLEEPS = 600  # seconds by the clock
MEMORY = 6 << 30  # bytes
MOST = 10  # faults of one place that are printed
FEW = 50  # tries that say nothing yet of the share that is taken
WORST = {  # of all scenes
    "roundings of energy missing an exchange": "imbalance",
    "a of overlap": "overlap",
    "a of depth in a wall or the floor": "outside",
}


class Campaign:
    """Counts what came out of the examples of one kind."""

    def __init__(self, name, number, first):
        self.name, self.number, self.first = name, number, first
        self.outcomes, self.faults = Counter(), defaultdict(list)

    @property
    def tried(self):
        """How many examples have been tried: the number of the one under way, counted from 0."""
        return self.outcomes.total() + sum(map(len, self.faults.values()))

    def run(self, strategy, attempt):
        """Draw examples, and give each to `attempt`, which returns what came of it or raises."""

        @seed(self.first)
        @settings(
            max_examples=self.number,
            phases=[Phase.generate],
            deadline=None,
            database=None,
            suppress_health_check=list(HealthCheck),
        )
        @given(strategy)
        def see(example):
            self._try(attempt, example)

        return self._report(see)

    def walk(self, cases, attempt):
        """Give so many cases of a list to `attempt`."""
        cases = random.Random(self.first).sample(cases, min(self.number, len(cases)))

        def see():
            for case in cases:
                self._try(attempt, case)

        return self._report(see)

    def _try(self, attempt, example):
        _watch(HANGS, SLEEPS)
        try:
            self.outcomes[attempt(example)] += 1
        except BaseException as error:
            self._note(error, example)
        finally:
            _watch(0, 0)

    def _report(self, see):
        """Try all, print what came of them, and return whether that is as it should be."""
        begun = time.monotonic()
        try:
            see()
        except KeyboardInterrupt:
            print(f"{self.name}: stopped")
        took = time.monotonic() - begun
        counts = ", ".join(f"{count} {what}" for what, count in sorted(self.outcomes.items()))
        print(f"{self.name}: {self.tried} tried with seed {self.first}: {counts}; {took:.0f} s")
        for where, found in self.faults.items():
            print(f"  {len(found)} times {where}", *found[:MOST], sep="\n    ")
        print(f"  faults: {sum(map(len, self.faults.values()))}", flush=True)
        hardly = self.tried >= FEW and self.outcomes["refused"] > (1 - ENOUGH) * self.tried
        if hardly:
            print(f"  fewer than {ENOUGH:.0%} were taken")
        return not (self.faults or hardly)

    def _note(self, error, example):
        if type(error).__module__.startswith("hypothesis") or isinstance(error, KeyboardInterrupt):
            raise error
        last = traceback.extract_tb(error.__traceback__)[-1]
        text = " ".join(f"number {self.tried}: {error} {example!r}".split())[:1000]
        where = f"{type(error).__name__} in {Path(last.filename).name}, line {last.lineno}"
        self.faults[where].append(text)


def _watch(processor, clock):
    for number in (signal.SIGALRM, signal.SIGPROF):
        signal.signal(number, _hangs)
    signal.setitimer(signal.ITIMER_PROF, processor)
    signal.alarm(clock)


def _hangs(*_):
    raise TimeoutError(f"not over after {HANGS} s of processor time, or {SLEEPS} s")


def configurations(campaign, folder):
    """Configurations whose values or whose text are spoiled."""
    from tests.fuzz import test_configurations as one
    from tests.fuzz.spoiling import legal_trees, spoiled_texts, spoiled_trees

    path = folder / "config.yaml"

    def attempt(example):
        kind, spoiled = example
        return (one.values_are_spoiled if kind == "values" else one.text_is_spoiled)(path, spoiled)

    trees = st.one_of(legal_trees(one.BRIEF), spoiled_trees(one.BRIEF))
    trees = st.tuples(st.just("values"), trees)
    texts = st.tuples(st.just("text"), st.one_of(one.NUMBERED, spoiled_texts(one.TEXT)))
    return campaign.run(st.one_of(trees, texts), attempt)


def commands(campaign, folder):
    """Command lines on files of ours, spoiled and foreign ones."""
    from tests.fuzz import test_commands as one

    files = one.write_folder(folder / "files")
    lines = st.one_of(one.right_lines(), one.command_lines(sorted(os.listdir(files))))
    with pytest.MonkeyPatch.context() as patch:
        return campaign.run(lines, lambda line: one.check(files, patch, line))


def files(campaign, folder):
    """Files that are spoiled, or foreign."""
    from tests.fuzz import test_files as one
    from tests.fuzz.files import real_files

    sources = real_files(folder / "real")
    with pytest.MonkeyPatch.context() as patch:
        return campaign.run(
            st.data(), lambda data: one.check(sources, folder / "spoiled", patch, data)
        )


def scenes(campaign, folder):
    """Random legal scenes, half of them of particles that differ."""
    from hard_cases import test_random_scenes as one
    from hard_cases.compositions import mixtures
    from hard_cases.compositions import scenes as alike
    from hard_cases.watched import Worst

    seen = []

    def attempt(scene):
        number = campaign.tried
        if not one.fits(*scene, number):
            return "too dense"
        found = Worst()
        end = found.see(*scene, number)
        seen.append((found, number, scene))
        assert found.broken == 0 and found.backwards == 0
        assert found.imbalance < 10.0 and found.overlap < 1e-11 and found.outside < 1e-11
        return end

    sound = campaign.run(st.one_of(alike(one.FEW), mixtures(one.UNLIKE)), attempt)
    print(f"  {sum(found.collisions for found, *_ in seen)} contacts; at most")
    for what, name in WORST.items() if seen else ():
        found, number, scene = max(seen, key=lambda one: getattr(one[0], name))
        print(f"  {getattr(found, name):.2g} {what}: number {number}, {scene}")
    return sound


def edges(campaign, folder):
    """Cases of the tables of options, keys of schedules, and environments."""
    from tests.fuzz import edges as one

    given = one.write_folder(folder / "files")
    print("edges of", ", ".join(f"{number} {what}" for what, number in one.size().items()))
    with pytest.MonkeyPatch.context() as patch:
        return campaign.walk(one.cases(), lambda case: one.attempt(given, patch, case))


KINDS = {one.__name__: one for one in (configurations, commands, files, scenes, edges)}
WHOLE = {"configurations": 1000, "commands": 1000, "files": 1000, "scenes": 100, "edges": 10**6}


def main():
    sys.path.insert(0, str(Path(__file__).parents[1]))  # as pytest has it
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, one in KINDS.items():
        parser.add_argument(f"--{name}", type=int, default=0, help=one.__doc__)
    parser.add_argument("--seed", type=int, default=1)
    options = vars(parser.parse_args())
    for number in (signal.SIGINT, signal.SIGTERM):  # what has been tried is reported
        signal.signal(number, signal.default_int_handler)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    first, sound = options.pop("seed"), True
    options = options if any(options.values()) else WHOLE
    for name, number in options.items():
        with tempfile.TemporaryDirectory() as folder:
            if number:
                sound &= KINDS[name](Campaign(name, number, first), Path(folder))
    return 0 if sound else 1


if __name__ == "__main__":
    sys.exit(main())
