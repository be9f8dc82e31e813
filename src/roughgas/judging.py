"""Building blocks for judges of statements: samples of numbers, and rules for verdicts.

A judge takes reduced datasets with the variable `theory`, of the same dimensions as R, and returns
a `Finding`, or raises `NotTestedError` if the data cannot decide. `agreement` judges whether a
sample of differences is compatible with zero; `grade`, `worst_verdict` and `combined_finding`
combine verdicts.
"""

from roughgas.claims.driven import averaged, follows_its_share, follows_over_collisions
from roughgas.claims.published import references
from roughgas.claims.variables import (
    deviation_of,
    species_temperature_ratio,
    steady,
    theory_over_grid,
)
from roughgas.claims.verdicts import (
    AGREE,
    AGREE_RELATIVE,
    DISAGREE,
    DISAGREE_RELATIVE,
    EXCEPTIONS,
    FAILS,
    HOLDS,
    QUALIFIED,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    agreement_in_proportion,
    check_power,
    combined_finding,
    deviation,
    deviation_at_shares,
    deviation_in_proportion,
    difference,
    effect_of_restitution,
    grade,
    is_large,
    over_seeds,
    point_text,
    points,
    ratio_sample,
    sample,
    spin_shares,
    tendency,
    text,
    worst_verdict,
)
from roughgas.data.variables import third_axis
from roughgas.results.comparison import Row
from roughgas.results.long_table import LongRow, read_long_rows
from roughgas.statistics.errors import stderr_over_seeds, sum_error
from roughgas.statistics.estimates import (
    SIGNIFICANCE,
    SIGNIFICANT,
    Estimate,
    mean_by_scatter,
)
from roughgas.statistics.fits import limit_at_zero, power_law
from roughgas.statistics.student import t_quantile
from roughgas.theory.prediction import predicted_ratio, species_at
