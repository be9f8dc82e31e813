"""Cost per collision against the number of particles, and with each effect."""

from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from benchmarks.kernel import Timing
from benchmarks.yardstick import Rate
from roughgas.kernel.memory import FEW
from roughgas.show.style import FAINT, LOOKS, PARAMETERS, THEORY, WIDTH, save


def draw(timings: list[Timing], yardstick: list[Rate], output: Path) -> None:
    """One line a scene, and the yardstick, into a PNG."""
    with rc_context(PARAMETERS):
        figure = Figure(figsize=(WIDTH, 0.8 * WIDTH), layout="constrained")
        axes = figure.subplots()
        titles = dict.fromkeys(timing.case.title for timing in timings)
        for title, look in zip(titles, LOOKS, strict=False):
            line = [(one.number, one.cost) for one in timings if one.case.title == title]
            axes.plot(
                *zip(*line, strict=True),
                color=look.colour,
                marker=look.marker,
                ls=look.line,
                label=title,
            )
        line = [(one.number, 1e6 / one.median) for one in yardstick]
        axes.plot(
            *zip(*line, strict=True), color=THEORY, marker="x", label="plain loop (yardstick)"
        )
        axes.axvline(FEW, color=FAINT, linewidth=0.8)
        axes.set(xscale="log", yscale="log", xlabel="number of particles $N$")
        axes.set_ylabel("CPU time per collision (µs)")
        for side, words in (("right", "all pairs "), ("left", " cells")):
            axes.annotate(
                words,
                (FEW, 0.02),
                xycoords=("data", "axes fraction"),
                ha=side,
                color=FAINT,
            )
        axes.legend()
        save(figure, [output])
