"""Figure of the cost per collision over the number of particles."""

from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from benchmarks.kernel import Timing
from benchmarks.yardstick import Rate
from roughgas.kernel.scheme import break_even
from roughgas.show.style import FAINT, LINE_STYLES, PARAMETERS, THEORY, WIDTH, save

TYPICAL_PACKING = 0.1  # of the scenes


def draw(timings: list[Timing], yardstick: list[Rate], output: Path) -> None:
    """Draw a line for each scene, and for the yardstick, into a PNG file."""
    with rc_context(PARAMETERS):
        figure = Figure(figsize=(WIDTH, 0.8 * WIDTH), layout="constrained")
        axes = figure.subplots()
        titles = dict.fromkeys(timing.case.title for timing in timings)
        for title, line_style in zip(titles, LINE_STYLES, strict=False):
            line = [
                (timing.number, timing.cost) for timing in timings if timing.case.title == title
            ]
            axes.plot(
                *zip(*line, strict=True),
                color=line_style.colour,
                marker=line_style.marker,
                ls=line_style.line,
                label=title,
            )
        line = [(rate.number, 1e6 / rate.median) for rate in yardstick]
        axes.plot(
            *zip(*line, strict=True), color=THEORY, marker="x", label="plain loop (yardstick)"
        )
        # axes are logarithmic: one line for packings of .05 to .2
        few = break_even(2, TYPICAL_PACKING)
        axes.axvline(few, color=FAINT, linewidth=0.8)
        axes.set(xscale="log", yscale="log", xlabel="number of particles $N$")
        axes.set_ylabel("CPU time per collision (µs)")
        for side, label in (("right", "all pairs "), ("left", " cells")):
            axes.annotate(
                label,
                (few, 0.02),
                xycoords=("data", "axes fraction"),
                ha=side,
                color=FAINT,
            )
        axes.legend()
        save(figure, [output])
