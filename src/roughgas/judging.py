"""What judges of statements are made of: samples of numbers beside theory, and rules for verdicts.

A judge takes reduced datasets beside theory (`theory`, like R) and returns a `Finding`, or raises
`NotTestedError` where the data cannot decide. `agreement` judges whether a sample of differences is
compatible with zero; `grade`, `worse` and `together` combine verdicts.
"""

from roughgas.claims.evidence import (
    AGREE,
    FAILS,
    FAR,
    FEW,
    HOLDS,
    LIMIT,
    NEAR,
    QUALIFIED,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    agreement_in_proportion,
    deviation,
    deviation_at_shares,
    difference,
    grade,
    of_ratio,
    over_seeds,
    place_of,
    points,
    sample,
    spin_shares,
    tendency,
    text,
    together,
    worse,
)
from roughgas.claims.paper import averaged, follows_its_share, follows_over_collisions
from roughgas.claims.published import references
from roughgas.data.reduced import third_axis
from roughgas.results.evidence import Row
from roughgas.statistics.errors import SIGNIFICANT, Estimate, sum_error
from roughgas.statistics.fits import power_law
from roughgas.theory.prediction import species_at
