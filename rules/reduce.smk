# From points to one dataset an experiment, over r, beta and seed, and over its variants.


rule reduce:
    input:
        sources("results.reduce"),
        points=points_of_experiment,
    output:
        REDUCED,
    log:
        "logs/{scale}/{experiment}/reduced.log",
    benchmark:
        "logs/{scale}/{experiment}/reduced.tsv"
    wildcard_constraints:
        experiment=EXPERIMENT,
    message:
        "reduce {wildcards.experiment}"
    shell:
        # a hundred thousand points are more than a command line holds
        "printf '%s\\n' {input.points} | roughgas reduce - --output {output} > {log} 2>&1"
