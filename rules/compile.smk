# The kernels of an experiment are compiled before its points are run.
FIRST = 10**12  # more urgent than any point


def kernel_of_point(wildcards):
    """What says that the kernel of a point is compiled; ends the workflow for an illegal point."""
    with one_line(f"results/{wildcards.scale}/{wildcards.experiment}"):
        roughgas.config.restitution(wildcards.r)
        if "beta" in wildcards.keys():
            roughgas.config.roughness(wildcards.beta)
        if "seed" in wildcards.keys():
            roughgas.config.seed(wildcards.seed)
        found = settings(wildcards.scale, wildcards.experiment)
        roughgas.config.check_one_variant(wildcards.experiment, found)
    experiment, _, _ = wildcards.experiment.partition("/")
    return KERNEL.format(scale=wildcards.scale, experiment=experiment, r=wildcards.r)


def kinds_of_kernels(wildcards):
    """What decides which kernels an experiment needs at some r, all variants in its sweep together:
    one more value that is like the others concerns no point that is there."""
    from roughgas.simulation.point import kernels

    found = settings(wildcards.scale, wildcards.experiment)
    every = roughgas.config.every_variant(wildcards.experiment, found).values()
    with one_line(KERNEL.format(**wildcards)):
        r = roughgas.config.restitution(wildcards.r)
    needed = kernels([one | {"sweep": {"r": [r]}} for one in every])
    common = roughgas.config.pilot_settings(roughgas.config.common(found))
    return [roughgas.config.as_text(common), *sorted(map(str, needed))]


def settings_of_kernels(wildcards, output):
    """The settings to compile, as JSON: not recorded, as those of `seeds_of_job`."""
    found = settings(wildcards.scale, wildcards.experiment)
    return roughgas.config.as_text(roughgas.config.kernel_settings(found))


rule compile_kernel:
    # Before the fan-out, and few at a time (see the profile). One job for all variants, since most
    # of them run the same machine code.
    # Its output also stands for all sources that shape a point. They are inputs here, and not once
    # more of each of a thousand points: at every step the scheduler looks at every input of every
    # job, which took it longer than the points take. So it holds their checksums: were it the same
    # after an edit, points that an interrupted run has left as they were would pass for new.
    input:
        sources("simulation.point", "data.point"),
        "src/roughgas/cli/run.py",
        "src/roughgas/config/labels.py",
    output:
        KERNEL,
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
        kinds=kinds_of_kernels,
        settings=settings_of_kernels,
    message:
        "compile the kernel of {wildcards.experiment} at r = {wildcards.r}"
    shell:
        "roughgas compile {wildcards.experiment} --scale {wildcards.scale} --r={wildcards.r}"
        " --settings {params.settings:q} --checked > {log} 2>&1; cksum {input} > {output}"
