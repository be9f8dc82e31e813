# Accuracy on demand: a pilot of each point says how many seeds it needs, and what they will cost.
PLANNED = [
    name
    for name in config["experiments"]
    if "target_stderr" in roughgas.config.experiment(config, name, SCALE)
]


DEAR = 0.5  # share of a run that its pilots may cost without a warning


def planned_experiments(wildcards):
    """Those of `figures`, or of `extensions`."""
    return catalogue.shown_in("beyond" if wildcards.plan == "plan_extensions" else "paper")


def pilots(wildcards):
    """The pilots of the points that are planned; warns where they are hardly worth it."""
    names = planned_experiments(wildcards)
    warn_of_dear_pilots(wildcards.scale, tuple(names))
    return [file for name in names for file in swept(PILOT, wildcards.scale, name)]


@functools.cache
def warn_of_dear_pilots(scale, names):
    from roughgas.planning.plan import share_of_pilots

    found = [roughgas.config.every_variant(name, settings(scale, name)) for name in names]
    share = share_of_pilots([one for every in found for one in every.values()])
    if share > DEAR:
        logger.warning(
            f"Pilots of the scale {scale} take about {share:.1f} times the CPU time of the run that "
            f"they plan. It may be better to run it: snakemake -j2 figures --config scale={scale}"
        )


def settings_without_lengths(wildcards):
    """The settings of points without run lengths and targets, which no pilot depends on, as JSON."""
    found = settings(wildcards.scale, wildcards.experiment)
    return roughgas.config.as_text(roughgas.config.pilot_settings(found))


def planned_data(wildcards):
    return reduced(wildcards.scale, PLANNED)


def fixed_schedules(wildcards):
    """How long all points of an experiment are run at the scale of the paper, as JSON."""
    return roughgas.config.as_text({n: settings("paper", n)["schedule"] for n in PLANNED})


rule pilot:
    input:
        kernel_of_point,
    output:
        PILOT,
    log:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/pilot.log",
    benchmark:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/pilot.tsv"
    params:
        code=code_of(
            "planning.pilot",
            "planning.plan",
            alone=["cli.planning"],
            settings=settings_without_lengths,
        ),
        settings=settings_without_lengths,
    message:
        "pilot of {wildcards.experiment}: r = {wildcards.r}, beta = {wildcards.beta}"
    shell:
        "roughgas pilot {wildcards.experiment:q} --scale {wildcards.scale:q} --r={wildcards.r:q}"
        " --beta={wildcards.beta:q} --settings {params.settings:q} --checked --output {output:q}"
        " > {log:q} 2>&1"


rule reach:
    # a folder, since only its making shows how many seeds it takes
    input:
        kernel_of_point,
        pilot=PILOT,
    output:
        directory(SEEDS),
    log:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/reach.log",
    benchmark:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/reach.tsv"
    params:
        code=code_of_points,
        settings=settings_of_points,
    message:
        "{wildcards.experiment}: r = {wildcards.r}, beta = {wildcards.beta}, to its target"
    shell:
        "roughgas reach {wildcards.experiment:q} --scale {wildcards.scale:q} --r={wildcards.r:q}"
        " --beta={wildcards.beta:q} --settings {params.settings:q} --checked --pilot {input.pilot:q}"
        " --output {output:q} > {log:q} 2>&1"


rule plan_of_scale:
    input:
        config=of_project(CONFIG),
        pilots=pilots,
    output:
        "results/{scale}/{plan}.md",
    log:
        "logs/{scale}/{plan}.log",
    wildcard_constraints:
        plan="plan|plan_extensions",
    params:
        code=code_of("planning.table"),
        names=planned_experiments,
        cores=workflow.cores,
    message:
        "write {output}"
    shell:
        "roughgas plan {params.names:q} --scale {wildcards.scale:q} --cores {params.cores:q}"
        " --config {input.config:q} --output {output:q}"
        " > {log:q} 2>&1"


rule costs_of_scale:
    input:
        data=planned_data,
    output:
        "results/{scale}/costs.md",
    log:
        "logs/{scale}/costs.log",
    params:
        code=code_of("results.costs"),
        fixed=fixed_schedules,
    message:
        "write {output}"
    shell:
        "roughgas costs {input.data:q} --fixed {params.fixed:q} --output {output:q} > {log:q} 2>&1"
