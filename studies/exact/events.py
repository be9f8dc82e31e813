"""Event-driven gases in periodic boxes, one run per function."""

import math

import numpy as np

from roughgas import theory
from roughgas.gas import Gas, build, restored, scene_settings

from .homogeneous import unbiased

KICKS_PER_COLLISION = 4  # of a particle
BURST_LENGTH = 0.01  # collisions per particle of one measurement
RENEWAL = 0.2  # collisions per particle as smooth elastic gas between two measurements
MIXTURE_RENEWAL = 2.0  # the same for a mixture, whose species lose unlike shares of their energies
REFRESH_INTERVAL = 10.0  # collisions per particle between two rescalings of a cooling gas
CONTACT_GAP = 1e-9  # a: pairs with smaller gaps are in contact
SHELLS = np.linspace(2.0, 2.5, 11)  # a: edges of the bins of pair distances


def _thermalised_gas(
    settings, dimension, packing, r, beta, effects, seed, **further_settings
) -> Gas:
    """Return a gas in a periodic box, after collisions as an elastic gas."""
    number = settings["particles"]
    side = (number / float(theory.number_density(packing, dimension))) ** (1.0 / dimension)
    raw = {"particles": number, "box": [side] * dimension, "effects": effects, **further_settings}
    experiment = scene_settings(raw)
    gas = Gas.start(build(experiment, r=r, beta=beta), experiment, np.random.default_rng(seed))
    gas.thermalise(settings["thermalise"] if "thermalise" in settings else 20.0)
    return gas


def temperature(gas: Gas) -> float:
    """Return T_tr of particles of mass 1 without total momentum, which have D(N - 1) velocities."""
    velocity = gas.positions_and_velocities()[1]
    return float(np.sum(velocity**2)) / (velocity.size - velocity.shape[1])


def fluid(settings, gas, seed) -> dict[str, float]:
    """Return the compressibility factor Z of a smooth elastic fluid from momentum transfer and from
    the number of collisions, and the pair correlation at contact.

    Z - 1 is the virial sum of 2 a m g_n per time over D N T; a gas of Maxwellian velocities has
    <g_n> = sqrt(pi T/m) at contacts.
    """
    dimension, packing = gas
    fluid = _thermalised_gas(settings, dimension, packing, 1.0, -1.0, {"contact_stress": {}}, seed)
    T, number, begun = temperature(fluid), settings["particles"], fluid.collisions
    fluid.sample_now()
    first, counts = fluid.sample, np.zeros(len(SHELLS) - 1)
    samples = round(settings["measure"] / settings["every"])
    for _ in range(samples):
        fluid.in_collisions(fluid.count(settings["every"]), 1)
        counts += _count_pairs(fluid.positions_and_velocities()[0], fluid.scene.box)
    last = fluid.sample
    passed = float(last["time"][0] - first["time"][0])
    virial = sum(float(last[f"J_{k} s_{k}"][0] - first[f"J_{k} s_{k}"][0]) for k in "xyz")
    frequency = 2.0 * (fluid.collisions - begun) / (number * passed)
    return {
        "Z_stress": 1.0 + virial / (passed * dimension * number * T),
        "Z_collisions": 1.0 + frequency * math.sqrt(math.pi / T) / dimension,
        "contact_value": _contact_value(counts / samples, number, packing, dimension),
    }


def _count_pairs(position, box):
    """Return the numbers of pairs whose distance is in each of the SHELLS.

    A sample is taken at a collision: the pair that has just collided is left out.
    """
    farthest = SHELLS[-1]
    position = position[np.argsort(position[:, 0])]
    number = len(position)
    images = position[position[:, 0] < farthest] + np.eye(len(box))[0] * box[0]
    position = np.concatenate([position, images])
    ends = np.searchsorted(position[:, 0], position[:number, 0] + farthest)
    partners = ends - np.arange(number) - 1
    first = np.repeat(np.arange(number), partners)
    second = first + 1 + np.arange(len(first)) - np.repeat(np.cumsum(partners) - partners, partners)
    away = position[second] - position[first]
    away[:, 1:] -= np.array(box[1:]) * np.rint(away[:, 1:] / np.array(box[1:]))
    distance = np.sqrt(np.sum(away**2, axis=1))
    return np.histogram(distance[distance > SHELLS[0] + CONTACT_GAP], SHELLS)[0]


def _contact_value(counts, number, packing, dimension):
    """Return g at the diameter, from a parabola through its values in the SHELLS."""
    volumes = {2: math.pi, 3: 4.0 * math.pi / 3.0}[dimension] * np.diff(SHELLS**dimension)
    density = float(theory.number_density(packing, dimension))
    g = counts / (0.5 * (number - 1) * density * volumes)
    middle = 0.5 * (SHELLS[1:] + SHELLS[:-1]) - SHELLS[0]
    return float(np.polynomial.polynomial.polyfit(middle, g, 2, w=np.sqrt(volumes))[0])


def noise(settings, gas, seed) -> dict[str, float]:
    """Return the cumulant a2 of a smooth gas that white noise drives to T = 1."""
    dimension, r = gas
    frequency = float(theory.collision_frequency(1.0, settings["packing"], dimension))
    power = frequency * (1.0 - r**2) / 2.0
    kicks = {"power": power, "spin_share": 0, "interval": 2.0 / (KICKS_PER_COLLISION * frequency)}
    effects = {"thermostat": kicks}
    driven = _thermalised_gas(settings, dimension, settings["packing"], r, -1.0, effects, seed)
    driven.in_time(settings["thermalise"] / frequency, 1)
    cumulants = []
    for _ in range(settings["measure"]):
        driven.in_time(1.0 / frequency, 1)
        square = np.sum(driven.positions_and_velocities()[1] ** 2, axis=1)
        moments = np.mean(square**2) / np.mean(square) ** 2
        cumulants.append(dimension / (dimension + 2.0) * moments - 1.0)
    return {"a2": float(unbiased(np.array(cumulants), settings["particles"], dimension).mean())}


def tracer(settings, gas, seed) -> dict[str, float]:
    """Return T_0/T of a few smooth spheres whose contacts with all other spheres are inelastic.

    All other contacts are elastic; contacts between two tracers leave a Maxwellian as it is. As the
    total momentum is zero, a particle has the energy D/2 T (1 - m/M), M being the total mass.
    """
    r, mass = gas
    tracers, number = settings["tracers"], settings["particles"]
    species = [
        {"name": "elastic", "number": number - tracers},
        {"name": "tracer", "number": tracers, "mass": mass},
    ]
    pairs = [{"between": ["elastic", "tracer"], "restitution": r}]
    species_settings = {"species": species, "species_pairs": pairs}
    mixture = _thermalised_gas(
        settings, 3, settings["packing"], 1.0, -1.0, {}, seed, **species_settings
    )
    mixture.cool(refresh_every=mixture.count(1.0))
    mixture.in_collisions(mixture.count(1.0), settings["thermalise"])
    total = number - tracers + tracers * mass
    retained = np.array([1.0 - 1.0 / total, 1.0 - mass / total])
    shares = np.zeros(2)
    for _ in range(settings["measure"]):
        mixture.in_collisions(mixture.count(1.0), 1)
        velocity = mixture.positions_and_velocities()[1]
        heavy = mixture.state.bodies.species == 1
        energies = np.array([np.mean(velocity[~heavy] ** 2), mass * np.mean(velocity[heavy] ** 2)])
        shares += energies / energies[0]
    return {"ratio": float(shares[1] / shares[0] * retained[0] / retained[1])}


def rates(settings, gas, seed) -> dict[str, float]:
    """Return -dT_tr/dn and dT_rot/dn over T_tr, n in collisions per particle, for a gas in
    equilibrium as smooth elastic particles and Maxwellian spins at T_rot = theta T_tr.

    A measurement lasts a hundredth of a collision per particle; it is repeated many times.
    """
    dimension, r, beta, theta = gas
    q = theory.moment_of_inertia(dimension)
    effects = {"spin": {"inertia": q}}
    rough = _thermalised_gas(settings, dimension, settings["packing"], r, beta, effects, seed)
    rng, number = np.random.default_rng(seed.spawn(1)[0]), settings["particles"]
    collisions, loss, gain = rough.count(BURST_LENGTH), 0.0, 0.0
    spins = 2 * dimension - 3
    for _ in range(settings["bursts"]):
        rough.thermalise(RENEWAL)
        before = temperature(rough)
        new_spins = rng.standard_normal((number, spins))
        new_spins *= math.sqrt(theta * before / (q * np.mean(new_spins**2)))
        rough.state.spin[:] = new_spins
        rough.in_collisions(collisions, 1)
        after = temperature(rough)
        mean = 0.5 * (before + after)
        loss += (before - after) / mean
        gain += (q * np.mean(rough.spins() ** 2) - theta * before) / mean
    passed = settings["bursts"] * 2.0 * collisions / number
    # the motion of the centre of mass loses nothing
    return {"loss": loss / passed * (number - 1) / number, "gain": gain / passed}


def clusters(settings, gas, seed) -> dict[str, float]:
    """Return -d ln E/d ln t of translation and rotation of rough disks that cool, between two
    numbers of collisions per particle, while clusters grow."""
    r, beta = gas
    effects = {"spin": {"inertia": theory.moment_of_inertia(2)}}
    effects["contact_time"] = {"duration": 1e-4, "below_r": 1}  # against a collapse in clusters
    disks = _thermalised_gas(settings, 2, settings["packing"], r, beta, effects, seed)
    disks.sample_now()
    start = float(disks.sample["time"][0])
    leg = disks.count(REFRESH_INTERVAL)
    disks.cool(refresh_every=leg)
    disks.in_collisions(leg, round(settings["from"] / REFRESH_INTERVAL))
    early, time = _log_energies(disks), float(disks.sample["time"][0]) - start
    disks.in_collisions(leg, round((settings["to"] - settings["from"]) / REFRESH_INTERVAL))
    passed = math.log((float(disks.sample["time"][0]) - start) / time)
    translation, rotation = (early - _log_energies(disks)) / passed
    return {"translation": float(translation), "rotation": float(rotation)}


def _log_energies(gas) -> np.ndarray:
    """Return the logarithms of E_trans and E_rot at the last sample."""
    energies = restored(gas.energies(gas.sample), gas.sample["exponent"])
    return np.log([float(column[0]) for column in energies[:2]])


def mixtures(settings, gas, seed) -> dict[str, float]:
    """Return the rates of `rates` for each species of spheres, half of them of mass and radius 1.

    T counts D (N - 1) degrees of freedom, so that pair energies are as if the momentum were not
    fixed.
    """
    r, beta, theta, mass, radius = gas
    number, q = settings["particles"], theory.moment_of_inertia(3)
    species = [{"name": "a"}, {"name": "b", "mass": mass, "radius": radius}]
    species = [row | {"number": number // 2} for row in species]
    packing = settings["packing"] / (0.5 * (1.0 + radius**3))  # as if all had the radius 1
    effects = {"spin": {"inertia": q}}
    mixture = _thermalised_gas(settings, 3, packing, r, beta, effects, seed, species=species)
    rng, collisions = np.random.default_rng(seed.spawn(1)[0]), mixture.count(BURST_LENGTH)
    sums, passed = np.zeros((2, 2)), settings["bursts"] * 2.0 * collisions / number
    for _ in range(settings["bursts"]):
        mixture.thermalise(MIXTURE_RENEWAL)
        mass = mixture.state.bodies.mass
        unit_spins = rng.standard_normal((number, 3)) * np.sqrt(theta / (q * mass))[:, None]
        velocity = mixture.positions_and_velocities()[1]
        T = float(np.sum(mass * np.sum(velocity**2, axis=1))) / (3.0 * (number - 1))
        mixture.state.spin[:] = unit_spins * math.sqrt(T)
        before = _energies(mixture, q)
        mixture.in_collisions(collisions, 1)
        change = _energies(mixture, q) - before
        sums += change / (T + 0.25 * change[:, 0].sum())
    (loss_1, gain_1), (loss_2, gain_2) = sums / passed
    return {"loss_1": -loss_1, "loss_2": -loss_2, "gain_1": gain_1, "gain_2": gain_2}


def _energies(gas, q):
    """Return m v^2/3 and q m (a w)^2/3 averaged over each species, (species, 2)."""
    mass, species = gas.state.bodies.mass / 3.0, gas.state.bodies.species
    velocity, spin = gas.positions_and_velocities()[1], gas.spins()
    energies = mass * np.sum(velocity**2, axis=1), q * mass * np.sum(spin**2, axis=1)
    return np.array([[energy[species == k].mean() for energy in energies] for k in (0, 1)])
