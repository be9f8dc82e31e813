"""Candidates for a contact with one particle, decided several at a time.

Their paths are copied side by side, so that one vector instruction serves eight of them.
"""

import math

from roughgas.kernel import hooks
from roughgas.kernel.agenda import add_contact
from roughgas.kernel.flight import path_of
from roughgas.kernel.images import speed_limit
from roughgas.kernel.jit import jit
from roughgas.kernel.layout import TOGETHER
from roughgas.kernel.pairs import meeting, meeting_of_any_image
from roughgas.kernel.vectors import column


@jit
def decide(state, scene, i, number, start, end, limit):
    """Put the contacts of particle i with the candidates, up to time `limit`, on its agenda.

    Between `start` and `end` every image counts, later only the nearest one in their middle.
    """
    shortlist, box = state.shortlist, scene.box
    for k in range(number):
        for c in range(2 * len(box) + 1):
            shortlist.paths[c, k] = state.trajectory[shortlist.found[k], c]
    path = path_of(state.trajectory, i, box)
    gravity = hooks.acceleration(scene.effects, None)
    slide = hooks.sliding(scene.effects, None, state)
    half = 0.5 * (end - start)
    fastest = speed_limit(box, half)
    paths, when = shortlist.paths, shortlist.when
    whole = -(-number // TOGETHER) * TOGETHER
    _decide(paths, when, whole, path, box, gravity, slide, start + half, fastest)
    for k in range(number):
        j = shortlist.found[k]
        if math.isnan(when[k]):
            other = path_of(state.trajectory, j, box)
            when[k] = meeting_of_any_image(path, other, box, gravity, slide, start, end)
        add_contact(state.agenda, i, when[k], j, state.changes[j], when[k] <= limit)


@jit
def _decide(paths, when, whole, path, box, gravity, slide, middle, fastest):
    for k in range(whole):
        other = column(paths, k, 0, box), column(paths, k, len(box), box), paths[2 * len(box), k]
        when[k] = meeting(path, other, box, gravity, slide, middle, fastest)
