"""Numbers of README.md, from the rows of evidence."""

from roughgas.quoting import AGREES, DIFFERS, NOT_TESTED, Evidence, in_words, verdict_counts

STUDY = "mixtures"
CLOSE = 3.0
"""Standard errors within which a row counts as close."""


def numbers(evidence: Evidence) -> dict[str, str]:
    """Return the numbers of rows with each verdict as texts by name."""
    rows = [row for study, row in evidence if study == STUDY]
    counts = verdict_counts(evidence, STUDY)
    return {
        "rows": f"{len(rows)}",
        "agree": f"{counts[AGREES]}",
        "differ": f"{counts[DIFFERS]}",
        "not_tested": in_words(counts[NOT_TESTED]),
        "close": f"{sum(abs(row.t) < CLOSE for row in rows)}",
    }


def tables(evidence: Evidence) -> dict[str, str]:
    """Return no table: the page quotes none."""
    return {}
