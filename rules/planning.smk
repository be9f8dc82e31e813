# Accuracy on demand: a pilot of each point says how many seeds it needs, and what they will cost.
PLANNED = [
    name
    for name in config["experiments"]
    if "target_stderr" in roughgas.config.experiment(config, name, SCALE)
]


def pilots(wildcards):
    """The pilots of all experiments' points."""
    return [file for name in config["experiments"] for file in swept(PILOT, wildcards.scale, name)]


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
        code=code_of("planning.pilot", "planning.plan", alone=["cli.planning"]),
        settings=settings_without_lengths,
    message:
        "pilot of {wildcards.experiment}: r = {wildcards.r}, beta = {wildcards.beta}"
    shell:
        "roughgas pilot {wildcards.experiment} --scale {wildcards.scale} --r={wildcards.r}"
        " --beta={wildcards.beta} --settings {params.settings:q} --checked --output {output}"
        " > {log} 2>&1"


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
        "roughgas reach {wildcards.experiment} --scale {wildcards.scale} --r={wildcards.r}"
        " --beta={wildcards.beta} --settings {params.settings:q} --checked --pilot {input.pilot}"
        " --output {output} > {log} 2>&1"


rule plan_of_scale:
    input:
        "config.yaml",
        pilots=pilots,
    output:
        "results/{scale}/plan.md",
    log:
        "logs/{scale}/plan.log",
    params:
        code=code_of("planning.table"),
        cores=workflow.cores,
    message:
        "write {output}"
    shell:
        "roughgas plan --scale {wildcards.scale} --cores {params.cores} --output {output}"
        " > {log} 2>&1"


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
        "roughgas costs {input.data} --fixed {params.fixed:q} --output {output} > {log} 2>&1"
