"""Legal compositions of effects, stated independently of the package.

Each effect is a line in PARAMETERS; NEEDS and EXCLUDES have the effects that it requires or
excludes.
"""

import itertools
import random

import numpy as np
from hypothesis import strategies as st

from roughgas.effects import EFFECTS

WAVES = ("sawtooth", "reversed_sawtooth", "triangle", "sine")
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
    # a single kind of wall on each side, since each kind compiles a kernel
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
        "spin_drag": st.just(0.5),
        "spin_velocity": st.floats(-5.0, 5.0),
    },
    "delta": {"speed": st.floats(0.01, 1.0)},
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
    "wall_impulses": {},
    "contact_log": {"most": st.sampled_from([1, 100])},
    "paths": {},
}
WAVING = {"floor", "right_wall"}  # effects that move in any wave form
OPPOSITE = [("left_wall", "right_wall"), ("front_wall", "back_wall")]
NEEDS = [("gravity", "floor"), ("floor", "gravity"), ("friction", "spin")]
NEEDS += [("contact_averages", "spin")]
NEEDS += [*((name, opposite) for pair in OPPOSITE for name, opposite in (pair, pair[::-1]))]
NEEDS += [("bottom_wall", "lid")]
EXCLUDES = [("walls", "shear"), ("shaken_walls", "shear"), ("walls", "shaken_walls")]
EXCLUDES += [("bottom_wall", "gravity")]
EXCLUDES += itertools.combinations(("viscoelastic", "power_law", "restitution_table"), 2)
EXCLUDES += [*itertools.product(("walls", "shaken_walls", "shear"), OPPOSITE[0])]
EXCLUDES += [*(("shear", name) for name in OPPOSITE[1])]
# A bed in space that is sheared between its sides heats up without end: flights grow long while
# images slide past by thousands, and a scene may take minutes
ENDLESS = {"gravity", "shear"}
# values of these parameters without spin
WITHOUT_SPIN = {"roughness": -1.0, "spin_share": 0.0, "spin_drag": 0.0, "spin_velocity": 0.0}


def is_legal(effects, dimension):
    """Whether these effects are compatible, in a box that is open above if they include gravity."""
    return (
        all(required in effects for effect, required in NEEDS if effect in effects)
        and not any(effects >= {*pair} for pair in EXCLUDES)
        and not (dimension == 2 and effects >= {"gravity", "shear"})  # sheared between its sides
        and not (dimension == 2 and effects & {"front_wall", "back_wall"})
        and not (dimension == 2 and effects >= {"lid", "shear"})
        and not ("lid" in effects and not effects & {"bottom_wall", "floor"})
    )


def sets_to_judge():
    """All sets of up to three effects, these with the effects they need, and their complements.

    So any three effects, present or absent, occur together in all legal ways.
    """
    sets = [set(c) for n in range(4) for c in itertools.combinations(sorted(EFFECTS), n)]
    candidates = [
        candidate
        for effects in sets
        for candidate in (effects, with_needs(effects), set(EFFECTS) - effects)
    ]
    return [set(effects) for effects in dict.fromkeys(map(frozenset, candidates))]


def with_needs(effects):
    """These effects and all effects that they need, directly or indirectly."""
    completed = effects | {required for effect, required in NEEDS if effect in effects}
    if "lid" in effects and "floor" not in effects:
        completed = completed | {"bottom_wall"}
    return completed if completed == effects else with_needs(completed)


def random_sets(number):
    """Legal (effects, dimension): effects are added in random order as long as the set is legal."""
    rng, sets = random.Random(0), []
    for _ in range(number):
        dimension, effects = rng.choice((2, 3)), set()
        for name in rng.sample(sorted(EFFECTS), len(EFFECTS)):
            extended = with_needs(effects | {name})
            if rng.random() < 0.7 and is_legal(extended, dimension) and not extended >= ENDLESS:
                effects = extended
        sets.append((effects, dimension))
    return sets


def covering(strength):
    """Legal compositions (effects, dimension, wave) that cover all legal combinations.

    For each choice of `strength` effects, all legal patterns of present and absent occur; the
    dimension counts as an effect, and so does a wave form.
    """
    legal = random_sets(600) + [
        (effects, dimension)
        for effects in sets_to_judge()
        for dimension in (2, 3)
        if is_legal(effects, dimension) and not effects >= ENDLESS
    ]
    choices = np.array(
        [[*(name in effects for name in EFFECTS), dimension == 3] for effects, dimension in legal]
    )
    subsets = np.array([*itertools.combinations(range(choices.shape[1]), strength)])
    patterns = choices[:, subsets] @ (1 << np.arange(strength, dtype=np.int8))
    rows = np.arange(len(subsets))
    missing = np.zeros((len(subsets), 2**strength), bool)
    for pattern in patterns:
        missing[rows, pattern] = True
    chosen = []
    while missing.any():
        best = max(range(len(legal)), key=lambda k: missing[rows, patterns[k]].sum())
        missing[rows, patterns[best]] = False
        chosen.append(legal[best])
    return _with_waves(chosen, strength)


def _with_waves(compositions, strength):
    """Give each composition a wave form of its floor and right wall, as each form has its own code.

    Compositions are repeated until each form has occurred with any strength - 2 other effects.
    """
    covered, with_forms = set(), []
    for k, (effects, dimension) in enumerate(compositions * len(WAVES)):
        companions = [*itertools.combinations(sorted(effects), strength - 2)]
        new_patterns = {
            form: {*itertools.product([form], WAVING & effects, companions)} - covered
            for form in WAVES
        }
        first = k % len(WAVES)  # equally good forms are taken in turn
        wave = max(WAVES[first:] + WAVES[:first], key=lambda form: len(new_patterns[form]))
        if k < len(compositions) or new_patterns[wave]:
            with_forms.append((effects, dimension, wave))
            covered |= new_patterns[wave]
    return with_forms


@st.composite
def scenes(draw, composition):
    """(settings of an experiment, r, beta) of a legal scene with 2 to 40 particles."""
    names, dimension, wave = composition
    effects = draw(parameters(names))
    for name in WAVING & names:
        effects[name]["wave"] = wave
    box = [draw(st.floats(7.0, 40.0)) for _ in range(dimension)]
    if "gravity" in names and "lid" not in names:
        box[-1] = "open"
    # more inelastic gases may collapse without the contact-time model
    narrow = names & {"walls", "shaken_walls", "left_wall", "lid", "back_wall"}
    narrow = narrow and ("gravity" not in names or "lid" in names)
    r = draw(st.floats(0.2 if "contact_time" in names and not narrow else 0.9, 1.0))
    return (
        {"particles": draw(st.integers(2, 40)), "box": box, "effects": effects},
        r,
        draw(st.floats(-1.0, 1.0)) if "spin" in names else -1.0,
    )


@st.composite
def mixtures(draw, composition):
    """As `scenes`, of up to three species, whose sizes differ threefold and masses by 1e6."""
    experiment, r, beta = draw(scenes(composition))
    material = {"restitution": st.floats(max(r, 0.9), 1.0)}
    if "spin" in experiment["effects"]:
        material |= {"inertia": st.floats(0.05, 1.0), "roughness": st.floats(-1.0, 1.0)}
    if "friction" in experiment["effects"]:
        material["mu"] = st.sampled_from([0.0, 0.2, 5.0])
    kind = st.fixed_dictionaries(
        {"radius": st.floats(0.6, 1.7)}, optional={"mass": st.floats(1e-3, 1e3), **material}
    )
    number = min(draw(st.integers(1, 3)), experiment["particles"])
    species = [draw(kind) | {"fraction": 1.0 / number} for _ in range(number)]
    return experiment | {"species": species}, r, beta


@st.composite
def parameters(draw, names):
    """Legal settings of these effects."""
    fixed = {} if "spin" in names else WITHOUT_SPIN
    return {
        name: {key: fixed.get(key, draw(kind)) for key, kind in PARAMETERS[name].items()}
        for name in EFFECTS
        if name in names
    }
