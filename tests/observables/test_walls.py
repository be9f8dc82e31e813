"""Forces on floor and walls: exact sums, equations of state, weights, and shear flow."""

import math

import numpy as np
import pytest
from brute_force import settings
from raw import observed_settings
from tests.observables.frames import frame_of, system_of

from roughgas import simulate, theory


def observed(system, closed, rates):
    """The observable of a system, and its results from these rates of sums, by a frame of the
    `closed` system."""
    observable = observed_settings({"wall_forces": {}})[0].make(system)
    return observable, observable.combine(observable.observe(frame_of(closed, rates=rates)))


def test_pressures_and_shear_stresses_are_forces_over_areas():
    """Spheres between a front and a back wall, whose area is 10 x 8."""
    system = system_of((10, 20, 8), periodic=(True, False, True), walls=("front_wall", "back_wall"))
    front = {"J_x": 1.0, "J_y": -240.0, "J_z": 2.0, "L_x": 3.0, "L_y": 4.0, "L_z": 5.0}
    back = {"J_x": -1.0, "J_y": 160.0, "J_z": 0.0, "L_x": 0.0, "L_y": 0.0, "L_z": -5.0}
    rates = {f"{name} front_wall": value for name, value in front.items()}
    rates |= {f"{name} back_wall": value for name, value in back.items()}
    observable, results = observed(system, system, rates)
    assert observable.coordinates == {
        "wall": ["front_wall", "back_wall"],
        "component": ["x", "y", "z"],
        "rotation_axis": ["x", "y", "z"],
    }
    assert results["wall_force"].tolist() == [[1, -240, 2], [-1, 160, 0]]
    assert results["wall_torque"].tolist() == [[3, 4, 5], [0, 0, -5]]
    assert results["wall_pressure"].tolist() == [3, 2]
    expected = np.array([[1, math.nan, 2], [-1, math.nan, 0]]) / 80
    assert results["wall_shear_stress"] == pytest.approx(expected, nan_ok=True)


def test_sides_of_an_open_box_have_forces_and_no_pressure():
    walls = ("left_wall", "right_wall", "floor")
    system = system_of((10, 8), inertia=None, periodic=(False, False), walls=walls)
    rates = {f"J_{axis} {wall}": -5.0 for wall in system.walls for axis in "xy"}
    _, results = observed(system._replace(box=(10.0, None)), system, rates)
    assert results["wall_pressure"] == pytest.approx([math.nan, math.nan, 0.5], nan_ok=True)
    assert results["wall_force"].tolist() == 3 * [[-5, -5]] and "wall_torque" not in results


def gas_with_walls(kernel, particles, box, schedule, r, beta, observe="wall_forces", **effects):
    """Return a steady gas with walls, simulated by a kernel of other tests."""
    scene = settings(kernel, particles, box, **effects)["effects"]
    return simulate(
        r=r,
        beta=beta,
        particles=particles,
        box=box,
        effects=scene,
        schedule={"kind": "steady"} | schedule,
        observe=observe,
        progress=False,
    )


def adsorbed_density(particles, length):
    """Density (1/a^2) far from the walls of a square box with disks of the diameter s = 2 a.

    Near a wall the density n is higher, by n times the area that the wall cuts from the circle of
    radius s around a particle: on all distances together by (2/3) n^2 s^3 per length of the wall.
    """
    inner, density = length - 2.0, 0.0
    for _ in range(50):
        density = (particles - density**2 * 16.0 / 3.0 * 4.0 * inner) / inner**2
    return density


def test_an_elastic_gas_in_equilibrium_presses_equally_on_all_walls():
    """p = n T Z on a thermal wall and on three smooth elastic ones, within 4 sigma and 0.5 %.

    Centres reach a length of L - 2 a, with (1/3) n^2 s^3 more of them at either end, for the reason
    in `adsorbed_density`. N particles have N - 1 partners, so that Z - 1 is smaller by 1/N.
    """
    particles, length, T = 40, 40, 4.0
    gas = gas_with_walls(
        *("container", particles, [length, length]),
        {"equilibrate": 200, "measure": 20_000, "sample_every": 2, "period": 2},
        *(1.0, -1.0),
        left_wall={"temperature": T, "velocity": 0.0},
        right_wall={"restitution": 1.0, "roughness": -1.0},
        bottom_wall={"velocity": 1e-300, "roughness": -1.0},
        lid={"amplitude": 1e-300, "roughness": -1.0},
    )
    density = adsorbed_density(particles, length)
    disks = theory.mixture([{"fraction": 1}], 1.0, -1.0, 2)
    excess = theory.compressibility(disks, math.pi * density) - 1.0
    contact_density = density * (1.0 + excess * (1.0 - 1.0 / particles))
    expected = T * (contact_density * (length - 2.0) + 2.0 * density**2 * 8.0 / 3.0) / length
    pressure, error = gas.wall_pressure, gas.wall_pressure_stderr
    assert gas.wall.values.tolist() == ["left_wall", "right_wall", "bottom_wall", "lid"]
    assert np.all(error < 0.015 * expected)
    assert np.all(abs(pressure - expected) < 4.0 * error + 0.005 * expected)
    shear, torque = gas.wall_shear_stress, gas.wall_torque
    smooth = shear.sel(wall=["right_wall", "bottom_wall", "lid"]).fillna(0.0)
    assert not smooth.values.any() and not torque.sel(wall=smooth.wall).values.any()
    assert abs(shear.sel(wall="left_wall", component="y")) < 4.0 * gas.wall_shear_stress_stderr.sel(
        wall="left_wall", component="y"
    )


def test_floor_and_rough_walls_carry_the_weight_of_a_bed():
    """In the mean, to 1 % and 4 sigma; opposite walls are pressed equally."""
    particles = 60
    gas = gas_with_walls(
        *("walled", particles, [20, "open"]),
        {"equilibrate": 50, "measure": 1000, "sample_every": 0.25, "period": 1},
        *(0.9, 0.3),
        floor={"amplitude": 1.0},
    )
    force, error = gas.wall_force, gas.wall_force_stderr
    assert gas.wall.values.tolist() == ["left_wall", "right_wall", "floor"]
    total, total_error = force.sum("wall"), np.sqrt((error**2).sum("wall"))
    assert np.all(abs(total - [0.0, -particles]) < 4.0 * total_error)
    assert float(total.sel(component="y")) == pytest.approx(-particles, rel=0.01)
    floor = dict(wall="floor", component="y")
    assert float(gas.wall_pressure[2]) == pytest.approx(-float(force.sel(floor)) / 20.0)
    assert abs(total.sel(component="x")) < 0.05 * float(force.sel(wall="right_wall", component="x"))


@pytest.mark.slow  # compiles a kernel
def test_couette_flow_shears_both_walls_as_the_stress_in_the_box():
    """Disks between rough walls that slide: all of P_xy and P_yy, within 4 sigma of each."""
    length, material = 30, {"restitution": 0.95, "roughness": 0.9}
    gas = simulate(
        r=0.9,
        beta=0.3,
        particles=60,
        box=(20, length),
        effects={
            "spin": {"inertia": 0.5},
            "bottom_wall": material | {"velocity": -2},
            "lid": material | {"velocity": 2},
        },
        schedule={"kind": "steady", "equilibrate": 500, "measure": 4000, "sample_every": 0.25},
        observe=["wall_forces", "stress"],
        progress=False,
    )
    box_stress = gas.stress_kinetic + gas.stress_collisional
    errors = np.hypot(gas.stress_kinetic_stderr, gas.stress_collisional_stderr)
    box_stress, errors = (x.sel(along="y") * length / (length - 2) for x in (box_stress, errors))
    for wall, sign in (("lid", 1.0), ("bottom_wall", -1.0)):
        force, error = gas.wall_force.sel(wall=wall) / 20, gas.wall_force_stderr.sel(wall=wall) / 20
        assert np.all(abs(force - sign * box_stress) < 4.0 * np.hypot(error, errors))
        assert np.all(error + errors < 0.05 * abs(box_stress))
        assert sign * gas.wall_shear_stress.sel(wall=wall, component="x") < 0.0
        assert gas.wall_pressure.sel(wall=wall) == pytest.approx(sign * float(force[1]))
        torque = gas.wall_torque.sel(wall=wall, rotation_axis="z")  # J x n
        assert torque == pytest.approx(-sign * 20.0 * float(force[0]))
