"""Accuracy on demand: `roughgas pilot`, `reach` and `plan`."""

import sys
import time
from argparse import Namespace
from pathlib import Path
from typing import Any

from roughgas import config
from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.base.layout import as_json
from roughgas.cli.options import whole_number
from roughgas.cli.run import point_of, say_done, write_seed
from roughgas.planning import reach as reaching
from roughgas.planning.pilot import Pilot, read_pilot, write_pilot
from roughgas.planning.plan import explore, plan_point
from roughgas.planning.table import as_markdown, as_numbers, row
from roughgas.scene import Scene, build
from roughgas.simulation.progress import Bar, Progress

PILOT = "{experiment}/r{r}/beta{beta}/pilot.json"


def pilot(options: Namespace) -> None:
    """Run the pilot of a point."""
    scene, settings = point_of(options)
    write_pilot(options.output, _explore(options, scene, settings))


def reach(options: Namespace) -> None:
    """Run seeds of a point until its standard error is the target of its experiment."""
    scene, settings = point_of(options)
    if "target_stderr" not in settings:
        raise InputError("target_stderr", "(nothing)", f"be set for {options.experiment}")
    known = read_pilot(options.pilot) if options.pilot else _explore(options, scene, settings)

    def keep(seed, point, chosen):
        output = str(Path(options.output, f"seed{seed}.nc"))
        write_seed(options, (options.r, options.beta, str(seed)), chosen, output, point)
        say_done(output, point)

    expected = plan_point(scene, settings, known)
    run_settings = reaching.completed(settings, expected)
    with Progress(options.experiment, scene, run_settings, expected.seeds) as progress:
        planned, error, seeds = reaching.reach(scene, settings, known, keep, progress)
    met = "met" if error.stderr <= settings["target_stderr"] else "NOT met"
    print(
        f"{options.output}: {seeds} seeds ({planned.seeds} planned), standard error "
        f"{error.stderr:.2g}: target {settings['target_stderr']:g} {met}",
        file=sys.stderr,
    )


def plan(options: Namespace) -> None:
    """Print what experiments will cost."""
    cores = whole_number("--cores", options.cores, 1)
    loaded = config.load(options.config)
    found: dict[str, dict[str, Any]] = {}
    for name in options.experiments or loaded["experiments"]:
        found |= config.every_variant(name, config.experiment(loaded, name, options.scale))
    folder = Path(options.pilots or f"results/{options.scale}")
    try:
        pilots = {name: _pilots(name, settings, folder) for name, settings in found.items()}
    except KeyboardInterrupt:
        kept = f"pilots that are done are kept in {folder}: the same command goes on from there"
        raise KeyboardInterrupt(kept) from None
    start_up = time.process_time()  # of this process: jobs import as much
    block = loaded.get("seeds_per_job", config.SEEDS_PER_JOB)
    rows = [row(name, settings, pilots[name][0], block) for name, settings in found.items()]
    start_up -= sum(seconds for _, seconds in pilots.values())
    table = rows, cores, start_up
    text = as_json(as_numbers(*table)) + "\n" if options.json else as_markdown(*table)
    print(text, end="")
    if options.output:
        write_text(options.output, text)


def _explore(options: Namespace, scene: Scene, settings: dict[str, Any]) -> Pilot:
    with Bar(f"pilot of {options.experiment}", None):
        return explore(scene, settings)


def _pilots(name: str, settings: dict[str, Any], folder: Path):
    """Return the pilots of a sweep by (r, beta), and the CPU seconds spent on missing ones."""
    axes, begin = settings["sweep"], time.process_time()
    found: dict[tuple[str, str], Pilot] = {}
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
