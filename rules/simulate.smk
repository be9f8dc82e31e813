# From an experiment's settings to its points. Of the sweep, `seeds_per_job` seeds at `betas_per_job`
# values of beta are made by one job (see config.yaml); any other point is a job of its own.
SIMULATING = ("simulation.point", "data.point")
RECORDING = (
    "cli.run",
    "simulation.points",
    "config.labels",
    "config.provenance",
)  # these hand on and write down


def settings_of_points(wildcards):
    """All in config.yaml that the points of an experiment depend on, as JSON."""
    return text_of_points(wildcards.scale, wildcards.experiment)


@functools.cache
def text_of_points(scale, experiment):
    return roughgas.config.as_text(roughgas.config.point_settings(settings(scale, experiment)))


def code_of_points(wildcards):
    """The code that points depend on."""
    code = sources.code_of(*SIMULATING, alone=RECORDING)
    return with_files(code, settings_of_points(wildcards))


def points_of_job(wildcards, output):
    """The betas and seeds of a job's outputs, each with each. Made from the output and therefore
    not recorded: a point is up to date whichever job has made it."""
    files = [Path(file) for file in output]
    betas = dict.fromkeys(file.parent.name.removeprefix("beta") for file in files)
    seeds = dict.fromkeys(file.stem.removeprefix("seed") for file in files)
    return [*(f"--beta={beta}" for beta in betas), "--seed", *seeds]


def urgency(wildcards):
    """How long a point takes: the longest start first, so that none is left alone at the end. A job
    on several betas counts as if they were 0."""
    from roughgas.simulation.point import effort

    place = place_of(wildcards)
    return effort(settings(wildcards.scale, wildcards.experiment), place.r, place.beta)


def one_of(labels):
    """The wildcard constraint for one of these labels."""
    return "|".join(re.escape(str(label)) for label in labels)


def jobs_of_points():
    """(name, outputs, log, wildcard constraints) of the rules that make points. A rule has a fixed
    number of outputs and the seeds of a sweep vary: so each block of points has a rule. With a job
    for each seed the paper takes a third longer, since a process starts as long as some points run.
    """
    yield "point", [POINT], "beta{beta}/seed{seed}", {}
    for experiment in config["experiments"]:
        found = roughgas.config.experiment(config, experiment, SCALE)
        axes = found["sweep"]
        swept_values = {
            "scale": SCALE,
            "experiment": one_of(roughgas.config.variants(experiment, found)),
            "r": one_of(axes["r"]),
            "beta": one_of(axes["beta"]),
        }
        for number, (betas, seeds) in enumerate(roughgas.config.blocks(axes, config), start=1):
            files = [
                POINT.replace("{beta}", beta).replace("{seed}", seed)
                for beta in betas
                for seed in seeds
            ]
            span = betas[0] if len(betas) == 1 else f"{betas[0]}to{betas[-1]}"
            log_of_block = f"beta{span}/seeds{seeds[0]}-{seeds[-1]}"
            yield f"{experiment}_block_{number}", files, log_of_block, swept_values


for job, files, log_of_job, swept_values in jobs_of_points():

    rule:
        name:
            job
        input:
            kernel_of_point,
        output:
            files,
        log:
            f"logs/{{scale}}/{{experiment}}/r{{r}}/{log_of_job}.log",
        benchmark:
            f"logs/{{scale}}/{{experiment}}/r{{r}}/{log_of_job}.tsv"
        wildcard_constraints:
            **swept_values,
        priority: urgency
        params:
            code=code_of_points,
            settings=settings_of_points,
            points=points_of_job,
        message:
            "{wildcards.experiment}: r = {wildcards.r}, {params.points}"
        shell:
            "roughgas run {wildcards.experiment:q} --scale {wildcards.scale:q} --r={wildcards.r:q}"
            " {params.points:q} --settings {params.settings:q} --checked --output {output:q}"
            " > {log:q} 2>&1"

    if job != "point":
        workflow.ruleorder(job, "point")  # the statement `ruleorder:` takes no variables
