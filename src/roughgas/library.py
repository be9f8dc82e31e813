"""roughgas in a notebook or a script: a scene from keyword arguments, its dataset back.

The names of this module are there as `roughgas.simulate`, `roughgas.trajectory` and
`roughgas.experiments`.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypedDict

from roughgas.base import InputError

if TYPE_CHECKING:
    import xarray

    from roughgas.config import Place

Values = float | Sequence[float]
"""One value of r, of beta or of the seed, or several."""
Side = float | Literal["open"]
"""Length of a box along one axis in a; the last axis may be open above."""
Effects = Mapping[str, Mapping[str, float | str] | None]
"""Parameters of effects by the effects' names; None takes away one that the experiment has."""

Species = Sequence[Mapping[str, Any]]
"""Species, or pairs of them, each a mapping of keys to values."""
Observe = Sequence[str] | Mapping[str, Mapping[str, float] | Callable[[Any], Any] | None]
"""Observables by name, each with settings, with None for the usual ones, or a function of frames
(`roughgas.observables.Frame`)."""


class Stage(TypedDict, total=False):
    """A stage of a schedule; what it changes stays so until another stage changes it again."""

    duration: float  #: T
    measure: bool  #: whether averages are over it, too; true by default
    effects: Effects  #: new values of parameters of effects that are there
    r: float  #: new restitution
    beta: float  #: new roughness
    temperature: float  #: of translation, that velocities are scaled to when it begins
    spin_temperature: float  #: of rotation, that spins are scaled to when it begins


class Schedule(TypedDict, total=False):
    """How long to simulate and what to measure, as `schedule` in config.yaml.

    A driven gas has the kind `steady`, and its lengths in T; one that nothing drives has the kind
    `cooling`, and its lengths in collisions per particle. Any gas may go through `stages`, whose
    lengths are in T.
    """

    kind: Literal["steady", "cooling", "stages"]  #: driven, not driven, or either
    sample_every: float  #: between samples
    equilibrate: float  #: (steady) before the measurement
    measure: float  #: (steady) length of the measurement
    period: float  #: (steady) of the drive; averages are over whole periods
    replicas: int  #: (cooling) independent runs
    thermalise: float  #: (cooling) as smooth elastic particles, at the start
    relaxation_times: float  #: (cooling) e-folds of theory until R is on its plateau
    plateau: float  #: (cooling) length of the plateau
    target_stderr: float  #: standard error of R that the run is prolonged to
    stages: Sequence[Stage]  #: (stages) what the gas goes through, in place of all lengths above


def simulate(
    experiment: str | None = None,
    *,
    r: Values,
    beta: Values,
    seed: Values | None = None,
    particles: int | None = None,
    box: Sequence[Side] | None = None,
    packing: float | None = None,
    layer: Mapping[str, Any] | None = None,
    effects: Effects | None = None,
    species: Species | None = None,
    species_pairs: Species | None = None,
    schedule: Schedule | None = None,
    spin_temperature: float | None = None,
    initial: "xarray.Dataset | None" = None,
    reseed: int | None = None,
    keep_state: bool | None = None,
    observe: Observe | None = None,
    scale: str | None = None,
    config: str | Path | None = None,
    progress: bool = True,
) -> "xarray.Dataset":
    """Simulate one point of an experiment, or several, and measure them.

    The keyword arguments `particles`, `box`, `effects` and `schedule` are the keys of an experiment
    in config.yaml. Beside a name they are merged over its settings, key by key; without a name they
    are the scene, and all of them must be given. The same arguments give the same numbers to the
    last bit (all but `kernel_seconds`), which are also those that `roughgas run` writes.

    Parameters
    ----------
    experiment
        Name of an experiment (see `experiments`), such as ``"vibrated"`` or ``"cooling"``, or of a
        variant, such as ``"STUDY.EXPERIMENT/mu0.3"`` of a study.
    r
        Normal restitution of the particles, in [0, 1]; 1 is elastic. Of r, beta and the seed each
        may be a list: then every r is combined with every beta and seed.
    beta
        Tangential restitution (roughness), in [-1, 1]; -1 is smooth, 1 perfectly rough.
    seed
        Seed of the random generator, from 0 to 2^63 - 1; by default 1, or with `initial` that of
        the run which is gone on from.
    particles
        Number N of particles.
    box
        Lengths of the box in a, two for disks and three for spheres; the last one is vertical, and
        ``"open"`` if there is gravity.
    packing
        Volume fraction of the particles, in place of these lengths. The box keeps its shape, or has
        that of the proportions in `box`, such as ``(1, 1, 1)``; by default it is a square.
    layer
        A shaken layer of spheres by Gamma, f* and its depth in diameters, such as ``{"gamma": 3,
        "f_star": 0.44, "depth": 5.42}``, in place of the amplitude and the period of its floor;
        also ``width``, and ``cycles`` of the schedule (docs/config.md).
    effects
        The effects that act, such as ``{"friction": {"mu": 0.3}}``; None removes one, as in
        ``{"contact_time": None}``. docs/effects.md lists them all.
    species
        Species, if particles are not all alike, such as
        ``[{"fraction": 0.5}, {"fraction": 0.5, "radius": 2}]``; docs/effects.md has all keys.
    species_pairs
        Materials of contacts of two species, such as
        ``[{"between": [0, 1], "restitution": 0.7}]``.
    schedule
        How long to simulate, such as ``{"measure": 200}``; see `Schedule`.
    spin_temperature
        Temperature of the spins at the start, in m a^2/T^2; that of the velocities is 1.
    initial
        Where to begin instead: a point that has kept its state, which is gone on from; or one frame
        of a trajectory, or a dataset with its variables ``position``, ``velocity`` and ``spin``,
        read by the names of their dimensions. Species are matched by name.
    reseed
        Seed of fresh noise for `initial`. Without it an unchanged state goes on with the noise of
        its run; a changed one has noise that follows from the seed and from the state.
    keep_state
        Whether to keep the last state in the dataset, for `initial` of another run.
    observe
        What to watch besides: names of observables, such as ``["profiles", "stress"]``, or names
        with their settings, or with a function that returns a number or an array of a frame
        (`roughgas.observables.Frame`). docs/observables.md lists them.
    scale
        ``"paper"``, ``"quick"`` (the paper's experiments, with errors three times as wide) or
        ``"small"`` (a quarter of the particles, and short); by default the configuration's own
        ``scale``, ``"paper"``.
    config
        Path of a configuration to use instead of the one that comes with roughgas.
    progress
        Whether to show a progress bar, in a notebook or on a terminal; elsewhere a line now and
        then, of what takes more than ten seconds.

    Returns
    -------
    xarray.Dataset
        ``R`` is the share of rotation in the energy, a mean over time, ``R_stderr`` its standard
        error. ``R_collisional`` of a driven gas with the effect ``contact_averages`` is the average
        over collisions that Lun's formula is derived for, unless the gas is sheared.
        ``R_series`` (sample) is what R is the mean of; ``E_trans_series`` and ``E_rot_series`` are
        the energies. Their coordinate is ``time`` (T) or, if the gas cools,
        ``collisions_per_particle``. ``R_replica`` (replica) has the cooling runs one by one. Every
        variable has ``units`` and a ``long_name``; the attributes say how to make it again.
        Of lists, the reduced dataset that the pipeline makes: ``R`` (r, beta) and its error pooled
        over seeds, ``R_seed`` (r, beta, seed).

    Raises
    ------
    roughgas.base.InputError
        For values that are illegal or contradict each other; its text is one line.
    roughgas.base.CollapseError
        If contacts accumulate without end, as in a bed of r = 0.6 without ``contact_time``.
    roughgas.base.SilentError
        If particles are so few that the collisions of a cooling gas do not come.
    OSError
        If `config` cannot be read.

    Examples
    --------
    >>> from roughgas import simulate, theory
    >>> gas = simulate("cooling", r=0.9, beta=0.5, scale="small", progress=False)
    >>> print(f"{gas.R:.2f} +- {gas.R_stderr:.2f}")
    0.45 +- 0.01
    >>> print(f"{theory.cooling_ratio(0.9, 0.5):.2f}")
    0.44

    A changed one, here a small bed on a floor that moves as a sine:

    >>> bed = simulate(
    ...     "vibrated", r=0.9, beta=0, particles=40, box=(12.5, "open"), progress=False,
    ...     effects={"floor": {"wave": "sine"}}, schedule={"equilibrate": 50, "measure": 100},
    ... )
    >>> bed.R_series.dims, bed.R_series.size
    (('sample',), 400)

    To go on from where another run has stopped, to the last bit:

    >>> first = simulate("sheared", r=0.9, beta=0, scale="small", keep_state=True, progress=False)
    >>> more = {"equilibrate": 0, "measure": 100}
    >>> second = simulate(
    ...     "sheared", r=0.9, beta=0, scale="small", initial=first, schedule=more, progress=False
    ... )
    >>> bool(second.measured_from == first.last_time)
    True
    """
    changes: dict[str, Any] = dict(particles=particles, box=box, packing=packing, layer=layer)
    changes |= dict(effects=effects, species=species, species_pairs=species_pairs)
    changes |= dict(schedule=schedule, spin_temperature=spin_temperature, keep_state=keep_state)

    from roughgas.data.point import as_dataset
    from roughgas.results.reduce import reduced_in_memory
    from roughgas.simulation.points import observables_of, points
    from roughgas.simulation.saved import initial_of, seeded

    states = [] if initial is None else initial_of(initial)
    states, seed = seeded(states, seed, reseed)
    at, several = _places(r, beta, seed)
    if several and (keep_state or initial is not None):
        key = "keep_state" if keep_state else "initial"
        raise InputError(key, "given", "come with one r, one beta and one seed")
    changes["observables"], functions = observables_of(observe)
    name, scale, settings = _settings(experiment, changes, scale, config)
    told = ["--from", "start.nc"] if states else []
    outputs = ["point.nc"] * len(at)
    found = points(name, settings, at, scale, outputs, states, functions, told, quiet=not progress)
    return reduced_in_memory(found) if several else as_dataset(next(found))


def trajectory(
    experiment: str | None = None,
    *,
    r: float,
    beta: float,
    seed: int | None = None,
    particles: int | None = None,
    box: Sequence[Side] | None = None,
    packing: float | None = None,
    layer: Mapping[str, Any] | None = None,
    effects: Effects | None = None,
    species: Species | None = None,
    species_pairs: Species | None = None,
    schedule: Schedule | None = None,
    start: float | None = None,
    length: float | None = None,
    frames: int | None = None,
    times: Sequence[float] | None = None,
    initial: "xarray.Dataset | None" = None,
    reseed: int | None = None,
    scale: str | None = None,
    config: str | Path | None = None,
    progress: bool = True,
) -> "xarray.Dataset":
    """Simulate one point of an experiment, and return where its particles are at chosen times.

    It is that of the gas that `simulate` measures with the same arguments, or of its first replica.
    Times are in T, of a cooling gas in collisions per particle.

    Parameters
    ----------
    experiment, r, beta, seed, particles, box, packing, layer
        As for `simulate`.
    effects, species, species_pairs, schedule
        As for `simulate`.
    initial, reseed, scale, config, progress
        As for `simulate`.
    start
        Where the frames begin; by default at `initial`, or when a driven gas should be steady.
    length, frames
        How long they go on, and how many they are; by default as suits the experiment.
    times
        The times themselves, rising, in place of these three.

    Returns
    -------
    xarray.Dataset
        ``position``, ``velocity`` (frame, particle, axis), ``spin`` (frame, particle, spin_axis),
        of disks ``angle`` (frame, particle), ``radius``, ``box``, ``time``, of a sheared gas
        ``image_shift`` (frame), the energies of each frame, and of a mixture ``species_of``,
        ``mass`` and ``inertia`` (particle). The function
        `roughgas.data.trajectory.write_trajectory` makes files of it for other programs.

    Raises
    ------
    roughgas.base.InputError
        For times that do not rise; otherwise as `simulate`.

    Examples
    --------
    >>> from roughgas import trajectory
    >>> gas = trajectory("cooling", r=0.9, beta=0.5, scale="small", times=[0, 5], progress=False)
    >>> gas.position.shape
    (2, 40, 2)
    """
    changes: dict[str, Any] = dict(particles=particles, box=box, packing=packing, layer=layer)
    changes |= dict(effects=effects, species=species, species_pairs=species_pairs)
    changes["schedule"] = schedule
    from roughgas.data.trajectory import as_trajectory
    from roughgas.scene import build
    from roughgas.simulation.points import provenance
    from roughgas.simulation.progress import watched
    from roughgas.simulation.restart import SEED
    from roughgas.simulation.saved import initial_of, seeded
    from roughgas.simulation.trajectory import chosen, snapshots, variables

    states, seed = seeded([] if initial is None else initial_of(initial), seed, reseed)
    ((legal_r, legal_beta, number, labels),), _ = _places(r, beta, seed)
    name, scale, settings = _settings(experiment, changes, scale, config)
    scene = build(settings, legal_r, legal_beta)
    take = chosen(settings, scene, start, length, frames, times, states)
    told = (["--from", "start.nc"] if states else []) + take.options()
    noise = states[0].noise if states else SEED
    about = provenance(name, settings, labels, scale, "bed.xyz", "trajectory", told, noise)
    filmed = snapshots(scene, settings, number, take, states)
    shots = list(watched(name, take.frames, "frames", filmed, quiet=not progress))
    return as_trajectory(variables(scene, settings, shots), about | {"seed": number})


def experiments(config: str | Path | None = None) -> dict[str, str]:
    """Return the experiments that `simulate` knows by name, and what each is.

    `config` and the errors are as for `simulate`.

    Examples
    --------
    >>> from roughgas import experiments
    >>> experiments()["cooling"]
    'A freely cooling gas, started from equilibrium as smooth elastic disks.'
    """
    from roughgas.config import SHIPPED, load

    known = load(config or SHIPPED)["experiments"]
    return {name: settings.get("description", "") for name, settings in known.items()}


def _settings(
    experiment: str | None,
    changes: Mapping[str, Any],
    scale: str | None,
    path: str | Path | None,
) -> tuple[str, str, dict[str, Any]]:
    """Return the name of an experiment, its scale, and its settings with changes.

    A scene without a name has the scale of the paper, others that of their configuration.
    """
    from roughgas.config import PAPER, SHIPPED, usual_scale
    from roughgas.simulation.points import UNNAMED, settings_of

    scale = scale or (PAPER if experiment is None else usual_scale(path or SHIPPED))
    return experiment or UNNAMED, scale, settings_of(experiment, changes, scale, path)


def _places(r: Any, beta: Any, seed: Any) -> "tuple[list[Place], bool]":
    """Return the places of r, of beta and of the seed, and whether any of these is a list."""
    from roughgas.config import places

    several, values = False, []
    for name, given in (("r", r), ("beta", beta), ("seed", seed)):
        if isinstance(given, str) or not hasattr(given, "__len__"):
            values.append([given])
            continue
        several = True
        values.append(list(getattr(given, "tolist", lambda g=given: g)()))
        if not values[-1]:
            raise InputError(name, "[]", "be one value or several")
    return places(*values), several
