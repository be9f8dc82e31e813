# Kernels, points, reduced datasets: the kernels of an experiment are compiled before its points are run.
# A job of the rule EXPERIMENT_blockN makes `seeds_per_job` seeds at `betas_per_job` values of beta of the
# sweep (see config.yaml), at one r, or at all r of a sweep that takes seconds; any other point has a
# separate job.


rule compile_kernel:
    # Before the points, and few at a time (see the profile); one job for all variants, since most of
    # them run the same machine code. The code of points includes the kernel's: an edit that recompiles
    # also reruns the points, and points left by an interrupted run are outdated by their own param.
    output:
        touch(KERNEL),
    log:
        "logs/{scale}/{experiment}/r{r}/compiled.log",
    benchmark:
        "logs/{scale}/{experiment}/r{r}/compiled.tsv"
    wildcard_constraints:
        experiment=EXPERIMENT,
    priority: from_wildcards(sweeps.kernel_priority)
    resources:
        compiling=1,
    params:
        code=from_wildcards(sweeps.kernel_code),
        kinds=from_wildcards(sweeps.kernel_kinds_of_path),
        settings=unrecorded(sweeps.kernel_settings),  # only `kinds` affect the kernel
        studies=unrecorded(sweeps.study_options),
    message:
        "compile the kernel of {wildcards.experiment} at r = {wildcards.r}"
    shell:
        "python -P -m roughgas.steps compile_kernels {wildcards.experiment:q} --r={wildcards.r:q}"
        " --settings {params.settings:q} {params.studies:q} > {log:q} 2>&1"


for block in sweeps.blocks():

    rule:
        name:
            block.name
        input:
            *(from_wildcards(sweeps.kernel, **r) for r in block.at_each_r),
        output:
            block.outputs,
        log:
            f"logs/{{scale}}/{{experiment}}/{block.log}.log",
        benchmark:
            f"logs/{{scale}}/{{experiment}}/{block.log}.tsv"
        wildcard_constraints:
            **block.constraints,
        priority: from_wildcards(sweeps.priority, points=len(block.outputs), **block.at_each_r[0])
        resources:
            runtime=per_attempt(sweeps.minutes, points=len(block.outputs), **block.at_each_r[0]),
            mem_mb=per_attempt(sweeps.megabytes),
        params:
            code=from_wildcards(sweeps.point_code),
            settings=from_wildcards(sweeps.point_settings),
            studies=unrecorded(sweeps.study_options),
            # not recorded: a point is up to date regardless of the job that made it
            points=lambda wildcards, output: points_of_job(output),
        message:
            "{wildcards.experiment}: {params.points}"
        shell:
            "roughgas run {wildcards.experiment:q} --scale {wildcards.scale:q} {params.points:q}"
            " --settings {params.settings:q} {params.studies:q} --output {output:q} > {log:q} 2>&1"


rule reduce:
    input:
        points=from_wildcards(sweeps.points),
    output:
        REDUCED,
    log:
        "logs/{scale}/{experiment}/reduced.log",
    benchmark:
        "logs/{scale}/{experiment}/reduced.tsv"
    wildcard_constraints:
        experiment=EXPERIMENT,
    # at once: while it waits, Snakemake checks the size of all these points before each new job
    priority: URGENT
    params:
        code=code_of("results.reduce"),
    message:
        "reduce {wildcards.experiment}"
    shell:
        # a hundred thousand points exceed the length of a command line
        "printf '%s\\n' {input.points:q} | "
        "roughgas reduce - --put-aside --output {output:q} > {log:q} 2>&1"
