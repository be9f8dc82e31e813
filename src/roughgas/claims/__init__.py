"""The verdict on McNamara & Luding (1998), from the datasets: statement by statement on the paper's
own experiments, and on the questions that it leaves open."""

from roughgas.claims.report import judge
from roughgas.claims.statements import read_subject

PAPER, OPEN_QUESTIONS = read_subject("paper"), read_subject("open_questions")

__all__ = ["OPEN_QUESTIONS", "PAPER", "judge"]
