# The kernels of an experiment are compiled before its points are run.


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
    return KERNEL.format(scale=wildcards.scale, experiment=experiment, r=wildcards.r)


def kinds_of_kernels(wildcards):
    """Which kernels the variants in the sweep of an experiment need at some r."""
    from roughgas.simulation.point import kernels

    found = settings(wildcards.scale, wildcards.experiment)
    every = roughgas.config.every_variant(wildcards.experiment, found).values()
    with one_line(KERNEL.format(**wildcards)):
        r = place_of(wildcards).r
    return sorted(map(str, kernels(every, r)))


def settings_of_kernels(wildcards, output):
    """The settings to compile, as JSON. Snakemake does not record params that are made from the
    output: of these settings only the kinds of kernels count."""
    found = settings(wildcards.scale, wildcards.experiment)
    return roughgas.config.as_text(roughgas.config.kernel_settings(found))


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
    priority: FIRST
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
