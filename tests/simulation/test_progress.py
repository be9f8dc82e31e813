"""Progress: bars on a terminal, elsewhere a line now and then, and a film's lines in a log."""

import io

import numpy as np
import pytest

from roughgas.kernel.record import Sampling
from roughgas.scene import build
from roughgas.simulation.gas import Gas
from roughgas.simulation.progress import Bar, Progress
from roughgas.simulation.recorder import Recorder

DRIVEN = {
    "particles": 10,
    "box": [50, 50],
    "effects": {"spin": {"inertia": 0.5}, "shear": {"velocity": 1}, "contact_averages": {}},
    "schedule": {"kind": "steady", "equilibrate": 2000, "measure": 5000, "sample_every": 1},
}
COOLING = DRIVEN | {
    "effects": {"spin": {"inertia": 0.5}},
    "schedule": {
        "kind": "cooling",
        "replicas": 4,
        "thermalise": 10,
        "relaxation_times": 16,
        "plateau": 50,
        "sample_every": 1,
    },
}


class Terminal(io.StringIO):
    """A stream that says it is a terminal; `shown` is what each bar in turn looked like."""

    def isatty(self):
        return True

    @property
    def shown(self):
        return [line for line in self.getvalue().split("\r") if line.strip()]


@pytest.fixture(autouse=True)
def every_step_is_shown(monkeypatch):
    monkeypatch.setattr("roughgas.simulation.progress.SECONDS_BETWEEN", 0.0)


def test_a_driven_gas_is_followed_in_time():
    stream = Terminal()
    with Progress("sheared", build(DRIVEN, 0.9, 0.0), DRIVEN, stream=stream) as progress:
        progress(1750.0, 98_765)
    assert stream.shown[-1].startswith("sheared:  25%|") and "1750 of 7000 T" in stream.shown[-1]


def test_a_run_that_is_prolonged_is_followed_to_its_new_end():
    stream = Terminal()
    with Progress("sheared", build(DRIVEN, 0.9, 0.0), DRIVEN, stream=stream) as progress:
        progress(7000.0, 98_765)
        progress.expect(14_000.0)
        progress(10_500.0, 123_456)
    assert stream.shown[-1].startswith("sheared:  75%|") and "of 14000 T" in stream.shown[-1]


def test_a_cooling_gas_is_followed_through_its_replicas():
    """So many collisions per particle: 10 to thermalise, the transient, 50 on the plateau."""
    stream = Terminal()
    with Progress("cooling", build(COOLING, 1.0, 1.0), COOLING, stream=stream) as progress:
        total = int(stream.shown[0].split(" of ")[1].split()[0])
        replica = total / 4
        for _ in range(4):
            for part in (0.5, 1.0):
                progress(123.0, round(part * replica * 5))
    shown = [int(one.split("| ")[1].split()[0]) for one in stream.shown[1:]]
    assert shown == pytest.approx([total * part / 8 for part in range(1, 9)], abs=1)
    assert stream.shown[-1].startswith("cooling: 100%|")


def test_the_text_says_what_is_going_on():
    """Placing, then compiling, then neither, long before the first sample is there."""
    stream, scene = Terminal(), build(COOLING, 0.9, 0.0)
    with Progress("cooling", scene, COOLING, stream=stream) as progress:
        gas = Gas.start(scene, COOLING, np.random.default_rng(1), Recorder(progress))
        asked = [line.split(":")[0] for line in stream.shown]
        gas.recorder.run(gas.state, scene, Sampling(np.inf, 1, 0), 0)
    assert asked == ["cooling (placing particles)", "cooling (compiling)"]
    assert stream.shown[2].startswith("cooling:   0%|")


def test_progress_is_silent_elsewhere_of_what_is_soon_over():
    stream = io.StringIO()
    with Progress("cooling", build(COOLING, 0.9, 0.0), COOLING, stream=stream) as progress:
        progress(1.0, 1)
    assert stream.getvalue() == ""


def test_a_pipe_hears_now_and_then_of_what_takes_long(monkeypatch):
    clock = iter([0, 5, 11, 60, 72])
    monkeypatch.setattr("roughgas.simulation.progress.time.monotonic", lambda: next(clock))
    stream = io.StringIO()
    with Bar("task", None, "points", stream) as bar:
        for done in range(1, 5):
            bar.reach(done, "r = 0.9", total=9)
    assert stream.getvalue().splitlines() == [
        "task: 2 of 9 points (r = 0.9), 11 s so far",
        "task: 4 of 9 points (r = 0.9), 72 s so far",
    ]
