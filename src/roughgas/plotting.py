"""Building blocks for figures of studies: R along an axis with theory, in a common style.

`ratio_figure` draws panels (`PanelContent`) of series of points with theory, and residuals beneath;
`series` takes the points from a reduced dataset. Other figures use the single functions. A title
states a conclusion only through `judged_title`, which judges the data drawn.
"""

from roughgas.base import InputError
from roughgas.claims.titles import judged_title
from roughgas.data.reduced import particles_of
from roughgas.show.figures.panel import (
    ANY_R,
    BETA,
    DOTS,
    ENERGY_RATIO,
    FRICTION,
    INERTIA,
    LEGEND_AT_HALF,
    NOT_TRUSTED,
    RESTITUTION,
    ROUGHNESS,
    SPIN_SHARE,
    Axis,
    Panel,
    PanelContent,
    Row,
    Series,
    add_legend,
    add_notes,
    add_title,
    content_for_each_beta,
    content_for_each_r,
    draw_points,
    draw_series,
    draw_theory,
    frame_rows,
    key,
    key_of_trust,
    keys_of_steadiness,
    ratio_figure,
    ratio_panels,
    rows_of,
    series,
    series_for_each,
    trusted,
)
from roughgas.show.style import (
    FAINT,
    GREY,
    LINE_STYLES,
    THEORY,
    TWO_WIDE,
    WIDTH,
    LineStyle,
    Style,
    add_circles,
    move_circles,
    write_movie,
)
from roughgas.theory.prediction import predicted_ratio, species_at
