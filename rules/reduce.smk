# From points to one dataset an experiment, over r, beta and seed, and over its variants.


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
        "printf '%s\\n' {input.points:q} | roughgas reduce - --output {output:q} > {log:q} 2>&1"
