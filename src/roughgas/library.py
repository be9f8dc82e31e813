"""roughgas in a notebook or a script: datasets of scenes given by keyword arguments.

The functions of this module are available as `roughgas.simulate`, `roughgas.trajectory`,
`roughgas.read_frame`, `roughgas.open_points`, `roughgas.experiments`, `roughgas.register_effect`
and `roughgas.register_observable`.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypedDict

from roughgas.base import InputError

if TYPE_CHECKING:
    import xarray

    from roughgas.base.labels import GridPoint
    from roughgas.observables import Observable
    from roughgas.simulation.tracker import Tracker

NumberOrNumbers = float | Sequence[float]
"""One value of r, of beta or of the seed, or several."""
Side = float | Literal["open"]
"""Length of a box along one axis in a; the last axis may be open above."""
Effects = Mapping[str, Mapping[str, float | str] | None]
"""Parameters of effects by name; None removes an effect of the experiment."""

Species = Sequence[Mapping[str, Any]]
"""Species, or pairs of them, each a mapping of keys to values."""
ObservableChoice = Mapping[str, float] | Callable[[Any], Any] | None
"""Settings of an observable, a function of frames, or None for the default settings."""
Observe = Sequence[str] | Mapping[str, ObservableChoice]
"""Observables by name, each with settings, None for the default settings, or a function of frames
(`roughgas.observables.Frame`)."""


class Stage(TypedDict, total=False):
    """A stage of a schedule; its changes persist until a later stage changes them.

    Times are in the time unit T, temperatures in m a^2/T^2.
    """

    duration: float  #: T
    sample_every: float  #: interval of its samples in T, in place of the schedule's
    sample_at: Sequence[float]  #: instants of its samples instead, in T since it begins
    samples_per_decade: int  #: samples per decade of time instead, from `first_sample` on
    first_sample: float  #: first instant of these, in T since it begins
    sample_start: bool  #: whether the begin of the stage is sampled, too
    measure: bool  #: whether averages include it; true by default
    effects: Effects  #: new values of parameters of the scene's effects
    r: float  #: new restitution
    beta: float  #: new roughness
    temperature: float  #: of translation; velocities are scaled to it when the stage begins
    spin_temperature: float  #: of rotation; spins are scaled to it, or drawn if all are 0


class Schedule(TypedDict, total=False):
    """Schedule of a run, as `schedule` in config.yaml.

    A driven gas has the kind `steady`, with lengths in T; a gas without drive has the kind
    `cooling`, with lengths in collisions per particle. Any gas may go through `stages`, with
    lengths in T.
    """

    kind: Literal["steady", "cooling", "stages"]  #: driven, not driven, or either
    sample_every: float  #: interval of samples
    equilibrate: float  #: (steady) before the measurement
    measure: float  #: (steady) length of the measurement
    period: float  #: (steady) of the drive; averages are over whole periods
    replicas: int  #: (cooling) independent runs
    thermalise: float  #: (cooling) as smooth elastic particles, at the start
    relaxation_times: float  #: e-folds of theory until R is on its plateau
    plateau: float  #: (cooling) length of the plateau
    target_stderr: float  #: the run is prolonged until R has this standard error
    stages: Sequence[Stage]  #: (stages) the stages of the gas, in place of all lengths above


def simulate(
    experiment: str | None = None,
    *,
    r: NumberOrNumbers,
    beta: NumberOrNumbers,
    seed: NumberOrNumbers | None = None,
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
    trackers: "Sequence[Tracker]" = (),
    checkpoint: str | Path | None = None,
    progress: bool = True,
) -> "xarray.Dataset":
    """Simulate one point of an experiment, or several, and measure them.

    The keyword arguments `particles`, `box`, `effects` and `schedule` are the keys of an experiment
    in config.yaml. With a name they are merged over its settings, key by key; without a name they
    define the scene, and all of them are required. The same arguments give the same numbers to the
    last bit (except `kernel_seconds`), as `roughgas run` does. Units are the radius a and the mass
    m of a particle and the time unit T.

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
        Seed of the random generator, from 0 to 2^63 - 1; by default 1, or with `initial` the seed
        of the run that is continued.
    particles
        Number N of particles.
    box
        Lengths of the box in particle radii a, two for disks and three for spheres; the last one is
        vertical, and ``"open"`` above a floor without a lid.
    packing
        Volume fraction of the particles, in place of these lengths. The box keeps its shape, or has
        the proportions in `box`, such as ``(1, 1, 1)``; by default it is a square.
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
        Temperature of the spins at the start, in m a^2/T^2; the velocities have temperature 1.
    initial
        State to begin with: a point with `keep_state`, which is continued; a frame of a trajectory,
        or of a file of another program (`read_frame`); or a dataset with the variables
        ``position``, ``velocity`` and ``spin``, read by the names of their dimensions. Species are
        matched by name.
    reseed
        Seed of new noise for `initial`. By default an unchanged state continues the noise of its
        run; the noise for a changed state follows from the seed and from the state.
    keep_state
        Whether to keep the last state in the dataset, for `initial` of another run.
    observe
        Further measurements: names of observables, such as ``["profiles", "stress"]``, or names
        with their settings, or with a function that returns a number or an array for a frame
        (`roughgas.observables.Frame`). docs/observables.md lists them.
    scale
        ``"paper"``, ``"lean"`` (with shorter waits), ``"quick"`` (the paper's experiments, with
        errors three times as wide) or ``"small"`` (a quarter of the particles, and short); by
        default the configuration's own ``scale``, ``"paper"``.
    config
        Path of a configuration to use instead of the packaged one.
    trackers
        Objects that watch the run (`roughgas.gas.Tracker`), one point after another.
    checkpoint
        Path of a file with the state of a long run: after an interruption the same call resumes
        from it, to the last bit, and removes it at the end. Only for a single r, beta and seed.
    progress
        Whether to show a progress bar, in a notebook or on a terminal; elsewhere occasional lines,
        if the run takes more than ten seconds.

    Returns
    -------
    xarray.Dataset
        ``R`` is the share of rotation in the energy, E_rot/(E_rot + E_trans) with the energies per
        degree of freedom, a mean over time, ``R_stderr`` its standard error. ``R_collisional`` of
        a driven gas with the effect ``contact_averages`` is the average over collisions that Lun's
        formula is derived for, unless the gas is sheared.
        R is the mean of ``R_series`` (sample); ``E_trans_series`` and ``E_rot_series`` are the
        energies in m a^2/T^2, of a cooling gas in units of the initial E_trans. Their coordinate
        is ``time`` (T) or, if the gas cools, ``collisions_per_particle``. ``R_replica`` (replica)
        has R of each cooling run. Every variable has ``units`` and a ``long_name``; the attributes
        hold a command to reproduce it.
        For lists of r, beta or the seed, the reduced dataset of the pipeline: ``R`` (r, beta) and
        its error pooled over seeds, ``R_seed`` (r, beta, seed).

    Raises
    ------
    roughgas.base.InputError
        For values that are illegal or contradict each other; its text is one line.
    roughgas.base.CollapseError
        If contacts accumulate without end, as in a bed of r = 0.6 without ``contact_time``.
    roughgas.base.SilentError
        If a cooling gas has too few particles for the requested collisions to occur.
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

    A modified experiment, here a small bed on a floor that moves as a sine:

    >>> bed = simulate(
    ...     "vibrated", r=0.9, beta=0, particles=40, box=(12.5, "open"), progress=False,
    ...     effects={"floor": {"wave": "sine"}}, schedule={"equilibrate": 50, "measure": 100},
    ... )
    >>> bed.R_series.dims, bed.R_series.size
    (('sample',), 400)

    To continue another run from its end, to the last bit:

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

    from roughgas.config import experiment_of, study_code
    from roughgas.data.point import as_dataset
    from roughgas.results.reduce import reduced_in_memory
    from roughgas.simulation.run_points import simulate_points
    from roughgas.simulation.saved_states import initial_states_of, with_noise_source

    states = [] if initial is None else initial_states_of(initial)
    states, seed = with_noise_source(states, seed, reseed)
    points_of_grid, is_sweep = _grid_of(r, beta, seed)
    single_point_only = {
        "keep_state": keep_state or None,
        "initial": initial,
        "checkpoint": checkpoint,
    }
    if is_sweep and (
        key := next((name for name, value in single_point_only.items() if value is not None), "")
    ):
        raise InputError(key, "given", "come with one r, one beta and one seed")
    observables = _by_name(observe)
    functions = {key: chosen for key, chosen in observables.items() if callable(chosen)}
    if observe is not None:
        named = {key: chosen for key, chosen in observables.items() if not callable(chosen)}
        changes["observables"] = {key: dict(chosen or {}) for key, chosen in named.items()}
    name, scale, settings = experiment_of(experiment, changes, scale, config)
    command_options = study_code.options(settings.effects, settings.observables)
    command_options += ["--from", "start.nc"] if states else []
    outputs = ["point.nc"] * len(points_of_grid)
    results = simulate_points(
        name,
        settings,
        points_of_grid,
        scale,
        outputs,
        initial=states,
        functions=functions,
        extra_arguments=command_options,
        quiet=not progress,
        checkpoints=[] if checkpoint is None else [str(checkpoint)],
        trackers=trackers,
    )
    if is_sweep:
        return reduced_in_memory(results)
    (point,) = results
    return as_dataset(point)


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
    checkpoint: str | Path | None = None,
    progress: bool = True,
) -> "xarray.Dataset":
    """Simulate one point of an experiment, and return the particles at chosen times.

    The gas is the same as in `simulate` with the same arguments, or its first replica. Times are in
    the time unit T, or in collisions per particle for a cooling gas.

    Parameters
    ----------
    experiment, r, beta, seed, particles, box, packing, layer
        As for `simulate`.
    effects, species, species_pairs, schedule
        As for `simulate`.
    initial, reseed, scale, config, checkpoint, progress
        As for `simulate`.
    start
        Time of the first frame; by default of `initial`, or when a driven gas should be steady.
    length, frames
        Duration and number of the frames; the defaults depend on the experiment.
    times
        The times of all frames, rising, in place of these three.

    Returns
    -------
    xarray.Dataset
        ``position``, ``velocity`` (frame, particle, axis), ``spin`` (frame, particle, spin_axis),
        of disks ``angle`` (frame, particle), ``radius`` (particle), ``box`` (axis), ``time``
        (frame), of a sheared gas ``image_shift`` (frame), the energies of each frame, and of a
        mixture ``species_of``, ``mass`` and ``inertia`` (particle). Lengths are in particle radii
        a, velocities and spins (a w, the velocity of the surface) in a/T. The function
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
    from roughgas.config import experiment_of, study_code
    from roughgas.data.trajectory import as_trajectory
    from roughgas.scene import build
    from roughgas.simulation.films import film
    from roughgas.simulation.initial_states import SEED
    from roughgas.simulation.progress import print_line, with_progress_bar
    from roughgas.simulation.run_points import provenance
    from roughgas.simulation.saved_states import initial_states_of, with_noise_source
    from roughgas.simulation.trajectory import requested_take as chosen_frames
    from roughgas.simulation.trajectory import trajectory_variables

    states, seed = with_noise_source(
        [] if initial is None else initial_states_of(initial), seed, reseed
    )
    (grid_point,), _ = _grid_of(r, beta, seed)
    name, scale, settings = experiment_of(experiment, changes, scale, config)
    scene = build(settings, grid_point.r, grid_point.beta)
    take = chosen_frames(settings, scene, start, length, frames, times, states)
    command_options = study_code.options(settings.effects, settings.observables)
    command_options += (["--from", "start.nc"] if states else []) + take.options()
    noise = states[0].noise if states else SEED
    attributes = provenance(
        name, settings, grid_point.labels, scale, "bed.xyz", "trajectory", command_options, noise
    )
    with film(scene, settings, grid_point, take, states, checkpoint, print_line) as filmed:
        shots = list(with_progress_bar(name, take.frames, "frames", filmed, quiet=not progress))
    return as_trajectory(
        trajectory_variables(scene, settings, shots), attributes | {"seed": grid_point.seed}
    )


def read_frame(
    path: str | Path,
    frame: int = -1,
    *,
    unit_length: float | None = None,
    unit_mass: float | None = None,
    unit_time: float = 1.0,
) -> "xarray.Dataset":
    """Return a frame of a file of another program, for `initial` of `simulate` and `trajectory`.

    The file is a data file of LAMMPS in atom_style sphere, a text file of its command dump, an
    extended XYZ file, or a GSD file (which needs roughgas[trajectories]).

    Parameters
    ----------
    path
        Path of the file; its content tells the format.
    frame
        Number of the frame, from 0, or from the end if negative; by default the last.
    unit_length
        The radius a in units of the file; by default the radius of its first species.
    unit_mass
        The mass m in units of the file; by default the mass of its first species.
    unit_time
        The time T in units of the file.

    Returns
    -------
    xarray.Dataset
        ``position``, ``velocity`` (particle, axis), ``spin`` (particle, spin_axis), ``radius`` and
        ``mass`` (particle), and in a mixture ``species_of`` (particle), as far as the file has
        them, in the units of the gas; ``box`` (axis) from the corner at 0. Spins are velocities of
        the surface, radius times angular velocity. Particles that stay in a plane of constant z
        are disks. A run that begins so checks sides of the box, radii, masses and species against
        its settings.

    Raises
    ------
    roughgas.base.InputError
        For content that is illegal or cut off, a tilted box, a missing frame or column; its text is
        one line with the file, the line and the column.
    OSError
        For a file that cannot be read.
    """
    from roughgas.data import other_programs

    units = other_programs.Units(unit_length, unit_mass, unit_time)
    return other_programs.read_frame(path, frame, units)


def open_points(points: str | Path | Iterable[str | Path]) -> "xarray.Dataset":
    """Open the points of one experiment as one dataset, each number over r, beta and the seed.

    Unlike in xarray, points may be missing, series may differ in length, and files may be of an
    older roughgas.

    Parameters
    ----------
    points
        A pattern like a shell's, such as ``"results/paper/cooling/r*/beta*/seed*.nc"``, where
        ``**`` stands for any folders; or paths of files.

    Returns
    -------
    xarray.Dataset
        Every variable of the points has the further dimensions ``r``, ``beta`` and ``seed``, in
        rising order; the third axis of an experiment, if it has one, comes first. Missing points,
        also of integers, and the ends of shorter series are NaN. A coordinate that all points
        share, up to its length, keeps its dimensions.
        Attributes are common to all points, and do not include their coordinates. With dask
        installed, arrays of a point are read when they are computed; else all is in memory.
        Left out are text that is no coordinate, integers along a dimension of varying length, and
        variables along a dimension whose coordinate differs among points.

    Raises
    ------
    roughgas.base.InputError
        Without such files, for a file that is no point or is damaged, for points of several
        experiments, scales or swept parameters, and for the same point twice.
    OSError
        For a file that cannot be read.
    """
    from roughgas.results import open_points as opening

    return opening.open_points(points)


def experiments(config: str | Path | None = None) -> dict[str, str]:
    """Return the descriptions of the experiments that `simulate` takes, by name.

    `config` and the errors are as for `simulate`.

    Examples
    --------
    >>> from roughgas import experiments
    >>> experiments()["cooling"]
    'A freely cooling gas, started from equilibrium as smooth elastic disks.'
    """
    from roughgas.config import SHIPPED, load

    configured = load(config or SHIPPED).experiments
    return {name: settings.get("description", "") for name, settings in configured.items()}


def register_effect(name: str, kind: type, before: str | None = None) -> None:
    """Register an effect that a file of yours defines, by its name among `effects`.

    It is then equivalent to the effects of docs/effects.md: its settings are checked, and messages
    list it. The cache of kernels depends on the sources of their effects: after an edit of the file
    the kernel is compiled anew, while scenes without the effect keep their kernels.

    Parameters
    ----------
    name
        Lower-case letters, digits and _; unique among effects, unless the same file, imported
        again, has registered it before.
    kind
        Its class, a NamedTuple registered with its settings and hooks by
        `roughgas.effects.settings.register`, in a file that is imported.
    before
        Name of the effect that it acts before, if several change the same value; by default it acts
        after all others. Effects that only observe come last.

    Raises
    ------
    roughgas.base.InputError
        For a name that is taken, a class without settings or hooks, and hooks that are not open.
    """
    from roughgas import effects

    effects.register_effect(name, kind, before)


def register_observable(name: str, kind: "type[Observable]") -> None:
    """Register an observable that a file of yours defines, by its name in `observe`.

    Parameters
    ----------
    name
        Lower-case letters, digits and _; unique among observables, unless the same file, imported
        again, has registered it before.
    kind
        Its class, derived from `roughgas.observables.Observable`, every setting with a default.

    Raises
    ------
    roughgas.base.InputError
        For a name that is taken, another class, a setting without default, effects that require
        settings, and variables that points already have.
    """
    from roughgas import observables

    observables.register_observable(name, kind)


def _by_name(observe: Observe | str | None) -> Mapping[str, ObservableChoice]:
    """Return the observables in `observe` by name, each with its settings or a function.

    None stands for the default settings.
    """
    if isinstance(observe, str):
        return {observe: None}
    return observe if isinstance(observe, Mapping) else dict.fromkeys(observe or ())


def _grid_of(r: Any, beta: Any, seed: Any) -> "tuple[list[GridPoint], bool]":
    """Return the points of all combinations of r, beta and seed, and whether any is a list.

    Each argument is a number, its text, or a list of these. Raises InputError for an empty list and
    for illegal values.
    """
    from roughgas.base.labels import grid_points

    is_list, values = False, []
    for name, argument in (("r", r), ("beta", beta), ("seed", seed)):
        if isinstance(argument, str) or not hasattr(argument, "__len__"):
            values.append([argument])
            continue
        is_list = True
        values.append(list(getattr(argument, "tolist", lambda g=argument: g)()))
        if not values[-1]:
            raise InputError(name, "[]", "be one value or several")
    return grid_points(*values), is_list
