"""Sums over the particles in slices across a gas, at phases of its drive, and over contacts there.

Slices are equally wide along the last axis, that of gravity or of the velocity's gradient, and
begin at 0; the last one holds all that is beyond. Samples are taken at the beginning of each phase.
A bed goes on from contact to contact, and each contact is counted in the slice halfway between its
partners and at the nearest phase.
"""

import math
import zlib
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.gas import Gas, build, inertia, shear_rate
from roughgas.tasks import check_alike, stream, timed

SUMS = ("particles", "u", "v", "uu", "vv", "uv", "w", "ww")
"""Over particles: u is the velocity along the first axis without the mean flow, v that along the
last; uu is the mean square over all axes but the last, w the first component of the spin, ww the
square of the spin."""
CONTACTS = ("v_t^2", "v_r^2", "v_t.v_r")
WHOLE = ("E_trans", "E_rot", "R")
PAIRS = ("pairs", "g", "g^2", "g^3", "s^2", "g s^2")
"""Over pairs: g is their relative speed, s that of their surfaces due to spin, across a direction
that is random."""
LEVEL, NEAR = 1.0, 4.0  # a
COMPANY = ("level", "meeting")
"""Of pairs: all whose heights differ by less than LEVEL; those of them that are nearer than NEAR
and approach each other."""


class Profile:
    """A gas, and what was summed up over it: `sums`, `contacts` and `whole` (names, phases, ...).

    Lengths in a, times in T.
    """

    def __init__(self, gas: Gas, point: Mapping[str, Any], phases: int, slices: int) -> None:
        self.gas, self.width, self.phases = gas, point["slice"], phases
        self.period, self.begun = point["period"], gas.time
        gas.look()
        self.sums = np.zeros((len(SUMS), phases, slices))
        self.contacts = np.zeros((1 + len(CONTACTS), phases, slices))
        self.whole = np.zeros((len(WHOLE), phases))
        self.pairs = np.zeros((len(PAIRS), len(COMPANY)))
        self.partners = np.triu_indices(gas.particles, 1)

    def go_on(self, number: int) -> None:
        """Go on to the beginning of the next phase, the `number`-th in all, and sample there."""
        self._advance(self.begun + (number + 1) * self.period / self.phases)
        phase = (number + 1) % self.phases
        E_trans, E_rot = (float(x[0]) for x in self.gas.energies(self.gas.sample).there())
        R = E_rot / (E_rot + E_trans)
        self.whole[:, phase] += E_trans, E_rot, R
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
        one, two = self.partners
        level = np.abs(position[one, -1] - position[two, -1]) < LEVEL
        one, two = one[level], two[level]
        apart, between = position[one] - position[two], velocity[one] - velocity[two]
        for axis, length in enumerate(self.gas.scene.box[:-1]):
            apart[:, axis] -= length * np.round(apart[:, axis] / length)
        meeting = (apart**2).sum(axis=1) < NEAR**2
        meeting &= (apart * between).sum(axis=1) < 0.0
        spin = self.gas.spins()
        square = ((spin[one] + spin[two]) ** 2).sum(axis=1) * (2 / 3 if spin.shape[1] > 1 else 1)
        g = np.sqrt((between**2).sum(axis=1))
        values = np.array([np.ones(len(g)), g, g**2, g**3, square, g * square])
        return np.stack([values.sum(axis=1), values[:, meeting].sum(axis=1)], axis=1)

    def _advance(self, until: float) -> None:
        """Go on, and count contacts: in a bed each where it happens, elsewhere the same in all
        slices."""
        if self.gas.scene.box[-1] is None:
            return self._go_on_by_contacts(until)
        before, collisions = self.gas.contact_sums(), self.gas.collisions
        self.gas.in_time(until - self.gas.time, 1)
        made = 1.0 * (self.gas.collisions - collisions), *(self.gas.contact_sums() - before)
        self.contacts[:, self._phase()] += np.array(made)[:, None] / self.contacts.shape[-1]

    def _go_on_by_contacts(self, until):
        before = self.gas.contact_sums()
        while self.gas.step(until, 1):
            now = self.gas.contact_sums()
            self.contacts[:, self._phase(), self._slice_of_contact()] += 1.0, *(now - before)
            before = now

    def _phase(self):
        """Return the number of the nearest phase."""
        return round((self.gas.time - self.begun) / self.period * self.phases) % self.phases

    def _slice_of_contact(self):
        """Return the slice of the contact that is just over; its partners are still there."""
        *_, positions = self.gas.last_contact()
        return self._slices(positions[:, -1].mean())

    def _slices(self, heights):
        return np.minimum(heights / self.width, self.sums.shape[-1] - 1).astype(int)


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all runs."""
    return [f"{point_name(one)}-{k}" for one in settings["points"] for k in range(settings["runs"])]


def point_name(point: Mapping[str, Any]) -> str:
    """Return the name of a point; its runs add `-0`, `-1` ... Random numbers hang on it."""
    name = f"{point['experiment']}_r{point['r']}_beta{point['beta']}"
    return name + (f"_{point['name']}" if "name" in point else "")


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return the sums of one run at a point, over (phase, slice), and over the whole gas (phase,).

    `samples` is the number of samples at each phase, `measured` the T that these cover.
    """
    point = next(one for one in settings["points"] if task.startswith(point_name(one) + "-"))
    number = int(task.removeprefix(point_name(point) + "-"))
    seed = stream(settings, zlib.crc32(point_name(point).encode()), number)
    check_alike(experiments[point["experiment"]])
    profile = _equilibrated(point, experiments[point["experiment"]], settings, seed)
    periods = round(point["measure"] / point["period"])
    seconds, before = 0.0, profile.gas.collisions
    for done in range(periods):
        seconds += timed(_one_period, profile, done)[1]
        progress(done + 1, periods)
    grid = ("phase", "slice")
    found: dict[str, Any] = dict(zip(SUMS, ((grid, one) for one in profile.sums), strict=True))
    for name, values in zip(("contacts", *CONTACTS), profile.contacts, strict=True):
        found[name] = (grid, values)
    for name, values in zip(WHOLE, profile.whole, strict=True):
        found[name] = ("phase", values)
    for name, values in zip(PAIRS, profile.pairs, strict=True):
        found[name] = ("company", values)
    found |= {"samples": periods, "cpu_seconds": seconds} | _about(profile.gas.scene)
    found["collisions"] = profile.gas.collisions - before
    return xr.Dataset(found, {"company": list(COMPANY)})


def _about(scene):
    """Return what the sums are turned into averages with; `area` is that of a slice, a^(D - 1)."""
    found = {"dimension": len(scene.box), "inertia": inertia(scene.effects)}
    return found | {"area": math.prod(scene.box[:-1]), "shear_rate": shear_rate(scene)}


def _one_period(profile, done):
    for phase in range(profile.phases):
        profile.go_on(done * profile.phases + phase)


def _equilibrated(point, experiment, settings, seed):
    effects = experiment["effects"] | point.get("effects", {}) | {"contact_averages": {}}
    experiment = experiment | {"effects": effects}
    scene = build(experiment, float(point["r"]), float(point["beta"]))
    gas = Gas.start(scene, experiment, np.random.default_rng(seed))
    gas.in_time(1.0, round(point["equilibrate"]))
    return Profile(gas, point, settings["phases"], settings["slices"])
