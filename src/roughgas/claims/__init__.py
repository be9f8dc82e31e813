"""The verdict on McNamara & Luding (1998), from the datasets: statement by statement on the paper's
own experiments. Statements beyond them are in folders of studies."""

from roughgas.claims.report import judge
from roughgas.claims.statements import read_subject

PAPER = read_subject("paper")

__all__ = ["PAPER", "judge"]
