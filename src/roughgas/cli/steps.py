"""The commands that the workflow gives: what each takes, says and calls."""

from roughgas.cli.options import POINT, REDUCED
from roughgas.cli.parser import Command, output, value

STEPS = {
    "pilot": Command(
        "cli.planning:pilot",
        "measure the cost and the scatter of a point in a short run",
        *POINT,
        output("JSON file"),
        writes="a pilot",
        examples=("roughgas pilot sheared --r 0.9 --beta 0 -o pilot.json",),
    ),
    "reach": Command(
        "cli.planning:reach",
        "run as many seeds of a point as its target_stderr needs",
        *POINT,
        value("--pilot FILE", "pilot of the point (default: run one first)"),
        output("folder for the datasets", "FOLDER"),
        writes="a folder",
        examples=("roughgas reach sheared --scale fine --r 0.9 --beta 0 -o seeds",),
    ),
    "costs": Command(
        "results.costs:write_costs",
        "compare planned and actual cost and accuracy",
        REDUCED,
        value("--fixed JSON", "schedules to compare with", required=True),
        output("Markdown file"),
        writes="costs",
        examples=("roughgas costs results/fine/sheared.nc --fixed '{}' -o costs.md",),
    ),
}
