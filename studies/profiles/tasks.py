"""Sums over the particles in slices across a gas, at phases of its drive, and over contacts there.

Slices are equally wide along the last axis, the axis of gravity or of the velocity's gradient, and
begin at 0; the last slice also holds everything above it. Samples are taken at the beginning of
each phase. A bed is advanced from contact to contact, and each contact is counted in the slice
halfway between its partners and at the nearest phase.
"""

import math
import zlib
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.gas import Gas, build, inertia, shear_rate
from roughgas.tasks import require_single_species, seed_sequence, timed

SUMS = ("particles", "u", "v", "uu", "vv", "uv", "w", "ww")
"""Sums over particles: u is the velocity along the first axis without the mean flow, v the velocity
along the last; uu is the mean square over all axes but the last, w the first component of the spin,
ww the square of the spin."""
CONTACTS = ("v_t^2", "v_r^2", "v_t.v_r")
GAS_VARIABLES = ("E_trans", "E_rot", "R")
PAIRS = ("pairs", "g", "g^2", "g^3", "s^2", "g s^2")
"""Sums over pairs: g is their relative speed, s the relative speed of their surfaces due to spin,
across a random direction."""
LEVEL_DISTANCE, NEAR_DISTANCE = 1.0, 4.0  # a
COMPANY = ("level", "meeting")
"""Classes of pairs: all whose heights differ by less than LEVEL_DISTANCE; those of them that are
nearer than NEAR_DISTANCE and approach each other."""


class Profile:
    """A gas and its sums: `sums`, `contacts` and `gas_sums` (names, phases, ...).

    Lengths in a, times in T.
    """

    def __init__(self, gas: Gas, point: Mapping[str, Any], phases: int, slices: int) -> None:
        self.gas, self.width, self.phases = gas, point["slice"], phases
        self.period, self.start = point["period"], gas.time
        gas.sample_now()
        self.sums = np.zeros((len(SUMS), phases, slices))
        self.contacts = np.zeros((1 + len(CONTACTS), phases, slices))
        self.gas_sums = np.zeros((len(GAS_VARIABLES), phases))
        self.pairs = np.zeros((len(PAIRS), len(COMPANY)))
        self.partners = np.triu_indices(gas.particles, 1)

    def sample_next_phase(self, number: int) -> None:
        """Advance the gas to the begin of the next phase, the `number`-th in all, and sample
        there."""
        self._advance(self.start + (number + 1) * self.period / self.phases)
        phase = (number + 1) % self.phases
        E_trans, E_rot = (
            float(x[0]) for x in self.gas.energies(self.gas.sample).present_components()
        )
        R = E_rot / (E_rot + E_trans)
        self.gas_sums[:, phase] += E_trans, E_rot, R
        position, velocity = self.gas.positions_and_velocities()
        for row, values in zip(self.sums, self._particles(position, velocity), strict=True):
            row[phase] += values
        if self.gas.scene.box[-1] is None:
            self.pairs += self._pairs(position, velocity)

    def _particles(self, position, velocity):
        """Yield SUMS over the particles in each slice, (slices,) each."""
        scene, spin = self.gas.scene, self.gas.spins()
        if shear_rate(scene) > 0.0:
            flow = shear_rate(scene) * (position[:, 1] - scene.middle)
            velocity = velocity - np.stack([flow, np.zeros(len(flow))], axis=1)
        u, v, w = velocity[:, 0], velocity[:, -1], spin[:, 0]
        across = (velocity[:, :-1] ** 2).mean(axis=1)
        ones, spins = np.ones(len(u)), (spin**2).sum(axis=1)
        slices = self._slices(position[:, -1])
        for values in (ones, u, v, across, v * v, u * v, w, spins):
            yield np.bincount(slices, values, self.sums.shape[-1])

    def _pairs(self, position, velocity):
        """Return PAIRS of each COMPANY, (names, companies)."""
        first, second = self.partners
        level = np.abs(position[first, -1] - position[second, -1]) < LEVEL_DISTANCE
        first, second = first[level], second[level]
        separation, relative_velocity = (
            position[first] - position[second],
            velocity[first] - velocity[second],
        )
        for axis, length in enumerate(self.gas.scene.box[:-1]):
            separation[:, axis] -= length * np.round(separation[:, axis] / length)
        meeting = (separation**2).sum(axis=1) < NEAR_DISTANCE**2
        meeting &= (separation * relative_velocity).sum(axis=1) < 0.0
        spin = self.gas.spins()
        square = ((spin[first] + spin[second]) ** 2).sum(axis=1) * (
            2 / 3 if spin.shape[1] > 1 else 1
        )
        g = np.sqrt((relative_velocity**2).sum(axis=1))
        values = np.array([np.ones(len(g)), g, g**2, g**3, square, g * square])
        return np.stack([values.sum(axis=1), values[:, meeting].sum(axis=1)], axis=1)

    def _advance(self, until: float) -> None:
        """Advance the gas and count contacts: in a bed each in its slice, otherwise evenly over all
        slices."""
        if self.gas.scene.box[-1] is None:
            return self._advance_by_contacts(until)
        before, collisions = self.gas.contact_sums(), self.gas.collisions
        self.gas.in_time(until - self.gas.time, 1)
        increments = 1.0 * (self.gas.collisions - collisions), *(self.gas.contact_sums() - before)
        self.contacts[:, self._phase()] += np.array(increments)[:, None] / self.contacts.shape[-1]

    def _advance_by_contacts(self, until):
        before = self.gas.contact_sums()
        while self.gas.step(until, 1):
            sums = self.gas.contact_sums()
            self.contacts[:, self._phase(), self._slice_of_contact()] += 1.0, *(sums - before)
            before = sums

    def _phase(self):
        """Return the number of the nearest phase."""
        return round((self.gas.time - self.start) / self.period * self.phases) % self.phases

    def _slice_of_contact(self):
        """Return the slice of the last contact, whose partners have not moved since."""
        *_, positions = self.gas.last_contact()
        return self._slices(positions[:, -1].mean())

    def _slices(self, heights):
        return np.minimum(heights / self.width, self.sums.shape[-1] - 1).astype(int)


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all runs."""
    return [
        f"{point_name(point)}-{k}" for point in settings["points"] for k in range(settings["runs"])
    ]


def point_name(point: Mapping[str, Any]) -> str:
    """Return the name of a point; its runs add `-0`, `-1` ... Random numbers depend on it."""
    name = f"{point['experiment']}_r{point['r']}_beta{point['beta']}"
    return name + (f"_{point['name']}" if "name" in point else "")


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return the sums of one run at a point, over (phase, slice), and over the whole gas (phase,).

    `samples` is the number of samples at each phase, `measured` their duration in T.
    """
    point = next(row for row in settings["points"] if task.startswith(point_name(row) + "-"))
    number = int(task.removeprefix(point_name(point) + "-"))
    seed = seed_sequence(settings, zlib.crc32(point_name(point).encode()), number)
    require_single_species(experiments[point["experiment"]])
    profile = _equilibrated(point, experiments[point["experiment"]], settings, seed)
    periods = round(point["measure"] / point["period"])
    seconds, before = 0.0, profile.gas.collisions
    for done in range(periods):
        seconds += timed(_one_period, profile, done)[1]
        progress(done + 1, periods)
    grid = ("phase", "slice")
    columns: dict[str, Any] = dict(zip(SUMS, ((grid, sums) for sums in profile.sums), strict=True))
    for name, sums in zip(("contacts", *CONTACTS), profile.contacts, strict=True):
        columns[name] = (grid, sums)
    for name, sums in zip(GAS_VARIABLES, profile.gas_sums, strict=True):
        columns[name] = ("phase", sums)
    for name, sums in zip(PAIRS, profile.pairs, strict=True):
        columns[name] = ("company", sums)
    columns |= {"samples": periods, "cpu_seconds": seconds} | _scene_numbers(profile.gas.scene)
    columns["collisions"] = profile.gas.collisions - before
    return xr.Dataset(columns, {"company": list(COMPANY)})


def _scene_numbers(scene):
    """Return the constants that turn sums into averages; `area` is the area of a slice, a^(D -
    1)."""
    values = {"dimension": len(scene.box), "inertia": inertia(scene.effects)}
    return values | {"area": math.prod(scene.box[:-1]), "shear_rate": shear_rate(scene)}


def _one_period(profile, done):
    for phase in range(profile.phases):
        profile.sample_next_phase(done * profile.phases + phase)


def _equilibrated(point, experiment, settings, seed):
    experiment = experiment.with_effects(point.get("effects", {}) | {"contact_averages": {}})
    scene = build(experiment, float(point["r"]), float(point["beta"]))
    gas = Gas.start(scene, experiment, np.random.default_rng(seed))
    gas.in_time(1.0, round(point["equilibrate"]))
    return Profile(gas, point, settings["phases"], settings["slices"])
