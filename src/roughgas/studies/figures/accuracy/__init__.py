"""The work-precision figure: error of R against CPU seconds, a panel for each study, and the map of
what the Maxwellian theory misses."""

from pathlib import Path

from matplotlib.figure import Figure

from roughgas.studies.accuracy.variables import read_studies
from roughgas.studies.figures.accuracy import discretisation, models, statistical

SIZE = (10.2, 8.6)  # inches
PANELS = (
    ("statistical", statistical.draw, "(a) noise: three scenes, {}"),
    ("models", models.draw, "(b) models of a cooling gas, {}"),
    ("discretisation", discretisation.draw, "(c) springs and time steps: cooling gas, {}"),
    ("models", models.draw_map, "(d) what the Maxwellian theory of a cooling gas misses"),
)


def draw(path: str | Path) -> Figure:
    """Return the figure, from the combined dataset of the studies at `path`."""
    studies = read_studies(path)
    figure = Figure(figsize=SIZE, layout="constrained")
    for axes, (name, panel, title) in zip(figure.subplots(2, 2).flat, PANELS, strict=True):
        panel(axes, studies[name])
        r, beta = (float(studies[name].attrs[key]) for key in ("r", "beta"))
        material = rf"$r = {r:g}$, $\beta = {beta:g}$"
        axes.set_title(title.format(material), loc="left", fontsize=9)
    return figure
