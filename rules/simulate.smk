# From an experiment's settings to its points, one job each.


rule compile_kernel:
    # Before the fan-out, and one at a time (see the profile): two compilers upset numba's cache.
    # Its output also stands for all sources that shape a point. They are inputs here, and not once
    # more of each of a thousand points: at every step the scheduler looks at every input of every
    # job, which took it longer than the points take. So it holds their checksums: were it the same
    # after an edit, points that an interrupted run has left as they were would pass for new.
    input:
        sources("simulate", "dataset"),
        "src/roughgas/cli/run.py",
        "src/roughgas/config/labels.py",
    output:
        KERNEL,
    log:
        "logs/{scale}/{experiment}/r{r}/compiled.log",
    benchmark:
        "logs/{scale}/{experiment}/r{r}/compiled.tsv"
    priority: 10
    resources:
        compiling=1,
    params:
        settings=settings_of_points,
    message:
        "compile the kernel of {wildcards.experiment} at r = {wildcards.r}"
    shell:
        "roughgas compile {wildcards.experiment} --scale {wildcards.scale} --r={wildcards.r}"
        " --settings {params.settings:q} --checked > {log} 2>&1; cksum {input} > {output}"


rule point:
    input:
        kernel_of_point,
    output:
        POINT,
    log:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/seed{seed}.log",
    benchmark:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/seed{seed}.tsv"
    priority: urgency
    params:
        settings=settings_of_points,
    message:
        "{wildcards.experiment}: r = {wildcards.r}, beta = {wildcards.beta}, seed = {wildcards.seed}"
    shell:
        "roughgas run {wildcards.experiment} --scale {wildcards.scale} --r={wildcards.r}"
        " --beta={wildcards.beta} --seed={wildcards.seed} --settings {params.settings:q}"
        " --checked --output {output} > {log} 2>&1"
