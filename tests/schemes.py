"""A scheme for candidates of contacts that does not depend on the number of particles."""

from roughgas.kernel import scheme

BREAK_EVENS = {"cells": 0, "sweep": 10_000}


def use(monkeypatch, name, per_cell=None):
    """Find candidates in `cells`, or by a `sweep`; cells may hold `per_cell` particles at least."""
    monkeypatch.setattr(scheme, "break_even", lambda dimension, packing: BREAK_EVENS[name])
    if per_cell is not None:
        monkeypatch.setattr(scheme, "PER_CELL", dict.fromkeys((2, 3), (per_cell, per_cell)))


def use_smallest_cells(monkeypatch):
    """Sort particles into the smallest possible cells, however few they are."""
    use(monkeypatch, "cells", per_cell=0.0)
