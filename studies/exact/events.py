"""Event-driven gases in periodic boxes: one run each."""

import math

import numpy as np

from roughgas import theory
from roughgas.gas import Gas, build, restored

from .homogeneous import unbiased

KICKS = 4  # that a particle gets between two of its collisions
BURST = 0.01  # collisions per particle that are watched at once
RENEWED = 0.2  # collisions per particle of the smooth elastic gas in between
EQUALISED = 2.0  # the same of a mixture, whose species have lost unlike shares of their energies
REFRESHED = 10.0  # collisions per particle after which a cooling gas is rescaled
GRAZE = 1e-9  # a: nearer pairs are in contact
SHELLS = np.linspace(2.0, 2.5, 11)  # in which pairs are counted, in a


def _started(about, dimension, packing, r, beta, effects, seed, **more) -> Gas:
    """Return a gas in a periodic box, after it has collided as an elastic one."""
    number = about["particles"]
    side = (number / float(theory.number_density(packing, dimension))) ** (1.0 / dimension)
    experiment = {"particles": number, "box": [side] * dimension, "effects": effects, **more}
    gas = Gas.start(build(experiment, r=r, beta=beta), experiment, np.random.default_rng(seed))
    gas.thermalise(about["thermalise"] if "thermalise" in about else 20.0)
    return gas


def temperature(gas: Gas) -> float:
    """Return T_tr of particles of mass 1 without momentum, which have D(N - 1) velocities."""
    velocity = gas.positions_and_velocities()[1]
    return float(np.sum(velocity**2)) / (velocity.size - velocity.shape[1])


def fluid(about, gas, seed) -> dict[str, float]:
    """Return the compressibility factor Z of a smooth elastic fluid from momentum transfer and from
    the number of collisions, and the pair correlation at contact.

    Z - 1 is the virial sum of 2 a m g_n per time over D N T; a gas of Maxwellian velocities has
    <g_n> = sqrt(pi T/m) at contacts.
    """
    dimension, packing = gas
    fluid = _started(about, dimension, packing, 1.0, -1.0, {"contact_stress": {}}, seed)
    T, number, begun = temperature(fluid), about["particles"], fluid.collisions
    fluid.look()
    first, counts = fluid.sample, np.zeros(len(SHELLS) - 1)
    looks = round(about["measure"] / about["every"])
    for _ in range(looks):
        fluid.in_collisions(fluid.count(about["every"]), 1)
        counts += _pairs(fluid.positions_and_velocities()[0], fluid.scene.box)
    last = fluid.sample
    passed = float(last["time"][0] - first["time"][0])
    virial = sum(float(last[f"J_{k} s_{k}"][0] - first[f"J_{k} s_{k}"][0]) for k in "xyz")
    frequency = 2.0 * (fluid.collisions - begun) / (number * passed)
    return {
        "Z_stress": 1.0 + virial / (passed * dimension * number * T),
        "Z_collisions": 1.0 + frequency * math.sqrt(math.pi / T) / dimension,
        "contact_value": _at_contact(counts / looks, number, packing, dimension),
    }


def _pairs(position, box):
    """Return the numbers of pairs whose distance is in each of the SHELLS.

    A look comes at a collision: the pair that has just collided does not count.
    """
    reach = SHELLS[-1]
    position = position[np.argsort(position[:, 0])]
    number = len(position)
    images = position[position[:, 0] < reach] + np.eye(len(box))[0] * box[0]
    position = np.concatenate([position, images])
    ends = np.searchsorted(position[:, 0], position[:number, 0] + reach)
    others = ends - np.arange(number) - 1
    one = np.repeat(np.arange(number), others)
    other = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(others) - others, others)
    away = position[other] - position[one]
    away[:, 1:] -= np.array(box[1:]) * np.rint(away[:, 1:] / np.array(box[1:]))
    distance = np.sqrt(np.sum(away**2, axis=1))
    return np.histogram(distance[distance > SHELLS[0] + GRAZE], SHELLS)[0]


def _at_contact(counts, number, packing, dimension):
    """Return g at the diameter, of a parabola through its values in the SHELLS."""
    volumes = {2: math.pi, 3: 4.0 * math.pi / 3.0}[dimension] * np.diff(SHELLS**dimension)
    density = float(theory.number_density(packing, dimension))
    g = counts / (0.5 * (number - 1) * density * volumes)
    middle = 0.5 * (SHELLS[1:] + SHELLS[:-1]) - SHELLS[0]
    return float(np.polynomial.polynomial.polyfit(middle, g, 2, w=np.sqrt(volumes))[0])


def noise(about, gas, seed) -> dict[str, float]:
    """Return the cumulant a2 of a smooth gas that white noise drives to T = 1."""
    dimension, r = gas
    frequency = float(theory.collision_frequency(1.0, about["packing"], dimension))
    power = frequency * (1.0 - r**2) / 2.0
    kicks = {"power": power, "spin_share": 0, "interval": 2.0 / (KICKS * frequency)}
    effects = {"thermostat": kicks}
    driven = _started(about, dimension, about["packing"], r, -1.0, effects, seed)
    driven.in_time(about["thermalise"] / frequency, 1)
    found = []
    for _ in range(about["measure"]):
        driven.in_time(1.0 / frequency, 1)
        square = np.sum(driven.positions_and_velocities()[1] ** 2, axis=1)
        moments = np.mean(square**2) / np.mean(square) ** 2
        found.append(dimension / (dimension + 2.0) * moments - 1.0)
    return {"a2": float(unbiased(np.array(found), about["particles"], dimension).mean())}


def tracer(about, gas, seed) -> dict[str, float]:
    """Return T_0/T of a few smooth spheres whose contacts with all others are inelastic.

    All other contacts are elastic; those of two of the few leave a Maxwellian as it is. A particle
    without the momentum of the whole has the energy D/2 T (1 - m/M), M being the mass of all.
    """
    r, mass = gas
    few, number = about["tracers"], about["particles"]
    species = [
        {"name": "elastic", "number": number - few},
        {"name": "tracer", "number": few, "mass": mass},
    ]
    pairs = [{"between": ["elastic", "tracer"], "restitution": r}]
    more = {"species": species, "species_pairs": pairs}
    both = _started(about, 3, about["packing"], 1.0, -1.0, {}, seed, **more)
    both.cool(refresh_every=both.count(1.0))
    both.in_collisions(both.count(1.0), about["thermalise"])
    total = number - few + few * mass
    kept = np.array([1.0 - 1.0 / total, 1.0 - mass / total])
    shares = np.zeros(2)
    for _ in range(about["measure"]):
        both.in_collisions(both.count(1.0), 1)
        velocity = both.positions_and_velocities()[1]
        heavy = both.state.bodies.species == 1
        energies = np.array([np.mean(velocity[~heavy] ** 2), mass * np.mean(velocity[heavy] ** 2)])
        shares += energies / energies[0]
    return {"ratio": float(shares[1] / shares[0] * kept[0] / kept[1])}


def rates(about, gas, seed) -> dict[str, float]:
    """Return -dT_tr/dn and dT_rot/dn over T_tr, n in collisions per particle, of a gas in
    equilibrium as smooth elastic particles, of Maxwellian spins at T_rot = theta T_tr.

    Only a hundredth of a collision per particle is watched, again and again.
    """
    dimension, r, beta, theta = gas
    q = theory.moment_of_inertia(dimension)
    effects = {"spin": {"inertia": q}}
    rough = _started(about, dimension, about["packing"], r, beta, effects, seed)
    rng, number = np.random.default_rng(seed.spawn(1)[0]), about["particles"]
    most, lost, gained = rough.count(BURST), 0.0, 0.0
    spins = 2 * dimension - 3
    for _ in range(about["bursts"]):
        rough.thermalise(RENEWED)
        before = temperature(rough)
        drawn = rng.standard_normal((number, spins))
        drawn *= math.sqrt(theta * before / (q * np.mean(drawn**2)))
        rough.state.spin[:] = drawn
        rough.in_collisions(most, 1)
        after = temperature(rough)
        middle = 0.5 * (before + after)
        lost += (before - after) / middle
        gained += (q * np.mean(rough.spins() ** 2) - theta * before) / middle
    passed = about["bursts"] * 2.0 * most / number
    # of the centre of mass nothing is lost
    return {"loss": lost / passed * (number - 1) / number, "gain": gained / passed}


def clusters(about, gas, seed) -> dict[str, float]:
    """Return -d ln E/d ln t of translation and rotation of rough disks that cool, between two
    numbers of collisions per particle, while clusters grow."""
    r, beta = gas
    effects = {"spin": {"inertia": theory.moment_of_inertia(2)}}
    effects["contact_time"] = {"duration": 1e-4, "below_r": 1}  # against a collapse in clusters
    disks = _started(about, 2, about["packing"], r, beta, effects, seed)
    disks.look()
    begun = float(disks.sample["time"][0])
    leg = disks.count(REFRESHED)
    disks.cool(refresh_every=leg)
    disks.in_collisions(leg, round(about["from"] / REFRESHED))
    early, time = _log_energies(disks), float(disks.sample["time"][0]) - begun
    disks.in_collisions(leg, round((about["to"] - about["from"]) / REFRESHED))
    passed = math.log((float(disks.sample["time"][0]) - begun) / time)
    translation, rotation = (early - _log_energies(disks)) / passed
    return {"translation": float(translation), "rotation": float(rotation)}


def _log_energies(gas) -> np.ndarray:
    """Return the logarithms of E_trans and E_rot at the last sample."""
    energies = restored(gas.energies(gas.sample), gas.sample["exponent"])
    return np.log([float(one[0]) for one in energies[:2]])


def mixtures(about, gas, seed) -> dict[str, float]:
    """Return the same of each species of spheres, half of them of mass and radius 1.

    Energies of pairs are as if the momentum were not fixed, since T is that of D (N - 1).
    """
    r, beta, theta, mass, radius = gas
    number, q = about["particles"], theory.moment_of_inertia(3)
    species = [{"name": "a"}, {"name": "b", "mass": mass, "radius": radius}]
    species = [one | {"number": number // 2} for one in species]
    packing = about["packing"] / (0.5 * (1.0 + radius**3))  # as if all had the radius 1
    effects = {"spin": {"inertia": q}}
    both = _started(about, 3, packing, r, beta, effects, seed, species=species)
    rng, most = np.random.default_rng(seed.spawn(1)[0]), both.count(BURST)
    sums, passed = np.zeros((2, 2)), about["bursts"] * 2.0 * most / number
    for _ in range(about["bursts"]):
        both.thermalise(EQUALISED)
        mass = both.state.bodies.mass
        drawn = rng.standard_normal((number, 3)) * np.sqrt(theta / (q * mass))[:, None]
        velocity = both.positions_and_velocities()[1]
        T = float(np.sum(mass * np.sum(velocity**2, axis=1))) / (3.0 * (number - 1))
        both.state.spin[:] = drawn * math.sqrt(T)
        before = _energies(both, q)
        both.in_collisions(most, 1)
        change = _energies(both, q) - before
        sums += change / (T + 0.25 * change[:, 0].sum())
    (loss_1, gain_1), (loss_2, gain_2) = sums / passed
    return {"loss_1": -loss_1, "loss_2": -loss_2, "gain_1": gain_1, "gain_2": gain_2}


def _energies(gas, q):
    """Return m v^2/3 and q m (a w)^2/3 averaged over each species, (species, 2)."""
    mass, own = gas.state.bodies.mass / 3.0, gas.state.bodies.species
    velocity, spin = gas.positions_and_velocities()[1], gas.spins()
    energies = mass * np.sum(velocity**2, axis=1), q * mass * np.sum(spin**2, axis=1)
    return np.array([[one[own == k].mean() for one in energies] for k in (0, 1)])
