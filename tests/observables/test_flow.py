"""The local flow of a gas, and the verdict on an R that takes a flow for temperature."""

import math

import numpy as np
import pytest
from tests.observables.frames import frame_of, system_of

import roughgas
from roughgas.observables.flow import (
    ParticleMotion,
    cell_counts,
    flow_corrected_energies,
    local_energies,
)
from roughgas.simulation.point import flow_verdict
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.sample_sizes import NO, UNKNOWN, YES

BOX = (40, 60)
SPIN = {"spin": {"inertia": 0.5}}


def frames(system, number, flow=None, seed=1):
    """Yield frames of a gas in equilibrium at E_trans = 1/2, plus `flow(positions)` along x."""
    rng, N, D = np.random.default_rng(seed), system.particles, system.dimension
    for _ in range(number):
        position = rng.uniform(0.0, 1.0, (N, D)) * system.box
        velocity = rng.standard_normal((N, D))
        if flow:
            velocity[:, 0] += flow(position)
        yield frame_of(system, position, velocity, rng.standard_normal((N, 2 * D - 3)))


def motion_of(frame):
    return ParticleMotion(
        *(frame.position, frame.velocity, frame.spin, frame.mass, frame.inertia, frame.radius)
    )


def flow_energies(system, number, flow=None, particles=40):
    """Return the energies of a gas relative to its local flow, (frames,) each."""
    motions = [motion_of(frame) for frame in frames(system, number, flow)]
    return flow_corrected_energies(motions, system, cell_counts(system, particles))


@pytest.mark.parametrize("particles", [3, 10, 40])
@pytest.mark.parametrize("box", [BOX, (14, 14, 20)])
def test_a_gas_in_equilibrium_has_the_same_energy_in_cells_of_any_size(box, particles):
    """400 frames of 160 particles: within 4 standard errors, by chance once in 8000 cases."""
    energies = flow_energies(system_of(box, particles=160), 400, particles=particles)
    for name, expected in (("E_trans", 0.5), ("shift", 0.0)):
        values = getattr(energies, name)
        assert abs(values.mean() - expected) < 4.0 * values.std() / math.sqrt(len(values))


def test_a_macroscopic_flow_is_no_temperature():
    """A wave with the energy of a tenth of the gas: E_trans has it, and E_trans_local nearly not.

    Within a cell of 12 a the velocity of a wave of 60 a still varies: a tenth of its energy
    remains. The shift is the change of R = 1/3, at equal temperatures, by an energy lower by 8 %.
    """
    system = system_of(BOX, particles=1600)
    wave = math.sqrt(2.0 * 0.2)
    energies = flow_energies(system, 20, lambda x: wave * np.sin(2.0 * np.pi * x[:, 1] / BOX[1]))
    assert energies.E_trans.mean() == pytest.approx(0.5, rel=0.02)
    rotation = 0.25  # q/2
    expected = rotation / (rotation + 0.5) - rotation / (rotation + 0.55)
    assert energies.shift.mean() == pytest.approx(expected, rel=0.15)


def test_cells_are_those_of_a_loop_over_particles():
    """Masses differ, and one particle is alone in its cell."""
    system = system_of((10, 20), particles=11)
    (frame,) = frames(system, 1)
    mass = np.linspace(0.5, 3.0, 11)
    frame = frame._replace(mass=mass)
    cells = {}
    for k, (x, y) in enumerate(frame.position):
        cells.setdefault((int(x / 10 * 2), int(y / 20 * 3)), []).append(k)
    numbers = np.array([3 * int(x / 10 * 2) + int(y / 20 * 3) for x, y in frame.position])
    energy, freedom = 0.0, 0
    for members in cells.values():
        flow = sum(mass[k] * frame.velocity[k] for k in members) / sum(mass[k] for k in members)
        energy += sum(0.5 * mass[k] * sum((frame.velocity[k] - flow) ** 2) for k in members)
        freedom += 2 * (len(members) - 1)
    (local,), (overall,) = local_energies(mass[None], frame.velocity[None], numbers[None], 6)
    energies = flow_corrected_energies([motion_of(frame)], system, (2, 3))
    assert energies.E_trans == pytest.approx([local])
    assert local == pytest.approx(energy / freedom)
    mean = mass @ frame.velocity / mass.sum()
    energy = 0.5 * mass @ ((frame.velocity - mean) ** 2).sum(axis=1)
    assert overall == pytest.approx(energy / 20)


@pytest.mark.parametrize(
    ("system", "cells"),
    [
        (system_of((50, 50), particles=160), (2, 2)),
        (system_of((60, 350), particles=1500), (3, 15)),
        (system_of((25, 25), particles=40), (1, 1)),
        (system_of((40, 40), particles=100, periodic=(True, False)), (1, 10)),
        (system_of((40, 40), particles=1000, periodic=(True, False)), (1, 16)),
        (system_of((20, 20, 20), particles=320), (2, 2, 2)),
    ],
)
def test_cells_have_forty_particles_and_layers_between_walls_ten(system, cells):
    assert cell_counts(system, 40) == cells


# ------------------------------------------------------------------------ verdicts

POINT = {"R": 0.2, "R_ci95": 0.01, "R_ci95_trusted": YES, "E_trans_trusted": YES, "target_met": YES}


@pytest.mark.parametrize(
    ("shift", "stderr", "flows"),
    [(0.011, 0.001, True), (0.009, 0.001, False), (0.011, 0.006, False), (-0.02, 0.001, False)],
)
def test_a_shift_beyond_the_interval_of_R_takes_its_verdicts_back(shift, stderr, flows):
    """If the shift is significant, and larger than the stated error of R."""
    point = POINT | flow_verdict(POINT, Estimate(shift, stderr))
    expected = UNKNOWN if flows else YES
    assert point["R_flow_shift"] == shift
    assert [point[name] for name in list(POINT)[2:]] == [expected] * 3


def test_untrusted_numbers_stay_untrusted():
    point = POINT | {"R_ci95_trusted": NO, "E_trans_trusted": NO, "target_met": NO}
    point = point | flow_verdict(point, Estimate(0.05, 0.001))
    assert [point[name] for name in list(POINT)[2:]] == [NO] * 3


@pytest.mark.slow
def test_a_large_sheared_gas_has_a_flow_that_R_counts_as_temperature():
    """R relative to the local flow is two of its intervals above R, whose verdict is unknown."""
    point = roughgas.simulate(
        r=0.8,
        beta=0.0,
        particles=1500,
        box=[60, 350],
        effects=SPIN | {"shear": {"velocity": 30}},
        schedule={"kind": "steady", "equilibrate": 1000, "measure": 1500, "sample_every": 1},
        observe=["local_flow"],
        progress=False,
    )
    assert int(point.equilibrated) == YES
    assert int(point.R_ci95_trusted) == int(point.E_trans_trusted) == UNKNOWN
    assert float(point.R_flow_shift) > float(point.R_ci95) and float(point.R_flow_sigma) > 3.0
    over_flow = float(point.R_local) - float(point.R)
    assert over_flow == pytest.approx(float(point.R_flow_shift), abs=0.004)


def test_the_papers_sheared_gas_has_no_secondary_flow():
    schedule = {"kind": "steady", "equilibrate": 500, "measure": 3000, "sample_every": 1}
    point = roughgas.simulate("sheared", r=0.8, beta=0.0, schedule=schedule, progress=False)
    assert int(point.R_ci95_trusted) == YES
    assert 0.0 < abs(float(point.R_flow_shift)) < float(point.R_ci95)


@pytest.mark.slow
def test_the_flow_between_sliding_walls_is_measured_by_default():
    """Its line is fitted to the flow, which slips at the walls and bends."""
    sides = {"bottom_wall": {"velocity": -2.0, "roughness": 0.5}}
    sides |= {"lid": {"velocity": 2.0, "roughness": 0.5}}
    schedule = {"kind": "steady", "equilibrate": 200, "measure": 600, "sample_every": 1}
    gas = dict(particles=100, box=[40, 40], effects=SPIN | sides, schedule=schedule, progress=False)
    point = roughgas.simulate(r=0.8, beta=0.0, **gas)
    assert math.isfinite(float(point.R_flow_shift)) and float(point.R_flow_shift) != 0.0
    heated = {"thermostat": {"power": 0.1, "interval": 0.5, "spin_share": 0}}
    at_rest = roughgas.simulate(r=0.8, beta=0.0, **gas | {"effects": SPIN | heated})
    assert "R_flow_shift" not in at_rest


def test_few_particles_have_no_measured_flow():
    schedule = {"kind": "steady", "equilibrate": 500, "measure": 1000, "sample_every": 1}
    sheared = dict(r=0.8, beta=0.0, schedule=schedule, progress=False)
    point = roughgas.simulate("sheared", particles=40, box=[25, 25], **sheared)
    assert "R_flow_shift" not in point
