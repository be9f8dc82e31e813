"""`python -m roughgas` is the command `roughgas`."""

from roughgas.cli import process

process()
