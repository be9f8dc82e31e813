# Kernels, points, reduced datasets: the kernels of an experiment are compiled before its points are run.
# Of the sweep, `seeds_per_job` seeds at `betas_per_job` values of beta are made by one job (see
# config.yaml); any other point is a job of its own.
SIMULATING = ("simulation.point", "data.point")
RECORDING = ("cli.run", "simulation.points", "config.labels")  # these hand on and write down


def place_of(wildcards):
    """The numbers r, beta and seed of a point, or of what several points share."""
    labels = (
        [wildcards.get(name, usual)] for name, usual in (("r", "1"), ("beta", "0"), ("seed", "1"))
    )
    (place,) = roughgas.config.places(*labels)
    return place


def kernel_of_point(wildcards):
    """The file that says that the kernel of a point is compiled; ends the workflow for an illegal
    point."""
    with one_line(f"results/{wildcards.scale}/{wildcards.experiment}"):
        place_of(wildcards)
        found = settings(wildcards.scale, wildcards.experiment)
        roughgas.config.check_one_variant(wildcards.experiment, found)
    experiment, _, _ = wildcards.experiment.partition("/")
    r = as_at(wildcards.scale, experiment, wildcards.r)
    return KERNEL.format(scale=wildcards.scale, experiment=experiment, r=r)


def as_at(scale, experiment, r):
    """The first r in the sweep of an experiment that needs the same kernels: they are compiled once."""
    needed = kinds_at(scale, experiment, r)
    swept = settings(scale, experiment)["sweep"]["r"]
    return next((one for one in swept if kinds_at(scale, experiment, one) == needed), r)


@functools.cache
def kinds_at(scale, experiment, r):
    """Which kernels the variants in the sweep of an experiment need at some r."""
    from roughgas.simulation.point import kernels

    every = roughgas.config.every_variant(experiment, settings(scale, experiment)).values()
    with one_line(KERNEL.format(scale=scale, experiment=experiment, r=r)):
        number = roughgas.config.restitution(r)
    return sorted(map(str, kernels(every, number)))


def kinds_of_kernels(wildcards):
    return kinds_at(wildcards.scale, wildcards.experiment, wildcards.r)


def settings_of_kernels(wildcards, output):
    """The settings to compile, as JSON. Snakemake does not record params that are made from the
    output: of these settings only the kinds of kernels count."""
    found = settings(wildcards.scale, wildcards.experiment)
    return roughgas.config.as_text(roughgas.config.kernel_settings(found))


# The figures of the paper appear one by one, the one that takes least first.
IN_TURN = list(
    dict.fromkeys(
        one
        for name in reversed(catalogue.figures_of("paper"))
        for one in catalogue.FIGURES[name].shows
    )
)
TURN = 10**10  # more collisions than any job makes


def turn(wildcards):
    """How urgent the experiment is: beyond the paper the length of a job alone decides."""
    experiment, _, _ = wildcards.experiment.partition("/")
    return (len(IN_TURN) - IN_TURN.index(experiment)) * TURN if experiment in IN_TURN else 0


def urgency_of_kernel(wildcards):
    """Before its points, and after those that are more urgent."""
    return turn(wildcards) + TURN


rule compile_kernel:
    # Before the fan-out, and few at a time (see the profile); one job for all variants, since most of
    # them run the same machine code. Its code is part of that of points: what compiles anew runs anew,
    # and points that an interrupted run has left know by their own param that they are old.
    output:
        touch(KERNEL),
    log:
        "logs/{scale}/{experiment}/r{r}/compiled.log",
    benchmark:
        "logs/{scale}/{experiment}/r{r}/compiled.tsv"
    wildcard_constraints:
        experiment=EXPERIMENT,
    priority: urgency_of_kernel
    resources:
        compiling=1,
    params:
        code=code_of("simulation.point"),
        kinds=kinds_of_kernels,
        settings=settings_of_kernels,
    message:
        "compile the kernel of {wildcards.experiment} at r = {wildcards.r}"
    shell:
        "python -P -m roughgas.steps compile_kernels {wildcards.experiment:q} --r={wildcards.r:q}"
        " --settings {params.settings:q} --checked > {log:q} 2>&1"


def settings_of_points(wildcards):
    """All in config.yaml that the points of an experiment depend on, as JSON."""
    return text_of_points(wildcards.scale, wildcards.experiment)


@functools.cache
def text_of_points(scale, experiment):
    return roughgas.config.as_text(roughgas.config.point_settings(settings(scale, experiment)))


def code_of_points(wildcards):
    """The code that points depend on."""
    code = hash_of_code(*SIMULATING, alone=RECORDING)
    return with_files(code, settings_of_points(wildcards))


def points_of_job(wildcards, output):
    """The betas and seeds of a job's outputs, each with each. Made from the output and therefore
    not recorded: a point is up to date whichever job has made it."""
    files = [Path(file) for file in output]
    betas = dict.fromkeys(map(beta_of, files))
    seeds = dict.fromkeys(file.stem.removeprefix("seed") for file in files)
    return [*(f"--beta={beta}" for beta in betas), "--seed", *seeds]


def beta_of(file):
    """The label of beta in the path of a point."""
    return file.parent.name.removeprefix("beta")


def collisions_of_point(wildcards, beta):
    """About how many collisions a point at this beta makes."""
    return collisions_at(wildcards.scale, wildcards.experiment, wildcards.r, beta)


@functools.cache
def collisions_at(scale, experiment, r, beta):
    from roughgas.simulation.point import effort

    (place,), found = roughgas.config.places([r], [beta], ["1"]), settings(scale, experiment)
    return effort(found, place.r, place.beta if "spin" in found["effects"] else -1.0)


def urgency(points, wildcards):
    """The longest jobs of an experiment start first, so that none is left alone at the end. A job has
    so many points; on several betas they count as if these were 0."""
    length = points * collisions_of_point(wildcards, wildcards.get("beta", "0"))
    return turn(wildcards) + min(length, TURN - 1)


def jobs_of_points():
    """(name, outputs, log, wildcard constraints) of the rules that make points. A rule has a fixed
    number of outputs and the seeds of a sweep vary: so each block of points has a rule, which is
    that of all experiments with such a block. With a job for each seed the paper takes a third
    longer, since a process starts as long as some points run.

    No point has two rules: Snakemake would make a job of each, for each file, before it chooses.
    Constraints look ahead at the rest of the path: of `experiment` at r, of `scale` at all.
    """
    blocks = {}  # (betas, seeds, constraint of beta) -> experiments, each with the r of its sweep
    for experiment in config["experiments"]:
        found = roughgas.config.experiment(config, experiment, SCALE)
        axes, names = found["sweep"], one_of(roughgas.config.variants(experiment, found))
        for betas, seeds in roughgas.config.blocks(found, config, last=experiment == IN_TURN[-1]):
            swept = one_of(axes["beta"] if betas == ["{beta}"] else betas)
            where = f"(?:{names})(?=/r(?:{one_of(axes['r'])})/)"
            blocks.setdefault((tuple(betas), tuple(seeds), swept), []).append(where)
    in_blocks = ["(?!)"]  # which is no point
    for number, ((betas, seeds, swept), where) in enumerate(blocks.items(), start=1):
        files = [
            POINT.replace("{beta}", beta).replace("{seed}", seed)
            for beta in betas
            for seed in seeds
        ]
        span = betas[0] if len(betas) == 1 else f"{betas[0]}to{betas[-1]}"
        constraints = {"scale": re.escape(SCALE), "experiment": "|".join(where), "beta": swept}
        yield f"block_{number}", files, f"beta{span}/seeds{seeds[0]}-{seeds[-1]}", constraints
        labels = constraints | {"r": NAME, "seed": one_of(seeds)}
        points = POINT.format(**{name: f"(?:{one})" for name, one in labels.items()})
        in_blocks.append(points.removeprefix("results/"))
    yield "point", [POINT], "beta{beta}/seed{seed}", {"scale": f"(?!{'|'.join(in_blocks)}){NAME}"}


for job, files, log_of_job, constraints in jobs_of_points():

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
            **constraints,
        priority: functools.partial(urgency, len(files))
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


def points_of_experiment(wildcards):
    return points(wildcards.scale, wildcards.experiment)


rule reduce:
    input:
        points=points_of_experiment,
    output:
        REDUCED,
    log:
        "logs/{scale}/{experiment}/reduced.log",
    benchmark:
        "logs/{scale}/{experiment}/reduced.tsv"
    wildcard_constraints:
        experiment=EXPERIMENT,
    # at once: while it waits, Snakemake asks the size of all these points before each job it starts
    priority: FIRST
    params:
        code=code_of("results.reduce"),
    message:
        "reduce {wildcards.experiment}"
    shell:
        # a hundred thousand points are more than a command line holds
        "printf '%s\\n' {input.points:q} | "
        "roughgas reduce - --put-aside --output {output:q} > {log:q} 2>&1"
