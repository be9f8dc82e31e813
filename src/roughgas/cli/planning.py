"""Accuracy on demand: `roughgas pilot`, `reach`, `plan` and `costs`."""

import argparse
import os
import sys
import time
from pathlib import Path
from typing import Any

from roughgas.base.errors import InputError
from roughgas.cli.layout import as_json
from roughgas.cli.parser import examples
from roughgas.cli.run import add_point, point_of, write_seed
from roughgas.cli.settings import add_experiments, add_scale

PILOT_EXAMPLE = examples("roughgas pilot sheared --r 0.9 --beta 0 -o pilot.json")
REACH_EXAMPLE = examples("roughgas reach sheared --scale fine --r 0.9 --beta 0 -o seeds")
PLAN_EXAMPLES = examples(
    "roughgas plan sheared --scale small",
    "roughgas plan --scale fine --cores 8",
    "roughgas plan vibrated cooling --scale fine --json",
)
COSTS_EXAMPLE = examples(
    "roughgas costs results/fine/sheared.nc --fixed '{}' -o costs.md",
)
PILOT = "{experiment}/r{r}/beta{beta}/pilot.json"


def add_commands(commands: Any) -> None:
    """Add the four subcommands to argparse's `commands`."""
    parser = commands.add_parser(
        "pilot",
        help="measure what a point costs and how much it scatters",
        description="Run a point for a moment, and write what its cost and its error follow from.",
        epilog=PILOT_EXAMPLE,
    )
    add_point(parser)
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="JSON file to write")
    parser.set_defaults(command=pilot)

    parser = commands.add_parser(
        "reach",
        help="run as many seeds of a point as its target_stderr needs",
        description="Run seeds 1, 2, ... of a point until the standard error of R is the "
        "experiment's target_stderr, and no longer.",
        epilog=REACH_EXAMPLE,
    )
    add_point(parser)
    parser.add_argument("--pilot", metavar="FILE", help="its pilot; without one it is run first")
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER", help="for the datasets")
    parser.set_defaults(command=reach)

    parser = commands.add_parser(
        "plan",
        help="say what all experiments will cost, and how accurate they will be",
        description="Print a table of points, seeds, errors and times, from pilot runs. Those that "
        "are not there yet are run first; nothing else is.",
        epilog=PLAN_EXAMPLES,
    )
    add_experiments(parser, dest="experiments", nargs="*", help="default: all")
    add_scale(parser)
    cores = str(os.cpu_count())
    parser.add_argument("--cores", default=cores, help="for the wall time (default: all here)")
    parser.add_argument("--pilots", metavar="FOLDER", help="of pilots (default: results/SCALE)")
    parser.add_argument("--json", action="store_true", help="print the table as JSON; times in s")
    parser.add_argument("-o", "--output", metavar="FILE", help="file for the table, too")
    parser.set_defaults(command=plan)

    parser = commands.add_parser(
        "costs",
        help="compare what was planned with what happened",
        description="Write, from reduced datasets, what was planned beside what happened.",
        epilog=COSTS_EXAMPLE,
    )
    parser.add_argument("inputs", nargs="+", metavar="REDUCED", help="reduced datasets")
    parser.add_argument("--fixed", required=True, metavar="JSON", help="schedules to compare with")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="Markdown file")
    parser.set_defaults(command=costs)


def pilot(options: argparse.Namespace) -> None:
    """Run the pilot of a point."""
    from roughgas.planning.pilot import explore, write_pilot
    from roughgas.scene import build

    r, beta, settings = point_of(options)
    write_pilot(options.output, explore(build(settings, r, beta), settings))


def reach(options: argparse.Namespace) -> None:
    """Run a point until it is as accurate as its experiment says."""
    from roughgas.planning.pilot import explore, read_pilot
    from roughgas.planning.plan import plan_point
    from roughgas.planning.reach import completed
    from roughgas.planning.reach import reach as run
    from roughgas.scene import build
    from roughgas.simulation.progress import Progress

    r, beta, settings = point_of(options)
    if "target_stderr" not in settings:
        raise InputError("target_stderr", "(nothing)", f"be set for {options.experiment}")
    scene = build(settings, r, beta)
    known = read_pilot(options.pilot) if options.pilot else explore(scene, settings)

    def keep(seed, point, chosen):
        output = str(Path(options.output, f"seed{seed}.nc"))
        write_seed(options, chosen, str(seed), output, point)

    expected = plan_point(scene, settings, known)
    run_settings = completed(settings, expected)
    with Progress(options.experiment, scene, run_settings, expected.seeds) as progress:
        planned, error, seeds = run(scene, settings, known, keep, progress)
    met = "met" if error.stderr <= settings["target_stderr"] else "NOT met"
    print(
        f"{options.output}: {seeds} seeds ({planned.seeds} planned), standard error "
        f"{error.stderr:.2g}: target {settings['target_stderr']:g} {met}",
        file=sys.stderr,
    )


def plan(options: argparse.Namespace) -> None:
    """Print what experiments will cost."""
    from roughgas import config
    from roughgas.base.files import write_text
    from roughgas.planning.table import as_markdown, as_numbers, row

    if not options.cores.isdecimal() or int(options.cores) < 1:
        raise InputError("--cores", options.cores, "be a whole number >= 1")
    loaded = config.load(options.config)
    names = options.experiments or list(loaded["experiments"])
    found = {}
    for name in names:
        found |= config.every_variant(name, config.experiment(loaded, name, options.scale))
    folder = Path(options.pilots or f"results/{options.scale}")
    pilots = {name: _pilots(name, settings, folder) for name, settings in found.items()}
    start_up = time.process_time()  # of this process: jobs import as much
    block = loaded.get("seeds_per_job", config.SEEDS_PER_JOB)
    rows = [row(name, settings, pilots[name][0], block) for name, settings in found.items()]
    start_up -= sum(seconds for _, seconds in pilots.values())
    table = rows, int(options.cores), start_up
    text = as_json(as_numbers(*table)) + "\n" if options.json else as_markdown(*table)
    print(text, end="")
    if options.output:
        write_text(options.output, text)


def costs(options: argparse.Namespace) -> None:
    """Write what was planned beside what happened."""
    from roughgas.results.costs import write_costs

    write_costs(options.inputs, options.fixed, options.output)


def _pilots(name: str, settings: dict[str, Any], folder: Path):
    """The pilots of a sweep by (r, beta), and the CPU seconds spent on missing ones."""
    from roughgas.planning.pilot import explore, read_pilot, write_pilot
    from roughgas.scene import build
    from roughgas.simulation.progress import Bar

    axes, found, begin = settings["sweep"], {}, time.process_time()
    with Bar(f"pilots of {name}", len(axes["r"]) * len(axes["beta"]), "points") as bar:
        for r in axes["r"]:
            for beta in axes["beta"]:
                bar.reach(len(found), f"r = {r}, beta = {beta}")
                path = folder / PILOT.format(experiment=name, r=r, beta=beta)
                if not path.exists():
                    scene = build(settings, float(r), float(beta))
                    write_pilot(path, explore(scene, settings))
                found[str(r), str(beta)] = read_pilot(path)
    return found, time.process_time() - begin
