"""A scheme for candidates of contacts that does not depend on the number of particles."""

from brute_force import run

from roughgas.kernel import scheme
from roughgas.kernel.state import LAST_FIRST, LAST_SECOND

BREAK_EVENS = {"cells": 0, "sweep": 10_000}


def use(monkeypatch, name, per_cell=None):
    """Find candidates in `cells`, or by a `sweep`; cells may hold `per_cell` particles at least."""
    monkeypatch.setattr(scheme, "break_even", lambda *density: BREAK_EVENS[name])
    if per_cell is not None:
        monkeypatch.setattr(scheme, "PER_CELL", dict.fromkeys((2, 3), (per_cell, per_cell)))


def use_smallest_cells(monkeypatch):
    """Sort particles into the smallest possible cells, however few they are."""
    use(monkeypatch, "cells", per_cell=0.0)


def assert_same_pairs(states, scene, contacts):
    """Let two states of a scene make a number of contacts, and compare the pairs of particles."""
    for _ in range(contacts):
        pairs = []
        for state in states:
            run(state, scene, 1, collisions=1)
            pairs.append({int(state.counts[LAST_FIRST]), int(state.counts[LAST_SECOND])})
        assert pairs[0] == pairs[1]
