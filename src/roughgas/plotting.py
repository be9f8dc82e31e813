"""What figures of studies are drawn with: R along one axis beside theory, as in all figures.

`ratio_figure` draws panels (`PanelContent`) of series of points, theory over them, and residuals
beneath; `series` takes them from a reduced dataset. Figures of another form use the parts.
"""

from roughgas.base import InputError
from roughgas.data.reduced import particles_of
from roughgas.show.figures.panel import (
    ANY_R,
    BETA,
    DOTS,
    ENERGY_RATIO,
    FRICTION,
    HALF,
    INERTIA,
    NOT_TRUSTED,
    RESTITUTION,
    ROUGHNESS,
    SPIN_SHARE,
    Axis,
    Panel,
    PanelContent,
    Series,
    add_legend,
    add_notes,
    add_title,
    averages_of,
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
    series,
    series_for_each,
    trusted,
)
from roughgas.show.style import (
    FAINT,
    GREY,
    LOOKS,
    THEORY,
    TWO_WIDE,
    WIDTH,
    Look,
    Style,
    add_circles,
    write_movie,
)
from roughgas.show.style import move as move_circles
from roughgas.theory.prediction import predicted_ratio, species_at
