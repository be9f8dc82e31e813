"""A study with effects and observables of its own, as text of its files."""

import re
import shutil
from pathlib import Path

from brute_force import run

from roughgas.config import study_code
from roughgas.simulation.energy_balance import balance, imbalance

ROOT = Path(__file__).parent.parent
GUIDE = (ROOT / "docs/effects.md").read_text()
PLASTICITY = next(
    text for text in re.findall(r"```python\n(.*?)```", GUIDE, re.S) if "class Plasticity(" in text
)
EFFECTS = PLASTICITY.replace("from roughgas.base", "import roughgas\nfrom roughgas.base", 1) + (
    'roughgas.register_effect("plasticity", Plasticity, before="threshold")\n'
)
"""The worked example of the guide to effects, and its line."""
OBSERVABLES = '''
"""Observables of a test."""

import numpy as np
import xarray as xr


def fast(frame):
    """The share of particles that are faster than twice the thermal speed."""
    square = _squares(frame)
    return np.mean(square > 4 * np.mean(square))


fast.long_name = "share of fast particles"


def constant(frame):
    return 1.0


def squares(frame):
    values = (frame.thermal_velocity**2).mean(axis=0)
    attributes = {"units": "a^2 T^-2", "long_name": "mean square of a component"}
    return xr.DataArray(values, {"side": ["x", "y"]}, ["side"], attrs=attributes)


def _squares(frame):
    return (frame.thermal_velocity**2).sum(axis=1)
'''
HEATED = """
    description: A heated gas.
    particles: 20
    box: [25, 25]
    effects: {spin: {inertia: 0.5}, thermostat: {power: 1, spin_share: 0.5, interval: 0.5}}
    schedule: {kind: steady, equilibrate: 20, measure: 80, sample_every: 1}
    sweep: {r: ["0.9"], beta: ["0", "0.5"], seeds: 2}
"""
CONFIG = f"""
experiments:
  plain:{HEATED}
  observed:
    extends: plain
    observables: {{fast: {{every: 2}}, squares: {{}}}}
  constant:
    extends: plain
    observables: {{constant: {{}}}}
  metal:
    extends: cooling
    particles: 20
    box: [25, 25]
    effects: {{contact_time: null, plasticity: {{yield_speed: 0.5}}}}
    schedule: {{plateau: 20, replicas: 3}}
    sweep: {{r: ["0.8"], beta: ["0"], seeds: 2, plasticity.yield_speed: ["0.5", "1"]}}
"""


def study_in_present_folder(tmp_path, monkeypatch):
    """Yield the folder of a study in a new present folder, and then forget its code."""
    shutil.copy(ROOT / "config.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)
    yield add_study()
    study_code.use(())


def study_in_use(name):
    """Make the effects of a study of this clone legal, and forget them after a test."""
    study_code.use([ROOT / "studies" / name])
    yield
    study_code.use(())


def booked_energies(scene, state, collisions):
    """Run a gas for `collisions`; return the gains of all accounts, which sum to its energy's."""
    before = balance(state, scene)
    run(state, scene, 1, collisions=collisions)
    after = balance(state, scene)
    booked = after.ledger - before.ledger
    assert imbalance(booked, after.energy - before.energy) < 1e-12
    return booked


def add_study(name="mine", effects=EFFECTS, observables=OBSERVABLES, config=CONFIG, folder="."):
    """Write a study into studies/ of a folder, without the files whose text is None."""
    study = Path(folder, "studies", name)
    study.mkdir(parents=True, exist_ok=True)
    files = {"effects.py": effects, "observables.py": observables, "config.yaml": config}
    for file, text in files.items():
        if text is not None:
            (study / file).write_text(text)
    return study
