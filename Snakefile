# The workflow at a glance: config.yaml says what is simulated, rules/ how, roughgas does the work.
#
#   snakemake -j2 figures                       the four figures of the paper, a table, its claims
#   snakemake -j2 figures --config scale=small  the same in a minute, with wide error bars
#   snakemake -j2 extensions                    beyond the paper: spheres, friction, other drives ...
#   snakemake -j1 showcase                      a large cooling gas forms clusters: a movie
#   snakemake -j2 accuracy                      what the next digit costs, in CPU seconds
#   snakemake -j2 coverage                      whether error bars hold the truth as often as they say
#   snakemake -j2 hard_cases                    where simulations go wrong, and how far from it we are
#   snakemake -j1 results/paper/cooling/r0.87/beta-0.33/seed7.nc     any one point


include: "rules/common.smk"
include: "rules/sources.smk"


if workflow.is_main_process:
    alive = forget_dead_locks()  # held until this process ends

config = checked_config("config.yaml", config)
SCALE = config["scale"]


wildcard_constraints:
    scale="[^/]+",
    experiment=EXPERIMENT + VARIANT,
    r="[^/]+",
    beta="[^/]+",
    seed="[^/]+",
    folder="([^/]+/)?",
    figure=r"(?!clustering\.|hard_cases|accuracy\.|coverage\.)[^/]+",  # these have their own rules
    study="[^/]+",
    task="[^/]+",
    study_figure="accuracy|coverage",
    family="[^/]+",


include: "rules/compile.smk"
include: "rules/simulate.smk"
include: "rules/planning.smk"
include: "rules/reduce.smk"
include: "rules/figures.smk"
include: "rules/extensions.smk"
include: "rules/showcase.smk"
include: "rules/hard_cases.smk"
include: "rules/accuracy.smk"


# on a cluster, these take less than sending them there
localrules:
    figure,
    table,
    claims,


rule figures:
    default_target: True
    input:
        drawn(PAPER),
        f"results/{SCALE}/R.csv",
        f"results/{SCALE}/claims.json",
        f"results/{SCALE}/claims.md",


rule everything:
    input:
        rules.figures.input,
        rules.extensions.input,
        reduced(SCALE, config["experiments"]),
        rules.showcase.input,
        rules.hard_cases.input,
        rules.accuracy.input,
        rules.coverage.input,


onstart:
    lift_rate_limit()


onerror:
    print("Stopped: the same command goes on from here.", file=sys.stderr)
