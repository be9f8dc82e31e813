"""The commands that the workflow gives: what each takes, says and calls."""

from roughgas.cli.options import CONFIG, KERNEL, POINT, REDUCED, SCALE, SETTINGS
from roughgas.cli.parser import Command, flag, output, value

STEPS = {
    "compile": Command(
        "cli.run:compile_kernel",
        "compile the kernel of a point ahead of it",
        *KERNEL,
        examples=("roughgas compile cooling --r 0.9",),
    ),
    "pilot": Command(
        "cli.planning:pilot",
        "measure the cost and the scatter of a point in a short run",
        *POINT,
        output("JSON file"),
        examples=("roughgas pilot sheared --r 0.9 --beta 0 -o pilot.json",),
    ),
    "reach": Command(
        "cli.planning:reach",
        "run as many seeds of a point as its target_stderr needs",
        *POINT,
        value("--pilot FILE", "pilot of the point (default: run one first)"),
        output("folder for the datasets", "FOLDER"),
        examples=("roughgas reach sheared --scale fine --r 0.9 --beta 0 -o seeds",),
    ),
    "costs": Command(
        "results.costs:write_costs",
        "compare planned and actual cost and accuracy",
        REDUCED,
        value("--fixed JSON", "schedules to compare with", required=True),
        output("Markdown file"),
        examples=("roughgas costs results/fine/sheared.nc --fixed '{}' -o costs.md",),
    ),
    "reduce": Command(
        "cli.products:reduce",
        "combine the points of an experiment",
        value(
            "inputs POINT",
            "datasets, or folders of them; - reads their names from standard input, one per line",
            nargs="+",
        ),
        output("reduced dataset"),
        examples=("roughgas reduce results/paper/sheared/r*/beta*/seed*.nc -o sheared.nc",),
    ),
    "table": Command(
        "results.table:write_table",
        "write reduced datasets as one CSV table",
        REDUCED,
        output("CSV file"),
        examples=("roughgas table results/paper/sheared.nc results/paper/cooling.nc -o R.csv",),
    ),
    "figure": Command(
        "cli.products:figure",
        "draw a figure from reduced datasets",
        value("name NAME", "name of the figure, such as fig1a"),
        REDUCED,
        output(".pdf, .png or .svg files", nargs="+"),
        flag("--slide", "in the shape of a slide, 16 to 9"),
        examples=(
            "roughgas figure fig2b results/paper/cooling.nc -o fig2b.pdf fig2b.png",
            "roughgas figure fig2b results/paper/cooling.nc --slide -o slide.pdf slide.svg",
        ),
    ),
    "claims": Command(
        "cli.products:claims",
        "judge the claims of the paper on reduced datasets",
        REDUCED,
        flag("--open-questions", "judge the open questions instead"),
        value("--json FILE", "verdicts for programs", required=True),
        value("--markdown FILE", "verdicts for people", required=True),
        examples=("roughgas claims results/paper/*.nc --json claims.json --markdown claims.md",),
    ),
    "page": Command(
        "show.page.explore:write_page",
        "write an interactive page of experiments and their points",
        REDUCED,
        value("--points FOLDER", "folder of their points: results/SCALE", required=True),
        output("HTML file"),
        value("--config FILE", "describes the experiments (default: that of roughgas)"),
        examples=(
            "roughgas page results/small/vibrated.nc --points results/small -o explore.html",
        ),
    ),
    "front": Command(
        "show.page.front:write_front",
        "write the report's front page: figures beside their captions, and verdicts",
        value("claims CLAIMS", "verdicts in Markdown"),
        value("--figures PNG", "pictures of figures", nargs="+", required=True),
        value("--captions RST", "their captions", nargs="+", required=True),
        output("HTML file"),
        examples=(
            "roughgas front results/small/claims.md --figures figures/small/fig1a.png"
            " --captions rules/captions/fig1a.rst -o report.html",
        ),
    ),
    "living": Command(
        "show.living.assemble:write_living",
        "write a page that simulates a gas of disks, with sliders",
        CONFIG,
        output("HTML file"),
        examples=("roughgas living -o living.html",),
    ),
    "html": Command(
        "show.page.document:write_document",
        "write a Markdown, YAML, MP4 or GIF file as one page of HTML",
        value("input FILE", "file to show"),
        output("HTML file"),
        examples=("roughgas html results/small/claims.md -o claims.html",),
    ),
    "times": Command(
        "results.costs:write_times",
        "write how long experiments took, in CPU seconds",
        REDUCED,
        output("Markdown file"),
        examples=("roughgas times results/small/vibrated.nc -o run_times.md",),
    ),
    "config": Command(
        "cli.products:effective_config",
        "write the complete configuration of a scale",
        SCALE,
        CONFIG,
        value("--changes JSON", "changes to the configuration", default="{}"),
        output("YAML file"),
        examples=("roughgas config --scale small -o config_small.yaml",),
    ),
    "clustering": Command(
        "cli.showcase:clustering",
        "film a large cooling gas until it forms clusters",
        *SETTINGS,
        value("--checkpoint-every FRAMES", "frames from one checkpoint to the next", default="10"),
        output("dataset"),
        examples=("roughgas clustering --scale small -o clustering.nc",),
        about="Film a large cooling gas until it forms clusters. If a run was interrupted or "
        "killed, the same command resumes from its last checkpoint, FILE.checkpoint.npz; the "
        "result is the same to the last bit.",
    ),
    "film": Command(
        "show.figures.clustering:draw",
        "draw the film of `roughgas clustering` as a picture or as a movie",
        value("input FILM", "dataset"),
        output(".pdf, .png, .mp4 files", nargs="+"),
        examples=("roughgas film clustering.nc -o clustering.png clustering.mp4",),
    ),
    "study": Command(
        "cli.studies:study",
        "run one of the independent tasks of a study",
        value("study STUDY", "statistical, models, ..."),
        value("task TASK", "name of the task"),
        *SETTINGS,
        output("dataset"),
        examples=("roughgas study statistical cooling-reference --scale small -o reference.nc",),
    ),
    "combine": Command(
        "studies.files:combine",
        "combine the tasks of studies into one dataset",
        value("inputs TASK", "datasets", nargs="+"),
        output("dataset"),
        examples=("roughgas combine results/small/studies/*/*.nc -o accuracy.nc",),
    ),
    "tables": Command(
        "studies.tables:write_tables",
        "write the results of studies as tables in Markdown",
        value("input COMBINED", "combined dataset"),
        output("Markdown file"),
        examples=("roughgas tables results/small/accuracy.nc -o accuracy.md",),
    ),
}
