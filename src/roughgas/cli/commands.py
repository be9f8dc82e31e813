"""The commands that people give: what each takes, says and calls."""

import os

from roughgas.cli.parser import (
    CONFIG,
    FROM,
    POINT,
    POINTS,
    RESEED,
    RESTITUTION,
    ROUGHNESS,
    SCALE,
    SET,
    TAKE,
    Command,
    flag,
    one_of,
    output,
    value,
)

CORES = str(os.cpu_count())
COMMANDS = {
    "run": Command(
        "cli.run:run",
        "simulate a point, and write its dataset",
        *POINTS,
        SET,
        FROM,
        value(*RESEED, nargs="+"),
        flag("--keep-state", "keep the last state in the dataset, for --from"),
        value("--observe NAME", "observables, such as stress or profiles", nargs="+"),
        output("datasets, one per point", required=False, nargs="+"),
        flag("--json", "print a line of JSON per seed"),
        writes="POINT",
        examples=(
            "roughgas run cooling --r 0.9 --beta -0.5",
            "roughgas run cooling --r 0.9 --beta 0 .5 1 --seed 1 2 3 --scale small",
            "roughgas run vibrated --r 0.9 --beta 0 --set particles=80 effects.friction.mu=0.3",
            "roughgas run vibrated --r 0.87 --beta 0.5 --seed 1 2 3 --scale small --json",
            "roughgas run vibrated --set effects.spin.inertia=0.3 --r 0.9 --beta 1 -o hollow.nc",
            "roughgas run sheared --r 0.9 --beta 0 --keep-state -o first.nc",
            "roughgas run sheared --r 0.9 --beta 0 --from first.nc -o second.nc",
            "roughgas run sheared --r 0.9 --beta 0 --observe stress profiles -o stress.nc",
        ),
        about="Simulate a point of an experiment, or each r with each beta and each seed in turn, "
        "and write a dataset for each. Without -o the dataset goes into the present folder, under "
        "a name made from the point's, and its summary is printed, as by `roughgas show`. --set "
        "changes any setting of the experiment, by its key in config.yaml.",
    ),
    "movie": Command(
        "cli.products:movie",
        "show a point as it moves",
        *POINTS,
        SET,
        *TAKE,
        value("--fps RATE", "frames a second", default="25"),
        value(
            "--colour",
            "meaning of colour: spin, species of a mixture, or height of spheres, seen from above",
            choices=("spin", "species", "height"),
            default="spin",
        ),
        output(".mp4 or .gif files", nargs="+"),
        examples=(
            "roughgas movie vibrated --r 0.9 --beta 0.5 -o bed.mp4 bed.gif",
            "roughgas movie vibrated --r 0.9 --beta -1 0 1 --length 10 -o roughness.mp4",
        ),
        about="Simulate a point of an experiment, and draw its particles as they move and spin, "
        "its boundaries, and R(t); several r, beta and seeds are shown side by side. The "
        "trajectory is that of `roughgas run` with the same seed. Times are in T; for a cooling "
        "gas, in collisions per particle.",
    ),
    "trajectory": Command(
        "cli.products:trajectory",
        "write the trajectories of all particles, for OVITO, ASE, freud ...",
        *POINT,
        value("--seed", "seed of the random generator (default: 1)"),
        SET,
        *TAKE,
        value("--times TIME", "increasing times of frames, in place of these three", nargs="+"),
        FROM,
        value(*RESEED),
        output(".xyz, .nc or .gsd files", nargs="+"),
        examples=(
            "roughgas trajectory vibrated --r 0.9 --beta 0.5 -o bed.xyz",
            "roughgas trajectory sheared --r 0.9 --beta 0 --times 100 200 300 -o sheared.nc",
            "roughgas trajectory cooling --r 0.9 --beta -0.5 --length 50 --frames 11 -o gas.gsd",
        ),
        about="Simulate a point of an experiment, and write positions, velocities, spins and "
        "angles of all particles, as `roughgas movie` would show them: as extended XYZ, as netCDF "
        "by the conventions of AMBER, or as GSD (which needs roughgas[trajectories]). Times are "
        "in T; for a cooling gas, in collisions per particle.",
    ),
    "show": Command(
        "cli.show:show",
        "summarise any dataset of the pipeline",
        value("files FILE", "datasets", nargs="+"),
        flag("--json", "print attributes and single numbers, a line of JSON for each file"),
        examples=(
            "roughgas show results/paper/vibrated/r0.9/beta0.5/seed1.nc",
            "roughgas show results/paper/vibrated.nc",
            "roughgas show results/paper/accuracy.nc",
            "roughgas show results/paper/sheared.nc --json",
        ),
        about="Print what a dataset holds: what was simulated, R with its error, theory, "
        "energies, cost, and how to make it again. It may be a point, a reduced dataset, "
        "a dataset of studies or a task of one. 0.3565(30) is 0.3565 with a "
        "standard error of 0.0030.",
    ),
    "plot": Command(
        "cli.products:plot",
        "draw a point over time, or any reduced dataset beside theory",
        value("input DATASET", "a point, or a reduced dataset"),
        value("--of VARIABLE", "what an observable of a point has found, in place of R(t)"),
        value("--over AXIS", "horizontal axis: r, beta, or the third axis (the default)"),
        value("--r VALUE", "values of r to show", nargs="+"),
        value("--beta VALUE", "values of beta to show", nargs="+"),
        output(".png, .pdf or .svg files", nargs="+"),
        examples=(
            "roughgas plot cooling_r0.9_beta0.5_seed1.nc -o over_time.png",
            "roughgas plot stress.nc --of temperature_profile -o profile.png",
            "roughgas plot results/paper/sheared.nc -o my.png",
            "roughgas plot results/paper/sheared.nc --beta 0 1 --over r -o my.png my.pdf",
            "roughgas plot results/paper/vibrated.nc --over beta --r 0.9 -o bed.png",
        ),
        about="Draw R of a sweep with error bars and theory, and R minus theory. The horizontal "
        "axis is the third axis of the sweep, else beta. Of many series an evenly spaced selection "
        "is drawn; --r and --beta choose. Without spin, the energy is drawn. Of a point, R(t) and "
        "both energies: the window in which R is measured is shaded, its mean, its 95 % interval "
        "and theory are lines. --of draws a variable of an observable instead, such as g(r), with "
        "its error, a line for each species.",
    ),
    "reduce": Command(
        "cli.products:reduce",
        "combine the points of an experiment into a dataset",
        value(
            "inputs POINT",
            "datasets, or folders of them; - reads their names from standard input, one per line",
            nargs="+",
        ),
        output("reduced dataset"),
        flag("--put-aside", "rename a damaged point to POINT.damaged: a workflow makes it anew"),
        writes="REDUCED",
        examples=("roughgas reduce results/paper/sheared/r*/beta*/seed*.nc -o sheared.nc",),
        about="Combine points of one experiment, at any r and beta, of any seeds, into a dataset "
        "that `roughgas show` and `roughgas plot` take: R with its error, beside theory.",
    ),
    "experiments": Command(
        "cli.products:experiments",
        "list the experiments of the configuration",
        SCALE,
        CONFIG,
        flag("--json", "print JSON, for scripts"),
        examples=("roughgas experiments", "roughgas experiments --scale small"),
        about="Print the name, the description and the sweep of each experiment at a scale. "
        "`roughgas run` takes these names, as do results/SCALE/NAME.nc and "
        "figures/NAME.png.",
    ),
    "theory": Command(
        "cli.theory:print_theory",
        "print R of theory, at a point or along a curve",
        value("--r VALUE", RESTITUTION, required=True, nargs="+"),
        value("--beta VALUE", ROUGHNESS, required=True, nargs="+"),
        value("--dimension", "of disks or of spheres (default: both)", choices=("2", "3")),
        value(
            "--inertia Q", "moment of inertia in m a^2 (default: 0.5 for disks, 0.4 for spheres)"
        ),
        value("--spin-share S", "share of the drive's power that goes into rotation", default="0"),
        value("--mu", "Coulomb friction (default: none, contacts never slide)"),
        value(
            "--species YAML",
            "a mixture: a list of species as in config.yaml, or a file with such a list",
        ),
        value("--packing", "share of the box that a mixture fills", default="0"),
        one_of(
            flag("--json", "print JSON, for scripts"), flag("--csv", "print CSV, for spreadsheets")
        ),
        examples=(
            "roughgas theory --r 0.9 --beta 0.5",
            "roughgas theory --r 0.9 --beta -1:1:0.1 --dimension 2",
            "roughgas theory --r 0.8 0.9 0.99 --beta 0 --inertia 0.1 --json",
            "roughgas theory --r 0.9 --beta 0.5 --mu 0.3",
            "roughgas theory --r 0.9 --beta -0.9:0.9:0.1 --spin-share 0.2 --csv",
            "roughgas theory --r 0.9 --beta 0 --dimension 2 --species"
            " '[{fraction: 0.5}, {fraction: 0.5, radius: 2, mass: 4}]'",
        ),
        about="Print R = E_rot/(E_rot + E_trans) of theory, driven and freely cooling, how fast "
        "it is reached, and how fast energy decays, with the equation behind each number. r and "
        "beta take several values, or a range START:STOP:STEP with both ends. Of a mixture, R and "
        "the translational temperature of each species, over its mean; it is driven as by the "
        "effect thermostat.",
    ),
    "crate": Command(
        "cli.products:crate",
        "pack a finished run as an RO-Crate",
        value("files FILE", "results and figures", nargs="+"),
        output(".zip file", "CRATE"),
        CONFIG,
        value("--configuration JSON", "the configuration, in place of --config"),
        writes="a crate",
        examples=(
            "roughgas crate results/paper/*.nc results/paper/R.csv figures/fig*.png -o run.zip",
        ),
        about="Pack results of a run in this folder, with its configuration and code, as an "
        "RO-Crate.",
    ),
    "doctor": Command(
        "doctor:doctor",
        "check the installation",
        flag("--json", "print JSON, for scripts or for asking for help"),
        examples=("roughgas doctor",),
        about="Check libraries, the configuration, a compiled kernel, caches and disks, and "
        "say what to do about each problem. The exit status is 1 if there is one.",
    ),
    "completion": Command(
        "cli.parser:print_completion",
        "complete commands, options and experiments in your shell",
        value("shell", "bash, zsh or fish", choices=("bash", "zsh", "fish")),
        examples=(
            'eval "$(roughgas completion bash)"      # in ~/.bashrc',
            'eval "$(roughgas completion zsh)"       # in ~/.zshrc, after compinit',
            "roughgas completion fish | source       # in ~/.config/fish/config.fish",
        ),
        about="Print the lines that make a shell complete this command when Tab is pressed: "
        "commands, options, files, and the experiments and scales of the configuration in the "
        "present folder.",
    ),
}
