"""What scenes may be composed of, said once more and apart from the package: an effect is a line in

PARAMETERS, and one in NEEDS or EXCLUDES if it does not go with everything.
"""

import itertools
import random

import numpy as np
from hypothesis import strategies as st

from roughgas.effects import KINDS

WAVES = KINDS["floor"].parameters["wave"].words
MATERIAL = {
    "restitution": st.sampled_from([0.3, 0.7, 0.9, 1.0]),
    "roughness": st.sampled_from([-1.0, -0.4, 0.5, 1.0]),
}
STROKES = {"amplitude": st.floats(0.1, 1.0), "period": st.floats(0.5, 5.0)}
PARAMETERS = {
    "spin": {"inertia": st.floats(0.05, 1.0)},
    "gravity": {"acceleration": st.floats(0.1, 10.0)},
    "floor": {
        "amplitude": st.floats(0.1, 8.0),
        "period": st.floats(0.2, 3.0),
        "wave": st.sampled_from(WAVES),
        **MATERIAL,
    },
    "walls": MATERIAL,
    "shaken_walls": {"amplitude": st.floats(0.0, 5.0), "period": st.floats(0.2, 5.0), **MATERIAL},
    # of each side one kind of wall, since each kind is a kernel of its own
    "left_wall": {"velocity": st.floats(0.5, 2.0), **MATERIAL},
    "right_wall": {"shaken": st.just("along"), "wave": st.sampled_from(WAVES), **STROKES},
    "back_wall": MATERIAL,
    "bottom_wall": {"wave": st.just("sine"), **STROKES},
    "lid": {"velocity": st.floats(-2.0, -0.5), **MATERIAL},
    "front_wall": {"temperature": st.floats(0.5, 2.0), "velocity": st.floats(-1.0, 1.0)},
    "shear": {"velocity": st.floats(0.01, 100.0)},
    "thermostat": {
        "power": st.floats(0.1, 10.0),
        "spin_share": st.sampled_from([0.0, 0.3, 1.0]),
        "interval": st.floats(0.02, 5.0),
    },
    "langevin": {
        "interval": st.floats(0.02, 5.0),
        "drag": st.floats(0.01, 1.0),
        "temperature": st.just(1.0),
        "spin_drag": st.sampled_from([0.0, 0.5]),
    },
    "friction": {"mu": st.sampled_from([0.0, 0.05, 0.3, 1.0, 20.0])},
    "viscoelastic": {"speed": st.floats(0.1, 10.0)},
    "power_law": {
        "speed": st.floats(0.1, 10.0),
        "exponent": st.sampled_from([0.25, 0.75, 1.0]),
        "least": st.sampled_from([0.0, 0.7]),
    },
    "restitution_table": {
        "speed": st.just([0.0, 0.3, 2.0]),
        "restitution": st.sampled_from([[1.0, 0.9, 0.7], [0.95, 0.95, 1.0]]),
        "reference": st.floats(0.1, 1.0),
    },
    "threshold": {"speed": st.floats(1e-3, 1.0), "restitution": st.sampled_from([1.0, 0.5])},
    "contact_time": {"duration": st.sampled_from([1e-5, 1e-3, 1e-1])},
    "contact_averages": {},
    "contact_stress": {},
    "contact_heat": {},
    "contact_pairs": {},
    "contact_log": {"most": st.sampled_from([1, 100])},
    "paths": {},
}
MOVED = {"floor", "right_wall"}  # in any wave form
OPPOSITE = [("left_wall", "right_wall"), ("front_wall", "back_wall")]
NEEDS = [("gravity", "floor"), ("floor", "gravity"), ("friction", "spin")]
NEEDS += [("contact_averages", "spin")]
NEEDS += [*((name, other) for pair in OPPOSITE for name, other in (pair, pair[::-1]))]
NEEDS += [("bottom_wall", "lid")]
EXCLUDES = [("walls", "shear"), ("shaken_walls", "shear"), ("walls", "shaken_walls")]
EXCLUDES += [("bottom_wall", "gravity"), ("langevin", "shear")]
EXCLUDES += itertools.combinations(("viscoelastic", "power_law", "restitution_table"), 2)
EXCLUDES += [*itertools.product(("walls", "shaken_walls", "shear"), OPPOSITE[0])]
EXCLUDES += [*(("shear", name) for name in OPPOSITE[1])]
# A bed in space that is sheared between its sides heats up without end: flights grow long while
# images slide past by thousands, and a scene may take minutes
ENDLESS = {"gravity", "shear"}
# what parameters are where nothing spins
WITHOUT_SPIN = {"roughness": -1.0, "spin_share": 0.0, "spin_drag": 0.0}


def is_legal(effects, dimension):
    """Whether these effects go together in a box that is open above where there is gravity."""
    return (
        all(needed in effects for one, needed in NEEDS if one in effects)
        and not any(effects >= {*pair} for pair in EXCLUDES)
        and not (dimension == 2 and effects >= {"gravity", "shear"})  # sheared between its sides
        and not (dimension == 2 and effects & {"front_wall", "back_wall"})
        and not (dimension == 2 and effects >= {"lid", "shear"})
        and not ("lid" in effects and not effects & {"bottom_wall", "floor"})
    )


def every_set():
    """Every set of up to three effects, the same with what they need, and all effects but these:
    there and not there, any three occur together in every way that is legal."""
    sets = [set(c) for n in range(4) for c in itertools.combinations(sorted(KINDS), n)]
    found = [which for one in sets for which in (one, with_needs(one), set(KINDS) - one)]
    return [set(one) for one in dict.fromkeys(map(frozenset, found))]


def with_needs(effects):
    """These effects and all that they need, directly or not."""
    whole = effects | {needed for one, needed in NEEDS if one in effects}
    if "lid" in effects and "floor" not in effects:
        whole = whole | {"bottom_wall"}
    return whole if whole == effects else with_needs(whole)


def random_sets(number):
    """Legal (effects, dimension), with effects added in random order for as long as it is legal."""
    draw, found = random.Random(0), []
    for _ in range(number):
        dimension, effects = draw.choice((2, 3)), set()
        for name in draw.sample(sorted(KINDS), len(KINDS)):
            more = with_needs(effects | {name})
            if draw.random() < 0.7 and is_legal(more, dimension) and not more >= ENDLESS:
                effects = more
        found.append((effects, dimension))
    return found


def covering(strength):
    """Legal compositions (effects, dimension, wave) in which all choices occur together that can:

    for any so many effects (the dimension counts as one, and so does a wave form), every legal
    pattern of there and not there.
    """
    legal = random_sets(600) + [
        (one, D) for one in every_set() for D in (2, 3) if is_legal(one, D) and not one >= ENDLESS
    ]
    choices = np.array([[*(name in one for name in KINDS), D == 3] for one, D in legal])
    together = np.array([*itertools.combinations(range(choices.shape[1]), strength)])
    patterns = choices[:, together] @ (1 << np.arange(strength, dtype=np.int8))
    which = np.arange(len(together))
    missing = np.zeros((len(together), 2**strength), bool)
    for has in patterns:
        missing[which, has] = True
    found = []
    while missing.any():
        best = max(range(len(legal)), key=lambda k: missing[which, patterns[k]].sum())
        missing[which, patterns[best]] = False
        found.append(legal[best])
    return _with_waves(found, strength)


def _with_waves(found, strength):
    """Give each composition a wave form of its floor and right wall, since forms have code of their
    own; repeat some with other forms until each form of either has met any strength - 2 effects."""
    met, waved = set(), []
    for k, (effects, dimension) in enumerate(found * len(WAVES)):
        others = [*itertools.combinations(sorted(effects), strength - 2)]
        new = {w: {*itertools.product([w], MOVED & effects, others)} - met for w in WAVES}
        turn = k % len(WAVES)  # of forms that are as good, each is taken as often
        wave = max(WAVES[turn:] + WAVES[:turn], key=lambda w: len(new[w]))
        if k < len(found) or new[wave]:
            waved.append((effects, dimension, wave))
            met |= new[wave]
    return waved


@st.composite
def scenes(draw, compositions):
    """(settings of an experiment, r, beta) of a legal scene with 2 to 40 particles."""
    names, dimension, wave = draw(st.sampled_from(compositions))
    effects = draw(parameters(names))
    for name in MOVED & names:
        effects[name]["wave"] = wave
    box = [draw(st.floats(7.0, 40.0)) for _ in range(dimension)]
    if "gravity" in names and "lid" not in names:
        box[-1] = "open"
    # what is more inelastic than that may collapse, and has a contact time
    narrow = names & {"walls", "shaken_walls", "left_wall", "lid", "back_wall"}
    narrow = narrow and ("gravity" not in names or "lid" in names)
    r = draw(st.floats(0.2 if "contact_time" in names and not narrow else 0.9, 1.0))
    return (
        {"particles": draw(st.integers(2, 40)), "box": box, "effects": effects},
        r,
        draw(st.floats(-1.0, 1.0)) if "spin" in names else -1.0,
    )


@st.composite
def mixtures(draw, compositions):
    """As `scenes`, of one to three species: their sizes differ threefold, their masses by 1e6."""
    experiment, r, beta = draw(scenes(compositions))
    material = {"restitution": st.floats(max(r, 0.9), 1.0)}
    if "spin" in experiment["effects"]:
        material |= {"inertia": st.floats(0.05, 1.0), "roughness": st.floats(-1.0, 1.0)}
    if "friction" in experiment["effects"]:
        material["mu"] = st.sampled_from([0.0, 0.2, 5.0])
    one = st.fixed_dictionaries(
        {"radius": st.floats(0.6, 1.7)}, optional={"mass": st.floats(1e-3, 1e3), **material}
    )
    number = min(draw(st.integers(1, 3)), experiment["particles"])
    species = [draw(one) | {"fraction": 1.0 / number} for _ in range(number)]
    return experiment | {"species": species}, r, beta


@st.composite
def parameters(draw, names):
    """Legal parameters of these effects."""
    fixed = {} if "spin" in names else WITHOUT_SPIN
    return {
        name: {key: fixed.get(key, draw(kind)) for key, kind in PARAMETERS[name].items()}
        for name in KINDS
        if name in names
    }
