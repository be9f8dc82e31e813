"""Candidates for a contact with one particle, decided several at a time, one to a lane."""

import math

import numpy as np

from roughgas.kernel import hooks
from roughgas.kernel.agenda import add_contact, set_contacts
from roughgas.kernel.arithmetic import choose
from roughgas.kernel.bodies import reach_of, widest_of
from roughgas.kernel.flight import path_of
from roughgas.kernel.hooks import either, unless_absent
from roughgas.kernel.images import speed_limit
from roughgas.kernel.jit import jit
from roughgas.kernel.lanes import (
    REGISTER,
    bits,
    gather,
    index,
    lanes_of,
    load,
    numbers_in,
    order,
    store,
    trailing_zeros,
)
from roughgas.kernel.layout import SLOTS_OF_FEW
from roughgas.kernel.pairs import meeting, meeting_of_any_image
from roughgas.kernel.unroll import unrolled


@jit
def decide(state, scene, i, number, start, end, limit):
    """Put the contacts of particle i with the candidates, up to time `limit`, on its agenda.

    Between `start` and `end` every image counts, later only the nearest one in their middle. What
    lies beyond the last candidate on the list is a particle's number, too: it is decided and left.
    """
    box = scene.box
    path = path_of(state.trajectory, i, box)
    gravity = hooks.acceleration(scene.effects, None)
    slide = hooks.sliding(scene.effects, None, state)
    half = 0.5 * (end - start)
    fastest = speed_limit(box, half, widest_of(state.bodies))
    first, more = 0, True
    while more:  # once mostly, and at least once, so that the processor can foresee it
        others = _paths_of(state.trajectory, state.shortlist.found, first, box)
        reach = _reaches(state.bodies, state.shortlist.found, i, first)
        when, unsure = meeting(path, others, box, gravity, slide, start + half, fastest, reach)
        listed = order(REGISTER) < number - first
        unsure = unsure & listed
        when = _of_any_image(fastest, state, scene, i, path, first, start, end, when, unsure)
        _note(state.cells, state, i, first, choose((when <= limit) & listed, when, math.inf))
        first += lanes_of(state.shortlist.when)
        more = first < number


@unrolled
def _paths_of(trajectory, found, first, box):
    """Return the paths of the candidates from `first` on."""
    return (
        tuple(gather(trajectory, k, found, first, REGISTER) for k in range(len(box))),
        tuple(gather(trajectory, len(box) + k, found, first, REGISTER) for k in range(len(box))),
        gather(trajectory, 2 * len(box), found, first, REGISTER),
    )


@unless_absent
def _reaches(bodies, found, i, first):
    """Return the distances at which particle i touches the candidates from `first` on."""
    return bodies.radius[i] + gather(bodies.radius, 0, found, first, REGISTER)


def _look_at_every_image(fastest, state, scene, i, path, first, start, end, when, unsure):
    undecided = bits(unsure)
    if undecided == 0:
        return when
    shortlist, box = state.shortlist, scene.box
    gravity = hooks.acceleration(scene.effects, None)
    slide = hooks.sliding(scene.effects, None, state)
    store(shortlist.when, 0, 0, when)
    while undecided != 0:
        k = trailing_zeros(undecided)
        j = shortlist.found[first + k]
        other = path_of(state.trajectory, j, box)
        reach = reach_of(state.bodies, i, j)
        time = meeting_of_any_image(path, other, box, gravity, slide, start, end, reach)
        shortlist.when[0, k] = time
        undecided &= undecided - np.uint64(1)
    return load(shortlist.when, 0, 0, REGISTER)


_of_any_image = either(
    _look_at_every_image,
    lambda fastest, state, scene, i, path, first, start, end, when, unsure: when,
)


@jit
def _one_by_one(state, i, first, when):
    agenda, shortlist = state.agenda, state.shortlist
    store(shortlist.when, 0, 0, when)
    contacts = bits(when < math.inf)
    while contacts != np.uint64(0):
        k = trailing_zeros(contacts)
        j = index(int(shortlist.found[index(first + k)]))
        add_contact(agenda, i, shortlist.when[0, k], j, state.changes[j])
        contacts &= contacts - np.uint64(1)


def _all_at_once(cells, state, i, first, when):
    if first + lanes_of(state.shortlist.when) > SLOTS_OF_FEW:
        _one_by_one(state, i, first, when)
        return
    found = state.shortlist.found
    changes = gather(state.changes, 0, found, first, REGISTER)
    set_contacts(state.agenda, i, first, when, numbers_in(found, first, REGISTER), changes)


_note = either(
    lambda cells, state, i, first, when: _one_by_one(state, i, first, when),
    _all_at_once,
)
