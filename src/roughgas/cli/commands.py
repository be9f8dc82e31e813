"""The commands of `roughgas`: the parameters of each function are the arguments of its command, and
its docstring is the help. Slow imports are inside the functions."""

import shlex
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

from roughgas.base import InputError
from roughgas.cli import completers
from roughgas.cli.parser import Command, Function, Option
from roughgas.cli.values import number

CONFIG_DEFAULT: Any = None
"""Default of the options `config` and `scale`: `roughgas.cli` replaces it by the configuration in
use, and by its scale."""
SCALE_HELP = "a scale of the configuration: small, ... (default: its own)"
Scale = Annotated[str, Option(SCALE_HELP, completer=completers.scales)]
Configuration = Annotated[
    str | Path, Option("the configuration (default: config.yaml here, or roughgas's own)", "FILE")
]
Settings = Annotated[str | None, Option("the settings, in place of --config", "JSON")]
STUDIES_HELP = "folders of studies whose effects and observables --settings name"
Studies = Annotated[Sequence[str], Option(STUDIES_HELP, "FOLDER")]
NAME_HELP = "its name in the configuration, or that of a variant: EXPERIMENT/VARIANT"
Name = Annotated[str, Option(NAME_HELP, "EXPERIMENT", completer=completers.experiments)]
PATTERN_HELP = "a pattern of the shell's, in quotes, that names match"
Pattern = Annotated[str, Option(PATTERN_HELP, "PATTERN", completer=completers.experiments)]
RESTITUTION_HELP = "normal restitution, in [0, 1]: 1 is elastic"
ROUGHNESS_HELP = "roughness, in [-1, 1]: -1 is smooth, 1 perfectly rough"
RANGE_HELP = "a list, or START:STOP:STEP"
Restitutions = Annotated[list[str], Option(f"{RESTITUTION_HELP}; {RANGE_HELP}", "VALUE")]
Roughnesses = Annotated[list[str], Option(f"{ROUGHNESS_HELP}; {RANGE_HELP}", "VALUE")]
SEEDS_HELP = f"seeds of the random generator: 0, 1, ...; {RANGE_HELP} (default: 1)"
Seeds = Annotated[list[str] | None, Option(SEEDS_HELP, "SEED")]
CHANGES_HELP = (
    "change settings: particles=80, schedule.measure=100, effects.friction.mu=0.3; null removes"
)
Changes = Annotated[Sequence[str], Option(CHANGES_HELP, "KEY=VALUE", "--set")]
START_FROM_HELP = (
    "continue from the last state of this dataset, or begin as in a file of another program: "
    "LAMMPS data or dump, extended XYZ, GSD"
)
StartFrom = Annotated[str | None, Option(START_FROM_HELP, "FILE", "--from")]
FRAME_HELP = "frame of such a file, from 0, or from its end: -1, ... (default: the last)"
FrameNumber = Annotated[str | None, Option(FRAME_HELP, "NUMBER")]
UNIT_HELP = "{} in units of such a file (default: {})"
UnitLength = Annotated[
    str | None, Option(UNIT_HELP.format("a", "the radius of its first species"), "LENGTH")
]
UnitMass = Annotated[
    str | None, Option(UNIT_HELP.format("m", "the mass of its first species"), "MASS")
]
UnitTime = Annotated[str | None, Option(UNIT_HELP.format("T", "1"), "TIME")]
RESEED_OPTION = Option("fresh noise for the state of --from, in place of --seed", "SEED")
StartTime = Annotated[str | None, Option("time of the first frame (default: when steady)", "TIME")]
Duration = Annotated[str | None, Option("time shown (default: by experiment)", "TIME")]
FrameCount = Annotated[str | None, Option("number of frames (default: 125 or 160)", "NUMBER")]
JsonFlag = Annotated[bool, Option("print JSON, for scripts")]
COMMANDS: dict[str, Command] = {}


def command(
    *examples: str, exclusive: Sequence[str] = (), writes: str = ""
) -> Callable[[Function], Function]:
    """Return a decorator that registers a function as the command of its name (see Command).

    `examples` are command lines for its help; the parameters named in `exclusive` exclude each
    other; `writes` is the type of its output files.
    """

    def add(function: Function) -> Function:
        COMMANDS[function.__name__] = Command(function, examples, exclusive, writes)
        return function

    return add


@command(
    "roughgas run cooling --r 0.9 --beta -0.5",
    "roughgas run cooling --r 0.9 --beta 0 .5 1 --seed 1 2 3 --scale small",
    "roughgas run vibrated --r 0.9 --beta 0 --set particles=80 effects.friction.mu=0.3",
    "roughgas run vibrated --r 0.87 --beta 0.5 --seed 1 2 3 --scale small --json",
    "roughgas run vibrated --set effects.spin.inertia=0.3 --r 0.9 --beta 1 -o hollow.nc",
    "roughgas run sheared --r 0.9 --beta 0 --keep-state -o first.nc",
    "roughgas run sheared --r 0.9 --beta 0 --from first.nc -o second.nc",
    "roughgas run sheared --r 0.9 --beta 0 --from gas.lammpstrj --frame 20 -o gas.nc",
    "roughgas run sheared --r 0.9 --beta 0 --observe stress profiles -o stress.nc",
    writes="POINT",
)
def run(
    experiment: Name,
    *,
    scale: Scale = CONFIG_DEFAULT,
    config: Configuration = CONFIG_DEFAULT,
    settings: Settings = None,
    studies: Studies = (),
    r: Restitutions,
    beta: Roughnesses,
    seed: Seeds = None,
    changes: Changes = (),
    start_from: StartFrom = None,
    frame: FrameNumber = None,
    unit_length: UnitLength = None,
    unit_mass: UnitMass = None,
    unit_time: UnitTime = None,
    reseed: Annotated[list[str] | None, RESEED_OPTION] = None,
    keep_state: Annotated[bool, Option("keep the last state in the dataset, for --from")] = False,
    observe: Annotated[
        Sequence[str], Option("observables, such as stress or profiles", "NAME")
    ] = (),
    output: Annotated[list[str] | None, Option("datasets, one per point", "FILE")] = None,
    json: Annotated[bool, Option("print a line of JSON per seed")] = False,
) -> None:
    """Simulate a point, and write its dataset.

    Simulate a point of an experiment, or each r with each beta and each seed in turn, and write a
    dataset for each. Without -o the dataset goes into the present folder, under a name made from
    the point's, and its summary is printed, as by `roughgas show`. --set changes any setting of the
    experiment, by its key in config.yaml.
    """
    from roughgas.cli.run import Selection, Start, write_points

    points = experiment, scale, config, settings, r, beta, seed
    selection = Selection(*points, changes, observe, keep_state, studies)
    start = Start(start_from, frame, unit_length, unit_mass, unit_time)
    write_points(selection, start, reseed, output, json)


@command(
    "roughgas movie vibrated --r 0.9 --beta 0.5 -o bed.mp4 bed.gif",
    "roughgas movie vibrated --r 0.9 --beta -1 0 1 --length 10 -o roughness.mp4",
)
def movie(
    experiment: Name,
    *,
    scale: Scale = CONFIG_DEFAULT,
    config: Configuration = CONFIG_DEFAULT,
    settings: Settings = None,
    studies: Studies = (),
    r: Restitutions,
    beta: Roughnesses,
    seed: Seeds = None,
    changes: Changes = (),
    start: StartTime = None,
    length: Duration = None,
    frames: FrameCount = None,
    fps: Annotated[str, Option("frames a second", "RATE")] = "25",
    colour: Annotated[
        Literal["spin", "species", "height"],
        Option(
            "meaning of colour: spin, species of a mixture, or height of spheres, seen from above"
        ),
    ] = "spin",
    output: Annotated[list[str], Option(".mp4 or .gif files", "FILE")],
) -> None:
    """Show a point as it moves.

    Simulate a point of an experiment, and draw its particles as they move and spin, its boundaries,
    and R(t); several r, beta and seeds are shown side by side. The trajectory is that of
    `roughgas run` with the same seed. Times are in T; for a cooling gas, in collisions per
    particle.
    """
    from roughgas.cli.excerpts import Excerpt, write_movies
    from roughgas.cli.run import Selection

    points = experiment, scale, config, settings, r, beta, seed
    selection = Selection(*points, changes, studies=studies)
    write_movies(selection, Excerpt(start, length, frames), fps, colour, output)


@command(
    "roughgas trajectory vibrated --r 0.9 --beta 0.5 -o bed.xyz",
    "roughgas trajectory sheared --r 0.9 --beta 0 --times 100 200 300 -o sheared.nc",
    "roughgas trajectory cooling --r 0.9 --beta -0.5 --length 50 --frames 11 -o gas.gsd",
)
def trajectory(
    experiment: Name,
    *,
    scale: Scale = CONFIG_DEFAULT,
    config: Configuration = CONFIG_DEFAULT,
    settings: Settings = None,
    studies: Studies = (),
    r: Annotated[str, Option(RESTITUTION_HELP)],
    beta: Annotated[str, Option(ROUGHNESS_HELP)],
    seed: Annotated[str | None, Option("seed of the random generator (default: 1)")] = None,
    changes: Changes = (),
    start: StartTime = None,
    length: Duration = None,
    frames: FrameCount = None,
    times: Annotated[
        list[str] | None, Option("increasing times of frames, in place of these three", "TIME")
    ] = None,
    start_from: StartFrom = None,
    frame: FrameNumber = None,
    unit_length: UnitLength = None,
    unit_mass: UnitMass = None,
    unit_time: UnitTime = None,
    reseed: Annotated[str | None, RESEED_OPTION] = None,
    double: Annotated[
        bool, Option("numbers of .gsd files in double precision (needs gsd 5 or newer)")
    ] = False,
    output: Annotated[list[str], Option(".xyz, .nc or .gsd files", "FILE")],
) -> None:
    """Write the trajectories of all particles, for OVITO, ASE, freud ...

    Simulate a point of an experiment, and write positions, velocities, spins and angles of all
    particles, as `roughgas movie` would show them: as extended XYZ, as netCDF by the conventions of
    AMBER, or as GSD (which needs roughgas[trajectories]). Times are in T; for a cooling gas, in
    collisions per particle.
    """
    from roughgas.cli.excerpts import Excerpt, write_trajectory
    from roughgas.cli.run import Selection, Start

    points = experiment, scale, config, settings, r, beta, seed
    selection = Selection(*points, changes, studies=studies)
    excerpt = Excerpt(start, length, frames, times)
    first = Start(start_from, frame, unit_length, unit_mass, unit_time)
    write_trajectory(selection, excerpt, first, reseed, double, output)


@command(
    "roughgas show results/paper/vibrated/r0.9/beta0.5/seed1.nc",
    "roughgas show results/paper/vibrated.nc",
    "roughgas show results/paper/accuracy.nc",
    "roughgas show results/paper/sheared.nc --json",
    "roughgas show results/paper/sheared.nc --of E_trans vertical_share",
)
def show(
    files: Annotated[list[str], Option("datasets", "FILE")],
    *,
    of: Annotated[
        Sequence[str], Option("variables of a reduced dataset, in place of R", "NAME")
    ] = (),
    json: Annotated[
        bool, Option("print attributes and single numbers, a line of JSON for each file")
    ] = False,
) -> None:
    """Summarise any dataset of the pipeline.

    Print what a dataset holds: what was simulated, R with its error, theory, energies, cost, and
    how to make it again. It may be a point, a reduced dataset, a dataset of studies or a task of
    one. 0.3565(30) is 0.3565 with a standard error of 0.0030. --of prints any variables of reduced
    datasets over the sweep, such as the results of observables.
    """
    from roughgas.cli.show import print_summaries

    print_summaries(files, json, of)


@command(
    "roughgas plot cooling_r0.9_beta0.5_seed1.nc -o over_time.png",
    "roughgas plot stress.nc --of temperature_profile -o profile.png",
    "roughgas plot results/paper/sheared.nc -o my.png",
    "roughgas plot results/paper/sheared.nc --beta 0 1 --over r -o my.png my.pdf",
    "roughgas plot results/paper/vibrated.nc --over beta --r 0.9 -o bed.png",
    "roughgas plot results/paper/vibrated.nc --of E_trans vertical_share -o energies.png",
)
def plot(
    input: Annotated[str, Option("a point, or a reduced dataset", "DATASET")],
    *,
    of: Annotated[
        Sequence[str],
        Option(
            "variables to draw, of a point one (default: R and, of a sweep, the observed)", "NAME"
        ),
    ] = (),
    over: Annotated[
        str | None, Option("horizontal axis: r, beta, or the third axis (the default)", "AXIS")
    ] = None,
    r: Annotated[Sequence[str], Option("values of r to show", "VALUE")] = (),
    beta: Annotated[Sequence[str], Option("values of beta to show", "VALUE")] = (),
    theory: Annotated[
        str | None, Option("a study's folder, whose theory.py has lines of a sweep", "FOLDER")
    ] = None,
    output: Annotated[list[str], Option(".png, .pdf or .svg files", "FILE")],
) -> None:
    """Draw a point over time, or any reduced dataset beside theory.

    Draw R of a sweep with error bars and theory, and R minus theory. The horizontal axis is the
    third axis of the sweep, else beta. Of many series an evenly spaced selection is drawn; --r and
    --beta choose. Without spin, the energy is drawn. Of a point, R(t) and both energies: the window
    in which R is measured is shaded, its mean, its 95 % interval and theory are lines. --of draws a
    variable of an observable instead, such as g(r), with its error, a line for each species. Of a
    sweep --of draws any variables with error bars, a row for each: over the axis, or, of a variable
    such as a profile, along its coordinate. Without --of, R and the results of observables.
    """
    from roughgas.claims.variables import theories_of
    from roughgas.show import gallery

    chosen = {"r": [number("--r", text) for text in r]}
    chosen["beta"] = [number("--beta", text) for text in beta]
    lines = partial(theories_of, theory) if theory else None
    for line in gallery.plot(input, output, over, of, lines, **chosen):
        print(line, file=sys.stderr)


@command("roughgas reduce results/paper/sheared/r*/beta*/seed*.nc -o sheared.nc", writes="REDUCED")
def reduce(
    inputs: Annotated[
        list[str],
        Option(
            "datasets, or folders of them; - reads their names from standard input, one per line",
            "POINT",
        ),
    ],
    *,
    output: Annotated[str, Option("reduced dataset", "FILE")],
    put_aside: Annotated[
        bool, Option("rename a damaged point to POINT.damaged: a workflow makes it anew")
    ] = False,
) -> None:
    """Combine the points of an experiment into a dataset.

    Combine points of one experiment, at any r and beta, of any seeds, into a dataset that
    `roughgas show` and `roughgas plot` take: R with its error, beside theory.
    """
    from roughgas.results.reduce import reduce_points

    paths = sys.stdin.read().splitlines() if inputs == ["-"] else inputs
    reduce_points(paths, output, put_aside)


@command(
    "roughgas experiments",
    "roughgas experiments 'friction.*' --scale small",
    "roughgas experiments '*shaken*'",
)
def experiments(
    pattern: Pattern = "*",
    *,
    scale: Scale = CONFIG_DEFAULT,
    config: Configuration = CONFIG_DEFAULT,
    json: JsonFlag = False,
) -> None:
    """List the experiments of the configuration.

    Print the name, the description and the sweep of each experiment at a scale. `roughgas run`
    takes these names, as do results/SCALE/NAME.nc and figures/NAME.png.
    """
    from roughgas.cli.experiments import print_experiments

    print_experiments(pattern, scale, config, json)


@command(
    "roughgas theory --r 0.9 --beta 0.5",
    "roughgas theory --r 0.9 --beta -1:1:0.1 --dimension 2",
    "roughgas theory --r 0.8 0.9 0.99 --beta 0 --inertia 0.1 --json",
    "roughgas theory --r 0.9 --beta 0.5 --mu 0.3",
    "roughgas theory --r 0.9 --beta -0.9:0.9:0.1 --spin-share 0.2 --csv",
    "roughgas theory --r 0.9 --beta 0 --dimension 2 --species"
    " '[{fraction: 0.5}, {fraction: 0.5, radius: 2, mass: 4}]'",
    exclusive=("json", "csv"),
)
def theory(
    *,
    r: Annotated[list[str], Option(RESTITUTION_HELP, "VALUE")],
    beta: Annotated[list[str], Option(ROUGHNESS_HELP, "VALUE")],
    dimension: Annotated[
        Literal["2", "3"] | None, Option("of disks or of spheres (default: both)")
    ] = None,
    inertia: Annotated[
        str | None,
        Option("moment of inertia in m a^2 (default: 0.5 for disks, 0.4 for spheres)", "Q"),
    ] = None,
    spin_share: Annotated[
        str, Option("share of the drive's power that goes into rotation", "S")
    ] = "0",
    mu: Annotated[
        str | None, Option("Coulomb friction (default: none, contacts never slide)")
    ] = None,
    species: Annotated[
        str | None,
        Option(
            "a mixture: a list of species as in config.yaml, or a file with such a list", "YAML"
        ),
    ] = None,
    packing: Annotated[str, Option("share of the box that a mixture fills")] = "0",
    json: JsonFlag = False,
    csv: Annotated[bool, Option("print CSV, for spreadsheets")] = False,
) -> None:
    """Print R of theory, at a point or along a curve.

    Print R = E_rot/(E_rot + E_trans) of theory, driven and freely cooling, how fast it is reached,
    and how fast energy decays, with the equation behind each number. r and beta take several
    values, or a range START:STOP:STEP with both ends. Of a mixture, R and the translational
    temperature of each species, over its mean; it is driven as by the effect thermostat.
    """
    from roughgas.cli.theory import gases, print_tables

    print_tables(gases(r, beta, dimension, inertia, spin_share, mu, species, packing), json, csv)


@command("roughgas init gases")
def init(folder: Annotated[str, Option("a folder that is new or empty", "FOLDER")]) -> None:
    """Write a project to start from.

    Write a Snakefile that uses the workflow of this installation, a config.yaml with changes to its
    configuration, and a study, studies/mine, to a new folder: `snakemake -j2 mine` in it simulates
    the study.
    """
    from roughgas.cli.project import write_project

    write_project(folder)
    print(f"{folder}: a project. Next:  cd {shlex.quote(folder)} && snakemake -j2 mine")


@command(
    "roughgas crate results/paper/*.nc results/paper/R.csv figures/fig*.png -o run.zip",
    writes="a crate",
)
def crate(
    files: Annotated[list[str], Option("results and figures", "FILE")],
    *,
    output: Annotated[str, Option(".zip file", "CRATE")],
    config: Configuration = CONFIG_DEFAULT,
    configuration: Annotated[
        str | None, Option("the configuration, in place of --config", "JSON")
    ] = None,
) -> None:
    """Pack a finished run as an RO-Crate.

    Pack results of a run in this folder, with its configuration and code, as an RO-Crate.
    """
    from roughgas.config import load
    from roughgas.results.crate import write_crate

    if not output.endswith(".zip"):
        raise InputError("--output", output, "end in .zip")
    write_crate(files, output, load(config).text if configuration is None else configuration)


@command("roughgas doctor")
def doctor(
    *, json: Annotated[bool, Option("print JSON, for scripts or for asking for help")] = False
) -> None:
    """Check the installation.

    Check libraries, the configuration, a compiled kernel, caches and disks, and say what to do
    about each problem. The exit status is 1 if there is one.
    """
    from roughgas.doctor import print_checks

    print_checks(json)


@command(
    'eval "$(roughgas completion bash)"      # in ~/.bashrc',
    'eval "$(roughgas completion zsh)"       # in ~/.zshrc, after compinit',
    "roughgas completion fish | source       # in ~/.config/fish/config.fish",
)
def completion(
    shell: Annotated[Literal["bash", "zsh", "fish"], Option("bash, zsh or fish")],
) -> None:
    """Complete commands, options and experiments in your shell.

    Print the lines that make a shell complete this command when Tab is pressed: commands, options,
    files, and the experiments and scales of the configuration in the present folder.
    """
    import argcomplete

    print(argcomplete.shellcode(["roughgas"], shell=shell))
